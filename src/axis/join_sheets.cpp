#include "axis/join_sheets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "axis/rims.hpp"
#include "blum/geometry/closest_point.hpp"

namespace blum::detail {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the smaller vertex first

/// Rounds in which one vertex is joined to sheets that meet there.
constexpr int most_sheets_at_vertex = 8;
constexpr int most_steps = 10000;

Edge edge_of(std::uint32_t a, std::uint32_t b) {
  return std::minmax(a, b);
}

/// Point of a triangle that lies near a vertex: one of its corners, a point of a side, or an inner point.
struct Meeting {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
  int corner = -1;  ///< 0 to 2 if the vertex lies at a corner
  int side = -1;    ///< 0 to 2 if the vertex lies on the side from this corner to the next
};

/// Point where the path from a border vertex along its edge leaves a triangle of another sheet.
struct Passage {
  Edge side;
  Vec3d at;
  double off = std::numeric_limits<double>::infinity();  ///< distance from the border edge
};

class SheetJoiner {
 public:
  SheetJoiner(const SheetsToJoin& sheets, const Context& context)
      : axis_vertices_(sheets.axis_vertices),
        tolerance_(sheets.tolerance.begin(), sheets.tolerance.end()),
        context_(context),
        search_(sheets.mesh),
        parts_of_(search_.mesh().triangles.size()),
        at_vertex_(search_.mesh().vertices.size()) {
    out_.positions = search_.mesh().vertices;
    for (std::uint32_t t = 0; t < parts_of_.size(); ++t) add(search_.mesh().triangles[t], t);
    for (std::uint32_t k = 0; k < sheets.borders.size(); ++k) {
      borders_.emplace(edge_of(sheets.borders[k][0], sheets.borders[k][1]), k);
    }
  }

  JoinedSheets run() {
    join_vertices();
    join_edges();
    remove_dead_triangles();
    return std::move(out_);
  }

 private:
  using Triangle = std::array<std::uint32_t, 3>;

  [[nodiscard]] const Vec3d& at(std::uint32_t v) const { return out_.positions[v]; }
  [[nodiscard]] const Triangle& triangle(std::uint32_t t) const { return out_.triangles[t]; }
  [[nodiscard]] bool has(std::uint32_t t, std::uint32_t v) const {
    return std::find(triangle(t).begin(), triangle(t).end(), v) != triangle(t).end();
  }
  [[nodiscard]] Vec3d area_vector(std::uint32_t t) const {
    const auto& [a, b, c] = triangle(t);
    return cross(at(b) - at(a), at(c) - at(a));
  }

  // --- Changes of the mesh.

  void add(const Triangle& corners, std::uint32_t first) {
    const auto t = static_cast<std::uint32_t>(out_.triangles.size());
    out_.triangles.push_back(corners);
    out_.first.push_back(first);
    is_alive_.push_back(true);
    parts_of_[first].push_back(t);
    for (const std::uint32_t v : corners) at_vertex_[v].push_back(t);
  }

  void remove(std::uint32_t t) {
    is_alive_[t] = false;
    for (const std::uint32_t v : triangle(t)) std::erase(at_vertex_[v], t);
    std::erase(parts_of_[out_.first[t]], t);
  }

  void replace(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
    std::erase(at_vertex_[from], t);
    at_vertex_[to].push_back(t);
    std::replace(out_.triangles[t].begin(), out_.triangles[t].end(), from, to);
  }

  std::uint32_t add_vertex(const Edge& edge, const Vec3d& position, double tolerance) {
    const auto v = static_cast<std::uint32_t>(out_.positions.size());
    const double part = length(position - at(edge.first)) / length(at(edge.second) - at(edge.first));
    out_.new_vertices.push_back({{edge.first, edge.second}, part});
    out_.positions.push_back(position);
    tolerance_.push_back(tolerance);
    at_vertex_.emplace_back();
    return v;
  }

  [[nodiscard]] std::vector<std::uint32_t> triangles_of(const Edge& edge) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : at_vertex_[edge.first]) {
      if (has(t, edge.second)) found.push_back(t);
    }
    return found;
  }

  /// Divides all triangles of an edge at a vertex.
  void split(const Edge& edge, std::uint32_t v) {
    for (const std::uint32_t t : triangles_of(edge)) {
      if (!has(t, v)) {
        Triangle other = triangle(t);
        std::replace(other.begin(), other.end(), edge.first, v);
        add(other, out_.first[t]);
        replace(t, edge.second, v);
      } else {
        remove(t);  // Its other two sides are the parts of the edge.
      }
    }
    const auto border = borders_.extract(edge);
    if (!border) return;
    borders_.emplace(edge_of(edge.first, v), border.mapped());
    borders_.emplace(edge_of(v, edge.second), border.mapped());
  }

  void divide(std::uint32_t t, std::uint32_t v) {
    const Triangle whole = triangle(t);
    for (std::size_t k = 1; k < 3; ++k) {
      Triangle part = whole;
      part[k] = v;
      add(part, out_.first[t]);
    }
    replace(t, whole[0], v);
  }

  /// Replaces a vertex of a strip's border by another vertex.
  void merge(std::uint32_t from, std::uint32_t to) {
    for (const std::uint32_t t : std::vector(at_vertex_[from])) {
      if (has(t, to)) {
        remove(t);
      } else {
        replace(t, from, to);
      }
    }
    std::vector<std::pair<Edge, std::uint32_t>> moved;
    for (const auto& border : borders_) {
      if (border.first.first == from || border.first.second == from) moved.emplace_back(border);
    }
    for (const auto& [edge, index] : moved) {
      borders_.erase(edge);
      const std::uint32_t other = edge.first == from ? edge.second : edge.first;
      if (other != to) borders_.emplace(edge_of(to, other), index);
    }
  }

  // --- Vertices of borders.

  void join_vertices() {
    std::set<std::uint32_t> vertices;
    for (const auto& [edge, index] : borders_) {
      for (const std::uint32_t v : {edge.first, edge.second}) {
        if (v >= axis_vertices_) vertices.insert(v);
      }
    }
    for (const std::uint32_t v : vertices) {
      throw_if_cancelled(context_);
      join_vertex(v);
    }
  }

  /// Does nothing for a vertex that was merged with another, because it has no triangles.
  void join_vertex(std::uint32_t v) {
    const std::optional<Vec3d> normal = largest_normal(at_vertex_[v]);
    for (int round = 0; normal && round < most_sheets_at_vertex; ++round) {
      const std::optional<Meeting> met = closest_meeting(v, *normal);
      if (!met) return;
      const Triangle corners = triangle(met->triangle);
      if (met->corner >= 0) {
        const std::uint32_t other = corners[static_cast<std::size_t>(met->corner)];
        merge(v, other);
        is_joined_.insert(other);
        return;
      }
      if (met->side >= 0) {
        const auto k = static_cast<std::size_t>(met->side);
        split(edge_of(corners[k], corners[(k + 1) % 3]), v);
      } else {
        divide(met->triangle, v);
      }
      is_joined_.insert(v);
    }
  }

  /// Returns the unit normal of the largest of some triangles.
  [[nodiscard]] std::optional<Vec3d> largest_normal(const std::vector<std::uint32_t>& triangles) const {
    Vec3d largest{};
    for (const std::uint32_t t : triangles) {
      const Vec3d own = area_vector(t);
      if (length(own) > length(largest)) largest = own;
    }
    const double size = length(largest);
    return size > 0 ? std::optional(largest / size) : std::nullopt;
  }

  [[nodiscard]] bool is_across(std::uint32_t t, const Vec3d& normal) const {
    const Vec3d own = area_vector(t);
    const double size = length(own);
    return size > 0 && std::abs(dot(own, normal)) <= cosine_of_meeting * size;
  }

  /// Returns the closest triangle of another sheet within the tolerance of a vertex. Corners come first, then sides.
  [[nodiscard]] std::optional<Meeting> closest_meeting(std::uint32_t v, const Vec3d& normal) const {
    Meeting best;
    const double tolerance = tolerance_[v];
    search_.bvh().for_each_within(at(v), 2 * tolerance, [&](const NearestPrimitive& near) {
      for (const std::uint32_t t : parts_of_[near.primitive]) {
        if (has(t, v) || !is_across(t, normal)) continue;
        const Meeting own = meeting(v, t);
        if (own.distance <= tolerance && comes_before(own, best)) best = own;
      }
      return true;
    });
    return best.distance <= tolerance ? std::optional(best) : std::nullopt;
  }

  static bool comes_before(const Meeting& a, const Meeting& b) {
    const auto rank = [](const Meeting& m) {
      const int kind = m.corner >= 0 ? 0 : m.side >= 0 ? 1 : 2;
      return std::tuple(std::isfinite(m.distance) ? kind : 3, m.distance, m.triangle);
    };
    return rank(a) < rank(b);
  }

  [[nodiscard]] Meeting meeting(std::uint32_t v, std::uint32_t t) const {
    const auto& [a, b, c] = triangle(t);
    const double tolerance = tolerance_[v];
    Meeting found{length(closest_point_on_triangle(at(v), {at(a), at(b), at(c)}) - at(v)), t};
    double nearest_corner = tolerance;
    double nearest_side = tolerance;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = triangle(t)[static_cast<std::size_t>(k)];
      const std::uint32_t to = triangle(t)[static_cast<std::size_t>((k + 1) % 3)];
      const double corner = length(at(from) - at(v));
      const double side = length(closest_point_on_segment(at(v), at(from), at(to)) - at(v));
      if (corner <= nearest_corner) {
        nearest_corner = corner;
        found.corner = k;
      }
      if (side <= nearest_side) {
        nearest_side = side;
        found.side = k;
      }
    }
    return found;
  }

  // --- Edges of borders.

  void join_edges() {
    std::vector<std::pair<Edge, std::uint32_t>> open(borders_.begin(), borders_.end());
    int steps = 0;
    while (!open.empty()) {
      throw_if_cancelled(context_);
      const auto [edge, border] = open.back();
      open.pop_back();
      const std::vector<std::uint32_t> own = triangles_of(edge);
      if (own.size() > 1) {
        out_.seams.push_back({{edge.first, edge.second}, border});
      } else if (own.size() == 1 && is_joined(edge.first) && is_joined(edge.second)) {
        const std::optional<std::uint32_t> next = ++steps < most_steps ? step(edge, own[0]) : std::nullopt;
        if (next) {
          open.emplace_back(edge_of(edge.first, *next), border);
          open.emplace_back(edge_of(*next, edge.second), border);
        } else {
          out_.unshared.push_back({{edge.first, edge.second}, border});
        }
      }
    }
  }

  [[nodiscard]] bool is_joined(std::uint32_t v) const { return v < axis_vertices_ || is_joined_.contains(v); }

  /// Divides a border edge where it passes from one triangle of another sheet to the next. Returns the new vertex, or
  /// nullopt if the edge does not run along another sheet.
  std::optional<std::uint32_t> step(const Edge& edge, std::uint32_t own) {
    const std::optional<Vec3d> normal = largest_normal({own});
    if (!normal) return std::nullopt;
    const double tolerance = std::max(tolerance_[edge.first], tolerance_[edge.second]);
    Passage best = passage(edge.first, edge.second, *normal, tolerance);
    if (const Passage other = passage(edge.second, edge.first, *normal, tolerance); other.off < best.off) best = other;
    if (best.off > 4 * tolerance) return std::nullopt;
    std::uint32_t next = best.side.first;
    for (const std::uint32_t end : {best.side.first, best.side.second}) {
      if (length(at(end) - best.at) < length(at(next) - best.at)) next = end;
    }
    if (length(at(next) - best.at) > tolerance) {
      next = add_vertex(best.side, best.at, tolerance);
      split(best.side, next);
    }
    split(edge, next);
    is_joined_.insert(next);
    return next;
  }

  [[nodiscard]] Passage passage(std::uint32_t from, std::uint32_t to, const Vec3d& normal, double tolerance) const {
    Passage best;
    const Vec3d way = at(to) - at(from);
    for (const std::uint32_t t : at_vertex_[from]) {
      if (has(t, to) || !is_across(t, normal)) continue;
      const auto k =
          static_cast<std::size_t>(std::find(triangle(t).begin(), triangle(t).end(), from) - triangle(t).begin());
      const std::uint32_t p = triangle(t)[(k + 1) % 3];
      const std::uint32_t q = triangle(t)[(k + 2) % 3];
      const Vec3d point = crossing_of(p, q, from, normal, tolerance);
      const double along = dot(point - at(from), way);
      if (!(along > 0) || along >= dot(way, way)) continue;
      const double off = length(closest_point_on_segment(point, at(from), at(to)) - point);
      if (off < best.off) best = {edge_of(p, q), point, off};
    }
    return best;
  }

  /// Returns the point of a side that lies in the plane of a strip, or the end of the side that is closer to it.
  [[nodiscard]] Vec3d crossing_of(std::uint32_t p, std::uint32_t q, std::uint32_t from, const Vec3d& normal,
                                  double tolerance) const {
    const double of_p = dot(at(p) - at(from), normal);
    const double of_q = dot(at(q) - at(from), normal);
    if ((of_p < 0) != (of_q < 0) && std::abs(of_p - of_q) > tolerance)
      return at(p) + (at(q) - at(p)) * (of_p / (of_p - of_q));
    return std::abs(of_p) <= std::abs(of_q) ? at(p) : at(q);
  }

  void remove_dead_triangles() {
    std::size_t kept = 0;
    std::set<Triangle> known;
    for (std::size_t t = 0; t < out_.triangles.size(); ++t) {
      Triangle sorted = out_.triangles[t];
      std::sort(sorted.begin(), sorted.end());
      if (!is_alive_[t] || !known.insert(sorted).second) continue;
      out_.triangles[kept] = out_.triangles[t];
      out_.first[kept++] = out_.first[t];
    }
    out_.triangles.resize(kept);
    out_.first.resize(kept);
  }

  std::size_t axis_vertices_;
  std::vector<double> tolerance_;
  const Context& context_;
  const SearchMesh& search_;                           ///< of the sheets before they are joined
  std::vector<std::vector<std::uint32_t>> parts_of_;   ///< by triangle before joining
  std::vector<std::vector<std::uint32_t>> at_vertex_;  ///< triangles of each vertex
  std::vector<bool> is_alive_;
  std::map<Edge, std::uint32_t> borders_;  ///< with the index of the border that it is a part of
  std::set<std::uint32_t> is_joined_;
  JoinedSheets out_;
};

}  // namespace

JoinedSheets join_sheets(const SheetsToJoin& sheets, const Context& context) {
  return SheetJoiner(sheets, context).run();
}

}  // namespace blum::detail
