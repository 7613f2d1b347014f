#include "blum/geometry/ear_clipping.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "blum/geometry/orient2d.hpp"

namespace blum::detail {
namespace {

using Point = std::array<double, 2>;

/// Balanced tree of boxes over the corners that may block an ear (lie inside it). Corners can be removed.
class PointTree {
 public:
  PointTree() = default;
  PointTree(std::span<const Point> points, std::vector<std::uint32_t> members)
      : points_(points.data()),
        members_(std::move(members)),
        leaf_of_(points.size(), none),
        leaves_(std::bit_ceil(members_.size() / leaf_size + 1)) {
    nodes_.resize(2 * leaves_);
    build(1, 0, members_.size());
  }

  /// Removes a corner. Does nothing if it is not in the tree.
  void remove(std::uint32_t corner) {
    const std::uint32_t leaf = std::exchange(leaf_of_[corner], none);
    if (leaf == none) return;
    for (std::uint32_t node = leaf; node > 0; node /= 2) --nodes_[node].count;
  }

  /// Returns true if a corner of the tree lies in the triangle or on its edges. Corners at exactly the position of a
  /// corner of the triangle are ignored, because the ends of bridges to holes coincide.
  /// @param work_left  reduced by the number of boxes and corners visited.
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
    std::uint32_t count = 0;           ///< number of members not yet removed
    std::uint32_t begin = 0, end = 0;  ///< for a leaf: its range in members_
  };

  void build(std::uint32_t index, std::size_t begin, std::size_t end) {
    Node& node = nodes_[index];
    node.count = static_cast<std::uint32_t>(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      const Point& p = points_[members_[k]];
      for (std::size_t axis = 0; axis < 2; ++axis) {
        node.lower[axis] = std::min(node.lower[axis], p[axis]);
        node.upper[axis] = std::max(node.upper[axis], p[axis]);
      }
    }
    if (index >= leaves_) {
      node.begin = static_cast<std::uint32_t>(begin);
      node.end = static_cast<std::uint32_t>(end);
      for (std::size_t k = begin; k < end; ++k) leaf_of_[members_[k]] = index;
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const std::size_t axis = node.upper[0] - node.lower[0] >= node.upper[1] - node.lower[1] ? 0 : 1;
    const auto at = [&](std::size_t k) { return members_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    build(2 * index, begin, middle);
    build(2 * index + 1, middle, end);
  }

  /// Returns true if the box certainly contains no point of the triangle. This is certain if the box does not touch the
  /// triangle's bounding box, or lies completely to the right of some edge. The corner of the box that is furthest to
  /// the left of an edge decides if the box lies to its right.
  static bool is_apart(const Node& box, const std::array<Point, 3>& t) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (box.upper[axis] < std::min({t[0][axis], t[1][axis], t[2][axis]})) return true;
      if (box.lower[axis] > std::max({t[0][axis], t[1][axis], t[2][axis]})) return true;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& a = t[k];
      const Point& b = t[(k + 1) % 3];
      const Point best = {b[1] > a[1] ? box.lower[0] : box.upper[0], b[0] > a[0] ? box.upper[1] : box.lower[1]};
      if (orient2d(a, b, best) < 0) return true;
    }
    return false;
  }

  static bool is_inside(const Point& p, const std::array<Point, 3>& t) {
    return p != t[0] && p != t[1] && p != t[2] && orient2d(t[0], t[1], p) >= 0 && orient2d(t[1], t[2], p) >= 0 &&
           orient2d(t[2], t[0], p) >= 0;
  }

  const Point* points_ = nullptr;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> leaf_of_;  ///< for every corner of the polygon: its leaf; none if not in the tree
  std::vector<Node> nodes_;             ///< the root has index 1, and the children of node i have indices 2i and 2i + 1
  std::vector<std::uint32_t> stack_;
  std::size_t leaves_ = 0;
};

class EarClipper {
 public:
  EarClipper(std::span<const Point> points, std::span<Triangle> triangles, std::int64_t& work_left,
             const Context& context)
      : points_(points),
        triangles_(triangles),
        links_(points.size()),
        twin_(points.size()),
        is_queued_(points.size()),
        work_left_(work_left),
        context_(context) {
    const auto n = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < n; ++i) links_[i] = {i == 0 ? n - 1 : i - 1, i + 1 == n ? 0 : i + 1};
    link_twins();
    std::vector<std::uint32_t> blocking;
    for (std::uint32_t i = 0; i < n; ++i) {
      if (turn(i) <= 0) blocking.push_back(i);
    }
    blockers_ = PointTree(points, std::move(blocking));
  }

  bool run(EarOrder order) { return order == EarOrder::in_turn ? run_in_turn() : run_every_other(); }

 private:
  struct Link {
    std::uint32_t previous, next;
  };

  static constexpr std::uint32_t gone = 0xffffffffU;

  /// Links all corners at the same position to a ring.
  void link_twins() {
    std::vector<std::uint32_t> sorted(points_.size());
    std::iota(sorted.begin(), sorted.end(), 0U);
    twin_ = sorted;
    std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
      return points_[a] != points_[b] ? points_[a] < points_[b] : a < b;
    });
    for (std::size_t k = 1; k < sorted.size(); ++k) {
      if (points_[sorted[k]] == points_[sorted[k - 1]]) std::swap(twin_[sorted[k]], twin_[sorted[k - 1]]);
    }
  }

  bool run_in_turn() {
    std::size_t left = points_.size();
    std::uint32_t corner = 0;
    bool flat_allowed = false;
    while (left > 3) {
      // One pass over all remaining corners. Corners next to a new ear are queued at the end. Cutting them at once
      // would make a fan of needles.
      queue_.clear();
      for (std::size_t i = 0; i < left; ++i, corner = links_[corner].next) enter(corner);
      const std::size_t before = left;
      for (std::size_t at = 0; at < queue_.size() && left > 3; ++at) {
        throw_if_cancelled(context_);
        if (--work_left_ < 0) return false;
        const std::uint32_t candidate = queue_[at];
        is_queued_[candidate] = false;
        if (links_[candidate].next == gone) continue;
        const int side = turn(candidate);
        if (!(side > 0 ? is_ear(candidate) : side == 0 && flat_allowed)) continue;
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
        continue;  // no ear was found at a convex corner, so straight corners may be cut, too
      } else {
        return false;
      }
    }
    if (turn(corner) < 0) return false;
    emit(corner);
    return true;
  }

  bool run_every_other() {
    std::uint32_t corner = 0;
    for (std::size_t left = points_.size(), tries = 0; left > 3;) {
      throw_if_cancelled(context_);
      if (--work_left_ < 0 || tries > left) return false;
      const Link link = links_[corner];
      if (turn(corner) > 0 && is_ear(corner)) {
        clip(corner);
        --left;
        tries = 0;
        corner = links_[link.next].next;
      } else {
        ++tries;
        corner = link.next;
      }
    }
    if (turn(corner) < 0) return false;
    emit(corner);
    return true;
  }

  void enter(std::uint32_t corner) {
    if (is_queued_[corner]) return;
    is_queued_[corner] = true;
    queue_.push_back(corner);
  }

  [[nodiscard]] int turn(std::uint32_t i) const {
    return orient2d(points_[links_[i].previous], points_[i], points_[links_[i].next]);
  }

  bool is_ear(std::uint32_t corner) {
    const Point& a = points_[links_[corner].previous];
    const Point& b = points_[corner];
    const Point& c = points_[links_[corner].next];
    bool is_doubtful = false;
    for (std::uint32_t twin = twin_[corner]; twin != corner; twin = twin_[twin]) {
      if (--work_left_ < 0) return false;
      if (links_[twin].next == gone) continue;
      // The polygon passes through the position of the ear's tip again: outside of the ear, through it, or along both
      // of its edges. In the last case the tip alone does not determine on which side of them the inside is.
      const Side before = side_of(points_[links_[twin].previous], a, b, c);
      const Side after = side_of(points_[links_[twin].next], a, b, c);
      if (before == Side::between || after == Side::between) return false;
      is_doubtful = is_doubtful || (before == Side::along && after == Side::along);
    }
    return !blockers_.any_inside({a, b, c}, work_left_) && (!is_doubtful || is_wound_around(corner));
  }

  /// Position of a point next to the tip b, relative to the ear a, b, c.
  enum class Side : std::uint8_t { between, along, outside };
  static Side side_of(const Point& q, const Point& a, const Point& b, const Point& c) {
    const int left_of_first = orient2d(a, b, q);
    const int left_of_second = orient2d(b, c, q);
    if (left_of_first < 0 || left_of_second < 0) return Side::outside;
    return left_of_first > 0 && left_of_second > 0 ? Side::between : Side::along;
  }

  /// Returns true if the remaining polygon winds around the area right at a corner, between its two edges. The test
  /// point is tip + e (previous - tip) + e^2 (next - tip), for a sufficiently small e > 0.
  [[nodiscard]] bool is_wound_around(std::uint32_t corner) {
    const Link link = links_[corner];
    const std::array<const Point*, 3> terms = {&points_[corner], &points_[link.previous], &points_[link.next]};
    // Terms are compared in order; the sign of the first difference decides.
    const auto is_above = [&](const Point& p) {
      const auto term = std::find_if(terms.begin(), terms.end(), [&](const Point* q) { return (*q)[1] != p[1]; });
      return term != terms.end() && p[1] > (**term)[1];
    };
    const auto side_of_line = [&](const Point& from, const Point& to) {
      int side = 0;
      for (std::size_t k = 0; k < terms.size() && side == 0; ++k) side = orient2d(from, to, *terms[k]);
      return side;
    };
    std::int64_t turns = 0;  // winding number, counted at the edges that a ray from the test point to the right crosses
    std::uint32_t at = corner;
    do {
      if (--work_left_ < 0) return false;
      const Point& from = points_[at];
      at = links_[at].next;
      const Point& to = points_[at];
      const bool is_upward = !is_above(from) && is_above(to);
      const bool is_downward = is_above(from) && !is_above(to);
      if (is_upward && side_of_line(from, to) > 0) ++turns;
      if (is_downward && side_of_line(from, to) < 0) --turns;
    } while (at != corner);
    return turns > 0;
  }

  void emit(std::uint32_t corner) { triangles_[emitted_++] = {links_[corner].previous, corner, links_[corner].next}; }

  void clip(std::uint32_t corner) {
    emit(corner);
    const Link link = links_[corner];
    links_[link.previous].next = link.next;
    links_[link.next].previous = link.previous;
    links_[corner] = {gone, gone};
    blockers_.remove(corner);
    if (turn(link.previous) > 0) blockers_.remove(link.previous);
    if (turn(link.next) > 0) blockers_.remove(link.next);
  }

  std::span<const Point> points_;
  std::span<Triangle> triangles_;
  std::vector<Link> links_;
  std::vector<std::uint32_t> twin_;  ///< for each corner: the next corner at the same position
  PointTree blockers_;               ///< remaining corners that did not turn left when last checked
  std::vector<char> is_queued_;
  std::vector<std::uint32_t> queue_;
  std::size_t emitted_ = 0;
  std::int64_t& work_left_;
  const Context& context_;
};

}  // namespace

bool clip_ears(std::span<const Point> points, EarOrder order, std::span<Triangle> triangles, std::int64_t& work_left,
               const Context& context) {
  return EarClipper(points, triangles, work_left, context).run(order);
}

}  // namespace blum::detail
