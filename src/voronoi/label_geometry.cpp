#include "voronoi/label_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "blum/geometry/closest_point.hpp"
#include "voronoi/dual_cone.hpp"

namespace blum::voronoi {
namespace {

/// Returns true if all corners lie outside the same plane of a label's domain, or behind the label's triangle.
bool is_apart(const LabelGeometry& labels, LabelIndex label, std::span<const Vec3d> corners) {
  const double margin = labels.rounding();
  const auto all_below = [&](const auto& height) {
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3d& q) { return height(q) < -margin; });
  };
  const PlacedLabel& placed = labels[label];
  if (placed.kind == SiteKind::face && all_below([&](const Vec3d& q) { return placed.height(q); })) return true;
  const std::span<const DomainPlane> planes = labels.planes(label);
  return std::any_of(planes.begin(), planes.end(), [&](const DomainPlane& plane) {
    return all_below([&](const Vec3d& q) { return plane.height(q); });
  });
}

/// A number as the sum of two doubles whose digits do not overlap.
struct DoubleDouble {
  double high = 0, low = 0;
};

DoubleDouble exact_difference(double a, double b) {
  const double high = a - b;
  const double part = a - high;
  return {high, (a - (high + part)) + (part - b)};
}

/// Returns a * b - c * d. Its error is about 1e-16 times a few units in the last place of the products.
double difference_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                              const DoubleDouble& d) {
  const double ab = a.high * b.high;
  const double cd = c.high * d.high;
  const double ab_low = std::fma(a.high, b.high, -ab) + (a.high * b.low + a.low * b.high);
  const double cd_low = std::fma(c.high, d.high, -cd) + (c.high * d.low + c.low * d.high);
  const DoubleDouble high = exact_difference(ab, cd);
  return high.high + (high.low + (ab_low - cd_low));
}

/// Returns the largest distance of a unit vector along a ray of a vertex's dual cone from the unit vector along the
/// first ray. For narrow cones, this is the width in radians.
double width_of_cone(const MeshView& mesh, const SiteTable& table, std::span<const std::uint32_t> edges,
                     std::uint32_t v) {
  const std::vector<Vec3d> ends = far_ends(mesh, table, v, edges);
  const std::vector<std::uint32_t> bounds = dual_cone(mesh.vertices[v], ends);
  std::vector<Vec3d> rays;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const Vec3d& next = ends[bounds[(k + 1) % bounds.size()]];
    if (!are_collinear(mesh.vertices[v], ends[bounds[k]], next)) {
      rays.push_back(unit_normal(mesh.vertices[v], ends[bounds[k]], next));
    }
  }
  double width = 0;
  for (const Vec3d& ray : rays) width = std::max(width, length(ray - rays[0]));
  return width;
}

}  // namespace

Vec3d unit(const Vec3d& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  const Vec3d scaled = v / largest;
  return scaled / length(scaled);
}

std::array<Vec3d, 2> axes_across(const Vec3d& n) {
  constexpr double steep = 0.6;
  const Vec3d other = std::abs(n.x) < steep ? Vec3d{1, 0, 0} : std::abs(n.y) < steep ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  const Vec3d first = unit(cross(n, other));
  return {first, cross(n, first)};
}

Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  std::array<DoubleDouble, 3> u;
  std::array<DoubleDouble, 3> v;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = exact_difference(b[k], a[k]);
    v[k] = exact_difference(c[k], a[k]);
  }
  return unit({difference_of_products(u[1], v[2], u[2], v[1]), difference_of_products(u[2], v[0], u[0], v[2]),
               difference_of_products(u[0], v[1], u[1], v[0])});
}

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * (180 / std::numbers::pi);
}

Quadratic PlacedLabel::along(const Vec3d& q, std::size_t axis) const {
  if (kind == SiteKind::face) {
    const double start = height(q);
    const double slope = direction[axis];
    return {slope * slope, 2 * start * slope, start * start};
  }
  if (kind == SiteKind::edge) {
    Vec3d step;
    step[axis] = 1;
    const Vec3d start = cross(q - point, direction);
    const Vec3d slope = cross(step, direction);
    return {squared_length(slope), 2 * dot(start, slope), squared_length(start)};
  }
  return {1, 2 * (q[axis] - point[axis]), squared_length(q - point)};
}

PolarDifference::PolarDifference(const LabelGeometry& labels, LabelIndex first, LabelIndex second)
    : labels_(labels), first_(labels[first]), second_(labels[second]) {
  if (const auto v = labels.common_vertex(first, second)) corner_ = labels.place(*v);
}

double PolarDifference::at(const Vec3d& q, const Vec3d& r) const {
  if (!corner_) return first_.polar(q, r) - second_.polar(q, r);
  const Vec3d from_q = q - *corner_;
  const Vec3d from_r = r - *corner_;
  return dot(second_.along(from_q), second_.along(from_r)) - dot(first_.along(from_q), first_.along(from_r));
}

double PolarDifference::error(const Vec3d& q, const Vec3d& r) const {
  const double rounding = labels_.rounding();
  if (!corner_) {
    return labels_.rounding_of_squares(std::sqrt(std::max({first_.squared_distance(q), second_.squared_distance(q),
                                                           first_.squared_distance(r), second_.squared_distance(r)})));
  }
  const Vec3d from_q = q - *corner_;
  const Vec3d from_r = r - *corner_;
  const double reach = length(first_.along(from_q)) + length(first_.along(from_r)) + length(second_.along(from_q)) +
                       length(second_.along(from_r));
  return rounding * (reach + 2 * rounding);
}

LabelGeometry::LabelGeometry(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                             const SiteLabels& labels)
    : box_(bounds(mesh)),
      centre_(box_.center()),
      size_(box_.diagonal()),
      rounding_(4e-15 * size_ + 1e-15 * box_.largest_coordinate()) {
  for (const Vec3d& p : mesh.vertices) places_.push_back(p - centre_);
  label_of_edge_.assign(table.edge_count(), outside);
  label_of_vertex_.assign(table.vertex_count(), outside);
  const IndexRows edges = edges_of_vertices(table);
  for (LabelIndex k = 0; k < labels.all().size(); ++k) {
    const Label& label = labels.all()[k];
    if (label.kind == SiteKind::edge) label_of_edge_[label.index] = k;
    if (label.kind != SiteKind::vertex) continue;
    const double width = width_of_cone(mesh, table, edges[label.index], label.index);
    if (width < thin) thin_vertices_.push_back(k);
    if (width < unseen) unseen_vertices_.push_back(k);
    if (!(width < unseen)) label_of_vertex_[label.index] = k;
  }
  add_triangles(mesh, table, sites);
  add_edges(mesh, table, sites);
  add_vertices(mesh, table, sites, edges);
  for (LabelIndex k = 0; k < labels_.size(); ++k) labels_[k].site = labels.site_of(labels.all()[k]);
  add_neighbours(table, sites);
  for (std::uint32_t k = 0; k < bisectors_.size(); ++k) {
    if (bisectors_[k].other == outside) continue;
    convex_pairs_.push_back({labels_[k / 3].site, labels_[bisectors_[k].other].site, k});
  }
  std::sort(convex_pairs_.begin(), convex_pairs_.end());
}

void LabelGeometry::add_triangles(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Vec3d, 3> p = triangle_corners(mesh, t);
    PlacedLabel label{SiteKind::face, 0, p[0] - centre_, -unit_normal(p[0], p[1], p[2]), 0, 0};
    label.first_plane = static_cast<std::uint32_t>(planes_.size());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t edge = table.triangle_edges()[t][k].value;
      const Vec3d inwards = unit(cross(unit(p[(k + 1) % 3] - p[k]), label.direction));
      DomainPlane plane{inwards, dot(inwards, p[k] - centre_), label_of_edge_[edge], edge};
      if (sites.turn[edge] == EdgeTurn::flat) {
        const auto [first, second] = sites.triangles_of[edge];
        plane.beyond = first == t ? second : first;
      }
      planes_.push_back(plane);
    }
    label.last_plane = static_cast<std::uint32_t>(planes_.size());
    labels_.push_back(label);
    corners_.push_back({p[0] - centre_, p[1] - centre_, p[2] - centre_});
    vertices_.push_back(mesh.triangles[t]);
  }
  add_bisectors(sites);
}

/// Finds the bisectors across convex edges. The normal of a bisector is a difference: of the vectors in both triangles
/// at right angles to the edge, or of both triangles' normals. The longer difference is more precise.
void LabelGeometry::add_bisectors(const PolyhedronSites& sites) {
  bisectors_.resize(3 * labels_.size());
  for (LabelIndex t = 0; t < labels_.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const DomainPlane& own = planes_[labels_[t].first_plane + k];
      if (sites.turn[own.edge] != EdgeTurn::convex) continue;
      const auto [first, second] = sites.triangles_of[own.edge];
      const LabelIndex other = first == t ? second : first;
      std::uint32_t side = labels_[other].first_plane;
      while (planes_[side].edge != own.edge) ++side;
      const Vec3d by_sides = own.normal - planes_[side].normal;
      const Vec3d by_normals = labels_[other].direction - labels_[t].direction;
      const Vec3d normal = unit(squared_length(by_sides) > squared_length(by_normals) ? by_sides : by_normals);
      bisectors_[3 * t + k] = {other, normal, dot(normal, corners_[t][k])};
    }
  }
}

Vec3d LabelGeometry::closest_point(LabelIndex label, const Vec3d& q) const {
  const std::array<Vec3d, 3>& p = corners_[label];
  switch (labels_[label].kind) {
    case SiteKind::face:
      return closest_point_on_triangle(q, p);
    case SiteKind::edge:
      return closest_point_on_segment(q, p[0], p[1]);
    default:
      return p[0];
  }
}

std::optional<Bisector> LabelGeometry::bisector(LabelIndex a, LabelIndex b) const {
  const PlacedLabel& first = labels_[a];
  const PlacedLabel& second = labels_[b];
  if (first.kind != second.kind) return std::nullopt;
  if (first.kind == SiteKind::face) {
    const ConvexPair key{first.site, second.site, 0};
    const auto known = std::lower_bound(convex_pairs_.begin(), convex_pairs_.end(), key);
    if (known != convex_pairs_.end() && (*known)[0] == first.site && (*known)[1] == second.site) {
      return bisectors_[(*known)[2]];
    }
    const Vec3d normal = second.direction - first.direction;
    return Bisector{b, normal, dot(second.direction, second.point) - dot(first.direction, first.point)};
  }
  if (first.kind == SiteKind::vertex) {
    const Vec3d normal = unit(first.point - second.point);
    return Bisector{b, normal, dot(normal, (first.point + second.point) * 0.5)};
  }
  // Let both directions point away from the common end. Then the edge at the smaller angle to a point is closer to it.
  for (const double of_a : {1.0, -1.0}) {
    for (const double of_b : {1.0, -1.0}) {
      const Vec3d& end = corners_[a][of_a > 0 ? 0 : 1];
      if (!(end == corners_[b][of_b > 0 ? 0 : 1])) continue;
      const Vec3d normal = first.direction * of_a - second.direction * of_b;
      return Bisector{b, normal, dot(normal, end)};
    }
  }
  return std::nullopt;
}

std::optional<Bisector> LabelGeometry::bisector_behind(LabelIndex a, LabelIndex b) const {
  const PlacedLabel& first = labels_[a];
  const PlacedLabel& second = labels_[b];
  if (first.kind != SiteKind::face || second.kind != SiteKind::face) return std::nullopt;
  return Bisector{b, second.direction + first.direction,
                  dot(second.direction, second.point) + dot(first.direction, first.point)};
}

bool LabelGeometry::share_reflex_edge(LabelIndex a, LabelIndex b) const {
  if (labels_[a].kind != SiteKind::face || labels_[b].kind != SiteKind::face) return false;
  const std::span<const DomainPlane> of_b = planes(b);
  const std::span<const DomainPlane> of_a = planes(a);
  return std::any_of(of_a.begin(), of_a.end(), [&](const DomainPlane& side) {
    return label_of_edge_[side.edge] != outside &&
           std::any_of(of_b.begin(), of_b.end(), [&](const DomainPlane& other) { return other.edge == side.edge; });
  });
}

bool LabelGeometry::has_corner(LabelIndex label, const Vec3d& corner) const {
  const std::span<const Vec3d> own = corners(label);
  return std::find(own.begin(), own.end(), corner) != own.end();
}

std::optional<std::uint32_t> LabelGeometry::common_vertex(LabelIndex a, LabelIndex b) const {
  for (const std::uint32_t v : vertices(a)) {
    if (has_vertex(b, v)) return v;
  }
  return std::nullopt;
}

void LabelGeometry::add_edges(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites) {
  for (const std::uint32_t edge : sites.reflex_edges) {
    const Segment& ends = table.edges()[edge];
    const std::array<Vec3d, 2> p{mesh.vertices[ends[0]], mesh.vertices[ends[1]]};
    PlacedLabel label{SiteKind::edge, 0, p[0] - centre_, unit(p[1] - p[0]), 0, 0};
    label.first_plane = static_cast<std::uint32_t>(planes_.size());
    for (const std::size_t end : {0U, 1U}) {
      const Vec3d inwards = end == 0 ? label.direction : -label.direction;
      planes_.push_back({inwards, dot(inwards, p[end] - centre_), label_of_vertex_[ends[end]], outside});
    }
    for (const std::uint32_t t : sites.triangles_of[edge]) {
      const std::uint32_t first = labels_[t].first_plane;
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (table.triangle_edges()[t][k].value != edge) continue;
        const DomainPlane side = planes_[first + k];
        planes_.push_back({-side.normal, -side.offset, t, edge});
      }
    }
    // If the edge is nearly flat, rounding of these two planes would let the domain extend below the surface. The next
    // plane prevents this.
    const auto [first, second] = sites.triangles_of[edge];
    const Vec3d upwards = unit(labels_[first].direction + labels_[second].direction);
    planes_.push_back({upwards, dot(upwards, label.point), outside, outside});
    label.last_plane = static_cast<std::uint32_t>(planes_.size());
    labels_.push_back(label);
    corners_.push_back({p[0] - centre_, p[1] - centre_, {}});
    vertices_.push_back({ends[0], ends[1], 0});
  }
}

void LabelGeometry::add_vertices(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                 const IndexRows& edges) {
  for (const std::uint32_t v : sites.reflex_vertices) {
    const Vec3d& at = mesh.vertices[v];
    PlacedLabel label{SiteKind::vertex, 0, at - centre_, {}, 0, 0};
    label.first_plane = static_cast<std::uint32_t>(planes_.size());
    const std::vector<Vec3d> ends = far_ends(mesh, table, v, edges[v]);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const Vec3d inwards = unit(at - ends[k]);
      planes_.push_back({inwards, dot(inwards, at - centre_), label_of_edge_[edges[v][k]], outside});
    }
    label.last_plane = static_cast<std::uint32_t>(planes_.size());
    labels_.push_back(label);
    corners_.push_back({at - centre_, {}, {}});
    vertices_.push_back({v, 0, 0});
  }
}

void LabelGeometry::add_neighbours(const SiteTable& table, const PolyhedronSites& sites) {
  const auto add = [&](LabelIndex a, LabelIndex b) {
    if (a == outside || b == outside) return;
    neighbours_.push_back({labels_[a].site, labels_[b].site});
    neighbours_.push_back({labels_[b].site, labels_[a].site});
  };
  for (std::uint32_t t = 0; t < table.face_count(); ++t) {
    for (const EdgeId edge : table.triangle_edges()[t]) {
      add(t, label_of_edge_[edge.value]);
      for (const std::uint32_t v : table.edges()[edge.value]) add(t, label_of_vertex_[v]);
    }
  }
  for (const std::uint32_t edge : sites.reflex_edges) {
    for (const std::uint32_t v : table.edges()[edge]) add(label_of_edge_[edge], label_of_vertex_[v]);
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
}

bool LabelGeometry::are_incident(std::uint32_t site, LabelIndex label) const {
  return are_neighbours(site, labels_[label].site);
}

bool LabelGeometry::are_neighbours(std::uint32_t site, std::uint32_t other) const {
  return std::binary_search(neighbours_.begin(), neighbours_.end(), std::array<std::uint32_t, 2>{site, other});
}

Vec3d closest_surface_point(const LabelGeometry& labels, std::span<const LabelIndex> among, const Vec3d& q) {
  Vec3d best;
  double least = std::numeric_limits<double>::infinity();
  for (const LabelIndex label : among) {
    if (labels[label].squared_distance(q) >= least) continue;
    const Vec3d point = labels.closest_point(label, q);
    const double squared = squared_length(point - q);
    if (!(squared < least)) continue;
    least = squared;
    best = point;
  }
  return best;
}

std::vector<LabelIndex> governors(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                  std::span<const Vec3d> corners, const Vec3d& middle) {
  if (among.empty()) return {};
  const Vec3d foot = closest_surface_point(labels, among, middle);
  std::vector<double> bounds;
  for (const Vec3d& corner : corners) {
    const double distance = length(corner - foot) + labels.rounding();
    bounds.push_back(distance * distance + labels.rounding_of_squares(distance));
  }
  const auto is_further = [&](LabelIndex label) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (!(labels[label].squared_distance(corners[k]) > bounds[k])) return false;
    }
    return true;
  };
  std::vector<LabelIndex> out;
  for (const LabelIndex label : among) {
    if (!is_further(label) && !is_apart(labels, label, corners)) out.push_back(label);
  }
  return out;
}

}  // namespace blum::voronoi
