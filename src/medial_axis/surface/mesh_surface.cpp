#include "medial_axis/surface/mesh_surface.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <optional>
#include <queue>
#include <unordered_set>
#include <utility>

#include "blum/geometry/triangle_contact.hpp"
#include "medial_axis/surface/void_points.hpp"

namespace blum::detail {
namespace {

Vec3d unit(const Vec3d& v) {
  const double size = length(v);
  return size > 0 ? v / size : Vec3d{};
}

Vec3d in_plane(Vec3d v, std::size_t axis) {
  v[axis] = 0;
  return unit(v);
}

constexpr int most_steps = 64;

// The corresponding functions of the search tree are slower and round differently:
// docs/decisions/0008-closest-points.md.
Footprint closest_on_edge(const Vec3d& query, const Vec3d& a, const Vec3d& b, unsigned bit_a, unsigned bit_b) {
  const Vec3d along = b - a;
  const double squared = squared_length(along);
  const double t = squared > 0 ? dot(query - a, along) / squared : 0;
  if (!(t > 0)) return {a, 0, bit_a};
  if (t >= 1) return {b, 0, bit_b};
  return {a + along * t, 0, bit_a | bit_b};
}

Footprint closest_on_triangle(const Vec3d& query, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  const double squared = squared_length(normal);
  if (squared > 0 && dot(cross(b - a, query - a), normal) > 0 && dot(cross(c - b, query - b), normal) > 0 &&
      dot(cross(a - c, query - c), normal) > 0) {
    return {query - normal * (dot(query - a, normal) / squared), 0, 7};
  }
  Footprint best = closest_on_edge(query, a, b, 1, 2);
  for (const Footprint& other : {closest_on_edge(query, b, c, 2, 4), closest_on_edge(query, c, a, 4, 1)}) {
    if (squared_length(query - other.point) < squared_length(query - best.point)) best = other;
  }
  return best;
}

/// Returns the middle of the part of a segment in a box.
std::optional<Vec3d> middle_within(const Vec3d& a, const Vec3d& b, const Box3& box) {
  const std::optional<SegmentPart> part = part_within(a, b, box);
  if (!part) return std::nullopt;
  return a + (b - a) * part->middle();
}

}  // namespace

std::optional<SegmentPart> part_within(const Vec3d& a, const Vec3d& b, const Box3& box) {
  SegmentPart part;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = b[axis] - a[axis];
    const double to_lower = box.lower[axis] - a[axis];
    const double to_upper = box.upper[axis] - a[axis];
    if (step == 0) {
      if (to_lower > 0 || to_upper < 0) return std::nullopt;
      continue;
    }
    const double enters = std::min(to_lower / step, to_upper / step);
    const double leaves = std::max(to_lower / step, to_upper / step);
    if (enters > part.low) {
      part.low = enters;
      part.low_axis = axis;
    }
    if (leaves < part.high) {
      part.high = leaves;
      part.high_axis = axis;
    }
  }
  if (!(part.low <= part.high)) return std::nullopt;
  return part;
}

void add_clip_points(const ClippedEdge& edge, const Box3& box, std::vector<SurfacePoint>& points) {
  const auto& [a, b] = edge.ends;
  const std::optional<SegmentPart> part = part_within(a, b, box);
  if (!part) return;
  const auto& [m, n] = edge.outwards;
  points.push_back({a + (b - a) * part->middle(), -unit(m + n)});
  const auto add_side = [&](double t, std::size_t axis) {
    Vec3d at = a + (b - a) * t;
    at = max(box.lower, min(box.upper, at));
    points.push_back({at, -unit(in_plane(m, axis) + in_plane(n, axis))});
  };
  if (part->low_axis) add_side(part->low, *part->low_axis);
  if (part->high_axis) add_side(part->high, *part->high_axis);
}

void add_clip_points(const std::array<Vec3d, 3>& triangle, const Vec3d& outwards, const Box3& box,
                     std::vector<SurfacePoint>& points) {
  const auto& [a, b, c] = triangle;
  const std::array<const Vec3d*, 2> sides{&box.lower, &box.upper};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (outwards[axis] == 0) continue;
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      Vec3d at;
      at[u] = (*sides[corner & 1])[u];
      at[v] = (*sides[corner >> 1])[v];
      const auto side = [&](const Vec3d& p, const Vec3d& q) {
        return (q[u] - p[u]) * (at[v] - p[v]) - (q[v] - p[v]) * (at[u] - p[u]);
      };
      const std::array<double, 3> turns{side(a, b), side(b, c), side(c, a)};
      const bool is_left = std::all_of(turns.begin(), turns.end(), [](double turn) { return turn >= 0; });
      const bool is_right = std::all_of(turns.begin(), turns.end(), [](double turn) { return turn <= 0; });
      if (!is_left && !is_right) continue;
      at[axis] = a[axis] - (outwards[u] * (at[u] - a[u]) + outwards[v] * (at[v] - a[v])) / outwards[axis];
      if (at[axis] < box.lower[axis] || at[axis] > box.upper[axis]) continue;
      Vec3d inwards;
      inwards[axis] = outwards[axis] > 0 ? -1 : 1;
      points.push_back({at, inwards});
    }
  }
}

MeshSurface::MeshSurface(const MeshView& mesh, const SiteTable& sites, bool bounds_solid, const Context& context)
    : mesh_(mesh),
      sites_(sites),
      bounds_solid_(bounds_solid),
      bvh_(mesh, sites, context),
      normals_(mesh, sites),
      first_(mesh.vertices.size() + 1, 0),
      triangles_(3 * mesh.triangles.size()) {
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++first_[v + 1];
  }
  for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) triangles_[next[v]++] = t;
  }
  size_ = bounds(mesh).diagonal();
  if (bounds_solid) voids_ = points_of_voids(mesh, *this);
}

SiteId MeshSurface::site_of(const Footprint& foot) const {
  if (foot.corners == 7) return sites_.id({SiteKind::face, foot.element});
  const auto corner = static_cast<std::size_t>(std::countr_zero(foot.corners));
  if (std::popcount(foot.corners) == 1) return sites_.id({SiteKind::vertex, mesh_.triangles[foot.element][corner]});
  // Edge k of a triangle lies between its corners k and k + 1: bits 011, 110, 101.
  const std::size_t edge = foot.corners == 5 ? 2 : corner;
  const EdgeId id = sites_.triangle_edges()[foot.element][edge];
  return id.has_value() ? sites_.id({SiteKind::edge, id.value}) : sites_.id({SiteKind::face, foot.element});
}

Footprint MeshSurface::footprint(SiteId site, const Vec3d& centre, bool /*is_inside*/) const {
  return closest_on(sites_.triangle(site).value, centre);
}

NearestPoint MeshSurface::nearest(const Vec3d& query, const Footprint& near) const {
  // The distance of the closest point of the given element, plus a margin for rounding, bounds the search.
  constexpr double room = 1e-6;
  std::optional<NearestSite> found;
  if (near.element < mesh_.triangles.size()) {
    const double within = length(query - closest_on(near.element, query).point);
    found = bvh_.nearest(query, within + room * (within + size_));
  }
  if (!found) found = bvh_.nearest(query);
  if (found) return {found->point, found->distance, found->site, sites_.triangle(found->site).value};
  return {near.point, length(query - near.point), site_of(near), near.element};  // for a query that is not finite
}

std::optional<SurfacePart> MeshSurface::part_in(const Box3& box) const {
  std::optional<BvhPart> found = bvh_.part_in(box);
  if (!found) return std::nullopt;
  return SurfacePart{box, std::move(*found)};
}

std::optional<double> MeshSurface::first_crossing(const Vec3d& from, const Vec3d& to, const SurfacePart* part) const {
  const Ray ray{from, to - from};
  const std::optional<RayCrossing> found =
      part != nullptr ? bvh_.first_crossing(ray, part->found) : bvh_.first_crossing(ray, 1);
  if (!found) return std::nullopt;
  return found->t;
}

bool MeshSurface::crosses(const Vec3d& a, const Vec3d& b, const Vec3d& c, const SurfacePart* part) const {
  constexpr std::array<std::uint32_t, 3> other_corners{~0U, ~0U - 1, ~0U - 2};  // not used by the mesh
  const detail::ContactTriangle own{{a, b, c}, other_corners};
  if (detail::has_no_area(own.points)) return false;
  bool is_found = false;
  const auto visit = [&](TriangleId near) {
    const Triangle& t = mesh_.triangles[near.value];
    const detail::ContactTriangle wall{{mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]}, t};
    is_found = !detail::has_no_area(wall.points) && detail::contact(own, wall) == detail::Contact::crossing;
    return !is_found;
  };
  if (part != nullptr) {
    bvh_.for_each_near(own.points, part->found, visit);
  } else {
    bvh_.for_each_near(own.points, visit);
  }
  return is_found;
}

/// Calls visit(triangle) for the triangles with two given vertices, ascending. It searches the triangles of the vertex
/// that has fewer, because one vertex may have thousands.
template <class Visit>
void MeshSurface::for_each_triangle_at(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
  const auto count = [&](std::uint32_t v) { return first_[v + 1] - first_[v]; };
  if (count(b) < count(a)) std::swap(a, b);
  for (std::uint32_t at = first_[a]; at < first_[a + 1]; ++at) {
    const Triangle& t = mesh_.triangles[triangles_[at]];
    if (t[0] == b || t[1] == b || t[2] == b) visit(triangles_[at]);
  }
}

/// Calls visit(other triangle, ends of the side) for each side of a triangle and each other triangle with that side.
template <class Visit>
void MeshSurface::for_each_neighbour(std::uint32_t triangle, const Visit& visit) const {
  const Triangle& own = mesh_.triangles[triangle];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = own[k];
    const std::uint32_t b = own[(k + 1) % 3];
    for_each_triangle_at(a, b, [&](std::uint32_t other) {
      if (other != triangle) visit(other, a, b);
    });
  }
}

std::optional<std::vector<SurfacePoint>> MeshSurface::way_over(std::uint32_t from, std::uint32_t to,
                                                               const Box3& within) const {
  constexpr std::size_t most_triangles = 2000;
  struct Reached {
    std::uint32_t triangle;
    std::size_t before;
    Vec3d entry;
    double way;
  };
  std::vector<Reached> reached;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> next;
  std::unordered_set<std::uint32_t> done;
  const auto middle_of = [&](std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    const Vec3d sum = mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]];
    return max(within.lower, min(within.upper, sum / 3.0));
  };
  const Vec3d goal = middle_of(to);
  reached.push_back({from, 0, middle_of(from), 0});
  next.emplace(0.0, 0);
  while (!next.empty() && done.size() < most_triangles) {
    const std::size_t at = next.top().second;
    next.pop();
    const Reached here = reached[at];
    if (!done.insert(here.triangle).second) continue;
    if (here.triangle == to) {
      std::vector<SurfacePoint> way;
      for (std::size_t n = at; n != 0; n = reached[n].before) {
        const Vec3d sum = outwards(reached[n].triangle) + outwards(reached[reached[n].before].triangle);
        way.push_back({reached[n].entry, squared_length(sum) > 0 ? -sum / length(sum) : sum});
      }
      std::reverse(way.begin(), way.end());
      return way;
    }
    for_each_neighbour(here.triangle, [&](std::uint32_t other, std::uint32_t a, std::uint32_t b) {
      if (done.contains(other)) return;
      const std::optional<Vec3d> entry = middle_within(mesh_.vertices[a], mesh_.vertices[b], within);
      if (!entry) return;
      const double way = here.way + length(*entry - here.entry);
      next.emplace(way + length(*entry - goal), reached.size());
      reached.push_back({other, at, *entry, way});
    });
  }
  return std::nullopt;
}

std::vector<SurfacePoint> MeshSurface::points_in(const Box3& box) const {
  std::vector<SurfacePoint> points;
  bvh_.for_each_within(box.center(), 0.5 * box.diagonal(), [&](const NearestPrimitive& near) {
    const Triangle& t = mesh_.triangles[near.primitive];
    const Vec3d facing = outwards(near.primitive);
    add_clip_points({mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]}, facing, box, points);
    for_each_neighbour(near.primitive, [&](std::uint32_t other, std::uint32_t a, std::uint32_t b) {
      if (other < near.primitive) return;  // the other triangle adds this edge
      add_clip_points({{mesh_.vertices[a], mesh_.vertices[b]}, {facing, outwards(other)}}, box, points);
    });
    return true;
  });
  return points;
}

Vec3d MeshSurface::outwards(std::uint32_t element) const {
  const Triangle& t = mesh_.triangles[element];
  const Vec3d normal = cross(mesh_.vertices[t[1]] - mesh_.vertices[t[0]], mesh_.vertices[t[2]] - mesh_.vertices[t[0]]);
  const double size = length(normal);
  return size > 0 ? normal / size : Vec3d{};
}

Footprint MeshSurface::closest_on(std::uint32_t triangle, const Vec3d& query) const {
  const Triangle& t = mesh_.triangles[triangle];
  Footprint foot = closest_on_triangle(query, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  foot.element = triangle;
  return foot;
}

Footprint MeshSurface::follow(const Footprint& start, const Vec3d& query, double reach) const {
  Footprint best = closest_on(start.element, query);
  for (int step = 0; step < most_steps; ++step) {
    Footprint better = best;
    double better_squared = squared_length(query - best.point) * (1 - 1e-12);
    // Only triangles that contain the footprint are tried. Other triangles at the ends of the footprint's edge may be
    // closer, but belong to other walls.
    const Triangle& own = mesh_.triangles[best.element];
    const auto first = static_cast<std::size_t>(std::countr_zero(best.corners));
    const unsigned others = best.corners & (best.corners - 1);
    const std::uint32_t far = others == 0 ? own[first] : own[static_cast<std::size_t>(std::countr_zero(others))];
    if (best.corners == 7) break;
    for_each_triangle_at(own[first], far, [&](std::uint32_t t) {
      if (t == best.element) return;
      const Footprint other = closest_on(t, query);
      const double other_squared = squared_length(query - other.point);
      if (other_squared >= better_squared) return;
      better = other;
      better_squared = other_squared;
    });
    if (better.element == best.element) break;
    if (squared_length(better.point - start.point) > reach * reach) break;
    best = better;
  }
  return best;
}

}  // namespace blum::detail
