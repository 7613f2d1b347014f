#include "blum/voronoi/voronoi_regions.hpp"

#include <map>
#include <utility>

namespace blum {

std::vector<VoronoiRegion> voronoi_regions(const Complex& complex) {
  validate(complex);
  const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = complex.triangle_columns.get<std::int32_t>("site_b");
  Vec3d middle;
  for (const Vec3d& p : complex.positions) middle += p * (1.0 / static_cast<double>(complex.positions.size()));
  std::map<std::int32_t, double> volumes, surfaces;
  std::map<std::pair<std::int32_t, std::int32_t>, double> areas;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto& [a, b, c] = complex.triangles[t];
    const Vec3d p = complex.positions[a] - middle;
    const Vec3d normal = cross(complex.positions[b] - middle - p, complex.positions[c] - middle - p);
    // Corners run counterclockwise as seen from the region of site_b: the normal points into it.
    const double cone = dot(p, normal) / 6;
    const double area = 0.5 * length(normal);
    volumes[site_b[t]] -= cone;
    if (site_a[t] < 0) {
      surfaces[site_b[t]] += area;
      continue;
    }
    volumes[site_a[t]] += cone;
    areas[{site_a[t], site_b[t]}] += area;
    areas[{site_b[t], site_a[t]}] += area;
  }
  std::vector<VoronoiRegion> out;
  for (const auto& [site, volume] : volumes) {
    VoronoiRegion& region = out.emplace_back();
    region.site = site;
    region.volume = volume;
    if (const auto at = surfaces.find(site); at != surfaces.end()) region.surface_area = at->second;
    for (auto at = areas.lower_bound({site, INT32_MIN}); at != areas.end() && at->first.first == site; ++at) {
      region.neighbours.push_back({at->first.second, at->second});
    }
  }
  return out;
}

}  // namespace blum
