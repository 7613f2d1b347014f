// Blum: voxel images of Python. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>

#include "arrays.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::python {

using ValuesIn = nb::ndarray<nb::ro, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

/// An image whose values are an array of Python, indexed [z, y, x].
struct ImageArrays {
  ValuesIn values;
  VoxelImageView view;
};

/// @throws nanobind::type_error for values of another type than VoxelImageView knows.
[[nodiscard]] ImageArrays image_arrays(ValuesIn values, const GridSpec& grid, std::string space);

/// (values [z, y, x], grid, space).
[[nodiscard]] nb::tuple image_of(VoxelImage image);

/// The voxels that are true, of an array [z, y, x] of bytes.
using MaskIn = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
[[nodiscard]] VoxelSet voxel_set(const MaskIn& mask);
/// The other way round.
[[nodiscard]] Out<std::uint8_t> mask_of(const VoxelSet& voxels);

}  // namespace blum::python
