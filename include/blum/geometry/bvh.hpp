// Blum: a bounding-volume hierarchy over triangles, segments and points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/ray.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// The closest point of a mesh to a query, and the site that it lies on.
struct NearestSite {
  Vec3d point;          ///< on the mesh, in mesh units
  double distance = 0;  ///< >= 0, mesh units
  SiteId site;          ///< the vertex, open edge or open face that the point lies on
};

/// The closest point of one primitive to a query. Primitives are the triangles, then the segments, then the points of
/// the mesh, counted in one row.
struct NearestPrimitive {
  Vec3d point;                  ///< on the primitive, in mesh units
  double distance = 0;          ///< >= 0, mesh units
  SiteId site;                  ///< the vertex, open edge or open face that the point lies on
  std::uint32_t primitive = 0;  ///< index
};

/// Leaves of a hierarchy: see Bvh::part_in().
class BvhPart {
 private:
  friend class Bvh;
  struct Leaves {
    std::uint32_t block = 0;  ///< of eight leaves in a row
    std::uint32_t bits = 0;   ///< those of them that are in the part
  };
  std::vector<Leaves> leaves_;
};

/// Where a ray crosses a triangle. Whether it does, `side` and `on_border` are exact.
struct RayCrossing {
  double t = 0;  ///< the point is origin + t * direction; >= 0
  TriangleId triangle;
  std::array<double, 3> weights{};  ///< barycentric: of the triangle's corners, in their order; their sum is 1
  int side = 0;            ///< 1 where the ray leaves through the side that the triangle faces, -1 where it enters
  bool on_border = false;  ///< on an edge or a corner, where neighbours of the triangle are met, too
};

/// A bounding-volume hierarchy over the triangles, segments and points of a mesh: eight children per node, leaves of
/// eight primitives. It copies what it needs; the mesh may go away. For boxes alone there is BoxBvh.
///
/// All queries may run on many threads at once; those that return no list allocate nothing. Distances are exact up to
/// rounding (about 1e-15 of the extent of mesh and query together). Queries are finite, within 1e140 times the mesh's
/// longest side; others find nothing.
///
/// Cost: O(n) to build, about 15 ms for 70,000 triangles and 0.4 s for 1.6 million on two cores; 135 bytes per
/// primitive.
class Bvh {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// @throws Cancelled.
  Bvh(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;
  ~Bvh();

  /// The same primitives after their vertices moved. Answers are, bit for bit, those of a hierarchy built anew (what
  /// visitors see comes in another order); queries get slower as neighbours move apart, then build anew. Must not run
  /// beside queries.
  /// @param vertices  as many as the mesh had, finite.
  /// @throws InvalidMesh for another count, or a vertex that is not finite; Cancelled, after which only another refit
  /// may follow. Cost: O(n), about a fifth of building.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// The closest site; among sites at the same computed distance the one with the smallest id.
  /// @param max_distance  mesh units; nothing further than this is found.
  /// @return              nullopt when no site lies within max_distance (or the query is out of its range).
  /// Cost: about O(log n) near the surface; more where many sites are nearly equally close.
  [[nodiscard]] std::optional<NearestSite> nearest(const Vec3d& query,
                                                   double max_distance = std::numeric_limits<double>::infinity()) const;
  /// The same for many queries, threaded. @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<NearestSite>> nearest(
      std::span<const Vec3d> queries, double max_distance = std::numeric_limits<double>::infinity(),
      const Context& context = {}) const;

  /// The closest one of the primitives that are wanted; of several at the same computed distance the first.
  /// @param is_wanted  asked of primitives that may be closer than those found before, more than once each.
  [[nodiscard]] std::optional<NearestPrimitive> nearest_wanted(
      const Vec3d& query, FunctionRef<bool(std::uint32_t)> is_wanted,
      double max_distance = std::numeric_limits<double>::infinity()) const;

  /// The k closest primitives (fewer, where there are fewer within max_distance), by rising distance, then index.
  [[nodiscard]] std::vector<NearestPrimitive> nearest_primitives(
      const Vec3d& query, std::size_t k, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Calls visit(primitive) for the primitives within a distance of a query, in no stated order, until it returns
  /// false.
  void for_each_within(const Vec3d& query, double distance, FunctionRef<bool(const NearestPrimitive&)> visit) const;
  /// All of these, by rising distance, then index.
  [[nodiscard]] std::vector<NearestPrimitive> within(const Vec3d& query, double distance) const;

  /// Calls limit = visit(crossing) for the triangles that a ray crosses between t = 0 and limit, near ones first as far
  /// as the hierarchy tells; a visitor that lowers the limit ends the search early. Triangles are closed: at an edge
  /// all that share it are found. Not found are triangles in whose plane the ray runs, and those without area.
  void for_each_crossing(const Ray& ray, double limit, FunctionRef<double(const RayCrossing&)> visit) const;
  /// All crossings up to t = limit, by rising t, then triangle.
  [[nodiscard]] std::vector<RayCrossing> crossings(const Ray& ray,
                                                   double limit = std::numeric_limits<double>::infinity()) const;
  /// The first of them.
  [[nodiscard]] std::optional<RayCrossing> first_crossing(const Ray& ray,
                                                          double limit = std::numeric_limits<double>::infinity()) const;
  /// The same for many rays, threaded. @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<RayCrossing>> first_crossings(
      std::span<const Ray> rays, double limit = std::numeric_limits<double>::infinity(),
      const Context& context = {}) const;

  /// The leaves of the hierarchy that touch a box: many short questions about the same small place are answered quicker
  /// with it. It must not be used after refit(). @return  nullopt where that is too much to be of use.
  [[nodiscard]] std::optional<BvhPart> part_in(const Box3& box) const;
  /// The same as first_crossing() up to t = 1, for a ray whose points up to there lie in the box of a part.
  [[nodiscard]] std::optional<RayCrossing> first_crossing(const Ray& ray, const BvhPart& part) const;
  /// The same as for_each_near(), for a triangle in the box of a part.
  void for_each_near(const std::array<Vec3d, 3>& triangle, const BvhPart& part,
                     FunctionRef<bool(TriangleId)> visit) const;

  /// Calls visit(triangle) for the triangles of the mesh that may have a point in common with a triangle that need not
  /// be one of them, in no stated order, until it returns false. None is left out that has one; most others are: those
  /// whose boxes do not touch, and those of which one lies on one side of the other's plane.
  void for_each_near(const std::array<Vec3d, 3>& triangle, FunctionRef<bool(TriangleId)> visit) const;

  /// Whether the box of a primitive may touch this box: false only if the box is free of the mesh.
  [[nodiscard]] bool may_touch(const Box3& box) const;

  /// All primitives, in an order in which every aligned run of 8, 64, 512, ... lies in a compact box of its own
  /// (as they were when the hierarchy was built).
  [[nodiscard]] std::span<const std::uint32_t> order() const;

  /// The box around all primitives, mesh units.
  [[nodiscard]] const Box3& bounds() const;
  /// How many primitives there are.
  [[nodiscard]] std::size_t size() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
