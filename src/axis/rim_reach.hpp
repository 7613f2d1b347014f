// Blum: targets of rims of medial axes that are continued. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/box_bvh.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Triangle mesh in which points are looked up. It owns its data.
class SearchMesh {
 public:
  /// @param mesh  has triangles.
  SearchMesh(TriangleMesh mesh, const Context& context);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] const BoxBvh& boxes() const { return boxes_; }  ///< of the triangles
  [[nodiscard]] Vec3d normal(std::uint32_t triangle) const;     ///< unit length; 0 without area

 private:
  TriangleMesh mesh_;
  Bvh bvh_;
  BoxBvh boxes_;
};

/// Point of a rim in its solid, and the way from there.
struct RimStart {
  Vec3d at;
  Vec3d outwards;                      ///< Unit length.
  std::optional<Vec3d> normal;         ///< Plane to stay in. If none, the way follows `outwards`.
  double radius = 0;                   ///< Distance to the surface.
  double reach = 0;                    ///< Greatest length of the way.
  std::array<std::uint32_t, 2> own{};  ///< Vertices of the axis that it lies on or between.
};

enum class RimEnd : std::uint8_t {
  border,  ///< on the surface of the solid
  sheet,   ///< on another sheet or its continuation
  open,    ///< at the end of the reach, if nothing was met
};

struct RimTarget {
  Vec3d at;
  Vec3d normal;  ///< unit normal of the target
  RimEnd end = RimEnd::border;
};

/// Meshes that rims may meet. All must outlive it.
struct RimObstacles {
  const SearchMesh* surface = nullptr;  ///< of the solid
  const SearchMesh* sheets = nullptr;   ///< of the axis: its vertices and triangles
  const SearchMesh* strips = nullptr;   ///< continue these; their first vertices are those of the axis; may be null
};

class RimReach {
 public:
  /// @param allows_open  true if a rim that meets nothing ends at its reach; otherwise it has no target.
  RimReach(const RimObstacles& obstacles, bool allows_open) : obstacles_(obstacles), allows_open_(allows_open) {}

  /// Returns the closest point of the surface in the plane of a start, within 65 degrees of its direction and visible
  /// from the start. Without a plane, it is the point that the direction leads to. If the way meets sheets or strips
  /// before that at 15 degrees or more, that point is returned.
  [[nodiscard]] std::optional<RimTarget> find(const RimStart& start) const;

  struct Stop {
    RimStart start;
    RimTarget target;
  };
  /// Returns the points between two targets on a line along the obstacles that they lie on. The middle of each segment
  /// is at most `tolerance` off, if possible. Points are corners where the planes at two points meet, and targets of
  /// starts halfway.
  [[nodiscard]] std::vector<Vec3d> between(const Stop& a, const Stop& b, double tolerance) const;

 private:
  [[nodiscard]] std::optional<RimTarget> on_surface(const RimStart& start) const;
  [[nodiscard]] std::optional<RimTarget> first_on_way(const SearchMesh* sheets, const RimStart& start,
                                                      const Vec3d& way) const;
  [[nodiscard]] std::optional<RimTarget> at(const Vec3d& point, double tolerance, const RimStart& start) const;
  [[nodiscard]] bool is_straight(const Stop& a, const Stop& b, double tolerance) const;
  void add_between(const Stop& a, const Stop& b, double tolerance, int depth, std::vector<Vec3d>& path) const;
  [[nodiscard]] std::optional<Stop> corner(const Stop& a, const Stop& b) const;

  RimObstacles obstacles_;
  bool allows_open_;
};

}  // namespace blum::detail
