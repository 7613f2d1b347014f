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

/// Triangle mesh with search trees. It owns its data.
class SearchMesh {
 public:
  /// @param mesh  has triangles.
  SearchMesh(TriangleMesh mesh, const Context& context);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] const BoxBvh& boxes() const { return boxes_; }  ///< tree of the triangles' boxes
  [[nodiscard]] Vec3d normal(std::uint32_t triangle) const;     ///< unit vector; 0 if the triangle has no area

 private:
  TriangleMesh mesh_;
  Bvh bvh_;
  BoxBvh boxes_;
};

/// Point of a rim, and the way outwards from it through the solid.
struct RimStart {
  Vec3d at;
  Vec3d outwards;                      ///< Unit length.
  std::optional<Vec3d> normal;         ///< Plane to stay in. If none, the way follows `outwards`.
  double radius = 0;                   ///< Distance to the surface.
  double reach = 0;                    ///< Greatest length of the way.
  std::array<std::uint32_t, 2> own{};  ///< Vertices of the axis that the point lies on or between.
};

enum class RimEnd : std::uint8_t {
  border,  ///< the target lies on the surface of the solid
  sheet,   ///< the target lies on another sheet or its strips
  open,    ///< the way has its full length `reach` and met nothing
};

struct RimTarget {
  Vec3d at;
  Vec3d normal;  ///< unit normal of the target
  RimEnd end = RimEnd::border;
};

/// Meshes that the way from a rim may meet. All must outlive this object.
struct RimObstacles {
  const SearchMesh* surface = nullptr;  ///< of the solid
  const SearchMesh* sheets = nullptr;   ///< vertices and triangles of the axis
  const SearchMesh* strips = nullptr;   ///< continue the sheets; start with the vertices of the axis; may be null
};

class RimReach {
 public:
  /// @param allows_open  true if a way that meets nothing has a target at its full length. Otherwise such a way has no
  ///                     target.
  RimReach(const RimObstacles& obstacles, bool allows_open) : obstacles_(obstacles), allows_open_(allows_open) {}

  /// Returns the end of the way from a start. It is the closest visible surface point in the plane of the start, within
  /// 65 degrees of its direction. If the start has no plane, it is the first surface point along its direction. If the
  /// way first meets a sheet or strip at 15 degrees or more, the meeting point is returned instead.
  [[nodiscard]] std::optional<RimTarget> find(const RimStart& start) const;

  struct Stop {
    RimStart start;
    RimTarget target;
  };
  /// Returns the inner points of a line between two targets, along the obstacles that contain them. The middle of each
  /// segment is at most `tolerance` away from the obstacles, if 6 halvings reach that. Each point is a corner between
  /// the planes at two targets, or the target of a start halfway between two others.
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
