#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/context.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "certificate/allowances.hpp"
#include "certificate/angle.hpp"
#include "certificate/checks.hpp"
#include "certificate/drawn_balls.hpp"
#include "certificate/missed_pairs.hpp"
#include "certificate/sampling.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

/// Distances of balls from an axis. The balls touch two walls at a large enough angle.
struct FoundBalls {
  Offsets all;                     ///< balls from random points of the whole solid
  std::vector<Offsets> bodies;     ///< for each body: balls from points in it, near its surface if that has triangles
  Offsets thin;                    ///< balls in the middle of parts thinner than a voxel
  std::vector<SeenBall> seen;      ///< for each point of the draws: the ball that counts, if one does
  std::vector<PairOfWalls> pairs;  ///< walls between which a sheet is missing
};

/// Returns the cells of an axis as triangles: edges of curves and single vertices have corners at the same place.
TriangleMesh cells_of(const MedialView& axis) {
  TriangleMesh cells;
  cells.vertices.assign(axis.positions.begin(), axis.positions.end());
  std::vector<bool> is_named(axis.positions.size(), false);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c}) is_named[v] = true;
    if (is_finite(cells.vertices[a]) && is_finite(cells.vertices[b]) && is_finite(cells.vertices[c])) {
      cells.triangles.push_back({a, b, c});
    }
  };
  for (const auto& [a, b, c] : axis.triangles) add(a, b, c);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    if (axis.edge_role(e) == MedialRole::curve) add(axis.edges[e][0], axis.edges[e][1], axis.edges[e][1]);
  }
  for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
    if (!is_named[v]) add(v, v, v);
  }
  return cells;
}

/// Decides which balls count as lying between two walls.
class BallJudge {
 public:
  BallJudge(const Allowances& allowed, double theta, double sought)
      : allowed_(allowed), sought_(sought), above_theta_(sought - theta) {}

  /// Returns the k-th ball; a ball of radius 0 if it does not count.
  [[nodiscard]] TouchingBall ball(const BallDraws& draws, std::size_t k) const {
    return draws.grown(
        k, sought_,
        [&](const TouchingBall& ball) { return allowed_.counts(length(ball.first - ball.second), ball.angle); },
        [&](double radius) { return reach_in(radius); });
  }

 private:
  /// Returns how far the surface may reach into a ball. A little is allowed, because all facets of a round part are
  /// about equally close. If a plane reaches by d into a ball of radius r, the separation angle may be smaller by up to
  /// acos(1 - d/r). So d is limited by the difference between theta and the sought angle. In a wedge of 164 degrees,
  /// 0.1 voxel alone would appear as 175 degrees.
  [[nodiscard]] double reach_in(double radius) const {
    constexpr double nearly_whole = 0.1;  // voxels: all facets of round parts are about equally close
    return std::min(nearly_whole * allowed_.voxel, radius * (1 - std::cos(above_theta_ / degrees_per_radian)));
  }

  const Allowances& allowed_;
  double sought_, above_theta_;
};

/// Measures how far the centres of the balls are from the axis, and adds them to `seen`.
Offsets offsets_of_balls(const BallDraws& draws, const BallJudge& judge, const TriangleSearch& search,
                         const Allowances& allowed, std::vector<SeenBall>& seen, const Context& context) {
  const std::size_t before = seen.size();
  seen.resize(before + draws.size());
  const auto add = [&](Offsets& offsets, std::size_t k) {
    const TouchingBall ball = judge.ball(draws, k);
    if (!(ball.radius > 0)) return;
    const double near = allowed.missing_at(ball.radius);
    // Distances below both the allowance and the largest distance so far need not be exact.
    const double enough = std::min(near, offsets.furthest);
    const double distance = search.distance_above(ball.centre, enough, no_group);
    offsets.add(distance, near, near, near, ball.centre);
    seen[before + k] = {ball, draws.body(k)};
  };
  return gathered_offsets(draws.size(), "looking for what is missing", add, context);
}

/// Decides which balls count as lying in the middle of a part thinner than a voxel.
class ThinBallJudge {
 public:
  ThinBallJudge(const SolidOracle& solid, const Allowances& allowed, double theta, double sought)
      : solid_(solid),
        allowed_(allowed),
        floor_(std::max(sought, Allowances::opposite)),
        reach_in_(1 - std::cos((floor_ - theta) / degrees_per_radian)) {}

  /// Returns the k-th ball; a ball of radius 0 if it does not count.
  [[nodiscard]] TouchingBall ball(const BallDraws& draws, std::size_t k, std::uint32_t body) const {
    TouchingBall found = draws.grown(
        k, allowed_.noise, allowed_.thin(), [&](const TouchingBall& ball) { return ball.radius <= allowed_.thin(); },
        [](double radius) { return radius; });
    for (int n = 0; n < most_climbs && found.radius > 0 && found.angle < floor_; ++n) found = larger(found, body);
    const bool counts = found.angle >= floor_ && found.radius > allowed_.rounding && found.radius <= allowed_.thin() &&
                        length(found.first - found.second) >= allowed_.lambda;
    return counts && fits(found, body) && is_largest(found, body) ? found : TouchingBall{};
  }

 private:
  static constexpr int most_climbs = 4;

  /// Returns a larger ball in the same part of the solid, preferably one between opposite walls. Its centre is beyond
  /// that of the given ball, away from both walls. Most balls in a part of many facets touch two facets at a small
  /// angle. Returns a ball of radius 0 if there is none, or if the part is not thin.
  [[nodiscard]] TouchingBall larger(const TouchingBall& ball, std::uint32_t body) const {
    constexpr double shorter = 0.7;
    constexpr double least_step = 0.1;  // of the radius
    const Vec3d away = 2 * ball.centre - ball.first - ball.second;
    const double size = length(away);
    if (!(size > 0)) return {};
    double best = 1.001 * ball.radius;
    Vec3d centre = ball.centre;
    for (double step = 2 * allowed_.thin(); step > least_step * ball.radius; step *= shorter) {
      const Vec3d x = ball.centre + away * (step / size);
      const double depth = solid_.distance(x, body);
      // If two balls overlap, both are on the same side of the surface.
      if (!(depth > best) || step > ball.radius + depth) continue;
      if (depth > allowed_.thin()) return {};
      best = depth;
      centre = x;
    }
    if (centre == ball.centre) return {};
    const Vec3d first = solid_.closest_point(centre, body);
    const TouchingBall between = grown_ball(solid_, body, centre, first, floor_);
    return between.radius > 0 && fits(between, body) ? between
                                                     : grown_ball(solid_, body, centre, first, allowed_.noise);
  }
  /// Returns true if the surface hardly reaches into a ball; see BallJudge::reach_in().
  [[nodiscard]] bool fits(const TouchingBall& ball, std::uint32_t body) const {
    return ball.is_whole || ball.radius - solid_.distance(ball.centre, body) <= reach_in_ * ball.radius;
  }
  /// Returns true if no ball beside a given ball is much larger. Here, beside means at right angles to the line between
  /// the ball's walls. Sheets end in wedges and strips, where larger balls are on one side.
  [[nodiscard]] bool is_largest(const TouchingBall& ball, std::uint32_t body) const {
    constexpr int directions = 8;
    constexpr double much_larger = 1.05;
    const Vec3d between = (ball.first - ball.second) / length(ball.first - ball.second);
    const Vec3d other = std::abs(between.x) > 0.6 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d across = cross(between, other);
    const Vec3d u = across / length(across);
    const Vec3d v = cross(between, u);
    for (int n = 0; n < directions; ++n) {
      const double turn = 360.0 * n / directions / degrees_per_radian;
      const Vec3d beside = ball.centre + (u * std::cos(turn) + v * std::sin(turn)) * ball.radius;
      if (solid_.distance(beside, body) > much_larger * ball.radius) return false;
    }
    return true;
  }

  const SolidOracle& solid_;
  const Allowances& allowed_;
  double floor_;     ///< degrees: least separation angle of the balls that count
  double reach_in_;  ///< how far the surface may reach into a ball, as a share of its radius
};

/// Measures how far the centres of the balls in thin parts are from the axis.
Offsets offsets_of_thin(const BallDraws& draws, std::uint32_t body, const ThinBallJudge& judge,
                        const TriangleSearch& search, const Allowances& allowed, const Context& context) {
  const auto add = [&](Offsets& offsets, std::size_t k) {
    const TouchingBall ball = judge.ball(draws, k, body);
    if (!(ball.radius > 0)) return;
    const double near = allowed.missing_in_thin(ball.radius);
    const double enough = std::min(near, offsets.furthest);
    offsets.add(search.distance_above(ball.centre, enough, no_group), near, near, near, ball.centre);
  };
  return gathered_offsets(draws.size(), "looking for what is missing", add, context);
}

constexpr double above_theta_of_sheets = 10;  ///< degrees: at angles this far above theta, no large sheet is missing
constexpr std::size_t few_of_pair = 8;        ///< with fewer balls between two walls, nothing is concluded
constexpr double spacing_of_pair = 2;         ///< voxels: balls this close to each other are counted as one ball
constexpr std::size_t few_apart = 6;          ///< with fewer balls further apart, nothing is concluded
constexpr double least_held = 0.5;            ///< least share of balls next to a cell of their sheet

/// Replaces the balls of `seen` by those that count at smaller separation angles.
void add_flat_balls(const DrawnBalls& drawn, const Allowances& allowed, double theta, std::vector<SeenBall>& seen,
                    const Context& context) {
  const BallJudge judge(allowed, theta, std::min(theta + above_theta_of_sheets, 0.5 * (theta + 180)));
  std::size_t before = 0;
  const auto add = [&](const BallDraws& draws) {
    parallel_for(context, draws.size(), 64, "looking for what is missing", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const TouchingBall ball = judge.ball(draws, k);
        if (ball.radius > 0) seen[before + k] = {ball, draws.body(k)};
      }
    });
    before += draws.size();
  };
  add(drawn.in_solid());
  for (std::uint32_t b = 0; before < seen.size(); b += drawn.every()) add(drawn.in_body(b));
}

/// Returns the pairs of walls between which a sheet is missing.
std::vector<PairOfWalls> missing_sheets(const KnownSolid& solid, const std::vector<SeenBall>& seen,
                                        const TriangleMesh& cells, const TriangleSearch& search,
                                        const Allowances& allowed, const Context& context) {
  std::vector<PairOfWalls> pairs =
      pairs_of_walls(solid, seen, cells, search, allowed, few_of_pair, spacing_of_pair * allowed.voxel, context);
  std::erase_if(pairs, [](const PairOfWalls& pair) {
    return pair.apart <= few_apart || static_cast<double>(pair.held) >= least_held * static_cast<double>(pair.examined);
  });
  return pairs;
}

/// Computes balls from random points, the same in every run, and their distances from the axis.
/// @param theta   degrees.
/// @param sought  least separation angle of the balls that count, degrees.
/// @param fitted  true if ends in thin parts are judged, too.
/// @throws Cancelled.
FoundBalls find_balls(const MedialView& axis, const KnownSolid& solid, const Allowances& allowed, double theta,
                      double sought, bool fitted, const Context& context) {
  const auto body_count = static_cast<std::uint32_t>(solid.bodies.size());
  FoundBalls found{{}, std::vector<Offsets>(body_count), {}, {}, {}};
  if (!(sought > theta)) return found;  // no angle is above theta = 180 degrees
  const DrawnBalls& drawn = solid.drawn_balls();
  if (drawn.in_solid().size() == 0) return found;
  const TriangleMesh cells = cells_of(axis);
  const TriangleSearch search(cells, {}, context);
  const BallJudge judge(allowed, theta, sought);
  found.all = offsets_of_balls(drawn.in_solid(), judge, search, allowed, found.seen, context);
  // In a small body, a coarse grid shows only steep angles reliably.
  const BallJudge steep_judge(allowed, theta, std::max(sought, Allowances::steep));
  for (std::uint32_t b = 0; b < body_count; b += drawn.every()) {
    found.bodies[b] = offsets_of_balls(drawn.in_body(b), steep_judge, search, allowed, found.seen, context);
  }
  if (allowed.of_voxels || solid.solid->slack() > 0) return found;
  add_flat_balls(drawn, allowed, theta, found.seen, context);
  found.pairs = missing_sheets(solid, found.seen, cells, search, allowed, context);
  if (!fitted) return found;
  const ThinBallJudge thin_judge(*solid.solid, allowed, theta, sought);
  for (std::uint32_t b = 0; b < body_count; b += drawn.every()) {
    found.thin.add(offsets_of_thin(drawn.in_body(b), b, thin_judge, search, allowed, context));
    found.thin.add(offsets_of_thin(drawn.at_corners(b), b, thin_judge, search, allowed, context));
  }
  return found;
}

constexpr double least_share = 0.95;       ///< least share of samples in the middle: true axes have 0.99
constexpr double least_near_share = 0.9;   ///< the same near the middle, by distance to the wall: true axes have 0.94
constexpr double least_close_share = 0.5;  ///< least share of samples close to the middle: true axes have 0.8
constexpr double most_missed = 0.05;       ///< largest share of balls far from the axis: true axes have 0.01
constexpr double most_vertices_off = 0.1;  ///< largest share of vertices with one footprint away from the middle
constexpr double most_deep_of_one_wall =
    0.6;                              ///< share of deep vertices with one footprint: true axes have 0.4 (a rod at 0)
constexpr double enough_sheet = 256;  ///< least area of sheets, in square voxels, for that check
constexpr double far_off = 1.5;       ///< multiple of missing_at() by which such vertices may be off the middle
constexpr double few_vertices = 16;   ///< number of vertices that may be off in any case
constexpr double thin_part = 1;       ///< voxels: smallest radius of parts that are not thin
constexpr double one_footprint = 5;   ///< degrees: footprints at a smaller angle count as one
constexpr double well_above = 30;     ///< degrees: at angles this far above theta, the axis must be complete
constexpr double most_missed_of_surface = 0.1;  ///< largest share of missed balls near surfaces: true axes have 0.06
constexpr double most_missed_of_body = 0.5;     ///< the same in one body of several: a coarse grid may miss a sheet
constexpr double most_missed_of_voxels = 0.1;   ///< most_missed if only voxels define the inside
constexpr double few_missed = 3;                ///< number of balls that may be missed in any case
constexpr double few_missed_of_thin = 1;        ///< the same in thin parts, where true axes miss none
constexpr std::size_t few_balls = 20;           ///< with fewer balls, nothing is concluded
constexpr std::size_t most_samples_of_sheets = 8'192;
constexpr std::size_t most_samples_of_curves = 2'048;
constexpr std::size_t most_samples_of_vertices = 4'096;
constexpr std::size_t enough_samples = 12;  ///< least number of samples of a sheet that is checked by itself
constexpr double most_off_of_sheet = 0.5;   ///< largest share of these off the middle: true axes have 0.25
constexpr double small_sheet = 4;           ///< square voxels: smaller sheets are not checked by themselves
constexpr std::size_t most_samples_of_small = 4'096;
constexpr std::size_t grain = 64;

/// A point of the axis to check.
struct AxisPoint {
  Vec3d at;
  std::uint32_t body = 0;
  double angle = 0;  ///< separation angle that its cell claims, degrees
  double size = 0;   ///< length of the longest side of that cell
  double depth = 0;  ///< largest radius at the corners of that cell
  Vec3d normal{};    ///< of that cell, of any length; 0 for vertices and curves
};

/// Returns the number of samples: 16 per unit, at least 64 and at most `most`; 0 unless `units` is above 0.
std::size_t sample_count(double units, std::size_t most) {
  constexpr double per_unit = 16;
  constexpr std::size_t least = 64;
  if (!(units > 0)) return 0;
  return units * per_unit >= static_cast<double>(most) ? most
                                                       : std::max(least, static_cast<std::size_t>(units * per_unit));
}

class Middle {
 public:
  Middle(const KnownSolid& solid, const Allowances& allowed) : solid_(*solid.solid), allowed_(allowed) {}

  /// Approximate distance of a point from the middle between two walls, and the radius of the ball between them.
  struct Found {
    double off = HUGE_VAL;  ///< HUGE_VAL if there is no second wall
    double radius = 0;
  };
  [[nodiscard]] Found find(const AxisPoint& point) const {
    const Vec3d foot = solid_.closest_point(point.at, point.body);
    const double depth = length(point.at - foot);
    const double nothing = 1e-9 * solid_.diagonal(point.body);
    if (!(depth > nothing)) return {is_thin(point) ? 0 : HUGE_VAL, 0};
    const TouchingBall ball =
        grown_ball_from_near(solid_, point.body, point.at, foot, allowed_.floor_at(point.angle), allowed_.middle);
    if (!(ball.radius > 0) || is_aslant(point, ball)) return {};
    return {distance_to_middle(point.at, ball), ball.radius};
  }

 private:
  /// Returns true if a ball touches two neighbouring facets, but the cell does not lie along the wall between them. In
  /// a fine round part, every point is close to such a wall.
  [[nodiscard]] bool is_aslant(const AxisPoint& point, const TouchingBall& ball) const {
    constexpr double most_aslant = 60;  ///< degrees between normals of cell and wall
    if (ball.angle >= allowed_.noise || !(squared_length(point.normal) > 0)) return false;
    const double angle = degrees_between(point.normal, ball.first - ball.second);
    return std::min(angle, 180 - angle) > most_aslant;
  }

  /// Returns true if the solid is thin around a surface point: the other side is close in all directions.
  [[nodiscard]] bool is_thin(const AxisPoint& point) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Vec3d beside = point.at;
        beside[axis] += sign * allowed_.middle;
        if (solid_.depth(beside, point.body) > 0.5 * allowed_.middle) return false;
      }
    }
    return true;
  }

  const SolidOracle& solid_;
  const Allowances& allowed_;
};

/// @param point  returns the k-th point.
/// @param note   is called with k, and true if that point is off the middle.
template <class Point, class Note>
Offsets offsets_of(std::size_t count, const Middle& middle, const Allowances& allowed, const Point& point,
                   const Note& note, const Context& context) {
  const auto add = [&](Offsets& offsets, std::size_t k) {
    const AxisPoint p = point(k);
    const Middle::Found found = middle.find(p);
    note(k, !(found.off <= allowed.middle));
    // Where a thin part opens into a thick part, only the edges of the opening are close to the axis. So the check also
    // uses the radii at the cell's corners.
    const double radius = std::max(found.radius, p.depth);
    offsets.add(found.off, allowed.close_at(radius, p.size), allowed.middle_at(radius, p.size), allowed.middle, p.at);
  };
  return gathered_offsets(count, "looking for the middle", add, context);
}

std::array<Vec3d, 3> corners_of(const MedialView& axis, std::size_t t) {
  const auto& [a, b, c] = axis.triangles[t];
  return {axis.positions[a], axis.positions[b], axis.positions[c]};
}

double longest_side(const std::array<Vec3d, 3>& corners) {
  return std::max({length(corners[0] - corners[1]), length(corners[1] - corners[2]), length(corners[2] - corners[0])});
}

double deepest(const MedialView& axis, const std::array<std::uint32_t, 3>& corners) {
  return std::max({axis.radius[corners[0]], axis.radius[corners[1]], axis.radius[corners[2]]});
}

/// Returns the separation angle of a vertex's footprints in degrees.
double angle_at(const MedialView& axis, std::uint32_t v) {
  const Vec3d& p = axis.positions[v];
  return degrees_between(axis.footprint(v, 0) - p, axis.footprint(v, 1) - p);
}

/// The parts of an axis that, by the axis's own angles, should lie between two walls at more than theta.
class Claimed {
 public:
  /// @param noise           degrees up to which two walls count as one rough wall.
  /// @param has_footprints  true if footprints are known. Otherwise all angles of vertices are 0.
  Claimed(const MedialView& axis, double theta, double noise, bool has_footprints)
      : angles_(axis.positions.size(), 0),
        is_claimed_(axis.positions.size(), false),
        is_between_walls_(axis.positions.size(), false),
        claim_(axis.positions.size(), 0),
        least_radius_(axis.positions.size(), HUGE_VAL),
        two_walls_(std::max(theta, 2 * noise)) {
    for (std::uint32_t v = 0; has_footprints && v < angles_.size(); ++v) angles_[v] = angle_at(axis, v);
    for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
      const double size = triangle_area(axis, t);
      if (std::isfinite(size)) all_ += size;
      if (!(axis.triangle_angle[t] > theta)) continue;
      sheets_.add(size, t);
      add_corners(axis, axis.triangles[t], axis.triangle_angle[t]);
    }
    for (std::uint32_t e = 0; e < axis.edges.size(); ++e) {
      if (axis.edge_role(e) != MedialRole::curve || !(axis.edge_angle[e] > theta)) continue;
      curves_.add(length(axis.positions[axis.edges[e][0]] - axis.positions[axis.edges[e][1]]), e);
      add_corners(axis, axis.edges[e], axis.edge_angle[e]);
    }
  }

  [[nodiscard]] const Spread& sheets() const { return sheets_; }
  [[nodiscard]] const Spread& curves() const { return curves_; }
  [[nodiscard]] bool contains(std::size_t vertex) const { return is_claimed_[vertex]; }
  /// Returns true if a vertex should lie between two walls, judged by the angle of one of its cells and by that cell's
  /// other corners.
  [[nodiscard]] bool is_between_walls(std::size_t vertex) const { return is_between_walls_[vertex]; }
  /// Returns the largest angle that a judged cell at a vertex claims, degrees; 0 if the vertex has no judged cell.
  [[nodiscard]] double claim(std::size_t vertex) const { return claim_[vertex]; }
  /// Returns the separation angle of a vertex's footprints in degrees.
  [[nodiscard]] double angle(std::size_t vertex) const { return angles_[vertex]; }
  /// Returns the smallest radius at the corners of all cells at a vertex.
  [[nodiscard]] double least_radius_around(std::size_t vertex) const { return least_radius_[vertex]; }
  /// Returns the share of the area of all triangles that exist only for homotopy.
  [[nodiscard]] double rest_of_area() const { return all_ > 0 ? std::max(0.0, 1 - sheets_.total() / all_) : 0; }

 private:
  void add_corners(const MedialView& axis, std::span<const std::uint32_t> corners, double angle) {
    double least = HUGE_VAL;
    std::size_t between_walls = 0;
    for (const std::uint32_t v : corners) {
      is_claimed_[v] = true;
      claim_[v] = std::max(claim_[v], angle);
      least = std::min<double>(least, axis.radius[v]);
      between_walls += angles_[v] > two_walls_ ? 1 : 0;
    }
    for (const std::uint32_t v : corners) {
      least_radius_[v] = std::min(least_radius_[v], least);
      if (angle > two_walls_ && between_walls + 1 >= corners.size()) is_between_walls_[v] = true;
    }
  }

  std::vector<double> angles_;
  std::vector<bool> is_claimed_, is_between_walls_;
  std::vector<double> claim_;  ///< degrees
  std::vector<double> least_radius_;
  double two_walls_ = 0;  ///< degrees: above this angle, two walls are not one rough wall
  Spread sheets_, curves_;
  double all_ = 0;
};

/// Checks the vertices that should lie between two walls but have one footprint. If there are many of these vertices,
/// the function checks a sample.
void look_at_vertices(const MedialView& axis, const Claimed& claimed, const Middle& middle, const Allowances& allowed,
                      const std::vector<std::uint32_t>& body_of, MedialCheck& check, const Context& context) {
  std::vector<std::uint32_t> single;
  for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
    if (!is_finite(axis.positions[v])) continue;
    const bool is_deep = claimed.contains(v) && axis.radius[v] > allowed.middle;
    check.deep_vertices += is_deep ? 1 : 0;
    const double one =
        claimed.contains(v) ? std::min(one_footprint, allowed.floor_at(claimed.claim(v))) : one_footprint;
    if (claimed.angle(v) >= one) continue;
    ++check.one_wall;
    check.deep_one_wall += is_deep ? 1 : 0;
    if (claimed.contains(v)) single.push_back(v);
  }
  const std::size_t every = single.size() / most_samples_of_vertices + 1;
  std::vector<Middle::Found> found((single.size() + every - 1) / every);
  parallel_for(context, found.size(), grain, "looking for the middle", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const std::uint32_t v = single[k * every];
      found[k] = middle.find({axis.positions[v], body_of[v], claimed.claim(v)});
    }
  });
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::uint32_t v = single[k * every];
    // Where a thin part opens into a thick part, only the edges of the opening are close to the axis.
    const auto& [off, radius] = found[k];
    if (!(off > allowed.middle_at(radius)) || claimed.least_radius_around(v) < thin_part * allowed.voxel) continue;
    ++check.one_wall_off;
    if (!(off > far_off * allowed.missing_at(radius)) || !claimed.is_between_walls(v)) continue;
    if (check.one_wall_far++ == 0) check.far_at = axis.positions[v];
  }
}

/// Random points of the sheets that should lie between two walls.
class SheetPoints {
 public:
  SheetPoints(const MedialView& axis, const Spread& triangles, const std::vector<std::uint32_t>& body_of,
              std::size_t count)
      : axis_(axis), triangles_(triangles), body_of_(body_of), count_(count) {}

  [[nodiscard]] AxisPoint at(std::size_t k) const {
    Random random(0x5a3eULL + k);
    const std::uint32_t t = triangle(k, random);
    const std::array<Vec3d, 3> corners = corners_of(axis_, t);
    return {random_point(corners, random),
            body_of_[axis_.triangles[t][0]],
            axis_.triangle_angle[t],
            longest_side(corners),
            deepest(axis_, axis_.triangles[t]),
            cross(corners[1] - corners[0], corners[2] - corners[0])};
  }
  [[nodiscard]] std::int32_t sheet(std::size_t k) const {
    Random random(0x5a3eULL + k);
    return axis_.sheet[triangle(k, random)];
  }

 private:
  [[nodiscard]] std::uint32_t triangle(std::size_t k, Random& random) const {
    return triangles_.at((static_cast<double>(k) + random.uniform()) / static_cast<double>(count_));
  }

  const MedialView& axis_;
  const Spread& triangles_;
  const std::vector<std::uint32_t>& body_of_;
  std::size_t count_;
};

/// Counts samples off the middle for each sheet, so that a wrong sheet cannot hide among others.
class SheetJudge {
 public:
  void add(std::int32_t sheet, bool is_off, const Vec3d& at) {
    Sheet& own = sheets_[sheet];
    ++own.samples;
    if (is_off && own.off++ == 0) own.where = at;
  }
  [[nodiscard]] std::size_t samples(std::int32_t sheet) const {
    const auto at = sheets_.find(sheet);
    return at == sheets_.end() ? 0 : at->second.samples;
  }
  void note(MedialCheck& check) const {
    for (const auto& [number, sheet] : sheets_) {
      if (sheet.samples < enough_samples) continue;
      ++check.sheets_judged;
      if (!(static_cast<double>(sheet.off) > most_off_of_sheet * static_cast<double>(sheet.samples))) continue;
      if (check.sheets_off++ == 0) check.sheet_off_at = sheet.where;
    }
  }

 private:
  struct Sheet {
    std::size_t samples = 0, off = 0;
    Vec3d where;
  };
  std::map<std::int32_t, Sheet> sheets_;
};

/// Takes more samples of sheets that have too few, the largest sheets first.
void look_at_small_sheets(const MedialView& axis, const Claimed& claimed, const Middle& middle,
                          const Allowances& allowed, const std::vector<std::uint32_t>& body_of, SheetJudge& judge,
                          const Context& context) {
  std::map<std::int32_t, Spread> small;
  for (const std::uint32_t t : claimed.sheets().cells()) {
    if (judge.samples(axis.sheet[t]) < enough_samples) small[axis.sheet[t]].add(triangle_area(axis, t), t);
  }
  std::vector<const Spread*> chosen;
  for (const auto& [sheet, spread] : small) {
    if (spread.total() >= small_sheet * allowed.voxel * allowed.voxel) chosen.push_back(&spread);
  }
  const std::size_t most = std::min(chosen.size(), most_samples_of_small / enough_samples);
  std::sort(chosen.begin(), chosen.end(), [](const Spread* a, const Spread* b) {
    return a->total() != b->total() ? a->total() > b->total() : a->cells().front() < b->cells().front();
  });
  std::vector<std::uint8_t> is_off(most * enough_samples);
  const auto point = [&](std::size_t k) {
    return SheetPoints(axis, *chosen[k / enough_samples], body_of, enough_samples).at(k % enough_samples);
  };
  static_cast<void>(offsets_of(
      is_off.size(), middle, allowed, point, [&](std::size_t k, bool off) { is_off[k] = off ? 1 : 0; }, context));
  for (std::size_t k = 0; k < is_off.size(); ++k) {
    judge.add(axis.sheet[chosen[k / enough_samples]->cells().front()], is_off[k] != 0, point(k).at);
  }
}

// ---- Messages ----

std::string percent(double share) {
  return rounded_text(std::round(share * 1000) / 10) + " %";
}

/// @param by_voxels  true if only voxels define the inside. Then walls inside the solid that bound nothing are as close
///                   as other walls. So shares in the middle are reported but cause no mismatches.
void explain(const MedialCheck& check, bool by_voxels, std::vector<std::string>& mismatches) {
  const double most_missed_here = by_voxels ? most_missed_of_voxels : most_missed;
  const std::string allowed = " (allowed: " + rounded_text(check.allowance) + ")";
  if (!by_voxels && check.medial_share < least_share) {
    mismatches.push_back("of the sheets and curves that should lie between two walls, only " +
                         percent(check.medial_share) + " lie midway; the largest distance from the middle is " +
                         rounded_text(check.off_by) + ", at " + place_text(check.off_at) + allowed);
  }
  if (!by_voxels && check.near_share < least_near_share) {
    mismatches.push_back("of the sheets and curves that should lie between two walls, only " +
                         percent(check.near_share) +
                         " are closer to the middle than a quarter of their distance to the walls");
  }
  if (!by_voxels && check.close_share < least_close_share) {
    mismatches.push_back("of the sheets and curves that should lie between two walls, only " +
                         percent(check.close_share) + " are within " + rounded_text(check.close_allowance) +
                         " of the middle");
  }
  const double vertices_off = most_vertices_off * static_cast<double>(check.claimed_vertices);
  if (static_cast<double>(check.one_wall_off) > std::max(vertices_off, few_vertices)) {
    mismatches.push_back("of the " + count_text(check.claimed_vertices) +
                         " vertices that should lie between two walls, " + count_text(check.one_wall_off) +
                         " have only one footprint and are not near the middle" + allowed);
  }
  if (!by_voxels && check.one_wall_far > 0) {
    mismatches.push_back(count_text(check.one_wall_far) +
                         " vertices that should lie between two walls have only one footprint and are more than " +
                         rounded_text(far_off * check.missing_allowance) + " away from the middle, the first one at " +
                         place_text(check.far_at));
  }
  if (!by_voxels && check.sheets_off > 0) {
    mismatches.push_back("of the " + count_text(check.sheets_judged) + " sheets that should lie between two walls, " +
                         count_text(check.sheets_off) + " lie mostly off the middle, the first one at " +
                         place_text(check.sheet_off_at) + allowed);
  }
  const auto balls = static_cast<double>(check.balls);
  if (check.balls >= few_balls && check.missed_share * balls > std::max(most_missed_here * balls, few_missed + 0.5)) {
    mismatches.push_back("the axis misses " + percent(check.missed_share) +
                         " of the medial balls from random points of the solid with angles above " +
                         rounded_text(check.sought_angle) + " degrees, by up to " + rounded_text(check.missed_by) +
                         " at " + place_text(check.missed_at) + " (allowed: " + rounded_text(check.missing_allowance) +
                         ")");
  }
  if (check.bodies_missed > 0) {
    mismatches.push_back("in " + count_text(check.bodies_missed) + " of the bodies the axis misses up to " +
                         percent(check.missed_share_of_body) +
                         " of the medial balls from points near the surface with angles above " +
                         rounded_text(check.sought_angle) + " degrees, by up to " +
                         rounded_text(check.missed_in_body_by) + " at " + place_text(check.missed_in_body_at));
  }
  if (static_cast<double>(check.thin_missed) > few_missed_of_thin) {
    mismatches.push_back("in parts thinner than a voxel, the axis misses " + count_text(check.thin_missed) + " of " +
                         count_text(check.thin_balls) + " medial balls by more than three of their radii, by up to " +
                         rounded_text(check.thin_missed_by) + " at " + place_text(check.thin_missed_at));
  }
}

double share_of(std::size_t some, std::size_t all) {
  return all > 0 ? static_cast<double>(some) / static_cast<double>(all) : 1;
}

void note_share(MedialCheck& check, const Offsets& sheets, const Offsets& curves, double weight_of_sheets) {
  const auto mean = [&](std::size_t of_sheets, std::size_t of_curves) {
    return weight_of_sheets * share_of(of_sheets, sheets.count) +
           (1 - weight_of_sheets) * share_of(of_curves, curves.count);
  };
  check.samples = sheets.count + curves.count;
  check.medial_share = mean(sheets.count - sheets.off, curves.count - curves.off);
  check.near_share = mean(sheets.count - sheets.not_near, curves.count - curves.not_near);
  check.close_share = mean(sheets.close, curves.close);
  const Offsets& worst = curves.furthest > sheets.furthest ? curves : sheets;
  check.off_by = worst.furthest;
  check.off_at = worst.where;
}

void note_missing(MedialCheck& check, const FoundBalls& found, double factor) {
  check.balls = found.all.count;
  if (check.balls > 0) check.missed_share = share_of(found.all.off, check.balls);
  check.missed_by = found.all.furthest / factor;
  check.missed_at = found.all.where / factor;
  check.thin_balls = found.thin.count;
  check.thin_missed = found.thin.off;
  check.thin_missed_by = found.thin.furthest / factor;
  check.thin_missed_at = found.thin.where / factor;
  check.judges_missing = check.balls >= few_balls || check.thin_balls >= few_balls;
  Offsets all;
  for (const Offsets& body : found.bodies) all.add(body);
  const auto misses = [](const Offsets& some, double most) {
    return static_cast<double>(some.off) > std::max(most * static_cast<double>(some.count), few_missed);
  };
  const double most = misses(all, most_missed_of_surface) ? most_missed_of_surface : most_missed_of_body;
  for (const Offsets& body : found.bodies) {
    if (body.count < few_balls) {
      ++check.bodies_unseen;
      continue;
    }
    check.judges_missing = true;
    const double share = share_of(body.off, body.count);
    if (misses(body, most)) ++check.bodies_missed;
    if (!(share > check.missed_share_of_body)) continue;
    check.missed_share_of_body = share;
    check.missed_in_body_by = body.furthest / factor;
    check.missed_in_body_at = body.where / factor;
  }
}

void explain_pairs(const std::vector<PairOfWalls>& pairs, double factor, MedialCheck& check,
                   std::vector<std::string>& mismatches) {
  check.pairs_missed = pairs.size();
  if (pairs.empty()) return;
  const PairOfWalls& first = pairs.front();
  check.pair_missed_at = first.missed.centre / factor;
  mismatches.push_back(
      "the axis misses sheets between " + count_text(pairs.size()) + " pairs of walls, the first one at " +
      place_text(check.pair_missed_at) + ", between the walls at " + place_text(first.missed.first / factor) + " and " +
      place_text(first.missed.second / factor) + ", which " + count_text(first.balls) + " medial balls touch");
}

}  // namespace

MedialCheck check_medial(const MedialView& axis, const KnownSolid& solid, const std::vector<std::uint32_t>& body_of,
                         const CertificateOptions& options, double factor, std::vector<std::string>& mismatches,
                         const Context& context) {
  const Allowances allowed = allowances(solid, options, factor);
  // Steps between voxels have separation angles of up to this everywhere. So cells that only a smaller theta keeps are
  // not checked.
  const double least = allowed.of_voxels ? 2 * allowed.noise : 0;
  const Claimed claimed(axis, options.angles ? std::max(options.theta.value_or(0), least) : HUGE_VAL, allowed.noise,
                        options.footprints);
  const Middle middle(solid, allowed);
  const std::size_t before = mismatches.size();
  MedialCheck check;
  check.homotopy_share = claimed.rest_of_area();
  const auto at = [](std::size_t k, std::size_t count, Random& random) {
    return (static_cast<double>(k) + random.uniform()) / static_cast<double>(count);
  };
  const std::size_t on_sheets =
      sample_count(claimed.sheets().total() / (allowed.voxel * allowed.voxel), most_samples_of_sheets);
  const SheetPoints points(axis, claimed.sheets(), body_of, on_sheets);
  std::vector<std::uint8_t> is_off(on_sheets);
  const Offsets sheets = offsets_of(
      on_sheets, middle, allowed, [&](std::size_t k) { return points.at(k); },
      [&](std::size_t k, bool off) { is_off[k] = off ? 1 : 0; }, context);
  // In noisy images, most points of a small sheet lie between steps of voxels.
  if (!allowed.of_voxels) {
    SheetJudge judge;
    for (std::size_t k = 0; k < on_sheets; ++k) judge.add(points.sheet(k), is_off[k] != 0, points.at(k).at);
    look_at_small_sheets(axis, claimed, middle, allowed, body_of, judge, context);
    judge.note(check);
  }
  const std::size_t on_curves = sample_count(claimed.curves().total() / allowed.voxel, most_samples_of_curves);
  const Offsets curves = offsets_of(
      on_curves, middle, allowed,
      [&](std::size_t k) {
        Random random(0xc0deULL + k);
        const std::uint32_t e = claimed.curves().at(at(k, on_curves, random));
        const auto& [a, b] = axis.edges[e];
        const Vec3d along = axis.positions[b] - axis.positions[a];
        return AxisPoint{axis.positions[a] + along * random.uniform(), body_of[a], axis.edge_angle[e], length(along),
                         std::max(axis.radius[a], axis.radius[b])};
      },
      [](std::size_t, bool) {}, context);
  // A curve is weighted as a strip of sheet one voxel wide.
  const double size_of_curves = claimed.curves().total() * allowed.voxel;
  const double size = claimed.sheets().total() + size_of_curves;
  note_share(check, sheets, curves, size > 0 ? claimed.sheets().total() / size : 1);
  for (std::size_t v = 0; v < axis.positions.size(); ++v) check.claimed_vertices += claimed.contains(v) ? 1 : 0;
  if (options.footprints) {
    look_at_vertices(axis, claimed, middle, allowed, body_of, check, context);
    const double one_wall = static_cast<double>(check.deep_one_wall);
    if (one_wall > most_deep_of_one_wall * static_cast<double>(check.deep_vertices) &&
        claimed.sheets().total() > enough_sheet * allowed.voxel * allowed.voxel) {
      mismatches.push_back("of the " + count_text(check.deep_vertices) +
                           " vertices deep inside that should lie between two walls, " +
                           count_text(check.deep_one_wall) + " have the same footprint twice");
    }
  }
  if (options.theta) {
    const double theta = std::max(*options.theta, allowed.noise);
    check.sought_angle = std::min(theta + well_above, 0.5 * (theta + 180));
    const FoundBalls found = find_balls(axis, solid, allowed, theta, check.sought_angle, options.fitted, context);
    note_missing(check, found, factor);
    explain_pairs(found.pairs, factor, check, mismatches);
  }
  check.allowance = allowed.middle / factor;
  check.missing_allowance = allowed.missing / factor;
  check.close_allowance = allowed.close / factor;
  check.off_by /= factor;
  check.off_at = check.off_at / factor;
  check.far_at = check.far_at / factor;
  check.sheet_off_at = check.sheet_off_at / factor;
  explain(check, solid.solid->slack() > 0, mismatches);
  check.holds = mismatches.size() == before;
  return check;
}

}  // namespace blum::verifier
