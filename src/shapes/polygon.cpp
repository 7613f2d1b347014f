#include "shapes/polygon.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "blum/core/error.hpp"
#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/orient2d.hpp"
#include "shapes/generator_parts.hpp"

namespace blum::detail {
namespace {

using Point = std::array<double, 2>;

double doubled_area(std::span<const Point> loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point& a = loop[k];
    const Point& b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (a[1] - loop[0][1]) * (b[0] - loop[0][0]);
  }
  return sum;
}

/// Whether the open segments ab and cd cross or overlap, or an end of one lies inside the other.
bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto between = [](const Point& p, const Point& q, const Point& r) {  // r on the line pq: strictly inside pq
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

/// @throws InvalidOption where two sides cross or touch other than in a common corner. Sides are swept by rising x.
void require_simple(const Polygon& polygon, const Context& context) {
  struct Side {
    Point lower, upper;  // by (x, y)
  };
  std::vector<Side> sides;
  for (std::size_t loop = 0; loop < polygon.loop_starts.size(); ++loop) {
    for (std::uint32_t k = polygon.loop_starts[loop]; k < polygon.loop_end(loop); ++k) {
      const Point& a = polygon.points[k];
      const Point& b = polygon.points[k + 1 == polygon.loop_end(loop) ? polygon.loop_starts[loop] : k + 1];
      sides.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::vector<Point> sorted = polygon.points;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    throw InvalidOption("the polygon names a point twice; its outline and holes may not touch");
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.lower < b.lower; });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    throw_if_cancelled(context);
    for (std::size_t k = i + 1; k < sides.size() && sides[k].lower[0] <= sides[i].upper[0]; ++k) {
      const auto [low, high] = std::minmax(sides[i].lower[1], sides[i].upper[1]);
      if (std::max(sides[k].lower[1], sides[k].upper[1]) < low) continue;
      if (std::min(sides[k].lower[1], sides[k].upper[1]) > high) continue;
      if (!segments_meet(sides[i].lower, sides[i].upper, sides[k].lower, sides[k].upper)) continue;
      throw InvalidOption("the polygon crosses or touches itself near x = " + std::to_string(sides[k].lower[0]) +
                          ", y = " + std::to_string(sides[k].lower[1]));
    }
  }
}

/// The outline with its holes joined to it by bridges: one loop of point indices, in which bridge ends come twice.
class JoinedLoop {
 public:
  JoinedLoop(const Polygon& polygon, const Context& context) : polygon_(polygon), context_(context) {
    loop_.resize(polygon.loop_end(0));
    std::iota(loop_.begin(), loop_.end(), 0U);
    // The rightmost hole first: then the bridge of a hole can only cross the loop joined so far.
    std::vector<Hole> holes;
    for (std::size_t h = 1; h < polygon.loop_starts.size(); ++h) holes.push_back(rightmost(h));
    std::sort(holes.begin(), holes.end(), [&](const Hole& a, const Hole& b) {
      return polygon.points[a.start] != polygon.points[b.start] ? polygon.points[a.start] > polygon.points[b.start]
                                                                : a.start < b.start;
    });
    for (const Hole& hole : holes) join(hole);
  }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return loop_; }

 private:
  struct Hole {
    std::size_t loop = 0;
    std::uint32_t start = 0;  ///< its largest point by (x, y)
  };

  [[nodiscard]] Hole rightmost(std::size_t loop) const {
    std::uint32_t best = polygon_.loop_starts[loop];
    for (std::uint32_t i = best; i < polygon_.loop_end(loop); ++i) {
      if (polygon_.points[i] > polygon_.points[best]) best = i;
    }
    return {loop, best};
  }

  /// Whether the ray from loop_[at] to the point starts inside the polygon at that corner.
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
    // The closest first, which nearly always is free.
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
    throw InvalidOption("the polygon cannot be triangulated: a hole lies outside the outline or in another hole");
  }

  /// Inserts: the hole's loop from its start back to its start, and the bridge's end once more.
  void splice(std::size_t at, const Hole& hole) {
    std::vector<std::uint32_t> inserted;
    const std::uint32_t first = polygon_.loop_starts[hole.loop];
    const std::uint32_t count = polygon_.loop_end(hole.loop) - first;
    for (std::uint32_t k = 0; k <= count; ++k) inserted.push_back(first + (hole.start - first + k) % count);
    inserted.push_back(loop_[at]);
    loop_.insert(loop_.begin() + static_cast<std::ptrdiff_t>(at) + 1, inserted.begin(), inserted.end());
  }

  const Polygon& polygon_;
  const Context& context_;
  std::vector<std::uint32_t> loop_;
};

}  // namespace

void Polygon::add_loop(std::span<const Point> loop) {
  require(loop.size() >= 3, "the number of points of a loop", "at least 3", static_cast<double>(loop.size()));
  const double count = static_cast<double>(points.size() + loop.size());
  require(count <= 20000, "the number of points of a polygon", "at most 20000", count);
  const double area = doubled_area(loop);
  require(area > 0 || area < 0, "the area of a loop", "finite and not 0", area);
  const bool is_outline = loop_starts.empty();
  loop_starts.push_back(static_cast<std::uint32_t>(points.size()));
  points.insert(points.end(), loop.begin(), loop.end());
  if ((area > 0) != is_outline) std::reverse(points.end() - static_cast<std::ptrdiff_t>(loop.size()), points.end());
}

std::uint32_t Polygon::loop_end(std::size_t loop) const {
  return loop + 1 < loop_starts.size() ? loop_starts[loop + 1] : static_cast<std::uint32_t>(points.size());
}

std::vector<Triangle> triangulate(const Polygon& polygon, const Context& context) {
  require_simple(polygon, context);
  const JoinedLoop joined(polygon, context);
  const std::vector<std::uint32_t>& loop = joined.indices();
  std::vector<Point> points;
  for (const std::uint32_t index : loop) points.push_back(polygon.points[index]);
  std::vector<Triangle> triangles(loop.size() - 2);
  std::int64_t work_left = std::numeric_limits<std::int64_t>::max();
  if (!clip_ears(points, EarOrder::every_other, triangles, work_left, context)) {
    throw InvalidOption("the polygon cannot be triangulated: its outline or holes cross");
  }
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = loop[corner];
  }
  return triangles;
}

}  // namespace blum::detail
