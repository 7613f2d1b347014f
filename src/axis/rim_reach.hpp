// Blum: targets of rims of medial axes that are continued. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "axis/rims.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/box_bvh.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Triangle mesh with search trees. It owns its data.
class SearchMesh {
 public:
  /// @param mesh   has triangles.
  /// @param sheet  number of the sheet of each triangle; empty if the mesh is not that of sheets.
  SearchMesh(TriangleMesh mesh, std::vector<std::int32_t> sheet, const Context& context);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] const BoxBvh& boxes() const { return boxes_; }  ///< tree of the triangles' boxes
  [[nodiscard]] Vec3d normal(std::uint32_t triangle) const;     ///< unit vector; 0 if the triangle has no area
  [[nodiscard]] std::int32_t sheet(std::uint32_t triangle) const { return sheet_[triangle]; }

 private:
  TriangleMesh mesh_;
  std::vector<std::int32_t> sheet_;
  Bvh bvh_;
  BoxBvh boxes_;
};

/// The rim edges of an axis with a search tree.
class RimLines {
 public:
  /// @param rims  rims of the axis; at least one edge.
  RimLines(const Complex& axis, const Rims& rims, const Context& context);

  struct Line {
    std::array<std::uint32_t, 2> ends{};  ///< vertices of the axis
    Vec3d normal;                         ///< mean unit normal of the sheet at both ends; 0 if unknown
  };
  [[nodiscard]] const Line& line(std::uint32_t number) const { return lines_[number]; }
  [[nodiscard]] const Vec3d& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  /// Calls visit(number) for all lines within a distance of a point.
  void for_each_within(const Vec3d& point, double distance, FunctionRef<void(std::uint32_t)> visit) const;
  /// Returns the sorted vertices that few rim edges connect to some vertices, including these.
  [[nodiscard]] std::vector<std::uint32_t> vertices_near(std::span<const std::uint32_t> vertices) const;

 private:
  TriangleMesh mesh_;
  std::vector<Line> lines_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> beside_;  ///< by vertex: the other ends of its rim edges
  Bvh bvh_;
};

/// Point of a rim, and the ray outwards from it through the solid.
struct RimStart {
  Vec3d at;
  Vec3d outwards;                      ///< Unit length.
  std::optional<Vec3d> normal;         ///< Plane to stay in. If none, the ray follows `outwards`.
  double radius = 0;                   ///< Distance to the surface.
  double reach = 0;                    ///< Greatest length of the ray.
  std::array<std::uint32_t, 2> own{};  ///< Vertices of the axis that the point lies on or between.
  std::int32_t sheet = 0;              ///< Number of the sheet of the rim.
};

enum class RimEnd : std::uint8_t {
  border,  ///< the target lies on the surface of the solid
  sheet,   ///< the target lies on another sheet or its strips
  open,    ///< the ray has its full length `reach` and met nothing
};

struct RimTarget {
  Vec3d at;
  Vec3d normal;  ///< unit normal of the target
  RimEnd end = RimEnd::border;
};

/// Meshes that the ray from a rim may meet. All meshes must outlive this object.
struct RimObstacles {
  const SearchMesh* surface = nullptr;  ///< of the solid
  const SearchMesh* sheets = nullptr;   ///< vertices and triangles of the axis
  const SearchMesh* strips = nullptr;   ///< continue the sheets; start with the vertices of the axis; may be null
  const RimLines* rims = nullptr;       ///< rims of the sheets; rays that nearly meet a rim end there
};

class RimReach {
 public:
  /// @param allows_open  true if a ray that meets nothing has a target at its full length; false if such a ray has no
  ///                     target.
  RimReach(const RimObstacles& obstacles, bool allows_open) : obstacles_(obstacles), allows_open_(allows_open) {}

  /// Returns the end of the ray from a start. The end is the closest visible surface point in the plane of the start,
  /// within 65 degrees of its direction. If the start has no plane, the end is the first surface point along its
  /// direction. If the ray first meets a sheet or strip at 15 degrees or more, the meeting point is returned instead. A
  /// ray also meets a sheet if it passes the sheet's rim within a quarter of the radius.
  [[nodiscard]] std::optional<RimTarget> find(const RimStart& start) const;

  struct Stop {
    RimStart start;
    RimTarget target;
  };
  /// Returns the inner points of a line between two targets, along the obstacles that contain them. The middle of each
  /// segment is at most `tolerance` away from the obstacles, if 6 halvings suffice for this. Each point is a corner
  /// between the planes at two targets, or the target of a start halfway between two others.
  [[nodiscard]] std::vector<Vec3d> between(const Stop& a, const Stop& b, double tolerance) const;

 private:
  [[nodiscard]] std::optional<RimTarget> on_surface(const RimStart& start) const;
  [[nodiscard]] std::optional<RimTarget> first_on_way(const SearchMesh* sheets, const RimStart& start,
                                                      const Vec3d& way) const;
  [[nodiscard]] std::optional<RimTarget> first_rim(const RimStart& start, const Vec3d& way) const;
  [[nodiscard]] std::optional<RimTarget> at(const Vec3d& point, double tolerance, const RimStart& start) const;
  [[nodiscard]] std::optional<RimTarget> on_sheet(const Vec3d& point, double tolerance, const RimStart& start) const;
  [[nodiscard]] bool is_straight(const Stop& a, const Stop& b, double tolerance) const;
  void add_between(const Stop& a, const Stop& b, double tolerance, int depth, std::vector<Vec3d>& path) const;
  [[nodiscard]] std::optional<Stop> corner(const Stop& a, const Stop& b) const;

  RimObstacles obstacles_;
  bool allows_open_;
};

}  // namespace blum::detail
