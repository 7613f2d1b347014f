#include "medial_axis/surface/clip_points.hpp"

#include <algorithm>

namespace blum {
namespace {

Vec3d unit(const Vec3d& v) {
  const double size = length(v);
  return size > 0 ? v / size : Vec3d{};
}

Vec3d in_plane(Vec3d v, std::size_t axis) {
  v[axis] = 0;
  return unit(v);
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

}  // namespace blum
