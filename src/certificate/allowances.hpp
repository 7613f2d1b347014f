// Blum: lengths by which an axis may be off, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/medial_columns.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// Returns the side of a voxel that the verifier assumes: `options.spacing`, or 1/32 of the diagonal if that is unset.
/// It is at most an eighth of the longest side of the solid, as on the coarsest grid. If the solid is made of voxels,
/// its range is instead from half a voxel's diagonal to the whole diagonal. Edges of the axis are not used: in the
/// middle of round parts they are as short as the facets of the surface.
[[nodiscard]] double believed_voxel(const KnownSolid& solid, const CertificateOptions& options, double factor);

/// Returns how far vertices may have been moved: `options.deviation`, or 0 if that is unset. It is at most 1/64 of the
/// diagonal, which is how much an edge may cut off a corner.
[[nodiscard]] double believed_deviation(const KnownSolid& solid, const CertificateOptions& options, double factor);

/// Lengths by which an axis may be off, as the verifier sees the solid.
///
/// Claims of a file never make an allowance wider than the solid justifies. Next to a ball between two walls, an
/// allowance is limited to a share of the ball's radius, or to what flat cells cut off. So a point halfway to the wall
/// is always off. Solids of voxels are exempt: they show nothing smaller than these lengths, and their voxel size is
/// known.
struct Allowances {
  double voxel = 0;
  double middle = 0;    ///< distance of a point of the axis from the middle
  double close = 0;     ///< the same, for half of all points
  double missing = 0;   ///< distance of a point of the middle from the axis
  double apart = 0;     ///< closer footprints count only at steep angles, and not for voxels
  double lambda = 0;    ///< closer footprints never count
  double rounding = 0;  ///< shorter lengths count as rounding errors
  double noise = 0;     ///< degrees from which two walls count as two
  bool of_voxels = false;

  static constexpr double steep = 80;  ///< degrees

  /// Returns true if the axis must contain points that see two footprints at this distance and angle. Between close
  /// walls only steep angles are more than roughness. Between close voxels no angle is.
  [[nodiscard]] bool counts(double between, double angle) const {
    return between >= lambda && (between >= apart || (angle >= steep && !of_voxels));
  }
  /// Returns how far from the middle a point of a cell of this size may be, next to a ball of this radius. Nearly all
  /// points must be within it. Large flat cells may be further off, because they cut off curved parts.
  [[nodiscard]] double middle_at(double radius, double size = 0) const { return limited(middle, radius / 4, size); }
  /// Returns the same limit for half of all points.
  [[nodiscard]] double close_at(double radius, double size = 0) const { return limited(close, radius / 8, size); }
  /// Returns how far from the axis a ball of this radius may be. Sheets end within about a voxel.
  [[nodiscard]] double missing_at(double radius) const {
    return of_voxels ? missing : std::min(missing, std::max(radius / 2, 2 * voxel));
  }

 private:
  [[nodiscard]] double limited(double length, double share, double size) const {
    const double cut_off = std::min(size / 10, voxel / 4);
    return of_voxels ? length : std::min(length, std::max({share, cut_off, rounding}));
  }
};

/// Computes the allowances for a solid.
/// @param factor  lengths are this many times the caller's. Lengths of the options are the caller's.
[[nodiscard]] Allowances allowances(const KnownSolid& solid, const CertificateOptions& options, double factor);

}  // namespace blum::verifier
