// Blum: numbers for the parts of a surface that do not change when it is moved. SPDX-License-Identifier: Apache-2.0
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

/// A part of an input mesh, and where it comes from.
struct PatchedMesh {
  static constexpr std::uint32_t no_vertex = 0xffffffffU;

  MeshView mesh;
  std::span<const std::uint32_t> triangle_of;  ///< of each triangle: in the input
  std::span<const std::uint32_t> vertex_of;    ///< of each vertex: in the input; no_vertex for one that is new
  FunctionRef<SiteId(SiteId own)> input_site;  ///< the site of the input that one of the part stands for
};

/// Numbers of the patches of a mesh, and places in it to measure from. Both follow from the order of faces and vertices
/// in the input and from its shape, and not from where it lies in space.
///
/// Patches are flat faces that make up much of the surface of their body, and else smooth parts: with fillets all of a
/// part may be one smooth part, of which its flat faces still tell the sheets. Of two patches the one with the smaller
/// first face has the smaller number.
class PatchNumbers {
 public:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// Of what has no mesh: no site has a number.
  PatchNumbers() = default;
  /// @param input  the sites of the mesh that the bodies are of.
  explicit PatchNumbers(const SiteTable& input) : number_of_(input.size(), none), is_shared_(input.size(), false) {}

  /// @param own  the sites of the part's mesh. @throws Cancelled. Cost: near-linear.
  void add(const PatchedMesh& part, const SiteTable& own, const Context& context);
  /// To be called when all bodies are there.
  void choose_anchors();

  [[nodiscard]] bool is_empty() const { return number_of_.empty(); }
  /// The smallest of those that a site of the input lies on; none where it lies on none.
  [[nodiscard]] std::uint32_t at(SiteId site) const { return site.has_value() ? number_of_[site.value] : none; }
  /// Whether a site of the input lies on several: an edge or a vertex where they meet.
  [[nodiscard]] bool is_shared(SiteId site) const { return site.has_value() && is_shared_[site.value]; }
  /// Up to four vertices, neither on a line nor in a plane as far as the mesh is not. Distances from them tell a place.
  [[nodiscard]] const std::vector<Vec3d>& anchors() const { return anchors_; }
  /// The distance of the first anchor from the vertex that is furthest from it.
  [[nodiscard]] double reach() const { return reach_; }

 private:
  std::vector<std::uint32_t> number_of_;  ///< of each site of the input
  std::vector<bool> is_shared_;
  std::vector<std::pair<std::uint32_t, Vec3d>> vertices_;
  std::vector<Vec3d> anchors_;
  double reach_ = 0;
};

}  // namespace blum::detail
