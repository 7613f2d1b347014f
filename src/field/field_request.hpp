// Blum: request for the field of a mesh, from options to kernels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/sign/method.hpp"

namespace blum {

/// Request for a field, and the memory of its result. make_field_request() creates it once. The request is passed
/// unchanged to the tiles of the CPU, or to the CUDA module and its kernels. The module has no other description of a
/// field. Only the memory is replaced when the CUDA module computes the field in slabs.
///
/// A new option of fields needs a member here. The struct must be plain data; cuda::module_version must change with its
/// layout.
struct FieldRequest {
  GridSpec grid;
  /// Half-width of the band, mesh units, finite. 0: no band; the field is computed on the full grid.
  double band = 0;
  /// One distance per node, x fastest, mesh units. Nodes beyond the band get +-band.
  float* distance = nullptr;
  /// Closest sites, one per node; 0xffffffff beyond the band. Null if sites are not requested.
  std::uint32_t* site = nullptr;
  /// Method of the signs. sign::Plan explains it and `level`. A back end may leave the signs to its caller; see
  /// FieldResult.
  sign::Method sign = sign::Method::none;
  /// Kind of the final site ids. With host memory, back ends write feature ids, which are converted after the signs are
  /// found.
  SiteIds site_ids = SiteIds::features;
  std::int32_t level = 0;

  [[nodiscard]] bool has_band() const { return band > 0; }
};
static_assert(std::is_standard_layout_v<FieldRequest> && std::is_trivially_copyable_v<FieldRequest>);

}  // namespace blum
