// CGAL's self-intersections. CGAL is GPL: only benchmarks link to it.
#include "peers/collisions.hpp"

#ifdef BLUM_BENCH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>

namespace blum::bench {

std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> cgal_self_intersections(const TriangleMesh& mesh) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh surface;
  for (const Vec3d& p : mesh.vertices) surface.add_vertex(Kernel::Point_3(p.x, p.y, p.z));
  for (const auto& [a, b, c] : mesh.triangles) {
    surface.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c));
  }
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(found));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  out.reserve(found.size());
  for (const auto& [f, g] : found) out.push_back(std::minmax<std::uint32_t>(f.idx(), g.idx()));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> cgal_self_intersections(const TriangleMesh&) {
  return std::nullopt;
}

}  // namespace blum::bench

#endif
