// Blum: which rule signs a field or a query, why, and how its sides are found. SPDX-License-Identifier: Apache-2.0
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

/// The rule for a mesh and a mode: nothing else is looked at, so that grids, devices and queries cannot disagree.
struct Plan {
  SignRule rule = SignRule::none;
  std::string reason;  ///< one sentence
  Method method = Method::none;
  /// With `crossings`, points with a winding number above this are inside: 0, or -1 to follow the orientation of a mesh
  /// that is inside out. With `sums`, those above level + 1/2.
  int level = 0;
  /// No two triangles touch or cross but neighbours, all shells face away from the solid, and every triangle has a
  /// normal: then pseudonormals tell the same sides. False where nobody looked.
  bool is_simple = false;
};

/// Plans the signs of meshes, one after the other. It keeps what makes the next search for self-intersections faster
/// where the next mesh is the last one deformed; the plans do not depend on it.
class Planner {
 public:
  Planner() = default;
  /// @param order  as for SelfIntersectionSearch.
  explicit Planner(std::span<const std::uint32_t> order) : search_(order) {}

  /// `automatic` takes
  /// - nothing where there are no triangles;
  /// - `normals` where the mesh is closed and consistently oriented, has no free segments or points, no triangles too
  ///   flat for a normal, all of its shells face away from the solid, and no two of its triangles touch or cross but
  ///   neighbours (find_self_intersections, which is exact);
  /// - `winding` elsewhere. The reason names the first of these that failed. A closed mesh that is inside out has a
  ///   winding number of -1 inside, so `winding` finds no inside: the reason says so.
  /// @throws InvalidMesh when normals are asked for but the mesh is not closed and consistently oriented; InvalidOption
  /// when a sign is asked for but there are no triangles; Cancelled.
  /// Cost: O(triangles); with `automatic`, where everything else speaks for `normals`, the search for a pair of
  /// triangles that touch, which ends at the first one.
  [[nodiscard]] Plan plan(SignMode mode, const MeshView& mesh, const SiteTable& sites, const Context& context);

 private:
  [[nodiscard]] Plan plan_automatically(const MeshView& mesh, const SiteTable& sites, const Context& context);

  SelfIntersectionSearch search_;
};

/// Plans the signs of a mesh that lies in a device's memory, where nobody looks at it: winding numbers for every mesh
/// with triangles.
/// @throws InvalidOption as above, and when normals are asked for.
[[nodiscard]] Plan plan_unseen_signs(SignMode mode, std::size_t triangles);

/// Plans the signs of an image's field.
/// @param selection  what is said of the values of voxels inside, such as "equals label 3".
[[nodiscard]] Plan plan_image_signs(bool is_signed, const std::string& selection);

/// Whether a triangle is too flat for its normal to mean anything. Such triangles close cracks in many CAD meshes, and
/// leave their edges with a pseudonormal of one side only.
[[nodiscard]] bool is_too_flat(const MeshView& mesh, const Triangle& triangle);

}  // namespace blum::sign
