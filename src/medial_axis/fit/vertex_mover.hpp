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

/// Point in the middle of a nearby round tube, or in the middle of a ball.
struct RoundCentre {
  Vec3d position;
  std::vector<Footprint> feet;  ///< points of the surface on all sides, about equally far from `position`
};

/// Limits of round_centre().
struct RoundLimits {
  double voxel = 0;  ///< mesh units; distances of footprints count as equal to within 0.02 voxels
  double reach = 0;  ///< mesh units: greatest distance of the middle from the start
  double theta = 0;  ///< degrees: least separation angle at the middle
};

/// Returns the middle of a round part: the point that is, by least squares, equally far from the surface on all sides.
/// The squares are summed over the closest points of the surface for 14 queries around the point. Three facets of a
/// round part are hardly ever equally far from a point, so balance() is not used.
/// @param start  a point at most `limits.reach` away from the middle.
/// @return       nullopt if the surface is not on all sides, for example next to a sheet.
/// Cost: about 80 queries of closest points; mostly 2 or 8 if the part is not round.
[[nodiscard]] std::optional<RoundCentre> round_centre(const Surface& surface, const Vec3d& start,
                                                      const RoundLimits& limits);

/// A vertex and its new data. While VertexMover::make() runs, `other` contains the old data.
struct VertexMove {
  std::uint32_t vertex = 0;
  AxisVertex other;
};

/// Moves vertices of lists, unless edges would leave the solid. The cells of the lists do not change.
class VertexMover {
 public:
  /// @param incidence  the incidence of the lists. All arguments must outlive this object.
  VertexMover(AxisLists& lists, const Incidence& incidence, const Surface& surface, const Context& context)
      : lists_(lists),
        incidence_(incidence),
        surface_(surface),
        paths_(surface),
        context_(context),
        move_of_(lists.vertices.size(), 0) {}

  /// Returns the moves of all vertices for which `where` returns a vertex, in the order of vertices.
  /// @param where  callable: (vertex) -> std::optional<AxisVertex>, called from many threads.
  template <class Where>
  [[nodiscard]] std::vector<VertexMove> moves_to(const Where& where) const {
    constexpr std::size_t grain = 64;
    return detail::gather<VertexMove>(context_, lists_.vertices.size(), grain, "borders",
                                      [&](std::size_t v, std::vector<VertexMove>& found) {
                                        const std::optional<AxisVertex> place = where(static_cast<std::uint32_t>(v));
                                        if (place) found.push_back({static_cast<std::uint32_t>(v), *place});
                                      });
  }

  /// Makes the moves. A move is left out if an edge of the vertex would leave the solid or sweep over a part of the
  /// surface.
  /// @return  largest move of a vertex, mesh units.  @throws Cancelled. Cost: linear in the number of edges of moved
  /// vertices.
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
  /// For each vertex, while make() runs: index of its move plus 1; 0 if it does not move.
  std::vector<std::uint32_t> move_of_;
};

}  // namespace blum::detail
