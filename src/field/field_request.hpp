// Blum: request for the field of a mesh, from options to kernels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/sign/method.hpp"

namespace blum {

/// Request for a field, and the memory of its result. make_field_request() makes it once. It is passed on unchanged to
/// the tiles of the CPU, and across the border of the CUDA module to its kernels. The module has no other description
/// of a field. Only the memory changes on the way, when a slab of the grid goes to memory of its own.
///
/// A new option of fields needs a member here. The struct is plain memory; cuda::module_version counts its layouts.
struct FieldRequest {
  GridSpec grid;
  /// Half-width of the band, mesh units, finite; 0: the full grid.
  double band = 0;
  /// One distance per node, x fastest, mesh units; +-band beyond the band.
  float* distance = nullptr;
  /// Closest sites, one per node; 0xffffffff beyond the band. Null if not wanted.
  std::uint32_t* site = nullptr;
  /// Method of the signs; sign::Plan explains it and `level`. A back end may leave signs to others: see FieldResult.
  sign::Method sign = sign::Method::none;
  /// Kind of site ids in a device's memory. In the host's memory they are features until the signs are found.
  SiteIds site_ids = SiteIds::features;
  std::int32_t level = 0;

  [[nodiscard]] bool has_band() const { return band > 0; }
};
static_assert(std::is_standard_layout_v<FieldRequest> && std::is_trivially_copyable_v<FieldRequest>);

}  // namespace blum
