#include "surface_map/distance_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "blum/core/inline_list.hpp"
#include "blum/geometry/closest_point.hpp"

namespace blum::surface {
namespace {

/// Greatest number of primitives at one site that are examined.
constexpr std::size_t most_primitives = 16;
using Primitives = std::span<const std::uint32_t>;
using Corners = std::array<const FacingPoint*, 3>;

Primitives primitives_at(const FacingSurface& surface, SiteId site) {
  const Primitives all = surface.primitives_at(site);
  return all.first(std::min(all.size(), most_primitives));
}

bool contains(Primitives list, std::uint32_t primitive) {
  return std::find(list.begin(), list.end(), primitive) != list.end();
}

double longest_side(const Corners& corners) {
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    squared = std::max(squared, squared_length(corners[k]->point - corners[(k + 1) % 3]->point));
  }
  return std::sqrt(squared);
}

/// Returns the bound that one primitive yields. The distance from a primitive is a convex function, so it is largest at
/// a corner of the triangle.
double bound_by_primitive(const Corners& corners, const std::array<Primitives, 3>& lists, const FacingSurface& surface,
                          std::uint32_t primitive) {
  const std::array<Vec3d, 3> facing = surface.corners_of(primitive);
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& at = corners[k]->point;
    const bool is_closest = contains(lists[k], primitive);
    const Vec3d closest = is_closest ? corners[k]->closest : closest_point_on_triangle(at, facing);
    squared = std::max(squared, squared_length(at - closest));
  }
  return std::sqrt(squared);
}

/// Finds the common part of two primitives: the two ends of an edge, or a vertex twice. Returns false if they have no
/// common vertex.
bool common_part(const FacingSurface& surface, std::uint32_t a, std::uint32_t b, std::array<Vec3d, 2>& part) {
  const Triangle of_a = surface.vertices_of(a);
  const Triangle of_b = surface.vertices_of(b);
  InlineList<std::uint32_t, 3> common;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_repeated = std::find(of_a.begin(), of_a.begin() + static_cast<std::ptrdiff_t>(k), of_a[k]) !=
                             of_a.begin() + static_cast<std::ptrdiff_t>(k);
    if (!is_repeated && std::find(of_b.begin(), of_b.end(), of_a[k]) != of_b.end()) common.push_back(of_a[k]);
  }
  if (common.empty()) return false;
  part = {surface.position(common[0]), surface.position(common[common.size() > 1 ? 1 : 0])};
  return true;
}

/// Returns the bound that a cut yields. The closest point of the corner lies on its own primitive, which is not the
/// middle primitive. The cut joins the points of the two sides at the corner that are closest to the common part of
/// both primitives. The corner's own primitive then bounds the corner's piece, and the middle primitive bounds the
/// rest.
double bound_by_cut(const Corners& corners, std::size_t corner, const std::array<Vec3d, 2>& common) {
  double squared = 0;
  for (const std::size_t other : {(corner + 1) % 3, (corner + 2) % 3}) {
    const auto [here, there] = closest_points_of_segments({corners[corner]->point, corners[other]->point}, common);
    squared = std::max(squared, squared_length(here - there));
  }
  return std::sqrt(squared);
}

/// Returns the bound that cuts of the triangle into pieces yield. Each piece is bounded by its distance from one
/// primitive, which is largest at a corner of the piece. The middle primitive bounds the middle piece. If the closest
/// point of a corner is not on the middle primitive, a piece is cut off there. A primitive that contains this closest
/// point bounds the piece. This primitive must touch the middle primitive.
double bound_around(const Corners& corners, const FacingSurface& surface, const std::array<Primitives, 3>& lists,
                    std::uint32_t middle, double enough) {
  double bound = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (contains(lists[k], middle)) continue;
    double best = std::numeric_limits<double>::infinity();
    for (const std::uint32_t own : lists[k]) {
      std::array<Vec3d, 2> common;
      if (common_part(surface, own, middle, common)) best = std::min(best, bound_by_cut(corners, k, common));
      if (best <= enough) break;
    }
    bound = std::max(bound, best);
    if (std::isinf(bound)) break;
  }
  return bound;
}

/// Returns the least bound_around() for all choices of the middle primitive among those that contain a closest point.
double bound_by_cuts(const Corners& corners, const FacingSurface& surface, const std::array<Primitives, 3>& lists,
                     double enough) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    for (const std::uint32_t middle : lists[k]) {
      const bool is_again = (k > 0 && contains(lists[0], middle)) || (k > 1 && contains(lists[1], middle));
      if (!is_again) best = std::min(best, bound_around(corners, surface, lists, middle, enough));
      if (best <= enough) return best;
    }
  }
  return best;
}

/// Returns the bound with the primitive closest to the centroid as the middle primitive. The closest points of all
/// corners may lie on neighbours of this primitive.
double bound_by_centroid(const Corners& corners, const FacingSurface& surface, const std::array<Primitives, 3>& lists,
                         double largest, double enough) {
  const Vec3d centroid = (corners[0]->point + corners[1]->point + corners[2]->point) / 3.0;
  double within = std::numeric_limits<double>::infinity();
  for (const FacingPoint* corner : corners) within = std::min(within, squared_length(centroid - corner->closest));
  const std::optional<NearestSite> nearest =
      surface.hierarchy().nearest(centroid, std::sqrt(within) * (1 + 1e-9) + std::numeric_limits<double>::min());
  double best = std::numeric_limits<double>::infinity();
  if (!nearest) return best;
  for (const std::uint32_t primitive : primitives_at(surface, nearest->site)) {
    best = std::min(best, bound_by_primitive(corners, lists, surface, primitive));
    if (best <= enough) break;
    best = std::min(best, std::max(largest, bound_around(corners, surface, lists, primitive, enough)));
    if (best <= enough) break;
  }
  return best;
}

}  // namespace

double distance_bound(const Corners& corners, const FacingSurface& surface, double enough) {
  const double largest = std::max({corners[0]->distance, corners[1]->distance, corners[2]->distance});
  // If a point moves, its distance changes by at most the length of the move. Each point of a triangle is at most
  // longest side / sqrt(3) away from its nearest corner.
  double best = largest + longest_side(corners) / std::numbers::sqrt3;
  if (best <= enough) return best;
  std::array<Primitives, 3> lists;
  for (std::size_t k = 0; k < 3; ++k) lists[k] = primitives_at(surface, corners[k]->site);
  for (const std::uint32_t primitive : lists[0]) {
    if (contains(lists[1], primitive) && contains(lists[2], primitive)) return largest;
  }
  best = std::min(best, std::max(largest, bound_by_cuts(corners, surface, lists, enough)));
  if (best <= enough) return best;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t primitive = lists[k][0];
    const bool is_again = (k > 0 && primitive == lists[0][0]) || (k > 1 && primitive == lists[1][0]);
    if (!is_again) best = std::min(best, bound_by_primitive(corners, lists, surface, primitive));
  }
  if (best <= enough) return best;
  return std::min(best, bound_by_centroid(corners, surface, lists, largest, enough));
}

}  // namespace blum::surface
