#include "field/sign_agreement.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

/// Whether any pair a[i], b[i] disagrees although they add up to more than the limit. Written for the vectoriser.
bool has_conflict(const float* a, const float* b, std::int64_t count, float limit) {
  int conflicts = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    conflicts |= static_cast<int>(std::signbit(a[i]) != std::signbit(b[i])) &
                 static_cast<int>(std::abs(a[i]) + std::abs(b[i]) > limit);
  }
  return conflicts != 0;
}

}  // namespace

bool signs_agree(const Field& field, double diagonal, const Context& context) {
  const GridSpec& grid = field.grid;
  const double slack = 4e-6 * diagonal;
  const std::array<float, 3> limit{static_cast<float>(grid.spacing.x + slack),
                                   static_cast<float>(grid.spacing.y + slack),
                                   static_cast<float>(grid.spacing.z + slack)};
  const std::int64_t width = grid.size[0];
  const std::int64_t rows = grid.size[1] * grid.size[2];
  std::atomic<bool> agree{true};
  parallel_for(context, static_cast<std::size_t>(rows), 64, "", [&](const WorkRange& range) {
    for (std::size_t r = range.begin; r < range.end; ++r) {
      const auto row = static_cast<std::int64_t>(r);
      const float* here = field.distance.data() + row * width;
      bool conflict = has_conflict(here, here + 1, width - 1, limit[0]);
      if (row % grid.size[1] + 1 < grid.size[1])
        conflict = conflict || has_conflict(here, here + width, width, limit[1]);
      if (row / grid.size[1] + 1 < grid.size[2]) {
        conflict = conflict || has_conflict(here, here + width * grid.size[1], width, limit[2]);
      }
      if (conflict) agree = false;
    }
  });
  return agree;
}

}  // namespace blum
