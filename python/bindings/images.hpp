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

/// Image whose values are a Python array, indexed [z, y, x].
struct ImageArrays {
  ValuesIn values;
  VoxelImageView view;
};

/// @throws nanobind::type_error if the values have a type that VoxelImageView does not support.
[[nodiscard]] ImageArrays image_arrays(ValuesIn values, const GridSpec& grid, std::string space);

/// Returns (values [z, y, x], grid, space).
[[nodiscard]] nb::tuple image_of(VoxelImage image);

/// Array [z, y, x] of bytes. Voxels that are not 0 belong to the set.
using MaskIn = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
[[nodiscard]] VoxelSet voxel_set(const MaskIn& mask);
/// Returns the mask of a set of voxels: 1 if the voxel belongs to it, else 0.
[[nodiscard]] Out<std::uint8_t> mask_of(const VoxelSet& voxels);

}  // namespace blum::python
