// Blum: statistics of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"

namespace blum::cli {

struct KindCount {
  std::uint64_t nodes = 0;  ///< number of nodes whose closest site is of this kind
  std::uint64_t sites = 0;  ///< number of different sites that are closest to some node
};

/// Statistics of the second order of a field.
struct SecondStatistics {
  std::optional<float> minimum, maximum;  ///< range of second distances; unset if no node has a second site
  std::uint64_t nodes_without = 0;        ///< number of nodes without a second site, including those beyond the band
};

struct FieldStatistics {
  float minimum = 0;
  float maximum = 0;
  std::uint64_t inside_nodes = 0;    ///< number of nodes with distance < 0
  std::uint64_t siteless_nodes = 0;  ///< number of nodes without a closest site, that is, beyond the band
  KindCount all;
  /// Indexed by SiteKind; set only if the field's site ids are features and `sites` is given.
  std::array<KindCount, 3> kinds;
  std::optional<SecondStatistics> second;  ///< only for fields of order 2
};

/// @param sites  the mesh's sites, if the field's site ids are features; else null.
/// Cost: a few passes over the field, and one bit for each site.
[[nodiscard]] FieldStatistics field_statistics(const Field& field, const SiteTable* sites, const Context& context);

}  // namespace blum::cli
