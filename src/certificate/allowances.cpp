#include "certificate/allowances.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace blum::verifier {
namespace {

constexpr double noise_of_meshes = 10;  ///< degrees: walls at a smaller angle are treated as one wall
constexpr double noise_of_images = 20;  ///< degrees: the same for solids of voxels
constexpr double least_voxels = 8;      ///< least number of voxels along the longest side of a solid

double longest_side(const KnownSolid& solid) {
  Box3 all;
  for (std::uint32_t b = 0; b < solid.bodies.size(); ++b) all.extend(solid.solid->box(b));
  const Vec3d size = all.size();
  return std::max({size.x, size.y, size.z});
}

}  // namespace

double believed_voxel(const KnownSolid& solid, const CertificateOptions& options, double factor) {
  const double diagonal = solid.solid->diagonal();
  const double said = options.spacing ? *options.spacing * factor : diagonal / 32;
  if (solid.solid->grain() > 0) return std::clamp(said, solid.solid->grain() / 2, solid.solid->grain());
  return std::min(said, longest_side(solid) / least_voxels);
}

double believed_deviation(const KnownSolid& solid, const CertificateOptions& options, double factor) {
  return std::min(options.deviation ? *options.deviation * factor : 0, solid.solid->diagonal() / 64);
}

Allowances allowances(const KnownSolid& solid, const CertificateOptions& options, double factor) {
  const double moved = believed_deviation(solid, options, factor);
  Allowances all;
  all.voxel = believed_voxel(solid, options, factor);
  all.middle = 1.5 * all.voxel + moved;
  all.close = std::max(all.voxel / 3, moved + all.voxel / 12);
  all.missing = 2 * all.voxel + moved;
  all.lambda = options.lambda ? *options.lambda * factor : 0;
  all.apart = 4 * all.voxel + all.lambda;
  all.of_voxels = solid.solid->grain() > 0;
  constexpr double least_theta = 0.5;  // below it, axes of grids have cells of any direction between facets
  all.of_facets = !all.of_voxels && options.theta && *options.theta >= least_theta;
  all.rounding = 1e-5 * solid.solid->diagonal();
  all.noise = solid.solid->grain() > 0 && solid.solid->slack() == 0 ? noise_of_images : noise_of_meshes;
  return all;
}

}  // namespace blum::verifier
