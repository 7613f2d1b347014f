#include "certificate/missed_pairs.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum::verifier {
namespace {

using Walls = std::array<std::uint32_t, 2>;

/// Returns true if a ball of the axis touches the walls of a ball of the solid, or other walls of the same smooth
/// parts. A round part has many walls, and cells of the axis lie between several of them.
bool touch_same_walls(const SolidOracle& solid, const SeenBall& seen, const TouchingBall& own) {
  const std::array<Walls, 2> walls{solid.walls_at(own.first, seen.body), solid.walls_at(own.second, seen.body)};
  const std::array<std::uint32_t, 2> sought{solid.walls_at(seen.ball.first, seen.body)[0],
                                            solid.walls_at(seen.ball.second, seen.body)[0]};
  const auto same = [&](std::size_t k, std::size_t n) {
    return solid.are_smooth(walls[n][0], sought[k]) || solid.are_smooth(walls[n][1], sought[k]);
  };
  return (same(0, 0) && same(1, 1)) || (same(0, 1) && same(1, 0));
}

/// Returns balls whose centres are pairwise more than `spacing` apart.
std::vector<const SeenBall*> far_apart(const std::vector<const SeenBall*>& balls, double spacing, std::size_t most) {
  std::vector<const SeenBall*> kept;
  for (const SeenBall* seen : balls) {
    const bool is_near = std::any_of(kept.begin(), kept.end(), [&](const SeenBall* other) {
      return squared_length(seen->ball.centre - other->ball.centre) <= spacing * spacing;
    });
    if (!is_near) kept.push_back(seen);
    if (kept.size() == most) break;
  }
  return kept;
}

/// Examines the cells of the axis next to the balls of a pair.
class CellsBetween {
 public:
  CellsBetween(const SolidOracle& solid, const TriangleMesh& cells, const TriangleSearch& search,
               const Allowances& allowed)
      : solid_(solid), cells_(cells), search_(search), allowed_(allowed) {}

  /// Returns true if the axis comes close to the centre of a ball, or if its closest cell lies between the ball's
  /// walls.
  [[nodiscard]] bool holds(const SeenBall& seen) const {
    const TriangleSearch::Nearest nearest = search_.nearest(seen.ball.centre);
    if (nearest.distance <= allowed_.beside_sheet()) return true;
    const auto [a, b, c] = corners_of(MeshView(cells_), nearest.triangle);
    const Vec3d p = (a + b + c) / 3.0;
    const Vec3d foot = solid_.closest_point(p, seen.body);
    const TouchingBall ball = grown_ball_from_near(solid_, seen.body, p, foot, allowed_.noise, allowed_.middle);
    return ball.radius > 0 && touch_same_walls(solid_, seen, ball);
  }

 private:
  const SolidOracle& solid_;
  const TriangleMesh& cells_;
  const TriangleSearch& search_;
  const Allowances& allowed_;
};

}  // namespace

std::optional<std::array<std::uint32_t, 2>> sure_walls(const SolidOracle& solid, const SeenBall& seen) {
  const Walls first = solid.walls_at(seen.ball.first, seen.body);
  const Walls second = solid.walls_at(seen.ball.second, seen.body);
  if (first[0] != first[1] || second[0] != second[1]) return std::nullopt;
  const auto [low, high] = std::minmax(first[0], second[0]);
  return Walls{low, high};
}

std::vector<PairOfWalls> pairs_of_walls(const KnownSolid& solid, const std::vector<SeenBall>& seen,
                                        const TriangleMesh& cells, const TriangleSearch& search,
                                        const Allowances& allowed, std::size_t few, double spacing,
                                        const Context& context) {
  constexpr std::size_t grain = 64;
  constexpr std::size_t most_examined = 32;
  std::vector<std::optional<Walls>> walls(seen.size());
  parallel_for(context, seen.size(), grain, "looking for walls", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (seen[k].ball.radius > allowed.missing) walls[k] = sure_walls(*solid.solid, seen[k]);
    }
  });
  std::map<Walls, std::vector<const SeenBall*>> balls;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (walls[k]) balls[*walls[k]].push_back(&seen[k]);
  }
  std::erase_if(balls, [&](const auto& pair) { return pair.second.size() <= few; });
  std::vector<PairOfWalls> out;
  std::vector<std::vector<const SeenBall*>> examined;
  for (const auto& [pair, list] : balls) {
    examined.push_back(far_apart(list, spacing, most_examined));
    out.push_back({pair, list.size(), examined.back().size(), examined.back().size(), 0, {}});
  }
  const CellsBetween between(*solid.solid, cells, search, allowed);
  parallel_for(context, out.size(), 1, "looking for walls", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      for (const SeenBall* one : examined[k]) {
        const bool holds = between.holds(*one);
        out[k].held += holds ? 1 : 0;
        if (!holds && !(out[k].missed.radius > one->ball.radius)) out[k].missed = one->ball;
      }
    }
  });
  return out;
}

}  // namespace blum::verifier
