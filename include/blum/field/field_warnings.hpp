// Blum: what deserves a look in signed distances of a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// What deserves a look although the field of a mesh is what was asked for: the mesh, or a part of it, faces the wrong
/// way (WarningCode::facing), or no node is inside (WarningCode::nothing_inside). At most one; none of unsigned fields.
///
/// @param mesh   that the field is of, whole.
/// @param facts  orientation() of it.
/// @throws Cancelled. Cost: where the mesh is closed and oriented, but does not face outwards, that of a search for a
/// pair of triangles that cross; else that of looking for a node inside.
[[nodiscard]] std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh, const Orientation& facts,
                                                  const Context& context = {});
/// The same, with the facts found here. @throws InvalidMesh unless it passes validate(mesh); Cancelled. Cost: O(n log
/// n) for n triangles more, some milliseconds for 70,000; nothing for unsigned fields.
[[nodiscard]] std::vector<Warning> field_warnings(const Field& field, const MeshView& mesh,
                                                  const Context& context = {});

/// The warning of these that needs no grid (WarningCode::facing), for signed distances at any points.
/// @param rule  ClosestPointQuery::sign_rule(). @throws InvalidMesh unless it passes validate(mesh); Cancelled. Cost:
/// as field_warnings().
[[nodiscard]] std::vector<Warning> sign_warnings(const MeshView& mesh, SignRule rule, const Context& context = {});

}  // namespace blum
