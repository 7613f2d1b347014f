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

/// Patches of a mesh (see AxisPatch), numbered by their first face.
class SurfacePatches {
 public:
  /// @param angle  degrees. @throws InvalidMesh, Cancelled. Cost: near-linear. The mesh must outlive this object.
  SurfacePatches(const MeshView& mesh, double angle, const Context& context);
  /// The same with the sites of the mesh, which must pass validate().
  SurfacePatches(const MeshView& mesh, SiteTable sites, double angle, const Context& context);

  static constexpr std::uint32_t none = 0xffffffffU;

  [[nodiscard]] const std::vector<AxisPatch>& patches() const { return patches_; }
  /// Returns the patch of a face; none for a face without area.
  [[nodiscard]] std::uint32_t of_face(std::uint32_t face) const { return patch_of_[face]; }
  /// Returns the patches that a site lies on, ascending. @throws InvalidOption for a site that the mesh does not have.
  [[nodiscard]] std::vector<std::uint32_t> at(SiteId site) const;

 private:
  /// Triangles of each edge or vertex, one after the other.
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
  std::vector<Vec3d> normals_;  ///< length: twice the area
  Rows at_edges_, at_vertices_;
  std::vector<std::uint32_t> patch_of_;  ///< of each face
  std::vector<AxisPatch> patches_;
};

}  // namespace blum::detail
