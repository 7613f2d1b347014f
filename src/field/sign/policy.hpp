// Blum: the rule for the signs of a field or a query, its reason and method. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/sign/facing_repair.hpp"
#include "field/sign/method.hpp"

namespace blum::sign {

/// Rule for the signs of a mesh. A plan depends only on the mesh and the sign mode, so grids, devices and queries
/// always agree.
struct Plan {
  SignRule rule = SignRule::none;
  std::string reason;  ///< one sentence
  std::vector<Warning> warnings = {};
  /// Triangles that replace those of the mesh, because some triangles of the mesh face the wrong way. Empty if the
  /// triangles of the mesh are used.
  std::vector<Triangle> triangles = {};
  Method method = Method::none;
  /// With `crossings`, points with a winding number above this level are inside. The level is 0. For an inside-out mesh
  /// whose orientation is to be followed, it is -1. With `sums`, points with a winding number above level + 1/2 are
  /// inside.
  int level = 0;
  /// True if no two triangles touch or cross except neighbours, all shells face away from the solid, and every triangle
  /// has a normal. In this case, pseudonormals give the same signs. False if the conditions were not checked.
  bool is_simple = false;
};

/// Plans the signs of meshes, one after the other. If a mesh is a deformation of the previous mesh, kept data make the
/// search for self-intersections faster. Plans do not depend on these data.
class Planner {
 public:
  Planner() = default;
  /// @param order  as for the constructor of SelfIntersectionSearch.
  explicit Planner(std::span<const std::uint32_t> order) : search_(order) {}

  /// Returns the plan for a mesh. The mode `automatic` chooses one of these:
  /// - Unsigned, if the mesh has no triangles.
  /// - `normals`, if all of these conditions hold. The mesh is closed and consistently oriented. It has no free
  ///   segments or points, and no triangles too flat for a normal. All of its shells face away from the solid. No two
  ///   of its triangles touch or cross, except neighbours (find_self_intersections, which is exact).
  /// - `winding` otherwise. The plan's reason states which condition failed first, in this order.
  ///
  /// If parts of a mesh face the wrong way, `automatic` first reverses these parts (repair_facing()), with a warning.
  /// The other modes use the mesh as it is, and warn. With `winding`, an inside-out mesh then has no inside, because
  /// its winding numbers are negative.
  ///
  /// @throws InvalidMesh if normals are requested, but the mesh is not closed and consistently oriented, or has free
  /// segments or points.
  /// @throws InvalidOption if signs are requested, but the mesh has no triangles.
  /// @throws Cancelled.
  /// Cost: that of repair_facing(), and O(triangles). With `automatic`, if all other conditions of `normals` hold, also
  /// a search for triangles that touch. The search ends at the first pair.
  [[nodiscard]] Plan plan(SignMode mode, const MeshView& mesh, const SiteTable& sites, const Context& context);

 private:
  /// Returns true if two triangles of a mesh cross or touch, except neighbours. Reversed triangles cross where the
  /// given ones do. So a closed mesh of triangles, whose vertices are not joined, is searched only once for a plan.
  class KnownCrossings {
   public:
    KnownCrossings(SelfIntersectionSearch& search, const MeshView& mesh, const Orientation& facts,
                   const Context& context)
        : search_(search),
          context_(context),
          is_shared_(facts.closed && mesh.segments.empty() && mesh.points.empty()) {}

    [[nodiscard]] bool operator()(const MeshView& mesh);

   private:
    SelfIntersectionSearch& search_;
    const Context& context_;
    bool is_shared_;
    std::optional<bool> answer_;
  };

  [[nodiscard]] Plan plan_automatically(const MeshView& mesh, const SiteTable& sites, const Context& context);
  /// Returns the plan of `winding`, which was requested.
  [[nodiscard]] Plan plan_as_given(const MeshView& mesh, const SiteTable& sites, const Context& context);
  /// Returns the automatic plan for a mesh that is used as it is.
  [[nodiscard]] static Plan plan_oriented(const MeshView& mesh, const SiteTable& sites, const Orientation& facts,
                                          KnownCrossings& crosses);

  SelfIntersectionSearch search_;
};

/// Plans the signs of a mesh in a device's memory. The mesh is not examined: every mesh with triangles gets winding
/// numbers.
/// @throws InvalidOption as for Planner::plan(), and also if normals are requested.
[[nodiscard]] Plan plan_unseen_signs(SignMode mode, std::size_t triangles);

/// Plans the signs of an image's field.
/// @param selection  condition that selects the voxels inside, for example "equals label 3".
[[nodiscard]] Plan plan_image_signs(bool is_signed, const std::string& selection);

/// Returns true if a triangle is too flat for a meaningful normal. Many CAD meshes close cracks with such triangles.
/// Edges of such a triangle get a pseudonormal from the other triangle only.
[[nodiscard]] bool is_too_flat(const MeshView& mesh, const Triangle& triangle);

}  // namespace blum::sign
