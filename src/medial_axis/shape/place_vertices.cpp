#include "medial_axis/shape/place_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "blum/core/parallel.hpp"
#include "medial_axis/surface/equidistant_point.hpp"
#include "medial_axis/surface/governors.hpp"
#include "medial_axis/surface/thin_ball.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t nodes_per_range = 256;
constexpr int most_steps = 24;
/// Greatest distance of a vertex from its lattice corner along each axis, in voxels. The squares that approximate a
/// plane have corners at most (1 + sqrt 3) / 4 voxels away from it.
constexpr double most_moved = 0.7;
/// Two distances count as equal if they differ by at most this much, in voxels.
constexpr double equal_distances = 1e-9;
constexpr double on_surface = 1e-9;    ///< voxels
constexpr double least_radius = 1e-6;  ///< voxels

/// Returns true if the voxels around a lattice corner, given as bits, are connected through faces that contain the
/// corner. The voxels around each edge at the corner must also be connected through faces.
bool are_joined_by_faces(unsigned voxels) {
  for (const unsigned axis : {1U, 2U, 4U}) {
    const unsigned u = axis == 1 ? 2 : 1;
    const unsigned v = 7U ^ axis ^ u;
    for (const unsigned side : {0U, axis}) {
      const auto has = [&](unsigned voxel) { return (voxels >> (side | voxel) & 1U) != 0; };
      const bool is_diagonal = has(0) == has(u | v) && has(u) == has(v) && has(0) != has(u);
      if (is_diagonal) return false;
    }
  }
  unsigned reached = voxels & (0U - voxels);
  for (unsigned before = 0; before != reached;) {
    before = reached;
    for (unsigned v = 0; v < 8; ++v) {
      if ((reached >> v & 1U) != 0) reached |= voxels & (1U << (v ^ 1U) | 1U << (v ^ 2U) | 1U << (v ^ 4U));
    }
  }
  return reached == voxels;
}

Vec3d corner_at(const GridSpec& grid, const std::array<std::int64_t, 3>& node) {
  return grid.position(node[0], node[1], node[2]) - grid.direction * (grid.spacing * 0.5);
}

AxisVertex vertex_on_surface(const NearestPoint& nearest) {
  AxisVertex vertex = vertex_of_one_wall(nearest.point, nearest);
  vertex.radius = 0;
  return vertex;
}

/// Point that is equally far from two footprints, p and q. No other known footprint is closer.
struct Placed {
  Vec3d x;
  Footprint p;
  Footprint q;
  NearestPoint nearest;  ///< closest point of the surface to x
};

class Placer {
 public:
  explicit Placer(const GovernorField& governors) : governors_(governors), surface_(governors.surface()) {}

  [[nodiscard]] AxisVertex place(const std::array<std::int64_t, 3>& node) const {
    const GridSpec& grid = governors_.solid().grid;
    const GovernorsAround around = governors_.around(node);
    const Vec3d corner = corner_at(grid, node);
    if (const auto joint = joint_at(around, corner)) return *joint;
    // Seams and axes of round parts are tried first: a point equally far from all footprints. If there is none, the
    // vertex moves to the nearest sheet.
    std::array<Vec3d, 8> feet;
    for (std::size_t v = 0; v < 8; ++v) feet[v] = around[v].foot.point;
    const EquidistantPoints points(feet, corner);
    for (const int rank : {3, 2}) {
      const std::optional<Vec3d> start = points.of_rank(rank);
      if (!start || !is_near(*start, corner)) continue;
      if (const auto vertex = vertex_at(settle(around, *start, corner), around)) return *vertex;
    }
    if (const auto vertex = vertex_at(settle(around, corner, corner), around)) return *vertex;
    return without_bisector(around, corner);
  }

 private:
  [[nodiscard]] bool is_near(const Vec3d& x, const Vec3d& corner) const {
    const GridSpec& grid = governors_.solid().grid;
    const Vec3d moved = grid.direction.transposed_times(x - corner);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(moved[axis]) > most_moved * grid.spacing[axis]) return false;
    }
    return true;
  }

  /// Returns the vertex at the corner itself if voxels of an image meet only at this corner or at an edge of it. If the
  /// vertex moved, edges would leave the solid.
  [[nodiscard]] std::optional<AxisVertex> joint_at(const GovernorsAround& around, const Vec3d& corner) const {
    unsigned inside = 0;
    for (unsigned v = 0; v < 8; ++v) inside |= around[v].is_inside ? 1U << v : 0U;
    if (are_joined_by_faces(inside)) return std::nullopt;
    const NearestPoint nearest = surface_.nearest(corner, around[0].foot);
    if (nearest.distance > on_surface * governors_.voxel()) return std::nullopt;
    return vertex_on_surface(nearest);
  }

  /// Makes Newton steps to the nearest point that is equally far from the closest wall and another wall.
  [[nodiscard]] std::optional<Placed> settle(const GovernorsAround& around, const Vec3d& start,
                                             const Vec3d& corner) const {
    const double voxel = governors_.voxel();
    Placed at{start, {}, {}, {}};
    Walls walls(surface_, 2 * voxel);
    for (const Governor& g : around) walls.add(g.foot, g.direction);
    for (int step = 0; step < most_steps; ++step) {
      walls.follow_to(at.x);
      const Walls::Wall& closest = walls.closest();
      if (walls.touch()) return std::nullopt;
      const Vec3d towards = (at.x - closest.foot.point) / closest.distance;
      Vec3d move;
      double least = std::numeric_limits<double>::infinity();
      for (const Walls::Wall& wall : walls.all()) {
        const Vec3d slope = towards - (at.x - wall.foot.point) / wall.distance;
        const double squared = squared_length(slope);
        if (squared < two_walls) continue;
        const double difference = wall.distance - closest.distance;
        if (difference >= least * std::sqrt(squared)) continue;
        least = difference / std::sqrt(squared);
        move = slope * (difference / squared);
        at.p = closest.foot;
        at.q = wall.foot;
      }
      if (!(least < std::numeric_limits<double>::infinity())) return std::nullopt;
      if (least <= equal_distances * voxel) {
        at.nearest = surface_.nearest(at.x, at.p);
        if (at.nearest.distance >= closest.distance - 1e-7 * voxel) return at;
        if (walls.is_full()) return std::nullopt;
        walls.add({at.nearest.point, at.nearest.element, 7}, {});
        continue;
      }
      at.x += move;
      if (!is_near(at.x, corner)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// Returns true if a point is in the solid. If the largest inner balls around the point and around a voxel's centre
  /// overlap, no query is needed.
  [[nodiscard]] bool is_inside(const GovernorsAround& around, const Vec3d& x, const NearestPoint& nearest) const {
    const bool meets = std::any_of(around.begin(), around.end(), [&](const Governor& g) {
      return g.is_inside && length(x - g.centre) < nearest.distance + length(g.centre - g.foot.point);
    });
    return meets || surface_.is_inside(x, nearest);
  }

  /// Returns the vertex at a point if the point is inside the solid. The first footprint is exact. The second one is p
  /// or q, if that is equally close.
  [[nodiscard]] std::optional<AxisVertex> vertex_at(const std::optional<Placed>& placed,
                                                    const GovernorsAround& around) const {
    // On the surface, for example at a convex edge, rounding errors determine the directions to footprints.
    if (!placed || placed->nearest.distance < least_radius * governors_.voxel()) return std::nullopt;
    AxisVertex vertex = vertex_of_one_wall(placed->x, placed->nearest);
    if (!is_inside(around, placed->x, placed->nearest)) return std::nullopt;
    const double limit = vertex.radius + 1e-6 * governors_.voxel() + 1e-9 * vertex.radius;
    for (const Footprint& foot : {placed->p, placed->q}) {
      if (length(vertex.position - foot.point) > limit) continue;
      const double angle = angle_at(vertex.position, vertex.footprints[0], foot.point);
      if (angle <= vertex.separation_angle) continue;
      vertex.footprints[1] = foot.point;
      vertex.sites[1] = surface_.site_of(foot);
      vertex.elements[1] = foot.element;
      vertex.separation_angle = angle;
    }
    return vertex.separation_angle > 0 ? std::optional(vertex) : std::nullopt;
  }

  /// Returns the middle of a thin part next to a corner outside the solid.
  [[nodiscard]] std::optional<AxisVertex> in_thin_part(const NearestPoint& touched, const Vec3d& corner) const {
    const std::optional<ThinBall> ball = thin_ball_behind(surface_, touched, corner, 2 * governors_.longest_voxel());
    return ball ? std::optional(vertex_of_ball(*ball)) : std::nullopt;
  }

  /// Returns the vertex of a corner with no point equally far from two walls within reach. The vertex is at the corner
  /// if that is inside the solid, otherwise in the middle of a thin part next to the corner. If there is none, it is at
  /// the centre of the deepest voxel. If all voxels are outside, it is on the surface.
  [[nodiscard]] AxisVertex without_bisector(const GovernorsAround& around, const Vec3d& corner) const {
    const NearestPoint nearest = surface_.nearest(corner, around[0].foot);
    if (is_inside(around, corner, nearest)) return vertex_of_one_wall(corner, nearest);
    if (const auto vertex = in_thin_part(nearest, corner)) return *vertex;
    const auto depth = [](const Governor& g) {
      const double distance = length(g.centre - g.foot.point);
      return g.is_inside ? distance : -distance;
    };
    const Governor& deepest = *std::max_element(
        around.begin(), around.end(), [&](const Governor& a, const Governor& b) { return depth(a) < depth(b); });
    if (deepest.is_inside) return vertex_of_one_wall(deepest.centre, surface_.nearest(deepest.centre, deepest.foot));
    return vertex_on_surface(surface_.nearest(deepest.foot.point, deepest.foot));
  }

  const GovernorField& governors_;
  const Surface& surface_;
};

}  // namespace

AxisVertex vertex_at_corner(const GovernorField& governors, const std::array<std::int64_t, 3>& node) {
  const Vec3d corner = corner_at(governors.solid().grid, node);
  const NearestPoint nearest = governors.surface().nearest(corner, governors.around(node)[0].foot);
  return nearest.distance > on_surface * governors.voxel() ? vertex_of_one_wall(corner, nearest)
                                                           : vertex_on_surface(nearest);
}

namespace {

/// Returns true if a straight line inside the solid shows that a vertex lies in the component that its cell represents.
/// Otherwise the vertex may lie between walls of another component.
bool is_in_component(const Witnesses& witnesses, Cell cell, const AxisVertex& vertex) {
  const GovernorField& governors = witnesses.governors();
  const CellStructure& structure = witnesses.structure();
  constexpr double furthest = 1.3;  // voxels from the corner; a move of 0.7 along each axis is 1.21 long
  const Vec3d corner = corner_at(governors.solid().grid, structure.lattice().place(node_of(cell)));
  if (length(vertex.position - corner) > furthest * governors.longest_voxel()) return false;
  if (!(vertex.radius > 0)) return false;
  // Most vertices lie in the ball around a voxel's centre, by more than the rounding error.
  bool is_in_ball = false;
  for_each_voxel_inside(governors, structure.lattice(), cell, [&](const std::array<std::int64_t, 3>& at) {
    const Governor g = governors.at(at[0], at[1], at[2]);
    is_in_ball = is_in_ball || length(vertex.position - g.centre) < 0.99 * length(g.centre - g.foot.point);
  });
  if (is_in_ball) return true;
  const std::optional<Stop> home = witnesses.deepest_voxel(cell);
  return !home || SolidPaths(governors.surface()).is_straight(*home, stop_of(vertex));
}

/// Returns a vertex in the component that a cell represents. It is at the centre of a ball that touches two walls and
/// contains a known point of the component. If no such ball is found, it is at the known point.
AxisVertex place_in_component(const Witnesses& witnesses, Cell cell) {
  const GovernorField& governors = witnesses.governors();
  const Surface& surface = governors.surface();
  const CellStructure& structure = witnesses.structure();
  const std::optional<Stop> home = witnesses.home_of(cell);
  if (!home && !structure.is_extra(cell)) {
    return vertex_at_corner(governors, structure.lattice().place(node_of(cell)));
  }
  if (!home) return vertex_on_surface(surface.nearest(structure.extra()->cell(cell).witness, {}));
  const auto ball = ball_touching(surface, home->nearest, home->at, 2 * governors.longest_voxel());
  if (!ball) return vertex_of_one_wall(home->at, home->nearest);
  const double reach = most_moved * governors.longest_voxel();
  const double distance = length(ball->centre - home->at);
  if (distance > reach) {
    const Vec3d nearer = home->at + (ball->centre - home->at) * (reach / distance);
    return vertex_of_one_wall(nearer, surface.nearest(nearer, {home->nearest.point, home->nearest.element, 7}));
  }
  return vertex_of_ball(*ball);
}

}  // namespace

Box3 box_of_vertex(const GovernorField& governors, const CellStructure& structure, Cell vertex) {
  constexpr double rounding = 1e-9;
  const GridSpec& grid = governors.solid().grid;
  const ExtraCell* extra = structure.is_extra(vertex) ? &structure.extra()->cell(vertex) : nullptr;
  const Vec3d margin = grid.spacing * rounding;
  if (extra != nullptr && extra->box) return {extra->box->lower - margin, extra->box->upper + margin};
  const Cell place = extra == nullptr ? vertex : extra->place.value_or(vertex);
  const Vec3d middle = corner_at(grid, structure.lattice().place(node_of(place)));
  const Vec3d half = grid.spacing * 0.5 + margin;
  return {middle - half, middle + half};
}

std::vector<AxisVertex> place_vertices(const Witnesses& witnesses, std::span<const Cell> cells,
                                       const Context& context) {
  const CellStructure& structure = witnesses.structure();
  const Placer placer(witnesses.governors());
  std::vector<AxisVertex> vertices(cells.size());
  parallel_for(context, cells.size(), nodes_per_range, "vertices", [&](const WorkRange& range) {
    for (std::size_t n = range.begin; n < range.end; ++n) {
      if (structure.is_extra(cells[n])) {
        vertices[n] = place_in_component(witnesses, cells[n]);
        continue;
      }
      vertices[n] = placer.place(structure.lattice().place(node_of(cells[n])));
      if (structure.extra() != nullptr && !is_in_component(witnesses, cells[n], vertices[n])) {
        vertices[n] = place_in_component(witnesses, cells[n]);
      }
    }
  });
  return vertices;
}

}  // namespace blum::detail
