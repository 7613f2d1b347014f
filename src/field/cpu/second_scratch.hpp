// Blum: what a tile of the second order keeps in memory. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "field/cpu/second_kernel.hpp"
#include "field/cpu/tile_scratch.hpp"

namespace blum::cpu {

/// Whole numbers of prepared candidates, read lane by lane.
class LeafWords {
 public:
  void reset(std::size_t columns, std::size_t capacity) {
    stride_ = (capacity + 31) / 16 * 16;
    if (values_.size() < columns * stride_) values_ = Buffer<std::uint32_t>(columns * stride_ * 2);
  }
  [[nodiscard]] std::uint32_t* column(std::size_t c) { return values_.data() + c * stride_; }
  [[nodiscard]] const std::uint32_t* column(std::size_t c) const { return values_.data() + c * stride_; }

 private:
  Buffer<std::uint32_t> values_;
  std::size_t stride_ = 0;
};

struct SecondScratch::Impl {
  TileScratch tile;
  std::array<LeafWords, 3> labels;   ///< of the candidates of a box of 8^3 nodes; vertices have one, edges two
  std::array<LeafWords, 3> allowed;  ///< of the leaf at hand: a bit for each first site beside which they may be second
  std::array<std::vector<std::uint16_t>, 3> saved_bits;
  std::vector<std::uint32_t> links;  ///< of the first site at hand
  std::vector<float> link_distances;
};

}  // namespace blum::cpu
