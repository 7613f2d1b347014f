// Blum: where rims of medial axes lead to when they are continued. SPDX-License-Identifier: Apache-2.0
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

/// A triangle mesh to look up points in. It owns what it needs.
class SearchMesh {
 public:
  /// @param mesh  has triangles.
  SearchMesh(TriangleMesh mesh, const Context& context);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] const BoxBvh& boxes() const { return boxes_; }  ///< of the triangles
  [[nodiscard]] Vec3d normal(std::uint32_t triangle) const;     ///< of unit length; 0 where there is no area

 private:
  TriangleMesh mesh_;
  Bvh bvh_;
  BoxBvh boxes_;
};

/// A point of a rim in its solid, and where to go from there.
struct RimStart {
  Vec3d at;
  Vec3d outwards;                      ///< of unit length
  std::optional<Vec3d> normal;         ///< of the plane to stay in; none: go along `outwards`
  double radius = 0;                   ///< distance to the surface
  double reach = 0;                    ///< not further than this
  std::array<std::uint32_t, 2> own{};  ///< vertices of the axis that it lies on, or between
};

enum class RimEnd : std::uint8_t {
  border,  ///< on the surface of the solid
  sheet,   ///< on another sheet, or on what continues it
  open,    ///< as far as the reach goes, where nothing was met
};

struct RimTarget {
  Vec3d at;
  Vec3d normal;  ///< of what is there, of unit length
  RimEnd end = RimEnd::border;
};

/// What rims may meet. All must outlive it.
struct RimObstacles {
  const SearchMesh* surface = nullptr;  ///< of the solid
  const SearchMesh* sheets = nullptr;   ///< of the axis: its vertices and triangles
  const SearchMesh* strips = nullptr;   ///< that continue them, whose first vertices are those of the axis; or none
};

class RimReach {
 public:
  /// @param allows_open  whether what meets nothing ends at its reach, instead of nowhere.
  RimReach(const RimObstacles& obstacles, bool allows_open) : obstacles_(obstacles), allows_open_(allows_open) {}

  /// The closest point of the surface that the plane of a start has within 65 degrees of its direction, and that is
  /// seen from there; without a plane, the point that the direction leads to. Or else what is met on the way of sheets
  /// and strips, at 15 degrees or more.
  [[nodiscard]] std::optional<RimTarget> find(const RimStart& start) const;

  struct Stop {
    RimStart start;
    RimTarget target;
  };
  /// The points between two targets on a line along what they lie on, such that the middle of each of its segments is
  /// at most `tolerance` off where it can be: corners where the planes at two points meet, and what is met from
  /// halfway.
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
