// Blum: labels that decide which sites may be second at a node, and the request for the second order of a field.
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

/// Labels that express both rules of the second order. Every vertex has one label; a site has the labels of its
/// vertices. A site may be second only if it shares no label with the first (closest) site. Under the rule "no common
/// vertex", the label of a vertex is its index. Under the rule "other object", it is the object.
///
/// If all sites with certain labels are removed, the rest is still a mesh: every remaining site keeps its border.
class SecondLabels {
 public:
  /// Labels of a site's vertices. If a site has fewer than three, the first label is repeated.
  using OfSite = std::array<std::uint32_t, 3>;

  SecondLabels() = default;
  /// @param objects  one per vertex. If empty, the objects are the connected parts of the mesh.
  SecondLabels(SecondRule rule, const MeshView& mesh, const SiteTable& sites, std::span<const std::uint32_t> objects,
               const Context& context);

  /// Returns true if each vertex has a different label.
  [[nodiscard]] bool is_by_vertex() const { return of_vertex_.empty(); }
  /// Returns the label of a vertex. Labels are below the number of vertices.
  [[nodiscard]] std::uint32_t of_vertex(std::uint32_t vertex) const {
    return of_vertex_.empty() ? vertex : of_vertex_[vertex];
  }
  [[nodiscard]] OfSite of_site(const SiteTable& sites, SiteId site) const;
  /// Returns true if the mesh has a site that may be second to a site with these labels.
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

/// Field of order 1 with its signs and sites, and the memory for its second order.
struct SecondRequest {
  GridSpec grid;
  /// Half-width of the band, mesh units, finite. 0: no band; the full grid is computed.
  double band = 0;
  const SecondLabels* labels = nullptr;
  const float* distance = nullptr;      ///< one per node, mesh units, signed or unsigned
  const std::uint32_t* site = nullptr;  ///< feature ids; 0xffffffff beyond the band
  float* distance2 = nullptr;           ///< one per node, mesh units
  std::uint32_t* site2 = nullptr;       ///< feature ids; 0xffffffff if the node has no second site

  [[nodiscard]] bool has_band() const { return band > 0; }
};

}  // namespace blum
