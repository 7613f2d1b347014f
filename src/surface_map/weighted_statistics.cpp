#include "surface_map/weighted_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace blum::surface {

double root_mean_square(std::span<const double> values, std::span<const double> weights, double largest, double sum) {
  if (!(largest > 0)) return 0;
  LongSum square;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double part = values[k] / largest;
    square.add(weights[k] * part * part);
  }
  return largest * std::sqrt(square.value() / sum);
}

std::array<double, 7> percentiles(std::span<const double> values, std::span<const double> weights, double sum,
                                  const std::array<double, 7>& percents) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return values[a] != values[b] ? values[a] < values[b] : a < b; });
  std::array<double, 7> out{};
  std::size_t next = 0;
  double below = 0;
  for (const std::uint32_t k : order) {
    below += weights[k];
    while (next < out.size() && below >= sum * percents[next] / 100) out[next++] = values[k];
  }
  while (next < out.size()) out[next++] = values[order.back()];
  return out;
}

}  // namespace blum::surface
