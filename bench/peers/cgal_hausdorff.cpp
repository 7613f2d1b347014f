// CGAL's Hausdorff distance with a bounded error. CGAL is GPL: only benchmarks link to it.
#include "peers/peers.hpp"

#ifdef BLUM_BENCH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <array>

namespace blum::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh surface_of(const MeshView& mesh) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3d& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::vector<std::size_t>> faces;
  for (const auto& [a, b, c] : mesh.triangles) faces.push_back({a, b, c});
  CGAL::Polygon_mesh_processing::orient_polygon_soup(points, faces);
  Mesh out;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, faces, out);
  return out;
}

}  // namespace

std::optional<PeerHausdorff> cgal_hausdorff(const MeshView& a, const MeshView& b, double tolerance) {
  const Mesh first = surface_of(a);
  const Mesh second = surface_of(b);
  PeerHausdorff out;
  out.times = time_runs([&] {
    out.distance = CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
        first, second, tolerance);
  });
  return out;
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::optional<PeerHausdorff> cgal_hausdorff(const MeshView&, const MeshView&, double) {
  return std::nullopt;
}

}  // namespace blum::bench

#endif
