// Blum: voxels of images and their squared distances, for kernels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/image_request.hpp"
#include "field/kernels/host_device.hpp"

namespace blum::kernels {

/// Index without a voxel. Linear indices of voxels are below 2^31.
inline constexpr std::uint32_t no_voxel = 0xffffffffU;

/// Divides numbers below 2^31 by a fixed divisor, with a multiplication and a shift.
struct Divisor {
  std::uint32_t factor = 0x80000001U;
  std::uint32_t shift = 31;

  Divisor() = default;
  explicit Divisor(std::uint32_t by) {
    // factor = floor(2^shift / by) + 1 exceeds 2^shift / by by a relative error of at most by / 2^shift <= 2^-31. So
    // the quotient errs by less than 1 / by before it is rounded down.
    shift = by == 1 ? 31 : 32 + highest_bit(by - 1);
    factor = static_cast<std::uint32_t>((std::uint64_t{1} << shift) / by + 1);
  }
  [[nodiscard]] BLUM_HD std::uint32_t quotient(std::uint32_t x) const {
    return static_cast<std::uint32_t>((std::uint64_t{x} * factor) >> shift);
  }
};

/// Position of a voxel. Axes are those of the request (those of length one come last).
struct Voxel {
  std::uint32_t x, y, z;
};

/// Shape of a request's image, and its mask of selected voxels. Voxel x of a row is bit x % 32 of word x / 32 of the
/// row.
struct ImageShape {
  std::uint32_t size[3] = {1, 1, 1};
  std::uint32_t plane = 1;  ///< voxels per slice
  Divisor by_row, by_plane;
  bool is_signed = true;
  std::uint32_t words_per_row = 1;
  const std::uint32_t* mask = nullptr;

  ImageShape() = default;
  explicit ImageShape(const detail::ImageRequest& request) : is_signed(request.is_signed) {
    for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = static_cast<std::uint32_t>(request.size[axis]);
    plane = size[0] * size[1];
    by_row = Divisor(size[0]);
    by_plane = Divisor(plane);
    words_per_row = (size[0] + 31) / 32;
  }
  [[nodiscard]] BLUM_HD std::uint32_t rows() const { return size[1] * size[2]; }
  [[nodiscard]] std::size_t mask_words() const { return std::size_t{rows()} * words_per_row; }
  [[nodiscard]] BLUM_HD Voxel voxel(std::uint32_t index) const {
    const std::uint32_t z = by_plane.quotient(index);
    const std::uint32_t in_plane = index - z * plane;
    const std::uint32_t y = by_row.quotient(in_plane);
    return {in_plane - y * size[0], y, z};
  }
  [[nodiscard]] BLUM_HD bool is_selected(const Voxel& at) const {
    const std::size_t row = std::size_t{at.z} * size[1] + at.y;
    return ((mask[row * words_per_row + at.x / 32] >> (at.x % 32)) & 1U) != 0;
  }
};

/// Parabola over the rows of a column. The parabola's height at a row is the squared distance to `site`: `cost` +
/// weight * (row - this row)^2.
template <class Value>
struct Parabola {
  std::uint32_t row = 0;
  std::uint32_t site = no_voxel;
  Value cost = 0;
};

BLUM_HD inline std::int32_t offset(std::uint32_t to, std::uint32_t from) {
  return static_cast<std::int32_t>(to - from);
}

/// Squared distances as integers below 2^30. They are exact.
struct IntegerCosts {
  using Value = std::int32_t;
  static constexpr bool is_exact = true;
  static constexpr Value slack = 0;
  Value weight[3];
  bool exact_in_float;
  double unit;

  explicit IntegerCosts(const detail::ImageRequest& request)
      : exact_in_float(request.exact_in_float), unit(request.unit) {
    for (std::size_t axis = 0; axis < 3; ++axis) weight[axis] = static_cast<Value>(request.weight[axis]);
  }
  [[nodiscard]] BLUM_HD Value square(std::size_t axis, std::int32_t step) const { return step * step * weight[axis]; }
  [[nodiscard]] BLUM_HD static Value sum(Value a, Value b) { return a + b; }
  /// Returns true if the parabola b is nowhere lower than both a and c. The rows must satisfy a < b < c.
  [[nodiscard]] BLUM_HD bool hides(std::size_t axis, const Parabola<Value>& a, const Parabola<Value>& b,
                                   const Parabola<Value>& c) const {
    const std::int32_t from_a = offset(b.row, a.row);
    const std::int32_t to_c = offset(c.row, b.row);
    return std::int64_t{rise(axis, a, b)} * to_c >= std::int64_t{rise(axis, b, c)} * from_a;
  }
  [[nodiscard]] BLUM_HD float distance(Value squared) const {
    if (exact_in_float) return root(static_cast<float>(squared)) * static_cast<float>(unit);
    return static_cast<float>(root(static_cast<double>(squared)) * unit);
  }

 private:
  /// Returns the height of b minus that of a at row 0. All heights are below 2^30. The two parabolas meet at row rise /
  /// (2 weight step).
  [[nodiscard]] BLUM_HD Value rise(std::size_t axis, const Parabola<Value>& a, const Parabola<Value>& b) const {
    return b.cost - a.cost + weight[axis] * offset(b.row, a.row) * static_cast<std::int32_t>(a.row + b.row);
  }
};

/// Squared distances in double, rounded as on the CPU. A parabola is dropped only if it is certainly higher than the
/// other parabolas, rounding included. If several are about equally low, all of them are evaluated.
struct RealCosts {
  using Value = double;
  static constexpr bool is_exact = false;
  Value slack = 0;  ///< a multiple of the rounding error of squared distances
  Value weight[3];
  double unit;

  explicit RealCosts(const detail::ImageRequest& request) : unit(request.unit) {
    constexpr double rounding = 1.0 / (std::uint64_t{1} << 46U);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      weight[axis] = request.weight[axis];
      const auto extent = static_cast<double>(request.size[axis] - 1);
      slack += rounding * weight[axis] * extent * extent;
    }
  }
  [[nodiscard]] BLUM_HD Value square(std::size_t axis, std::int32_t step) const {
    return rounded_product(rounded_product(step, step), weight[axis]);
  }
  [[nodiscard]] BLUM_HD static Value sum(Value a, Value b) { return rounded_sum(a, b); }
  [[nodiscard]] BLUM_HD bool hides(std::size_t axis, const Parabola<Value>& a, const Parabola<Value>& b,
                                   const Parabola<Value>& c) const {
    const double from_a = offset(b.row, a.row);
    const double to_c = offset(c.row, b.row);
    // At every row, the height of b minus that of the lower of a and c is at least this value / (from_a + to_c).
    return rise(axis, a, b) * to_c - rise(axis, b, c) * from_a >= slack * (from_a + to_c);
  }
  [[nodiscard]] BLUM_HD float distance(Value squared) const {
    return static_cast<float>(rounded_product(root(squared), unit));
  }

 private:
  [[nodiscard]] BLUM_HD Value rise(std::size_t axis, const Parabola<Value>& a, const Parabola<Value>& b) const {
    return b.cost - a.cost + weight[axis] * offset(b.row, a.row) * (static_cast<double>(a.row) + b.row);
  }
};

}  // namespace blum::kernels
