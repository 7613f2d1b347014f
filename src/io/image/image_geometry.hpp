// Blum: from the axes of image files to grids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::volume_io {

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
