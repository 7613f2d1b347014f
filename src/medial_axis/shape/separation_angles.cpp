#include "medial_axis/shape/separation_angles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "medial_axis/cells/voxel_solid.hpp"
#include "medial_axis/surface/equidistant_point.hpp"
#include "medial_axis/surface/thin_ball.hpp"

namespace blum::detail {
namespace {

using Words = std::span<const std::uint64_t>;

/// Sets each bit of `to` that is at most `within` bits away from a set bit of `from`.
void spread_along(Words from, int within, std::span<std::uint64_t> to) {
  for (std::size_t w = 0; w < from.size(); ++w) {
    const std::uint64_t before = w > 0 ? from[w - 1] : 0;
    const std::uint64_t after = w + 1 < from.size() ? from[w + 1] : 0;
    to[w] = from[w];
    for (int n = 1; n <= within; ++n) {
      to[w] |= from[w] << n | from[w] >> n | before >> (64 - n) | after << (64 - n);
    }
  }
}

void add(Words from, std::span<std::uint64_t> to) {
  for (std::size_t w = 0; w < from.size(); ++w) to[w] |= from[w];
}

/// Clears the bits after the last voxel of a row.
void clear_beyond(std::int64_t length, std::span<std::uint64_t> row) {
  const auto used = static_cast<std::size_t>(length);
  row[used / 64] &= (std::uint64_t{1} << (used % 64)) - 1;
}

/// Voxels: greatest allowed move of a footprint when its point moves by less than one voxel.
constexpr double reach_around_axis = 1.5;
/// Voxels: at a point fitted to several footprints, a footprint counts if its distance exceeds that of the closest one
/// by at most this.
constexpr double fitted_tolerance = 0.1;
/// Voxels along each axis: greatest distance of a fitted point from the middle of its cell.
constexpr double fitted_reach = 0.5;
/// The same limit for wires that pass between all voxels, because balls in wires are found less reliably.
constexpr double wire_reach = 0.7;
constexpr int bisector_steps = 4;
constexpr double opposite_step = 0.3;  ///< voxels
/// Degrees: at this angle between two footprints, there may be others on the opposite side.
constexpr double wide_angle = 100;
constexpr double opposite_enough = 175;  ///< degrees: if an angle exceeds this, no larger angle is searched for

/// Voxels in thick parts of the solid. In thick parts, two footprints that are close together are always treated as
/// one.
class ThickParts {
 public:
  ThickParts(const GovernorField& governors, const NoiseFloor& floor, const Context& context) {
    if (floor.thin_within == 0) return;
    const VoxelSolid& solid = governors.solid();
    VoxelSet deep(solid.voxels.size());
    take_deeper_than(solid.depth.span(), floor.voxels * governors.longest_voxel(), deep, context);
    at_ = spread(deep, floor.thin_within, context);
    all_around_ = spread(deep, floor.thin_within - 1, context);
  }

  [[nodiscard]] bool contain(const std::array<std::int64_t, 3>& voxel) const {
    return at_.contains(voxel[0], voxel[1], voxel[2]);
  }
  /// Returns true if a voxel and all its 26 neighbours are in thick parts.
  [[nodiscard]] bool contain_all_around(const std::array<std::int64_t, 3>& voxel) const {
    return all_around_.contains(voxel[0], voxel[1], voxel[2]);
  }

 private:
  VoxelSet at_;
  VoxelSet all_around_;
};

/// Governors of the voxels around the lattice nodes of a layer, for one row of nodes after the other. Each governor is
/// computed once per layer, and only if it is needed.
class GovernorRows {
 public:
  GovernorRows(const GovernorField& governors, const NoiseFloor& floor, const ThickParts& thick, std::int64_t k)
      : governors_(governors),
        floor_(floor),
        thick_(thick),
        k_(k),
        chord_(2 * std::sin(0.5 * floor.angle / degrees_per_radian)) {
    const auto length = static_cast<std::size_t>(governors.solid().grid.size[0]);
    for (Row& row : rows_) row = {std::vector<Governor>(length), std::vector<std::uint8_t>(length, 0), {}};
    const SiteId any = governors.solid().site[0];
    has_rough_ = governors.surface().rough_footprint(any).has_value();
    for (Row& row : rows_) row.rough.resize(has_rough_ ? length : 0);
  }

  /// Moves to the nodes of row j. From call to call, j must ascend.
  void go_to(std::int64_t j) {
    if (j == j_ + 1) {
      std::swap(rows_[0], rows_[1]);
      std::swap(rows_[2], rows_[3]);
    }
    for (std::size_t r = 0; r < 4; ++r) {
      if (j != j_ + 1 || (r & 1U) == 1) std::fill(rows_[r].known.begin(), rows_[r].known.end(), 0);
    }
    j_ = j;
  }

  /// Returns true if the footprints of the eight voxels around a node certainly lie on one wall.
  [[nodiscard]] bool has_one_wall(std::int64_t i) {
    const VoxelSolid& solid = governors_.solid();
    const auto [x0, y0, z0] = place(i, 7);
    const std::size_t last = solid.grid.index(x0, y0, z0);
    if (has_rough_) return has_one_rough_wall(i, static_cast<double>(solid.depth[last]));
    for (std::size_t v = 0; v < 7; ++v) {
      const auto [x, y, z] = place(i, v);
      if (solid.site[solid.grid.index(x, y, z)] != solid.site[last]) return false;
    }
    return true;
  }

  [[nodiscard]] GovernorsAround around(std::int64_t i) {
    GovernorsAround out;
    for (std::size_t v = 0; v < 8; ++v) {
      const auto [x, y, z] = place(i, v);
      Row& row = rows_[v >> 1U];
      const auto at = static_cast<std::size_t>(x);
      if ((row.known[at] & 1U) == 0) row.governors[at] = governors_.at(x, y, z);
      row.known[at] |= 1U;
      out[v] = row.governors[at];
    }
    return out;
  }

 private:
  struct Row {
    std::vector<Governor> governors;
    /// For each voxel of the row; bit 0: its governor is known; bit 1: its rough footprint is known.
    std::vector<std::uint8_t> known;
    std::vector<Vec3d> rough;
  };

  [[nodiscard]] const Vec3d& rough(std::int64_t i, std::size_t v) {
    const auto [x, y, z] = place(i, v);
    Row& row = rows_[v >> 1U];
    const auto at = static_cast<std::size_t>(x);
    if ((row.known[at] & 2U) == 0) {
      const VoxelSolid& solid = governors_.solid();
      row.rough[at] = *governors_.surface().rough_footprint(solid.site[solid.grid.index(x, y, z)]);
      row.known[at] |= 2U;
    }
    return row.rough[at];
  }

  /// @param depth  depth of the last of the eight voxels around node i, mesh units.
  [[nodiscard]] bool has_one_rough_wall(std::int64_t i, double depth) {
    // Rough footprints have errors of up to half a voxel, and the node is at most one voxel away from the voxel.
    const double voxel = governors_.longest_voxel();
    if (!thick_.contain_all_around(place(i, 7))) return false;
    const double limit = std::max((floor_.voxels - 1) * voxel, chord_ * (depth - voxel) - voxel);
    const Vec3d& middle = rough(i, 7);
    for (std::size_t v = 0; v < 7; ++v) {
      if (squared_length(rough(i, v) - middle) > limit * limit) return false;
    }
    return true;
  }

  [[nodiscard]] std::array<std::int64_t, 3> place(std::int64_t i, std::size_t v) const {
    return {i - 1 + static_cast<std::int64_t>(v & 1U), j_ - 1 + static_cast<std::int64_t>(v >> 1U & 1U),
            k_ - 1 + static_cast<std::int64_t>(v >> 2U)};
  }

  const GovernorField& governors_;
  const NoiseFloor& floor_;
  const ThickParts& thick_;
  std::int64_t k_;
  std::int64_t j_ = -2;
  double chord_;  ///< distance of two footprints at the noise floor's angle, relative to their distance from the point
  bool has_rough_ = false;
  std::array<Row, 4> rows_;  ///< the four rows of voxels around a row of nodes: index y + 2 z
};

class Measure {
 public:
  Measure(const GovernorField& governors, const CellComplex& complex, const NoiseFloor& floor, const Context& context)
      : thick_(governors, floor, context),
        governors_(governors),
        surface_(governors.surface()),
        complex_(complex),
        floor_(floor),
        voxel_(governors.voxel()),
        step_(governors.longest_voxel()) {}

  using Around = GovernorsAround;

  /// Calls use(node, around) for the nodes of layer k that have cells, if the directions from the voxels around them to
  /// their footprints differ.
  template <class Use>
  void for_each_uneven_node(std::int64_t k, const Use& use) const {
    const CellLattice& lattice = complex_.lattice();
    const auto& size = lattice.size();
    GovernorRows rows(governors_, floor_, thick_, k);
    for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
      rows.go_to(j);
      for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
        const std::size_t node = lattice.node(i, j, k);
        if (complex_.bytes()[node] == 0 || rows.has_one_wall(i)) continue;
        const Around around = rows.around(i);
        if (is_uneven(around)) use(node, around);
      }
    }
  }

  /// Returns the separation angle, in degrees, at the point between two voxels that is equally far from both walls.
  /// Returns 0 if both voxels have the same wall.
  [[nodiscard]] double between(const Governor& a, const Governor& b) const {
    if (a.foot.element == b.foot.element) return 0;
    // Two outside voxels have an angle only if a thin part lies between them. Their directions then differ by at least
    // 90 degrees.
    if (!a.is_inside && !b.is_inside && dot(a.direction, b.direction) > 0) return 0;
    double low = 0;  // position between a and b at which a's wall is closer
    double high = 1;
    double t = 0.5;
    Vec3d x;
    Footprint p = a.foot;
    Footprint q = b.foot;
    for (int step = 0; step < bisector_steps; ++step) {
      x = a.centre + (b.centre - a.centre) * t;
      p = surface_.follow(a.foot, x, HUGE_VAL);
      q = surface_.follow(b.foot, x, HUGE_VAL);
      const double difference = depth_of(x, a, p) - depth_of(x, b, q);
      if (std::abs(difference) < 1e-3 * voxel_) break;
      (difference < 0 ? low : high) = t;
      // Newton step: both distances change with the slopes along the directions to their footprints, as if linear.
      const double slope = slope_along(a, b, x, a, p) - slope_along(a, b, x, b, q);
      const double next = slope > 0 ? t - difference / slope : -1;
      t = next > low && next < high ? next : 0.5 * (low + high);
    }
    if (!is_inside(a, x) || !is_inside(b, x)) return 0;
    return above_floor(x, p.point, q.point);
  }

  /// Returns the angle of an extra polygon, in degrees. It is that at the point of its interval that is equally far
  /// from the walls at both ends. In a thin round part, both ends may be on one wall. The angle is then that of the
  /// medial ball around the middle of the interval.
  [[nodiscard]] double between(const ExtraCell& polygon) const {
    std::array<Governor, 2> ends;
    for (std::size_t k = 0; k < 2; ++k) {
      const ExtraCell::End& end = polygon.ends[k];
      ends[k] = end.triangle ? governor_at(end) : governor_inside(end.point);
    }
    const double angle = between(ends[0], ends[1]);
    if (angle > wide_angle) return angle;
    const double across = in_wire(0.5 * (ends[0].centre + ends[1].centre), wire_reach);
    return across > wide_angle ? across : angle;
  }
  /// Returns the angle in the middle of a part of the solid that is so thin that no line between nodes meets it,
  /// degrees.
  [[nodiscard]] double in_wire(const ExtraCell& cell) const { return in_wire(cell.witness, HUGE_VAL); }

  /// Returns the largest angle between the directions from any two voxels around a cell to their footprints, degrees.
  [[nodiscard]] static double coarse(const Around& around, CellAxes axes) {
    double least = 1;
    for (unsigned v = 0; v < 8; ++v) {
      if ((v & axes) != axes) continue;
      for (unsigned w = v + 1; w < 8; ++w) {
        if ((w & axes) == axes) least = std::min(least, dot(around[v].direction, around[w].direction));
      }
    }
    return std::acos(std::clamp(least, -1.0, 1.0)) * degrees_per_radian;
  }

  /// Returns the angle at the point equally far from the footprints of all voxels around an edge or vertex, degrees. It
  /// returns 0 if that point is further from the middle of the cell than `fitted_reach`, or `wire_reach` for wires.
  [[nodiscard]] double fitted(const Around& around, CellAxes axes) const {
    std::array<Vec3d, 8> feet;
    std::array<const Governor*, 8> governors{};
    std::size_t count = 0;
    std::size_t inside = 0;
    Vec3d middle;
    for (unsigned v = 0; v < 8; ++v) {
      if ((v & axes) != axes) continue;
      inside += around[v].is_inside ? 1 : 0;
      governors[count] = &around[v];
      feet[count++] = around[v].foot.point;
      middle += around[v].centre;
    }
    middle *= 1.0 / static_cast<double>(count);
    const bool is_wire = inside == 0;
    // Voxels of a rod of about their own thickness determine its middle badly, so the ball there is looked for.
    if (!is_wire && inside != count) return in_rod(around[axes == 0 ? 7 : axes], middle);
    const EquidistantPoints points({feet.data(), count}, middle);
    double largest = 0;
    for (const int rank : {3, 2}) {
      const std::optional<Vec3d> x = points.of_rank(rank);
      if (!x || !is_near(*x, middle, is_wire ? wire_reach : fitted_reach)) continue;
      largest = std::max(largest, angle_of({governors.data(), count}, *x));
    }
    if (largest > 0 || !is_wire) return largest;
    // A wire may be so thin that the footprints do not determine its middle.
    const NearestPoint nearest = surface_.nearest(middle, governors[0]->foot);
    if (nearest.distance > step_ || surface_.is_inside(middle, nearest)) return 0;
    const std::optional<ThinBall> ball = thin_ball_behind(surface_, nearest, middle, step_);
    return ball && is_near(ball->centre, middle, wire_reach) ? angle_of(*ball) : 0;
  }

 private:
  /// Returns the angle of the medial ball next to the middle of a cell whose voxels are inside and outside, degrees. It
  /// is 0 if another cell is closer to the ball's centre.
  [[nodiscard]] double in_rod(const Governor& near, const Vec3d& middle) const {
    const NearestPoint nearest = surface_.nearest(middle, near.foot);
    if (nearest.distance > step_) return 0;
    const std::optional<ThinBall> ball = surface_.is_inside(middle, nearest)
                                             ? ball_around(surface_, nearest, middle, step_)
                                             : thin_ball_behind(surface_, nearest, middle, step_);
    // At convex edges, the squares of voxels suffice. Balls there touch walls at a smaller angle.
    if (!ball || ball->angle_across < wide_angle || !is_nearest_cell_of(ball->centre, middle)) return 0;
    return angle_of(*ball);
  }
  /// Returns the angle of the medial ball around a point of a thin part, degrees. It is 0 if the ball's centre is
  /// further than `reach` voxels away along an axis of the grid.
  [[nodiscard]] double in_wire(const Vec3d& inside, double reach) const {
    const NearestPoint nearest = surface_.nearest(inside, {});
    if (!surface_.is_inside(inside, nearest)) return 0;
    const std::optional<ThinBall> ball = ball_around(surface_, nearest, inside, step_);
    if (!ball || !is_near(ball->centre, inside, reach)) return 0;
    return angle_of(*ball);
  }
  [[nodiscard]] double angle_of(const ThinBall& ball) const {
    const double radius = ball.nearest.distance;
    const double between = 2 * radius * std::sin(0.5 * ball.angle_across / degrees_per_radian);
    return above_floor(ball.centre, ball.angle_across, between);
  }

  [[nodiscard]] bool is_uneven(const Around& around) const {
    Vec3d sum;
    bool is_same = true;
    for (const Governor& g : around) {
      sum += g.direction;
      is_same = is_same && g.foot.element == around[0].foot.element;
    }
    if (is_same) return false;
    const double size = length(sum);
    const double narrow = std::cos(0.5 * floor_.angle / degrees_per_radian);
    if (size < 8 * narrow) return true;  // opposite walls: their directions add up to almost zero
    for (const Governor& g : around) {
      if (dot(g.direction, sum) < narrow * size) return true;
    }
    return false;
  }

  /// Returns the distance of a point from `foot`, its footprint on the wall of a governor. It is negative if the point
  /// is beyond the wall.
  [[nodiscard]] static double depth_of(const Vec3d& x, const Governor& g, const Footprint& foot) {
    return std::copysign(length(x - foot.point), dot(foot.point - x, g.direction));
  }
  /// Returns the change of depth_of() when x moves by the vector from a to b, linearly extrapolated.
  [[nodiscard]] static double slope_along(const Governor& a, const Governor& b, const Vec3d& x, const Governor& g,
                                          const Footprint& foot) {
    const double depth = depth_of(x, g, foot);
    return depth != 0 ? dot(b.centre - a.centre, x - foot.point) / depth : 0;
  }

  /// Returns true if a point near a voxel is on the inner side of the wall that is closest to the voxel.
  [[nodiscard]] static bool is_inside(const Governor& g, const Vec3d& x) {
    return dot(x - g.foot.point, g.direction) < 0;
  }

  /// Returns a governor at a point of the surface.
  [[nodiscard]] Governor governor_at(const ExtraCell::End& end) const {
    Governor g;
    g.centre = end.point;
    g.foot = {end.point, *end.triangle, 7};
    g.is_inside = true;
    g.direction = surface_.outwards(*end.triangle);
    return g;
  }
  [[nodiscard]] Governor governor_inside(const Vec3d& x) const {
    Governor g;
    const NearestPoint nearest = surface_.nearest(x, {});
    g.centre = x;
    g.foot = {nearest.point, nearest.element, 7};
    g.is_inside = true;
    if (nearest.distance > 0) g.direction = (nearest.point - x) / nearest.distance;
    return g;
  }

  [[nodiscard]] double above_floor(const Vec3d& x, const Vec3d& p, const Vec3d& q) const {
    return above_floor(x, angle_at(x, p, q), length(p - q));
  }
  /// Returns an angle between two footprints of x, or 0 if it is below the noise floor.
  /// @param apart  distance between the footprints.
  [[nodiscard]] double above_floor(const Vec3d& x, double angle, double apart) const {
    if (angle < floor_.angle) return 0;
    if (apart < floor_.lambda) return 0;
    if (apart >= floor_.voxels * step_) return angle;
    return angle < floor_.clear_angle || !is_thin_around(x) ? 0 : angle;
  }

  [[nodiscard]] bool is_thin_around(const Vec3d& x) const {
    if (floor_.thin_within == 0) return true;
    const GridSpec& grid = governors_.solid().grid;
    const Vec3d at = grid.direction.transposed_times(x - grid.origin);
    std::array<std::int64_t, 3> voxel{};
    for (std::size_t a = 0; a < 3; ++a) {
      voxel[a] = std::clamp(std::int64_t{std::lround(at[a] / grid.spacing[a])}, std::int64_t{0}, grid.size[a] - 1);
    }
    return !thick_.contain(voxel);
  }

  [[nodiscard]] bool is_near(const Vec3d& x, const Vec3d& middle, double reach) const {
    const GridSpec& grid = governors_.solid().grid;
    const Vec3d moved = grid.direction.transposed_times(x - middle);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(moved[axis]) > reach * grid.spacing[axis]) return false;
    }
    return true;
  }

  /// Returns true if a cell with the given middle is the closest of its kind to x. If the axis of a rod runs through
  /// centres of voxels, four edges of each voxel are equally close to it. The middles are shifted a little, so that
  /// exactly one of these edges is chosen.
  [[nodiscard]] bool is_nearest_cell_of(const Vec3d& x, const Vec3d& middle) const {
    constexpr std::array shift{0.0137, 0.0173, 0.0191};  // voxels
    constexpr double rounding = 1e-6;                    // voxels
    const GridSpec& grid = governors_.solid().grid;
    const Vec3d moved = grid.direction.transposed_times(x - middle);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(moved[axis] / grid.spacing[axis] - shift[axis]) > 0.5 + rounding) return false;
    }
    return true;
  }

  [[nodiscard]] double angle_of(std::span<const Governor* const> governors, const Vec3d& x) const {
    std::array<Footprint, 8> feet;
    std::array<double, 8> distance{};
    double closest = std::numeric_limits<double>::infinity();
    std::size_t behind = 0;
    for (std::size_t g = 0; g < governors.size(); ++g) {
      behind += is_inside(*governors[g], x) ? 1 : 0;
      feet[g] = surface_.follow(governors[g]->foot, x, reach_around_axis * voxel_);
      distance[g] = length(x - feet[g].point);
      closest = std::min(closest, distance[g]);
    }
    if (behind < (governors[0]->is_inside ? 1 : governors.size())) return 0;
    const double limit = closest + fitted_tolerance * voxel_;
    double largest = 0;
    double least_cosine = std::cos(floor_.angle / degrees_per_radian);
    std::size_t widest = 0;
    for (std::size_t a = 0; a < governors.size(); ++a) {
      for (std::size_t b = a + 1; b < governors.size() && distance[a] <= limit; ++b) {
        if (distance[b] > limit) continue;
        const double cosine_scaled = dot(feet[a].point - x, feet[b].point - x);
        if (cosine_scaled > least_cosine * distance[a] * distance[b]) continue;  // a test cheaper than the angle
        const double angle = above_floor(x, feet[a].point, feet[b].point);
        if (angle <= largest) continue;
        largest = angle;
        least_cosine = std::cos(angle / degrees_per_radian);
        widest = a;
      }
    }
    if (largest == 0 || largest > opposite_enough) return largest;
    const Vec3d opposite = opposite_of(x, feet[widest]);
    return length(x - opposite) > limit ? largest : std::max(largest, above_floor(x, feet[widest].point, opposite));
  }

  /// Returns a footprint on the other side of x: the closest point to a query a little further away from the given
  /// footprint. It may be missing among the footprints of the voxels around an axis of a round part.
  [[nodiscard]] Vec3d opposite_of(const Vec3d& x, const Footprint& foot) const {
    const Vec3d away = x - foot.point;
    const double distance = length(away);
    if (!(distance > 0)) return foot.point;
    const Vec3d beyond = x + away * (std::min(opposite_step * voxel_, 0.5 * distance) / distance);
    const NearestPoint there = surface_.nearest(beyond, foot);
    return surface_.follow({there.point, there.element, 7}, x, reach_around_axis * voxel_).point;
  }

  ThickParts thick_;
  const GovernorField& governors_;
  const Surface& surface_;
  const CellComplex& complex_;
  const NoiseFloor& floor_;
  double voxel_;
  double step_;  ///< longest side of a voxel
};

using Entries = std::vector<Importance::Entry>;

/// Returns the angles of extra polygons, and of extra edges that are not sides of polygons.
Entries angles_of_extra(const Measure& measure, const CellStructure& structure, const Context& context) {
  std::vector<float> angles(structure.extra_count(), 0);
  const Cell first = structure.first_extra();
  parallel_for(context, angles.size(), 256, "separation angles", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const Cell name = first + static_cast<Cell>(k);
      const ExtraCell& cell = structure.extra()->cell(name);
      if (cell.dimension == 2) angles[k] = static_cast<float>(measure.between(cell));
      if (cell.dimension == 1 && structure.extra()->cofaces_of(name).empty()) {
        angles[k] = static_cast<float>(measure.in_wire(cell));
      }
    }
  });
  Entries entries;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    if (angles[k] > 0) entries.push_back({first + static_cast<Cell>(k), angles[k]});
  }
  return entries;
}

/// Returns one list of the entries of all layers.
Entries joined(const std::vector<Entries>& layers) {
  Entries all;
  for (const Entries& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
  return all;
}

/// Returns the largest angle of the squares that touch a node or one of its 26 neighbours. The node must not lie on the
/// border of the lattice.
double largest_around(const Importance& squares, const CellLattice& lattice, std::size_t node) {
  float largest = 0;
  for (std::size_t z = 0; z < 3; ++z) {
    for (std::size_t y = 0; y < 3; ++y) {
      const std::size_t row =
          node + z * lattice.stride(2) + y * lattice.stride(1) - lattice.stride(2) - lattice.stride(1);
      for (std::size_t n = row - 1; n <= row + 1; ++n) {
        // The value of a vertex is at least that of each square that it is a corner of.
        largest = std::max(largest, squares.of(cell_at(n, 0)));
      }
    }
  }
  return largest;
}

}  // namespace

VoxelSet spread(const VoxelSet& from, int within, const Context& context) {
  const auto& size = from.size();
  VoxelSet in_layers(size);  // result for steps along x and y only
  VoxelSet out(size);
  const auto for_each_layer = [&](const auto& use) {
    parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
      for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) use(k);
    });
  };
  for_each_layer([&](std::int64_t k) {
    std::vector<std::uint64_t> wide(from.words_per_row());
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const Words row = from.row(j, k);
      if (std::all_of(row.begin(), row.end(), [](std::uint64_t word) { return word == 0; })) continue;
      spread_along(row, within, wide);
      clear_beyond(size[0], wide);
      const std::int64_t last = std::min(size[1] - 1, j + within);
      for (std::int64_t to = std::max<std::int64_t>(0, j - within); to <= last; ++to) add(wide, in_layers.row(to, k));
    }
  });
  for_each_layer([&](std::int64_t k) {
    const std::int64_t last = std::min(size[2] - 1, k + within);
    for (std::int64_t near = std::max<std::int64_t>(0, k - within); near <= last; ++near) {
      for (std::int64_t j = 0; j < size[1]; ++j) add(in_layers.row(j, near), out.row(j, k));
    }
  });
  return out;
}

Importance separation_angles(const GovernorField& governors, const CellComplex& complex, const NoiseFloor& floor,
                             const Context& context) {
  const Measure measure(governors, complex, floor, context);
  const CellLattice& lattice = complex.lattice();
  const auto layers = static_cast<std::size_t>(lattice.size()[2]);
  std::vector<Entries> found(layers);
  std::vector<std::vector<std::uint32_t>> uneven(layers);
  const auto for_each_layer = [&](std::string_view phase, const auto& use) {
    parallel_for(context, layers, 1, phase, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        if (k > 0 && k + 1 < layers) use(k);
      }
    });
  };
  for_each_layer("separation angles of squares", [&](std::size_t k) {
    measure.for_each_uneven_node(static_cast<std::int64_t>(k), [&](std::size_t node, const GovernorsAround& around) {
      uneven[k].push_back(static_cast<std::uint32_t>(node));
      for (const CellAxes axes : {3U, 5U, 6U}) {
        if (!complex.contains(cell_at(node, axes))) continue;
        const double angle = measure.between(around[axes], around[7]);
        if (angle > 0) found[k].push_back({cell_at(node, axes), static_cast<float>(angle)});
      }
    });
  });
  found.push_back(angles_of_extra(measure, complex.structure(), context));
  const Importance squares(complex.structure(), joined(found));
  constexpr double nearly_opposite = 170;  // degrees; larger angles occur on axes of round parts
  for_each_layer("separation angles of edges", [&](std::size_t k) {
    for (const std::uint32_t node : uneven[k]) {
      const double known = largest_around(squares, lattice, node);
      const double least = std::max(std::min(known + floor.clearly_more, nearly_opposite), floor.angle);
      if (known >= least) continue;
      const GovernorsAround around = governors.around(lattice.place(node));
      for (const CellAxes axes : {0U, 1U, 2U, 4U}) {
        if (!complex.contains(cell_at(node, axes)) || Measure::coarse(around, axes) < std::min(least, wide_angle))
          continue;
        const double angle = measure.fitted(around, axes);
        if (angle >= least) found[k].push_back({cell_at(node, axes), static_cast<float>(angle)});
      }
    }
  });
  return {complex.structure(), joined(found)};
}

}  // namespace blum::detail
