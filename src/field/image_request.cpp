#include "field/image_request.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum::detail {
namespace {

/// Spacings as integer multiples of a common unit.
struct CommonUnit {
  std::uint64_t multiple[3] = {1, 1, 1};
  double unit = 1;
};

/// Finds the common unit of spacings: a power of two times the greatest common divisor of their mantissas. A common
/// unit exists for any three doubles whose exponents differ little enough. Returns false if the multiples do not fit in
/// their integer type.
bool find_common_unit(const double (&spacing)[3], int used, CommonUnit& common) {
  int lowest_exponent = std::numeric_limits<int>::max();
  int exponents[3] = {};
  std::uint64_t mantissas[3] = {};
  for (int axis = 0; axis < used; ++axis) {
    mantissas[axis] = static_cast<std::uint64_t>(std::ldexp(std::frexp(spacing[axis], &exponents[axis]), 53));
    const int zeros = std::countr_zero(mantissas[axis]);
    mantissas[axis] >>= static_cast<unsigned>(zeros);
    exponents[axis] += zeros - 53;
    lowest_exponent = std::min(lowest_exponent, exponents[axis]);
  }
  std::uint64_t divisor = 0;
  for (int axis = 0; axis < used; ++axis) {
    const int shift = exponents[axis] - lowest_exponent;
    if (shift > std::countl_zero(mantissas[axis])) return false;
    common.multiple[axis] = mantissas[axis] << static_cast<unsigned>(shift);
    divisor = std::gcd(divisor, common.multiple[axis]);
  }
  for (int axis = 0; axis < used; ++axis) common.multiple[axis] /= divisor;
  common.unit = std::ldexp(static_cast<double>(divisor), lowest_exponent);
  return true;
}

/// Returns the largest squared distance in the image, in units of unit^2.
double largest_square(const ImageRequest& request) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto extent = static_cast<double>(request.size[axis] - 1);
    sum += request.weight[axis] * extent * extent;
  }
  return sum;
}

bool is_power_of_two(double value) {
  int exponent = 0;
  return std::frexp(value, &exponent) == 0.5;
}

/// Chooses integer arithmetic for squared distances if the spacings allow it.
void choose_arithmetic(ImageRequest& request, const double (&spacing)[3], int used) {
  constexpr double integer_limit = 1 << 30;
  constexpr double float_limit = 1 << 24;
  CommonUnit common;
  if (find_common_unit(spacing, used, common)) {
    // The scaled root is correctly rounded only if the unit is a power of two. For another integer unit, the unit is
    // multiplied into the weights and set to 1.
    const double whole = std::round(common.unit);
    const bool undivided = whole == common.unit && whole > 1 && whole < 1024 && !is_power_of_two(whole);
    for (const double factor : {undivided ? whole : 1.0, 1.0}) {
      for (int axis = 0; axis < used; ++axis) {
        const double multiple = factor * static_cast<double>(common.multiple[axis]);
        request.weight[axis] = multiple * multiple;
      }
      request.unit = common.unit / factor;
      const double largest = largest_square(request);
      request.integer = largest < integer_limit;
      request.exact_in_float =
          largest < float_limit && is_power_of_two(request.unit) && request.unit > 1e-30 && request.unit < 1e30;
      if (request.integer) return;
    }
  }
  request.integer = false;
  request.exact_in_float = false;
  request.unit = 1;
  // Spacings are divided by the largest one, so that squares neither overflow nor vanish.
  const double scale = *std::max_element(spacing, spacing + used);
  for (int axis = 0; axis < used; ++axis) request.weight[axis] = (spacing[axis] / scale) * (spacing[axis] / scale);
  request.unit = scale;
}

/// Rejects grids whose extent makes float32 distances infinite or all zero.
void check_extent(const GridSpec& grid) {
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] == 1) continue;
    longest = std::max(longest, grid.spacing[axis] * static_cast<double>(grid.size[axis]));
  }
  if (longest == 0) return;  // the image has a single voxel
  if (longest >= 1e-36 && longest < 1e37) return;
  throw InvalidImage("the image spans " + exact_text(longest) +
                     " units, but 32-bit distances hold 1e-36 to 1e37: give its spacing in other units");
}

}  // namespace

ImageRequest make_image_request(const GridSpec& grid, const DistanceTransformOptions& options) {
  ImageRequest request;
  double spacing[3] = {1, 1, 1};
  int used = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] == 1) continue;
    request.size[used] = static_cast<std::size_t>(grid.size[axis]);
    spacing[used] = grid.spacing[axis];
    ++used;
  }
  check_extent(grid);
  choose_arithmetic(request, spacing, std::max(used, 1));
  request.is_signed = options.is_signed;
  request.selection = options.selection;
  if (options.band) {
    const double band = *options.band;
    if (!(band > 0)) throw InvalidOption("the band must be a positive width, not " + exact_text(band));
    request.has_band = band < static_cast<double>(std::numeric_limits<float>::max());
    if (request.has_band) {
      // Rounded to float like distances, so that a distance equal to the band is within it.
      request.band = static_cast<float>(band);
    }
  }
  return request;
}

}  // namespace blum::detail
