#include "proximity/scene_object.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/weld.hpp"

namespace blum {
namespace {

/// Greatest coordinate of an object, mesh units. Fourth powers of coordinates must stay finite.
constexpr double largest_coordinate = 1e70;
constexpr double smallest_coordinate = 1e-140;
constexpr std::size_t vertices_per_range = 8192;

double magnitude(const Vec3d& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

}  // namespace

void check(const RigidTransform& place) {
  constexpr double tolerance = 1e-9;
  const auto& c = place.rotation.columns;
  if (!is_finite(c[0]) || !is_finite(c[1]) || !is_finite(c[2])) {
    throw InvalidOption("the rotation of a transform holds numbers that are not finite");
  }
  if (const double error = place.rotation_error(); !(error <= tolerance)) {
    constexpr double rounding = 1e-5;  // error of numbers in single precision, and of a few products of them
    throw InvalidOption(
        "a transform is not rigid: the columns of its rotation must be orthonormal to within 1e-9, but are so only to "
        "within " +
        rounded_text(error) +
        (error <= rounding ? ": it seems to be rounded to single precision; pass closest_rotation(matrix)"
                           : ": it scales or shears; scale vertices instead"));
  }
  if (dot(cross(c[0], c[1]), c[2]) < 0) {
    throw InvalidOption(
        "a transform is a reflection, which turns bodies inside out; mirror the mesh instead, and reverse its "
        "triangles");
  }
  if (!is_finite(place.translation) || magnitude(place.translation) > largest_coordinate) {
    throw InvalidOption("the translation of a transform is not finite, or beyond 1e70");
  }
}

namespace detail {
namespace {

void check(const MeshView& mesh) {
  validate(mesh);
  const double largest = bounds(mesh).largest_coordinate();
  if (largest > largest_coordinate) {
    throw InvalidMesh("a coordinate is beyond 1e70, the limit for objects of a scene: scale it");
  }
  if (largest > 0 && largest < smallest_coordinate) {
    throw InvalidMesh("no coordinate is above 1e-140: an object of a scene must be larger; scale it");
  }
}

}  // namespace

SceneObject::SceneObject(const MeshView& mesh, ObjectOptions options, const Context& context)
    : options_(std::move(options)) {
  set_mesh(mesh, context);
}

void SceneObject::set_mesh(const MeshView& mesh, const Context& context) {
  check(mesh);
  OrientedBvh bvh(mesh, context);
  mesh_ = copy_of(mesh);
  bvh_ = std::move(bvh);
}

void SceneObject::check_positions(std::span<const Vec3d> vertices, const Context& context) const {
  if (vertices.size() != mesh_.vertices.size()) {
    throw InvalidMesh("the object has " + std::to_string(mesh_.vertices.size()) + " vertices, but the update has " +
                      std::to_string(vertices.size()) + "; set a new mesh to change their number");
  }
  std::atomic<bool> are_fine = true;
  std::atomic<bool> is_any_large = false;
  parallel_for(context, vertices.size(), vertices_per_range, "", [&](const WorkRange& range) {
    double largest = 0;
    for (std::size_t v = range.begin; v < range.end; ++v) {
      if (!is_finite(vertices[v])) are_fine = false;
      largest = std::max(largest, magnitude(vertices[v]));
    }
    if (largest > largest_coordinate) are_fine = false;
    if (largest >= smallest_coordinate) is_any_large = true;
  });
  if (are_fine && is_any_large) return;
  // Vertices that no primitive uses may have any value.
  MeshView moved = mesh_;
  moved.vertices = vertices;
  check(moved);
}

void SceneObject::set_positions(std::span<const Vec3d> vertices, const Context& context) {
  check_positions(vertices, context);
  parallel_for(context, vertices.size(), vertices_per_range, "", [&](const WorkRange& range) {
    std::copy_n(vertices.data() + range.begin, range.end - range.begin, mesh_.vertices.data() + range.begin);
  });
  bvh_->refit(mesh_.vertices, context);
}

void SceneObject::set_place(const RigidTransform& place) {
  check(place);
  place_ = place;
  is_placed_ = !(place == RigidTransform{});
}

Box3 SceneObject::bounds() const {
  const Box3& box = bvh_->bounds();
  if (!is_placed_) return box;
  Box3 out;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3d p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = (corner >> axis & 1U) != 0 ? box.upper[axis] : box.lower[axis];
    out.extend(place_(p));
  }
  return out;
}

std::array<std::uint32_t, 3> SceneObject::vertices(std::uint32_t primitive) const {
  return primitive_vertices(mesh_, primitive);
}

std::array<Vec3d, 3> SceneObject::corners(std::uint32_t primitive) const {
  if (is_placed_) return corners(primitive, place_);
  const auto [a, b, c] = vertices(primitive);
  return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
}

std::array<Vec3d, 3> SceneObject::corners(std::uint32_t primitive, const RigidTransform& place) const {
  const auto [a, b, c] = vertices(primitive);
  const std::vector<Vec3d>& v = mesh_.vertices;
  if (place == RigidTransform{}) return {v[a], v[b], v[c]};
  return {place(v[a]), place(v[b]), place(v[c])};
}

std::vector<Vec3d> SceneObject::positions(std::span<const Vec3d> vertices, const RigidTransform& place) {
  std::vector<Vec3d> out(vertices.begin(), vertices.end());
  if (place == RigidTransform{}) return out;
  for (Vec3d& p : out) p = place(p);
  return out;
}

std::vector<std::uint32_t> SceneObject::clusters() const {
  return is_placed_ ? weld_clusters(positions()) : weld_clusters(mesh_.vertices);
}

std::string name_of(ObjectId id, const SceneObject& object) {
  const std::string& name = object.options().name;
  return name.empty() ? "object " + std::to_string(id.value) : "'" + name + "'";
}

}  // namespace detail
}  // namespace blum
