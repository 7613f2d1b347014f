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

/// Closest point of a mesh to a query, and the site that contains it.
struct NearestSite {
  Vec3d point;          ///< on the mesh, in mesh units
  double distance = 0;  ///< >= 0, mesh units
  SiteId site;          ///< the vertex, open edge or open face that the point lies on
};

/// Closest point of one primitive to a query. Primitives are numbered consecutively: triangles, then segments, then
/// points of the mesh.
struct NearestPrimitive {
  Vec3d point;                  ///< on the primitive, in mesh units
  double distance = 0;          ///< >= 0, mesh units
  SiteId site;                  ///< the vertex, open edge or open face that the point lies on
  std::uint32_t primitive = 0;  ///< index of the primitive
};

/// Set of leaves of a hierarchy. See Bvh::part_in().
class BvhPart {
 private:
  friend class Bvh;
  struct Leaves {
    std::uint32_t block = 0;  ///< index of a block: leaves 8 * block to 8 * block + 7
    std::uint32_t bits = 0;   ///< bit k is set if leaf 8 * block + k belongs to the set
  };
  std::vector<Leaves> leaves_;
};

/// Crossing of a ray and a triangle. The existence of a crossing, `side` and `on_border` are exact.
struct RayCrossing {
  double t = 0;  ///< the crossing is at origin + t * direction; t >= 0
  TriangleId triangle;
  std::array<double, 3> weights{};  ///< barycentric weights of the triangle's corners, in their order; their sum is 1
  int side = 0;                     ///< 1 if the ray crosses towards the side that the triangle faces, -1 if it crosses
                                    ///< towards the opposite side
  bool on_border = false;           ///< true if the ray meets an edge or corner of the triangle; then it also meets the
                                    ///< triangles that share this edge or corner
};

/// Bounding-volume hierarchy over the triangles, segments and points of a mesh, with eight children per node and eight
/// primitives per leaf. It copies the data it needs, so the mesh may be destroyed. The hierarchy for boxes is BoxBvh.
///
/// All queries may run on many threads at once. Queries that return no list allocate no memory. The rounding error of
/// distances is about 1e-15 times the extent of the box around mesh and query. Coordinates of queries must be finite,
/// and of magnitude at most 1e140 times the mesh's longest side. A query beyond these limits finds nothing.
///
/// Cost: O(n) time to build, and 135 bytes per primitive. On two cores, building takes about 15 ms for 70,000 triangles
/// and 0.4 s for 1.6 million.
class Bvh {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// @throws Cancelled.
  Bvh(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;
  ~Bvh();

  /// Updates the hierarchy to moved vertices of the same primitives. Afterwards, results equal those of a newly built
  /// hierarchy, bit for bit; only the order of visits differs. Queries become slower if primitives that were neighbours
  /// move apart; build a new hierarchy in this case. Must not run at the same time as queries.
  /// @param vertices  the new positions, one for each vertex of the mesh. Vertices that a triangle, segment or point
  ///                  uses must be finite, of magnitude at most 1e150.
  /// @throws InvalidMesh if the number of vertices has changed or a used vertex is out of range; Cancelled. After
  /// Cancelled, refit() must be called again before any other function. Cost: O(n), about a fifth of the time to build
  /// a hierarchy.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// Returns the closest site. If several sites have the smallest computed distance, the one with the smallest id is
  /// returned.
  /// @param max_distance  mesh units; farther sites are not found.
  /// @return              nullopt if no site lies within max_distance, or if a coordinate of the query exceeds the
  ///                      limit of this class.
  /// Cost: about O(log n) near the surface; more if many sites are nearly equally close.
  [[nodiscard]] std::optional<NearestSite> nearest(const Vec3d& query,
                                                   double max_distance = std::numeric_limits<double>::infinity()) const;
  /// Returns the closest sites of many queries, computed with threads. @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<NearestSite>> nearest(
      std::span<const Vec3d> queries, double max_distance = std::numeric_limits<double>::infinity(),
      const Context& context = {}) const;

  /// Returns the closest primitive for which is_wanted(primitive) returns true. If several primitives have the smallest
  /// computed distance, the one with the smallest index is returned.
  /// @param is_wanted  called with primitives that may be closer than those found before; may be called several times
  ///                   with the same primitive.
  [[nodiscard]] std::optional<NearestPrimitive> nearest_wanted(
      const Vec3d& query, FunctionRef<bool(std::uint32_t)> is_wanted,
      double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Returns the k closest primitives, in rising order of distance, then of index. Returns fewer than k if fewer
  /// primitives lie within max_distance.
  [[nodiscard]] std::vector<NearestPrimitive> nearest_primitives(
      const Vec3d& query, std::size_t k, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Calls visit(primitive) for each primitive within a distance of a query, until visit() returns false. The order is
  /// unspecified.
  void for_each_within(const Vec3d& query, double distance, FunctionRef<bool(const NearestPrimitive&)> visit) const;
  /// Returns all primitives within a distance of a query, in rising order of distance, then of index.
  [[nodiscard]] std::vector<NearestPrimitive> within(const Vec3d& query, double distance) const;

  /// Calls limit = visit(crossing) for each triangle that a ray crosses between t = 0 and t = limit. The value that
  /// visit() returns is the limit for the rest of the search; a lower limit ends the search earlier. Crossings are
  /// visited approximately in rising order of t. Triangles are closed: if a ray crosses an edge, all triangles that
  /// share the edge are found. Triangles without area, and triangles whose plane contains the ray, are not found.
  void for_each_crossing(const Ray& ray, double limit, FunctionRef<double(const RayCrossing&)> visit) const;
  /// Returns all crossings with t <= limit, in rising order of t, then of triangle index.
  [[nodiscard]] std::vector<RayCrossing> crossings(const Ray& ray,
                                                   double limit = std::numeric_limits<double>::infinity()) const;
  /// Returns the first entry of the list that crossings() returns; nullopt if this list is empty.
  [[nodiscard]] std::optional<RayCrossing> first_crossing(const Ray& ray,
                                                          double limit = std::numeric_limits<double>::infinity()) const;
  /// Returns the first crossings of many rays, computed with threads. @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<RayCrossing>> first_crossings(
      std::span<const Ray> rays, double limit = std::numeric_limits<double>::infinity(),
      const Context& context = {}) const;

  /// Returns the leaves of the hierarchy that touch a box. This set of leaves makes many short queries in the same
  /// small region faster. The set must not be used after refit(). @return nullopt if so many leaves touch the box that
  /// queries would not be faster.
  [[nodiscard]] std::optional<BvhPart> part_in(const Box3& box) const;
  /// Returns the result of first_crossing() with limit 1. The points of the ray with t <= 1 must lie in the box that
  /// was passed to part_in().
  [[nodiscard]] std::optional<RayCrossing> first_crossing(const Ray& ray, const BvhPart& part) const;
  /// Does the same as for_each_near() below. The given triangle must lie in the box that was passed to part_in().
  void for_each_near(const std::array<Vec3d, 3>& triangle, const BvhPart& part,
                     FunctionRef<bool(TriangleId)> visit) const;

  /// Calls visit(triangle) for triangles of the mesh that may have a common point with a given triangle, until visit()
  /// returns false. The given triangle need not belong to the mesh. The order is unspecified. All triangles with a
  /// common point are visited. Most other triangles are not visited: their box does not touch the given triangle's box,
  /// or the plane of one triangle separates the two triangles.
  void for_each_near(const std::array<Vec3d, 3>& triangle, FunctionRef<bool(TriangleId)> visit) const;

  /// Returns true if the box of a primitive may touch the given box. If it returns false, the given box contains no
  /// point of the mesh.
  [[nodiscard]] bool may_touch(const Box3& box) const;

  /// Returns all primitives in the order of the leaves. Entries 8 k to 8 k + 7, for any k, are neighbours: they lay in
  /// a compact box of their own when the hierarchy was built. The same holds for groups of 64, 512, ... entries.
  [[nodiscard]] std::span<const std::uint32_t> order() const;

  /// Returns the box around all primitives, mesh units.
  [[nodiscard]] const Box3& bounds() const;
  /// Returns the number of primitives.
  [[nodiscard]] std::size_t size() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
