#include "field/slice_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace blum::cli {
namespace {

std::size_t node_index(const Slice& slice, std::int64_t i, std::int64_t j) {
  i = std::clamp<std::int64_t>(i, 0, slice.width - 1);
  j = std::clamp<std::int64_t>(j, 0, slice.height - 1);
  return static_cast<std::size_t>(j * slice.width + i);
}

std::array<double, 3> quadratic_weights(double t) {  // t is the distance from the middle node, in [-0.5, 0.5] steps
  return {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)};
}

}  // namespace

DistanceSampler::DistanceSampler(const Slice& slice)
    : slice_(slice), smooth_(static_cast<std::size_t>(slice.width) * static_cast<std::size_t>(slice.height)) {
  // Checks the change between neighbouring nodes. A distance changes by at most the step. Only between voxels of two
  // kinds it changes by two steps, from -1 to +1.
  const auto close = [](double a, double b, double step) { return std::abs(a - b) <= 2.01 * step; };
  for (std::int64_t j = 0; j < slice.height; ++j) {
    for (std::int64_t i = 0; i < slice.width; ++i) {
      const double a = node(i, j);
      const double b = node(i + 1, j);
      const double c = node(i, j + 1);
      const double d = node(i + 1, j + 1);
      smooth_[node_index(slice, i, j)] = close(a, b, slice.u_step) && close(c, d, slice.u_step) &&
                                         close(a, c, slice.v_step) && close(b, d, slice.v_step);
    }
  }
}

double DistanceSampler::node(std::int64_t i, std::int64_t j) const {
  // Values beyond the border are extrapolated linearly, so that contours reach the border as straight lines.
  if (i < 0) return 2 * node(0, j) - node(1, j);
  if (i >= slice_.width) return 2 * node(slice_.width - 1, j) - node(std::max<std::int64_t>(slice_.width - 2, 0), j);
  if (j < 0) return 2 * node(i, 0) - node(i, 1);
  if (j >= slice_.height) return 2 * node(i, slice_.height - 1) - node(i, std::max<std::int64_t>(slice_.height - 2, 0));
  return static_cast<double>(slice_.distance[node_index(slice_, i, j)]);
}

bool DistanceSampler::is_smooth(std::int64_t i, std::int64_t j) const {
  return smooth_[node_index(slice_, i, j)];
}

DistanceSampler::Cell DistanceSampler::cell_at(double u, double v) const {
  const auto nearest = [](double place, std::int64_t count) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(place), 0, std::max<std::int64_t>(count - 2, 0));
  };
  const std::int64_t i = nearest(u, slice_.width);
  const std::int64_t j = nearest(v, slice_.height);
  return {i, j, u - static_cast<double>(i), v - static_cast<double>(j)};
}

bool DistanceSampler::is_smooth_around(const Cell& cell) const {
  // In the half step beyond the last nodes, values are extrapolated linearly.
  bool smooth = cell.s >= 0 && cell.s <= 1 && cell.t >= 0 && cell.t <= 1;
  for (std::int64_t dj = -1; dj <= 1; ++dj) {
    for (std::int64_t di = -1; di <= 1; ++di) smooth = smooth && is_smooth(cell.i + di, cell.j + dj);
  }
  return smooth;
}

Sample DistanceSampler::bilinear(const Cell& cell) const {
  const auto& [i, j, s, t] = cell;
  const double a = node(i, j);
  const double b = node(i + 1, j);
  const double c = node(i, j + 1);
  const double d = node(i + 1, j + 1);
  return {(a * (1 - s) + b * s) * (1 - t) + (c * (1 - s) + d * s) * t, (b - a) * (1 - t) + (d - c) * t,
          (c - a) * (1 - s) + (d - b) * s, true};
}

Sample DistanceSampler::at(double u, double v) const {
  const Cell cell = cell_at(u, v);
  if (!is_smooth(cell.i, cell.j)) return {node(std::llround(u), std::llround(v)), 0, 0, false};
  return bilinear(cell);
}

Sample DistanceSampler::smoothed(double u, double v) const {
  const Cell cell = cell_at(u, v);
  if (!is_smooth(cell.i, cell.j) || !is_smooth_around(cell)) return at(u, v);
  const std::int64_t i = std::llround(u);
  const std::int64_t j = std::llround(v);
  const double s = u - static_cast<double>(i);
  const double t = v - static_cast<double>(j);
  const std::array<double, 3> wu = quadratic_weights(s);
  const std::array<double, 3> wv = quadratic_weights(t);
  const std::array<double, 3> du{s - 0.5, -2 * s, s + 0.5};
  const std::array<double, 3> dv{t - 0.5, -2 * t, t + 0.5};
  Sample sample;
  for (std::size_t y = 0; y < 3; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      const double value = node(i + static_cast<std::int64_t>(x) - 1, j + static_cast<std::int64_t>(y) - 1);
      sample.value += wu[x] * wv[y] * value;
      sample.slope_u += du[x] * wv[y] * value;
      sample.slope_v += wu[x] * dv[y] * value;
    }
  }
  return sample;
}

RegionSample region_at(const Slice& slice, double u, double v) {
  u = std::clamp(u, 0.0, static_cast<double>(slice.width - 1));
  v = std::clamp(v, 0.0, static_cast<double>(slice.height - 1));
  const std::int64_t i = std::llround(u);
  const std::int64_t j = std::llround(v);
  const std::array<double, 3> wu = quadratic_weights(u - static_cast<double>(i));
  const std::array<double, 3> wv = quadratic_weights(v - static_cast<double>(j));
  std::array<SiteId, 9> ids;
  std::array<double, 9> votes{};
  std::size_t count = 0;
  for (std::size_t y = 0; y < 3; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      const SiteId id =
          slice.site[node_index(slice, i + static_cast<std::int64_t>(x) - 1, j + static_cast<std::int64_t>(y) - 1)];
      std::size_t at = 0;
      while (at < count && ids[at] != id) ++at;
      if (at == count) ids[count++] = id;
      votes[at] += wu[x] * wv[y];
    }
  }
  if (count == 1) return {ids[0], SiteId::none(), 1, true};
  const std::size_t best = static_cast<std::size_t>(
      std::max_element(votes.begin(), votes.begin() + static_cast<std::ptrdiff_t>(count)) - votes.begin());
  std::size_t second = best == 0 ? 1 : 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (k != best && votes[k] > votes[second]) second = k;
  }
  return {ids[best], ids[second], votes[best] - votes[second], false};
}

}  // namespace blum::cli
