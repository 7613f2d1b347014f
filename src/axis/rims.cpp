#include "axis/rims.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/closest_point.hpp"

namespace blum::detail {
namespace {

constexpr double least_cosine = 0.174;  // of 80 degrees
/// A direction leads through a plane only if its component along the plane's normal is at least this.
constexpr double least_turn = 0.1;
constexpr std::uint32_t first_of_line = 2;

const Vec3d& point(const StripOutline& outline, std::uint32_t number) {
  return number < first_of_line ? outline.rim[number] : outline.line[number - first_of_line];
}

/// Returns the quality of a triangle: twice its area as projected along the outline's normal, divided by the square of
/// its longest side. It is -1 if the triangle's normal is 80 degrees or more from the outline's.
double quality(const StripOutline& outline, const std::array<std::uint32_t, 3>& triangle) {
  const Vec3d& a = point(outline, triangle[0]);
  const Vec3d& b = point(outline, triangle[1]);
  const Vec3d& c = point(outline, triangle[2]);
  const Vec3d normal = cross(b - a, c - a);
  const double along = dot(normal, outline.normal);
  if (!(along > least_cosine * length(normal))) return -1;
  return along / std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
}

/// Returns triangles over a strip. One triangle contains both ends of the rim edge and line[k]. The other triangles fan
/// out from the rim edge's ends: from the first end before line[k], from the second end after it.
std::vector<std::array<std::uint32_t, 3>> fans(std::uint32_t line_points, std::uint32_t k) {
  std::vector<std::array<std::uint32_t, 3>> triangles{{1, 0, first_of_line + k}};
  for (std::uint32_t p = 0; p + 1 < line_points; ++p) {
    triangles.push_back({p < k ? 0U : 1U, first_of_line + p, first_of_line + p + 1});
  }
  return triangles;
}

Vec3d unit(const Vec3d& v) {
  const double size = length(v);
  return size > 0 ? v / size : Vec3d{};
}

constexpr std::size_t most_in_tangent = 64;

class RimFinder {
 public:
  RimFinder(const Complex& axis, const Context& context)
      : axis_(axis),
        radius_(axis.vertex_columns.get<double>(medial_columns::radius)),
        incidence_(axis.view(), context) {}

  Rims find() {
    add_edges();
    for (std::uint32_t v = 0; v < axis_.positions.size(); ++v) {
      if (!at_vertex_[v].empty()) add_corners(v);
    }
    return std::move(rims_);
  }

 private:
  [[nodiscard]] const Vec3d& at(std::uint32_t v) const { return axis_.positions[v]; }
  [[nodiscard]] std::size_t triangles_at(std::uint32_t edge) const {
    return incidence_.triangles_of_edge()[edge].size();
  }
  [[nodiscard]] Vec3d normal_of(std::uint32_t t) const {
    const auto& [a, b, c] = axis_.triangles[t];
    return unit(cross(at(b) - at(a), at(c) - at(a)));
  }

  void add_edges() {
    at_vertex_.resize(axis_.positions.size());
    for (std::uint32_t e = 0; e < incidence_.edges().size(); ++e) {
      if (triangles_at(e) != 1) continue;
      RimEdge edge;
      edge.triangle = incidence_.triangles_of_edge()[e][0];
      const auto& sides = incidence_.sides()[edge.triangle];
      const auto side = static_cast<std::size_t>(std::find(sides.begin(), sides.end(), e) - sides.begin());
      const auto& triangle = axis_.triangles[edge.triangle];
      edge.vertices = {triangle[side], triangle[(side + 1) % 3]};
      const Vec3d along = at(edge.vertices[1]) - at(edge.vertices[0]);
      edge.normal = normal_of(edge.triangle);
      edge.outwards = unit(cross(along, edge.normal));
      edge.length = length(along);
      for (std::uint32_t end = 0; end < 2; ++end) {
        at_vertex_[edge.vertices[end]].push_back({static_cast<std::uint32_t>(rims_.edges.size()), end});
      }
      rims_.edges.push_back(edge);
    }
  }

  /// Adds corners at a vertex. Triangles around the vertex form a group if edges at the vertex, seams included, connect
  /// them. Each group with a rim edge gets one corner.
  void add_corners(std::uint32_t v) {
    const std::span<const std::uint32_t> around = incidence_.triangles_of_vertex()[v];
    detail::UnionFind groups(around.size());
    std::map<std::uint32_t, std::uint32_t> first_at;  // by edge: index in `around` of its first triangle
    for (std::uint32_t k = 0; k < around.size(); ++k) {
      for (const std::uint32_t e : incidence_.sides()[around[k]]) {
        if (!has_end(e, v)) continue;
        const auto [known, is_new] = first_at.try_emplace(e, k);
        if (!is_new) groups.join(known->second, k);
      }
    }
    std::map<std::uint32_t, std::uint32_t> corner_of;  // by group
    for (const RimEnd& end : at_vertex_[v]) {
      RimEdge& edge = rims_.edges[end.edge];
      const auto place = std::lower_bound(around.begin(), around.end(), edge.triangle) - around.begin();
      const std::uint32_t group = groups.find(static_cast<std::uint32_t>(place));
      const auto [known, is_new] = corner_of.try_emplace(group, static_cast<std::uint32_t>(rims_.corners.size()));
      if (is_new) add_corner(v, around, groups, group);
      edge.corners[end.end] = known->second;
    }
    bool is_on_sheet = false;
    for (std::uint32_t k = 0; k < around.size(); ++k) is_on_sheet = is_on_sheet || !corner_of.contains(groups.find(k));
    for (const auto& [group, corner] : corner_of) rims_.corners[corner].is_on_sheet = is_on_sheet;
    if (!is_on_sheet && corner_of.size() > 1) stay_beside(corner_of, around, groups);
  }

  /// Turns the directions of corners at one vertex so that they do not lead through the triangles of another corner.
  void stay_beside(const std::map<std::uint32_t, std::uint32_t>& corner_of, std::span<const std::uint32_t> around,
                   detail::UnionFind& groups) {
    std::vector<std::pair<std::uint32_t, Vec3d>> turned;
    for (const auto& [group, c] : corner_of) {
      for (const auto& [other_group, o] : corner_of) {
        const RimCorner& corner = rims_.corners[c];
        const RimCorner& other = rims_.corners[o];
        if (o == c || !corner.normal || !other.normal) continue;
        const Vec3d inwards = inwards_of(corner.vertex, around, groups, group);
        if (dot(inwards, *other.normal) * dot(corner.outwards, *other.normal) >= 0) continue;
        const std::optional<Vec3d> way = way_beside(corner.outwards, *corner.normal, *other.normal, {});
        if (way) turned.emplace_back(c, *way);
      }
    }
    for (const auto& [c, outwards] : turned) {
      rims_.corners[c].outwards = outwards;
      rims_.corners[c].is_beside_sheet = true;
    }
  }

  /// Returns the sum of directions from a vertex to the triangles of a group.
  [[nodiscard]] Vec3d inwards_of(std::uint32_t v, std::span<const std::uint32_t> around, detail::UnionFind& groups,
                                 std::uint32_t group) const {
    Vec3d sum{};
    for (std::uint32_t k = 0; k < around.size(); ++k) {
      if (groups.find(k) == group) sum += middle_of(around[k]) - at(v);
    }
    return sum;
  }

  void add_corner(std::uint32_t v, std::span<const std::uint32_t> around, detail::UnionFind& groups,
                  std::uint32_t group) {
    RimCorner corner;
    corner.vertex = v;
    std::vector<std::uint32_t> own;
    bool ends_seam = false;
    for (std::uint32_t k = 0; k < around.size(); ++k) {
      if (groups.find(k) != group) continue;
      const std::uint32_t t = around[k];
      own.push_back(t);
      for (const std::uint32_t e : incidence_.sides()[t]) {
        ends_seam = ends_seam || (has_end(e, v) && triangles_at(e) > 2);
      }
    }
    if (!ends_seam) corner.normal = tangent_normal(v, std::move(own));
    corner.outwards = outwards_of(v, corner.normal, around, groups, group);
    if (length(corner.outwards) == 0) {
      corner.outwards = unit(in_plane(-inwards_of(v, around, groups, group), corner.normal));
    }
    rims_.corners.push_back(corner);
  }

  /// Returns the mean normal of triangles around a vertex, weighted by area so that slivers hardly tilt it. Small
  /// triangles at rims are rough. So the mean includes connected triangles within the vertex's radius, up to about 64
  /// triangles. The weight of a large triangle is that of a triangle of the size of the radius.
  [[nodiscard]] std::optional<Vec3d> tangent_normal(std::uint32_t v, std::vector<std::uint32_t> triangles) const {
    for (std::size_t k = 0; k < triangles.size() && triangles.size() < most_in_tangent; ++k) {
      for (const std::uint32_t e : incidence_.sides()[triangles[k]]) {
        const std::span<const std::uint32_t> beside = incidence_.triangles_of_edge()[e];
        if (beside.size() != 2 || distance_to_edge(v, e) > radius_[v]) continue;
        const std::uint32_t next = beside[beside[0] == triangles[k] ? 1 : 0];
        if (std::find(triangles.begin(), triangles.end(), next) == triangles.end()) triangles.push_back(next);
      }
    }
    const double largest = radius_[v] * radius_[v];
    Vec3d sum{};
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = axis_.triangles[t];
      Vec3d own = cross(at(b) - at(a), at(c) - at(a));
      if (length(own) > largest) own = own * (largest / length(own));
      sum += dot(own, sum) < 0 ? -own : own;
    }
    return length(sum) > 0 ? std::optional(unit(sum)) : std::nullopt;
  }

  [[nodiscard]] double distance_to_edge(std::uint32_t v, std::uint32_t edge) const {
    const auto& [a, b] = incidence_.edges()[edge];
    return length(closest_point_on_segment(at(v), at(a), at(b)) - at(v));
  }

  /// Returns the mean outward direction of the rim edges of a group, weighted by length. The weight is at most three
  /// times the shortest edge. So the direction lies near the middle even between a long and a short edge, and a step in
  /// a rim hardly changes it.
  [[nodiscard]] Vec3d outwards_of(std::uint32_t v, const std::optional<Vec3d>& normal,
                                  std::span<const std::uint32_t> around, detail::UnionFind& groups,
                                  std::uint32_t group) const {
    std::vector<const RimEdge*> own;
    double shortest = std::numeric_limits<double>::infinity();
    for (const RimEnd& end : at_vertex_[v]) {
      const RimEdge& edge = rims_.edges[end.edge];
      const auto place = std::lower_bound(around.begin(), around.end(), edge.triangle) - around.begin();
      if (groups.find(static_cast<std::uint32_t>(place)) != group || length(edge.outwards) == 0) continue;
      own.push_back(&edge);
      shortest = std::min(shortest, edge.length);
    }
    Vec3d sum{};
    for (const RimEdge* const edge : own) sum += edge->outwards * std::min(edge->length, 3 * shortest);
    return unit(in_plane(sum, normal));
  }

  static Vec3d in_plane(const Vec3d& v, const std::optional<Vec3d>& normal) {
    return normal ? v - *normal * dot(v, *normal) : v;
  }
  [[nodiscard]] bool has_end(std::uint32_t edge, std::uint32_t v) const {
    const auto& ends = incidence_.edges()[edge];
    return ends[0] == v || ends[1] == v;
  }
  [[nodiscard]] Vec3d middle_of(std::uint32_t t) const {
    const auto& [a, b, c] = axis_.triangles[t];
    return (at(a) + at(b) + at(c)) / 3.0;
  }
  struct RimEnd {
    std::uint32_t edge = 0, end = 0;
  };
  const Complex& axis_;
  std::span<const double> radius_;
  Incidence incidence_;
  std::vector<std::vector<RimEnd>> at_vertex_;
  Rims rims_;
};

}  // namespace

std::optional<Vec3d> way_beside(const Vec3d& way, const Vec3d& normal, const Vec3d& other, const Vec3d& beyond) {
  const Vec3d common = cross(normal, other);
  const double ahead = dot(way, other);
  const bool is_behind = dot(beyond, other) * ahead >= 0;
  if (length(common) < sine_of_meeting || std::abs(ahead) < least_turn || !is_behind) return std::nullopt;
  const Vec3d along = unit(common) * dot(way, unit(common));
  return length(along) < least_turn ? Vec3d{} : unit(along);
}

std::optional<std::vector<std::array<std::uint32_t, 3>>> fill_strip(const StripOutline& outline) {
  const auto line_points = static_cast<std::uint32_t>(outline.line.size());
  std::optional<std::vector<std::array<std::uint32_t, 3>>> best;
  double best_quality = 0;
  for (std::uint32_t k = 0; k < line_points; ++k) {
    std::vector<std::array<std::uint32_t, 3>> triangles = fans(line_points, k);
    double worst = std::numeric_limits<double>::infinity();
    for (const auto& triangle : triangles) worst = std::min(worst, quality(outline, triangle));
    if (worst <= best_quality) continue;
    best_quality = worst;
    best = std::move(triangles);
  }
  return best;
}

bool is_strip_inside(const StripOutline& outline, std::span<const std::array<std::uint32_t, 3>> triangles,
                     FunctionRef<bool(const Vec3d&)> is_inside) {
  for (const auto& triangle : triangles) {
    Vec3d sum{};
    for (const std::uint32_t number : triangle) sum += point(outline, number);
    if (!is_inside(sum / 3.0)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k];
      const std::uint32_t b = triangle[(k + 1) % 3];
      const bool is_border = a >= first_of_line && b >= first_of_line;
      if (!is_border && !is_inside((point(outline, a) + point(outline, b)) * 0.5)) return false;
    }
  }
  return true;
}

Rims find_rims(const Complex& axis, const Context& context) {
  return RimFinder(axis, context).find();
}

}  // namespace blum::detail
