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
  std::uint32_t primitive = 0;  ///< index
};

/// Some leaves of a hierarchy. See Bvh::part_in().
class BvhPart {
 private:
  friend class Bvh;
  struct Leaves {
    std::uint32_t block = 0;  ///< number of a block of eight consecutive leaves
    std::uint32_t bits = 0;   ///< those of them that belong to the part
  };
  std::vector<Leaves> leaves_;
};

/// Crossing of a ray and a triangle. Its existence, `side` and `on_border` are exact.
struct RayCrossing {
  double t = 0;  ///< the point is origin + t * direction; >= 0
  TriangleId triangle;
  std::array<double, 3> weights{};  ///< barycentric, in the order of the triangle's corners; their sum is 1
  int side = 0;                     ///< 1 if the ray leaves through the side that the triangle faces, -1 if it enters
  bool on_border = false;           ///< on an edge or corner, where the ray meets neighbouring triangles, too
};

/// Bounding-volume hierarchy over the triangles, segments and points of a mesh, with eight children per node and eight
/// primitives per leaf. It copies the data it needs, so the mesh may be destroyed. BoxBvh is the hierarchy for boxes
/// alone.
///
/// All queries may run on many threads at once. Queries that return no list allocate nothing. Distances are exact up to
/// rounding, about 1e-15 of the extent of mesh and query together. Queries must be finite, and within 1e140 times the
/// mesh's longest side. Others find nothing.
///
/// Cost: O(n) to build. That takes about 15 ms for 70,000 triangles and 0.4 s for 1.6 million, on two cores; 135 bytes
/// per primitive.
class Bvh {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// @throws Cancelled.
  Bvh(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;
  ~Bvh();

  /// Updates the hierarchy to moved vertices of the same primitives. Answers are, bit for bit, those of a newly built
  /// hierarchy; only the order of visits differs. Queries get slower as neighbours move apart; then build a new
  /// hierarchy. Must not run at the same time as queries.
  /// @param vertices  as many as the mesh had. Those that the mesh names must be finite, of magnitude at most 1e150.
  /// @throws InvalidMesh if the number differs or a named vertex is out of range; Cancelled. After Cancelled, only
  /// another refit may follow. Cost: O(n), about a fifth of building.
  void refit(std::span<const Vec3d> vertices, const Context& context = {});

  /// Returns the closest site. Among sites at the same computed distance it is the one with the smallest id.
  /// @param max_distance  mesh units; farther sites are not found.
  /// @return              nullopt if no site lies within max_distance, or if the query is out of its range.
  /// Cost: about O(log n) near the surface; more if many sites are nearly equally close.
  [[nodiscard]] std::optional<NearestSite> nearest(const Vec3d& query,
                                                   double max_distance = std::numeric_limits<double>::infinity()) const;
  /// Returns the closest sites of many queries, computed with threads. @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<NearestSite>> nearest(
      std::span<const Vec3d> queries, double max_distance = std::numeric_limits<double>::infinity(),
      const Context& context = {}) const;

  /// Returns the closest of the wanted primitives. Among primitives at the same computed distance it is the first.
  /// @param is_wanted  asked about primitives that may be closer than those found before; maybe several times for one.
  [[nodiscard]] std::optional<NearestPrimitive> nearest_wanted(
      const Vec3d& query, FunctionRef<bool(std::uint32_t)> is_wanted,
      double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Returns the k closest primitives by rising distance, then index. Fewer are returned if fewer lie within
  /// max_distance.
  [[nodiscard]] std::vector<NearestPrimitive> nearest_primitives(
      const Vec3d& query, std::size_t k, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Calls visit(primitive) for the primitives within a distance of a query, until it returns false. The order is
  /// unspecified.
  void for_each_within(const Vec3d& query, double distance, FunctionRef<bool(const NearestPrimitive&)> visit) const;
  /// Returns all these primitives by rising distance, then index.
  [[nodiscard]] std::vector<NearestPrimitive> within(const Vec3d& query, double distance) const;

  /// Calls limit = visit(crossing) for the triangles that a ray crosses between t = 0 and limit. Closer ones come
  /// first, as far as the hierarchy orders them. A visitor that lowers the limit ends the search early. Triangles are
  /// closed: at an edge, all triangles that share it are found. Triangles whose plane contains the ray are not found,
  /// and neither are triangles without area.
  void for_each_crossing(const Ray& ray, double limit, FunctionRef<double(const RayCrossing&)> visit) const;
  /// Returns all crossings up to t = limit, by rising t, then triangle.
  [[nodiscard]] std::vector<RayCrossing> crossings(const Ray& ray,
                                                   double limit = std::numeric_limits<double>::infinity()) const;
  /// Returns the first of these crossings.
  [[nodiscard]] std::optional<RayCrossing> first_crossing(const Ray& ray,
                                                          double limit = std::numeric_limits<double>::infinity()) const;
  /// Returns the first crossings of many rays, computed with threads. @throws Cancelled.
  [[nodiscard]] std::vector<std::optional<RayCrossing>> first_crossings(
      std::span<const Ray> rays, double limit = std::numeric_limits<double>::infinity(),
      const Context& context = {}) const;

  /// Returns the leaves of the hierarchy that touch a box. With them, many short queries in the same small region are
  /// faster. The part must not be used after refit(). @return  nullopt if too many leaves touch the box for a gain.
  [[nodiscard]] std::optional<BvhPart> part_in(const Box3& box) const;
  /// Returns first_crossing() up to t = 1, for a ray whose points up to there lie in the box of a part.
  [[nodiscard]] std::optional<RayCrossing> first_crossing(const Ray& ray, const BvhPart& part) const;
  /// Works as for_each_near() below, for a triangle in the box of a part.
  void for_each_near(const std::array<Vec3d, 3>& triangle, const BvhPart& part,
                     FunctionRef<bool(TriangleId)> visit) const;

  /// Calls visit(triangle) for the triangles of the mesh that may have a common point with a given triangle, until it
  /// returns false. The given triangle need not belong to the mesh; the order is unspecified. No triangle with a common
  /// point is left out. Most others are: those whose boxes do not touch, and pairs in which one lies on one side of the
  /// other's plane.
  void for_each_near(const std::array<Vec3d, 3>& triangle, FunctionRef<bool(TriangleId)> visit) const;

  /// Returns true if the box of a primitive may touch this box. If false, this box is free of the mesh.
  [[nodiscard]] bool may_touch(const Box3& box) const;

  /// Returns all primitives in the order of the leaves. Every aligned run of 8, 64, 512, ... of them lay in a compact
  /// box of its own when the hierarchy was built.
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
