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
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/solid_paths.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum {

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

}  // namespace blum
