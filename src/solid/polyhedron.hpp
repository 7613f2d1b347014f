// Blum: the bodies that a mesh bounds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/resolve_crossings.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum::detail {

/// Findings of Solid::of() about a mesh.
struct MeshSolid {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;
  std::string problem;   ///< see Solid::problem()
  Topology topology;     ///< topology of the given mesh
  SolidSurface surface;  ///< see Solid::surface()
  std::size_t reversed_triangles = 0;
  bool is_closed = false;                  ///< every edge has two triangles that traverse it in opposite directions
  std::optional<CrossingCounts> resolved;  ///< crossings that were resolved to get the shells
  std::vector<SolidShell> shells;
  std::vector<SolidBody> bodies;
  std::vector<std::array<std::uint32_t, 2>> touching;  ///< pairs of touching bodies, the smaller first; ascending
};

/// Returns a group number for each body, such that bodies of the same group do not touch each other. If no bodies
/// touch, all bodies are in group 0.
[[nodiscard]] std::vector<std::uint32_t> groups_apart(std::size_t bodies,
                                                      std::span<const std::array<std::uint32_t, 2>> touching);

/// Finds the solid that a mesh bounds, and splits it into bodies.
/// @throws InvalidMesh if the mesh has no triangles; Cancelled.
[[nodiscard]] MeshSolid split_into_bodies(const MeshView& mesh, const SiteTable& sites, const Context& context);

/// Triangles with a consistent orientation within each shell, and the topology before and after.
struct Facing {
  std::optional<std::vector<Triangle>> triangles;  ///< all triangles; set only if some were reversed
  std::size_t reversed_triangles = 0;
  bool is_one_sided = false;  ///< closed, but without a consistent orientation
  Topology given;             ///< of the given mesh
  Topology facts;             ///< topology with `triangles`
};

/// Reverses triangles that face against the majority of their shell. Cost: that of topology(), or twice as much if
/// triangles were reversed.
/// @throws Cancelled.
[[nodiscard]] Facing face_one_way(const MeshView& mesh, const SiteTable& sites, const Context& context);

/// Returns true if each shell at odd depth bounds a void of the shell around it, which is at even depth.
[[nodiscard]] bool are_nested(std::span<const Shell> shells);

}  // namespace blum::detail
