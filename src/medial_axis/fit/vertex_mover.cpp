#include "medial_axis/fit/vertex_mover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "blum/core/sort_unique.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/equidistant_point.hpp"
#include "medial_axis/surface/governors.hpp"
#include "medial_axis/surface/void_points.hpp"

namespace blum::detail {
namespace {

/// Queries for closest points are made at these distances from a point, in voxels, one distance after the other. Each
/// distance is at most `most_of_depth` times the depth of the point.
constexpr std::array beside{4.0, 2.0, 1.0, 0.5, 0.3};
constexpr double most_of_depth = 0.4;
/// Limits for the distances of the footprints of a round part. Each distance may exceed the smallest distance by this
/// many voxels, and by this share of the smallest distance.
constexpr double equally_far = 0.02;
constexpr double equally_far_share = 0.05;
/// A round part must have footprints in at least this number of directions from its middle. The angle between any two
/// of these must be at least `share_of_theta` times theta, clamped to `least_apart` and `most_apart` degrees.
constexpr std::size_t least_directions = 5;
constexpr double share_of_theta = 0.25;
constexpr double least_apart = 5;
constexpr double most_apart = 30;

/// Returns the unit vectors from the centre of a cube to the centres of its 6 sides and to its 8 corners.
std::array<Vec3d, 14> directions() {
  std::array<Vec3d, 14> out;
  for (std::size_t k = 0; k < 6; ++k) out[k][k / 2] = k % 2 == 0 ? 1 : -1;
  constexpr double part = std::numbers::inv_sqrt3;
  for (std::size_t k = 0; k < 8; ++k) {
    out[6 + k] = {(k & 1) != 0 ? part : -part, (k & 2) != 0 ? part : -part, (k & 4) != 0 ? part : -part};
  }
  return out;
}

std::vector<Footprint> feet_beside(const Surface& surface, const Vec3d& x, double step) {
  static const std::array<Vec3d, 14> ways = directions();
  std::vector<Footprint> feet;
  for (const Vec3d& way : ways) {
    const NearestPoint at = surface.nearest(x + way * step, {});
    feet.push_back({at.point, at.element, 7});
  }
  return feet;
}

/// Returns the footprints that are at most `limit` away from a point. If several lie in nearly the same direction, only
/// the first is returned.
std::vector<Footprint> all_around(const Vec3d& x, const std::vector<Footprint>& feet, double limit,
                                  double same_direction) {
  std::vector<Footprint> kept;
  std::vector<Vec3d> ways;
  for (const Footprint& foot : feet) {
    const Vec3d way = foot.point - x;
    const double size = length(way);
    if (!(size > 0) || size > limit) continue;
    const auto is_known = [&](const Vec3d& other) { return dot(other, way) > same_direction * size; };
    if (std::any_of(ways.begin(), ways.end(), is_known)) continue;
    ways.push_back(way / size);
    kept.push_back(foot);
  }
  return kept;
}

/// Returns two unit vectors perpendicular to a direction and to each other.
std::array<Vec3d, 2> directions_across(const Vec3d& direction) {
  const bool is_along_x = std::abs(direction.x) > 0.6;
  const Vec3d u = cross(direction, is_along_x ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0});
  const Vec3d v = cross(direction, u);
  return {u / length(u), v / length(v)};
}

/// Returns a point near the middle of a round part, or nullopt if the surface does not surround such a point on all
/// sides. This quick test saves most of the work if the part is not round.
std::optional<Vec3d> near_middle(const Surface& surface, const Vec3d& start, const NearestPoint& nearest,
                                 const RoundLimits& limits, double same_direction) {
  constexpr double most_of_way = 0.9;   // of the depth: the far side of a round part is further away
  constexpr double rounding = 1e-9;     // of the depth
  constexpr double to_the_side = 0.05;  // of the radius: a step so small that directions to walls hardly change
  if (!(nearest.distance > 0)) return std::nullopt;
  const Vec3d inwards = (start - nearest.point) / nearest.distance;
  const Vec3d beyond = start + inwards * std::min(1.25 * limits.reach, most_of_way * nearest.distance);
  Vec3d other = surface.nearest(beyond, {}).point;
  if (!(angle_at(start, nearest.point, start + (other - beyond)) > limits.theta)) return std::nullopt;
  // The point inwards that is equally far from both sides. In a round part this is the middle.
  Vec3d middle = start;
  for (int n = 0; n < 2; ++n) {
    const Vec3d from_other = start - other;
    const double slope = nearest.distance - dot(inwards, from_other);
    const double way = 0.5 * (squared_length(from_other) - nearest.distance * nearest.distance) / slope;
    // At the middle itself, rounding errors may give either sign.
    if (!(way >= -rounding * nearest.distance) || way > limits.reach) return std::nullopt;
    middle = start + inwards * way;
    other = surface.nearest(middle + inwards * (to_the_side * nearest.distance), {}).point;
  }
  const double radius = length(middle - nearest.point);
  const auto [u, v] = directions_across(inwards);
  std::vector<Footprint> feet;
  for (const Vec3d& way : {inwards, -inwards, u, -u, v, -v}) {
    feet.push_back({surface.nearest(middle + way * (to_the_side * radius), {}).point, 0, 7});
  }
  if (all_around(middle, feet, HUGE_VAL, same_direction).size() < 4) return std::nullopt;
  return middle;
}

}  // namespace

std::optional<RoundCentre> round_centre(const Surface& surface, const Vec3d& start, const RoundLimits& limits) {
  const auto& [voxel, reach, theta] = limits;
  const double apart = std::clamp(share_of_theta * theta, least_apart, most_apart);
  const double same_direction = std::cos(apart / degrees_per_radian);
  Vec3d x = start;
  std::vector<Footprint> feet;
  const NearestPoint nearest = surface.nearest(x, {});
  const std::optional<Vec3d> inner = near_middle(surface, x, nearest, limits, same_direction);
  if (!inner) return std::nullopt;
  double depth = nearest.distance;
  // A start close to the surface of a thin part may be further from the middle than the steps below reach.
  if (const double deeper = depth < voxel ? surface.nearest(*inner, {}).distance : 0; deeper > depth) {
    x = *inner;
    depth = deeper;
  }
  for (const double voxels : beside) {
    const double step = std::min(voxels * voxel, most_of_depth * depth);
    if (!(step > 0)) return std::nullopt;
    feet = feet_beside(surface, x, step);
    // If the middle is less than a step away, the distances of footprints on all sides exceed the depth by at most two
    // steps.
    if (all_around(x, feet, depth + 2 * step, same_direction).size() < least_directions) return std::nullopt;
    std::vector<Vec3d> points;
    for (const Footprint& foot : feet) points.push_back(foot.point);
    const std::optional<Vec3d> middle = EquidistantPoints(points, x).of_rank(2);
    if (!middle || squared_length(*middle - start) > reach * reach) return std::nullopt;
    x = *middle;
    depth = surface.nearest(x, {}).distance;
  }
  const double step = std::min(beside.back() * voxel, most_of_depth * depth);
  const double furthest = depth + std::min(equally_far * voxel, equally_far_share * depth);
  feet = all_around(x, feet_beside(surface, x, step), std::hypot(furthest, step), same_direction);
  if (feet.size() < least_directions) return std::nullopt;
  return RoundCentre{x, std::move(feet)};
}

double VertexMover::make(std::vector<VertexMove> moves) {
  std::vector<std::uint32_t> changed;
  for (std::uint32_t k = 0; k < moves.size(); ++k) {
    std::swap(lists_.vertices[moves[k].vertex], moves[k].other);
    move_of_[moves[k].vertex] = k + 1;
    changed.push_back(moves[k].vertex);
  }
  // If the move of a vertex is undone, other edges of the vertex may leave the solid.
  while (!changed.empty()) {
    const std::vector<std::uint32_t> edges = edges_of(changed);
    const std::vector<std::uint8_t> leaves = which_leave(edges, moves);
    changed.clear();
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (leaves[k] == 0) continue;
      for (const std::uint32_t v : incidence_.edges()[edges[k]]) {
        if (move_of_[v] == 0) continue;
        lists_.vertices[v] = moves[move_of_[v] - 1].other;
        move_of_[v] = 0;
        changed.push_back(v);
      }
    }
  }
  double furthest = 0;
  for (const VertexMove& move : moves) {
    if (move_of_[move.vertex] == 0) continue;
    furthest = std::max(furthest, length(lists_.vertices[move.vertex].position - move.other.position));
    move_of_[move.vertex] = 0;
  }
  return furthest;
}

/// Returns the edges for which the result of which_leave() may change when some vertices move.
std::vector<std::uint32_t> VertexMover::edges_of(const std::vector<std::uint32_t>& vertices) const {
  std::vector<std::uint32_t> edges;
  for (const std::uint32_t v : vertices) {
    const auto at = incidence_.edges_of_vertex()[v];
    edges.insert(edges.end(), at.begin(), at.end());
    if (surface_.voids().empty()) continue;
    for (const std::uint32_t t : incidence_.triangles_of_vertex()[v]) {
      const auto& sides = incidence_.sides()[t];
      edges.insert(edges.end(), sides.begin(), sides.end());
    }
  }
  detail::sort_unique(edges);
  return edges;
}

const AxisVertex& VertexMover::before(std::uint32_t v, const std::vector<VertexMove>& moves) const {
  return move_of_[v] == 0 ? lists_.vertices[v] : moves[move_of_[v] - 1].other;
}

std::vector<std::uint8_t> VertexMover::which_leave(const std::vector<std::uint32_t>& edges,
                                                   const std::vector<VertexMove>& moves) const {
  constexpr std::size_t edges_per_range = 256;
  std::vector<std::uint8_t> leaves(edges.size(), 0);
  parallel_for(context_, edges.size(), edges_per_range, "borders", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto& [a, b] = incidence_.edges()[edges[k]];
      if (move_of_[a] == 0 && move_of_[b] == 0) continue;
      const std::array<Stop, 2> now{stop_of(lists_.vertices[a]), stop_of(lists_.vertices[b])};
      const bool stays = paths_.is_straight(now[0], now[1]) &&
                         paths_.can_sweep({stop_of(before(a, moves)), stop_of(before(b, moves))}, now) &&
                         !moves_over_void(edges[k], moves);
      leaves[k] = stays ? 0 : 1;
    }
  });
  return leaves;
}

/// Returns true if a triangle of an edge moved over a whole void. Tests of its edges alone do not detect this.
bool VertexMover::moves_over_void(std::uint32_t e, const std::vector<VertexMove>& moves) const {
  const auto around = incidence_.triangles_of_edge()[e];
  return !surface_.voids().empty() && std::any_of(around.begin(), around.end(), [&](std::uint32_t t) {
    auto corners = lists_.triangles[t];
    std::sort(corners.begin(), corners.end());
    std::array<Vec3d, 3> from;
    std::array<Vec3d, 3> to;
    for (std::size_t k = 0; k < 3; ++k) {
      from[k] = before(corners[k], moves).position;
      to[k] = lists_.vertices[corners[k]].position;
    }
    return moves_over_any(surface_.voids(), from, to);
  });
}

}  // namespace blum::detail
