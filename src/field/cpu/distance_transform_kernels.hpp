// Blum: the passes of the distance transform of images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "field/image_request.hpp"

namespace blum::detail {

/// Number of columns that one task of a column pass takes: a whole number of cache lines of each array.
inline constexpr std::size_t tile_width = 64;

/// Data that all passes of one transform share.
///
/// Between passes the site array holds packed partial sites. After the x pass, these are the closest x in the row.
/// After the y pass, they are `y << x_bits | x` of the closest voxel in the plane. All ones stand for none. Both fit 32
/// bits, and all ones is not a site, because an image has fewer than 2^31 voxels.
struct TransformPlan : ImageRequest {
  unsigned x_bits = 0;                  ///< bits that hold an x coordinate
  const std::uint64_t* mask = nullptr;  ///< see MaskBits
  std::size_t mask_words_per_row = 0;
  const Context* context = nullptr;  ///< checked for cancellation inside long tasks
};

/// The squares of an axis: table[n - 1 + k] = weight * k^2 for -n < k < n, as int32 or double.
struct SquareTable {
  SquareTable() = default;
  SquareTable(std::size_t length, double weight, bool integer);
  Buffer<std::int32_t> integers;
  Buffer<double> doubles;
};

/// Working memory of one worker, for rows and columns of up to these lengths.
struct PassScratch {
  explicit PassScratch(std::size_t row_length, std::size_t column_length, bool integer);
  Buffer<std::uint32_t> next_selected, next_other;  ///< per 16 voxels of a row
  Buffer<std::int32_t> integer_costs;               ///< [row][lane]
  Buffer<double> double_costs;
  Buffer<std::int32_t> partial_sites;
  Buffer<std::int32_t> lowest, highest;  ///< per row of the column: range of the closest rows, over lanes
};

/// Runs the x pass on rows [begin, end) of the image, numbered z * size[1] + y.
void transform_rows(const TransformPlan& plan, PassScratch& scratch, std::size_t begin, std::size_t end);

/// Runs the y pass on the columns of plane z whose x lies in [x_begin, x_end).
void transform_columns_y(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t z,
                         std::size_t x_begin, std::size_t x_end);

/// Runs the z pass, which also writes the final distances and sites, on the columns at y whose x lies in [x_begin,
/// x_end). Its x_begin must be a multiple of 16 here and in the y pass.
void transform_columns_z(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t y,
                         std::size_t x_begin, std::size_t x_end);

}  // namespace blum::detail
