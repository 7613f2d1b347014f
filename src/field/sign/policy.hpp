// Blum: the rule for the signs of a field or a query, its reason and method. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/sign/method.hpp"

namespace blum::sign {

/// Rule for the signs of a mesh. It depends on the mesh and the mode only, so that grids, devices and queries cannot
/// disagree.
struct Plan {
  SignRule rule = SignRule::none;
  std::string reason;  ///< one sentence
  Method method = Method::none;
  /// With `crossings`, points with a winding number above this level are inside. The level is 0, or -1 to follow the
  /// orientation of a mesh that is inside out. With `sums`, points above level + 1/2 are inside.
  int level = 0;
  /// True if no triangles but neighbours touch or cross, all shells face away from the solid, and every triangle has a
  /// normal. Pseudonormals then give the same sides. False if this was not checked.
  bool is_simple = false;
};

/// Plans the signs of meshes, one after the other. It keeps data that make the next search for self-intersections
/// faster if the next mesh is the last one deformed. Plans do not depend on these data.
class Planner {
 public:
  Planner() = default;
  /// @param order  as for SelfIntersectionSearch.
  explicit Planner(std::span<const std::uint32_t> order) : search_(order) {}

  /// Returns the plan for a mesh. `automatic` chooses one of these:
  /// - Unsigned, if the mesh has no triangles.
  /// - `normals`, if all of these conditions hold. The mesh is closed and consistently oriented. It has no free
  ///   segments or points, and no triangles too flat for a normal. All of its shells face away from the solid. No two
  ///   of its triangles but neighbours touch or cross (find_self_intersections, which is exact).
  /// - `winding`, otherwise. The reason names the first of these conditions that failed.
  ///
  /// A closed mesh that is inside out has a winding number of -1 inside, so `winding` finds no inside. The reason says
  /// so.
  ///
  /// @throws InvalidMesh if normals are asked for, but the mesh is not closed and consistently oriented, or has free
  /// segments or points.
  /// @throws InvalidOption if a sign is asked for, but the mesh has no triangles.
  /// @throws Cancelled.
  /// Cost: O(triangles). With `automatic`, if all other conditions of `normals` hold, also the search for a pair of
  /// triangles that touch. It ends at the first pair.
  [[nodiscard]] Plan plan(SignMode mode, const MeshView& mesh, const SiteTable& sites, const Context& context);

 private:
  [[nodiscard]] Plan plan_automatically(const MeshView& mesh, const SiteTable& sites, const Context& context);

  SelfIntersectionSearch search_;
};

/// Plans the signs of a mesh in a device's memory, where it is not examined: winding numbers for every mesh with
/// triangles.
/// @throws InvalidOption as Planner::plan(), and if normals are asked for.
[[nodiscard]] Plan plan_unseen_signs(SignMode mode, std::size_t triangles);

/// Plans the signs of an image's field.
/// @param selection  condition on the values of voxels inside, for example "equals label 3".
[[nodiscard]] Plan plan_image_signs(bool is_signed, const std::string& selection);

/// Returns true if a triangle is too flat for a meaningful normal. Such triangles close cracks in many CAD meshes. They
/// leave their edges with a pseudonormal of one side only.
[[nodiscard]] bool is_too_flat(const MeshView& mesh, const Triangle& triangle);

}  // namespace blum::sign
