#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "io/mesh_builder.hpp"

namespace blum {
namespace {

/// A corner of a polygon, seen along a coordinate axis.
struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// Twice the signed area of a triangle: positive when its corners turn left.
double area2(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners, seen along the axis nearest to the polygon's mean normal (Newell's) such that it turns left, as
/// fractions of its size. Dropping a coordinate keeps the others exact, and is an affine map of the polygon's plane.
/// @returns empty when the polygon has no area to speak of.
std::vector<Point> flattened(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners) {
  Box3 box;
  for (const std::uint32_t corner : corners) box.extend(vertices[corner]);
  const Vec3d origin = box.lower;
  const Vec3d size = box.upper * 0.5 - box.lower * 0.5;  // halves: the difference itself might overflow
  const double largest = std::max({size.x, size.y, size.z});
  if (!(largest > 0)) return {};
  const auto scaled = [&](std::uint32_t corner) {
    const Vec3d v = vertices[corner] * 0.5 - origin * 0.5;
    return Vec3d{v.x / largest, v.y / largest, v.z / largest};
  };
  Vec3d normal;
  Vec3d last = scaled(corners.back());
  for (const std::uint32_t corner : corners) {
    const Vec3d next = scaled(corner);
    normal += cross(last, next);
    last = next;
  }
  const Vec3d magnitude = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const std::size_t axis = magnitude.z >= magnitude.x && magnitude.z >= magnitude.y ? 2
                           : magnitude.y >= magnitude.x                             ? 1
                                                                                    : 0;
  constexpr double rounding = 1e-15;  // each of the terms above is below 1, and exact to about 1e-16
  if (!(magnitude[axis] > rounding * static_cast<double>(corners.size()))) return {};
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const Vec3d v = scaled(corner);
    const Point p = {v[(axis + 1) % 3], v[(axis + 2) % 3]};
    points.push_back(normal[axis] > 0 ? p : Point{p.y, p.x});
  }
  return points;
}

/// Whether every corner turns left, and the outline goes around once.
bool is_strictly_convex(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  std::size_t upward_starts = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = points[i];
    const Point& b = points[i + 1 < n ? i + 1 : i + 1 - n];
    const Point& c = points[i + 2 < n ? i + 2 : i + 2 - n];
    if (!(area2(a, b, c) > 0)) return false;
    const bool first_up = b.y > a.y || (b.y == a.y && b.x > a.x);
    const bool second_up = c.y > b.y || (c.y == b.y && c.x > b.x);
    upward_starts += !first_up && second_up ? 1 : 0;
  }
  return upward_starts == 1;
}

void cut_as_fan(std::span<const std::uint32_t> corners, std::span<Triangle> triangles) {
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) triangles[i] = {corners[0], corners[i + 1], corners[i + 2]};
}

/// The corners that may be in the way of an ear, as a balanced tree of boxes over them; corners can be taken out.
class PointTree {
 public:
  PointTree() = default;
  PointTree(const std::vector<Point>& points, std::vector<std::uint32_t> members)
      : points_(points.data()),
        members_(std::move(members)),
        leaf_of_(points.size(), none),
        leaves_(std::bit_ceil(members_.size() / leaf_size + 1)) {
    nodes_.resize(2 * leaves_);
    build(1, 0, members_.size());
  }

  /// Does nothing for a corner that is not in the tree.
  void remove(std::uint32_t corner) {
    const std::uint32_t leaf = std::exchange(leaf_of_[corner], none);
    if (leaf == none) return;
    for (std::uint32_t node = leaf; node > 0; node /= 2) --nodes_[node].count;
  }

  /// Whether a corner lies in the triangle, edges included. Corners at exactly the place of one of its own do not
  /// count: the ends of bridges to holes meet so.
  /// @param work_left  is lowered by the number of boxes and corners looked at.
  [[nodiscard]] bool any_inside(const std::array<Point, 3>& t, std::int64_t& work_left) {
    stack_.assign(1, 1);
    while (!stack_.empty()) {
      const std::uint32_t index = stack_.back();
      stack_.pop_back();
      --work_left;
      const Node& node = nodes_[index];
      if (node.count == 0 || is_apart(node, t)) continue;
      if (index < leaves_) {
        stack_.push_back(2 * index);
        stack_.push_back(2 * index + 1);
        continue;
      }
      for (std::size_t k = node.begin; k < node.end; ++k, --work_left) {
        if (leaf_of_[members_[k]] != none && is_inside(points_[members_[k]], t)) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;
  static constexpr std::size_t leaf_size = 4;
  struct Node {
    Point lower{HUGE_VAL, HUGE_VAL}, upper{-HUGE_VAL, -HUGE_VAL};
    std::uint32_t count = 0;           ///< members that have not been taken out
    std::uint32_t begin = 0, end = 0;  ///< of a leaf, in members_
  };

  void build(std::uint32_t index, std::size_t begin, std::size_t end) {
    Node& node = nodes_[index];
    node.count = static_cast<std::uint32_t>(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      const Point& p = points_[members_[k]];
      node.lower = {std::min(node.lower.x, p.x), std::min(node.lower.y, p.y)};
      node.upper = {std::max(node.upper.x, p.x), std::max(node.upper.y, p.y)};
    }
    if (index >= leaves_) {
      node.begin = static_cast<std::uint32_t>(begin);
      node.end = static_cast<std::uint32_t>(end);
      for (std::size_t k = begin; k < end; ++k) leaf_of_[members_[k]] = index;
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const bool along_x = node.upper.x - node.lower.x >= node.upper.y - node.lower.y;
    const auto at = [&](std::size_t k) { return members_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      return along_x ? points_[a].x < points_[b].x : points_[a].y < points_[b].y;
    });
    build(2 * index, begin, middle);
    build(2 * index + 1, middle, end);
  }

  /// Whether no point of the box can pass is_inside(): the corner of the box that is farthest to the left of an edge is
  /// right of it. The same sums as in area2(), so rounding, which is monotone, cannot make the two disagree.
  static bool is_apart(const Node& box, const std::array<Point, 3>& t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& a = t[k];
      const Point& b = t[(k + 1) % 3];
      const Point best = {b.y - a.y > 0 ? box.lower.x : box.upper.x, b.x - a.x > 0 ? box.upper.y : box.lower.y};
      if (area2(a, b, best) < 0) return true;
    }
    return box.upper.x < std::min({t[0].x, t[1].x, t[2].x}) || box.lower.x > std::max({t[0].x, t[1].x, t[2].x}) ||
           box.upper.y < std::min({t[0].y, t[1].y, t[2].y}) || box.lower.y > std::max({t[0].y, t[1].y, t[2].y});
  }

  static bool is_inside(const Point& p, const std::array<Point, 3>& t) {
    return area2(t[0], t[1], p) >= 0 && area2(t[1], t[2], p) >= 0 && area2(t[2], t[0], p) >= 0 && p != t[0] &&
           p != t[1] && p != t[2];
  }

  const Point* points_ = nullptr;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> leaf_of_;  ///< of every corner of the polygon; none for those that are not in the tree
  std::vector<Node> nodes_;             ///< the root is 1; the children of i are 2i and 2i + 1
  std::vector<std::uint32_t> stack_;
  std::size_t leaves_ = 0;
};

/// Cuts ears off a polygon until a triangle is left. An ear is a corner that turns left and whose triangle holds no
/// other corner. Only corners that do not turn left can be in the way; a tree of boxes finds them.
///
/// When all ears turn left and the polygon is simple (holes joined by bridges allowed), the triangles cover its inside
/// exactly once whatever ears were taken, because their winding numbers add up to the polygon's.
class EarClipper {
 public:
  EarClipper(const std::vector<Point>& points, std::span<const std::uint32_t> corners, std::span<Triangle> triangles,
             std::int64_t& work_left)
      : points_(points),
        corners_(corners),
        triangles_(triangles),
        links_(points.size()),
        is_queued_(points.size()),
        work_left_(work_left) {
    const std::size_t n = points.size();
    for (std::uint32_t i = 0; i < n; ++i) {
      links_[i] = {i == 0 ? static_cast<std::uint32_t>(n - 1) : i - 1, i + 1 == n ? 0 : i + 1};
    }
    std::vector<std::uint32_t> blocking;
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!(corner_area(i) > 0)) blocking.push_back(i);
    }
    blockers_ = PointTree(points, std::move(blocking));
  }

  /// False when the polygon crosses itself, or takes too much work.
  bool run() {
    std::size_t left = points_.size();
    std::uint32_t corner = 0;
    bool flat_allowed = false;
    while (left > 3) {
      // One pass over all that is left. Corners beside a new ear get another turn at the end of the queue, not at once:
      // that would make a fan of needles.
      queue_.clear();
      for (std::size_t i = 0; i < left; ++i, corner = links_[corner].next) enter(corner);
      const std::size_t before = left;
      for (std::size_t turn = 0; turn < queue_.size() && left > 3; ++turn) {
        if (--work_left_ < 0) return false;
        const std::uint32_t candidate = queue_[turn];
        is_queued_[candidate] = false;
        if (links_[candidate].next == gone) continue;
        const double area = corner_area(candidate);
        if (!(area > 0 ? is_ear(candidate) : area == 0 && flat_allowed)) continue;
        const Link link = links_[candidate];
        clip(candidate);
        --left;
        enter(link.next);
        enter(link.previous);
        corner = link.next;
      }
      if (work_left_ < 0) return false;
      if (left < before) {
        flat_allowed = false;
      } else if (!std::exchange(flat_allowed, true)) {
        continue;  // nothing turns left: corners that turn nowhere may go, too
      } else {
        return false;
      }
    }
    const Link link = links_[corner];
    if (area2(points_[link.previous], points_[corner], points_[link.next]) < 0) return false;
    emit(corner);
    return true;
  }

 private:
  struct Link {
    std::uint32_t previous, next;
  };

  static constexpr std::uint32_t gone = 0xffffffffU;

  void enter(std::uint32_t corner) {
    if (is_queued_[corner]) return;
    is_queued_[corner] = true;
    queue_.push_back(corner);
  }

  double corner_area(std::uint32_t i) const {
    return area2(points_[links_[i].previous], points_[i], points_[links_[i].next]);
  }

  bool is_ear(std::uint32_t corner) {
    return !blockers_.any_inside({points_[links_[corner].previous], points_[corner], points_[links_[corner].next]},
                                 work_left_);
  }

  void emit(std::uint32_t corner) {
    const Link link = links_[corner];
    triangles_[emitted_++] = {corners_[link.previous], corners_[corner], corners_[link.next]};
  }

  void clip(std::uint32_t corner) {
    emit(corner);
    const Link link = links_[corner];
    links_[link.previous].next = link.next;
    links_[link.next].previous = link.previous;
    links_[corner] = {gone, gone};
    blockers_.remove(corner);
    if (corner_area(link.previous) > 0) blockers_.remove(link.previous);
    if (corner_area(link.next) > 0) blockers_.remove(link.next);
  }

  const std::vector<Point>& points_;
  std::span<const std::uint32_t> corners_;
  std::span<Triangle> triangles_;
  std::vector<Link> links_;
  PointTree blockers_;  ///< corners that are left and did not turn left when last looked at
  std::vector<char> is_queued_;
  std::vector<std::uint32_t> queue_;
  std::size_t emitted_ = 0;
  std::int64_t& work_left_;  ///< tests that may still be made
};

}  // namespace

bool cut_polygon(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners, std::span<Triangle> triangles,
                 std::int64_t& work_left) {
  const std::vector<Point> points = flattened(vertices, corners);
  if (!points.empty() && is_strictly_convex(points)) {
    cut_as_fan(corners, triangles);
    return true;
  }
  work_left += polygon_work_per_corner * static_cast<std::int64_t>(corners.size());
  if (!points.empty() && EarClipper(points, corners, triangles, work_left).run()) return true;
  work_left = std::max<std::int64_t>(work_left, 0);
  cut_as_fan(corners, triangles);
  return false;
}

}  // namespace blum
