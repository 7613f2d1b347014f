// Blum: voxel image files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/warning.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/formats.hpp"

namespace blum {

/// Image, with the warnings and the format that its reader found.
struct ImageFile {
  VoxelImage image = {};
  /// Warnings that two frames (positions of voxels) in the file disagree, or that a frame cannot be used
  /// (WarningCode::left_out). Each warning names both frames, and the frame that the image has.
  std::vector<Warning> warnings = {};
  std::optional<ImageFormat> format = {};  ///< format of the file; readers always set it
};

/// Reads a 3D image of scalars. Values keep the type that they have in the file, unless the list below says otherwise.
/// Spacing, origin and direction are those of the file, in the world axes and units of the file. The name of the unit
/// is not read (xyzt_units in NIfTI, "units" and "space units" in NRRD). A 2D image becomes an image with one layer.
///
///   `.nrrd`, `.nhdr`  NRRD 1 to 5 in either byte order, with raw, gzip or text data. The data are in the same file or
///                     in one other file. Line skip and byte skip are supported. The geometry is given by "space
///                     directions", "space origin" and "space" (VoxelImage::space), or else by "spacings" and "axis
///                     mins" and "axis maxs". NaN means unknown: an unknown spacing becomes 1, and an unknown origin 0.
///                     Axes without a direction ("none"), and axes whose kind counts components (vector, colour,
///                     matrix), must have one entry, and are removed. If more than three axes remain, axes with one
///                     entry are removed, too. Axes of all other kinds are treated like spatial axes.
///   `.nii`, `.hdr` with `.img`, each also with `.gz`
///                     NIfTI-1 and 2, in either byte order. The geometry is given by the sform if it is set, else by
///                     the qform if that is set, else by the spacings alone. If the sform has shear, the qform is used
///                     instead. Shear without a qform is an error. read_image_file() warns if sform and qform (or the
///                     spacings) place a corner more than 0.1 voxels apart. If either form is used, the space is
///                     right-anterior-superior. If the file has a scale (scl_slope, scl_inter), values become double. A
///                     slope of 0, NaN or infinity is ignored. Sizes along dimensions beyond the third must be 1.
///   `.npy`            Arrays of one to three axes, indexed [z, y, x], in C or Fortran order, and in either byte order.
///                     Type bool becomes uint8. The spacing is 1, and the origin 0.
///   `.vol`            The Vol format of DGtal and simplevol: a text header and one byte per voxel. In Version 3, these
///                     bytes are compressed by zlib; in Version 2, they are not. The spacing is 1, and the origin 0.
///                     The Center fields are ignored, because programs that write them disagree on their meaning.
///
/// Direction vectors that are perpendicular unit vectors up to rounding (1e-4) are replaced by the nearest exact unit
/// vectors. Other direction vectors are an error. Bytes after the last value are ignored, except for checksums, which
/// must match.
/// @throws FileError if the file cannot be read.
/// @throws FormatError with the file and the reason, if the content is wrong or not supported, or if the image has more
/// than 2^31 - 1 voxels.
/// @throws InvalidOption for another extension.
/// @throws OutOfMemory. Sizes in a header are compared with the length of the file before memory is allocated.
/// Cost: O(voxels) time. Memory in addition to the image is needed only for values that are text, scaled or in Fortran
/// order.
[[nodiscard]] VoxelImage read_image(const std::filesystem::path& path);

/// Reads an image from memory. In messages, `name` is used as the name of the file. An image whose data are in another
/// file is rejected.
[[nodiscard]] VoxelImage read_image(std::span<const std::byte> bytes, ImageFormat format,
                                    const std::string& name = "image");

/// Read an image as read_image() does, and also return warnings.
[[nodiscard]] ImageFile read_image_file(const std::filesystem::path& path);
[[nodiscard]] ImageFile read_image_file(std::span<const std::byte> bytes, ImageFormat format,
                                        const std::string& name = "image");

/// Writes an image as .nrrd (raw data, with geometry and space) or .npy (values only), in the byte order of the
/// machine. The file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws InvalidImage if validate(image) rejects the image.
/// @throws FileError.
void write_image(const std::filesystem::path& path, const VoxelImageView& image);

}  // namespace blum
