#include <algorithm>
#include <cmath>
#include <numbers>

#include "blum/field/reference.hpp"

namespace blum::reference {

double segment_distance(const Vec3d& query, const Vec3d& a, const Vec3d& b) {
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  if (squared == 0) return length(query - a);
  const double t = std::clamp(dot(query - a, direction) / squared, 0.0, 1.0);
  // The closest point is computed from the nearer end, so that the rounding error of t does not grow with the segment's
  // length.
  const Vec3d closest = t <= 0.5 ? a + direction * t : b - direction * (1 - t);
  return length(query - closest);
}

double triangle_distance(const Vec3d& query, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double border =
      std::min({segment_distance(query, a, b), segment_distance(query, b, c), segment_distance(query, c, a)});
  const Vec3d normal = cross(b - a, c - a);
  const double squared_normal = squared_length(normal);
  // A triangle too flat to be oriented in double precision is treated as its border only.
  const double longest = std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
  if (!(squared_normal > 1e-28 * longest * longest)) return border;
  const bool over_face = dot(cross(b - a, query - a), normal) > 0 && dot(cross(c - b, query - b), normal) > 0 &&
                         dot(cross(a - c, query - c), normal) > 0;
  if (!over_face) return border;
  return std::min(border, std::abs(dot(query - a, normal)) / std::sqrt(squared_normal));
}

BruteForce::BruteForce(const MeshView& mesh) : mesh_(mesh), sites_(mesh), named_(mesh.vertices.size(), false) {
  for_each_named_vertex(mesh, [this](std::uint32_t v) { named_[v] = true; });
}

double BruteForce::site_distance(SiteId id, const Vec3d& query) const {
  const Site site = sites_.site(id);
  const auto vertex = [&](std::uint32_t v) { return mesh_.vertices[v]; };
  if (site.kind == SiteKind::vertex) return length(query - vertex(site.index));
  if (site.kind == SiteKind::edge) {
    const Segment& edge = sites_.edges()[site.index];
    return segment_distance(query, vertex(edge[0]), vertex(edge[1]));
  }
  const Triangle& t = mesh_.triangles[site.index];
  return triangle_distance(query, vertex(t[0]), vertex(t[1]), vertex(t[2]));
}

Nearest BruteForce::nearest(const Vec3d& query) const {
  Nearest best{HUGE_VAL, SiteId::none()};
  for (std::uint32_t i = 0; i < sites_.size(); ++i) {
    const SiteId id(i);
    if (i < named_.size() && !named_[i]) continue;
    const double distance = site_distance(id, query);
    if (distance < best.distance) best = {distance, id};
  }
  return best;
}

bool BruteForce::share_label(SiteId a, SiteId b, std::span<const std::uint32_t> labels) const {
  const auto label = [&](std::int32_t v) {
    const auto vertex = static_cast<std::uint32_t>(v);
    return labels.empty() ? vertex : labels[vertex];
  };
  for (const std::int32_t u : sites_.vertices(a)) {
    for (const std::int32_t v : sites_.vertices(b)) {
      if (u >= 0 && v >= 0 && label(u) == label(v)) return true;
    }
  }
  return false;
}

std::optional<Nearest> BruteForce::second(const Vec3d& query, SiteId first,
                                          std::span<const std::uint32_t> labels) const {
  std::optional<Nearest> best;
  for (std::uint32_t i = 0; i < sites_.size(); ++i) {
    const SiteId id(i);
    if (i < named_.size() && !named_[i]) continue;
    if (share_label(first, id, labels)) continue;
    const double distance = site_distance(id, query);
    if (!best || distance < best->distance) best = Nearest{distance, id};
  }
  return best;
}

double winding_number(const MeshView& mesh, const Vec3d& query) {
  double solid_angle = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - query;
    const Vec3d b = mesh.vertices[t[1]] - query;
    const Vec3d c = mesh.vertices[t[2]] - query;
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    const double determinant = dot(a, cross(b, c));
    const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    if (determinant != 0 || denominator != 0) solid_angle += 2 * std::atan2(determinant, denominator);
  }
  return solid_angle / (4 * std::numbers::pi);
}

}  // namespace blum::reference
