// Blum: more vertices for curves that bend. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Merges curves that leave a vertex side by side. Edges of curves belong to no triangle. The longer edge is changed so
/// that it begins where the shorter edge ends. This step is repeated. The homotopy type stays, because the triangle
/// between both edges lies in the solid.
/// @param beside  mesh units: greatest distance of the end of the shorter edge from the longer one.
/// @return  true if any edge was changed.  @throws Cancelled. Cost: near-linear in the edges of curves.
bool merge_curves(AxisLists& lists, const Surface& surface, double beside, const Context& context);

/// Inserts vertices into edges of curves that cut short a bend. Edges of curves belong to no triangle. The two parts of
/// a split edge may be split again.
/// @param incidence  the incidence of the lists.
/// @param middle  returns the vertex of a curve near a point, or nullopt if there is none. Called from many threads.
/// @return  true if any edge was split.  @throws Cancelled.
bool split_curves(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                  const std::function<std::optional<AxisVertex>(const Vec3d&)>& middle, const Context& context);

}  // namespace blum::detail
