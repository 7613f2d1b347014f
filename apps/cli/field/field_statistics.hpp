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
  std::uint64_t nodes = 0;  ///< nodes whose closest site is of this kind
  std::uint64_t sites = 0;  ///< distinct sites that are closest to some node
};

/// Statistics of the second order of a field.
struct SecondStatistics {
  std::optional<float> minimum, maximum;  ///< distances; unset if no node has a second site
  std::uint64_t nodes_without = 0;        ///< nodes without a second site (or beyond the band)
};

struct FieldStatistics {
  float minimum = 0;
  float maximum = 0;
  std::uint64_t inside_nodes = 0;    ///< distance < 0
  std::uint64_t siteless_nodes = 0;  ///< beyond the band
  KindCount all;
  std::array<KindCount, 3> kinds;          ///< by SiteKind; only if the field's sites are features and `sites` is given
  std::optional<SecondStatistics> second;  ///< only for fields of order 2
};

/// @param sites  the mesh's sites if the field's site values are features; else null.
/// Cost: a few passes over the field, and one bit for each site.
[[nodiscard]] FieldStatistics field_statistics(const Field& field, const SiteTable* sites, const Context& context);

}  // namespace blum::cli
