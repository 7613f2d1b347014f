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

/// Reads a 3D image of scalars. Values keep their type in the file, with the exceptions below. The image's spacing,
/// origin and direction are the file's, in its own world axes and units. A 2D image becomes one layer.
///
///   `.nrrd`, `.nhdr`  NRRD 1 to 5: raw, gzip and text data, attached or in one other file, line and byte skip, either
///                     byte order. The geometry is "space directions" with "space origin" and "space"
///                     (VoxelImage::space), or else "spacings" with "axis mins". A spacing or an origin of NaN is
///                     unknown and becomes 1 or 0. Some axes must have one entry, and are left out: those without a
///                     direction ("none"), and those whose kind counts components (vector, colour, matrix). If more
///                     than three other axes remain, those of one entry are left out. Other kinds are ignored.
///   `.nii`, `.hdr` with `.img`, each also with `.gz`
///                     NIfTI-1 and 2, either byte order. The geometry is the sform if it is set, else the qform, else
///                     the spacings alone. If the sform has shear, the qform replaces it; without a qform this is an
///                     error. With either form the space is right-anterior-superior. Values with a scale (scl_slope,
///                     scl_inter) become double. A slope of 0, NaN or infinity is ignored. Dimensions beyond three must
///                     be 1.
///   `.npy`            Arrays indexed [z, y, x], of one to three axes, in C or Fortran order, either byte order, bool
///                     as uint8. Spacing 1, origin 0.
///   `.vol`            Vol of DGtal and simplevol: a text header, then bytes (Version 2) or the same compressed by zlib
///                     (Version 3). Spacing 1, origin 0. Its Center fields are ignored, because writers disagree on
///                     their meaning.
///
/// Axes that are perpendicular unit vectors up to rounding (1e-4) are replaced by the nearest exact ones. Others are an
/// error. Bytes after the last value are ignored, except checksums.
/// @throws FileError if the file cannot be read.
/// @throws FormatError that names the file and the reason, if its content is wrong or of a kind that is not read. Also
/// for more than 2^31 - 1 voxels.
/// @throws InvalidOption for another extension.
/// @throws OutOfMemory. Sizes in a header are compared with the length of the file before memory is allocated.
/// Cost: O(voxels) time. It takes no memory beyond the image, except for text, scaled and Fortran-ordered values.
[[nodiscard]] VoxelImage read_image(const std::filesystem::path& path);

/// Reads an image from memory. In messages, `name` stands for the file. Data in another file are rejected.
[[nodiscard]] VoxelImage read_image(std::span<const std::byte> bytes, ImageFormat format,
                                    const std::string& name = "image");

/// Writes an image as .nrrd (raw data; keeps geometry and space) or .npy (values only), in the byte order of the
/// machine. The file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws InvalidImage unless validate(image) passes.
/// @throws FileError.
void write_image(const std::filesystem::path& path, const VoxelImageView& image);

}  // namespace blum
