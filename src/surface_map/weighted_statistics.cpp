#include "surface_map/weighted_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace blum::surface {
namespace {

/// Value at which the weight below it begins to grow faster or more slowly, or jumps.
struct Event {
  double at = 0;
  double slope = 0;  ///< change of the slope
  double jump = 0;
};

std::vector<Event> events_of(std::span<const SpreadValue> values) {
  // Narrower values would have slopes that overflow.
  constexpr double least_spread = 1e-12;  // of the largest magnitude
  double largest = 0;
  for (const SpreadValue& v : values) largest = std::max(largest, std::abs(v.middle));
  std::vector<Event> events;
  events.reserve(2 * values.size());
  for (const SpreadValue& v : values) {
    if (!(v.spread > least_spread * largest)) {
      events.push_back({v.middle, 0, v.weight});
      continue;
    }
    const double slope = v.weight / (2 * v.spread);
    events.push_back({v.middle - v.spread, slope, 0});
    events.push_back({v.middle + v.spread, -slope, 0});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.at < b.at; });
  return events;
}

}  // namespace

double root_mean_square(std::span<const SpreadValue> values, double largest, double sum) {
  if (!(largest > 0)) return 0;
  LongSum square;
  for (const SpreadValue& v : values) {
    const double part = v.middle / largest;
    square.add(v.weight * part * part);
  }
  return largest * std::sqrt(square.value() / sum);
}

std::array<double, 7> percentiles(std::span<const SpreadValue> values, const std::array<double, 7>& percents) {
  const std::vector<Event> events = events_of(values);
  LongSum all;
  for (const SpreadValue& v : values) all.add(v.weight);
  std::array<double, 7> wanted{};  // weights below the percentiles
  for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = all.value() * percents[k] / 100;
  std::array<double, 7> out{};
  out.fill(events.back().at);
  std::size_t next = 0;
  LongSum below;
  LongSum slope;
  double at = events.front().at;
  for (const Event& event : events) {
    const double before = below.value();
    const double rise = std::max(slope.value(), 0.0);
    below.add(rise * (event.at - at));
    for (; next < out.size() && below.value() >= wanted[next]; ++next) {
      out[next] = rise > 0 ? std::min(at + (wanted[next] - before) / rise, event.at) : event.at;
    }
    below.add(event.jump);
    slope.add(event.slope);
    at = event.at;
    for (; next < out.size() && below.value() >= wanted[next]; ++next) out[next] = at;
  }
  return out;
}

}  // namespace blum::surface
