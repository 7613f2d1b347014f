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
  /// How the sign is found, by the same rule as for fields. `none` is cheapest.
  SignMode sign = SignMode::automatic;
  /// Nothing further than this is looked for; >= 0, in mesh units. Unset: no limit.
  std::optional<double> max_distance = {};
};

template <>
struct Description<ClosestPointOptions> {
  static constexpr std::string_view name = "ClosestPointOptions";
  static constexpr std::string_view doc = "What closest points are asked for";
  static constexpr std::tuple members{
      Member{"sign", &ClosestPointOptions::sign, "",
             "how the sign is found, by the same rule as for fields; 'none' is cheapest"},
      Member{"max_distance", &ClosestPointOptions::max_distance, "mesh units",
             "nothing further than this is looked for", Range::at_least(0)},
  };
};

/// The point of a mesh that is closest to a query.
struct ClosestPoint {
  Vec3d point;          ///< on the mesh; the query itself where nothing lies within max_distance
  double distance = 0;  ///< mesh units, negative inside when signed; infinite where nothing lies within max_distance
  SiteId site;          ///< the vertex, open edge or open face that the point lies on, numbered as SiteTable says
  TriangleId triangle;  ///< the smallest triangle that the site lies on; none() on free segments and points
};

/// The unit vector in which the signed distance grows: away from the surface outside, towards it inside. On the medial
/// axis it is one of several. nullopt on the surface (where rounding would tell), and where nothing was found.
[[nodiscard]] std::optional<Vec3d> gradient(const Vec3d& query, const ClosestPoint& found);

/// Weights of the corners of `found.triangle`, in their order, of which the closest point is the mean: each >= 0, their
/// sum 1 but for rounding; 1 at a vertex that the point lies on, 0 at the others.
/// @param mesh  that was asked. @return  nullopt where the point lies on no triangle.
[[nodiscard]] std::optional<std::array<double, 3>> barycentric(const MeshView& mesh, const ClosestPoint& found);

/// What is closest to one of several queries.
struct FoundPoint {
  std::size_t query = 0;  ///< its index
  Vec3d point;            ///< as in ClosestPoint, like the others
  double distance = 0;
  SiteId site;
};

/// What several queries found each: entries first[q] ... first[q + 1] - 1 of query q, by rising distance, then
/// primitive.
struct NearPrimitives {
  std::vector<std::size_t> first{0};  ///< one more than queries
  std::vector<NearestPrimitive> found;
};

/// Answers closest-point queries on one mesh. It copies what it needs; the mesh may go away.
class ClosestPointQuery {
 public:
  /// @throws InvalidMesh, InvalidOption, Cancelled.
  /// Cost: O(n log n), about 80 ms for 70,000 triangles on two cores, 30 ms unsigned, and more where winding
  /// numbers are needed.
  explicit ClosestPointQuery(const MeshView& mesh, const ClosestPointOptions& options = {},
                             const Context& context = {});
  ClosestPointQuery(ClosestPointQuery&&) noexcept;
  ClosestPointQuery& operator=(ClosestPointQuery&&) noexcept;
  ~ClosestPointQuery();

  /// One query. May be called from many threads at once; allocates nothing.
  /// @param query  finite, within 1e140 times the mesh's longest side, or 1e140 where that is longer than 1 (else the
  ///               result has no site).
  /// @return       a distance within about 1e-15 of exact, relative to the extent of mesh and query together. Of
  ///               several sites at the same computed distance the one with the smallest id. A query on the surface is
  ///               not inside; of an open mesh, where its computed distance is not 0 but for rounding, it may be.
  [[nodiscard]] ClosestPoint nearest(const Vec3d& query) const;

  /// Many queries, threaded. The same results as nearest(), bit for bit, for any number of threads. Where there are as
  /// many as the mesh has triangles, and 4,096 or more, they are ordered in space and looked at together; the first
  /// such call builds what that needs, 0.5 us and 450 bytes per triangle.
  /// @throws InvalidOption naming the first query that is not finite or too far away; Cancelled.
  [[nodiscard]] std::vector<ClosestPoint> nearest(std::span<const Vec3d> queries, const Context& context = {}) const;

  /// The same, told as it is found instead of kept: calls use(found) for groups of queries that lie close together,
  /// from several threads at once where the context has them. Over all groups each query is told once.
  /// @throws as nearest().
  void for_each_nearest(std::span<const Vec3d> queries, FunctionRef<void(std::span<const FoundPoint>)> use,
                        const Context& context = {}) const;

  /// Tells that many queries will come in batches, each of which lie close together: where there will be as many as the
  /// mesh has triangles, and 4,096 or more, what they need is built now, and calls of nearest() with 1,024 queries or
  /// more use it from then on. Answers are the same. Must not run beside queries.
  /// @param queries  over all batches, about. @throws Cancelled. Cost: 0.5 us per triangle and core.
  void prepare_for_many(std::size_t queries, const Context& context = {});

  /// The triangles, segments and points of the mesh within a distance of each query, threaded, each with its closest
  /// point. Distances are without sign.
  /// @param distance  mesh units, >= 0; infinite for all. max_distance limits it, too.
  /// @throws InvalidOption, also as nearest(); Cancelled.  Cost: a search for each query, and 50 ns for each entry.
  [[nodiscard]] NearPrimitives within(std::span<const Vec3d> queries, double distance,
                                      const Context& context = {}) const;

  /// The k closest of them (fewer, where there are fewer, or fewer within max_distance).
  /// @throws as within(). Cost: as within().
  [[nodiscard]] NearPrimitives nearest_primitives(std::span<const Vec3d> queries, std::size_t k,
                                                  const Context& context = {}) const;

  /// The same mesh after its vertices moved. Answers are, bit for bit, those of a new query; they take longer as
  /// neighbours move apart, then make a new one. Must not run beside queries.
  /// @param vertices  as many as the mesh has.
  /// @throws InvalidMesh (then nothing has changed); Cancelled, after which only another refit may follow.
  /// Cost: O(n), unsigned about 2 ms for 100,000 triangles on two cores. Signs are planned anew, which takes as long as
  /// in a new query. What many queries at once need is built by the next that do,
  /// or by prepare_for_many().
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// How signs are found, and why (one sentence).
  [[nodiscard]] SignRule sign_rule() const;
  [[nodiscard]] const std::string& sign_reason() const;
  /// Whether the sign may change off the surface, where the distance is not 0: by winding numbers of meshes with a
  /// boundary, and by normals of shells that cross each other.
  [[nodiscard]] bool sign_may_jump() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The closest point, its distance, site and triangle for every query; exact, not interpolated from a grid.
///
/// @param mesh     any soup of triangles, segments and points; it must pass validate(mesh).
/// @param queries  finite.
/// @return         one entry per query, in their order; see ClosestPointQuery.
/// @throws InvalidMesh; InvalidOption, also for a query that is not finite (named by its index); Cancelled.
/// Cost: O(n log n) for n primitives; then per query and core, measured with 70,000 triangles and a million queries,
/// 0.2 us near the surface and 0.3 us all over the mesh's box. Of fewer queries than triangles, each takes 0.7 us near
/// the surface where they follow each other along it, 1.4 us near it in any order, 7 us all over the box, and up to 20
/// us where many sites are nearly equally close. Signs of closed meshes add up to a third, those of open ones
/// 0.2 to 0.4 us, in soups a winding number each. Method: docs/theory/closest-points.md.
[[nodiscard]] std::vector<ClosestPoint> closest_points(const MeshView& mesh, std::span<const Vec3d> queries,
                                                       const ClosestPointOptions& options = {},
                                                       const Context& context = {});

}  // namespace blum
