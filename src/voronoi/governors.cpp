#include "voronoi/governors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blum::voronoi {
namespace {

/// Whether all corners lie outside of one plane of a label's domain, or behind its triangle.
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

}  // namespace

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
