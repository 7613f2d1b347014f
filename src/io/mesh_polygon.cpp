#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// Cuts ears off a polygon until a triangle is left. An ear is a corner that turns left and whose triangle holds no
/// other corner. Only corners that do not turn left can be in the way; a grid finds those near a triangle.
///
/// When all ears turn left and the polygon is simple (holes joined by bridges allowed), the triangles cover its inside
/// exactly once whatever ears were taken, because their winding numbers add up to the polygon's.
class EarClipper {
 public:
  EarClipper(const std::vector<Point>& points, std::span<const std::uint32_t> corners, std::span<Triangle> triangles)
      : points_(points), corners_(corners), triangles_(triangles), links_(points.size()), blocks_(points.size()) {
    const std::size_t n = points.size();
    work_left_ = std::int64_t{1000} * static_cast<std::int64_t>(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      links_[i] = {i == 0 ? static_cast<std::uint32_t>(n - 1) : i - 1, i + 1 == n ? 0 : i + 1};
    }
    for (std::uint32_t i = 0; i < n; ++i) blocks_[i] = !(corner_area(i) > 0);
    make_grid();
  }

  /// False when the polygon crosses itself, or takes too much work.
  bool run() {
    std::uint32_t corner = 0;
    std::size_t left = points_.size();
    std::size_t refused = 0;
    bool flat_allowed = false;
    while (left > 3) {
      if (refused > left) {
        if (flat_allowed) return false;
        flat_allowed = true;
        refused = 0;
      }
      if (--work_left_ < 0) return false;
      const double area = corner_area(corner);
      const bool is_ear = area > 0 ? is_empty(corner) : area == 0 && flat_allowed;
      if (work_left_ < 0) return false;
      const std::uint32_t next = links_[corner].next;
      if (!is_ear) {
        corner = next;
        ++refused;
        continue;
      }
      clip(corner);
      --left;
      refused = 0;
      flat_allowed = false;
      corner = links_[next].next;  // not the neighbour: that would make a fan of needles
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

  double corner_area(std::uint32_t i) const {
    return area2(points_[links_[i].previous], points_[i], points_[links_[i].next]);
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
    blocks_[corner] = false;
    blocks_[link.previous] = !(corner_area(link.previous) > 0);
    blocks_[link.next] = !(corner_area(link.next) > 0);
  }

  std::size_t cell(double value, double lower, double scale) const {
    const double index = (value - lower) * scale;
    return index > 0 ? std::min(static_cast<std::size_t>(index), cells_ - 1) : 0;
  }
  std::size_t column(double x) const { return cell(x, lower_.x, scale_.x); }
  std::size_t row(double y) const { return cell(y, lower_.y, scale_.y); }

  /// A square grid with about one corner of those that may be in the way for each cell.
  void make_grid() {
    std::vector<std::uint32_t> blocking;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      if (blocks_[i]) blocking.push_back(i);
    }
    cells_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(blocking.size()))) + 1;
    Point upper = lower_ = points_.front();
    for (const Point& p : points_) {
      lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y)};
      upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
    }
    const auto count = static_cast<double>(cells_);
    scale_ = {upper.x > lower_.x ? count / (upper.x - lower_.x) : 0.0,
              upper.y > lower_.y ? count / (upper.y - lower_.y) : 0.0};
    starts_.assign(cells_ * cells_ + 1, 0);
    const auto cell_of = [&](std::uint32_t i) { return row(points_[i].y) * cells_ + column(points_[i].x); };
    for (const std::uint32_t i : blocking) ++starts_[cell_of(i) + 1];
    for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
    entries_.resize(blocking.size());
    std::vector<std::uint32_t> fill(starts_.begin(), starts_.end() - 1);
    for (const std::uint32_t i : blocking) entries_[fill[cell_of(i)]++] = i;
  }

  /// Whether no corner that is left lies in the triangle at this corner, its edges included. Corners at exactly the
  /// place of one of its own do not count: the ends of bridges to holes meet so.
  bool is_empty(std::uint32_t corner) {
    const std::array<Point, 3> t = {points_[links_[corner].previous], points_[corner], points_[links_[corner].next]};
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    const std::size_t first = column(x0);
    const std::size_t last = column(x1);
    const std::size_t last_row = row(y1);
    for (std::size_t r = row(y0); r <= last_row; ++r) {
      const std::size_t begin = starts_[r * cells_ + first];
      const std::size_t end = starts_[r * cells_ + last + 1];
      work_left_ -= static_cast<std::int64_t>(end - begin) + 1;
      if (work_left_ < 0) return false;
      for (std::size_t k = begin; k < end; ++k) {
        if (blocks_[entries_[k]] && is_inside(points_[entries_[k]], t)) return false;
      }
    }
    return true;
  }

  static bool is_inside(const Point& p, const std::array<Point, 3>& t) {
    return area2(t[0], t[1], p) >= 0 && area2(t[1], t[2], p) >= 0 && area2(t[2], t[0], p) >= 0 && p != t[0] &&
           p != t[1] && p != t[2];
  }

  const std::vector<Point>& points_;
  std::span<const std::uint32_t> corners_;
  std::span<Triangle> triangles_;
  std::vector<Link> links_;
  std::vector<char> blocks_;  ///< left, and not turning left
  std::size_t emitted_ = 0;
  std::int64_t work_left_ = 0;

  std::size_t cells_ = 1;  ///< on each axis
  Point lower_, scale_;
  std::vector<std::uint32_t> starts_;  ///< of each cell's part of entries_, row by row
  std::vector<std::uint32_t> entries_;
};

}  // namespace

bool cut_polygon(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners,
                 std::span<Triangle> triangles) {
  const std::vector<Point> points = flattened(vertices, corners);
  if (!points.empty() && is_strictly_convex(points)) {
    cut_as_fan(corners, triangles);
    return true;
  }
  if (!points.empty() && EarClipper(points, corners, triangles).run()) return true;
  cut_as_fan(corners, triangles);
  return false;
}

}  // namespace blum
