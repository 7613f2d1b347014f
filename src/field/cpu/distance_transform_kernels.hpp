// Blum: the passes of the distance transform of images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "field/image_request.hpp"

namespace blum::detail {

/// Number of columns that one task of a column pass processes. In each array they fill a whole number of cache lines.
inline constexpr std::size_t tile_width = 64;

/// Data that all passes of one transform share.
///
/// Between passes, the site array contains packed partial sites. After the x pass, a partial site is the x of the
/// closest voxel in the row. After the y pass, it is `y << x_bits | x` of the closest voxel in the plane. A value with
/// all bits set means none. Values fit in 32 bits, and no site has all bits set, because an image has fewer than 2^31
/// voxels.
///
/// Without sites, the partial sites are in the memory of the distances. The z pass reads all partial sites of a column
/// before it writes distances over them.
struct TransformPlan : ImageRequest {
  std::uint32_t* partial = nullptr;     ///< the site array; the memory of the distances if that is null
  unsigned x_bits = 0;                  ///< number of bits for an x coordinate
  const std::uint64_t* mask = nullptr;  ///< see MaskBits
  std::size_t mask_words_per_row = 0;
  const Context* context = nullptr;  ///< checked for cancellation inside long tasks
};

/// Weighted squares for one axis of length n: table[n - 1 + k] = weight * k^2 for -n < k < n, as int32 or double.
struct SquareTable {
  SquareTable() = default;
  SquareTable(std::size_t length, double weight, bool integer);
  Buffer<std::int32_t> integers;
  Buffer<double> doubles;
};

/// Working memory of one worker, for rows and columns of at most the given lengths.
struct PassScratch {
  explicit PassScratch(std::size_t row_length, std::size_t column_length, bool integer);
  Buffer<std::uint32_t> next_selected, next_other;  ///< one per group of 16 voxels of a row
  Buffer<std::int32_t> integer_costs;               ///< [row][lane]
  Buffer<double> double_costs;
  Buffer<std::int32_t> partial_sites;
  Buffer<std::int32_t> lowest, highest;  ///< per row of the column: smallest and largest closest row over the lanes
};

/// Runs the x pass on the rows [begin, end) of the image; row (y, z) has the number z * size[1] + y.
void transform_rows(const TransformPlan& plan, PassScratch& scratch, std::size_t begin, std::size_t end);

/// Runs the y pass on the columns of plane z whose x lies in [x_begin, x_end).
void transform_columns_y(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t z,
                         std::size_t x_begin, std::size_t x_end);

/// Runs the z pass on the columns at y whose x lies in [x_begin, x_end). This pass writes the final distances and
/// sites. In both the y and the z pass, x_begin must be a multiple of 16.
void transform_columns_z(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t y,
                         std::size_t x_begin, std::size_t x_end);

}  // namespace blum::detail
