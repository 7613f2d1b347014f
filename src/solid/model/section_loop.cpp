#include "solid/model/section_loop.hpp"

#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

/// Returns the corner of a triangle that is not an end of the given edge.
Vec3d apex(const SurfaceMesh& mesh, std::uint32_t triangle, std::uint32_t edge) {
  const Triangle& t = mesh.triangles()[triangle];
  const Segment& ends = mesh.edges()[edge];
  for (const std::uint32_t v : t) {
    if (v != ends[0] && v != ends[1]) return mesh.vertices()[v];
  }
  return mesh.vertices()[t[0]];
}

}  // namespace

bool is_around_hole(const SurfaceMesh& mesh, std::span<const std::uint32_t> edges, std::size_t across, double plane) {
  const std::size_t along = (across + 1) % 3;
  const std::size_t beside = (across + 2) % 3;
  std::uint32_t lowest = edges.front();
  for (const std::uint32_t edge : edges.subspan(1)) {
    if (passes_before(mesh.ends(edge), mesh.ends(lowest), across, plane, along)) lowest = edge;
  }
  // The curve's lowest point is tested: the region below it lies outside the curve. A ray downwards from there is
  // tilted slightly to the side, so that it is parallel to no triangle.
  const auto& [one, two] = mesh.triangles_of(lowest);
  const auto is_behind = [&](const TriangleCorners& corners) {
    const int component = normal_sign(corners, along);
    return (component != 0 ? -component : normal_sign(corners, beside)) < 0;
  };
  const bool behind_one = is_behind(mesh.corners(one));
  const bool behind_two = is_behind(mesh.corners(two));
  const TriangleCorners corners = mesh.corners(one);
  const bool is_reflex = orient3d(corners[0], corners[1], corners[2], apex(mesh, two, lowest)) > 0;
  return is_reflex ? behind_one || behind_two : behind_one && behind_two;
}

}  // namespace blum::detail
