// Blum: reversal of the parts of a mesh that face into the solid, for signs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::sign {

/// Triangles of a mesh after parts that face into the solid were reversed.
struct FacingRepair {
  std::vector<Triangle> triangles = {};  ///< all triangles; empty if none was reversed
  std::string text = {};                 ///< for example "1 shell was reversed"; empty if none was reversed
  std::vector<Warning> warnings = {};    ///< about parts that face inwards, but were not reversed with certainty
};

/// Finds the parts of a mesh that face into the solid.
///
/// Vertices at the same position count as one vertex. So a soup of triangles without common vertices counts as a
/// surface. If the mesh still has a boundary, positions that differ by rounding to single precision count as the same.
/// Such positions count as the same only if this leaves fewer boundary edges. If the mesh is then closed,
/// repaired_facing() decides. Shells that cross have no depth. If shells cross and a shell has a negative volume, all
/// shells are examined again. If the mesh is not closed, a part consists of triangles connected through edges. First,
/// the triangles of each part get consistent orientations, if that is possible and the part then surrounds a volume. If
/// a part then has a negative volume, all parts are examined. Flat sheets and single triangles are never reversed,
/// since they surround no volume.
///
/// A part is examined by winding numbers of the whole mesh at sample points, which are spread evenly over the part's
/// area. The mean of the numbers on both sides of a sample point is about 1/2 beside a solid and beside its voids. The
/// mean is about -1/2 beside a solid that faces inwards. Parts without consistent orientations are not reversed.
///
/// @param facts    the result of orientation() for the mesh.
/// @param crosses  returns true if triangles of a mesh cross or touch. The function is called at most once.
/// @throws Cancelled. Cost: none for closed meshes that face outwards without voids. Linear time for other meshes. If a
/// part is examined, also the cost of a WindingNumber.
[[nodiscard]] FacingRepair repair_facing(const MeshView& mesh, const SiteTable& sites, const Orientation& facts,
                                         FunctionRef<bool(const MeshView&)> crosses, const Context& context);

}  // namespace blum::sign
