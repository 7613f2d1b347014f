// Blum: voxel image files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "blum/core/error.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/formats.hpp"

namespace blum {

/// Reads a 3D image of scalars. Values keep the type that they have in the file, except as said below; the image's
/// spacing, origin and direction are the file's, in its own world axes and units. A 2D image becomes one layer.
///
///   .nrrd, .nhdr  NRRD 1 to 5: raw, gzip and text data, attached or in one other file, line and byte skip, either byte
///                 order. "space directions" with "space origin" and "space" (VoxelImage::space), or else "spacings"
///                 with "axis mins"; a spacing or an origin of NaN is not known and becomes 1 or 0. An axis without a
///                 direction ("none"), or whose kind counts components (vector, colour, matrix), must have one entry
///                 and is left out; further axes of one entry are left out beyond three. Other kinds are not looked at.
///   .nii, .hdr with .img, each also with .gz
///                 NIfTI-1 and 2, either byte order. The sform where it is set and has no shear, else the qform, else
///                 the spacings alone; with either form the space is right-anterior-superior. Values with a scale
///                 (scl_slope, scl_inter) become double; a slope of 0, NaN or infinity is none. Dimensions beyond three
///                 must be 1.
///   .npy          Arrays indexed [z, y, x], of one to three axes, in C or Fortran order, either byte order, bool as
///                 uint8. Spacing 1, origin 0.
///   .vol          Vol of DGtal and simplevol: a text header, then bytes (Version 2) or the same compressed by zlib
///                 (Version 3). Spacing 1, origin 0; its Center fields are not looked at, since writers disagree on
///                 what they mean.
///
/// Axes that are perpendicular and unit vectors up to rounding (1e-4) are replaced by the nearest ones that are exactly
/// so; others are an error. Bytes behind the last value are not looked at, except checksums.
/// @throws FileError when the file cannot be read; FormatError, naming the file and the reason, when its content is
/// wrong or of a kind that is not read; InvalidOption for another extension; also above 2^31 - 1 voxels;
/// OutOfMemory. What a header promises is compared with the length of the file before memory is taken for it.
/// Cost: O(voxels) time; no memory beyond the image, but for text, scaled and Fortran-ordered values.
[[nodiscard]] VoxelImage read_image(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages. Data in another file are refused.
[[nodiscard]] VoxelImage read_image(std::span<const std::byte> bytes, ImageFormat format,
                                    const std::string& name = "image");

/// Writes an image as .nrrd (raw data; keeps geometry and space) or .npy (values only), in the byte order of the
/// machine. The file appears under its name only when it is complete.
/// @throws InvalidOption for another extension; InvalidImage unless validate(image) passes; FileError.
void write_image(const std::filesystem::path& path, const VoxelImageView& image);

}  // namespace blum
