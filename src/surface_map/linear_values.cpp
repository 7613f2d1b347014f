#include "surface_map/linear_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "blum/core/parallel.hpp"
#include "surface_map/weighted_statistics.hpp"

namespace blum::surface {
namespace {

constexpr std::size_t bins = 1024;

/// Weights of triangles by the range of their values, to find a short interval that contains a percentile.
class Histogram {
 public:
  explicit Histogram(std::span<const LinearValue> values)
      : least_(values.front().lowest), most_(values.front().highest), all_ends_(bins + 1, 0), any_begins_(bins + 1, 0) {
    for (const LinearValue& v : values) {
      least_ = std::min(least_, v.lowest);
      most_ = std::max(most_, v.highest);
    }
    for (const LinearValue& v : values) {
      all_ends_[bin_of(v.highest)] += v.weight;
      any_begins_[bin_of(v.lowest)] += v.weight;
      total_.add(v.weight);
    }
  }

  [[nodiscard]] double total() const { return total_.value(); }
  [[nodiscard]] double range() const { return most_ - least_; }

  /// Returns an interval that contains the value below which a given weight lies. It is up to two bins longer than
  /// needed, so that rounding does no harm.
  [[nodiscard]] std::pair<double, double> around(double weight) const {
    double begun = 0;
    double ended = 0;
    std::size_t first = 0;
    while (first < bins && begun + any_begins_[first] < weight) begun += any_begins_[first++];
    std::size_t last = 0;
    while (last < bins && ended + all_ends_[last] < weight) ended += all_ends_[last++];
    return {first < 1 ? least_ : edge(first - 1), last + 2 > bins ? most_ : edge(last + 2)};
  }

 private:
  [[nodiscard]] double edge(std::size_t bin) const {
    return std::min(least_ + (most_ - least_) * (static_cast<double>(bin) / static_cast<double>(bins)), most_);
  }
  [[nodiscard]] std::size_t bin_of(double value) const {
    const double part = (value - least_) / (most_ - least_);
    return part > 0 ? std::min(static_cast<std::size_t>(part * static_cast<double>(bins)), bins) : 0;
  }

  double least_ = 0;
  double most_ = 0;
  std::vector<double> all_ends_;    ///< for each bin, the weight of triangles whose highest value lies in it
  std::vector<double> any_begins_;  ///< for each bin, the weight of triangles whose lowest value lies in it
  LongSum total_;
};

/// Finds the value below which a given weight lies, by halving of an interval that contains it.
/// @param below   weight of the triangles whose values are all below the interval.
/// @param error     largest error of the result.
/// @param is_upper  true for an upper bound of the value, false for a lower bound.
/// @param active  triangles with values in the interval. The list is changed.
double halve(double low, double high, double wanted, double below, double error, bool is_upper,
             std::vector<LinearValue>& active) {
  while (!active.empty()) {
    double least = active.front().lowest;
    double most = active.front().highest;
    for (const LinearValue& v : active) {
      least = std::min(least, v.lowest);
      most = std::max(most, v.highest);
    }
    low = std::max(low, least);
    high = std::min(high, most);
    const double middle = low + (high - low) / 2;
    if (!(high - low > error && middle > low && middle < high)) break;
    LongSum here;
    for (const LinearValue& v : active) here.add(v.weight * fraction_below(v, middle));
    if (below + here.value() >= wanted) {
      high = middle;
      std::erase_if(active, [&](const LinearValue& v) { return v.lowest > middle; });
    } else {
      low = middle;
      LongSum ended;
      for (const LinearValue& v : active) ended.add(v.highest <= middle ? v.weight : 0);
      below += ended.value();
      std::erase_if(active, [&](const LinearValue& v) { return v.highest <= middle; });
    }
  }
  return is_upper ? high : low;
}

}  // namespace

LinearValue linear_value(double a, double b, double c, double weight) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c, weight};
}

double fraction_below(const LinearValue& triangle, double value) {
  const auto& [a, b, c, weight] = triangle;
  if (value >= c) return 1;
  if (value < a) return 0;
  if (value < b) return (value - a) / (b - a) * ((value - a) / (c - a));
  return 1 - (c - value) / (c - b) * ((c - value) / (c - a));
}

std::vector<double> percentiles(std::span<const LinearValue> values, std::span<const double> percents, double error,
                                bool is_upper, const Context& context) {
  const Histogram histogram(values);
  const double enough = std::max(error, 1e-15 * histogram.range());
  std::vector<double> out(percents.size());
  parallel_for(context, percents.size(), 1, "", [&](const WorkRange& range) {
    const double wanted = histogram.total() * percents[range.begin] / 100;
    const auto [low, high] = histogram.around(wanted);
    std::vector<LinearValue> active;
    LongSum below;
    for (const LinearValue& v : values) {
      if (v.highest < low) {
        below.add(v.weight);
      } else if (v.lowest <= high) {
        active.push_back(v);
      }
    }
    out[range.begin] = halve(low, high, wanted, below.value(), enough, is_upper, active);
  });
  return out;
}

}  // namespace blum::surface
