// Blum: the closed surfaces of an axis and what they enclose, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/homology/complement.hpp"
#include "certificate/homology/elimination.hpp"

namespace blum::verifier {

/// What closed surfaces of an axis wind around.
struct Windings {
  std::vector<std::size_t> rank;  ///< in each body: of the winding numbers modulo 2 around its voids; the least
                                  ///< that any choice of points in them gives
  bool over_integers = false;     ///< whether they span all integer ones, in every body
  /// In each body: a void of which nothing could be told, as triangles go through its points, by one of these.
  std::vector<std::optional<Vec3d>> untold;
};

/// Takes away what has a free edge, over and over; groups what is left into sheets over edges of two triangles; and
/// finds the cycles of sheets by elimination at the seams, and how often each winds around each void by counting what
/// lines from the voids cross. That is done for all points of the voids: a surface that goes through a void instead of
/// around it is around some of them only. Triangles that are named twice count once.
/// @param body_of  of each vertex.  @throws Cancelled. Cost: linear, but for the elimination: sheets are few.
[[nodiscard]] Windings windings(const ComplexView& axis, const Incidence& incidence,
                                const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& body_of,
                                const Complement& complement, std::size_t body_count, const Box3& box,
                                const Context& context);

}  // namespace blum::verifier
