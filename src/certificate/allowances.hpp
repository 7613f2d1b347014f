// Blum: lengths by which an axis may be off, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/medial_columns.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// Returns the side of a voxel that the verifier assumes, in scaled units. It is `options.spacing`, or 1/32 of the
/// diagonal of the solid if that is unset. It is at most an eighth of the longest side of the solid, as on the coarsest
/// grid. If the solid consists of voxels, it lies between half a voxel's diagonal and the whole diagonal. The edges of
/// the axis are not used: in the middle of round parts they are as short as the facets of the surface.
[[nodiscard]] double believed_voxel(const KnownSolid& solid, const CertificateOptions& options, double factor);

/// Returns how far vertices may have been moved by simplification, in scaled units: `options.deviation`, or 0 if it is
/// unset. It is at most 1/64 of the diagonal, which is the distance by which an edge may cut off a corner.
[[nodiscard]] double believed_deviation(const KnownSolid& solid, const CertificateOptions& options, double factor);

/// Lengths by which an axis may deviate from the exact axis.
///
/// Claims of a file never make an allowance larger than the solid justifies. For a ball between two walls, an allowance
/// is at most a share of the ball's radius, or what flat cells cut off. So a point halfway to the wall is never
/// accepted. Solids of voxels are exempt: they have no details smaller than these lengths, and their voxel size is
/// known.
struct Allowances {
  double voxel = 0;
  double middle = 0;    ///< largest distance of a point of the axis from the middle
  double close = 0;     ///< largest distance of at least half of these points
  double missing = 0;   ///< largest distance of a point of the middle from the axis
  double apart = 0;     ///< closer footprints are considered only at steep angles, and never between voxels
  double lambda = 0;    ///< closer footprints are never considered
  double rounding = 0;  ///< shorter lengths are treated as rounding errors
  double noise = 0;     ///< degrees: walls at a smaller angle count as one
  bool of_voxels = false;
  bool of_facets = false;  ///< true if sheets between facets are judged by these facets

  static constexpr double steep = 80;      ///< degrees
  static constexpr double opposite = 150;  ///< degrees: walls at this angle are on opposite sides of a thin part
  static constexpr double of_thin = 3;     ///< radii: ends in thin parts are at most 1.5 diameters short

  /// Returns true if the axis must contain points with two footprints at this distance from each other and this
  /// separation angle. Between close walls, only steep angles are more than roughness. Between close voxels, every
  /// angle may be roughness.
  [[nodiscard]] bool counts(double between, double angle) const {
    return between >= lambda && (between >= apart || (angle >= steep && !of_voxels));
  }
  /// Returns how far nearly all points of a cell may be from the middle, next to a ball of this radius. `size` is the
  /// longest side of the cell: large flat cells may be further off, because they cut off curved parts.
  [[nodiscard]] double middle_at(double radius, double size = 0) const { return limited(middle, radius / 4, size); }
  /// Returns the limit for at least half of all points.
  [[nodiscard]] double close_at(double radius, double size = 0) const { return limited(close, radius / 8, size); }
  /// Returns the least separation angle of the two walls between which a point of a cell may lie, in degrees. The
  /// result is half of the angle that the cell claims, but at most the noise angle. So walls of facets are
  /// distinguished where the cell claims them.
  [[nodiscard]] double floor_at(double claim) const {
    constexpr double least = 0.1;
    return !of_facets ? noise : std::min(noise, std::max(0.5 * claim, least));
  }
  /// Returns how far the centre of a ball of this radius may be from the axis. Sheets end within about a voxel of their
  /// exact end.
  [[nodiscard]] double missing_at(double radius) const {
    return of_voxels ? missing : std::min(missing, std::max(radius / 2, 2 * voxel));
  }
  /// Returns how far the centre of a ball may be from a cell of its sheet, if its radius is above `missing`.
  [[nodiscard]] double beside_sheet() const { return missing - voxel; }
  /// Returns how far the centre of a ball of this radius, between opposite walls of a thin part, may be from the axis.
  [[nodiscard]] double missing_in_thin(double radius) const { return std::max(of_thin * radius, rounding); }
  /// Returns the largest radius of thin parts: there, missing_in_thin() is below missing_at().
  [[nodiscard]] double thin() const { return of_voxels ? 0 : 2 * voxel / of_thin; }

 private:
  [[nodiscard]] double limited(double length, double share, double size) const {
    const double cut_off = std::min(size / 10, voxel / 4);
    return of_voxels ? length : std::min(length, std::max({share, cut_off, rounding}));
  }
};

/// Computes the allowances for a solid, in scaled units.
/// @param factor  lengths of the solid are this many times the caller's. Lengths of the options are the caller's.
[[nodiscard]] Allowances allowances(const KnownSolid& solid, const CertificateOptions& options, double factor);

}  // namespace blum::verifier
