// Blum: smooth parts of a mesh, and the parts that a site lies on. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/axis/axis_graph.hpp"
#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Patches of a mesh (see AxisPatch), numbered in the order of their first faces.
class SurfacePatches {
 public:
  /// The mesh must outlive this object.
  /// @param angle  largest bend at an edge inside a patch, in degrees.
  /// @throws InvalidMesh, Cancelled. Cost: near-linear.
  SurfacePatches(const MeshView& mesh, double angle, const Context& context);
  /// Does the same with the given sites of the mesh. The mesh must pass validate().
  SurfacePatches(const MeshView& mesh, SiteTable sites, double angle, const Context& context);

  static constexpr std::uint32_t none = 0xffffffffU;

  [[nodiscard]] const std::vector<AxisPatch>& patches() const { return patches_; }
  /// Returns the patch number of a face; none for a face without area.
  [[nodiscard]] std::uint32_t of_face(std::uint32_t face) const { return patch_of_[face]; }
  /// Returns the indices of the patches to which a site belongs, in ascending order.
  /// @throws InvalidOption for a site that the mesh does not have.
  [[nodiscard]] std::vector<std::uint32_t> at(SiteId site) const;

 private:
  /// Triangles of all edges, or of all vertices, row after row.
  struct Rows {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> triangles;
  };
  void find_normals();
  void find_rows();
  void join_faces(double angle, const Context& context);
  [[nodiscard]] bool is_smooth(std::uint32_t edge, double least_cosine) const;
  void add_up();

  const MeshView mesh_;
  SiteTable sites_;
  std::vector<Vec3d> normals_;  ///< normals of the triangles; their length is twice the area
  Rows at_edges_, at_vertices_;
  std::vector<std::uint32_t> patch_of_;  ///< for each face
  std::vector<AxisPatch> patches_;
};

}  // namespace blum::detail
