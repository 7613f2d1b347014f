#include "voronoi/planes/plane_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace blum::voronoi {
namespace {

constexpr std::uint32_t leaf_size = 8;
constexpr double rounding = 0x1p-53;

double largest(const Vec3d& p) {
  return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

/// Returns the smallest product of a vector in a box with another vector.
double least_product(const Vec3d& low, const Vec3d& high, const Vec3d& by) {
  return std::min(low.x * by.x, high.x * by.x) + std::min(low.y * by.y, high.y * by.y) +
         std::min(low.z * by.z, high.z * by.z);
}

}  // namespace

PlaneTree::PlaneTree(const HalfSpaces& spaces, const std::vector<Vec3d>& middle) : order_(spaces.plane_count()) {
  std::iota(order_.begin(), order_.end(), 0U);
  for (const Vec3d& p : middle) centre_ += p / static_cast<double>(middle.size());
  for (const Index k : order_) scale_ = std::max({scale_, largest(middle[k]), std::abs(spaces.offset(k))});
  rows_.resize(order_.size());
  build(0, static_cast<std::uint32_t>(order_.size()), spaces, middle);
}

void PlaneTree::build(std::uint32_t begin, std::uint32_t end, const HalfSpaces& spaces,
                      const std::vector<Vec3d>& middle) {
  const std::size_t at = nodes_.size();
  Node node;
  node.begin = begin;
  node.end = end;
  node.low = node.high = spaces.normal(order_[begin]);
  for (std::uint32_t k = begin; k < end; ++k) {
    const Vec3d& normal = spaces.normal(order_[k]);
    rows_[k] = {normal, spaces.offset(order_[k])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::min(node.low[axis], normal[axis]);
      node.high[axis] = std::max(node.high[axis], normal[axis]);
    }
  }
  nodes_.push_back(node);
  if (end - begin > leaf_size) {
    const Vec3d size = node.high - node.low;
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0U : size.y >= size.z ? 1U : 2U;
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end, [&](Index a, Index b) {
      return std::pair(spaces.normal(a)[axis], a) < std::pair(spaces.normal(b)[axis], b);
    });
    build(begin, half, spaces, middle);
    nodes_[at].second = static_cast<std::uint32_t>(nodes_.size());
    build(half, end, spaces, middle);
  }
  bound(nodes_[at], middle);
}

/// Sets the depths of a node, whose rows must be in their final order.
void PlaneTree::bound(Node& node, const std::vector<Vec3d>& middle) const {
  const auto count = static_cast<double>(node.end - node.begin);
  for (std::uint32_t k = node.begin; k < node.end; ++k) {
    node.place += middle[order_[k]] / count;
    node.inwards += rows_[k].normal / count;
  }
  const double size = length(node.inwards);
  // Opposite normals cancel; bounds hold for any vector.
  node.inwards = size > 0 ? node.inwards / size : rows_[node.begin].normal;
  node.least_cosine = node.above_place = node.above_centre = HUGE_VAL;
  for (std::uint32_t k = node.begin; k < node.end; ++k) {
    const Row& row = rows_[k];
    node.least_cosine = std::min(node.least_cosine, dot(row.normal, node.inwards));
    node.above_place = std::min(node.above_place, dot(row.normal, node.place) + row.offset);
    node.above_centre = std::min(node.above_centre, dot(row.normal, centre_) + row.offset);
  }
}

/// Returns a lower bound on the depth of a point in the half-spaces of a node.
///
/// For a point p and a normal n, n . x + c = n . (x - p) + (n . p + c). The last part has a bound if p is the centre.
/// It also has one for p = place + height * inwards, which is close to x if a plane of the node is closest to x.
double PlaneTree::least_depth(const Node& node, const PlacedCorner& point) const {
  const double height = std::max(point.height, 0.0);
  const double near = least_product(node.low, node.high, point.at - node.place - node.inwards * height) +
                      node.above_place + height * node.least_cosine;
  const double central = least_product(node.low, node.high, point.at - centre_) + node.above_centre;
  return std::max(near, central) - point.height;
}

void PlaneTree::find(const PlacedCorner& point, Found& out) const {
  out.is_outside = false;
  out.planes.clear();
  const double scale = largest(point.at) + std::abs(point.height) + scale_;
  const double error = 3 * point.error + 16 * rounding * scale;
  const double margin = 128 * rounding * scale;
  double limit = error;                   // greater depths do not matter
  constexpr std::size_t most_nodes = 64;  // deeper than any tree of 2^32 planes
  std::array<std::pair<double, std::uint32_t>, most_nodes> stack;
  std::size_t count = 0;
  stack[count++] = {least_depth(nodes_[0], point), 0};
  while (count > 0) {
    const auto [least, at] = stack[--count];
    if (least > limit + margin) continue;
    const Node& node = nodes_[at];
    if (node.second != 0) {
      const std::pair first{least_depth(nodes_[at + 1], point), at + 1};
      const std::pair second{least_depth(nodes_[node.second], point), node.second};
      // The closer child comes first.
      const bool is_first = first.first <= second.first;
      stack[count++] = is_first ? second : first;
      stack[count++] = is_first ? first : second;
      continue;
    }
    for (std::uint32_t k = node.begin; k < node.end; ++k) {
      const double depth = dot(rows_[k].normal, point.at) + rows_[k].offset - point.height;
      if (depth > limit) continue;
      if (depth < -error) {
        out.is_outside = true;
        limit = depth;
        out.planes.assign(1, order_[k]);
      } else if (!out.is_outside) {
        out.planes.push_back(order_[k]);
      }
    }
  }
}

}  // namespace blum::voronoi
