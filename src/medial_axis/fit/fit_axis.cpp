#include "medial_axis/fit/fit_axis.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/fit/balance.hpp"
#include "medial_axis/fit/border_directions.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/fit/split_curves.hpp"
#include "medial_axis/fit/trim.hpp"
#include "medial_axis/fit/unfold.hpp"
#include "medial_axis/fit/vertex_mover.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/governors.hpp"
#include "medial_axis/surface/thin_ball.hpp"

namespace blum::detail {
namespace {

/// 64-bit hash of the data that a step depends on. The probability that two of 10^6 different inputs have the same hash
/// is 10^-7.
class SightHash {
 public:
  void add(std::uint64_t word) {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;  // from the golden ratio
    state_ = std::rotl(state_ ^ word, 29) * odd;
    state_ ^= state_ >> 32U;
  }
  void add(const Vec3d& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint64_t>(v[axis]));
  }
  void add(const AxisVertex& vertex) {
    add(vertex.position);
    add(vertex.footprints[0]);
    add(vertex.footprints[1]);
    add(std::bit_cast<std::uint64_t>(vertex.separation_angle));
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

/// Hashes of the data of vertices that a step did not move.
using Settled = std::unordered_set<std::uint64_t>;

/// Returns true if two vertices are equal up to rounding.
/// @param voxel  mesh units.
inline bool is_same_vertex(const AxisVertex& a, const AxisVertex& b, double voxel) {
  constexpr double next_to_nothing = 1e-6;  // voxels for lengths, degrees for angles
  const double most = next_to_nothing * voxel;
  return a.sites == b.sites && squared_length(a.position - b.position) <= most * most &&
         std::abs(a.radius - b.radius) <= most && std::abs(a.separation_angle - b.separation_angle) <= next_to_nothing;
}

/// Moves vertices of lists. The cells of the lists do not change, except in bend_curves(), so results that depend only
/// on cells are computed once.
class Fitter {
  // Limits of all steps.
  static constexpr std::size_t vertices_per_range = 64;
  /// Greatest distances that a vertex may move, in voxels: along a seam, to a curve, and to the middle of a round part.
  static constexpr double most_moved = 1.5;
  static constexpr double most_moved_to_curve = 2.5;
  static constexpr double most_moved_to_centre = 4;
  /// Radius at which a sheet that would reach the surface ends, in voxels.
  static constexpr double least_radius = 0.02;
  static constexpr std::array short_radii{0.2, 0.1, 0.05};
  /// Degrees: two walls are treated as parallel at this separation angle or more. Parallel walls do not meet nearby.
  static constexpr double parallel = 175;
  /// Near the rim of a sheet, the separation angle exceeds theta by at most this much, in degrees.
  static constexpr double nearly_theta = 10;
  /// Distances along the direction outwards and inwards at which the angle is evaluated, in voxels.
  static constexpr std::array outwards{0.25, 0.5, 1.0, 1.5, 2.0, 2.5};
  static constexpr std::array inwards{-0.25, -0.5, -1.0, -1.5, -2.0, -2.5};
  static constexpr int halvings = 9;
  /// A border vertex does not move if it is this close to where its border should end, in voxels. The halvings find the
  /// end of the border with the same accuracy.
  static constexpr double settled = 0.001;
  /// Greatest radius of thin parts, in voxels.
  static constexpr double thin_part = 2;
  /// Degrees: walls at this separation angle or more are on opposite sides of a thin part.
  static constexpr double opposite_walls = 150;
  /// Greatest distance of a point of a curve from the middle of its round part, in voxels.
  static constexpr double off_centre = 0.1;
  /// Voxels: the point opposite of a footprint is the closest point to a query this far from the vertex, on the other
  /// side. It may be further from the vertex than the footprint by `facets` voxels, and `facets_share` of the radius.
  static constexpr double opposite_step = 0.3;
  static constexpr double facets = 0.02;
  static constexpr double facets_share = 0.05;

 public:
  /// Results that are kept for the next Fitter.
  struct Known {
    std::set<std::array<double, 3>> not_round;  ///< positions at which centred() found nothing
    Settled seams, rims;                        ///< hashes of vertices that place_seams() and cut_rims() did not move
  };

  Fitter(AxisLists& lists, const FitTarget& target, Known& known, const Context& context)
      : lists_(lists),
        target_(target),
        surface_(target.surface),
        voxel_(target.voxel),
        context_(context),
        incidence_({lists.vertices.size(), lists.edges, lists.triangles}, context),
        kinds_(kinds_of(incidence_, lists.vertices.size())),
        directions_(lists, incidence_, kinds_),
        known_(known),
        is_not_round_(lists.vertices.size(), 0),
        sight_(lists.vertices.size(), 0),
        mover_(lists, incidence_, target.surface, context) {}

  // ---- Steps: they move vertices and return the length of the largest move, mesh units ----

  /// Moves vertices of rims and curves that are not shown (see is_shown()) to the middle of a round part. Without this
  /// move, trim() would remove these vertices.
  double find_centres() {
    return move([&](std::uint32_t v) -> Moved {
      if (is_shown(lists_.vertices[v], 3)) return std::nullopt;
      if (kinds_[v].rims + kinds_[v].curves == 0) return centred_in_thin(v);
      const Moved found = between(v, 3);
      if (!found || !is_shown(*found, 3)) return centred(v);
      // A vertex of a rim that has only one footprint is often next to a point between two walls.
      const Moved between_two = on_sheet(v);
      const Vec3d& at = lists_.vertices[v].position;
      const bool is_nearer =
          between_two && squared_length(between_two->position - at) < squared_length(found->position - at);
      return is_nearer && is_shown(*between_two, 2) ? between_two : found;
    });
  }
  /// Moves vertices that have only one footprint to a point equally far from two walls.
  double find_sheets() {
    return move([&](std::uint32_t v) { return lists_.vertices[v].separation_angle > 0 ? std::nullopt : on_sheet(v); });
  }
  /// Returns the incidence of the lists. It is valid until an edge of the lists is removed.
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  /// Returns angle_seen() of each vertex, in degrees.
  [[nodiscard]] std::vector<double> angles() const {
    std::vector<double> out(lists_.vertices.size());
    parallel_for(context_, out.size(), 4 * vertices_per_range, "borders", [&](const WorkRange& range) {
      for (std::size_t v = range.begin; v < range.end; ++v) out[v] = angle_seen(lists_.vertices[v]);
    });
    return out;
  }
  double place_seams() {
    return move_unsettled(known_.seams, [&](std::uint32_t v) { return balanced(v); });
  }
  /// Moves vertices of curves as place_seams() does.
  double place_curves() {
    return move([&](std::uint32_t v) { return kinds_[v].curves > 0 ? balanced(v) : std::nullopt; });
  }
  /// If a sheet bends at an inner vertex, moves the vertex to a nearby seam. A vertex at such a bend was put on another
  /// sheet, beyond the seam.
  double straighten() {
    return move([&](std::uint32_t v) { return is_bent(v) ? straightened(v) : std::nullopt; });
  }
  /// Moves vertices that are not shown, but have a shown neighbour, to the middle of a round part. If that fails, a
  /// vertex of a rim or curve with two or more shown neighbours moves to the nearest of them.
  double take_back() {
    return move([&](std::uint32_t v) -> Moved {
      if (is_shown(lists_.vertices[v], 3)) return std::nullopt;
      std::size_t shown = 0;
      const AxisVertex* nearest = nullptr;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
        const AxisVertex& other = lists_.vertices[other_end(incidence_.edges()[e], v)];
        if (!is_shown(other, 3)) continue;
        ++shown;
        const Vec3d& at = lists_.vertices[v].position;
        const bool is_nearer =
            nearest == nullptr || squared_length(other.position - at) < squared_length(nearest->position - at);
        if (is_nearer) nearest = &other;
      }
      if (shown == 0) return std::nullopt;
      if (auto found = centred(v)) return found;
      return shown > 1 && kinds_[v].rims + kinds_[v].curves > 0 ? Moved(*nearest) : std::nullopt;
    });
  }
  /// Inserts vertices into edges of curves that cut short a bend of the middle of a round part.
  /// @return  true if any was inserted. The lists then have other cells, and this object must not be used any more.
  bool bend_curves() {
    return split_curves(
        lists_, incidence_, surface_, voxel_,
        [&](const Vec3d& at) {
          if (const Moved found = centred_at(at)) return found;
          const NearestPoint nearest = surface_.nearest(at, {});
          return surface_.is_inside(at, nearest) ? centred_in_thin(at, nearest) : std::nullopt;
        },
        context_);
  }
  double cut_rims() {
    return move_unsettled(known_.rims, [&](std::uint32_t v) { return cut(v); });
  }
  /// Moves ends of curves as cut_rims() does.
  double cut_ends() {
    return move([&](std::uint32_t v) { return kinds_[v].is_curve_end() ? cut(v) : std::nullopt; });
  }
  /// Moves vertices of rims that stayed far from the surface, because otherwise edges of the rim would have cut off
  /// corners of holes. They move to a radius of 1/5, then 1/10, then 1/20 of a voxel, as far as their edges allow.
  double cut_rims_short() {
    double furthest = 0;
    for (const double radius : short_radii) {
      const double moved = move([&](std::uint32_t v) {
        const AxisVertex& own = lists_.vertices[v];
        const bool stayed = kinds_[v].is_rim() && own.radius > 1.2 * radius * voxel_ &&
                            own.separation_angle >= target_.theta + nearly_theta;
        return stayed ? slide(v, directions_.of_rim(v), 2, radius) : std::nullopt;
      });
      furthest = std::max(furthest, moved);
    }
    return furthest;
  }

 private:
  using Moved = std::optional<AxisVertex>;

  // ---- Positions of vertices ----

  /// Returns the position of a vertex of a seam, junction or curve: equally far from four walls for a junction,
  /// otherwise from three.
  [[nodiscard]] Moved balanced(std::uint32_t v) {
    const Kind& kind = kinds_[v];
    const bool is_alone = kind.rims + kind.seams + kind.curves + kind.inner == 0;
    if (is_alone || kind.curves > 0) {
      if (auto found = centred(v)) return found;
    }
    if (kind.is_junction()) {
      if (auto found = between(v, 4)) return found;
      return between(v, 3);
    }
    return is_alone || kind.seams + kind.curves > 0 ? between(v, 3) : std::nullopt;
  }

  [[nodiscard]] Moved between(std::uint32_t v, std::size_t walls) const {
    const AxisVertex& vertex = lists_.vertices[v];
    // A vertex that is not shown may be more than a voxel away from the middle of a round part.
    const double reach = is_shown(vertex, 3) ? most_moved : most_moved_to_curve;
    return balanced_at(vertex.position, feet_around(v), walls, {voxel_, reach * voxel_, true});
  }

  /// Returns a point equally far from two walls: those of the nearest neighbour that lies on the sheet only. If there
  /// is none, any two walls near the vertex are used.
  [[nodiscard]] Moved on_sheet(std::uint32_t v) const {
    const AxisVertex& vertex = lists_.vertices[v];
    std::uint32_t beside = v;
    for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
      const std::uint32_t other = other_end(incidence_.edges()[e], v);
      const bool is_of_sheet = kinds_[other].seams + kinds_[other].curves == 0;
      if (!is_of_sheet || !(lists_.vertices[other].separation_angle > 0)) continue;
      const auto off = [&](std::uint32_t u) { return squared_length(lists_.vertices[u].position - vertex.position); };
      if (beside == v || off(other) < off(beside)) beside = other;
    }
    if (beside != v) {
      const BalanceLimits limits{voxel_, most_moved * voxel_, false};
      if (auto found = balanced_at(vertex.position, feet_of(beside), 2, limits)) return found;
    }
    return between(v, 2);
  }

  /// Returns true if a vertex is on a curve, or on a strip: a part of a sheet without vertices inside. The sheet of a
  /// thin wall has vertices inside, and its rims are found where the angle is theta.
  [[nodiscard]] bool is_on_strip(std::uint32_t v) const {
    const auto at = incidence_.triangles_of_vertex()[v];
    return std::all_of(at.begin(), at.end(), [&](std::uint32_t t) {
      const auto& corners = lists_.triangles[t];
      return std::all_of(corners.begin(), corners.end(),
                         [&](std::uint32_t c) { return kinds_[c].rims + kinds_[c].curves > 0; });
    });
  }
  /// Returns the middle of a round part around a vertex, or of a thin part around a strip, if that point is shown.
  [[nodiscard]] Moved centred(std::uint32_t v) {
    const Vec3d& at = lists_.vertices[v].position;
    if (known_.not_round.contains({at.x, at.y, at.z})) return std::nullopt;
    Moved found = centred_at(at);
    if (!found && is_on_strip(v)) found = middle_of_thin(v);
    if (!found) found = centred_in_thin(v);
    is_not_round_[v] = found ? 0 : 1;
    return found;
  }
  /// Returns the middle of a thin round part around a point that may be close to its surface, if the middle is shown.
  /// @param nearest  closest point of the surface to `at`.
  [[nodiscard]] Moved centred_in_thin(const Vec3d& at, const NearestPoint& nearest) const {
    if (!(nearest.distance > 0) || nearest.distance > voxel_) return std::nullopt;
    const std::optional<ThinBall> ball = ball_around(surface_, nearest, at, voxel_);
    return ball ? centred_at(ball->centre) : std::nullopt;
  }
  [[nodiscard]] Moved centred_in_thin(std::uint32_t v) const {
    const Stop stop = stop_of(lists_.vertices[v]);
    return centred_in_thin(stop.at, stop.nearest);
  }
  /// Returns the middle of a thin part around a point. If the part is not round, returns a shown point between two of
  /// its walls.
  /// @param nearest  closest point of the surface to `at`.
  [[nodiscard]] Moved middle_of_thin(const Vec3d& at, const NearestPoint& nearest) const {
    const double thin = thin_part * voxel_;
    if (!(nearest.distance > 0) || nearest.distance > thin) return std::nullopt;
    const std::optional<ThinBall> ball = ball_around(surface_, nearest, at, thin, target_.theta);
    if (!ball) return std::nullopt;
    if (auto found = centred_at(ball->centre)) return found;
    // Balls in sharp edges of thick parts are small, too, but their walls are not opposite.
    if (ball->angle_across < opposite_walls) return std::nullopt;
    AxisVertex found = vertex_of_ball(*ball);
    widen(found);
    for (SiteId& site : found.sites) site = target_.input_site(site);
    return is_shown(found, 3) ? Moved(found) : std::nullopt;
  }
  [[nodiscard]] Moved middle_of_thin(std::uint32_t v) const {
    // The vertex has sites of the input; the ball needs those of the surface.
    const Vec3d at = stop_of(lists_.vertices[v]).at;
    return middle_of_thin(at, surface_.nearest(at, {}));
  }
  /// Returns middle_of_thin() if it is beside the point, not before or behind it along a direction.
  [[nodiscard]] Moved middle_beside(const Vec3d& at, const Vec3d& direction) const {
    constexpr double most_along = 0.1;  // of the radius
    const NearestPoint nearest = surface_.nearest(at, {});
    if (!surface_.is_inside(at, nearest)) return std::nullopt;
    const Moved found = middle_of_thin(at, nearest);
    const bool is_beside = found && std::abs(dot(found->position - at, direction)) <= most_along * found->radius;
    return is_beside ? found : std::nullopt;
  }
  [[nodiscard]] Moved centred_at(const Vec3d& start) const {
    const std::optional<RoundCentre> centre =
        round_centre(surface_, start, {voxel_, most_moved_to_centre * voxel_, target_.theta});
    if (!centre) return std::nullopt;
    // Prefers a point equally far from three facets, if there is one next to the middle.
    const BalanceLimits next_to{voxel_, facets * voxel_, true};
    Moved found = balanced_at(centre->position, centre->feet, 3, next_to);
    if (found && is_shown(*found, 3)) return found;
    const NearestPoint nearest = surface_.nearest(centre->position, {});
    if (!surface_.is_inside(centre->position, nearest)) return std::nullopt;
    found = vertex_of_one_wall(centre->position, nearest);
    widen(*found);
    for (SiteId& site : found->sites) site = target_.input_site(site);
    return is_shown(*found, 3) ? found : std::nullopt;
  }

  /// Returns the result of balance(), with sites of the input instead of sites of the surface.
  [[nodiscard]] Moved balanced_at(const Vec3d& start, const std::vector<Footprint>& feet, std::size_t walls,
                                  const BalanceLimits& limits) const {
    Moved found = balance(surface_, start, feet, walls, limits);
    if (!found) return found;
    if (walls > 2) widen(*found);
    for (SiteId& site : found->sites) site = target_.input_site(site);
    return found;
  }

  /// Returns a point on the seam for a vertex for which is_bent() is true, if the sheet would bend less with the vertex
  /// there.
  [[nodiscard]] Moved straightened(std::uint32_t v) const {
    constexpr double better = 0.5;  // greatest ratio of 1 - cosine after the move to that before
    const double bend = least_cosine(v, lists_.vertices[v].position);
    const Moved found = between(v, 3);
    if (!found || 1 - least_cosine(v, found->position) > better * (1 - bend)) return std::nullopt;
    return found;
  }

  /// Returns true if a vertex is an inner vertex of a sheet and the sheet bends there.
  [[nodiscard]] bool is_bent(std::uint32_t v) const {
    constexpr double sharp = 0.9;  // cosine: 25 degrees
    const Kind& kind = kinds_[v];
    return kind.seams + kind.curves + kind.rims == 0 && least_cosine(v, lists_.vertices[v].position) <= sharp;
  }

  /// Returns the least cosine of the angles by which the sheet would bend at a vertex's edges if the vertex were at
  /// `position`.
  [[nodiscard]] double least_cosine(std::uint32_t v, const Vec3d& position) const {
    return least_cosine_at(lists_, incidence_, v, position);
  }

  /// Returns the closest point of the surface to a query: to the vertex, moved a little away from its first footprint.
  /// The vertex must not be on the surface.
  [[nodiscard]] NearestPoint opposite_of(const AxisVertex& vertex) const {
    const Vec3d away = (vertex.position - vertex.footprints[0]) / vertex.radius;
    return surface_.nearest(vertex.position + away * std::min(opposite_step * voxel_, 0.5 * vertex.radius),
                            foot_of(vertex, 0));
  }

  /// Replaces the second footprint by the point opposite of the first footprint, if this point is equally close and
  /// gives a larger angle. Vertices in round parts need this replacement.
  void widen(AxisVertex& vertex) const {
    const NearestPoint opposite = opposite_of(vertex);
    const double limit = vertex.radius + 1e-6 * voxel_ + 1e-9 * vertex.radius;
    if (length(opposite.point - vertex.position) > limit) return;
    const double angle = angle_at(vertex.position, vertex.footprints[0], opposite.point);
    if (angle <= vertex.separation_angle) return;
    vertex.footprints[1] = opposite.point;
    vertex.sites[1] = opposite.site;
    vertex.elements[1] = opposite.element;
    vertex.separation_angle = angle;
  }

  /// Returns the position of a vertex of a rim, or at the end of a seam or curve. The angle there is theta, or the
  /// radius almost zero.
  [[nodiscard]] Moved cut(std::uint32_t v) const {
    const Kind& kind = kinds_[v];
    if (kind.is_rim()) {
      if (auto found = slide(v, directions_.of_rim(v), 2)) return found;
      return slide(v, directions_.towards_surface(v), 2);
    }
    if (kind.is_seam_end()) return slide(v, directions_.of_end(v, 3), 3);
    if (kind.is_curve_end()) return directions_.comes_back(v) ? std::nullopt : slide(v, directions_.of_end(v, 0), 3);
    return kind.rims + kind.seams + kind.curves == 0 ? at_mouth(v) : std::nullopt;
  }

  /// Returns the point where a thin part of the solid next to a vertex begins. There the angle drops to almost zero.
  /// The sheet may continue beyond that point, only because homotopy requires it.
  [[nodiscard]] Moved at_mouth(std::uint32_t v) const {
    if (is_shown(lists_.vertices[v], 2) || incidence_.edges_of_vertex()[v].empty()) return std::nullopt;
    const std::uint32_t inner = best_neighbour(v);
    const AxisVertex& thin = lists_.vertices[inner];
    constexpr double wider = 4;
    const bool is_thin = thin.radius < least_radius * voxel_ && thin.separation_angle >= parallel &&
                         wider * thin.radius < lists_.vertices[v].radius;
    // Edges from this point to vertices beyond leave the thin part, so the error of the point must be well below the
    // part's thickness.
    return is_thin && is_shown(thin, 2) ? towards(v, inner, 2, 3 * halvings) : std::nullopt;
  }

  /// Returns true if a vertex is shown: its angle is above theta, and its radius is not so small that the sheet ends
  /// there.
  /// @param walls  2 for vertices of sheets, whose angle is that of the two footprints; more for others, whose angle is
  /// angle_seen().
  [[nodiscard]] bool is_shown(const AxisVertex& vertex, std::size_t walls) const {
    // Sheets end where their two walls meet. Between parallel walls, a small radius does not mean that the sheet ends.
    if (vertex.radius < least_radius * voxel_ && vertex.separation_angle < parallel) return false;
    return (walls > 2 ? angle_seen(vertex) : vertex.separation_angle) > target_.theta;
  }

  /// Returns the largest angle between footprints of a vertex, degrees. The point opposite of the first footprint is
  /// treated as a footprint if it is only a little further away (`facets`). Exactly equal distances are rare in round
  /// parts, because these consist of facets.
  [[nodiscard]] double angle_seen(const AxisVertex& vertex) const {
    const double own = vertex.separation_angle;
    if (own > target_.theta || !(vertex.radius > 0)) return own;
    const Vec3d opposite = opposite_of(vertex).point;
    const double most_further = std::min(facets * voxel_, facets_share * vertex.radius);
    if (length(opposite - vertex.position) > vertex.radius + most_further) return own;
    return std::max(own, angle_at(vertex.position, vertex.footprints[0], opposite));
  }

  /// Path of a vertex along its sheet, seam or curve, and findings at the points examined so far.
  struct Way {
    Vec3d origin;
    Vec3d direction;  ///< Unit length, or zero.
    std::size_t walls = 0;
    bool is_curve = false;  ///< True if the vertex is the end of a curve.
    std::vector<Footprint> feet;
    const AxisVertex* sheet = nullptr;  ///< A shown vertex of the sheet.
    double end_radius = least_radius;   ///< Radius at which the path ends, in voxels.
    /// True if the last point is past the border: it was on the sheet, seam or curve but not shown, or on another
    /// sheet.
    bool is_past = false;
    bool is_round = false;  ///< True if some point was in the middle of a round or thin part.
  };
  [[nodiscard]] bool is_shown_on(const Way& way, const AxisVertex& vertex) const {
    if (vertex.radius < way.end_radius * voxel_ && vertex.separation_angle < parallel) return false;
    // At the end of a curve, opposite footprints are at twice the angle between a footprint and the curve.
    return is_shown(vertex, way.walls) && (!way.is_curve || angle_ahead(vertex, way.direction) > target_.theta);
  }
  /// Returns the vertex at a distance of `voxels` voxels along the path, if that vertex is shown.
  [[nodiscard]] Moved on(Way& way, double voxels) const {
    const Vec3d place = way.origin + way.direction * (voxels * voxel_);
    Moved found = balanced_at(place, way.feet, way.walls, {voxel_, most_moved * voxel_, true});
    if (found && way.walls == 2 && !goes_on(*way.sheet, *found)) found.reset();
    way.is_past = found && !is_shown_on(way, *found);
    if (found && !way.is_past) return found;
    if (!way.is_curve) return std::nullopt;
    found = centred_at(place);
    if (!found) found = middle_beside(place, way.direction);
    if (found && !is_shown_on(way, *found)) found.reset();
    way.is_past = way.is_past || (way.is_round && !found);
    way.is_round = way.is_round || found;
    return found;
  }

  /// Returns the last shown vertex on the path of a vertex along its sheet, seam or curve. The radius of that vertex is
  /// at least `end_radius` voxels, except between parallel walls.
  [[nodiscard]] Moved slide(std::uint32_t v, const Vec3d& direction, std::size_t walls,
                            double end_radius = least_radius) const {
    const AxisVertex& own = lists_.vertices[v];
    const std::uint32_t inner = best_neighbour(v);
    const bool shows = is_shown(own, walls);
    if (squared_length(direction) > 0) {
      Way way{own.position,
              direction,
              walls,
              kinds_[v].is_curve_end(),
              walls == 2 ? feet_of(shows ? v : inner) : feet_around(v),
              shows ? &own : &lists_.vertices[inner],
              end_radius};
      if (const Moved start = on(way, 0)) return slide_outwards(way, *start);
      if (const Moved found = slide_inwards(way)) return found;
    }
    return is_shown(lists_.vertices[inner], walls) && !shows ? towards(v, inner, walls) : std::nullopt;
  }
  [[nodiscard]] Moved slide_outwards(Way& way, AxisVertex start) const {
    const auto at = [&](double t) { return on(way, t); };
    way.origin = start.position;
    // Most vertices are already in their final position.
    if (!at(settled) && way.is_past) return start;
    double good = 0;
    for (const double t : outwards) {
      if (const Moved next = at(t)) {
        start = *next;
        good = t;
        continue;
      }
      // A step longer than the radius may have crossed the surface.
      bool is_beyond = way.is_past || start.radius <= (t - good) * voxel_;
      const auto look = [&](double nearer) {
        Moved found = at(nearer);
        is_beyond = is_beyond || (way.is_past && way.is_curve);
        return found;
      };
      start = *last_shown(look, good, t, start);
      // Beyond the rim of a lens-shaped part, only one wall is near.
      return is_beyond || start.separation_angle < target_.theta + nearly_theta ? Moved(start) : std::nullopt;
    }
    if (way.is_round) return start;
    // Far out, three facets may be equally far away although the part is not round there, as in the cap of a capsule.
    const Moved centre = way.is_curve ? centred_at(start.position) : std::nullopt;
    const bool is_centre = centre && length(centre->position - start.position) <= off_centre * voxel_;
    return is_centre || (way.is_curve && middle_beside(start.position, way.direction)) ? Moved(start) : std::nullopt;
  }
  [[nodiscard]] Moved slide_inwards(Way& way) const {
    const auto at = [&](double t) { return on(way, t); };
    double bad = 0;
    for (const double t : inwards) {
      if (const Moved found = at(t)) return last_shown(at, t, bad, found);
      bad = t;
    }
    return std::nullopt;
  }

  /// Returns the separation angle at the end of a curve, degrees: twice the angle between the first footprint and the
  /// curve's direction. The second footprint is not used, because it depends on the facets.
  [[nodiscard]] static double angle_ahead(const AxisVertex& vertex, const Vec3d& direction) {
    if (!(vertex.radius > 0) || !(squared_length(direction) > 0)) return 180;
    const double cosine = dot(vertex.footprints[0] - vertex.position, direction) / vertex.radius;
    return cosine > 0 ? 2 * std::acos(std::min(cosine, 1.0)) * degrees_per_radian : 180;
  }

  /// Returns true if two vertices lie on one smooth sheet. The directions from the first to the second footprint of
  /// both vertices decide.
  [[nodiscard]] static bool goes_on(const AxisVertex& a, const AxisVertex& b) {
    constexpr double least = 0.9;  // cosine
    const Vec3d p = a.footprints[1] - a.footprints[0];
    const Vec3d q = b.footprints[1] - b.footprints[0];
    return std::abs(dot(p, q)) >= least * length(p) * length(q);
  }

  /// Returns the last shown vertex between the parameters `good`, where the vertex is shown, and `bad`, where it is
  /// not, by halving.
  template <class At>
  [[nodiscard]] Moved last_shown(const At& at, double good, double bad, Moved best, int times = halvings) const {
    for (int n = 0; n < times; ++n) {
      const double t = 0.5 * (good + bad);
      if (const Moved found = at(t)) {
        best = found;
        good = t;
      } else {
        bad = t;
      }
    }
    return best;
  }

  /// Returns the last shown vertex on the straight line from a shown neighbour to a vertex.
  [[nodiscard]] Moved towards(std::uint32_t v, std::uint32_t neighbour, std::size_t walls, int times = halvings) const {
    const AxisVertex& from = lists_.vertices[neighbour];
    const Vec3d way = lists_.vertices[v].position - from.position;
    const std::vector<Footprint> feet = feet_of(neighbour);
    const auto at = [&](double t) -> Moved {
      const Moved found =
          balanced_at(from.position + way * t, feet, std::min<std::size_t>(walls, 2), {voxel_, voxel_, false});
      return found && is_shown(*found, walls) ? found : std::nullopt;
    };
    return last_shown(at, 0, 1, from, times);
  }

  [[nodiscard]] std::uint32_t best_neighbour(std::uint32_t v) const {
    std::uint32_t best = v;
    for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
      const std::uint32_t other = other_end(incidence_.edges()[e], v);
      if (lists_.vertices[other].separation_angle > lists_.vertices[best].separation_angle || best == v) best = other;
    }
    return best;
  }

  // ---- Walls ----

  [[nodiscard]] static Footprint foot_of(const AxisVertex& vertex, std::size_t k) {
    return {vertex.footprints[k], vertex.elements[k], 7};
  }
  void add_feet(std::uint32_t v, std::vector<Footprint>& feet) const {
    const AxisVertex& vertex = lists_.vertices[v];
    for (std::size_t k = 0; k < 2; ++k) {
      if (k == 1 && vertex.separation_angle == 0) break;
      const Footprint foot = foot_of(vertex, k);
      const auto is_same = [&](const Footprint& other) { return other.element == foot.element; };
      if (std::none_of(feet.begin(), feet.end(), is_same)) feet.push_back(foot);
    }
  }
  [[nodiscard]] std::vector<Footprint> feet_of(std::uint32_t v) const {
    std::vector<Footprint> feet;
    add_feet(v, feet);
    return feet;
  }
  [[nodiscard]] std::vector<Footprint> feet_around(std::uint32_t v) const {
    std::vector<Footprint> feet = feet_of(v);
    for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
      add_feet(other_end(incidence_.edges()[e], v), feet);
    }
    for (std::size_t k = 0; k < 6 && incidence_.edges_of_vertex()[v].empty(); ++k) {
      Vec3d beside = lists_.vertices[v].position;
      beside[k / 2] += k % 2 == 0 ? voxel_ : -voxel_;
      const NearestPoint at = surface_.nearest(beside, foot_of(lists_.vertices[v], 0));
      feet.push_back({at.point, at.element, 7});
    }
    if (feet.size() > most_walls) feet.resize(most_walls);
    return feet;
  }

  /// Moves each vertex for which `where` returns a new vertex, unless its edges would leave the solid.
  /// @return  largest move, mesh units.
  template <class Where>
  double move(const Where& where) {
    std::vector<VertexMove> moves = mover_.moves_to(where);
    for (std::size_t v = 0; v < is_not_round_.size(); ++v) {
      if (is_not_round_[v] == 0) continue;
      const Vec3d& at = lists_.vertices[v].position;
      known_.not_round.insert({at.x, at.y, at.z});
      is_not_round_[v] = 0;
    }
    return mover_.make(std::move(moves));
  }

  /// Moves vertices as move() does, but skips a vertex of a border if an earlier call with the same data did not move
  /// it.
  template <class Where>
  double move_unsettled(Settled& settled, const Where& where) {
    const double furthest = move([&](std::uint32_t v) -> Moved {
      const Kind& kind = kinds_[v];
      const bool is_inside = kind.rims + kind.seams + kind.curves == 0 && kind.inner > 0;
      if (is_inside) return where(v);  // most vertices; `where` decides these quickly by their kind
      const std::uint64_t sight = sight_of(v);
      if (settled.contains(sight)) return std::nullopt;
      Moved found = where(v);
      if (found && !is_same_vertex(lists_.vertices[v], *found, voxel_)) return found;
      sight_[v] = sight;
      return std::nullopt;
    });
    for (std::uint64_t& sight : sight_) {
      if (sight != 0) settled.insert(std::exchange(sight, 0));
    }
    return furthest;
  }
  /// Returns a hash of the data that determine how a vertex of a border moves.
  [[nodiscard]] std::uint64_t sight_of(std::uint32_t v) const {
    SightHash hash;
    const Kind& kind = kinds_[v];
    for (const std::uint32_t count : {kind.rims, kind.seams, kind.curves, kind.inner}) hash.add(count);
    hash.add(lists_.vertices[v]);
    for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
      hash.add(lists_.vertices[other_end(incidence_.edges()[e], v)]);
    }
    if (kind.is_rim()) hash.add(directions_.of_rim(v));
    return hash.value();
  }

  AxisLists& lists_;
  const FitTarget& target_;
  const Surface& surface_;
  double voxel_;
  const Context& context_;
  Incidence incidence_;
  std::vector<Kind> kinds_;
  BorderDirections directions_;
  Known& known_;
  // Results of the current step, written by many threads, to be added to known_.
  std::vector<std::uint8_t> is_not_round_;
  std::vector<std::uint64_t> sight_;  ///< for each vertex: hash of its data if the step does not move it; else 0
  VertexMover mover_;
};

/// Limits in voxels. Triangles up to the height `thin` are replaced by two of their sides. In the middle of round parts
/// the limit is `thin_if_round`. Curves closer together than `beside` are merged.
constexpr double thin = 0.02;
constexpr double thin_if_round = 0.2;
constexpr double beside = 0.1;
/// Greatest radius in parts of the solid that are much thinner than a voxel, in voxels.
constexpr double far_below_a_voxel = 0.05;
/// Sheets with an area of up to `crumb` square voxels are removed if they lie within `on_others` voxels of other
/// sheets.
constexpr double crumb = 16;
constexpr double on_others = 0.2;
/// Edges up to this length, in voxels, that stick out of a rim are removed. The rim is later moved outwards instead.
constexpr double whiskers = 1;

/// Runs the steps one after the other. Steps use the same Fitter until one of them changes the cells.
class Fitting {
 public:
  Fitting(AxisLists& lists, const FitTarget& target, const Context& context)
      : lists_(lists), target_(target), context_(context) {}

  using Step = double (Fitter::*)();

  /// @return  largest move of a vertex, voxels.
  double take(Step step) { return (fitter().*step)() / target_.voxel; }
  double take(Step step, const ShortLengths& lengths) {
    const double furthest = take(step);
    contract(lengths);
    return furthest;
  }
  void contract(const ShortLengths& lengths) {
    const std::size_t before = lists_.vertices.size();
    if (contract_short(lists_, fitter().incidence(), target_.surface, target_.voxel, lengths, context_)) {
      fitter_.reset();
    }
    has_contracted_ = lists_.vertices.size() != before;
  }
  /// Returns true if the last call of contract() changed anything. After contractions, narrow strips may be shorter
  /// than before.
  [[nodiscard]] bool has_contracted() const { return has_contracted_; }
  /// Removes cells whose angle is at most theta, and cells that lie on other cells, as far as homotopy allows.
  /// @return  true if the number of triangles and edges changed.
  bool trim_excess() {
    const std::size_t before = lists_.triangles.size() + lists_.edges.size();
    const double voxel = target_.voxel;
    const TrimLimits limits{target_.theta, thin * voxel, thin_if_round * voxel, whiskers * voxel, beside * voxel};
    if (trim(lists_, fitter().incidence(), fitter().angles(), limits, context_)) fitter_.reset();
    merge();
    return lists_.triangles.size() + lists_.edges.size() != before;
  }
  void bend_curves() {
    if (fitter().bend_curves()) fitter_.reset();
    merge();
  }
  /// @return  largest move of sheets, mesh units.
  double thin_out() {
    if (!(target_.tolerance > 0)) return 0;
    const double moved = thin_insides(lists_, fitter().incidence(), target_, context_);
    fitter_.reset();
    return moved;
  }
  /// @param most_radius  voxels; only vertices with radii up to this are treated.
  void take_folds_away(double most_radius) {
    const UnfoldLimits limits{target_.voxel, most_radius * target_.voxel};
    if (unfold(lists_, fitter().incidence(), target_.surface, limits, context_)) fitter_.reset();
  }
  void take_crumbs_away() {
    const double voxel = target_.voxel;
    const CrumbLimits limits{crumb * voxel * voxel, on_others * voxel};
    if (take_crumbs(lists_, fitter().incidence(), limits, context_)) fitter_.reset();
  }
  /// Merges curves that run side by side.
  void merge() {
    if (merge_curves(lists_, target_.surface, beside * target_.voxel, context_)) fitter_.reset();
  }

 private:
  Fitter& fitter() {
    if (!fitter_) fitter_ = std::make_unique<Fitter>(lists_, target_, known_, context_);
    return *fitter_;
  }

  AxisLists& lists_;
  const FitTarget& target_;
  const Context& context_;
  Fitter::Known known_;
  std::unique_ptr<Fitter> fitter_;
  bool has_contracted_ = false;
};

}  // namespace

double fit_axis(AxisLists& lists, const FitTarget& target, const Context& context) {
  constexpr ShortLengths nothing{};
  constexpr ShortLengths inside{.on_seams = 0, .on_rims = 0};
  constexpr ShortLengths with_seams{.on_seams = 0.6, .at_corners = 2};
  constexpr ShortLengths with_rims{.on_seams = 0.6, .on_rims = 0.3, .of_crumbs = 1.5, .at_corners = 2, .of_slivers = 4};
  Fitting fitting(lists, target, context);
  fitting.take(&Fitter::find_centres);
  fitting.trim_excess();
  // Vertices that are close together are first contracted to one, so that only one of them must be moved to its sheet.
  fitting.contract(inside);
  fitting.take(&Fitter::find_sheets, nothing);
  // In parts much thinner than a voxel, the cells do not determine the order of vertices along the walls, so triangles
  // may be folded.
  fitting.take_folds_away(far_below_a_voxel);
  const double moved = fitting.thin_out();
  fitting.take(&Fitter::place_seams, with_seams);
  fitting.take(&Fitter::place_seams, with_seams);
  fitting.take(&Fitter::straighten, with_seams);
  fitting.take(&Fitter::straighten, with_seams);
  fitting.take(&Fitter::cut_rims, with_seams);
  double furthest_cut = fitting.take(&Fitter::cut_rims, with_rims);
  bool is_changed = fitting.has_contracted();
  is_changed = fitting.trim_excess() || is_changed;
  fitting.take(&Fitter::place_seams, with_rims);
  fitting.bend_curves();
  // A change may require another round, and ends of curves that move far need several rounds.
  constexpr int most_rounds = 3;
  constexpr double far = 0.5;
  for (int round = 0; round < most_rounds; ++round) {
    is_changed = fitting.take(&Fitter::take_back, with_rims) > 0 || is_changed;
    is_changed = fitting.trim_excess() || is_changed;
    if (!is_changed && furthest_cut < far) break;
    furthest_cut = fitting.take(&Fitter::cut_rims, with_rims);
    is_changed = fitting.has_contracted();
  }
  // Strips of sheets around a curve may have become the curve only now, shorter than the curve should be. In thin
  // parts that are not round, curves may end far from where the angle is theta.
  constexpr int most_cuts = 64;
  for (int n = 0; n < most_cuts; ++n) {
    fitting.merge();
    if (fitting.take(&Fitter::cut_ends) < far) break;
  }
  fitting.take(&Fitter::cut_rims_short);
  fitting.take(&Fitter::place_curves);
  fitting.bend_curves();
  fitting.take_folds_away(HUGE_VAL);
  fitting.take_crumbs_away();
  return moved;
}

}  // namespace blum::detail
