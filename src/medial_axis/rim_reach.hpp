// Blum: where rims of medial axes meet the surface when they are continued. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// A triangle mesh to look up points in, whose triangles may be all there is. It owns what it needs.
class SearchMesh {
 public:
  SearchMesh(TriangleMesh mesh, const Context& context);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] Vec3d normal(std::uint32_t triangle) const;  ///< of unit length; 0 where there is no area

 private:
  TriangleMesh mesh_;
  Bvh bvh_;
};

/// A point to go from, in a solid, and where to.
struct RimStart {
  Vec3d at;
  Vec3d outwards;               ///< of unit length
  std::optional<Vec3d> normal;  ///< of the plane to stay in; none: go along `outwards`
  double reach = 0;             ///< not further than this
};

/// A point of the surface, or of a sheet.
struct RimTarget {
  Vec3d at;
  std::uint32_t triangle = 0;  ///< of the surface that it lies on
};

/// The closest point of a surface that a plane through a start has within 65 degrees of its direction, and that is seen
/// from the start; without a plane, the one that the direction leads to. nullopt where there is none within reach.
[[nodiscard]] std::optional<RimTarget> find_target(const SearchMesh& surface, const RimStart& start);

/// The line along a surface between two points of it, such that the middle of each of its segments is at most
/// `tolerance` off the surface where it can be: corners where the planes at two points meet a plane between them, and
/// what is met from halfway.
class BorderPath {
 public:
  BorderPath(const SearchMesh& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  struct Stop {
    RimStart start;  ///< that it was found from
    RimTarget target;
  };
  /// The points between two.
  [[nodiscard]] std::vector<Vec3d> between(const Stop& a, const Stop& b) const;

 private:
  void add_between(const Stop& a, const Stop& b, int depth, std::vector<Vec3d>& path) const;
  [[nodiscard]] bool is_on_surface(const Vec3d& at, double tolerance) const;
  [[nodiscard]] std::optional<Stop> corner(const Stop& a, const Stop& b) const;

  const SearchMesh& surface_;
  double tolerance_;
};

}  // namespace blum
