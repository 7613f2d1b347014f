// Blum: numbers of surface parts that do not depend on position. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Mesh of one body of an input mesh, with references to the input mesh.
struct PatchedMesh {
  static constexpr std::uint32_t no_vertex = 0xffffffffU;

  MeshView mesh;
  std::span<const std::uint32_t> triangle_of;  ///< Index in the input mesh of each triangle of `mesh`.
  /// Index in the input mesh of each vertex of `mesh`; `no_vertex` for a new vertex.
  std::span<const std::uint32_t> vertex_of;
  FunctionRef<SiteId(SiteId own)> input_site;  ///< Returns the site of the input mesh for a site of `mesh`.
};

/// Numbers of the patches of a mesh, and the anchors of the mesh: vertices from which distances are measured. Numbers
/// and anchors depend on the shape of the mesh and on the order of its faces and vertices, but not on its position.
///
/// A patch is a flat or a smooth part of the surface. The faces of a flat part are connected through edges that bend by
/// at most 1 degree. In a smooth part, edges bend by at most 30 degrees. The patch of a face is its flat part if this
/// part covers at least 0.437 % of the surface of the body. If the flat part is smaller, the patch of the face is its
/// smooth part. If the mesh has fillets, its whole surface may be one smooth part. Then flat parts still distinguish
/// the sheets. The patch with the smaller first face has the smaller number.
class PatchNumbers {
 public:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// Constructs an object without a mesh: no site has a number.
  PatchNumbers() = default;
  /// @param input  sites of the mesh to which the bodies belong.
  explicit PatchNumbers(const SiteTable& input) : number_of_(input.size(), none), is_shared_(input.size(), false) {}

  /// Adds a body.
  /// @param own  sites of `part.mesh`.
  /// @throws Cancelled.
  /// Cost: near-linear.
  void add(const PatchedMesh& part, const SiteTable& own, const Context& context);
  /// Chooses the anchors. Call this after all bodies were added.
  void choose_anchors();

  [[nodiscard]] bool is_empty() const { return number_of_.empty(); }
  /// Returns the smallest number of the patches that contain a site of the input; `none` if no patch does.
  [[nodiscard]] std::uint32_t at(SiteId site) const { return site.has_value() ? number_of_[site.value] : none; }
  /// Returns true if a site of the input lies on several patches, that is, on an edge or vertex between them.
  [[nodiscard]] bool is_shared(SiteId site) const { return site.has_value() && is_shared_[site.value]; }
  /// Returns the anchors: up to four vertices. The anchors do not all lie on a line or in a plane, unless the whole
  /// mesh does. The distances of a position from the anchors determine the position.
  [[nodiscard]] const std::vector<Vec3d>& anchors() const { return anchors_; }
  /// Returns the distance from the first anchor to the vertex that is furthest from this anchor.
  [[nodiscard]] double reach() const { return reach_; }

 private:
  std::vector<std::uint32_t> number_of_;  ///< Number of each site of the input.
  std::vector<bool> is_shared_;
  std::vector<std::pair<std::uint32_t, Vec3d>> vertices_;
  std::vector<Vec3d> anchors_;
  double reach_ = 0;
};

}  // namespace blum::detail
