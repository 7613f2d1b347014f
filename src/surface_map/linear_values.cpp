#include "surface_map/linear_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "blum/core/parallel.hpp"
#include "surface_map/round_values.hpp"
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

  /// Returns an interval that contains the value below which a given weight lies. The interval is up to two bins longer
  /// than needed, so that rounding does no harm.
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

/// Searches the value below which a given weight lies.
class PercentileSearch {
 public:
  /// @param low, high  contain the value.
  /// @param wanted     weight.
  PercentileSearch(std::span<const LinearValue> values, double low, double high, double wanted)
      : low_(low), high_(high), wanted_(wanted) {
    LongSum below;
    for (const LinearValue& v : values) {
      if (v.highest < low) {
        below.add(v.weight);
      } else if (v.lowest <= high) {
        active_.push_back(v);
      }
    }
    below_ = below.value();
    double all = below_;
    for (const LinearValue& v : active_) all += v.weight;
    set_weights(below_, all);
  }

  void set_weights(double low, double high) {
    weight_of_low_ = low;
    weight_of_high_ = high;
  }

  /// Narrows the interval until it is not longer than `error`.
  void run(double error) {
    bool is_halved = true;
    while (!active_.empty()) {
      narrow_to_values();
      const double width = high_ - low_;
      const double middle = low_ + width / 2;
      if (!(width > error && middle > low_ && middle < high_)) return;
      double at = middle;
      if (is_halved) at = std::clamp(interpolated(error), low_ + width / 64, high_ - width / 64);
      divide(at > low_ && at < high_ ? at : middle);
      is_halved = high_ - low_ <= width / 2;
    }
  }

  [[nodiscard]] std::pair<double, double> bounds() const { return {low_, high_}; }
  /// Returns true if a weight that differs from the wanted one by at most `error` would have led to the same bounds.
  [[nodiscard]] bool is_certain(double error) const {
    return weight_of_low_ < wanted_ - error && weight_of_high_ >= wanted_ + error;
  }

 private:
  void narrow_to_values() {
    double least = active_.front().lowest;
    double most = active_.front().highest;
    for (const LinearValue& v : active_) {
      least = std::min(least, v.lowest);
      most = std::max(most, v.highest);
    }
    low_ = std::max(low_, least);
    high_ = std::min(high_, most);
  }

  /// Returns the value that has the wanted weight if the weight changes linearly. The value is moved towards the
  /// further end, so that the next interval is short.
  [[nodiscard]] double interpolated(double error) const {
    const double rise = weight_of_high_ - weight_of_low_;
    const double part = rise > 0 ? std::clamp((wanted_ - weight_of_low_) / rise, 0.0, 1.0) : 0.5;
    const double at = low_ + (high_ - low_) * part;
    return at + (part < 0.5 ? 0.4 : -0.4) * std::max(error, std::min(part, 1 - part) * (high_ - low_) / 8);
  }

  void divide(double at) {
    LongSum here;
    for (const LinearValue& v : active_) here.add(v.weight * fraction_below(v, at));
    const double weight = below_ + here.value();
    if (weight >= wanted_) {
      high_ = at;
      weight_of_high_ = weight;
      std::erase_if(active_, [&](const LinearValue& v) { return v.lowest > at; });
      return;
    }
    low_ = at;
    weight_of_low_ = weight;
    LongSum ended;
    for (const LinearValue& v : active_) ended.add(v.highest <= at ? v.weight : 0);
    below_ += ended.value();
    std::erase_if(active_, [&](const LinearValue& v) { return v.highest <= at; });
  }

  double low_;
  double high_;
  double wanted_;
  double below_ = 0;  ///< weight of the triangles whose values are all below the interval
  double weight_of_low_ = 0;
  double weight_of_high_ = 0;
  std::vector<LinearValue> active_;  ///< triangles with values in the interval
};

/// Returns a bound on the error of the weight below a value.
double weight_error(std::span<const LinearValue> values) {
  double out = 0;
  for (const LinearValue& v : values) out += v.round != nullptr ? v.weight * v.round->fraction_error() : 0;
  return out;
}

}  // namespace

LinearValue linear_value(double a, double b, double c, double weight) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c, weight};
}

double fraction_below(const LinearValue& triangle, double value) {
  const double a = triangle.lowest;
  const double b = triangle.middle;
  const double c = triangle.highest;
  if (value >= c) return 1;
  if (value < a) return 0;
  if (triangle.round != nullptr) {
    const double distance = triangle.sign * (value - triangle.shift);
    const double fraction = triangle.round->fraction_below(distance);
    return triangle.sign < 0 ? 1 - fraction : fraction;
  }
  if (value < b) return (value - a) / (b - a) * ((value - a) / (c - a));
  return 1 - (c - value) / (c - b) * ((c - value) / (c - a));
}

std::vector<std::pair<double, double>> percentiles(std::span<const LinearValue> values,
                                                   std::span<const double> percents, double error,
                                                   const Context& context) {
  const Histogram histogram(values);
  const double enough = std::max(error, 1e-15 * histogram.range());
  const double uncertain = weight_error(values);
  std::vector<std::pair<double, double>> out(percents.size());
  parallel_for(context, percents.size(), 1, "", [&](const WorkRange& range) {
    const double wanted = histogram.total() * percents[range.begin] / 100;
    const auto searched = [&](double weight) {
      const auto [low, high] = histogram.around(weight);
      PercentileSearch search(values, low, high, weight);
      search.run(enough);
      return search;
    };
    const PercentileSearch search = searched(wanted);
    out[range.begin] = search.bounds();
    if (uncertain > 0 && !search.is_certain(uncertain)) {
      out[range.begin] = {searched(wanted - uncertain).bounds().first, searched(wanted + uncertain).bounds().second};
    }
  });
  return out;
}

}  // namespace blum::surface
