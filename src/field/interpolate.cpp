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
/// How far beyond the outermost nodes rounding may put a point of the border, in steps of the grid.
constexpr double rounding = 1e-9;

/// The layers before and after a coordinate, and how far it is between them.
struct Between {
  std::int64_t before = 0;
  std::int64_t after = 0;
  double part = 0;
};

/// @param at    in steps from the first layer.
/// @param size  number of layers.
std::optional<Between> between_layers(double at, std::int64_t size) {
  if (size == 1) return std::abs(at) <= 0.5 ? std::optional(Between{}) : std::nullopt;
  const auto last = static_cast<double>(size - 1);
  const double slack = rounding * static_cast<double>(size);
  if (!(at >= -slack && at <= last + slack)) return std::nullopt;
  const auto before = static_cast<std::int64_t>(std::fmin(std::fmax(std::floor(at), 0.0), last - 1));
  return Between{before, before + 1, std::fmin(std::fmax(at - static_cast<double>(before), 0.0), 1.0)};
}

/// Between two values, each of which stays exactly what it is at its end, also where it is infinite.
double mix(double a, double b, double part) {
  if (part == 0) return a;
  return part == 1 ? b : a + (b - a) * part;
}

double value_at(const GridSpec& grid, std::span<const float> values, const Vec3d& point) {
  const Vec3d local = grid.direction.transposed_times(point - grid.origin);
  std::array<Between, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::optional<Between> found = between_layers(local[a] / grid.spacing[a], grid.size[a]);
    if (!found) return std::numeric_limits<double>::quiet_NaN();
    axes[a] = *found;
  }
  const Between& x = axes[0];
  const auto along_x = [&](std::int64_t j, std::int64_t k) {
    const std::size_t row = grid.index(0, j, k);
    const auto before = static_cast<double>(values[row + static_cast<std::size_t>(x.before)]);
    return mix(before, static_cast<double>(values[row + static_cast<std::size_t>(x.after)]), x.part);
  };
  const Between& y = axes[1];
  const auto along_y = [&](std::int64_t k) { return mix(along_x(y.before, k), along_x(y.after, k), y.part); };
  return mix(along_y(axes[2].before), along_y(axes[2].after), axes[2].part);
}

}  // namespace

std::vector<double> interpolate(const Field& field, std::span<const Vec3d> points, const Context& context) {
  validate(field.grid);
  if (field.distance.size() != field.grid.node_count()) {
    throw InvalidGrid("the field has " + std::to_string(field.distance.size()) + " distances for " +
                      std::to_string(field.grid.node_count()) + " nodes");
  }
  std::vector<double> values(points.size());
  std::atomic<std::size_t> offender{points.size()};
  parallel_for(context, points.size(), points_per_range, "interpolate", [&](const WorkRange& range) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      if (is_finite(points[p])) {
        values[p] = value_at(field.grid, field.distance.span(), points[p]);
        continue;
      }
      std::size_t known = offender;
      while (p < known && !offender.compare_exchange_weak(known, p)) {
      }
      return;
    }
  });
  if (offender < points.size()) throw InvalidOption("point " + std::to_string(offender) + " is not finite");
  return values;
}

}  // namespace blum
