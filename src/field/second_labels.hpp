// Blum: which sites may be second at a node, and what the second order of a field is asked for.
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

/// Both rules of second order in one: every vertex has a label, a site has those of its vertices, and sites that have a
/// label in common are no second of each other. Without a common vertex: each vertex is its own label. Of another
/// object: the label is the object.
///
/// What remains of a mesh without the sites that have some labels is a mesh, too: with a site, its border remains.
class SecondLabels {
 public:
  /// The labels of a site's vertices; the first one again where there are fewer than three.
  using OfSite = std::array<std::uint32_t, 3>;

  SecondLabels() = default;
  /// @param objects  one per vertex; empty: the connected parts of the mesh.
  SecondLabels(SecondRule rule, const MeshView& mesh, const SiteTable& sites, std::span<const std::uint32_t> objects,
               const Context& context);

  /// Whether each vertex is its own label.
  [[nodiscard]] bool is_by_vertex() const { return of_vertex_.empty(); }
  /// Below the number of vertices.
  [[nodiscard]] std::uint32_t of_vertex(std::uint32_t vertex) const {
    return of_vertex_.empty() ? vertex : of_vertex_[vertex];
  }
  [[nodiscard]] OfSite of_site(const SiteTable& sites, SiteId site) const;
  /// Whether any site may be second beside one with these labels.
  [[nodiscard]] bool has_second(const OfSite& labels) const;

 private:
  std::vector<std::uint32_t> of_vertex_;
  std::size_t count_ = 0;  ///< different labels of the vertices that something names
};

[[nodiscard]] inline bool share_label(const SecondLabels::OfSite& a, const SecondLabels::OfSite& b) {
  bool found = false;
  for (const std::uint32_t label : a) found = found || label == b[0] || label == b[1] || label == b[2];
  return found;
}

/// A field of first order that is complete, its signs and sites included, and where the second order of it goes.
struct SecondRequest {
  GridSpec grid;
  /// Half-width of the band, mesh units, finite; 0: the full grid.
  double band = 0;
  const SecondLabels* labels = nullptr;
  const float* distance = nullptr;      ///< one per node, mesh units, of any sign
  const std::uint32_t* site = nullptr;  ///< features; 0xffffffff beyond the band
  float* distance2 = nullptr;           ///< one per node, mesh units
  std::uint32_t* site2 = nullptr;       ///< features; 0xffffffff where there is none

  [[nodiscard]] bool has_band() const { return band > 0; }
};

}  // namespace blum
