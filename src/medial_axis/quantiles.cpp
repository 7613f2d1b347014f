#include "medial_axis/quantiles.hpp"

#include <utility>

namespace blum {
namespace {

/// The least value up to which a share of the weight lies, by halving; parts that no longer matter are left out.
double quantile(std::vector<LinearPart> parts, double share, double low, double high) {
  constexpr int halvings = 50;
  double missing = 0;  // weight
  for (const LinearPart& part : parts) missing += share * part.weight;
  for (int k = 0; k < halvings && low < high; ++k) {
    const double middle = low + 0.5 * (high - low);
    double sum = 0;
    for (const LinearPart& part : parts) sum += part.weight * part.share_up_to(middle);
    (sum >= missing ? high : low) = middle;
    std::erase_if(parts, [&](const LinearPart& part) {
      if (part.values[2] <= low) missing -= part.weight;
      return part.values[2] <= low || part.values[0] > high;
    });
  }
  return high;
}

}  // namespace

double LinearPart::share_up_to(double value) const {
  const auto [a, b, c] = values;
  if (value >= c) return 1;
  if (value < a) return 0;
  if (is_edge) return (value - a) / (c - a);
  if (value < b) return (value - a) / (b - a) * ((value - a) / (c - a));
  return 1 - (c - value) / (c - b) * ((c - value) / (c - a));
}

void add_quantiles(std::vector<LinearPart> parts, AxisSpread& spread) {
  constexpr double low_share = 0.05;
  double total = 0;
  for (const LinearPart& part : parts) total += part.weight;
  if (!(total > 0)) {
    for (LinearPart& part : parts) part.weight = 1;
  }
  spread.low = quantile(parts, low_share, spread.minimum, spread.maximum);
  spread.median = quantile(std::move(parts), 0.5, spread.minimum, spread.maximum);
}

}  // namespace blum
