// Blum: ways that touch the surface, led past it, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "blum/core/vec3.hpp"
#include "certificate/homology/edge_labels.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// A point inside of a body, a little way from one on its surface: the first one that is deep enough for the step that
/// led there, else the deepest one tried; nullopt where none is inside.
/// @param step  the shortest tried; the longest is 16 times as long.
[[nodiscard]] std::optional<Vec3d> moved_inside(const SolidOracle& solid, std::uint32_t body, const Vec3d& point,
                                                double step);

/// Adds points to a way that touches segments of paths, so that it passes them inside of the body. Way points that lie
/// on the surface are moved inside, but for both ends.
/// @param step  as above.  @return  whether it touches nothing any more.
[[nodiscard]] bool lead_inside(const SolidOracle& solid, std::uint32_t body, const Curtains& curtains, double step,
                               Way& way);

}  // namespace blum::verifier
