#include "voronoi/traced/proof/site_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "blum/geometry/orient3d.hpp"

namespace blum::voronoi {
namespace {

/// Bounds below are first-order estimates times a factor that covers the terms of higher order.
constexpr double safety = 4;

/// Returns the least height of a triangle, mesh units.
double least_height(const std::array<Vec3d, 3>& c) {
  const double longest = std::max({length(c[1] - c[0]), length(c[2] - c[1]), length(c[0] - c[2])});
  return longest > 0 ? length(cross(c[1] - c[0], c[2] - c[0])) / longest : 0;
}

}  // namespace

SiteBounds::SiteBounds(const TracedSites& sites, const MeshView& mesh)
    : sites_(sites), rounding_(0x1p-49 * sites.extent()) {
  // The plane of a face is that of its largest triangle.
  std::vector<double> largest(sites.size(), 0.0);
  std::vector<std::uint32_t> reference(sites.size(), 0);
  std::vector<double> height(sites.size(), 0.0);
  double away = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index face = sites.face_of(t);
    std::array<Vec3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = sites.vertices()[mesh.triangles[t][k]];
      away = std::max(away, std::abs(sites.distance(face, corners[k])));
    }
    const double size = squared_length(cross(corners[2] - corners[0], corners[1] - corners[0]));
    if (size <= largest[face]) continue;
    largest[face] = size;
    reference[face] = t;
    height[face] = least_height(corners);
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    moved_ = std::max(moved_, length(mesh.vertices[v] - sites.origin() - sites.vertices()[v]));
  }
  are_faces_exact_ = moved_ == 0;
  for (std::uint32_t t = 0; are_faces_exact_ && t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[reference[sites.face_of(t)]];
    for (const std::uint32_t v : mesh.triangles[t]) {
      const std::array<Vec3d, 4> p{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[v]};
      are_faces_exact_ = are_faces_exact_ && detail::orient3d(p[0], p[1], p[2], p[3]) == 0;
    }
  }
  // Coordinates relative to the middle of the box are rounded once.
  corner_error_ = away + 0x1p-52 * bounds(mesh).largest_coordinate() + rounding_;
  for (Index i = 0; i < sites.size(); ++i) {
    const TracedSite& site = sites[i];
    const double size = site.kind == SiteKind::face ? height[i] : site.length;
    direction_error_.push_back(site.kind == SiteKind::vertex ? 0 : safety * (corner_error_ + rounding_) / size);
  }
  add_side_errors();
}

/// Each side of a vertex's domain is a plane at right angles to an edge that ends in the vertex.
void SiteBounds::add_side_errors() {
  side_error_ = direction_error_;
  std::map<std::uint32_t, double> largest;
  for (Index i = 0; i < sites_.size(); ++i) {
    if (sites_[i].kind != SiteKind::edge) continue;
    for (const std::uint32_t v : sites_[i].vertices) largest[v] = std::max(largest[v], direction_error_[i]);
  }
  for (Index i = 0; i < sites_.size(); ++i) {
    if (sites_[i].kind == SiteKind::vertex) side_error_[i] = largest[sites_[i].vertices[0]];
  }
}

LinearBound SiteBounds::distance(Index i, const Vec3d& x, double reach) const {
  const TracedSite& site = sites_[i];
  LinearBound out;
  out.value = {sites_.distance(i, x), corner_error_ + rounding_ + direction_error_[i] * length(x - site.point)};
  out.slope = sites_.gradient(i, x);
  out.turned = direction_error_[i] + 0x1p-49;
  if (site.kind == SiteKind::face) return out;
  // The second derivative of the distance from a line or a point is at most one over the distance.
  const double least = out.value.value - out.value.error - reach;
  out.bend = least > 0 ? 1 / least : std::numeric_limits<double>::infinity();
  out.turned += out.value.error * out.bend;
  return out;
}

LinearBound SiteBounds::height(const DomainSide& side, Index i, Index k, const Vec3d& x) const {
  LinearBound out;
  out.turned = side_error_[i] + side_error_[k] + 0x1p-49;
  out.value = {side.height(x), corner_error_ + rounding_ + out.turned * length(x - side.ends[0])};
  out.slope = side.normal;
  return out;
}

}  // namespace blum::voronoi
