// Blum: generalized winding numbers of triangle soups. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Generalized winding number w of the triangles of a mesh: the sum of their signed solid angles, divided by 4 pi. See
/// Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation", 2013. For a closed surface that faces
/// outwards, w is 1 inside and 0 outside. For open surfaces and soups, w need not be a whole number. Away from the
/// triangles, w varies smoothly (w is harmonic). A point is inside if w > 1/2.
///
/// Clusters of distant triangles are replaced by the first three terms of their multipole series. See Barill, Dickson,
/// Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds", 2018. This class bounds the error of the
/// series, so is_inside() returns the same result as the full sum.
///
/// All member functions may be called from many threads at once, and allocate no memory. Queries must be finite. At a
/// point of the surface, w jumps, and any value between the values on the two sides may be returned. The mesh may be
/// destroyed after construction.
class WindingNumber {
 public:
  /// @param mesh  must pass validate(mesh). The mesh's segments and points have no winding number and are ignored.
  /// @throws InvalidMesh, also if the mesh has more than max_id_count sites; Cancelled.
  /// Cost: O(n log n) time for n triangles, about 12 ms for 70,000 on two cores, and 100 bytes per triangle.
  explicit WindingNumber(const MeshView& mesh, const Context& context = {});
  /// Constructs the same object, but uses a given table of the mesh's sites.
  WindingNumber(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;
  ~WindingNumber();

  /// Returns w as the full sum over all triangles, with an error of about 1e-12. Cost: O(triangles), about 3 ns per
  /// triangle.
  [[nodiscard]] double operator()(const Vec3d& query) const;

  /// Returns an approximation of w without an error bound. A cluster of radius r is replaced by its series if its
  /// distance from the query is more than beta r.
  /// @param beta  > 1; 2 gives errors of about 1e-3. Cost: O(log n).
  [[nodiscard]] double approximate(const Vec3d& query, double beta = 2) const;

  /// Returns true if w > 1/2, with the same result as the full sum. The hierarchy is refined until the error bound
  /// excludes w = 1/2. If refining does not exclude w = 1/2 (if |w - 1/2| is below about 1e-9), the full sum is
  /// computed. Cost: O(log n) on average, about 1 us for 70,000 triangles.
  [[nodiscard]] bool is_inside(const Vec3d& query) const;

  /// Side of a query (inside or outside), and a lower bound on |w - 1/2| at the query. If a path from the query crosses
  /// no triangle, and w changes by less than `margin` along it, the path stays on the query's side.
  struct Decision {
    bool is_inside = false;
    double margin = 0;  ///< 0 if rounding alone may change the side
  };
  /// Returns the side that is_inside() returns, and the margin.
  /// @param distance  distance of the query from the triangles, mesh units. Rounding may change solid angles by about
  /// 1e-15 times the coordinates divided by this distance. If no margin is left, the rounded full sum decides.
  [[nodiscard]] Decision decide(const Vec3d& query, double distance) const;
  /// Returns the amount by which rounding may change w at a given distance from the triangles.
  [[nodiscard]] double rounding_at(const Vec3d& query, double distance) const;

  /// Value of w, and a bound on its error.
  struct Estimate {
    double value = 0;
    double error = 0;
  };
  /// Returns w with an error bound of at most max_error or 1e-11, whichever is larger.
  ///
  /// Cost for 70,000 triangles: 1 to 3 us if max_error is 0.45, and 10 to 30 us if it is 0.01. The cost is 30 to 60 us
  /// if max_error is 1e-3, and 230 to 280 us if it is 1e-6.
  [[nodiscard]] Estimate estimate(const Vec3d& query, double max_error) const;

  /// Returns a precise value of w, computed from a rough value. A cone over the boundary of the surface closes the
  /// surface. So w is a whole number minus the winding number of the cone. The winding number of the cone is summed
  /// over all of its triangles. For a closed mesh, w is the whole number closest to the rough value.
  /// @param rough  a value of w with an error below rough_error.
  /// @return       w with an error of at most refined_error; exact for a closed mesh. Returns nullopt if the boundary
  /// has more than 2,048 edges. Also returns nullopt if the query is too close to the boundary or to an edge of the
  /// cone.
  /// Cost: O(edges of the boundary), about 3 ns per edge.
  [[nodiscard]] std::optional<double> refine(const Vec3d& query, double rough) const;
  static constexpr double rough_error = 0.45;
  static constexpr double refined_error = 1e-9;
  /// Returns true if the boundary has at most 2,048 edges, so that refine() can return a value.
  [[nodiscard]] bool has_short_boundary() const;

  /// Returns w and a bound on its error, by the fastest method. The method is refine() if refine() returns a value.
  /// Otherwise, the method is the full sum if the mesh has few triangles, and estimate() if it has many.
  [[nodiscard]] Estimate value(const Vec3d& query, double max_error) const;

  /// Returns nullopt if |w - 1/2| may be at most `change`. Otherwise, returns true if w > 1/2, and false if w < 1/2. If
  /// a side is returned, every point whose w is within `change` of w at the query has the same side. A bound on the
  /// gradient of w can supply `change`. With change = 0, the result is that of is_inside(); only if w is 1/2 up to
  /// rounding, it is nullopt.
  [[nodiscard]] std::optional<bool> side(const Vec3d& query, double change) const;

  /// Returns the side of a whole box: true if w > 1/2 at all points of the box, false if w <= 1/2 at all points.
  /// Returns nullopt if neither side is proven, or if the box may touch a triangle. A returned side is always correct.
  /// Method: away from the surface, the gradient of w is the Biot-Savart field of the surface's boundary. So between
  /// the centre and a point of the box, w changes by at most the half-diagonal times gradient_bound().
  [[nodiscard]] std::optional<bool> uniform_side(const Box3& box) const;

  /// Returns an upper bound on the length of the gradient of w in a box, which may be a point. The unit is 1 / mesh
  /// units. Because w jumps at the surface, the bound limits the change of w only along paths that cross no triangle.
  /// The bound is infinite if the box touches the boundary of the surface, and 0 for closed meshes.
  /// @param enough  if the bound is above `enough`, any number above `enough` may be returned instead, which takes less
  ///                time.
  [[nodiscard]] double gradient_bound(const Box3& box, double enough = HUGE_VAL) const;

  /// Returns true if w is constant along paths that cross no triangle: if triangles traverse every edge equally often
  /// in both directions. If so, w is an integer at all points that are not on the surface. Edges with ends at the same
  /// positions count as the same edge.
  [[nodiscard]] bool is_piecewise_constant() const;

  /// Returns the number of triangles.
  [[nodiscard]] std::size_t triangle_count() const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace blum
