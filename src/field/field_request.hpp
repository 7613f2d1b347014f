// Blum: what a field of a mesh is asked for, from options to kernels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/sign/method.hpp"

namespace blum {

/// What a field is asked for and where it goes. Made once, by make_field_request(), and passed on as it is: to the
/// tiles of the CPU, across the border of the CUDA module (which has no other description of a field), and to its
/// kernels. Only the memory changes on the way, where a slab of the grid goes to memory of its own.
///
/// A new option of fields has its member here. Plain memory: cuda::module_version counts its layouts.
struct FieldRequest {
  GridSpec grid;
  /// Half-width of the band, mesh units, finite; 0: the full grid.
  double band = 0;
  /// One per node, x fastest, mesh units; +-band beyond the band.
  float* distance = nullptr;
  /// The closest sites, one per node; 0xffffffff beyond the band. Null where they are not wanted.
  std::uint32_t* site = nullptr;
  /// How nodes get their signs; see sign::Plan, also for the level. A back end may leave that to others: FieldResult.
  sign::Method sign = sign::Method::none;
  /// What sites count in a device's memory. In the host's memory they count features, until the signs are there.
  SiteIds site_ids = SiteIds::features;
  std::int32_t level = 0;

  [[nodiscard]] bool has_band() const { return band > 0; }
};
static_assert(std::is_standard_layout_v<FieldRequest> && std::is_trivially_copyable_v<FieldRequest>);

}  // namespace blum
