// Blum: vertices of an axis that move, and what may not. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/core/gather.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/solid_paths.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// A point in the middle of a round tube near by; of a ball, if it is next to its middle.
struct RoundCentre {
  Vec3d position;
  std::vector<Footprint> feet;  ///< on the surface all around, about as far from it
};

/// What round_centre() looks for.
struct RoundLimits {
  double voxel = 0;  ///< mesh units: feet count as equally far within 0.02 of it
  double reach = 0;  ///< mesh units, from the start
  double theta = 0;  ///< degrees: the middle sees this, or more
};

/// The point that the surface all around is equally far from, by least squares over the closest points of places beside
/// it. Facets of round things meet in no one point, but for next to nothing of them, so walls are not told apart.
/// @param start  within the reach.
/// @return       nullopt where the surface is not all around, as beside a sheet.
/// Cost: some 80 closest points, 2 or 8 where nothing is round for the most part.
[[nodiscard]] std::optional<RoundCentre> round_centre(const Surface& surface, const Vec3d& start,
                                                      const RoundLimits& limits);

/// A vertex and what it is to be; while vertices move, what it was before.
struct VertexMove {
  std::uint32_t vertex = 0;
  AxisVertex other;
};

/// Moves vertices of lists whose cells stay, as long as edges stay in the solid.
class VertexMover {
 public:
  /// @param incidence  of the lists. All must stay.
  VertexMover(AxisLists& lists, const Incidence& incidence, const Surface& surface, const Context& context)
      : lists_(lists),
        incidence_(incidence),
        surface_(surface),
        paths_(surface),
        context_(context),
        move_of_(lists.vertices.size(), 0) {}

  /// What is to move, in the order of vertices.
  /// @param where  std::optional<AxisVertex>(vertex), called from many threads.
  template <class Where>
  [[nodiscard]] std::vector<VertexMove> moves_to(const Where& where) const {
    constexpr std::size_t grain = 64;
    return detail::gather<VertexMove>(context_, lists_.vertices.size(), grain, "borders",
                                      [&](std::size_t v, std::vector<VertexMove>& found) {
                                        const std::optional<AxisVertex> place = where(static_cast<std::uint32_t>(v));
                                        if (place) found.push_back({static_cast<std::uint32_t>(v), *place});
                                      });
  }

  /// Makes all moves but those whose edges would leave the solid, or sweep over a part of the surface.
  /// @return  how far the furthest vertex went, mesh units.  @throws Cancelled. Cost: linear in the edges of what
  /// moves.
  double make(std::vector<VertexMove> moves);

 private:
  [[nodiscard]] std::vector<std::uint32_t> edges_of(const std::vector<std::uint32_t>& vertices) const;
  [[nodiscard]] const AxisVertex& before(std::uint32_t v, const std::vector<VertexMove>& moves) const;
  [[nodiscard]] std::vector<std::uint8_t> which_leave(const std::vector<std::uint32_t>& edges,
                                                      const std::vector<VertexMove>& moves) const;
  [[nodiscard]] bool moves_over_void(std::uint32_t e, const std::vector<VertexMove>& moves) const;

  AxisLists& lists_;
  const Incidence& incidence_;
  const Surface& surface_;
  SolidPaths paths_;
  const Context& context_;
  std::vector<std::uint32_t> move_of_;  ///< of each vertex, while they move: which of the moves, and one more; else 0
};

}  // namespace blum::detail
