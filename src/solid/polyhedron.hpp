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

/// What Solid::of() finds of a mesh.
struct MeshSolid {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;
  std::string problem;   ///< see Solid::problem()
  Topology topology;     ///< of the mesh as it was given
  SolidSurface surface;  ///< see Solid::surface()
  std::size_t reversed_triangles = 0;
  bool is_closed = false;                  ///< every edge has two triangles, which traverse it in opposite directions
  std::optional<CrossingCounts> resolved;  ///< what the shells are without
  std::vector<SolidShell> shells;
  std::vector<SolidBody> bodies;
  std::vector<std::array<std::uint32_t, 2>> touching;  ///< pairs of bodies that touch, the lesser first; rising
};

/// A group for each body, such that bodies of one group do not touch each other: 0 where none touch.
[[nodiscard]] std::vector<std::uint32_t> groups_apart(std::size_t bodies,
                                                      std::span<const std::array<std::uint32_t, 2>> touching);

/// @throws InvalidMesh where there are no triangles; Cancelled.
[[nodiscard]] MeshSolid split_into_bodies(const MeshView& mesh, const SiteTable& sites, const Context& context);

/// Triangles that face one way within each shell, and what they are then.
struct Facing {
  std::optional<std::vector<Triangle>> triangles;  ///< where some were reversed: all of them
  std::size_t reversed_triangles = 0;
  bool is_one_sided = false;  ///< closed, and no way to face makes neighbours agree
  Topology given;             ///< of the mesh as it is
  Topology facts;             ///< of the mesh with these triangles
};

/// The mesh with triangles reversed that face another way than most of their shell. @throws Cancelled.
/// Cost: that of topology(), twice where triangles disagree.
[[nodiscard]] Facing face_one_way(const MeshView& mesh, const SiteTable& sites, const Context& context);

/// Whether shells at odd depth bound voids of those around them, which are at even depth.
[[nodiscard]] bool are_nested(std::span<const Shell> shells);

}  // namespace blum::detail
