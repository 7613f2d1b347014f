// Blum: optional other programs for proximity queries. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::bench {

/// Two bodies of a peer. The first one rests.
class PeerBodies {
 public:
  virtual ~PeerBodies() = default;
  /// The distance between the bodies, with the second one at the given place.
  [[nodiscard]] virtual double separation(const RigidTransform& second) = 0;
  /// Returns true if the surfaces of the bodies meet, with the second one at the given place.
  [[nodiscard]] virtual bool meets(const RigidTransform& second) = 0;
  /// Replaces the vertices and keeps the triangles. Distances are right afterwards.
  virtual void deform(const TriangleMesh& first, const TriangleMesh& second) = 0;
};

/// FCL's representation of a body.
enum class FclBodies {
  oriented,  ///< oriented boxes and swept spheres: the fastest for bodies of constant shape. Deformed bodies are
             ///< rebuilt, because refitted ones give wrong distances in 0.7
  aligned    ///< boxes along the axes, which are refitted: the fastest for bodies that deform
};

/// FCL's BVH models; nullptr if FCL was not installed when the benchmarks were configured.
[[nodiscard]] std::unique_ptr<PeerBodies> fcl_bodies(const TriangleMesh& first, const TriangleMesh& second,
                                                     FclBodies kind);

/// Coal's BVH models with oriented boxes and swept spheres; nullptr if Coal was not installed. They do not deform.
[[nodiscard]] std::unique_ptr<PeerBodies> coal_bodies(const TriangleMesh& first, const TriangleMesh& second);

/// The pairs of triangles from CGAL's self_intersections(), with exact predicates. They are sorted, each with the
/// smaller index first. Returns nullopt if CGAL was not installed. @param mesh  an orientable manifold.
[[nodiscard]] std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> cgal_self_intersections(
    const TriangleMesh& mesh);

}  // namespace blum::bench
