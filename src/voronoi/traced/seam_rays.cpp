#include "voronoi/traced/seam_rays.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;

bool has_three_footprints(const TracedSites& sites, const Vec3d& at, const std::vector<Index>& found) {
  if (found.size() != 3) return false;
  constexpr double least = 1e-8;
  const auto apart = [&](std::size_t a, std::size_t b) {
    return length(sites.gradient(found[a], at) - sites.gradient(found[b], at)) > least;
  };
  return apart(0, 1) && apart(0, 2) && apart(1, 2);
}

/// Returns the seams that meet a plane near a point, among the sites of a ray from the point.
std::vector<LeavingSeam> seams_in_plane(const TracedSites& sites, const SeamTracer& tracer, const Vec3d& at,
                                        const SeamRay& ray, double step) {
  std::vector<LeavingSeam> out;
  constexpr double aside = 0.2;
  for (const Vec3d& start : tracer.seam_points(ray.sites, at + ray.direction * step, ray.direction, aside * step)) {
    const std::vector<Index> closest = tracer.closest(start, sites.tolerance(), ray.sites[0]).sites;
    if (!std::includes(ray.sites.begin(), ray.sites.end(), closest.begin(), closest.end())) continue;
    const auto curve = tracer.curve_of(closest, start, ray.direction);
    if (!curve) continue;
    Vec3d along = tracer.tangent(*curve, start);
    if (dot(along, ray.direction) < 0) along = -along;
    SeamRay own = LocalStar(sites, start, closest).ray(along);
    if (own.ring.germs.size() < 3) continue;
    own.direction = ray.direction;
    out.push_back({std::move(own), *curve, start, unit(start - at)});
  }
  // Fewer sites with the same distances lie on the same curve. They were found where others differ by the tolerance.
  const auto is_part = [&](const LeavingSeam& seam) {
    const std::vector<Index>& own = seam.ray.sites;
    return std::any_of(out.begin(), out.end(), [&](const LeavingSeam& other) {
      const std::vector<Index>& all = other.ray.sites;
      return all.size() > own.size() && std::includes(all.begin(), all.end(), own.begin(), own.end());
    });
  };
  std::vector<LeavingSeam> kept;
  for (const LeavingSeam& seam : out) {
    if (!is_part(seam)) kept.push_back(seam);
  }
  return kept;
}

}  // namespace

std::vector<LeavingSeam> leaving_seams(const TracedSites& sites, const SeamTracer& tracer, const Vec3d& at,
                                       const std::vector<Index>& found) {
  std::vector<LeavingSeam> out;
  const double radius = sites.distance(found[0], at);
  for (SeamRay& ray : LocalStar(sites, at, found).rays()) {
    if (ray.ring.germs.size() == 3 && has_three_footprints(sites, at, ray.sites)) {
      if (const auto curve = tracer.curve_of(ray.sites, at, ray.direction)) {
        const Vec3d direction = ray.direction;
        out.push_back({std::move(ray), *curve, at, direction});
        continue;
      }
    }
    // Seams that part by the square of the step must be clearly apart.
    double step = std::clamp(8 * std::sqrt(sites.tolerance() * radius), 0.02 * radius, 0.25 * radius);
    // Seams between junctions that are very close are short.
    constexpr int least_tries = 8;
    for (int k = 0; k < least_tries || step > 8 * sites.tolerance(); ++k, step *= 0.25) {
      std::vector<LeavingSeam> seams = seams_in_plane(sites, tracer, at, ray, step);
      if (seams.empty()) continue;
      std::move(seams.begin(), seams.end(), std::back_inserter(out));
      break;
    }
  }
  return out;
}

}  // namespace blum::voronoi
