#include "certificate/homology/axis_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/homology/edge_labels.hpp"
#include "certificate/segments.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

constexpr int most_moves = 32;

/// Returns the deepest point that `prefers` accepts, among some directions, at the shortest step with a deep enough
/// point. If no step has one, it returns the deepest point tried; nullopt if no point is inside.
/// @param prefers  returns true if a point is acceptable.
template <class Prefers>
std::optional<Vec3d> best_step(const SolidOracle& solid, std::uint32_t body, const Vec3d& point, double step,
                               std::span<const Vec3d> directions, const Prefers& prefers) {
  constexpr double deep_enough = 1.0 / 8;
  std::optional<Vec3d> deepest;
  double depth_of_deepest = 0;
  for (const double longer : {1.0, 4.0, 16.0}) {
    std::optional<Vec3d> best;
    double depth_of_best = deep_enough * longer * step;
    for (const Vec3d& direction : directions) {
      const Vec3d moved = point + direction * (longer * step);
      const double depth = solid.depth(moved, body);
      if (depth > depth_of_deepest) std::tie(deepest, depth_of_deepest) = std::pair(moved, depth);
      if (depth > depth_of_best && prefers(moved)) std::tie(best, depth_of_best) = std::pair(moved, depth);
    }
    if (best) return best;
  }
  return deepest;
}

/// Returns a point inside, beside the point at parameter `along` of the segment from a to b.
std::optional<Vec3d> moved_aside(const SolidOracle& solid, std::uint32_t body, const Vec3d& a, const Vec3d& b,
                                 double along, double step) {
  constexpr std::size_t count = 12;
  constexpr double turn = 0.1;  // radians; avoids directions along axes
  const ProbeLine line = line_between(a, b);
  std::array<Vec3d, count> directions;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = turn + 2 * std::numbers::pi * static_cast<double>(k) / count;
    directions[k] = line.across * std::cos(angle) + line.up * std::sin(angle);
  }
  // A point beyond a narrow gap would be inside, too. So the segments to both ends must not meet the boundary.
  const auto is_beside = [&](const Vec3d& p) { return solid.is_clear(a, p, body) && solid.is_clear(p, b, body); };
  return best_step(solid, body, a + (b - a) * along, step, directions, is_beside);
}

/// Adds points between a and b, so that the way passes all touched segments, and then b. Returns false if that fails.
bool lead_between(const SolidOracle& solid, std::uint32_t body, const Curtains& curtains, double step, const Vec3d& a,
                  const Vec3d& b, int& moves_left, Way& way) {
  const auto touched = curtains.first_touched(a, b, body);
  if (!touched) {
    way.push_back(b);
    return true;
  }
  if (moves_left-- <= 0) return false;
  const auto middle = moved_aside(solid, body, a, b, closest_along({a, b}, *touched), step);
  return middle && lead_between(solid, body, curtains, step, a, *middle, moves_left, way) &&
         lead_between(solid, body, curtains, step, *middle, b, moves_left, way);
}

/// Returns 30 unit vectors in directions of all kinds, the same list in each call.
const std::vector<Vec3d>& all_directions() {
  static const std::vector<Vec3d> directions = [] {
    std::vector<Vec3d> out;
    for (std::uint32_t k = 0; k < 12; ++k) {
      const ProbeLine line = line_through({}, k);
      out.insert(out.end(), {line.along, -line.along});
    }
    for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) out.insert(out.end(), {axis, -axis});
    return out;
  }();
  return directions;
}

/// Adds a point to a way that ends close to a point of the surface. From there, the way leads to `to` inside the body,
/// around an edge or corner. Adds nothing if no point is needed or found.
void lead_around(const SolidOracle& solid, std::uint32_t body, const Vec3d& surface, const Vec3d& to, Way& way) {
  const Vec3d from = way.back();
  if (solid.is_clear(from, to, body)) return;
  if (!(solid.depth(from, body) > 0)) return;
  const double size = std::max(length(from - surface), length(to - surface));
  // The way must not pass a hole on the other side than the edge. So it forms triangles with the surface point that
  // lie in the body, except for a tip at that point.
  constexpr double tip = 1e-3;
  const auto is_filled = [&](const Vec3d& p, const Vec3d& q) {
    const Vec3d near_p = surface + (p - surface) * tip;
    const Vec3d near_q = surface + (q - surface) * tip;
    return solid.is_clear({p, q, near_p}, body) && solid.is_clear({q, near_q, near_p}, body);
  };
  for (const double scale : {1.0, 0.25, 4.0}) {
    for (const Vec3d& direction : all_directions()) {
      const Vec3d at = surface + direction * (scale * size);
      if (!is_filled(from, at) || !is_filled(at, to)) continue;
      way.push_back(at);
      return;
    }
  }
}

/// Returns a point in a body, close to the given surface point. It is the first point tried that is deep enough for its
/// step. If there is none, it is the deepest point tried; nullopt if no point is inside.
/// @param step  the shortest step to try; the longest is 16 times as long.
std::optional<Vec3d> moved_inside(const SolidOracle& solid, std::uint32_t body, const Vec3d& point, double step) {
  return best_step(solid, body, point, step, all_directions(), [](const Vec3d&) { return true; });
}

/// Adds points to a way that touches segments of paths, so that it passes them inside the body. Points of the way that
/// are less deep than `step` are moved inside, except for its two ends.
/// @param step  the shortest step to try, as for moved_inside().
/// @return      true if the way no longer touches any segment.
bool lead_inside(const SolidOracle& solid, std::uint32_t body, const Curtains& curtains, double step, Way& way) {
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    if (solid.depth(way[k], body) >= step) continue;
    way[k] = moved_inside(solid, body, way[k], step).value_or(way[k]);
  }
  int moves_left = most_moves;
  Way led{way.front()};
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    if (!lead_between(solid, body, curtains, step, way[k], way[k + 1], moves_left, led)) return false;
  }
  way = std::move(led);
  return true;
}

/// Fraction of the tolerance of positions. It is far below the tolerance of edges, and far above rounding.
constexpr double of_tolerance = 1.0 / 16;

}  // namespace

AxisLabels::AxisLabels(const AxisInSolid& given, const Complement& complement, const std::vector<bool>& is_wanted,
                       const Context& context)
    : given_(given),
      complement_(complement),
      is_wanted_(is_wanted),
      allowed_(tolerances(given.solid)),
      positions_(given.axis.positions.begin(), given.axis.positions.end()) {
  constexpr std::uint32_t most_attempts = 4;
  slide_from_surface();
  for (std::uint32_t body = 0; body < allowed_.size(); ++body) box_.extend(given.solid.solid->box(body));
  for (const Vec3d& p : positions_) {
    if (is_finite(p)) box_.extend(p);
  }
  for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
    apex_ = std::make_unique<Apex>(box_, attempt);
    curtains_ = std::make_unique<Curtains>(complement, *apex_, context);
    edges_ =
        std::make_unique<EdgeLabels>(*curtains_, given.incidence.edges(), positions_, given.parts.body_of, context);
    take_pushed();
    lead_past_surface();
    if (doubtful_.empty()) return;
  }
}

void AxisLabels::slide_from_surface() {
  constexpr double steepest = 32;
  const auto& edges = given_.incidence.edges();
  const auto& locations = given_.locations;
  for (std::uint32_t v = 0; v < positions_.size(); ++v) {
    const std::uint32_t body = given_.parts.body_of[v];
    const double near = allowed_[body] * of_tolerance;
    if (!is_wanted_[body] || locations[v].depth >= near) continue;
    std::uint32_t deepest = v;
    for (const std::uint32_t e : given_.incidence.edges_of_vertex()[v]) {
      const std::uint32_t other = edges[e][0] == v ? edges[e][1] : edges[e][0];
      if (locations[other].body == body && locations[other].depth > locations[deepest].depth) deepest = other;
    }
    const Vec3d along = given_.axis.positions[deepest] - given_.axis.positions[v];
    const double far = length(along);
    if (!(far > 0) || !(locations[deepest].depth > 2 * near)) {
      const auto inside = moved_inside(*given_.solid.solid, body, positions_[v], 2 * near);
      if (inside && given_.solid.solid->depth(*inside, body) > locations[v].depth) positions_[v] = *inside;
      continue;
    }
    for (double step = 2; step <= steepest; step *= 2) {
      positions_[v] = given_.axis.positions[v] + along * std::min(0.5, step * near / far);
      if (given_.solid.solid->depth(positions_[v], body) >= near) break;
    }
  }
}

void AxisLabels::take_pushed() {
  replaced_.clear();
  doubtful_ = {edges_->doubtful().begin(), edges_->doubtful().end()};
  for (const PushedEdge& pushed : given_.ways.pushed) {
    const std::uint32_t body = given_.parts.body_of[given_.incidence.edges()[pushed.edge][0]];
    if (!is_wanted_[body]) continue;
    doubtful_.erase(pushed.edge);
    if (!curtains_->add(way_of(pushed.edge), body, replaced_[pushed.edge])) doubtful_.insert(pushed.edge);
  }
}

Way AxisLabels::way_of(std::uint32_t edge) const {
  const auto [a, b] = given_.incidence.edges()[edge];
  Way way{positions_[a]};
  const auto pushed = std::lower_bound(given_.ways.pushed.begin(), given_.ways.pushed.end(), edge,
                                       [](const PushedEdge& one, std::uint32_t other) { return one.edge < other; });
  if (pushed != given_.ways.pushed.end() && pushed->edge == edge) {
    way.insert(way.end(), pushed->way.begin(), pushed->way.end());
  }
  way.push_back(positions_[b]);
  return way;
}

void AxisLabels::lead_past_surface() {
  std::erase_if(doubtful_, [&](std::uint32_t edge) {
    const std::uint32_t body = given_.parts.body_of[given_.incidence.edges()[edge][0]];
    Way way = way_of(edge);
    std::vector<Label> labels;
    if (!lead_inside(*given_.solid.solid, body, *curtains_, of_tolerance * allowed_[body], way)) return false;
    if (!curtains_->add(way, body, labels)) return false;
    replaced_[edge] = std::move(labels);
    return true;
  });
}

bool AxisLabels::is_across(std::size_t triangle, SparseRow& row) const {
  row.clear();
  const auto& corners = given_.axis.triangles[triangle];
  const auto& sides = given_.incidence.sides()[triangle];
  if (std::any_of(sides.begin(), sides.end(), [&](std::uint32_t e) { return is_doubtful(e); })) return false;
  for (std::size_t k = 0; k < 3; ++k) add(sides[k], corners[k] < corners[(k + 1) % 3] ? 1 : -1, row);
  if (row.empty()) return false;
  tidy(row);
  return !row.empty();
}

std::vector<std::uint32_t> AxisLabels::triangles_across(const Context& context) {
  constexpr std::size_t grain = 4096;
  const std::size_t count = given_.axis.triangles.size();
  std::vector<std::vector<std::uint32_t>> parts(count / grain + 1);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    SparseRow row;
    for (std::size_t t = range.begin; t < range.end; ++t) {
      if (is_across(t, row)) parts[range.begin / grain].push_back(static_cast<std::uint32_t>(t));
    }
  });
  std::vector<std::uint32_t> across;
  for (const auto& part : parts) across.insert(across.end(), part.begin(), part.end());
  constexpr std::size_t most_looked_at = 20000;
  std::unordered_set<std::uint32_t> looked_at;
  std::unordered_set<std::uint32_t> found(across.begin(), across.end());
  SparseRow row;
  for (std::size_t k = 0; k < across.size(); ++k) {  // `across` grows
    throw_if_cancelled(context);
    for (const std::uint32_t e : given_.incidence.sides()[across[k]]) {
      if (looked_at.size() >= most_looked_at || !looked_at.insert(e).second || !take(e, closer_look(e))) continue;
      for (const std::uint32_t t : given_.incidence.triangles_of_edge()[e]) {
        if (is_across(t, row) && found.insert(t).second) across.push_back(t);
      }
    }
  }
  lead_over_triangles(across, context);
  std::sort(across.begin(), across.end());
  return across;
}

void AxisLabels::lead_over_triangles(std::vector<std::uint32_t>& across, const Context& context) {
  SparseRow row;
  const auto count_at = [&](std::uint32_t e) {
    const auto around = given_.incidence.triangles_of_edge()[e];
    return std::count_if(around.begin(), around.end(), [&](std::uint32_t t) { return is_across(t, row); });
  };
  for (bool is_better = true; is_better;) {
    throw_if_cancelled(context);
    is_better = false;
    std::erase_if(across, [&](std::uint32_t t) { return !is_across(t, row); });
    for (const std::uint32_t t : across) {
      for (std::size_t k = 0; k < 3 && is_across(t, row); ++k) {
        const std::uint32_t e = given_.incidence.sides()[t][k];
        const auto pushed = replaced_.find(e);
        if (pushed == replaced_.end()) continue;  // sides of these triangles are not doubtful
        const auto before = count_at(e);
        std::vector<Label> other = over_other_sides(t, k);
        other.swap(pushed->second);
        if (count_at(e) < before) {
          is_better = true;
        } else {
          other.swap(pushed->second);
        }
      }
    }
  }
}

std::vector<Label> AxisLabels::over_other_sides(std::uint32_t triangle, std::size_t side) const {
  const auto& corners = given_.axis.triangles[triangle];
  const auto sign = [&](std::size_t k) { return corners[k] < corners[(k + 1) % 3] ? 1 : -1; };
  std::vector<Label> labels;
  for (const std::size_t k : {(side + 1) % 3, (side + 2) % 3}) {
    for (const Label& label : of(given_.incidence.sides()[triangle][k])) {
      labels.push_back({label.segment, -sign(side) * sign(k) * label.times});
    }
  }
  return labels;
}

void AxisLabels::look_at_grazing(const Context& context) {
  std::vector<std::uint32_t> wanted;
  for (const std::uint32_t e : given_.ways.grazing) {
    if (is_wanted_[given_.parts.body_of[given_.incidence.edges()[e][0]]]) wanted.push_back(e);
  }
  look_closely(wanted, context);
}

bool AxisLabels::look_at_thin_parts(const Context& context) {
  constexpr std::size_t most_looked_at = 50000;
  const auto& edges = given_.incidence.edges();
  std::vector<std::uint32_t> thin;
  for (const bool of_curves : {true, false}) {
    for (std::uint32_t e = 0; e < edges.size() && thin.size() < most_looked_at; ++e) {
      const std::uint32_t body = given_.parts.body_of[edges[e][0]];
      if (!is_wanted_[body] || given_.incidence.triangles_of_edge()[e].empty() != of_curves) continue;
      const double depth = std::min(given_.locations[edges[e][0]].depth, given_.locations[edges[e][1]].depth);
      if (depth < more_for_edges * allowed_[body] && !replaced_.contains(e)) thin.push_back(e);
    }
  }
  return look_closely(thin, context);
}

bool AxisLabels::look_closely(std::span<const std::uint32_t> edges, const Context& context) {
  // Only few edges are examined at a time, because together they may use more looks than are left.
  constexpr std::size_t most_at_a_time = 32;
  bool is_changed = false;
  std::vector<CloserLook> found;
  for (std::size_t first = 0; first < edges.size(); first += most_at_a_time) {
    found.assign(std::min(most_at_a_time, edges.size() - first), {});
    parallel_for(context, found.size(), 1, {},
                 [&](const WorkRange& range) { found[range.begin] = closer_look(edges[first + range.begin]); });
    for (std::size_t k = 0; k < found.size(); ++k) is_changed = take(edges[first + k], found[k]) || is_changed;
  }
  return is_changed;
}

AxisLabels::CloserLook AxisLabels::closer_look(std::uint32_t edge) const {
  const auto [a, b] = given_.incidence.edges()[edge];
  const std::uint32_t body = given_.parts.body_of[a];
  Way straight{positions_[a], positions_[b]};
  if (given_.solid.solid->is_clear(straight[0], straight[1], body)) return {};
  std::size_t looks = 0;
  for (const Way& way : ways_beside(edge)) {
    CloserLook look = closer_look(way, body);
    looks += look.looks;
    if (!look.way.empty()) return {std::move(look.way), looks};
  }
  CloserLook look = closer_look(straight, body);
  look.looks += looks;
  if (look.way.size() == 2) look.way.clear();  // the edge is inside
  return look;
}

std::vector<Way> AxisLabels::ways_beside(std::uint32_t edge) const {
  constexpr std::array<double, 2> steps{16, 256};
  const auto [a, b] = given_.incidence.edges()[edge];
  const std::uint32_t body = given_.parts.body_of[a];
  const SolidOracle& solid = *given_.solid.solid;
  const double near = allowed_[body] * of_tolerance;
  const bool has_slid_a = given_.locations[a].depth < near;
  const bool has_slid_b = given_.locations[b].depth < near;
  const auto& at = given_.axis.positions;
  const std::span<const std::uint32_t> triangles = given_.incidence.triangles_of_edge()[edge];
  std::vector<Way> ways;
  if (!(has_slid_a || has_slid_b) || triangles.empty()) return ways;
  const auto& corners = given_.axis.triangles[triangles[0]];
  // An edge along the surface is led over the triangle beside it.
  const Vec3d& third = at[corners[0] ^ corners[1] ^ corners[2] ^ a ^ b];
  const Vec3d aside = has_slid_a && has_slid_b ? third : 0.5 * (at[a] + at[b]);
  const double size = std::min(length(aside - at[a]), length(aside - at[b]));
  for (const double step : steps) {
    const double share = step * near / size;
    if (!(share < 0.25)) continue;
    const Vec3d beside_a = at[a] + (aside - at[a] + at[b] - at[a]) * share;
    const Vec3d beside_b = at[b] + (aside - at[b] + at[a] - at[b]) * share;
    Way way{positions_[a]};
    if (has_slid_a) {
      lead_around(solid, body, at[a], beside_a, way);
      way.push_back(beside_a);
    }
    if (has_slid_b) {
      Way back{positions_[b]};
      lead_around(solid, body, at[b], beside_b, back);
      way.push_back(beside_b);
      way.insert(way.end(), back.rbegin(), back.rend());
    } else {
      way.push_back(positions_[b]);
    }
    ways.push_back(std::move(way));
  }
  return ways;
}

AxisLabels::CloserLook AxisLabels::closer_look(const Way& way, std::uint32_t body) const {
  constexpr double fine = 1e-3;
  constexpr std::size_t most_looks_at_edge = 32'768;
  const SolidOracle& solid = *given_.solid.solid;
  const BodyEdges edges(solid, body, fine * allowed_[body]);
  const auto stop = [&](const Vec3d& p) { return Stop{p, solid.depth(p, body)}; };
  const std::size_t most_looks = std::min(most_looks_at_edge, looks_left_);
  PushBudget budget{.looks = most_looks};
  CloserLook look{.way = {way[0]}};
  bool is_found = true;
  for (std::size_t k = 1; k < way.size() && is_found; ++k) {
    is_found = edges.can_be_pushed_in(stop(way[k - 1]), stop(way[k]), budget, look.way);
    look.way.push_back(way[k]);
  }
  look.looks = most_looks - budget.looks;
  if (!is_found) look.way.clear();
  return look;
}

bool AxisLabels::take(std::uint32_t edge, const CloserLook& look) {
  looks_left_ -= std::min(looks_left_, look.looks);
  if (look.way.empty()) return false;
  std::vector<Label> labels;
  if (!curtains_->add(look.way, given_.parts.body_of[given_.incidence.edges()[edge][0]], labels)) return false;
  replaced_[edge] = std::move(labels);
  doubtful_.erase(edge);
  return true;
}

}  // namespace blum::verifier
