// Blum: pairs of walls between which an axis has no sheet, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/allowances.hpp"
#include "certificate/drawn_balls.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {

/// A ball between two walls, and the body in which it lies.
struct SeenBall {
  TouchingBall ball;  ///< its radius is 0 if the ball does not count
  std::uint32_t body = 0;
};

/// Returns the pair of walls that a ball touches, the smaller number first; nullopt if it touches an edge between
/// walls.
[[nodiscard]] std::optional<std::array<std::uint32_t, 2>> sure_walls(const SolidOracle& solid, const SeenBall& seen);

/// Two walls, and the balls between them.
struct PairOfWalls {
  std::array<std::uint32_t, 2> walls{};  ///< the smaller number first
  std::size_t balls = 0;
  std::size_t apart = 0;     ///< number of balls whose centres are pairwise more than a given distance apart
  std::size_t examined = 0;  ///< balls for which cells of the axis were sought
  std::size_t held = 0;      ///< balls among `examined` that are next to a cell between the same walls
  TouchingBall missed;       ///< the largest of these balls that is not next to such a cell
};

/// Finds the pairs of walls with many balls, and examines whether the axis has cells between them. Only balls with
/// radii above Allowances::missing count: on a coarse grid, thin parts may lack single sheets.
/// @param cells    cells of the axis, and a search tree over them.
/// @param few      pairs with at most this number of balls are left out.
/// @param spacing  balls with closer centres are counted as one in PairOfWalls::apart.
/// @throws Cancelled.
[[nodiscard]] std::vector<PairOfWalls> pairs_of_walls(const KnownSolid& solid, const std::vector<SeenBall>& seen,
                                                      const TriangleMesh& cells, const TriangleSearch& search,
                                                      const Allowances& allowed, std::size_t few, double spacing,
                                                      const Context& context);

}  // namespace blum::verifier
