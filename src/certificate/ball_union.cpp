#include "certificate/ball_union.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blum/core/inline_list.hpp"

namespace blum::verifier {
namespace {

/// Half the distance between float32 numbers at 1.
constexpr double rounding = 6e-8;

float rounded_up(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

}  // namespace

BallUnion::BallUnion(const std::vector<Ball>& balls, const Context& context) {
  if (balls.empty()) return;
  std::vector<Box3> boxes;
  boxes.reserve(balls.size());
  for (const Ball& ball : balls) boxes.push_back({ball.centre, ball.centre});
  const BoxHierarchy tree(boxes, context);
  std::vector<double> radii;
  radii.reserve(balls.size());
  balls_.reserve(balls.size());
  for (const std::uint32_t place : tree.order()) {
    balls_.push_back(balls[place]);
    radii.push_back(balls[place].radius);
  }
  const Box3& whole = tree.node(0).box;
  origin_ = whole.center();
  const Vec3d sides = whole.size();
  const double longest = std::max({sides.x, sides.y, sides.z});
  if (longest > 0) size_ = longest;
  const std::vector<double> largest = tree.node_maxima(radii);
  slack_ = rounding * (32 + 8 * std::abs(largest.front()) / size_);
  nodes_.reserve(balls.size() / 2 + 1);
  add_node(tree, tree.places(), largest, 0);
}

Vec3d BallUnion::slope_of(const BoxHierarchy::Places& places) const {
  const auto [begin, end] = places;
  const auto count = static_cast<double>(end - begin);
  Vec3d mean;
  double mean_radius = 0;
  for (std::uint32_t k = begin; k < end; ++k) {
    mean += balls_[k].centre / count;
    mean_radius += balls_[k].radius / count;
  }
  Mat3 spread{{Vec3d{}, Vec3d{}, Vec3d{}}};
  Vec3d rise;
  for (std::uint32_t k = begin; k < end; ++k) {
    const Vec3d apart = (balls_[k].centre - mean) / size_;
    for (std::size_t a = 0; a < 3; ++a) spread.columns[a] += apart * apart[a];
    rise += apart * ((balls_[k].radius - mean_radius) / size_);
  }
  // The centres of a sheet do not determine the slope across the sheet. A little extra spread keeps the slope along the
  // sheet.
  const double more = 1e-3 * (spread.columns[0].x + spread.columns[1].y + spread.columns[2].z);
  for (std::size_t a = 0; a < 3; ++a) spread.columns[a][a] += more;
  const auto& [x, y, z] = spread.columns;
  const double volume = dot(x, cross(y, z));
  if (!(volume > 0)) return {};
  const Vec3d slope = Vec3d{dot(rise, cross(y, z)), dot(x, cross(rise, z)), dot(x, cross(y, rise))} / volume;
  constexpr double steepest = 2;  // slopes of true axes are at most 1
  return squared_length(slope) <= steepest * steepest ? slope : Vec3d{};
}

void BallUnion::set_child(Node& node, std::size_t k, const Box3& box, const BoxHierarchy::Places& places,
                          double largest) const {
  constexpr std::uint32_t most_balls = 4096;  // the radii of more balls do not follow a plane
  const Vec3d slope = places.second - places.first <= most_balls ? slope_of(places) : Vec3d{};
  Vec3d middle;
  Vec3d rounded_slope;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.middle[axis][k] = static_cast<float>((box.center()[axis] - origin_[axis]) / size_);
    node.slope[axis][k] = static_cast<float>(slope[axis]);
    middle[axis] = static_cast<double>(node.middle[axis][k]);
    rounded_slope[axis] = static_cast<double>(node.slope[axis][k]);
    const double lower = (box.lower[axis] - origin_[axis]) / size_;
    const double upper = (box.upper[axis] - origin_[axis]) / size_;
    node.half[axis][k] = rounded_up(std::max(middle[axis] - lower, upper - middle[axis]));
  }
  double radius = -HUGE_VAL;
  for (std::uint32_t b = places.first; b < places.second; ++b) {
    const Vec3d at = (balls_[b].centre - origin_) / size_ - middle;
    radius = std::max(radius, balls_[b].radius / size_ - dot(rounded_slope, at));
  }
  node.squared_reach[k] =
      node.half[0][k] * node.half[0][k] + node.half[1][k] * node.half[1][k] + node.half[2][k] * node.half[2][k];
  node.largest[k] = rounded_up(largest / size_);
  node.radius[k] = rounded_up(radius);
}

std::uint32_t BallUnion::add_node(const BoxHierarchy& tree, const std::vector<BoxHierarchy::Places>& places,
                                  const std::vector<double>& largest, std::uint32_t index) {
  const auto is_leaf = [&](std::uint32_t n) { return places[n].second - places[n].first <= width; };
  InlineList<std::uint32_t, width> children;
  children.push_back(index);
  // Splits the child with the most balls into its two children, while there is room.
  while (!children.is_full()) {
    std::uint32_t* const most =
        std::max_element(children.begin(), children.end(), [&](std::uint32_t a, std::uint32_t b) {
          return places[a].second - places[a].first < places[b].second - places[b].first;
        });
    if (is_leaf(*most)) break;
    const std::uint32_t first_child = tree.node(*most).first;
    *most = first_child;
    children.push_back(first_child + 1);
  }
  const auto own = static_cast<std::uint32_t>(nodes_.size());
  Node& node = nodes_.emplace_back();
  node.children = children.size();
  for (std::size_t k = 0; k < children.size(); ++k) {
    set_child(node, k, tree.node(children[k]).box, places[children[k]], largest[children[k]]);
  }
  for (std::size_t k = 0; k < children.size(); ++k) {
    const auto [begin, end] = places[children[k]];
    const bool has_balls = is_leaf(children[k]);
    const std::uint32_t first = has_balls ? begin : add_node(tree, places, largest, children[k]);
    nodes_[own].first[k] = first;
    nodes_[own].count[k] = has_balls ? end - begin : 0;
  }
  return own;
}

BallUnion::Four BallUnion::bounds_of(const Node& node, const std::array<float, 3>& at) {
  // The distance of a centre c in the box, minus its largest possible radius, is
  // |p - c| - radius - slope * (c - middle). This is convex in c, so its tangent at the middle is a lower bound in the
  // whole box.
  std::array<Four, 3> apart{};
  Four squared{};
  Four squared_outside{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < width; ++k) {
      apart[axis][k] = node.middle[axis][k] - at[axis];
      squared[k] += apart[axis][k] * apart[axis][k];
      const float outside = std::abs(apart[axis][k]) - node.half[axis][k];
      const float most = outside < 0 ? 0 : outside;
      squared_outside[k] += most * most;
    }
  }
  Four bounds{};
  Four per_length{};
  for (std::size_t k = 0; k < width; ++k) {
    const float distance = std::sqrt(squared[k]);
    per_length[k] = 1 / (distance < 1e-18F ? 1e-18F : distance);
    bounds[k] = distance - node.radius[k];
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < width; ++k) {
      bounds[k] -= std::abs(apart[axis][k] * per_length[k] - node.slope[axis][k]) * node.half[axis][k];
    }
  }
  for (std::size_t k = 0; k < width; ++k) {
    const float of_box = std::sqrt(squared_outside[k]) - node.largest[k];
    // Close to the middle, rounding errors make the direction to the middle useless.
    bounds[k] = squared[k] < node.squared_reach[k] || bounds[k] < of_box ? of_box : bounds[k];
  }
  return bounds;
}

template <class Visit>
void BallUnion::search(const Vec3d& p, double least, const Visit& visit) const {
  if (nodes_.empty()) return;
  struct Item {
    double bound;
    std::uint32_t first, count;
  };
  const Vec3d local = (p - origin_) / size_;
  const double reach = std::abs(local.x) + std::abs(local.y) + std::abs(local.z);
  if (!(reach < 1e15)) {  // squares would overflow
    for (std::uint32_t place = 0; place < balls_.size(); ++place) least = visit(place);
    return;
  }
  const std::array<float, 3> at{static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)};
  const double slack = slack_ + rounding * 20 * reach;
  InlineList<Item, 128> stack;  // three more items per level; each level has a quarter of the balls
  stack.push_back({-HUGE_VAL, 0, 0});
  while (!stack.empty()) {
    const Item item = stack.pop_back();
    if (item.bound >= least) continue;
    for (std::uint32_t k = 0; k < item.count; ++k) least = visit(item.first + k);
    if (item.count > 0) continue;
    const Node& node = nodes_[item.first];
    const Four bounds = bounds_of(node, at);
    // The child with the lowest bound is searched first.
    std::size_t lowest = 0;
    for (std::size_t k = 1; k < node.children; ++k) lowest = bounds[k] < bounds[lowest] ? k : lowest;
    const auto push = [&](std::size_t k) {
      const double bound = (static_cast<double>(bounds[k]) - slack) * size_;
      if (!(bound >= least)) stack.push_back({bound, node.first[k], node.count[k]});
    };
    for (std::size_t k = 0; k < node.children; ++k) {
      if (k != lowest) push(k);
    }
    push(lowest);
  }
}

double BallUnion::gap(const Vec3d& p, std::uint32_t& first) const {
  if (balls_.empty()) return HUGE_VAL;
  double best = gap_to(p, first);
  if (best <= 0) return best;
  search(p, best, [&](std::uint32_t place) {
    const double own = gap_to(p, place);
    if (own < best) {
      best = own;
      first = place;
    }
    return best <= 0 ? -HUGE_VAL : best;  // p lies in the union: ends the search
  });
  return best;
}

bool BallUnion::holds(const Vec3d& p, double margin, Holders& holders) const {
  if (balls_.empty()) return false;
  double wanted = -margin;  // -infinity once a ball is found, which ends the search
  for (auto holder = holders.begin(); holder != holders.end(); ++holder) {
    if (!(gap_to(p, *holder) < wanted)) continue;
    std::rotate(holders.begin(), holder, holder + 1);
    return true;
  }
  search(p, wanted, [&](std::uint32_t place) {
    if (!(gap_to(p, place) < wanted)) return wanted;
    std::copy_backward(holders.begin(), holders.end() - 1, holders.end());
    holders.front() = place;
    return wanted = -HUGE_VAL;
  });
  return wanted < -margin;
}

}  // namespace blum::verifier
