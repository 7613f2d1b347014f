#include "solid/clean/collapse_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "blum/geometry/closest_point.hpp"
#include "solid/clean/fan_gap.hpp"

namespace blum::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Of a vertex with more neighbours only the closest ones are tried.
constexpr std::size_t many_neighbours = 24;
constexpr std::size_t targets_of_many = 12;
/// Steps that move the surface less than this part of the tolerance are as good as each other.
constexpr double negligible = 0.002;
/// What the worst shape of new triangles costs, where 1 is all of the tolerance.
constexpr double cost_of_shape = 0.1;
/// New triangles may be flatter than those before by this, where they are no needles.
constexpr double flattening = 0.25;
/// Triangles below the tolerance are needles where they are also this much longer than high.
constexpr double slenderness = 10;
/// The cosine of the angle that triangles turn by at most. Needles turn freely, but are not to lie on their neighbours.
constexpr double least_cosine = 0.2;
constexpr double least_cosine_of_needle = -0.5;
/// Edges are turned where that makes triangles this much higher, so that it ends.
constexpr double least_gain = 1.5;
/// Flips come after collapses that are as good.
constexpr double cost_of_flip = 0.1;
constexpr double rounding = 1e-14;

double cosine(const Vec3d& a, const Vec3d& b) {
  const double sizes = std::sqrt(squared_length(a)) * std::sqrt(squared_length(b));
  return sizes > 0 ? dot(a, b) / sizes : -1;
}

}  // namespace

bool CollapseSearch::is_needle(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
  const double height = least_height(a, b, c);
  return height < tolerance_ && height * slenderness < longest_side(a, b, c);
}

void CollapseSearch::look_at_star(std::uint32_t v) {
  mesh_.find_star(v, star_);
  const std::size_t count = star_.ring.size();
  around_.resize(count);
  sides_.resize(count);
  for (std::size_t k = 0; k < count; ++k) around_[k] = mesh_.point(star_.ring[k]) - mesh_.point(v);
  deviation_ = 0;
  least_height_ = infinity;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3d& a = around_[k];
    const Vec3d& b = around_[(k + 1) % count];
    sides_[k] = {cross(a, b), least_height({}, a, b), is_needle({}, a, b)};
    deviation_ = std::max(deviation_, deviations_[star_.triangles[k]]);
    least_height_ = std::min(least_height_, sides_[k].height);
  }
}

void CollapseSearch::choose_targets() {
  targets_.resize(around_.size());
  std::iota(targets_.begin(), targets_.end(), std::size_t{0});
  if (targets_.size() <= many_neighbours) return;
  const auto is_closer = [&](std::size_t a, std::size_t b) {
    const double first = squared_length(around_[a]);
    const double second = squared_length(around_[b]);
    return first != second ? first < second : star_.ring[a] < star_.ring[b];
  };
  std::partial_sort(targets_.begin(), targets_.begin() + targets_of_many, targets_.end(), is_closer);
  targets_.resize(targets_of_many);
}

/// The vertex moves onto the chord from the target to another neighbour at first; what is on either side of the chord
/// is then a fan of its own. @return  infinity where that shows no bound below a limit.
double CollapseSearch::bound_along_crease(double limit) const {
  const std::size_t count = rotated_.size();
  const double enough = negligible * tolerance_;
  double best = infinity;
  std::vector<Vec3d> other_side;
  for (std::size_t m = 1; m < count; ++m) {
    const Vec3d foot = closest_point_on_segment({}, rotated_[0], rotated_[m]);
    const double height = length(foot) + rounding * (length(rotated_[0]) + length(rotated_[m]));
    if (!(height < limit)) continue;
    const double one = fan_gap(std::span(rotated_).first(m + 1), foot, false, enough);
    if (!(height + one < limit)) continue;
    other_side.assign(1, rotated_[0]);
    for (std::size_t k = count - 1; k >= m; --k) other_side.push_back(rotated_[k]);
    const double both = height + std::max(one, fan_gap(other_side, foot, false, enough));
    if (!(both < limit)) continue;
    best = limit = both;
  }
  return best;
}

/// How far the surface moves at most; above the budget where no better bound is known.
double CollapseSearch::bound(std::size_t onto, double budget) {
  const std::size_t count = around_.size();
  rotated_.resize(count);
  for (std::size_t k = 0; k < count; ++k) rotated_[k] = around_[(onto + k) % count];
  const double enough = negligible * tolerance_;
  double best = length(rotated_[0]) * (1 + rounding);
  if (best > enough) best = std::min(best, fan_gap(rotated_, {}, true, enough));
  if (best <= enough) return best;
  return std::min(best, bound_along_crease(std::min(best, budget)));
}

/// @param side  of the ring: the triangle there turns to a normal.
bool CollapseSearch::folds(std::uint32_t v, std::size_t side, const Vec3d& normal) const {
  if (!sides_[side].is_needle) return cosine(sides_[side].normal, normal) < least_cosine;
  const EdgePair edge = mesh_.opposite_edge(star_.triangles[side], v);
  const std::array<Vec3d, 3> beyond = mesh_.corners(edge.right);
  const Vec3d outer = cross(beyond[1] - beyond[0], beyond[2] - beyond[0]);
  const double found = cosine(outer, normal);
  return found < least_cosine_of_needle && found < cosine(outer, sides_[side].normal);
}

CollapseSearch::Shape CollapseSearch::shape(std::uint32_t v, std::size_t onto) const {
  const std::size_t count = around_.size();
  const Vec3d& w = around_[onto];
  Shape out{true, 1};
  double least = infinity;
  bool makes_needle = false;
  for (std::size_t step = 1; step + 1 < count; ++step) {
    const std::size_t side = (onto + step) % count;
    const Vec3d& a = around_[side];
    const Vec3d& b = around_[(side + 1) % count];
    const Vec3d normal = cross(a - w, b - w);
    const double longest = longest_side(w, a, b);
    const double height = longest > 0 ? length(normal) / longest : 0;
    if (!(height > 0) || folds(v, side, normal)) return {};
    least = std::min(least, height);
    makes_needle = makes_needle || is_needle(w, a, b);
    out.quality = std::min(out.quality, height / longest * (2 / std::numbers::sqrt3));
  }
  out.is_allowed = least >= least_height_ || (!makes_needle && least >= flattening * least_height_);
  return out;
}

std::span<const VertexCollapse> CollapseSearch::find(std::uint32_t v) {
  found_.clear();
  look_at_star(v);
  const double budget = tolerance_ - deviation_;
  if (star_.ring.size() < 3 || !(budget > 0)) return {};
  choose_targets();
  for (const std::size_t onto : targets_) {
    const Shape made = shape(v, onto);
    if (!made.is_allowed) continue;
    const double step = bound(onto, budget);
    const double deviation = (deviation_ + step) * (1 + rounding);
    if (!(deviation <= tolerance_)) continue;
    const double cost = deviation / tolerance_ + cost_of_shape * (1 - made.quality);
    found_.push_back({cost, deviation, star_.ring[onto], onto});
  }
  std::sort(found_.begin(), found_.end(), [](const VertexCollapse& a, const VertexCollapse& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.target < b.target;
  });
  return found_;
}

EdgeFlip CollapseSearch::find_flip(std::uint32_t t) const {
  EdgeFlip out;
  const std::array<Vec3d, 3> p = mesh_.corners(t);
  std::size_t apex = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    const auto opposite = [&](std::size_t of) { return squared_length(p[(of + 1) % 3] - p[(of + 2) % 3]); };
    if (opposite(k) > opposite(apex)) apex = k;
  }
  out.edge = mesh_.opposite_edge(t, mesh_.triangle(t)[apex]);
  const EdgePair& e = out.edge;
  const Vec3d& origin = mesh_.point(e.apex_left);
  const Vec3d a = mesh_.point(e.a) - origin;
  const Vec3d b = mesh_.point(e.b) - origin;
  const Vec3d d = mesh_.point(e.apex_right) - origin;
  // Both old triangles are within this of the new ones: the apex moves onto the edge, which it cuts in two.
  const double height = length(closest_point_on_segment({}, a, b)) + rounding * (length(a) + length(b));
  out.deviation = (std::max(deviations_[e.left], deviations_[e.right]) + height) * (1 + rounding);
  out.cost = out.deviation / tolerance_ + cost_of_flip;
  if (!(out.deviation <= tolerance_) || e.apex_left == e.apex_right) return out;
  const double before = std::min(least_height({}, a, b), least_height(b, a, d));
  const double after = std::min(least_height({}, a, d), least_height(d, b, {}));
  if (!(after >= least_gain * before && after > 0)) return out;
  const Vec3d beyond = cross(a - b, d - b);
  if (!is_needle(b, a, d) &&
      (cosine(beyond, cross(a, d)) < least_cosine || cosine(beyond, cross(b - d, -d)) < least_cosine)) {
    return out;
  }
  out.is_possible = !mesh_.has_edge(e.apex_left, e.apex_right);
  return out;
}

}  // namespace blum::detail
