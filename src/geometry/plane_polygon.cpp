#include "blum/geometry/plane_polygon.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/orient2d.hpp"

namespace blum::detail {

using Point = PlanePolygon::Point;

double doubled_area(std::span<const Point> loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point& a = loop[k];
    const Point& b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (a[1] - loop[0][1]) * (b[0] - loop[0][0]);
  }
  return sum;
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  // True if r, on line pq, is strictly between p and q.
  const auto between = [](const Point& p, const Point& q, const Point& r) {
    return std::min(p, q) < r && r < std::max(p, q);
  };
  const int c_side = orient2d(a, b, c);
  const int d_side = orient2d(a, b, d);
  const int a_side = orient2d(c, d, a);
  const int b_side = orient2d(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) || (a_side == 0 && between(c, d, a)) ||
         (b_side == 0 && between(c, d, b));
}

namespace {

/// The outline of a polygon, to which its holes are joined by bridges: one loop of point indices. The ends of bridges
/// occur twice.
class JoinedLoop {
 public:
  JoinedLoop(const PlanePolygon& polygon, const Context& context) : polygon_(polygon), context_(context) {
    loop_.resize(polygon.loop_end(0));
    std::iota(loop_.begin(), loop_.end(), 0U);
    // The rightmost hole is joined first. So the bridge of a hole can only cross the loop joined so far, not a later
    // hole.
    std::vector<Hole> holes;
    for (std::size_t h = 1; h < polygon.loop_starts.size(); ++h) holes.push_back(rightmost(h));
    std::sort(holes.begin(), holes.end(), [&](const Hole& a, const Hole& b) {
      return polygon.points[a.start] != polygon.points[b.start] ? polygon.points[a.start] > polygon.points[b.start]
                                                                : a.start < b.start;
    });
    for (const Hole& hole : holes) join(hole);
  }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return loop_; }
  /// Returns false if a hole lies outside the outline, or in another hole.
  [[nodiscard]] bool is_possible() const { return is_possible_; }

 private:
  struct Hole {
    std::size_t loop = 0;
    std::uint32_t start = 0;  ///< index of its largest point by (x, y)
  };

  [[nodiscard]] Hole rightmost(std::size_t loop) const {
    std::uint32_t best = polygon_.loop_starts[loop];
    for (std::uint32_t i = best; i < polygon_.loop_end(loop); ++i) {
      if (polygon_.points[i] > polygon_.points[best]) best = i;
    }
    return {loop, best};
  }

  /// Returns true if the ray from corner loop_[at] to the point `target` starts inside the polygon.
  [[nodiscard]] bool leaves_inwards(std::size_t at, const Point& target) const {
    const std::size_t n = loop_.size();
    const Point& before = polygon_.points[loop_[(at + n - 1) % n]];
    const Point& corner = polygon_.points[loop_[at]];
    const Point& after = polygon_.points[loop_[(at + 1) % n]];
    const bool left_of_first = orient2d(before, corner, target) > 0;
    const bool left_of_second = orient2d(corner, after, target) > 0;
    return orient2d(before, corner, after) > 0 ? left_of_first && left_of_second : left_of_first || left_of_second;
  }

  [[nodiscard]] bool is_free(std::uint32_t from, std::uint32_t to) const {
    const auto& p = polygon_.points;
    for (std::size_t k = 0; k < loop_.size(); ++k) {
      if (segments_meet(p[from], p[to], p[loop_[k]], p[loop_[(k + 1) % loop_.size()]])) return false;
    }
    return true;
  }

  void join(const Hole& hole) {
    const Point& start = polygon_.points[hole.start];
    std::vector<std::size_t> order;
    for (std::size_t at = 0; at < loop_.size(); ++at) {
      if (polygon_.points[loop_[at]] > start && leaves_inwards(at, start)) order.push_back(at);
    }
    const auto squared = [&](std::size_t at) {
      const Point& q = polygon_.points[loop_[at]];
      return (q[0] - start[0]) * (q[0] - start[0]) + (q[1] - start[1]) * (q[1] - start[1]);
    };
    // The closest corner is tried first, because the bridge to it almost never crosses the loop.
    const auto goes_later = [&](std::size_t a, std::size_t b) {
      return squared(a) != squared(b) ? squared(a) > squared(b) : a > b;
    };
    std::make_heap(order.begin(), order.end(), goes_later);
    for (auto end = order.end(); end != order.begin(); --end) {
      throw_if_cancelled(context_);
      std::pop_heap(order.begin(), end, goes_later);
      const std::size_t at = *(end - 1);
      if (!is_free(hole.start, loop_[at])) continue;
      splice(at, hole);
      return;
    }
    is_possible_ = false;
  }

  /// Inserts after loop_[at] the loop of a hole, from its start back to its start, and then loop_[at] again.
  void splice(std::size_t at, const Hole& hole) {
    std::vector<std::uint32_t> inserted;
    const std::uint32_t first = polygon_.loop_starts[hole.loop];
    const std::uint32_t count = polygon_.loop_end(hole.loop) - first;
    for (std::uint32_t k = 0; k <= count; ++k) inserted.push_back(first + (hole.start - first + k) % count);
    inserted.push_back(loop_[at]);
    loop_.insert(loop_.begin() + static_cast<std::ptrdiff_t>(at) + 1, inserted.begin(), inserted.end());
  }

  const PlanePolygon& polygon_;
  const Context& context_;
  std::vector<std::uint32_t> loop_;
  bool is_possible_ = true;
};

}  // namespace

bool PlanePolygon::add_loop(std::span<const Point> loop) {
  const bool is_outline = loop_starts.empty();
  loop_starts.push_back(static_cast<std::uint32_t>(points.size()));
  points.insert(points.end(), loop.begin(), loop.end());
  if ((doubled_area(loop) > 0) == is_outline) return true;
  std::reverse(points.end() - static_cast<std::ptrdiff_t>(loop.size()), points.end());
  return false;
}

std::optional<std::vector<Triangle>> triangulate(const PlanePolygon& polygon, EarOrder order, const Context& context) {
  const JoinedLoop joined(polygon, context);
  if (!joined.is_possible()) return std::nullopt;
  const std::vector<std::uint32_t>& loop = joined.indices();
  std::vector<Point> points;
  for (const std::uint32_t index : loop) points.push_back(polygon.points[index]);
  std::vector<Triangle> triangles(loop.size() - 2);
  std::int64_t work_left = std::numeric_limits<std::int64_t>::max();
  if (!clip_ears(points, order, triangles, work_left, context)) return std::nullopt;
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = loop[corner];
  }
  return triangles;
}

}  // namespace blum::detail
