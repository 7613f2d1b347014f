#include "blum/geometry/pseudonormals.hpp"

#include <array>
#include <cmath>

#include "blum/core/huge_pages.hpp"
#include "blum/core/parallel.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum {
namespace {

constexpr std::size_t grain = 4096;

/// Returns the angle between two vectors. The result is accurate for all angles.
double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

Pseudonormals::Pseudonormals(const MeshView& mesh, const SiteTable& sites, const Context& context)
    : normals_(detail::large_list<Vec3d>(sites.size())) {
  const double scale = unit_scale(bounds(mesh));
  const std::size_t edge_base = sites.vertex_count();
  const std::size_t face_base = edge_base + sites.edge_count();
  std::vector<std::array<double, 3>> angles(mesh.triangles.size());
  parallel_for(context, mesh.triangles.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const Triangle& triangle = mesh.triangles[t];
      const auto corner = [&](std::size_t k) { return mesh.vertices[triangle[k]] * scale; };
      const std::array<Vec3d, 3> p{corner(0), corner(1), corner(2)};
      normals_[face_base + t] = make_triangle_frame(p).normal();
      for (std::size_t k = 0; k < 3; ++k) angles[t][k] = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
    }
  });
  // Runs on one thread, in the order of triangles, so that sums are bitwise equal for any number of threads.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % (std::size_t{1} << 16) == 0) throw_if_cancelled(context);
    const Vec3d& normal = normals_[face_base + t];
    for (std::size_t k = 0; k < 3; ++k) {
      normals_[mesh.triangles[t][k]] += normal * angles[t][k];
      const EdgeId edge = sites.triangle_edges()[t][k];
      if (edge.has_value()) normals_[edge_base + edge.value] += normal;
    }
  }
}

}  // namespace blum
