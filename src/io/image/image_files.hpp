// Blum: what readers and writers of images share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_image.hpp"
#include "io/bytes/byte_source.hpp"

namespace blum::volume_io {

/// @param data_source  the .img file of a pair; null where the data must follow the header. Each may be
/// gzip-compressed.
[[nodiscard]] VoxelImage read_nifti(const ByteSource& source, const ByteSource* data_source);
[[nodiscard]] VoxelImage read_vol(const ByteSource& source);

/// Writes a header and the values after it, in the machine's byte order; the file appears when it is complete.
void write_values_after(const std::filesystem::path& path, const std::string& header, const VoxelImageView& image);

/// The bytes of a source, decompressed where they begin as a gzip file does.
[[nodiscard]] std::unique_ptr<ByteStream> open_plain_or_gzip(const ByteSource& source);

/// How far the axes of a file may be from perpendicular (cosine), and unit axes from length 1: what rounding to six
/// digits or to float32 leaves, with some room. Such axes are replaced by the nearest perpendicular ones.
inline constexpr double frame_tolerance = 1e-4;

/// Sets spacing and direction of a grid from one vector per index axis: unit vector, and the step along it.
/// @throws FormatError with `name` for steps that are not positive and finite, and for axes that are not perpendicular.
void set_frame(GridSpec& grid, const std::array<Vec3d, 3>& unit_axes, const Vec3d& steps, const std::string& name);

/// The same from the vectors between neighbouring nodes. An axis without one gets step 1 and a direction perpendicular
/// to the others.
void set_frame(GridSpec& grid, const std::array<std::optional<Vec3d>, 3>& steps, const std::string& name);

/// True when the vectors are non-zero, finite and perpendicular within the tolerance.
[[nodiscard]] bool is_perpendicular(const std::array<Vec3d, 3>& axes);

/// The orthonormal matrix nearest to one that is nearly so (polar decomposition by Newton's iteration, Higham 1986).
[[nodiscard]] Mat3 nearest_orthonormal(const Mat3& matrix);

/// @throws FormatError with `name` unless each size is at least 1 and their product at most `limit`.
void check_count(const std::array<std::int64_t, 3>& size, std::uint64_t limit, const std::string& name);

/// Limit for fields, as for grids.
inline constexpr std::uint64_t max_field_nodes = std::uint64_t{1} << 40U;

}  // namespace blum::volume_io
