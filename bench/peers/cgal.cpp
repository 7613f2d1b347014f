// CGAL's AABB tree: closest point and primitive, with hints. CGAL is GPL: only benchmarks link to it.
#include "peers/bundles.hpp"

#ifdef BLUM_BENCH_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <memory>

namespace blum::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

}  // namespace

std::optional<PeerField> cgal_field(const MeshView& mesh, const GridSpec& grid, const Context& context) {
  PeerField result = empty_result(grid);
  Triangles triangles;
  std::unique_ptr<Tree> tree;
  const auto build = [&] {
    const auto point = [&](std::uint32_t vertex) {
      const Vec3d& p = mesh.vertices[vertex];
      return Kernel::Point_3(p.x, p.y, p.z);
    };
    triangles.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
    tree = std::make_unique<Tree>(triangles.cbegin(), triangles.cend());
    tree->build();
  };
  run_peer(result, context, build, [&](const Bundles& bundles, std::size_t bundle, Field& field) {
    Tree::Point_and_primitive_id hint(triangles.front().vertex(0), triangles.cbegin());
    bundles.visit(bundle, [&](std::size_t node, const Vec3d& position) {
      const Kernel::Point_3 query(position.x, position.y, position.z);
      hint = tree->closest_point_and_primitive(query, hint);
      field.distance[node] = static_cast<float>(std::sqrt(CGAL::squared_distance(query, hint.first)));
      field.site[node] = SiteId(static_cast<std::uint32_t>(hint.second - triangles.cbegin()));
    });
  });
  return result;
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::optional<PeerField> cgal_field(const MeshView&, const GridSpec&, const Context&) {
  return std::nullopt;
}

}  // namespace blum::bench

#endif
