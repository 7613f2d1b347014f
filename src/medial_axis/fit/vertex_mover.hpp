// Blum: moves vertices of an axis within a solid. SPDX-License-Identifier: Apache-2.0
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

/// Point in the middle of a nearby round tube. A ball has one only next to its middle.
struct RoundCentre {
  Vec3d position;
  std::vector<Footprint> feet;  ///< on the surface all around, about equally far from it
};

/// Limits of round_centre().
struct RoundLimits {
  double voxel = 0;  ///< mesh units; feet count as equally far within 0.02 voxels
  double reach = 0;  ///< mesh units, from the start
  double theta = 0;  ///< degrees; the middle sees at least this
};

/// Returns the point from which the surface all around is equally far, by least squares over the closest points of
/// places beside it. Walls are not distinguished, because facets of round parts hardly ever meet in one point.
/// @param start  within the reach.
/// @return       nullopt if the surface is not all around, as beside a sheet.
/// Cost: some 80 closest points; mostly 2 or 8 if nothing is round.
[[nodiscard]] std::optional<RoundCentre> round_centre(const Surface& surface, const Vec3d& start,
                                                      const RoundLimits& limits);

/// Vertex and its new data. While vertices move, it contains the old data.
struct VertexMove {
  std::uint32_t vertex = 0;
  AxisVertex other;
};

/// Moves vertices of lists as long as edges stay in the solid. The cells of the lists stay.
class VertexMover {
 public:
  /// @param incidence  of the lists. All arguments must outlive this object.
  VertexMover(AxisLists& lists, const Incidence& incidence, const Surface& surface, const Context& context)
      : lists_(lists),
        incidence_(incidence),
        surface_(surface),
        paths_(surface),
        context_(context),
        move_of_(lists.vertices.size(), 0) {}

  /// Returns the moves, in the order of vertices.
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

  /// Makes all moves except those whose edges would leave the solid or sweep over a part of the surface.
  /// @return  largest move of a vertex, mesh units.  @throws Cancelled. Cost: linear in the edges of moved vertices.
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
  std::vector<std::uint32_t> move_of_;  ///< of each vertex, while they move: index of its move plus 1; else 0
};

}  // namespace blum::detail
