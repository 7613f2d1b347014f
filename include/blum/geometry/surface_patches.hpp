// Blum: smooth parts of a mesh, and the parts that a site lies on. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Smooth part of a mesh. Its faces are connected through edges that have exactly two faces and bend little, unless
/// patches are given. Faces without area belong to no patch.
struct SurfacePatch {
  std::size_t faces = 0;
  double area = 0;  ///< Square mesh units.
  Vec3d centroid;   ///< Centroid of the area.
  Vec3d normal;     ///< Mean normal over the area, scaled to unit length; 0 if undefined, as for a closed surface.
};

/// Returns the normals of all triangles. The length of a normal is twice the triangle's area.
[[nodiscard]] std::vector<Vec3d> triangle_normals(const MeshView& mesh);

/// Returns for each edge of a mesh 1 if it has exactly two triangles with normals, and bends by at most an angle.
/// @param normals  for each triangle, a vector in the direction of its normal; 0 if it has none.
/// @param angle    degrees.
[[nodiscard]] std::vector<std::uint8_t> smooth_edges(const MeshView& mesh, const SiteTable& sites,
                                                     std::span<const Vec3d> normals, double angle);

/// Patches of a mesh, numbered in the order of their first faces.
class SurfacePatches {
 public:
  /// The mesh must outlive this object.
  /// @param angle  largest bend at an edge inside a patch, in degrees.
  /// @throws InvalidMesh, Cancelled. Cost: near-linear.
  SurfacePatches(const MeshView& mesh, double angle, const Context& context);
  /// Finds patches in the same way, with the given sites of the mesh. The mesh must pass validate().
  SurfacePatches(const MeshView& mesh, SiteTable sites, double angle, const Context& context);
  /// Does the same with given normals, for example with those of planes that several triangles have in common.
  /// @param normals  for each triangle, a vector in the direction of its normal. Its length is twice the area.
  SurfacePatches(const MeshView& mesh, SiteTable sites, std::vector<Vec3d> normals, double angle,
                 const Context& context);

  /// Uses given patches.
  /// @param normals   for each triangle, a vector in the direction of its normal. Its length is twice the area.
  /// @param patch_of  for each triangle, the number of its patch; `none` if it belongs to no patch. Patches are
  /// numbered consecutively from 0.
  SurfacePatches(const MeshView& mesh, SiteTable sites, std::vector<Vec3d> normals,
                 std::vector<std::uint32_t> patch_of);

  static constexpr std::uint32_t none = 0xffffffffU;

  [[nodiscard]] const std::vector<SurfacePatch>& patches() const { return patches_; }
  /// Returns the number of sites of the mesh.
  [[nodiscard]] std::size_t site_count() const { return sites_.size(); }
  /// Returns the patch number of a face; none for a face without area.
  [[nodiscard]] std::uint32_t of_face(std::uint32_t face) const { return patch_of_[face]; }
  /// Returns the indices of the patches to which a site belongs, in ascending order.
  /// @param site  below site_count().
  [[nodiscard]] std::vector<std::uint32_t> at(SiteId site) const;

 private:
  /// Triangles of all edges, or of all vertices, row after row.
  struct Rows {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> triangles;
  };
  void find_rows();
  void join_faces(double angle, const Context& context);
  void add_up();

  const MeshView mesh_;
  SiteTable sites_;
  std::vector<Vec3d> normals_;  ///< normals of the triangles; their length is twice the area
  Rows at_edges_, at_vertices_;
  std::vector<std::uint32_t> patch_of_;  ///< for each face
  std::vector<SurfacePatch> patches_;
};

}  // namespace blum::detail
