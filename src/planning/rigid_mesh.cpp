#include "planning/rigid_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/geometry/primitives.hpp"

namespace blum::detail {
namespace {

/// Returns the mesh if it is valid.
MeshView checked(const MeshView& mesh, const std::string& name) {
  constexpr double furthest = 1e70, smallest = 1e-140;
  validate(mesh);
  double largest = 0;
  for (const Vec3d& p : mesh.vertices) {
    const double here = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!(here <= furthest)) {
      throw InvalidMesh("motion: a coordinate of the " + name + " is beyond 1e70; use other units");
    }
    largest = std::max(largest, here);
  }
  // Squares of smaller numbers would become 0.
  if (largest > 0 && largest < smallest) {
    throw InvalidMesh("motion: all coordinates of the " + name + " are below 1e-140; use other units");
  }
  return mesh;
}

}  // namespace

RigidMesh::RigidMesh(const MeshView& mesh, const std::string& name, const Context& context)
    : vertices_(mesh.vertices.begin(), mesh.vertices.end()), bvh_(checked(mesh, name), context) {
  for (std::uint32_t k = 0; k < bvh_.size(); ++k) primitives_.push_back(primitive_vertices(mesh, k));
  constexpr std::size_t many = 1024;
  if (3 * primitives_.size() > many) {
    for (unsigned k = 0; k < 8; ++k) {
      const auto side = [&](std::size_t axis) {
        return (k >> axis & 1U) != 0 ? bounds().upper[axis] : bounds().lower[axis];
      };
      hull_points_.push_back({side(0), side(1), side(2)});
    }
    return;
  }
  std::vector<std::uint32_t> used;
  for (const std::array<std::uint32_t, 3>& corners : primitives_)
    used.insert(used.end(), corners.begin(), corners.end());
  sort_unique(used);
  for (const std::uint32_t v : used) hull_points_.push_back(vertices_[v]);
}

}  // namespace blum::detail
