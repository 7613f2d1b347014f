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
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/fit/split_curves.hpp"
#include "medial_axis/fit/trim.hpp"
#include "medial_axis/fit/unfold.hpp"
#include "medial_axis/fit/vertex_mover.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum::detail {
namespace {

/// Directions in which vertices of rims, and ends of seams and curves, may slide. They have unit length, or are zero if
/// unknown.
class BorderDirections {
 public:
  /// @param kinds  of the vertices. All arguments must outlive this object.
  BorderDirections(const AxisLists& lists, const Incidence& incidence, const std::vector<Kind>& kinds)
      : lists_(lists), incidence_(incidence), kinds_(kinds) {}

  /// Returns the direction away from the sheet, from nearby edges of the rim.
  [[nodiscard]] Vec3d of_rim(std::uint32_t v) const;
  /// Returns the direction along the sheet to where it is less deep: over convex edges at which it ends.
  [[nodiscard]] Vec3d towards_surface(std::uint32_t v) const;
  /// Returns the direction away from the only neighbour along a seam (at least `triangles` triangles) or curve (0).
  [[nodiscard]] Vec3d of_end(std::uint32_t v, std::size_t triangles) const;
  /// Returns true if a curve that ends at a vertex comes back there beside a longer edge. It will be removed, so it
  /// must not follow the other edge.
  [[nodiscard]] bool comes_back(std::uint32_t v) const;

 private:
  /// Returns a vector from a triangle outwards through its side, as long as the side.
  [[nodiscard]] Vec3d outwards_of(std::uint32_t e) const;

  const AxisLists& lists_;
  const Incidence& incidence_;
  const std::vector<Kind>& kinds_;
};

Vec3d BorderDirections::of_rim(std::uint32_t v) const {
  constexpr int reach = 4;
  Vec3d sum;
  for (const std::uint32_t first : incidence_.edges_of_vertex()[v]) {
    if (incidence_.triangles_of_edge()[first].size() != 1) continue;
    std::uint32_t e = first;
    std::uint32_t from = v;
    for (int n = 0; n < reach; ++n) {
      sum += outwards_of(e) / (1 + n);
      const std::uint32_t next = other_end(incidence_.edges()[e], from);
      if (!kinds_[next].is_rim()) break;
      const std::uint32_t at = e;
      for (const std::uint32_t other : incidence_.edges_of_vertex()[next]) {
        if (other != at && incidence_.triangles_of_edge()[other].size() == 1) e = other;
      }
      from = next;
    }
  }
  const double size = length(sum);
  return size > 0 ? sum / size : Vec3d{};
}

Vec3d BorderDirections::towards_surface(std::uint32_t v) const {
  const AxisVertex& vertex = lists_.vertices[v];
  const Vec3d way = vertex.footprints[0] + vertex.footprints[1] - 2 * vertex.position;
  const double size = length(way);
  constexpr double least = 0.1;  // of the radius: 174 degrees
  return size > least * vertex.radius ? way / size : Vec3d{};
}

Vec3d BorderDirections::outwards_of(std::uint32_t e) const {
  const auto& side = incidence_.edges()[e];
  const std::uint32_t third = third_corner(lists_.triangles[incidence_.triangles_of_edge()[e][0]], side);
  const Vec3d& at = lists_.vertices[side[0]].position;
  const Vec3d along = lists_.vertices[side[1]].position - at;
  const Vec3d in = lists_.vertices[third].position - at;
  const double squared = squared_length(along);
  if (!(squared > 0)) return {};
  const Vec3d out = along * (dot(in, along) / squared) - in;
  const double size = length(out);
  return size > 0 ? out * (std::sqrt(squared) / size) : Vec3d{};
}

Vec3d BorderDirections::of_end(std::uint32_t v, std::size_t triangles) const {
  const auto next_of = [&](std::uint32_t at, std::uint32_t before) {
    for (const std::uint32_t e : incidence_.edges_of_vertex()[at]) {
      const std::size_t count = incidence_.triangles_of_edge()[e].size();
      if (triangles == 0 ? count > 0 : count < triangles) continue;
      const std::uint32_t other = other_end(incidence_.edges()[e], at);
      if (other != before) return other;
    }
    return at;
  };
  const std::uint32_t first = next_of(v, v);
  const std::uint32_t second = kinds_[first].is_seam() || kinds_[first].is_curve() ? next_of(first, v) : first;
  const Vec3d way = lists_.vertices[v].position - lists_.vertices[second].position;
  const double size = length(way);
  return size > 0 ? way / size : Vec3d{};
}

bool BorderDirections::comes_back(std::uint32_t v) const {
  constexpr double same_way = 0.95;  // cosine
  const std::uint32_t own = incidence_.edges_of_vertex()[v][0];
  const std::uint32_t at = other_end(incidence_.edges()[own], v);
  const Vec3d way = lists_.vertices[v].position - lists_.vertices[at].position;
  for (const std::uint32_t e : incidence_.edges_of_vertex()[at]) {
    if (e == own || !incidence_.triangles_of_edge()[e].empty()) continue;
    const Vec3d other = lists_.vertices[other_end(incidence_.edges()[e], at)].position - lists_.vertices[at].position;
    const bool is_longer =
        squared_length(other) > squared_length(way) || (squared_length(other) == squared_length(way) && e < own);
    if (is_longer && dot(way, other) >= same_way * length(way) * length(other)) return true;
  }
  return false;
}

/// Hash of the data that a step depends on, of 64 bits. Among 10^6 different data, two share a hash in 10^-7 of all
/// runs.
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

/// Hashes of the data with which a step left the vertex as it was.
using Settled = std::unordered_set<std::uint64_t>;

/// Returns true if two vertices are the same up to rounding.
/// @param voxel  mesh units.
inline bool is_same_vertex(const AxisVertex& a, const AxisVertex& b, double voxel) {
  constexpr double next_to_nothing = 1e-6;  // voxels, degrees
  const double most = next_to_nothing * voxel;
  return a.sites == b.sites && squared_length(a.position - b.position) <= most * most &&
         std::abs(a.radius - b.radius) <= most && std::abs(a.separation_angle - b.separation_angle) <= next_to_nothing;
}

/// Moves vertices of lists, whose cells stay except in bend_curves(). Results that depend only on the cells are
/// computed once.
class Fitter {
  // Limits of all steps.
  static constexpr std::size_t vertices_per_range = 64;
  /// Voxels that a vertex may move: on a seam, to a curve, to the middle of a round part.
  static constexpr double most_moved = 1.5;
  static constexpr double most_moved_to_curve = 2.5;
  static constexpr double most_moved_to_centre = 4;
  /// Radius at which sheets end that reach the surface, in voxels.
  static constexpr double least_radius = 0.02;
  static constexpr std::array short_radii{0.2, 0.1, 0.05};
  /// Separation angle, in degrees, between walls that do not meet near by.
  static constexpr double parallel = 175;
  /// Next to the end of a sheet, at most this much more than theta is seen, in degrees.
  static constexpr double nearly_theta = 10;
  /// Places on the way outwards and inwards at which the angle is evaluated, in voxels.
  static constexpr std::array outwards{0.25, 0.5, 1.0, 1.5, 2.0, 2.5};
  static constexpr std::array inwards{-0.25, -0.5, -1.0, -1.5, -2.0, -2.5};
  static constexpr int halvings = 9;
  /// Borders stay if they are this close to where they end, in voxels. The halvings find that place this exactly.
  static constexpr double settled = 0.001;
  /// Distance from a vertex at which the point opposite of a footprint is searched for, in voxels. `facets` is how much
  /// further than the footprint this point may be.
  static constexpr double opposite_step = 0.3;
  static constexpr double facets = 0.02;

 public:
  /// Results that are kept for the next Fitter.
  struct Known {
    std::set<std::array<double, 3>> not_round;  ///< places where centred() found nothing
    Settled seams, rims;                        ///< of place_seams() and cut_rims()
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

  // ---- Steps: they move vertices and return the largest move, mesh units ----

  /// Moves vertices of ribbons to the middle of a round part. Otherwise trim() would remove those that are not shown.
  double find_centres() {
    return move([&](std::uint32_t v) -> Moved {
      if (kinds_[v].rims + kinds_[v].curves == 0 || is_shown(lists_.vertices[v], 3)) return std::nullopt;
      const Moved found = between(v, 3);
      if (!found || !is_shown(*found, 3)) return centred(v);
      // Rims of sheets that know of one wall only are next to a place between two walls.
      const Moved between_two = on_sheet(v);
      const Vec3d& at = lists_.vertices[v].position;
      const bool is_nearer =
          between_two && squared_length(between_two->position - at) < squared_length(found->position - at);
      return is_nearer && is_shown(*between_two, 2) ? between_two : found;
    });
  }
  /// Moves vertices that know of one wall only between two walls.
  double find_sheets() {
    return move([&](std::uint32_t v) { return lists_.vertices[v].separation_angle > 0 ? std::nullopt : on_sheet(v); });
  }
  /// Incidence of the lists, valid as long as none of their edges is removed.
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  /// Returns the angle that each vertex sees, degrees.
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
  /// Moves only vertices of curves, after short edges beside them were contracted.
  double place_curves() {
    return move([&](std::uint32_t v) { return kinds_[v].curves > 0 ? balanced(v) : std::nullopt; });
  }
  /// Moves vertices inside of a sheet to the seam if they were put on another sheet beyond it.
  double straighten() {
    return move([&](std::uint32_t v) { return is_bent(v) ? straightened(v) : std::nullopt; });
  }
  /// Moves vertices that are not shown, next to shown ones, to the middle of a round part. If that fails, those of rims
  /// and curves between two shown ones go to the nearest of these.
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
  /// Inserts vertices into edges of curves that leave the bent middle of a round part.
  /// @return  true if any was inserted. The lists then have other cells, and this object must not be used any more.
  bool bend_curves() {
    return split_curves(
        lists_, incidence_, surface_, voxel_, [&](const Vec3d& at) { return centred_at(at); }, context_);
  }
  double cut_rims() {
    return move_unsettled(known_.rims, [&](std::uint32_t v) { return cut(v); });
  }
  /// Moves rims that stayed far from the surface because edges between them would have cut off corners of holes. They
  /// go to a radius of a fifth of a voxel, a tenth, a twentieth, as far as their edges allow.
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

  // ---- Places of vertices ----

  /// Returns the place of a vertex of a seam, junction or curve: between as many walls as it should have.
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
    // A vertex that is not shown may lie more than a voxel beside a round part.
    const double reach = is_shown(vertex, 3) ? most_moved : most_moved_to_curve;
    return balanced_at(vertex.position, feet_around(v), walls, {voxel_, reach * voxel_, true});
  }

  /// Returns a place between the two walls of the rest of the sheet next to a vertex. If these are unknown, it is
  /// between any two.
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

  /// Returns the middle of a round part around a vertex, if it is shown.
  [[nodiscard]] Moved centred(std::uint32_t v) {
    const Vec3d& at = lists_.vertices[v].position;
    if (known_.not_round.contains({at.x, at.y, at.z})) return std::nullopt;
    Moved found = centred_at(at);
    is_not_round_[v] = found ? 0 : 1;
    return found;
  }
  [[nodiscard]] Moved centred_at(const Vec3d& start) const {
    const std::optional<RoundCentre> centre =
        round_centre(surface_, start, {voxel_, most_moved_to_centre * voxel_, target_.theta});
    if (!centre) return std::nullopt;
    // Prefers a point where three facets are equally far, if it is next to the middle.
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

  /// Returns the result of balance(), with sites of the input.
  [[nodiscard]] Moved balanced_at(const Vec3d& start, const std::vector<Footprint>& feet, std::size_t walls,
                                  const BalanceLimits& limits) const {
    Moved found = balance(surface_, start, feet, walls, limits);
    if (!found) return found;
    if (walls > 2) widen(*found);
    for (SiteId& site : found->sites) site = target_.input_site(site);
    return found;
  }

  /// Returns a place on the seam for a vertex that is_bent(), if the sheet bends less then.
  [[nodiscard]] Moved straightened(std::uint32_t v) const {
    constexpr double better = 0.5;  // of the difference to 1
    const double bend = least_cosine(v, lists_.vertices[v].position);
    const Moved found = between(v, 3);
    if (!found || 1 - least_cosine(v, found->position) > better * (1 - bend)) return std::nullopt;
    return found;
  }

  /// Returns true if a vertex lies inside of a sheet that bends there.
  [[nodiscard]] bool is_bent(std::uint32_t v) const {
    constexpr double sharp = 0.9;  // cosine: 25 degrees
    const Kind& kind = kinds_[v];
    return kind.seams + kind.curves + kind.rims == 0 && least_cosine(v, lists_.vertices[v].position) <= sharp;
  }

  /// Returns the least cosine of the angles by which the sheet would bend at the edges of a vertex; 1 if it is flat.
  [[nodiscard]] double least_cosine(std::uint32_t v, const Vec3d& position) const {
    return least_cosine_at(lists_, incidence_, v, position);
  }

  /// Returns the closest point to a place a little further away from the first footprint. The vertex must not be on the
  /// surface.
  [[nodiscard]] NearestPoint opposite_of(const AxisVertex& vertex) const {
    const Vec3d away = (vertex.position - vertex.footprints[0]) / vertex.radius;
    return surface_.nearest(vertex.position + away * std::min(opposite_step * voxel_, 0.5 * vertex.radius),
                            foot_of(vertex, 0));
  }

  /// For round parts, takes the footprint opposite of the first one as the second, if it is as close.
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

  /// Returns the place of a vertex of a rim or end: where the angle is theta or the radius almost zero.
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

  /// Returns the mouth of a thin wall next to a vertex. There the angle drops to almost zero, also inside of a sheet
  /// that goes on beyond for homotopy alone.
  [[nodiscard]] Moved at_mouth(std::uint32_t v) const {
    if (is_shown(lists_.vertices[v], 2) || incidence_.edges_of_vertex()[v].empty()) return std::nullopt;
    const std::uint32_t inner = best_neighbour(v);
    const AxisVertex& thin = lists_.vertices[inner];
    constexpr double wider = 4;
    const bool is_thin = thin.radius < least_radius * voxel_ && thin.separation_angle >= parallel &&
                         wider * thin.radius < lists_.vertices[v].radius;
    // Edges to vertices beyond come out of the wall, so the mouth must be found to well within the wall's thickness.
    return is_thin && is_shown(thin, 2) ? towards(v, inner, 2, 3 * halvings) : std::nullopt;
  }

  /// Returns true if a vertex is shown: it sees more than theta, and the sheet does not end there.
  /// @param walls  of what the vertex lies on: on sheets (2), the two footprints determine the angle.
  [[nodiscard]] bool is_shown(const AxisVertex& vertex, std::size_t walls) const {
    // Sheets end where their two walls meet. Between parallel walls the radius may be this small anywhere.
    if (vertex.radius < least_radius * voxel_ && vertex.separation_angle < parallel) return false;
    return (walls > 2 ? angle_seen(vertex) : vertex.separation_angle) > target_.theta;
  }

  /// Returns the largest angle between footprints of a vertex. The point opposite of the first one counts if it is as
  /// far to within `facets`. Few facets of round parts meet in one point.
  [[nodiscard]] double angle_seen(const AxisVertex& vertex) const {
    const double own = vertex.separation_angle;
    if (own > target_.theta || !(vertex.radius > 0)) return own;
    const Vec3d opposite = opposite_of(vertex).point;
    if (length(opposite - vertex.position) > vertex.radius + facets * voxel_) return own;
    return std::max(own, angle_at(vertex.position, vertex.footprints[0], opposite));
  }

  /// Way of a vertex along its sheet, seam or curve, and results at its last point.
  struct Way {
    Vec3d origin;
    Vec3d direction;  ///< Unit length, or zero.
    std::size_t walls = 0;
    bool is_curve = false;  ///< True if it is a curve that ends at the vertex.
    std::vector<Footprint> feet;
    const AxisVertex* sheet = nullptr;  ///< A shown vertex of the sheet.
    double end_radius = least_radius;   ///< Radius at which it ends, in voxels.
    bool is_past = false;               ///< True if the last point is past the border, and not past something else.
    bool is_round = false;              ///< True if some point was in the middle of a round part.
  };
  [[nodiscard]] bool is_shown_on(const Way& way, const AxisVertex& vertex) const {
    if (vertex.radius < way.end_radius * voxel_ && vertex.separation_angle < parallel) return false;
    // Where a curve ends, feet around it are seen at twice the angle that they make with the curve.
    return is_shown(vertex, way.walls) && (!way.is_curve || angle_ahead(vertex, way.direction) > target_.theta);
  }
  /// Returns the vertex that many voxels on, if it is shown.
  [[nodiscard]] Moved on(Way& way, double voxels) const {
    const Vec3d place = way.origin + way.direction * (voxels * voxel_);
    Moved found = balanced_at(place, way.feet, way.walls, {voxel_, most_moved * voxel_, true});
    if (found && way.walls == 2 && !goes_on(*way.sheet, *found)) found.reset();
    way.is_past = found && !is_shown_on(way, *found);
    if (found && !way.is_past) return found;
    if (!way.is_curve) return std::nullopt;
    found = centred_at(place);
    if (found && !is_shown_on(way, *found)) found.reset();
    way.is_past = way.is_past || (way.is_round && !found);
    way.is_round = way.is_round || found;
    return found;
  }

  /// Returns the last shown vertex on the way from a vertex along its sheet or seam, down to a radius of `end_radius`
  /// voxels.
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
    // Most vertices are in their place already.
    if (!at(settled) && way.is_past) return start;
    double good = 0;
    for (const double t : outwards) {
      if (const Moved next = at(t)) {
        start = *next;
        good = t;
        continue;
      }
      // Beyond the reach of the ball, the surface may have been passed.
      const bool is_beyond = way.is_past || start.radius <= (t - good) * voxel_;
      start = *last_shown(at, good, t, start);
      // Beyond the rim of a lens only one wall is near.
      return is_beyond || start.separation_angle < target_.theta + nearly_theta ? Moved(start) : std::nullopt;
    }
    return way.is_round ? Moved(start) : std::nullopt;
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

  /// Returns the angle at which feet all around a curve are seen, in degrees. It is computed from the first foot and
  /// the direction of the curve, because the opposite foot depends on the facets.
  [[nodiscard]] static double angle_ahead(const AxisVertex& vertex, const Vec3d& direction) {
    if (!(vertex.radius > 0) || !(squared_length(direction) > 0)) return 180;
    const double cosine = dot(vertex.footprints[0] - vertex.position, direction) / vertex.radius;
    return cosine > 0 ? 2 * std::acos(std::min(cosine, 1.0)) * degrees_per_radian : 180;
  }

  /// Returns true if two vertices lie on one smooth sheet. The directions from one footprint to the other decide.
  [[nodiscard]] static bool goes_on(const AxisVertex& a, const AxisVertex& b) {
    constexpr double least = 0.9;  // cosine
    const Vec3d p = a.footprints[1] - a.footprints[0];
    const Vec3d q = b.footprints[1] - b.footprints[0];
    return std::abs(dot(p, q)) >= least * length(p) * length(q);
  }

  /// Returns the last shown vertex between a shown place and one that is not, by halving.
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

  /// Returns the last shown vertex on the way from a shown neighbour.
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

  /// Moves all vertices for which `where` returns a place, except those whose edges would leave the solid.
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

  /// The same, but skips vertices that stayed before when all data around them were the same.
  template <class Where>
  double move_unsettled(Settled& settled, const Where& where) {
    const double furthest = move([&](std::uint32_t v) -> Moved {
      const Kind& kind = kinds_[v];
      const bool is_inside = kind.rims + kind.seams + kind.curves == 0 && kind.inner > 0;
      if (is_inside) return where(v);  // most are; their kind decides quickly
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
  /// Returns a hash of the data that determine the move of a vertex of a border.
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
  // Results of threads, for known_.
  std::vector<std::uint8_t> is_not_round_;
  std::vector<std::uint64_t> sight_;  ///< of vertices that stay; else 0
  VertexMover mover_;
};

/// Triangles up to this height count as two of their sides, and curves this close count as one, in voxels.
constexpr double thin = 0.02;
constexpr double thin_if_round = 0.2;
constexpr double beside = 0.1;
/// Radius in walls much thinner than cells, in voxels.
constexpr double far_below_a_voxel = 0.05;
/// Sheets up to this size, in square voxels, that lie this close to others, in voxels, are removed.
constexpr double crumb = 16;
constexpr double on_others = 0.2;
/// Edges up to this length that stick out of a rim count as a part of its sheet, in voxels.
constexpr double whiskers = 1;

/// Runs the steps one after the other. The Fitter is kept from step to step while the cells stay.
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
    if (contract_short(lists_, fitter().incidence(), target_.surface, target_.voxel, lengths, context_)) {
      fitter_.reset();
    }
  }
  /// Removes cells beyond the angle, and cells that lie on other cells, as far as possible.
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

 private:
  void merge() {
    if (merge_curves(lists_, target_.surface, beside * target_.voxel, context_)) fitter_.reset();
  }
  Fitter& fitter() {
    if (!fitter_) fitter_ = std::make_unique<Fitter>(lists_, target_, known_, context_);
    return *fitter_;
  }

  AxisLists& lists_;
  const FitTarget& target_;
  const Context& context_;
  Fitter::Known known_;
  std::unique_ptr<Fitter> fitter_;
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
  // If vertices are close together, only one of them is put on its sheet.
  fitting.contract(inside);
  fitting.take(&Fitter::find_sheets, nothing);
  // If walls are much closer than the cells, these do not determine the order of vertices along the walls.
  fitting.take_folds_away(far_below_a_voxel);
  const double moved = fitting.thin_out();
  fitting.take(&Fitter::place_seams, with_seams);
  fitting.take(&Fitter::place_seams, with_seams);
  fitting.take(&Fitter::straighten, with_seams);
  fitting.take(&Fitter::straighten, with_seams);
  fitting.take(&Fitter::cut_rims, with_seams);
  double furthest_cut = fitting.take(&Fitter::cut_rims, with_rims);
  bool is_changed = fitting.trim_excess();
  fitting.take(&Fitter::place_seams, with_rims);
  fitting.bend_curves();
  // Changes of one round may require the next one, and ends of curves go far in several steps.
  constexpr int most_rounds = 3;
  constexpr double far = 0.5;
  for (int round = 0; round < most_rounds; ++round) {
    is_changed = fitting.take(&Fitter::take_back, with_rims) > 0 || is_changed;
    is_changed = fitting.trim_excess() || is_changed;
    if (!is_changed && furthest_cut < far) break;
    furthest_cut = fitting.take(&Fitter::cut_rims, with_rims);
    is_changed = false;
  }
  fitting.take(&Fitter::cut_rims_short);
  fitting.take(&Fitter::place_curves);
  fitting.bend_curves();
  fitting.take_folds_away(HUGE_VAL);
  fitting.take_crumbs_away();
  return moved;
}

}  // namespace blum::detail
