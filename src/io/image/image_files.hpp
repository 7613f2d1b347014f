// Blum: shared functions of readers and writers of images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/image_io.hpp"
#include "io/bytes/byte_source.hpp"

namespace blum::volume_io {

/// @param data_source  the .img file of a pair; null if the data follow the header. Both files may be gzip-compressed.
[[nodiscard]] ImageFile read_nifti(const ByteSource& source, const ByteSource* data_source);
[[nodiscard]] VoxelImage read_vol(const ByteSource& source);

/// Writes a header and then the values of an image, in the machine's byte order. The file appears under its name when
/// it is complete.
void write_values_after(const std::filesystem::path& path, const std::string& header, const VoxelImageView& image);

/// Returns a stream of the bytes of a source. They are decompressed if they start like a gzip file.
[[nodiscard]] std::unique_ptr<ByteStream> open_plain_or_gzip(const ByteSource& source);

/// Largest absolute cosine between two axes of a file, and largest deviation of a unit axis from length 1. The limit
/// covers rounding to six digits or to float32. If all axes are within it, they are replaced by the nearest
/// perpendicular ones.
inline constexpr double frame_tolerance = 1e-4;

/// Sets the spacing and direction of a grid. They are given by a unit vector and a step for each index axis.
/// @throws FormatError with `name` if a step is not positive and finite, or if the axes are not perpendicular unit
/// vectors.
void set_frame(GridSpec& grid, const std::array<Vec3d, 3>& unit_axes, const Vec3d& steps, const std::string& name);

/// Sets the spacing and direction of a grid from the vectors between neighbouring nodes. An axis without a vector gets
/// step 1 and a direction perpendicular to the others.
void set_frame(GridSpec& grid, const std::array<std::optional<Vec3d>, 3>& steps, const std::string& name);

/// Returns the first pair of axes that are not perpendicular, with their angle: "axes x and y form an angle of 84
/// degrees". Axes that are zero or not finite are skipped. Returns an empty text if all pairs are perpendicular.
[[nodiscard]] std::string shear_text(const std::array<Vec3d, 3>& axes);

/// Returns the largest distance between the positions of a corner voxel in two frames of an image of one size. The unit
/// is the smallest spacing of `a` among axes with several voxels. The result is NaN if a position is NaN.
[[nodiscard]] double frame_distance(const GridSpec& a, const GridSpec& b);

/// Two frames of a file agree if the positions of each corner voxel are at most this far apart, in voxels. Rounding to
/// float32 and programs that recompute a frame cause such differences.
inline constexpr double largest_frame_distance = 0.1;

/// Returns the orthonormal matrix nearest to a given matrix, which must be nearly orthonormal (polar decomposition by
/// Newton's iteration, Higham 1986).
[[nodiscard]] Mat3 nearest_orthonormal(const Mat3& matrix);

/// @throws FormatError with `name` unless each size is at least 1 and their product is at most `limit`.
void check_count(const std::array<std::int64_t, 3>& size, std::uint64_t limit, const std::string& name);

/// Largest number of nodes of a field. It is the limit of grids.
inline constexpr std::uint64_t max_field_nodes = std::uint64_t{1} << 40U;

}  // namespace blum::volume_io
