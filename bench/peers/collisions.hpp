// Blum: other programs that answer questions about close triangles; each is optional. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::bench {

/// Two bodies of a peer, the first of which rests.
class PeerBodies {
 public:
  virtual ~PeerBodies() = default;
  /// The distance of the second body from the first one.
  [[nodiscard]] virtual double separation(const RigidTransform& second) = 0;
  /// The same triangles with other vertices: what the peer does for that, which gives right distances afterwards.
  virtual void deform(const TriangleMesh& first, const TriangleMesh& second) = 0;
};

/// How FCL is to keep a body.
enum class FclBodies {
  oriented,  ///< oriented boxes and swept spheres: its fastest for bodies that keep their shape; rebuilt where they
             ///< deform, as refitted ones give wrong distances in 0.7
  aligned    ///< boxes along the axes, which are refitted: its fastest for bodies that deform
};

/// FCL's BVH models; nullptr where it was not installed when the benchmarks were configured.
[[nodiscard]] std::unique_ptr<PeerBodies> fcl_bodies(const TriangleMesh& first, const TriangleMesh& second,
                                                     FclBodies kind);

/// The pairs of triangles that CGAL's self_intersections() finds, with exact predicates: the smaller first, sorted;
/// nullopt where it was not installed. @param mesh  an orientable manifold.
[[nodiscard]] std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> cgal_self_intersections(
    const TriangleMesh& mesh);

}  // namespace blum::bench
