// Blum: the passes of the distance transform of images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "field/image_request.hpp"

namespace blum::detail {

/// Columns that one task of a column pass takes: a whole number of cache lines of each array.
inline constexpr std::size_t tile_width = 64;

/// What all passes of one transform share.
///
/// Between passes the site array holds packed partial sites: after the x pass the closest x in the row, after the y
/// pass `y << x_bits | x` of the closest voxel in the plane; all ones where there is none. Both fit 32 bits, and all
/// ones is no site, because an image has fewer than 2^31 voxels.
struct TransformPlan : ImageRequest {
  unsigned x_bits = 0;                  ///< bits that hold an x coordinate
  const std::uint64_t* mask = nullptr;  ///< see MaskBits
  std::size_t mask_words_per_row = 0;
  const Context* context = nullptr;  ///< looked at for cancellation inside long tasks
};

/// The squares of an axis: table[n - 1 + k] = weight * k^2 for -n < k < n, as int32 or double.
struct SquareTable {
  SquareTable() = default;
  SquareTable(std::size_t length, double weight, bool integer);
  Buffer<std::int32_t> integers;
  Buffer<double> doubles;
};

/// Working memory of one worker, for axes of up to `length` voxels.
struct PassScratch {
  explicit PassScratch(std::size_t row_length, std::size_t column_length, bool integer);
  Buffer<std::uint32_t> next_selected, next_other;  ///< per 16 voxels of a row
  Buffer<std::int32_t> integer_costs;               ///< [row][lane]
  Buffer<double> double_costs;
  Buffer<std::int32_t> partial_sites;
  Buffer<std::int32_t> lowest, highest;  ///< per row of the column, over lanes: the closest row
};

/// x pass: rows [begin, end) of the image, numbered z * size[1] + y.
void transform_rows(const TransformPlan& plan, PassScratch& scratch, std::size_t begin, std::size_t end);

/// y pass: the columns of plane z whose x lies in [x_begin, x_end).
void transform_columns_y(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t z,
                         std::size_t x_begin, std::size_t x_end);

/// z pass, which also writes the final distances and sites: the columns at y whose x lies in [x_begin, x_end).
/// x_begin must be a multiple of 16 here and in the y pass.
void transform_columns_z(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t y,
                         std::size_t x_begin, std::size_t x_end);

}  // namespace blum::detail
