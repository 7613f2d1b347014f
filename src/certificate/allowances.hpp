// Blum: within which lengths an axis may be off, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/medial_columns.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// The side of a voxel that an axis says, as far as it can be so: an eighth of the longest side of the solid at most,
/// as the coarsest grid has it. 1/32 of the diagonal where nothing is said. Where the solid is made of voxels, these
/// are known. Edges of the axis tell nothing: those in the middle of what is round are as short as its facets make
/// them.
[[nodiscard]] double believed_voxel(const KnownSolid& solid, const CertificateOptions& options, double factor);

/// The same for how far vertices were moved: 1/64 of the diagonal at most, what an edge may cut off a corner.
[[nodiscard]] double believed_deviation(const KnownSolid& solid, const CertificateOptions& options, double factor);

/// Lengths within which an axis may be off, as the verifier sees the solid.
///
/// What a file says of itself makes none of them wider than the solid shows: next to a ball in the middle between two
/// walls, all are at most shares of its radius, so that halfway to the wall is off everywhere. Solids of voxels show
/// nothing smaller than these, and tell themselves how large they are.
struct Allowances {
  double voxel = 0;
  double middle = 0;    ///< of a point of the axis, from the middle
  double close = 0;     ///< the same, for half of all
  double missing = 0;   ///< of a point of the middle, from the axis
  double apart = 0;     ///< footprints that are closer than this count where they are seen from between them, about
  double lambda = 0;    ///< those that are closer than this count for nothing
  double rounding = 0;  ///< less than this is nothing
  double noise = 0;     ///< degrees
  bool of_voxels = false;

  static constexpr double steep = 80;  ///< degrees

  /// Whether an axis must have what two footprints so far apart are seen from at an angle. Between walls that are close
  /// only steep ones are more than roughness; between voxels that are close there is none.
  [[nodiscard]] bool counts(double between, double angle) const {
    return between >= lambda && (between >= apart || (angle >= steep && !of_voxels));
  }
  /// How far from the middle a point of a cell so large may be next to a ball of a radius: flat cells cut off what is
  /// bent. Of nearly all.
  [[nodiscard]] double middle_at(double radius, double size = 0) const { return limited(middle, radius / 4, size); }
  /// The same of half of all.
  [[nodiscard]] double close_at(double radius, double size = 0) const { return limited(close, radius / 8, size); }
  /// How far from the axis a ball of a radius may be: sheets end within a voxel, about.
  [[nodiscard]] double missing_at(double radius) const {
    return of_voxels ? missing : std::min(missing, std::max(radius / 2, 2 * voxel));
  }

 private:
  [[nodiscard]] double limited(double length, double share, double size) const {
    const double cut_off = std::min(size / 10, voxel / 4);
    return of_voxels ? length : std::min(length, std::max({share, cut_off, rounding}));
  }
};

/// @param factor  lengths are this many times what the caller knows; those of the options are the caller's.
[[nodiscard]] Allowances allowances(const KnownSolid& solid, const CertificateOptions& options, double factor);

}  // namespace blum::verifier
