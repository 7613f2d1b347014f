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
  Topology topology;     ///< of the given mesh
  SolidSurface surface;  ///< see Solid::surface()
  std::size_t reversed_triangles = 0;
  bool is_closed = false;                  ///< every edge has two triangles, which traverse it in opposite directions
  std::optional<CrossingCounts> resolved;  ///< crossings that were resolved to get the shells
  std::vector<SolidShell> shells;
  std::vector<SolidBody> bodies;
  std::vector<std::array<std::uint32_t, 2>> touching;  ///< pairs of bodies that touch, the lesser first; rising
};

/// Returns a group for each body, such that bodies of one group do not touch each other. All are in group 0 if none
/// touch.
[[nodiscard]] std::vector<std::uint32_t> groups_apart(std::size_t bodies,
                                                      std::span<const std::array<std::uint32_t, 2>> touching);

/// Splits a mesh into the bodies that it bounds.
/// @throws InvalidMesh if there are no triangles; Cancelled.
[[nodiscard]] MeshSolid split_into_bodies(const MeshView& mesh, const SiteTable& sites, const Context& context);

/// Triangles that face one way within each shell, and the topology with them.
struct Facing {
  std::optional<std::vector<Triangle>> triangles;  ///< if some were reversed: all of them
  std::size_t reversed_triangles = 0;
  bool is_one_sided = false;  ///< closed, but no orientation makes neighbours agree
  Topology given;             ///< of the given mesh
  Topology facts;             ///< of the mesh with these triangles
};

/// Returns the mesh's triangles, with those reversed that face another way than most of their shell. Cost: that of
/// topology(), twice if triangles disagree.
/// @throws Cancelled.
[[nodiscard]] Facing face_one_way(const MeshView& mesh, const SiteTable& sites, const Context& context);

/// Returns true if each shell at odd depth bounds a void of the shell around it, which is at even depth.
[[nodiscard]] bool are_nested(std::span<const Shell> shells);

}  // namespace blum::detail
