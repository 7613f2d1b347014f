// Blum: cycles and points around a solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/shells.hpp"

namespace blum::verifier {

/// For each body of a solid: closed paths that generate the first homology of its complement, and points in each of its
/// voids. By Alexander duality, linking numbers with the paths distinguish all classes of the body's first homology.
/// Winding numbers around the points distinguish all classes of its second homology. Paths and points may lie on the
/// boundary.
class Complement {
 public:
  /// A straight segment of one or more paths, listed once.
  struct Segment {
    std::array<std::uint32_t, 2> ends;  ///< indices for point()
    std::uint32_t body = 0;
  };
  /// A path that runs along a segment.
  struct Use {
    std::uint32_t path = 0;
    std::int32_t times = 0;  ///< how often the path runs along it; negative if backwards
  };
  struct Void {
    std::vector<Vec3d> points;  ///< points in the void, the deepest first; at least one
    std::uint32_t body = 0;
  };

  /// A segment of a path, used only during construction.
  struct Step {
    std::array<std::uint32_t, 2> ends;
    std::uint32_t path = 0;
    std::int32_t times = 0;
  };

  Complement() = default;
  /// @param body_of_path  for each path its body, in ascending order.
  Complement(std::vector<Vec3d> points, std::vector<Step> steps, const std::vector<std::uint32_t>& body_of_path,
             std::vector<Void> voids);

  [[nodiscard]] const Vec3d& point(std::uint32_t index) const { return points_[index]; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  [[nodiscard]] std::span<const Use> paths_along(std::size_t segment) const {
    return std::span(uses_).subspan(first_[segment], first_[segment + 1] - first_[segment]);
  }
  [[nodiscard]] std::size_t path_count() const { return path_count_; }
  [[nodiscard]] const std::vector<Void>& voids() const { return voids_; }

 private:
  std::vector<Vec3d> points_;
  std::vector<Segment> segments_;
  std::vector<std::size_t> first_{0};
  std::vector<Use> uses_;
  std::size_t path_count_ = 0;
  std::vector<Void> voids_;
};

/// Returns paths along the edges of the shells, and points in each void. The paths generate the homology of the shells,
/// and so that of the complement. Cost: nothing for shells without handles.
/// @param points_of_void  returns for a shell points in its void, or a point on its boundary.
/// @throws Cancelled.
[[nodiscard]] Complement complement_of_mesh(const MeshView& mesh, const ClosedShells& shells,
                                            const std::function<std::vector<Vec3d>(std::uint32_t)>& points_of_void,
                                            const Context& context);

}  // namespace blum::verifier
