// Blum: numbers of the patches of a Voronoi diagram's sites. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/voronoi/voronoi_patches.hpp"

namespace blum::voronoi {

/// For each site, the number of its patch.
class SitePatches {
 public:
  /// @throws InvalidOption if a site has a negative number, or belongs to two patches.
  explicit SitePatches(std::span<const VoronoiPatch> patches) {
    for (std::size_t k = 0; k < patches.size(); ++k) {
      for (const std::int32_t site : patches[k].sites) {
        const auto at = static_cast<std::size_t>(site);
        if (site < 0) throw InvalidOption("patch " + std::to_string(k) + " has site " + std::to_string(site));
        if (at >= of_site_.size()) of_site_.resize(at + 1, outside);
        if (of_site_[at] != outside) throw InvalidOption("site " + std::to_string(site) + " belongs to two patches");
        of_site_[at] = static_cast<std::int32_t>(k);
      }
    }
  }

  /// Returns the patch of a site in the columns `site_a` and `site_b`; -1 for -1, the outside.
  /// @throws InvalidOption if no patch has the site.
  [[nodiscard]] std::int32_t of_side(std::int32_t site) const {
    if (site < 0) return outside;
    const auto at = static_cast<std::size_t>(site);
    if (at < of_site_.size() && of_site_[at] != outside) return of_site_[at];
    throw InvalidOption("no patch has site " + std::to_string(site) +
                        " of the complex: pass the patches of the complex's own sites, from voronoi_patches()");
  }

 private:
  static constexpr std::int32_t outside = -1;
  std::vector<std::int32_t> of_site_;
};

}  // namespace blum::voronoi
