#include "voronoi/traced/sheet_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/plane_polygon.hpp"

namespace blum::voronoi {
namespace {

using Point = WallMap::Point;
constexpr std::uint32_t none = 0xffffffff;

double cross_of(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Returns true if d lies clearly inside the circle through a, b and c, which run counterclockwise.
bool is_in_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double ax = a[0] - d[0], ay = a[1] - d[1], bx = b[0] - d[0], by = b[1] - d[1], cx = c[0] - d[0],
               cy = c[1] - d[1];
  const double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  const double det = aa * (bx * cy - by * cx) - bb * (ax * cy - ay * cx) + cc * (ax * by - ay * bx);
  return det > 1e-9 * aa * (bb + cc);
}

class Refinement {
 public:
  Refinement(const WallMap& map, SheetTriangles& out, double chord, double longest, const Context& context)
      : map_(map), out_(out), chord_(chord), longest_(longest), context_(context) {}

  void run() {
    flip_all();
    constexpr int most_passes = 40;
    for (int k = 0; k < most_passes && split_all(); ++k) {
      flip_all();
      throw_if_cancelled(context_);
    }
  }

  /// Flips inner edges until they satisfy the Delaunay condition in the plane.
  void flip_all() {
    constexpr int most_passes = 30;
    for (int pass = 0; pass < most_passes; ++pass) {
      bool is_any = false;
      std::vector<bool> is_changed(out_.triangles.size(), false);
      const Sides all = sides();
      for (const auto& [ends, at] : all) {
        if (at[1] == none || is_changed[at[0]] || is_changed[at[1]]) continue;
        auto [a, b] = ends;
        const std::uint32_t c = apex(at[0], a, b), d = apex(at[1], a, b);
        const auto& p = out_.plane;
        if (!runs_along(at[0], a, b)) std::swap(a, b);
        if (c == d || all.contains(key(c, d))) continue;
        // The flipped triangles c-d must both be counterclockwise.
        const double least = 1e-12 * (std::abs(cross_of(p[a], p[b], p[c])) + std::abs(cross_of(p[a], p[b], p[d])));
        if (cross_of(p[c], p[a], p[d]) <= least || cross_of(p[d], p[b], p[c]) <= least) continue;
        if (!is_in_circle(p[a], p[b], p[c], p[d])) continue;
        out_.triangles[at[0]] = {c, a, d};
        out_.triangles[at[1]] = {d, b, c};
        is_changed[at[0]] = is_changed[at[1]] = true;
        is_any = true;
      }
      if (!is_any) return;
    }
  }

 private:
  /// Sides of triangles by their ends, the smaller one first: up to two triangles.
  using Sides = std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::uint32_t, 2>>;

  static std::pair<std::uint32_t, std::uint32_t> key(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
  }

  [[nodiscard]] Sides sides() const {
    Sides out;
    for (std::uint32_t t = 0; t < out_.triangles.size(); ++t) {
      const Triangle& corners = out_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        auto& place = out.try_emplace(key(corners[k], corners[(k + 1) % 3]), std::array{none, none}).first->second;
        (place[0] == none ? place[0] : place[1]) = t;
      }
    }
    return out;
  }

  [[nodiscard]] std::uint32_t apex(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t v : out_.triangles[t]) {
      if (v != a && v != b) return v;
    }
    return a;
  }

  /// Returns true if b follows a in a triangle.
  [[nodiscard]] bool runs_along(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
    const Triangle& corners = out_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] == a) return corners[(k + 1) % 3] == b;
    }
    return false;
  }

  [[nodiscard]] Point middle(std::uint32_t a, std::uint32_t b) const {
    return {0.5 * (out_.plane[a][0] + out_.plane[b][0]), 0.5 * (out_.plane[a][1] + out_.plane[b][1])};
  }

  /// Returns how far the sheet is from the mean of some corners, in place or in distance from its sites.
  [[nodiscard]] double error_at(const Point& p, std::initializer_list<std::uint32_t> corners) const {
    const Vec3d x = map_.from_plane(p);
    Vec3d mean;
    double radius = 0;
    for (const std::uint32_t v : corners) {
      mean += out_.points[v] / static_cast<double>(corners.size());
      radius += map_.radius(out_.points[v]) / static_cast<double>(corners.size());
    }
    return std::max(length(x - mean), std::abs(map_.radius(x) - radius));
  }

  std::uint32_t add(const Point& p) {
    out_.plane.push_back(p);
    out_.points.push_back(map_.from_plane(p));
    return static_cast<std::uint32_t>(out_.points.size() - 1);
  }

  /// Splits inner edges and triangles whose middles are too far from the sheet, the worst edges first.
  bool split_all() {
    struct Edge {
      double error;  ///< relative to what is allowed
      std::uint32_t a, b;
      std::array<std::uint32_t, 2> at;
    };
    std::vector<Edge> edges;
    for (const auto& [ends, at] : sides()) {
      if (at[1] == none) continue;
      const auto& [a, b] = ends;
      const double error =
          std::max(error_at(middle(a, b), {a, b}) / chord_, length(out_.points[a] - out_.points[b]) / longest_);
      if (error > 1) edges.push_back({error, a, b, at});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) {
      return p.error != q.error ? p.error > q.error : std::pair(p.a, p.b) < std::pair(q.a, q.b);
    });
    const std::size_t count = out_.triangles.size();
    std::vector<bool> is_changed(count, false);
    for (const Edge& edge : edges) {
      if (is_changed[edge.at[0]] || is_changed[edge.at[1]]) continue;
      const std::uint32_t m = add(middle(edge.a, edge.b));
      for (const std::uint32_t t : edge.at) {
        is_changed[t] = true;
        Triangle second = out_.triangles[t];
        std::replace(out_.triangles[t].begin(), out_.triangles[t].end(), edge.a, m);
        std::replace(second.begin(), second.end(), edge.b, m);
        out_.triangles.push_back(second);
      }
    }
    bool is_any = !edges.empty();
    for (std::uint32_t t = 0; t < count; ++t) {
      if (is_changed[t]) continue;
      const auto [a, b, c] = out_.triangles[t];
      const auto& p = out_.plane;
      const Point centre{(p[a][0] + p[b][0] + p[c][0]) / 3, (p[a][1] + p[b][1] + p[c][1]) / 3};
      if (error_at(centre, {a, b, c}) <= chord_) continue;
      if (!(cross_of(p[a], p[b], p[c]) > 0)) continue;
      const std::uint32_t m = add(centre);
      out_.triangles[t] = {a, b, m};
      out_.triangles.push_back({b, c, m});
      out_.triangles.push_back({c, a, m});
      is_any = true;
    }
    return is_any;
  }

  const WallMap& map_;
  SheetTriangles& out_;
  const double chord_;
  const double longest_;
  const Context& context_;
};

/// Returns true if no triangle of a sheet is turned over.
bool is_one_to_one(const SheetTriangles& sheet) {
  double largest = 0;
  double least = 0;
  for (const auto& [a, b, c] : sheet.triangles) {
    const double area = cross_of(sheet.plane[a], sheet.plane[b], sheet.plane[c]);
    largest = std::max(largest, area);
    least = std::min(least, area);
  }
  return least >= -1e-9 * largest;
}

}  // namespace

std::optional<SheetTriangles> sheet_triangles(const WallMap& map, const std::vector<std::vector<Vec3d>>& loops,
                                              double chord, double longest, const Context& context) {
  SheetTriangles out;
  detail::PlanePolygon polygon;
  std::vector<std::uint32_t> number;  // of each point of the polygon
  for (const std::vector<Vec3d>& loop : loops) {
    std::vector<Point> flat;
    const auto first = static_cast<std::uint32_t>(out.points.size());
    for (const Vec3d& x : loop) {
      flat.push_back(map.to_plane(x));
      out.points.push_back(x);
      number.push_back(static_cast<std::uint32_t>(number.size()));
    }
    out.plane.insert(out.plane.end(), flat.begin(), flat.end());
    if (!polygon.add_loop(flat)) std::reverse(number.begin() + first, number.end());
  }
  const auto triangles = detail::triangulate(polygon, detail::EarOrder::in_turn, context);
  if (!triangles) return std::nullopt;
  for (const Triangle& t : *triangles) out.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  Refinement(map, out, chord, longest, context).run();
  return is_one_to_one(out) ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<SheetTriangles> narrow_sheet_triangles(const WallMap& map, const std::vector<Vec3d>& loop, double chord,
                                                     const Context& context) {
  const std::size_t count = loop.size();
  std::vector<Point> plane;
  std::vector<double> way{0};  // along the loop, to each point and back to the first one
  for (std::size_t k = 0; k < count; ++k) {
    plane.push_back(map.to_plane(loop[k]));
    way.push_back(way.back() + length(loop[(k + 1) % count] - loop[k]));
  }
  if (std::abs(detail::doubled_area(plane)) > way.back() * chord) return std::nullopt;
  // The ends are far apart, and divide the loop into two sides.
  const auto furthest_from = [&](std::size_t from) {
    const auto closer = [&](const Vec3d& a, const Vec3d& b) {
      return squared_length(a - loop[from]) < squared_length(b - loop[from]);
    };
    return static_cast<std::size_t>(std::max_element(loop.begin(), loop.end(), closer) - loop.begin());
  };
  std::size_t last = furthest_from(0);
  std::size_t first = furthest_from(last);
  if (first > last) std::swap(first, last);
  if (first == last) return std::nullopt;
  // Both sides bend outwards, counterclockwise, so that the polygon is convex.
  SheetTriangles out{loop, {}, {}};
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_lower = k >= first && k <= last;
    const double to_first = way[k] >= way[first] ? way[k] - way[first] : way[k] - way[first] + way.back();
    const double lower = way[last] - way[first];
    const double share = is_lower ? to_first / lower : 1 - (to_first - lower) / (way.back() - lower);
    out.plane.push_back({share, (is_lower ? -1 : 1) * share * (1 - share)});
  }
  detail::PlanePolygon polygon;
  std::ignore = polygon.add_loop(out.plane);
  auto triangles = detail::triangulate(polygon, detail::EarOrder::in_turn, context);
  if (!triangles) return std::nullopt;
  out.triangles = std::move(*triangles);
  const double infinite = std::numeric_limits<double>::infinity();
  Refinement(map, out, infinite, infinite, context).flip_all();
  return out;
}

}  // namespace blum::voronoi
