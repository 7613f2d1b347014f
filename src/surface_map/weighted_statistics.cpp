#include "surface_map/weighted_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace blum::surface {

namespace {

/// @param at  callable: returns value k and its weight.
template <class At>
double root_mean_square_of(std::size_t count, double largest, double sum, const At& at) {
  if (!(largest > 0)) return 0;
  LongSum square;
  for (std::size_t k = 0; k < count; ++k) {
    const auto [value, weight] = at(k);
    const double part = value / largest;
    square.add(weight * part * part);
  }
  return largest * std::sqrt(square.value() / sum);
}

/// Place at which the weight below a value begins to grow faster or more slowly, or jumps.
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

double root_mean_square(std::span<const double> values, std::span<const double> weights, double largest, double sum) {
  return root_mean_square_of(values.size(), largest, sum,
                             [&](std::size_t k) { return std::pair{values[k], weights[k]}; });
}

double root_mean_square(std::span<const SpreadValue> values, double largest, double sum) {
  return root_mean_square_of(values.size(), largest, sum,
                             [&](std::size_t k) { return std::pair{values[k].middle, values[k].weight}; });
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
