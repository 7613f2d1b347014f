// Blum: warnings about signed distances of a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Returns a warning if the field of a mesh has suspicious signs. Either the mesh or a part of it faces the wrong way
/// (WarningCode::facing), or no node is inside (WarningCode::nothing_inside). Returns at most one warning, and none for
/// unsigned fields.
///
/// @param mesh   the whole mesh of the field.
/// @param facts  its orientation().
/// @throws Cancelled.
/// Cost: a search for a node inside. If the mesh is closed and oriented, but does not face outwards, also a search for
/// a pair of triangles that cross.
[[nodiscard]] std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh, const Orientation& facts,
                                                  const Context& context = {});
/// Returns the same warnings, and computes the facts itself.
/// @throws InvalidMesh unless the mesh passes validate(mesh).
/// @throws Cancelled.
/// Cost: in addition O(n log n) for n triangles, some milliseconds for 70,000; nothing for unsigned fields.
[[nodiscard]] std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh,
                                                  const Context& context = {});

/// Returns the warning that needs no grid (WarningCode::facing), for signed distances at any points.
/// @param rule  ClosestPointQuery::sign_rule().
/// @throws InvalidMesh unless the mesh passes validate(mesh).
/// @throws Cancelled.
/// Cost: as field_warnings().
[[nodiscard]] std::vector<Warning> sign_warnings(const MeshView& mesh, SignRule rule, const Context& context = {});

}  // namespace blum
