// Blum: bounds on the distances of all points of a small triangle from a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "surface_map/nearest_regions.hpp"
#include "surface_map/round_values.hpp"

namespace blum::surface {

/// A part of a triangle of a surface. The deviation of each of its points x is at most error(x) from value(x). The
/// error changes linearly between the corners. The value also changes linearly, unless `is_round` is true: then the
/// value is the distance from the site.
struct DeviationPiece {
  std::array<Vec3d, 3> corners{};
  std::array<double, 3> value{};
  std::array<double, 3> error{};  ///< not negative
  double area = 0;                ///< above 0, in a unit of the caller's choice
  double mean_value = 0;
  double round_square = 0;  ///< mean square of the value if `is_round`
  double inner = 0;         ///< smallest magnitude of the value if `is_round`, with the sign of the values
  std::int8_t sign = 0;     ///< sign of all deviations; 0: unknown, or both signs occur
  std::uint8_t side = 3;    ///< side to divide, from corner `side` to the next one; 3: the longest
  bool is_sharp = false;    ///< true if the bounds follow from several primitives of the mesh
  bool may_cut = false;     ///< true if cuts where the closest site changes are better than halves
  bool is_round = false;
  SiteId site;  ///< site of the mesh that is closest to all points of the piece; none(): several, or unknown

  /// Returns the mean square of the value divided by `unit`.
  [[nodiscard]] double mean_square(double unit) const;
  /// Returns a bound on the mean of the error.
  [[nodiscard]] double mean_error() const;
  /// Returns the mean square of the error.
  [[nodiscard]] double mean_square_error() const;
  [[nodiscard]] double largest_error() const;
  /// Returns the smallest and the largest value.
  [[nodiscard]] std::pair<double, double> values() const;
  /// Returns the smallest and the largest deviation that a point of the piece may have.
  [[nodiscard]] std::pair<double, double> range() const;
};

/// Bounds the distances of pieces from a mesh.
class DeviationBounds {
 public:
  /// @param mesh       must outlive this object. The largest coordinate of the mesh, and of pieces, must be about 1.
  /// @param signs      decides the signs of distances from the same mesh; nullptr: unsigned. Must outlive this object.
  /// @throws Cancelled.
  DeviationBounds(const MeshView& mesh, const ClosestPointQuery* signs, const Context& context);

  /// Computes the bounds of a piece from the primitives that may be closest to one of its points. With a distance d and
  /// a side h of the piece, errors are about h^2 / 8 d on curved and 0 on flat parts.
  /// @param piece  has its corners, right but wider bounds and, if it is known, its sign.
  /// Cost: 1 to 5 us.
  /// Method: docs/theory/surface-maps.md.
  void sharpen(DeviationPiece& piece) const;

  /// Least number of parts that parts() may be asked for.
  static constexpr std::size_t least_parts = 2;
  /// Divides a piece, and computes the bounds of its parts.
  /// @param most  greatest number of parts, at least `least_parts`.
  [[nodiscard]] std::vector<DeviationPiece> parts(const DeviationPiece& piece, std::size_t most) const;

  /// Returns the distances of a piece from its site. The piece must be round.
  [[nodiscard]] RoundValues round_values(const DeviationPiece& piece) const;

 private:
  struct Linear;
  struct Search;
  [[nodiscard]] Linear examine(const DeviationPiece& piece, Search& search) const;
  void collect(Search& search) const;
  void find_partners();
  [[nodiscard]] Vec3d closest_point(const Vec3d& query, std::uint32_t primitive) const;
  [[nodiscard]] std::uint32_t partner_of(std::uint32_t primitive) const;
  [[nodiscard]] bool is_behind_partner(const Search& search, const NearestPrimitive& one) const;
  [[nodiscard]] double front_of(std::uint32_t primitive, const Vec3d& direction, const Vec3d& origin) const;
  [[nodiscard]] Linear upper_bound(const DeviationPiece& piece, const Search& search) const;
  [[nodiscard]] Linear lower_bound(const DeviationPiece& piece, const Search& search, const Linear& upper) const;
  [[nodiscard]] Facet facet_of(std::uint32_t primitive) const;
  [[nodiscard]] SiteId edge_between(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] Vec3d offset_from(SiteId site, const Vec3d& point) const;
  void add_regions(const DeviationPiece& piece, std::size_t most, std::vector<DeviationPiece>& out) const;
  static void add_halves(const DeviationPiece& piece, std::vector<DeviationPiece>& out);
  void choose_bend(DeviationPiece& piece, const std::array<Vec3d, 3>& offsets) const;
  void set_by_site(DeviationPiece& piece) const;
  void set_values(DeviationPiece& piece, const Vec3d& centroid, const Linear& lower, const Linear& upper,
                  double least) const;
  void set_sign(DeviationPiece& piece, const Vec3d& centroid, const Linear& lower, const Linear& upper,
                double least) const;
  static bool is_one_sided(DeviationPiece& piece, const Linear& lower, const Linear& upper);
  static void set_round(DeviationPiece& piece, const RoundValues& round, double error);
  static void set_crossing(DeviationPiece& piece, const Vec3d& centroid, const Linear& upper, double at_centroid);

  MeshView mesh_;
  SiteTable sites_;
  Bvh bvh_;
  const ClosestPointQuery* signs_;
  /// For each triangle: another triangle in the same plane, so that both together are a convex quadrilateral; or the
  /// triangle itself.
  std::vector<std::uint32_t> partner_;
};

/// Sets the bounds of a new piece, which follow from the deviation of its centroid alone. The errors of the bounds are
/// the distances of the corners from the centroid.
void set_around(DeviationPiece& piece, double deviation);

/// Returns the mean square of a linear function over a triangle.
/// @param values  of the function at the corners.
[[nodiscard]] double mean_square_of(const std::array<double, 3>& values);

}  // namespace blum::surface
