// Blum: the bodies that a mesh bounds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/medial_axis/medial_axis.hpp"

namespace blum {

/// A connected part of a solid, or the whole of it, and the triangles of the input around it.
struct SolidBody {
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< of each vertex of `mesh`, in the input
  std::vector<std::uint32_t> triangle_of;  ///< of each triangle of `mesh`, in the input
  BettiNumbers betti{};                    ///< SolidRule::polyhedron: of the body

  /// The site of the input that a site of `mesh` stands for.
  [[nodiscard]] SiteId input_site(SiteId own, const SiteTable& own_sites, const SiteTable& input_sites) const;
};

struct SolidBodies {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;
  std::size_t turned_shells = 0;
  /// Polyhedra: an outer shell with the voids in it each, facing outwards. Else one: all triangles.
  std::vector<SolidBody> bodies;
};

/// @throws InvalidMesh where there are no triangles; Cancelled.
[[nodiscard]] SolidBodies split_into_bodies(const MeshView& mesh, const SiteTable& sites, const Context& context);

}  // namespace blum
