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

/// The generalized winding number w of the triangles of a mesh: the sum of their signed solid angles over 4 pi
/// (Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation", 2013). 1 inside a closed surface that faces
/// outwards, 0 outside, a harmonic function between for open surfaces and soups. Inside means w > 1/2.
///
/// Clusters of triangles far away are replaced by the first three terms of their multipole series (Barill, Dickson,
/// Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds", 2018), here with a bound on the rest of the
/// series, so that decisions are those of the full sum.
///
/// All member functions may be called from many threads at once and allocate nothing. Queries must be finite. At points
/// of the surface itself w jumps, and any value of the jump may come back. The mesh may go away after construction.
class WindingNumber {
 public:
  /// @param mesh  must pass validate(mesh). Segments and points have no winding number and are left out.
  /// @throws InvalidMesh (more sites than ids), Cancelled.
  /// Cost: O(n log n), about 12 ms for 70,000 triangles on two cores; 100 bytes per triangle.
  explicit WindingNumber(const MeshView& mesh, const Context& context = {});
  /// The same with the mesh's table of sites at hand.
  WindingNumber(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;
  ~WindingNumber();

  /// The full sum, good to about 1e-12. Cost: O(triangles), about 3 ns for each.
  [[nodiscard]] double operator()(const Vec3d& query) const;

  /// The hierarchical sum without a guarantee: a cluster of radius r is replaced by its series beyond beta r.
  /// @param beta  > 1; 2 gives errors of about 1e-3. Cost: O(log n).
  [[nodiscard]] double approximate(const Vec3d& query, double beta = 2) const;

  /// Whether w > 1/2, as the full sum decides it: the hierarchy is refined until its error bound excludes 1/2, and
  /// where it never does (|w - 1/2| < 1e-9 or so) the full sum is taken. Cost: O(log n) on average, about 1 us for
  /// 70,000 triangles.
  [[nodiscard]] bool is_inside(const Vec3d& query) const;

  /// A side, and how far w lies at least from 1/2 there: all points that a path joins to the query lie on it, where the
  /// path crosses no triangle and w changes along it by less.
  struct Decision {
    bool is_inside = false;
    double margin = 0;  ///< 0 where rounding alone may make a difference
  };
  /// The same as is_inside(), told with its margin.
  /// @param distance  of the query from the triangles, mesh units: rounding may do more to solid angles the closer they
  ///                  are, about 1e-15 of the coordinates over the distance. Where that leaves no margin, the full sum
  ///                  decides, as it is rounded.
  [[nodiscard]] Decision decide(const Vec3d& query, double distance) const;
  /// What rounding may do to w at a distance from the triangles.
  [[nodiscard]] double rounding_at(const Vec3d& query, double distance) const;

  /// A value and a bound on its error.
  struct Estimate {
    double value = 0;
    double error = 0;
  };
  /// w with an error bound of at most about max_error (at least 1e-12). Cost for 70,000 triangles, in us: 1 to 3 where
  /// max_error is 0.45, 10 to 30 at 0.01, 30 to 60 at 1e-3, 230 to 280 at 1e-6.
  [[nodiscard]] Estimate estimate(const Vec3d& query, double max_error) const;

  /// w, exact from a rough value: a cone over the surface's boundary closes it, so that w is a whole number less the
  /// winding number of the cone, which is summed in full. Of a closed mesh it is the whole number next to the rough
  /// one.
  /// @param rough  off by less than rough_error.
  /// @return       off by no more than refined_error, of a closed mesh exact; nullopt where the boundary has more than
  ///               2,048 edges, and where the query is too close to the boundary or to an edge of the cone.
  /// Cost: O(edges of the boundary), about 3 ns for each.
  [[nodiscard]] std::optional<double> refine(const Vec3d& query, double rough) const;
  static constexpr double rough_error = 0.45;
  static constexpr double refined_error = 1e-9;
  /// Whether refine() is of any use.
  [[nodiscard]] bool has_short_boundary() const;

  /// w by the quickest way to a bound on its error: refine() where that works, the full sum of few triangles, else
  /// estimate().
  [[nodiscard]] Estimate value(const Vec3d& query, double max_error) const;

  /// Whether w > 1/2, where w differs from 1/2 by more than `change` (which an argument about its gradient gives);
  /// nullopt where it may not. With change = 0 the same as is_inside(), up to nullopt where w is 1/2 to rounding.
  [[nodiscard]] std::optional<bool> side(const Vec3d& query, double change) const;

  /// The side of a whole box: whether w > 1/2 at all of its points, or at none; nullopt where that cannot be shown, and
  /// where the box may touch a triangle. Conservative: an answer is always right.
  /// Method: away from the surface the gradient of w is the Biot-Savart field of the surface's boundary, so w cannot
  /// change by more than the box's half-diagonal times gradient_bound() between the centre and a point of the box.
  [[nodiscard]] std::optional<bool> uniform_side(const Box3& box) const;

  /// A bound on the length of the gradient of w over a box (which may be a point), where it exists: w jumps at the
  /// surface, and between two points the bound holds along paths that cross none. In 1 / mesh units; infinite where the
  /// box touches the boundary; 0 for closed meshes.
  /// @param enough  where the bound is above this, any number above it may be given: that takes less time.
  [[nodiscard]] double gradient_bound(const Box3& box, double enough = HUGE_VAL) const;

  /// Whether w is constant wherever no triangle lies between: triangles meet at every edge in cancelling directions
  /// (edges are compared by the positions of their ends), so that w is an integer off the surface.
  [[nodiscard]] bool is_piecewise_constant() const;

  /// How many triangles there are.
  [[nodiscard]] std::size_t triangle_count() const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace blum
