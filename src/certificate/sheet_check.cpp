#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/random.hpp"
#include "blum/core/union_find.hpp"
#include "certificate/allowances.hpp"
#include "certificate/angle.hpp"
#include "certificate/checks.hpp"
#include "certificate/drawn_balls.hpp"
#include "certificate/missed_pairs.hpp"
#include "certificate/sampling.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/stated_sites.hpp"

namespace blum::verifier {
namespace {

// ---- Parts of sheets ----

constexpr double most_bend = 45;          ///< degrees: Blum joins triangles next to seams at bends of up to 37 degrees
constexpr double large_part = 4;          ///< square voxels: parts with less area are not judged
constexpr std::size_t few_triangles = 8;  ///< smaller parts belong to the sheet beside them
constexpr std::size_t samples_of_part = 24;
constexpr double nearly_all = 0.75;  ///< share of the samples of a part that lie between one pair of walls
constexpr double least_turn = 50;    ///< degrees: least angle between parts of different sheets

/// Returns the vector from an edge to the third vertex of a triangle, at a right angle to the edge.
Vec3d leaf(const MedialView& axis, const std::array<std::uint32_t, 2>& edge, std::uint32_t triangle) {
  const auto& v = axis.triangles[triangle];
  const Vec3d& from = axis.positions[edge[0]];
  const Vec3d along = axis.positions[edge[1]] - from;
  const Vec3d out = axis.positions[v[0] ^ v[1] ^ v[2] ^ edge[0] ^ edge[1]] - from;
  const double squared = squared_length(along);
  return squared > 0 ? out - along * (dot(out, along) / squared) : out;
}

/// Returns the bend of an edge of two triangles in degrees; 180 if one of them has no area.
double bend(const MedialView& axis, const std::array<std::uint32_t, 2>& edge, std::span<const std::uint32_t> both) {
  return 180 - degrees_between(leaf(axis, edge, both[0]), leaf(axis, edge, both[1]));
}

/// A part of a sheet. Edges that bend little next to seams, and all other edges inside the sheet, join its triangles.
struct SheetPart {
  std::int32_t sheet = 0;
  Spread triangles;
};

/// Returns the large parts of all sheets that have several large parts, sheet by sheet.
std::vector<SheetPart> large_parts(const MedialView& axis, const Incidence& incidence, double least_area) {
  std::vector<bool> is_on_seam(axis.positions.size(), false);
  for (std::uint32_t e = 0; e < incidence.edges().size(); ++e) {
    if (incidence.triangles_of_edge()[e].size() <= 2) continue;
    for (const std::uint32_t v : incidence.edges()[e]) is_on_seam[v] = true;
  }
  detail::UnionFind joined(axis.triangles.size());
  for (std::uint32_t e = 0; e < incidence.edges().size(); ++e) {
    const std::span<const std::uint32_t> both = incidence.triangles_of_edge()[e];
    if (both.size() != 2 || axis.sheet[both[0]] != axis.sheet[both[1]]) continue;
    const std::array<std::uint32_t, 2>& edge = incidence.edges()[e];
    const bool is_beside_seam = is_on_seam[edge[0]] || is_on_seam[edge[1]];
    if (!is_beside_seam || bend(axis, edge, both) < most_bend) joined.join(both[0], both[1]);
  }
  std::map<std::pair<std::int32_t, std::uint32_t>, SheetPart> parts;
  for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
    SheetPart& part = parts[{axis.sheet[t], joined.find(t)}];
    part.sheet = axis.sheet[t];
    part.triangles.add(triangle_area(axis, t), t);
  }
  std::vector<SheetPart> out;
  for (auto at = parts.begin(); at != parts.end();) {
    const std::size_t before = out.size();
    const std::int32_t sheet = at->second.sheet;
    for (; at != parts.end() && at->second.sheet == sheet; ++at) {
      const Spread& own = at->second.triangles;
      if (own.total() >= least_area && own.cells().size() >= few_triangles) out.push_back(std::move(at->second));
    }
    if (out.size() == before + 1) out.pop_back();
  }
  return out;
}

/// The pair of walls between which a part of a sheet lies.
struct PartBetween {
  bool is_sure = false;
  std::array<std::uint32_t, 2> walls{};
  Vec3d normal;       ///< mean direction from one wall to the other, a unit vector
  TouchingBall ball;  ///< one of its balls
};

/// Finds the walls of a part from the balls at random points.
PartBetween walls_of(const MedialView& axis, const SheetPart& part, const SolidOracle& solid, const Allowances& allowed,
                     const std::vector<std::uint32_t>& body_of) {
  struct Votes {
    std::size_t count = 0;
    Vec3d normal;
    TouchingBall ball;
  };
  std::map<std::array<std::uint32_t, 2>, Votes> all;
  for (std::size_t k = 0; k < samples_of_part; ++k) {
    Random random(0x5bee7ULL + k);
    const double share = random.uniform();
    const std::uint32_t t = part.triangles.at(share);
    const auto& [a, b, c] = axis.triangles[t];
    const Vec3d p = random_point({axis.positions[a], axis.positions[b], axis.positions[c]}, random);
    const std::uint32_t body = body_of[a];
    const Vec3d foot = solid.closest_point(p, body);
    const TouchingBall ball = grown_ball_from_near(solid, body, p, foot, allowed.noise, allowed.middle);
    if (!(ball.radius > 0) || distance_to_middle(p, ball) > allowed.middle) continue;
    const auto walls = sure_walls(solid, {ball, body});
    if (!walls) continue;
    Votes& votes = all[*walls];
    ++votes.count;
    votes.ball = ball;
    const Vec3d across = (ball.first - ball.second) / length(ball.first - ball.second);
    votes.normal += dot(votes.normal, across) < 0 ? -1.0 * across : across;
  }
  PartBetween best;
  for (const auto& [walls, votes] : all) {
    if (static_cast<double>(votes.count) < nearly_all * samples_of_part) continue;
    best = {length(votes.normal) > 0, walls, votes.normal / length(votes.normal), votes.ball};
  }
  return best;
}

/// Returns the angle between two planes with these normals in degrees, 0 to 90.
double turn(const Vec3d& a, const Vec3d& b) {
  const double angle = degrees_between(a, b);
  return std::min(angle, 180 - angle);
}

std::string pair_text(const TouchingBall& ball, double factor) {
  return "between the walls at " + place_text(ball.first / factor) + " and " + place_text(ball.second / factor);
}

/// Checks that no sheet joins large parts between different walls.
void check_parts(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid, const Allowances& allowed,
                 const std::vector<std::uint32_t>& body_of, double factor, SheetCheck& check,
                 std::vector<std::string>& mismatches) {
  const std::vector<SheetPart> parts = large_parts(axis, incidence, large_part * allowed.voxel * allowed.voxel);
  std::vector<PartBetween> between;
  between.reserve(parts.size());
  for (const SheetPart& part : parts) between.push_back(walls_of(axis, part, *solid.solid, allowed, body_of));
  std::string first;
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    while (end < parts.size() && parts[end].sheet == parts[begin].sheet) ++end;
    ++check.sheets;
    std::optional<std::array<std::size_t, 2>> two;
    for (std::size_t k = begin; k < end && !two; ++k) {
      for (std::size_t n = begin; n < k && !two; ++n) {
        const bool is_sure = between[n].is_sure && between[k].is_sure && between[n].walls != between[k].walls;
        if (is_sure && turn(between[n].normal, between[k].normal) >= least_turn) two = {n, k};
      }
    }
    if (!two || check.two_pairs++ > 0) continue;
    const TouchingBall& one = between[(*two)[0]].ball;
    const TouchingBall& other = between[(*two)[1]].ball;
    check.two_pairs_at = one.centre / factor;
    first = "sheet " + std::to_string(parts[begin].sheet) + " at " + place_text(one.centre / factor) + " lies " +
            pair_text(one, factor) + ", and at " + place_text(other.centre / factor) + " " + pair_text(other, factor);
  }
  if (check.two_pairs == 0) return;
  mismatches.push_back(count_text(check.two_pairs) +
                       " sheets lie between two pairs of walls, with a seam between them: " + first);
}

// ---- Stated sites and patches ----

constexpr double few_degrees = 1;    ///< vertices with a smaller separation angle have one footprint
constexpr double most_wrong = 0.05;  ///< largest share of vertices off their stated sites
constexpr double few_wrong = 3;      ///< number of such vertices that is accepted in any case

using Numbers = std::vector<std::int64_t>;

std::optional<Numbers> integers(const Columns& columns, std::string_view name) {
  const Column* const column = columns.find(name);
  if (column == nullptr || column->components != 1) return std::nullopt;
  return std::visit(
      []<class T>(const std::vector<T>& values) -> std::optional<Numbers> {
        if constexpr (std::is_floating_point_v<T>) {
          return std::nullopt;
        } else {
          return Numbers(values.begin(), values.end());
        }
      },
      column->values);
}

/// The two columns of numbers on the sides of triangles.
struct Sides {
  std::optional<Numbers> first, second;

  Sides(const Complex& complex, std::string_view a, std::string_view b)
      : first(integers(complex.triangle_columns, a)), second(integers(complex.triangle_columns, b)) {}

  [[nodiscard]] bool exist() const { return first && second; }
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> of(std::uint32_t triangle) const {
    return {(*first)[triangle], (*second)[triangle]};
  }
};

/// Returns true if all triangles at a vertex have the same sides, and no edge at it has more or fewer than two.
bool is_inside(const Incidence& incidence, std::uint32_t v, const Sides& sides) {
  constexpr std::size_t least_triangles = 3;
  const std::span<const std::uint32_t> at = incidence.triangles_of_vertex()[v];
  if (at.size() < least_triangles) return false;
  const auto same = [&](std::uint32_t t) { return sides.of(t) == sides.of(at[0]); };
  const auto is_inner = [&](std::uint32_t e) { return incidence.triangles_of_edge()[e].size() == 2; };
  const std::span<const std::uint32_t> edges = incidence.edges_of_vertex()[v];
  return std::all_of(at.begin(), at.end(), same) && std::all_of(edges.begin(), edges.end(), is_inner);
}

/// Checks that footprints of vertices inside sheets lie on the sites that the file states for the triangles.
void check_sites(const Complex& complex, const MedialView& axis, const Incidence& incidence, const StatedSites& stated,
                 double factor, SheetCheck& check, std::vector<std::string>& mismatches) {
  const Sides sides(complex, "site_a", "site_b");
  if (!sides.exist()) return;
  std::string first;
  for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
    const SiteId p = axis.site(v, 0);
    const SiteId q = axis.site(v, 1);
    const bool has_two = p.has_value() && q.has_value() && axis.separation_angle[v] >= few_degrees;
    if (!has_two || !is_inside(incidence, v, sides)) continue;
    const auto [a, b] = sides.of(incidence.triangles_of_vertex()[v][0]);
    if (a < 0) continue;  // on the surface
    ++check.vertices;
    const bool fits = (stated.may_contain(a, p) && stated.may_contain(b, q)) ||
                      (stated.may_contain(a, q) && stated.may_contain(b, p));
    if (fits || check.wrong++ > 0) continue;
    check.wrong_at = axis.positions[v] / factor;
    first = "the first one at " + place_text(check.wrong_at) + ": the file states the sites " + std::to_string(a) +
            " and " + std::to_string(b) + " of the diagram, but the footprints lie on the sites " +
            std::to_string(p.value) + " and " + std::to_string(q.value) + " of the mesh";
  }
  const double limit = std::max(few_wrong, most_wrong * static_cast<double>(check.vertices));
  if (static_cast<double>(check.wrong) <= limit) return;
  mismatches.push_back("of the " + count_text(check.vertices) + " vertices inside sheets of one pair of sites, " +
                       count_text(check.wrong) + " have a footprint on another site, " + first);
}

/// Checks that each site belongs to one patch, and that each sheet of patches has one pair of patches.
void check_patches(const Complex& complex, const MedialView& axis, double factor,
                   std::vector<std::string>& mismatches) {
  const Sides patches(complex, medial_columns::patches[0], medial_columns::patches[1]);
  if (!patches.exist()) return;
  const Sides sites(complex, "site_a", "site_b");
  const std::optional<Numbers> sheet = integers(complex.triangle_columns, medial_columns::patch_sheet);
  using Pair = std::pair<std::int64_t, std::int64_t>;
  std::map<std::int64_t, Pair> pair_of_sheet;
  std::map<Pair, Pair> pair_of_sites;
  const auto text = [](const Pair& pair) { return std::to_string(pair.first) + " and " + std::to_string(pair.second); };
  const auto place = [&](std::uint32_t t) {
    const auto& [a, b, c] = axis.triangles[t];
    return place_text((axis.positions[a] + axis.positions[b] + axis.positions[c]) / (3 * factor));
  };
  bool has_sheet = false;
  bool has_sites = false;
  for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
    const Pair own = patches.of(t);
    if (sites.exist() && !has_sites) {
      const Pair& known = pair_of_sites.try_emplace(sites.of(t), own).first->second;
      has_sites = known != own;
      if (has_sites) {
        mismatches.push_back("the triangle at " + place(t) + " has the patches " + text(own) +
                             ", but another one between the same sites, " + text(sites.of(t)) + ", has the patches " +
                             text(known));
      }
    }
    if (!sheet || has_sheet) continue;
    const std::int64_t number = (*sheet)[t];
    if ((number < 0) != (own.first == own.second)) {
      has_sheet = true;
      mismatches.push_back("the triangle at " + place(t) + " has the patches " + text(own) + " and the sheet " +
                           std::to_string(number) + " of patches; inside one patch, and only there, it must be -1");
    } else if (number >= 0) {
      const Pair& known = pair_of_sheet.try_emplace(number, own).first->second;
      has_sheet = known != own;
      if (has_sheet) {
        mismatches.push_back("sheet " + std::to_string(number) + " of patches lies between two pairs of patches: " +
                             text(known) + ", and at " + place(t) + " " + text(own));
      }
    }
  }
}

}  // namespace

SheetCheck check_sheets(const Complex& complex, const Incidence& incidence, const KnownSolid& solid,
                        const std::vector<std::uint32_t>& body_of, const CertificateOptions& options, double factor,
                        std::vector<std::string>& mismatches, const Context& context) {
  SheetCheck check;
  const MedialView axis(complex);
  const std::size_t before = mismatches.size();
  check_patches(complex, axis, factor, mismatches);
  throw_if_cancelled(context);
  const StatedSites* const stated = options.sites ? solid.solid->stated_sites() : nullptr;
  if (stated != nullptr) check_sites(complex, axis, incidence, *stated, factor, check, mismatches);
  const bool is_mesh = solid.solid->has_triangles();
  if (options.labels && is_mesh) {
    check_parts(axis, incidence, solid, allowances(solid, options, factor), body_of, factor, check, mismatches);
  }
  check.holds = mismatches.size() == before;
  return check;
}

}  // namespace blum::verifier
