#include <array>

#include "blum/core/error.hpp"
#include "blum/geometry/generators.hpp"
#include "geometry/generator_parts.hpp"

namespace blum {
namespace {

using detail::require;
using detail::require_at_least;
using detail::require_positive;
using detail::require_triangle_count;

}  // namespace

TriangleMesh make_void_cube(const VoidCubeOptions& options) {
  require_positive(options.size, "size");
  require_positive(options.void_radius, "void_radius");
  require(options.void_radius < 0.5 * options.size, "void_radius", "below size / 2, or the void cuts the cube",
          options.void_radius);
  const int n = options.segments;
  TriangleMesh mesh = make_box({{options.size, options.size, options.size}, {n, n, n}});
  TriangleMesh inner = make_sphere({options.void_radius, options.frequency});
  require_triangle_count(static_cast<double>(mesh.triangles.size()) + static_cast<double>(inner.triangles.size()));
  reverse_triangles(inner);
  append(mesh, inner);
  return mesh;
}

TriangleMesh make_nested_shells(const NestedShellsOptions& options) {
  require(options.shells >= 1 && options.shells <= 1000, "shells", "1 to 1000", options.shells);
  require_positive(options.radius, "radius");
  require_at_least(options.frequency, 1, "frequency");
  require_triangle_count(20.0 * options.shells * options.frequency * options.frequency);
  // All shells are scaled copies of one convex polyhedron around the origin: they cannot touch.
  const TriangleMesh outer = make_sphere({options.radius, options.frequency});
  TriangleMesh mesh;
  for (int shell = 0; shell < options.shells; ++shell) {
    TriangleMesh scaled = outer;
    for (Vec3d& p : scaled.vertices) p *= 1 - static_cast<double>(shell) / options.shells;
    if (shell % 2 == 1) reverse_triangles(scaled);
    append(mesh, scaled);
  }
  return mesh;
}

TriangleMesh make_bodies(const BodiesOptions& options) {
  require_at_least(options.count, 1, "count");
  require_positive(options.size, "size");
  require_positive(options.spacing, "spacing");
  require(options.spacing > options.size, "spacing", "above size, or bodies touch", options.spacing);
  require_at_least(options.frequency, 0, "frequency");
  const double each = options.frequency == 0 ? 12.0 : 20.0 * options.frequency * options.frequency;
  require_triangle_count(each * options.count);
  const TriangleMesh body = options.frequency == 0 ? make_box({{options.size, options.size, options.size}, {1, 1, 1}})
                                                   : make_sphere({0.5 * options.size, options.frequency});
  int side = 1;
  while (static_cast<double>(side) * side * side < options.count) ++side;
  const double middle = 0.5 * (side - 1);
  TriangleMesh mesh;
  for (int i = 0; i < options.count; ++i) {
    const Vec3d place{i % side - middle, i / side % side - middle, i / side / side - middle};
    append(mesh, body, place * options.spacing);
  }
  return mesh;
}

}  // namespace blum
