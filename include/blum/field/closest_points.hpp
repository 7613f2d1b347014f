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
#include "blum/field/field.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct ClosestPointOptions {
  /// Method for the sign, with the same rules as for fields. `none` is the cheapest.
  SignMode sign = SignMode::automatic;
  /// Largest distance that is searched; >= 0, in mesh units. Unset: no limit.
  std::optional<double> max_distance = {};
};

template <>
struct Description<ClosestPointOptions> {
  static constexpr std::string_view name = "ClosestPointOptions";
  static constexpr std::string_view doc = "Options of closest points";
  static constexpr std::tuple members{
      Member{"sign", &ClosestPointOptions::sign, "", "rule for the sign, as for fields; 'none' is cheapest"},
      Member{"max_distance", &ClosestPointOptions::max_distance, "mesh units", "largest distance that is searched",
             Range::at_least(0)},
  };
};

/// Point of a mesh that is closest to a query.
struct ClosestPoint {
  Vec3d point;          ///< on the mesh; the query itself if nothing lies within max_distance
  double distance = 0;  ///< mesh units, negative inside when signed; infinite if nothing lies within max_distance
  SiteId site;          ///< vertex, open edge or open face that contains the point, numbered as in SiteTable
  TriangleId triangle;  ///< smallest triangle that contains the site; none() on free segments and points
};

/// Returns the unit vector in which the signed distance grows: away from the surface outside, towards it inside. On the
/// medial axis it is one of several such vectors. Returns nullopt on the surface, within rounding, and if nothing was
/// found.
[[nodiscard]] std::optional<Vec3d> gradient(const Vec3d& query, const ClosestPoint& found);

/// Returns the weights of the corners of `found.triangle`, in their order. The closest point is the weighted mean of
/// the corners. Each weight is at least 0, and their sum is 1 within rounding. If the point lies on a vertex, that
/// weight is 1 and the others are 0.
/// @param mesh  mesh of the query.
/// @return      nullopt if the point lies on no triangle.
[[nodiscard]] std::optional<std::array<double, 3>> barycentric(const MeshView& mesh, const ClosestPoint& found);

/// Closest point of one of several queries.
struct FoundPoint {
  std::size_t query = 0;  ///< index of the query
  Vec3d point;            ///< like the other members: as in ClosestPoint
  double distance = 0;
  SiteId site;
};

/// Primitives found by several queries. Those of query q are entries first[q] ... first[q + 1] - 1, by rising distance,
/// then primitive.
struct NearPrimitives {
  std::vector<std::size_t> first{0};  ///< one more entry than queries
  std::vector<NearestPrimitive> found;
};

/// Answers closest-point queries on one mesh. It copies what it needs, so the mesh need not outlive it.
class ClosestPointQuery {
 public:
  /// @throws InvalidMesh, InvalidOption, Cancelled.
  /// Cost: O(n log n). For 70,000 triangles on two cores about 80 ms, unsigned 30 ms, and more if winding numbers are
  /// needed.
  explicit ClosestPointQuery(const MeshView& mesh, const ClosestPointOptions& options = {},
                             const Context& context = {});
  ClosestPointQuery(ClosestPointQuery&&) noexcept;
  ClosestPointQuery& operator=(ClosestPointQuery&&) noexcept;
  ~ClosestPointQuery();

  /// Answers one query. It may be called from many threads at once, and allocates nothing.
  /// @param query  finite. Coordinates must be at most 1e140, and at most 1e140 times the longest side of the mesh's
  ///               box (unless that is 0). Else the result has no site.
  /// @return       a distance within about 1e-15 of exact, relative to the extent of mesh and query together. Among
  ///               sites at the same computed distance, the one with the smallest id is returned. A query on the
  ///               surface is not inside. With an open mesh it may be, if rounding makes its computed distance differ
  ///               from 0.
  [[nodiscard]] ClosestPoint nearest(const Vec3d& query) const;

  /// Answers many queries, threaded. Results are those of nearest(), bit for bit, for any number of threads. Queries
  /// are ordered in space and answered together if they are at least 4,096 and at least as many as the mesh has
  /// triangles. The first such call builds a structure for this, which takes 0.5 us and 450 bytes per triangle. Later
  /// calls use it if they have at least 1,024 queries, and at least half as many as the mesh has triangles.
  /// @throws InvalidOption that names the first query that is not finite or too far away.
  /// @throws Cancelled.
  [[nodiscard]] std::vector<ClosestPoint> nearest(std::span<const Vec3d> queries, const Context& context = {}) const;

  /// Answers many queries and reports the results as they are found, instead of keeping them. Calls use(found) for
  /// groups of queries that lie close together, from several threads at once if the context has them. Each query is in
  /// exactly one group.
  /// @throws as nearest().
  void for_each_nearest(std::span<const Vec3d> queries, FunctionRef<void(std::span<const FoundPoint>)> use,
                        const Context& context = {}) const;

  /// Announces that many queries will come in batches, each of queries that lie close together. The structure of
  /// nearest() is built now if the queries are at least 4,096 and at least as many as the mesh has triangles. From then
  /// on, calls of nearest() with 1,024 queries or more use it. Answers stay the same. Must not run beside queries.
  /// @param queries  approximate number of queries over all batches.
  /// @throws Cancelled.
  /// Cost: 0.5 us per triangle and core.
  void prepare_for_many(std::size_t queries, const Context& context = {});

  /// Finds the triangles, segments and points of the mesh within a distance of each query, threaded, each with its
  /// closest point. Distances are unsigned.
  /// @param distance  mesh units, >= 0; infinite: all of them. max_distance limits it, too.
  /// @throws InvalidOption, also as nearest().
  /// @throws Cancelled.
  /// Cost: one search for each query, and 50 ns for each entry.
  [[nodiscard]] NearPrimitives within(std::span<const Vec3d> queries, double distance,
                                      const Context& context = {}) const;

  /// Finds the k closest primitives of each query. There are fewer if the mesh has fewer within max_distance.
  /// @throws as within().
  /// Cost: as within().
  [[nodiscard]] NearPrimitives nearest_primitives(std::span<const Vec3d> queries, std::size_t k,
                                                  const Context& context = {}) const;

  /// Moves the vertices of the mesh. Answers are, bit for bit, those of a new query object. They take longer as
  /// neighbours move apart; make a new object then. Must not run beside queries.
  /// @param vertices  as many as the mesh has.
  /// @throws InvalidMesh; nothing has changed then.
  /// @throws Cancelled; only another refit may follow then.
  /// Cost: O(n), unsigned about 2 ms for 100,000 triangles on two cores. Signs are planned anew, which takes as long as
  /// in a new query object. The structure for many queries is discarded. The next call with many queries, or
  /// prepare_for_many(), builds it again.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// Returns the rule that decides signs, and the reason for it (one sentence).
  [[nodiscard]] SignRule sign_rule() const;
  [[nodiscard]] const std::string& sign_reason() const;
  /// Returns true if the sign may change off the surface, at distances other than 0. This happens with winding numbers
  /// of meshes with a boundary, and with normals of shells that cross each other.
  [[nodiscard]] bool sign_may_jump() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Returns the closest point, its distance, site and triangle for every query. Results are exact, not interpolated from
/// a grid.
///
/// @param mesh     any soup of triangles, segments and points; must pass validate(mesh).
/// @param queries  finite.
/// @return         one entry per query, in their order; see ClosestPointQuery.
/// @throws InvalidMesh.
/// @throws InvalidOption, also for a query that is not finite or too far away; the message names its index.
/// @throws Cancelled.
/// Cost: O(n log n) for n primitives, then a search per query. Times per query and core were measured with 70,000
/// triangles. With a million queries they are 0.2 us near the surface and 0.3 us all over the mesh's box. With fewer
/// queries than triangles, each takes 0.7 us if they follow each other along the surface. Near the surface in any order
/// it takes 1.4 us, all over the box 7 us. It takes up to 20 us where many sites are nearly equally close. Signs of
/// closed meshes add up to a third, signs of open ones 0.2 to 0.4 us. In soups each sign takes a winding number.
/// Method: docs/theory/closest-points.md.
[[nodiscard]] std::vector<ClosestPoint> closest_points(const MeshView& mesh, std::span<const Vec3d> queries,
                                                       const ClosestPointOptions& options = {},
                                                       const Context& context = {});

}  // namespace blum
