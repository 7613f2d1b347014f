// Blum: which sites may be second at a node, and the request for the second order of a field.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

/// Labels that express both rules of second order. Every vertex has a label, and a site has the labels of its vertices.
/// Sites that share a label are not second to each other. Under the rule "no common vertex", each vertex is its own
/// label. Under the rule "other object", the label is the object.
///
/// A mesh without the sites that have some labels is still a mesh: every site that remains keeps its border.
class SecondLabels {
 public:
  /// Labels of a site's vertices; the first label repeats if there are fewer than three.
  using OfSite = std::array<std::uint32_t, 3>;

  SecondLabels() = default;
  /// @param objects  one per vertex; empty: the connected parts of the mesh.
  SecondLabels(SecondRule rule, const MeshView& mesh, const SiteTable& sites, std::span<const std::uint32_t> objects,
               const Context& context);

  /// Returns true if each vertex is its own label.
  [[nodiscard]] bool is_by_vertex() const { return of_vertex_.empty(); }
  /// Returns the label of a vertex, below the number of vertices.
  [[nodiscard]] std::uint32_t of_vertex(std::uint32_t vertex) const {
    return of_vertex_.empty() ? vertex : of_vertex_[vertex];
  }
  [[nodiscard]] OfSite of_site(const SiteTable& sites, SiteId site) const;
  /// Returns true if any site may be second to a site with these labels.
  [[nodiscard]] bool has_second(const OfSite& labels) const;

 private:
  std::vector<std::uint32_t> of_vertex_;
  std::size_t count_ = 0;  ///< number of different labels of the vertices that primitives use
};

[[nodiscard]] inline bool share_label(const SecondLabels::OfSite& a, const SecondLabels::OfSite& b) {
  bool found = false;
  for (const std::uint32_t label : a) found = found || label == b[0] || label == b[1] || label == b[2];
  return found;
}

/// First-order field that is complete with signs and sites, and the memory of its second order.
struct SecondRequest {
  GridSpec grid;
  /// Half-width of the band, mesh units, finite; 0: the full grid.
  double band = 0;
  const SecondLabels* labels = nullptr;
  const float* distance = nullptr;      ///< one per node, mesh units, of any sign
  const std::uint32_t* site = nullptr;  ///< features; 0xffffffff beyond the band
  float* distance2 = nullptr;           ///< one per node, mesh units
  std::uint32_t* site2 = nullptr;       ///< features; 0xffffffff if none

  [[nodiscard]] bool has_band() const { return band > 0; }
};

}  // namespace blum
