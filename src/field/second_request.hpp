// Blum: what the second order of a field is asked for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/grid/grid_spec.hpp"
#include "field/second_labels.hpp"

namespace blum {

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
