// Blum: an object of a scene. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/oriented_bvh.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/scene.hpp"

namespace blum::detail {

/// An object of a scene: a mesh, its transform into the scene (called place), and a hierarchy of boxes over the mesh.
class SceneObject {
 public:
  SceneObject(const MeshView& mesh, ObjectOptions options, const Context& context);

  void set_positions(std::span<const Vec3d> vertices, const Context& context);
  /// @throws InvalidMesh if set_positions() would reject the vertices.
  void check_positions(std::span<const Vec3d> vertices, const Context& context) const;
  void set_place(const RigidTransform& place);
  void set_mesh(const MeshView& mesh, const Context& context);
  void set_name(std::string name) { options_.name = std::move(name); }

  [[nodiscard]] const ObjectOptions& options() const { return options_; }
  [[nodiscard]] const OrientedBvh& bvh() const { return *bvh_; }
  [[nodiscard]] const RigidTransform& place() const { return place_; }
  [[nodiscard]] std::size_t primitives() const { return bvh_->size(); }
  [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }
  /// Returns a box around the whole object, in scene coordinates.
  [[nodiscard]] Box3 bounds() const;

  /// Returns the vertices of a primitive. The vertices of a segment or point are repeated.
  [[nodiscard]] std::array<std::uint32_t, 3> vertices(std::uint32_t primitive) const;
  /// Returns the positions of a primitive's vertices in the scene, with the object's own transform.
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t primitive) const;
  /// Returns the positions of a primitive's vertices in the scene, with another transform of the object.
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t primitive, const RigidTransform& place) const;
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  /// Returns the positions of all vertices in the scene.
  [[nodiscard]] std::vector<Vec3d> positions() const { return positions(mesh_.vertices, place_); }
  /// Returns the vertices, transformed by `place`.
  [[nodiscard]] static std::vector<Vec3d> positions(std::span<const Vec3d> vertices, const RigidTransform& place);
  /// Returns for each vertex the smallest vertex with the same position in the scene.
  [[nodiscard]] std::vector<std::uint32_t> clusters() const;

 private:
  TriangleMesh mesh_;
  ObjectOptions options_;
  RigidTransform place_;
  bool is_placed_ = false;
  std::optional<OrientedBvh> bvh_;
};

/// Returns the name of an object in messages: "'arm.ply'", or "object 3" if it has no name.
[[nodiscard]] std::string name_of(ObjectId id, const SceneObject& object);

}  // namespace blum::detail
