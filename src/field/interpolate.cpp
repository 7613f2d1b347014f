#include "blum/field/interpolate.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

constexpr std::size_t points_per_range = 4096;
/// Largest distance beyond the grid's border at which a point still counts as on the border. This distance covers
/// rounding. Unit: grid steps times the number of layers.
constexpr double rounding = 1e-9;

/// The two layers around a coordinate, and its relative position between them, 0 to 1.
struct Between {
  std::int64_t before = 0;
  std::int64_t after = 0;
  double part = 0;
};

/// Returns the layers around a position; nullopt if the position is outside of the grid.
/// @param at    position in steps, counted from the first layer.
/// @param size  number of layers.
std::optional<Between> between_layers(double at, std::int64_t size) {
  if (size == 1) return std::abs(at) <= 0.5 ? std::optional(Between{}) : std::nullopt;
  const auto last = static_cast<double>(size - 1);
  const double slack = rounding * static_cast<double>(size);
  if (!(at >= -slack && at <= last + slack)) return std::nullopt;
  const auto before = static_cast<std::int64_t>(std::fmin(std::fmax(std::floor(at), 0.0), last - 1));
  return Between{before, before + 1, std::fmin(std::fmax(at - static_cast<double>(before), 0.0), 1.0)};
}

/// Interpolates linearly between two values. At each end it returns exactly that end's value, even if a value is
/// infinite.
double mix(double a, double b, double part) {
  if (part == 0) return a;
  return part == 1 ? b : a + (b - a) * part;
}

/// Returns the cell (box between eight nodes) around a point; nullopt outside of the grid.
std::optional<std::array<Between, 3>> cell_around(const GridSpec& grid, const Vec3d& point) {
  const Vec3d local = grid.direction.transposed_times(point - grid.origin);
  std::array<Between, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::optional<Between> found = between_layers(local[a] / grid.spacing[a], grid.size[a]);
    if (!found) return std::nullopt;
    axes[a] = *found;
  }
  return axes;
}

/// Returns the values at the corners of a cell. Bit a of a corner's index is 1 if the corner lies in the higher of the
/// two layers along axis a.
std::array<double, 8> corners_of(const GridSpec& grid, std::span<const float> values,
                                 const std::array<Between, 3>& cell) {
  std::array<double, 8> out;
  for (std::size_t c = 0; c < 8; ++c) {
    const auto layer = [&](std::size_t a) { return (c >> a & 1) != 0 ? cell[a].after : cell[a].before; };
    out[c] = static_cast<double>(values[grid.index(layer(0), layer(1), layer(2))]);
  }
  return out;
}

/// Interpolates along x, then along y, then along z.
double mixed(const std::array<double, 8>& v, const std::array<Between, 3>& cell) {
  const auto along_x = [&](std::size_t row) { return mix(v[row], v[row + 1], cell[0].part); };
  const auto along_y = [&](std::size_t slice) { return mix(along_x(slice), along_x(slice + 2), cell[1].part); };
  return mix(along_y(0), along_y(4), cell[2].part);
}

/// Returns the derivative of the interpolated value along an axis, per grid step.
double slope(const std::array<double, 8>& v, const std::array<Between, 3>& cell, std::size_t axis) {
  const std::size_t b = (axis + 1) % 3;
  const std::size_t c = (axis + 2) % 3;
  const auto rise = [&](std::size_t at) { return v[at | std::size_t{1} << axis] - v[at]; };
  const auto along_b = [&](std::size_t at) { return mix(rise(at), rise(at | std::size_t{1} << b), cell[b].part); };
  return mix(along_b(0), along_b(std::size_t{1} << c), cell[c].part);
}

Vec3d gradient_of(const GridSpec& grid, const std::array<double, 8>& corners, const std::array<Between, 3>& cell) {
  Vec3d out;
  for (std::size_t a = 0; a < 3; ++a) out[a] = slope(corners, cell, a) / grid.spacing[a];
  return grid.direction * out;
}

void check(const Field& field) {
  validate(field.grid);
  if (field.distance.size() != field.grid.node_count()) {
    throw InvalidGrid("the field has " + std::to_string(field.distance.size()) + " distances, but its grid has " +
                      std::to_string(field.grid.node_count()) + " nodes");
  }
}

/// Calls take(point, cell, values at the cell's corners) for each point inside the grid.
template <class Take>
void for_each_cell(const Field& field, std::span<const Vec3d> points, const Context& context, const Take& take) {
  check(field);
  std::atomic<std::size_t> offender{points.size()};
  parallel_for(context, points.size(), points_per_range, "interpolate", [&](const WorkRange& range) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      if (is_finite(points[p])) {
        const std::optional<std::array<Between, 3>> cell = cell_around(field.grid, points[p]);
        if (cell) take(p, *cell, corners_of(field.grid, field.distance.span(), *cell));
        continue;
      }
      std::size_t known = offender;
      while (p < known && !offender.compare_exchange_weak(known, p)) {
      }
      return;
    }
  });
  if (offender < points.size()) throw InvalidOption("point " + std::to_string(offender) + " is not finite");
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<double> interpolate(const Field& field, std::span<const Vec3d> points, const Context& context) {
  std::vector<double> values(points.size(), nan);
  for_each_cell(field, points, context,
                [&](std::size_t p, const auto& cell, const auto& corners) { values[p] = mixed(corners, cell); });
  return values;
}

InterpolatedGradients interpolate_with_gradient(const Field& field, std::span<const Vec3d> points,
                                                const Context& context) {
  InterpolatedGradients out{std::vector<double>(points.size(), nan),
                            std::vector<Vec3d>(points.size(), Vec3d{nan, nan, nan})};
  for_each_cell(field, points, context, [&](std::size_t p, const auto& cell, const auto& corners) {
    out.value[p] = mixed(corners, cell);
    out.gradient[p] = gradient_of(field.grid, corners, cell);
  });
  return out;
}

}  // namespace blum
