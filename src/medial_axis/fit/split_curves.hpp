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

/// Curves that leave a vertex beside each other become one: of two edges on no triangle the longer one is taken to
/// begin where the shorter one ends, again and again. The homotopy type stays, since the triangle between both is in
/// the solid.
/// @param beside  mesh units: how far the end of the shorter edge may be from the longer one.
/// @return  whether any did.  @throws Cancelled. Cost: near-linear in the edges of curves.
bool merge_curves(AxisLists& lists, const Surface& surface, double beside, const Context& context);

/// Puts vertices into edges of curves, those on no triangle, where these cut short what bends, again and again.
/// @param incidence  of the lists.
/// @param middle  the vertex that a curve has near a point; nullopt where there is none. Called from many threads.
/// @return  whether any was split.  @throws Cancelled.
bool split_curves(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                  const std::function<std::optional<AxisVertex>(const Vec3d&)>& middle, const Context& context);

}  // namespace blum::detail
