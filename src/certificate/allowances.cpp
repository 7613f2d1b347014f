#include "certificate/allowances.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace blum::verifier {
namespace {

constexpr double noise_of_meshes = 10;  ///< degrees from which two walls are two
constexpr double noise_of_images = 20;  ///< the same between steps of voxels
constexpr double least_voxels = 8;      ///< along the longest side of a solid

double longest_side(const KnownSolid& solid) {
  Box3 all;
  for (std::uint32_t b = 0; b < solid.bodies.size(); ++b) all.extend(solid.solid->box(b));
  const Vec3d size = all.size();
  return std::max({size.x, size.y, size.z});
}

/// The length that a quarter of an axis's edges reach; HUGE_VAL for one without edges.
double length_of_long_edges(const MedialView& axis) {
  std::vector<double> lengths;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    const double own = length(axis.positions[a] - axis.positions[b]);
    if (std::isfinite(own)) lengths.push_back(own);
  };
  for (const auto& [a, b] : axis.edges) add(a, b);
  for (const auto& [a, b, c] : axis.triangles) {
    add(a, b);
    add(b, c);
    add(c, a);
  }
  if (lengths.empty()) return HUGE_VAL;
  const auto long_one = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 3 / 4);
  std::nth_element(lengths.begin(), long_one, lengths.end());
  return *long_one;
}

}  // namespace

double believed_voxel(const MedialView& axis, const KnownSolid& solid, const CertificateOptions& options,
                      double factor) {
  const double diagonal = solid.solid->diagonal();
  const double said = options.spacing ? *options.spacing * factor : diagonal / 32;
  if (solid.solid->grain() > 0) return std::clamp(said, solid.solid->grain() / 2, solid.solid->grain());
  return std::min({said, longest_side(solid) / least_voxels, length_of_long_edges(axis)});
}

double believed_deviation(const KnownSolid& solid, const CertificateOptions& options, double factor) {
  return std::min(options.deviation ? *options.deviation * factor : 0, solid.solid->diagonal() / 64);
}

Allowances allowances(const MedialView& axis, const KnownSolid& solid, const CertificateOptions& options,
                      double factor) {
  const double moved = believed_deviation(solid, options, factor);
  Allowances all;
  all.voxel = believed_voxel(axis, solid, options, factor);
  all.middle = 1.5 * all.voxel + moved;
  all.close = std::max(all.voxel / 3, moved + all.voxel / 12);
  all.missing = 2 * all.voxel + moved;
  all.lambda = options.lambda ? *options.lambda * factor : 0;
  all.apart = 4 * all.voxel + all.lambda;
  all.of_voxels = solid.solid->grain() > 0;
  all.rounding = 1e-5 * solid.solid->diagonal();
  all.noise = solid.solid->grain() > 0 && solid.solid->slack() == 0 ? noise_of_images : noise_of_meshes;
  return all;
}

}  // namespace blum::verifier
