// Blum: exact closest points and signed distances at any points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct ClosestPointOptions {
  /// Rule for the sign of distances, as for fields. `none` (unsigned) is the cheapest.
  SignMode sign = SignMode::automatic;
  /// Largest distance at which points of the mesh are found; >= 0, in mesh units. Unset: no limit.
  std::optional<double> max_distance = {};
};

template <>
struct Description<ClosestPointOptions> {
  static constexpr std::string_view name = "ClosestPointOptions";
  static constexpr std::string_view doc = "Options of closest points";
  static constexpr std::tuple members{
      Member{"sign", &ClosestPointOptions::sign, "", "rule for the sign, as for fields; 'none' is fastest"},
      Member{"max_distance", &ClosestPointOptions::max_distance, "mesh units", "largest distance that is searched",
             Range::at_least(0)},
  };
};

/// Point of a mesh that is closest to a query.
struct ClosestPoint {
  Vec3d point;          ///< on the mesh; the query itself if nothing lies within max_distance
  double distance = 0;  ///< mesh units, negative inside if signed; infinite if nothing lies within max_distance
  SiteId site;          ///< vertex, open edge or open face that contains the point, numbered as in SiteTable
  TriangleId triangle;  ///< smallest index of a triangle that contains the site; none() if no triangle does
};

/// Returns the unit vector along which the signed distance grows fastest. The vector points away from the surface if
/// the query is outside, and towards the surface if the query is inside. On the medial axis, the distance grows fastest
/// along several vectors, and one of these is returned. Returns nullopt if the query is on the surface (within
/// rounding), or if no closest point was found. ClosestPointQuery::gradient() also has a value on the surface.
[[nodiscard]] std::optional<Vec3d> gradient(const Vec3d& query, const ClosestPoint& found);

/// Returns the weights of the corners of `found.triangle`, in their order. The closest point is the weighted mean of
/// the corners. Each weight is at least 0, and their sum is 1 within rounding. If the closest point is a corner, the
/// weight of that corner is 1, and the other weights are 0.
/// @param mesh  the mesh on which `found` is the closest point.
/// @return      nullopt if the closest point lies on no triangle.
[[nodiscard]] std::optional<std::array<double, 3>> barycentric(const MeshView& mesh, const ClosestPoint& found);

/// Closest point of a mesh to one of several queries.
struct FoundPoint {
  std::size_t query = 0;  ///< index of the query
  Vec3d point;            ///< `point`, `distance` and `site` are as in ClosestPoint
  double distance = 0;
  SiteId site;
};

/// Primitives found by several queries. The primitives of query q are found[first[q]] to found[first[q + 1] - 1], in
/// rising order of distance, then of primitive index.
struct NearPrimitives {
  std::vector<std::size_t> first{0};  ///< one entry more than there are queries
  std::vector<NearestPrimitive> found;
};

/// Answers closest-point queries on one mesh. It copies the data that it needs, so the mesh may be destroyed.
class ClosestPointQuery {
 public:
  /// @throws InvalidMesh, InvalidOption, Cancelled.
  /// Cost: O(n log n) for n primitives. With 70,000 triangles on two cores, construction takes about 80 ms, or 30 ms if
  /// unsigned. Construction takes longer if winding numbers are needed.
  explicit ClosestPointQuery(const MeshView& mesh, const ClosestPointOptions& options = {},
                             const Context& context = {});
  /// Constructs a query object and prepares it with prepare_for_many(). With several threads, one call of for_many() is
  /// faster than these two calls, because it builds both search structures at the same time.
  /// @param queries  approximate number of queries in all batches together.
  /// @throws as the constructor.
  [[nodiscard]] static ClosestPointQuery for_many(const MeshView& mesh, std::size_t queries,
                                                  const ClosestPointOptions& options = {}, const Context& context = {});
  ClosestPointQuery(ClosestPointQuery&&) noexcept;
  ClosestPointQuery& operator=(ClosestPointQuery&&) noexcept;
  ~ClosestPointQuery();

  /// Returns the closest point to one query. This function may be called from many threads at once, and allocates no
  /// memory.
  /// @param query  finite. The magnitude of coordinates must be at most 1e140. If the longest side of the mesh's box is
  ///               not 0, the magnitude must also be at most 1e140 times that side. If the query is beyond these
  ///               limits, the result has no site.
  /// @return       the closest point. The error of its distance is about 1e-15 times the extent of the box around mesh
  ///               and query. If several sites have the smallest computed distance, the one with the smallest id is
  ///               returned. A query whose computed distance is 0 counts as outside. With an open mesh, a query on the
  ///               surface may count as inside if rounding makes its computed distance differ from 0.
  [[nodiscard]] ClosestPoint nearest(const Vec3d& query) const;

  /// Returns the closest points to many queries, computed with threads. Each result is that of nearest(query), bit for
  /// bit, for any number of threads. If there are at least 4,096 queries, and no fewer queries than triangles, the
  /// queries are ordered in space and answered together. The first call with that many queries builds a search
  /// structure, which takes 0.5 us and 450 bytes per triangle. A later call uses the structure if the number of its
  /// queries is at least 1,024, and at least half the number of triangles.
  /// @throws InvalidOption with the index of the first query that is not finite or beyond the limits above.
  /// @throws Cancelled.
  [[nodiscard]] std::vector<ClosestPoint> nearest(std::span<const Vec3d> queries, const Context& context = {}) const;

  /// Finds the closest points to many queries and passes them to `use` as they are found, instead of returning a list.
  /// Calls use(found) once for each group of queries that lie close together. If the context has several threads,
  /// several of these calls may run at the same time. Each query is in exactly one group.
  /// @throws as nearest().
  void for_each_nearest(std::span<const Vec3d> queries, FunctionRef<void(std::span<const FoundPoint>)> use,
                        const Context& context = {}) const;

  /// Returns the gradient of the distance at a query, which has length 1. Off the surface, it is that of the function
  /// blum::gradient(). On the surface (within rounding) the distance grows in several directions. The result is then
  /// the normal of the closest site: that of the face, or the direction of the edge's or vertex's Pseudonormals. If
  /// warnings() reports triangles that face the wrong way, the normals are those of the reversed triangles.
  /// @param found  result of nearest(query).
  /// @return       nullopt if nothing was found, or if the site has no normal: segments, points, triangles without
  /// area. Cost: 0.01 us. The first query on the surface computes all normals, unless signs need them: O(triangles).
  [[nodiscard]] std::optional<Vec3d> gradient(const Vec3d& query, const ClosestPoint& found) const;

  /// Returns the gradient at each query, computed with threads.
  /// @param found  results of nearest(queries).
  /// @throws InvalidOption if the numbers of queries and results differ.
  /// @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<Vec3d>> gradients(std::span<const Vec3d> queries,
                                                            std::span<const ClosestPoint> found,
                                                            const Context& context = {}) const;

  /// Prepares for many batches of queries. The queries of a batch should lie close together. If `queries` is at least
  /// 4,096 and at least the number of triangles, this builds the structure that nearest() uses for many queries. Then
  /// each call of nearest() with at least 1,024 queries uses the structure. Results stay the same. Must not run at the
  /// same time as queries.
  /// @param queries  approximate number of queries in all batches together.
  /// @throws Cancelled.
  /// Cost: 0.5 us of one core per triangle.
  void prepare_for_many(std::size_t queries, const Context& context = {});

  /// Finds, for each query, the triangles, segments and points of the mesh that are within a distance of the query.
  /// Each primitive is returned with its point closest to the query. Distances are unsigned. The search uses threads.
  /// @param distance  mesh units, >= 0.
  /// If it is infinite, all primitives are found. ClosestPointOptions::max_distance
  ///                  limits the search, too.
  /// @throws InvalidOption, also for the queries that nearest() rejects.
  /// @throws Cancelled.
  /// Cost: one search for each query, and 50 ns for each primitive found.
  [[nodiscard]] NearPrimitives within(std::span<const Vec3d> queries, double distance,
                                      const Context& context = {}) const;

  /// Finds the k closest primitives of each query. For a query, fewer than k primitives are returned if fewer
  /// primitives lie within max_distance.
  /// @throws as within().
  /// Cost: as within().
  [[nodiscard]] NearPrimitives nearest_primitives(std::span<const Vec3d> queries, std::size_t k,
                                                  const Context& context = {}) const;

  /// Moves the vertices of the mesh. Afterwards, results equal those of a new query object for the moved mesh, bit for
  /// bit. Queries become slower if primitives that were neighbours move apart; construct a new object in this case.
  /// Must not run at the same time as queries.
  /// @param vertices  the new positions, one for each vertex of the mesh.
  /// @throws InvalidMesh. After InvalidMesh, the object is unchanged.
  /// @throws Cancelled. After Cancelled, refit() must be called again before any other function.
  /// Cost: O(n). For 100,000 triangles on two cores, refit() takes about 2 ms if distances are unsigned. If distances
  /// are signed, the rule for signs is also chosen again, which takes as long as in the constructor. The structure for
  /// many queries is discarded. The next call with many queries, or prepare_for_many(), builds it again.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// Return the rule that decides signs, and the reason for this rule (one sentence).
  [[nodiscard]] SignRule sign_rule() const;
  [[nodiscard]] const std::string& sign_reason() const;
  /// Returns at most one warning about the signs. WarningCode::facing: parts of the mesh face the wrong way. The list
  /// is empty if distances are unsigned.
  [[nodiscard]] const std::vector<Warning>& warnings() const;
  /// Returns true if the sign may change at points that are not on the surface. The sign may change with winding
  /// numbers if the mesh has a boundary, and with normals if shells cross each other.
  [[nodiscard]] bool sign_may_jump() const;

 private:
  struct Data;
  explicit ClosestPointQuery(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// Returns the closest point, its distance, site and triangle for every query. Results are exact, not interpolated from
/// a grid.
///
/// @param mesh     any soup of triangles, segments and points; must pass validate(mesh).
/// @param queries  finite.
/// @return         one entry per query, in the order of the queries; see ClosestPointQuery.
/// @throws InvalidMesh.
/// @throws InvalidOption, also for a query that is not finite, or beyond the limits of ClosestPointQuery::nearest().
/// The message contains the index of the query.
/// @throws Cancelled.
/// Cost: O(n log n) for n primitives, then one search per query. The following times of a search on one core were
/// measured with 70,000 triangles. With a million queries, a search takes 0.2 us near the surface, and 0.3 us anywhere
/// in the mesh's box. With fewer queries than triangles, a search takes 0.7 us if each query is near the previous
/// query, along the surface. If the queries are in random order, a search takes 1.4 us near the surface, and 7 us
/// anywhere in the box. Where many sites are nearly equally close, a search takes up to 20 us. Computing the sign adds
/// up to a third of this time for closed meshes, and 0.2 to 0.4 us for open meshes. For soups, computing the sign takes
/// as long as computing a winding number. Method: docs/theory/closest-points.md.
[[nodiscard]] std::vector<ClosestPoint> closest_points(const MeshView& mesh, std::span<const Vec3d> queries,
                                                       const ClosestPointOptions& options = {},
                                                       const Context& context = {});

}  // namespace blum
