// Blum: edges that cross gaps of a solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/segments.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {

/// Where segments go out of a body and come in again, and whether a way along its surface joins both places. Past an
/// edge of the solid, or a hair beside it, one does; across a gap none does, however narrow the gap is.
class GapSearch {
 public:
  /// All that is given must stay. @param search  the triangles of the mesh, with bodies as groups.
  /// @param beside  for each side of a triangle the triangle on the other side of it.
  GapSearch(const SolidOracle& solid, const TriangleSearch& search, const MeshView& mesh,
            std::span<const std::uint32_t> body_of, std::span<const std::uint32_t> beside)
      : solid_(solid), search_(search), mesh_(mesh), body_of_(body_of), beside_(beside) {}

  /// Whether a part of a segment outside of a body cannot be replaced by a way along the surface that keeps within
  /// `reach` of it; nullopt where that cannot be told.
  [[nodiscard]] std::optional<bool> crosses(const Vec3d& a, const Vec3d& b, std::uint32_t body, double reach) const;

 private:
  /// A place where a segment meets the surface, or an end of it that is not inside.
  struct Meeting {
    Vec3d at;
    std::uint32_t triangle = 0;
  };

  [[nodiscard]] std::optional<std::vector<Meeting>> meetings(const Vec3d& a, const Vec3d& b, std::uint32_t body) const;
  [[nodiscard]] std::optional<bool> are_joined(const Meeting& from, const Meeting& to, double reach) const;

  const SolidOracle& solid_;
  const TriangleSearch& search_;
  const MeshView& mesh_;
  std::span<const std::uint32_t> body_of_;
  std::span<const std::uint32_t> beside_;
};

}  // namespace blum::verifier
