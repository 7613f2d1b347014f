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
/// outwards, w is 1 inside and 0 outside. For open surfaces and soups it is a harmonic function in between. Inside
/// means w > 1/2.
///
/// Clusters of distant triangles are replaced by the first three terms of their multipole series. See Barill, Dickson,
/// Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds", 2018. Here the rest of the series is bounded,
/// so that decisions are those of the full sum.
///
/// All member functions may be called from many threads at once and allocate nothing. Queries must be finite. On the
/// surface itself w jumps, and any value of the jump may be returned. The mesh may be destroyed after construction.
class WindingNumber {
 public:
  /// @param mesh  must pass validate(mesh). Its segments and points have no winding number and are left out.
  /// @throws InvalidMesh (more sites than ids), Cancelled.
  /// Cost: O(n log n), about 12 ms for 70,000 triangles on two cores; 100 bytes per triangle.
  explicit WindingNumber(const MeshView& mesh, const Context& context = {});
  /// Constructs the same from the mesh's table of sites.
  WindingNumber(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;
  ~WindingNumber();

  /// Returns the full sum, with an error of about 1e-12. Cost: O(triangles), about 3 ns each.
  [[nodiscard]] double operator()(const Vec3d& query) const;

  /// Returns the hierarchical sum without a guarantee: a cluster of radius r is replaced by its series beyond beta r.
  /// @param beta  > 1; 2 gives errors of about 1e-3. Cost: O(log n).
  [[nodiscard]] double approximate(const Vec3d& query, double beta = 2) const;

  /// Returns true if w > 1/2, as the full sum decides it. The hierarchy is refined until its error bound excludes 1/2.
  /// If it never does (|w - 1/2| < 1e-9 or so), the full sum is taken. Cost: O(log n) on average, about 1 us for 70,000
  /// triangles.
  [[nodiscard]] bool is_inside(const Vec3d& query) const;

  /// Side of a query, and a lower bound on |w - 1/2| there. A path from the query stays on this side if it crosses no
  /// triangle and w changes along it by less than `margin`.
  struct Decision {
    bool is_inside = false;
    double margin = 0;  ///< 0 if rounding alone may change the side
  };
  /// Returns the same side as is_inside(), with its margin.
  /// @param distance  distance of the query from the triangles, mesh units. The closer triangles are, the more rounding
  /// may change solid angles: by about 1e-15 of the coordinates over the distance. If that leaves no margin, the
  /// rounded full sum decides.
  [[nodiscard]] Decision decide(const Vec3d& query, double distance) const;
  /// Returns the amount by which rounding may change w at a given distance from the triangles.
  [[nodiscard]] double rounding_at(const Vec3d& query, double distance) const;

  /// Value and a bound on its error.
  struct Estimate {
    double value = 0;
    double error = 0;
  };
  /// Returns w with an error bound of at most max_error, or 1e-11 if that is larger.
  ///
  /// Cost for 70,000 triangles: 1 to 3 us if max_error is 0.45, and 10 to 30 us if it is 0.01. At 1e-3 it is 30 to 60
  /// us, at 1e-6 230 to 280 us.
  [[nodiscard]] Estimate estimate(const Vec3d& query, double max_error) const;

  /// Returns w from a rough value. A cone over the surface's boundary closes the surface. So w is a whole number minus
  /// the winding number of the cone, which is summed in full. For a closed mesh it is the whole number closest to the
  /// rough value.
  /// @param rough  off by less than rough_error.
  /// @return       off by at most refined_error; exact for a closed mesh. nullopt if the boundary has more than 2,048
  /// edges. Also nullopt if the query is too close to the boundary or to an edge of the cone.
  /// Cost: O(edges of the boundary), about 3 ns each.
  [[nodiscard]] std::optional<double> refine(const Vec3d& query, double rough) const;
  static constexpr double rough_error = 0.45;
  static constexpr double refined_error = 1e-9;
  /// Returns true if refine() can return a value: the boundary is short enough.
  [[nodiscard]] bool has_short_boundary() const;

  /// Returns w by the fastest way to a bound on its error: refine() if that works, the full sum for few triangles, else
  /// estimate().
  [[nodiscard]] Estimate value(const Vec3d& query, double max_error) const;

  /// Returns true if w > 1/2, provided that w differs from 1/2 by more than `change`. A bound on its gradient gives
  /// `change`. Returns nullopt if w may be closer to 1/2. With change = 0 it is the same as is_inside(), except for
  /// nullopt if w is 1/2 up to rounding.
  [[nodiscard]] std::optional<bool> side(const Vec3d& query, double change) const;

  /// Returns the side of a whole box: true if w > 1/2 at all of its points, false if at none. Returns nullopt if
  /// neither can be shown, or if the box may touch a triangle. An answer is always right.
  /// Method: away from the surface, the gradient of w is the Biot-Savart field of the surface's boundary. So between
  /// the centre and a point of the box, w changes by at most the half-diagonal times gradient_bound().
  [[nodiscard]] std::optional<bool> uniform_side(const Box3& box) const;

  /// Returns a bound on the length of the gradient of w over a box, which may be a point. At the surface w jumps, so
  /// between two points the bound holds along paths that cross no triangle. In 1 / mesh units; infinite if the box
  /// touches the boundary; 0 for closed meshes.
  /// @param enough  a bound above this may be replaced by any other number above it, which takes less time.
  [[nodiscard]] double gradient_bound(const Box3& box, double enough = HUGE_VAL) const;

  /// Returns true if w is constant along paths that cross no triangle. Then triangles meet at every edge in cancelling
  /// directions, and w is an integer off the surface. Edges are compared by the positions of their ends.
  [[nodiscard]] bool is_piecewise_constant() const;

  /// Returns the number of triangles.
  [[nodiscard]] std::size_t triangle_count() const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace blum
