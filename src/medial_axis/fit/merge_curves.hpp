// Blum: curves that run beside each other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum {

/// Curves that leave a vertex beside each other become one: of two edges on no triangle the longer one is taken to
/// begin where the shorter one ends, again and again. The homotopy type stays, since the triangle between both is in
/// the solid.
/// @param beside  mesh units: how far the end of the shorter edge may be from the longer one.
/// @return  whether any did.  @throws Cancelled. Cost: near-linear in the edges of curves.
bool merge_curves(AxisLists& lists, const Surface& surface, double beside, const Context& context);

}  // namespace blum
