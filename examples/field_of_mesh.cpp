// Example: the signed distance field of a mesh, what its values mean, and how to keep it.
#include <array>
#include <cstdint>
#include <iostream>

#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/shape_catalog.hpp"

int main(int argc, char** argv) try {
  // A mesh from a file, or a torus knot that Blum makes.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_shape("torus_knot");

  // 96 nodes along the longest side, 10 % of it as room on each side.
  const blum::GridSpec grid = blum::grid_around(blum::bounds(mesh), 96);
  const blum::Field field = blum::distance_field(mesh, grid);
  std::cout << "sign by " << to_string(field.sign_rule) << " (" << field.sign_reason << ")\n";

  // Node (i, j, k) is value index(i, j, k); x runs fastest.
  const std::size_t node = grid.index(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2);
  std::cout << "at the middle: distance " << field.distance[node] << ", closest site " << field.site[node].value
            << '\n';

  // The site is a vertex, an open edge or an open face.
  const blum::SiteTable sites(mesh);
  const std::array<std::int32_t, 3> corners = sites.vertices(field.site[node]);
  std::cout << "its vertices: " << corners[0] << ' ' << corners[1] << ' ' << corners[2] << " (-1: none)\n";

  std::size_t inside = 0;
  for (const float distance : field.distance) inside += distance < 0 ? 1 : 0;
  const double cell = grid.spacing.x * grid.spacing.y * grid.spacing.z;
  std::cout << "volume, from nodes inside: " << static_cast<double>(inside) * cell << '\n';

  const blum::MeshView view = mesh;
  blum::write_field("field.npz", field, {.mesh = &view, .sites = &sites, .source = "field_of_mesh"});
  std::cout << "wrote field.npz\n";
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
