// Blum: warnings about signed distances of a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Returns a warning if the signs of a mesh's field may be wrong. WarningCode::facing: triangles or shells of the mesh
/// face the wrong way. WarningCode::nothing_inside: no node is inside the mesh. Returns at most one warning, and none
/// for unsigned fields.
///
/// @param mesh   the mesh of which the field was computed.
/// @param facts  the result of orientation() for this mesh.
/// @throws Cancelled.
/// Cost: that of a search for a node inside the mesh. If the mesh is closed and oriented, but does not face outwards,
/// the cost of a search for two triangles that cross is added.
[[nodiscard]] std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh, const Orientation& facts,
                                                  const Context& context = {});
/// Returns the same warnings, and computes the orientation of the mesh itself.
/// @throws InvalidMesh unless the mesh passes validate(mesh).
/// @throws Cancelled.
/// Cost: in addition O(n log n) for n triangles: a few milliseconds for 70,000 triangles. There is no cost for unsigned
/// fields.
[[nodiscard]] std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh,
                                                  const Context& context = {});

/// Returns the warning WarningCode::facing, which needs no grid, for signed distances at any points.
/// @param rule  the result of ClosestPointQuery::sign_rule().
/// @throws InvalidMesh unless the mesh passes validate(mesh).
/// @throws Cancelled.
/// Cost: as field_warnings(), without the search for a node inside.
[[nodiscard]] std::vector<Warning> sign_warnings(const MeshView& mesh, SignRule rule, const Context& context = {});

}  // namespace blum
