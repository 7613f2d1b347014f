// Blum: flat and smooth parts of a surface, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/shells.hpp"

namespace blum::verifier {

/// The walls of a solid: parts of its surface between which sheets lie.
///
/// Triangles that are connected through edges that bend by at most 1 degree form a flat part. Triangles that are
/// connected through edges that bend by at most 30 degrees form a smooth part. The wall of a triangle is its flat part
/// if that covers at least 1/256 of the surface of the body, else its smooth part. With fillets, the whole surface may
/// be one smooth part.
class SurfaceWalls {
 public:
  SurfaceWalls() = default;
  /// @param shells   shells of the mesh, with its triangles' neighbours and facings.
  /// @param body_of  body of each triangle; no_group for triangles that belong to no wall.
  /// Cost: near-linear.
  SurfaceWalls(const MeshView& mesh, const ClosedShells& shells, std::span<const std::uint32_t> body_of);

  /// Returns the number of the wall of a triangle.
  [[nodiscard]] std::uint32_t of(std::uint32_t triangle) const { return wall_[triangle]; }
  /// Returns the smallest triangle of the smooth part that contains a wall.
  [[nodiscard]] std::uint32_t smooth_part_of_wall(std::uint32_t wall) const {
    const auto count = static_cast<std::uint32_t>(wall_.size());
    return wall < count ? smooth_part_[wall] : wall - count;
  }
  /// Returns the smallest triangle of the flat part of a triangle.
  [[nodiscard]] std::uint32_t flat_part_of(std::uint32_t triangle) const { return flat_part_[triangle]; }

 private:
  std::vector<std::uint32_t> wall_, flat_part_, smooth_part_;
};

}  // namespace blum::verifier
