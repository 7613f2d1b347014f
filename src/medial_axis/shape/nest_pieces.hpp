// Blum: pieces of a medial axis at all angles, as one complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_piece.hpp"

namespace blum {

/// What append_at() and contract_points() make of pieces at the angles from `least_theta` on.
/// @throws Cancelled.
[[nodiscard]] Complex nest_pieces(const std::vector<AxisPiece>& pieces, double least_theta, const Context& context);

}  // namespace blum
