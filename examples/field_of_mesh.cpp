// Example: the signed distance field of a mesh, the meaning of its values, and how to write it.
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
  // Reads a mesh, or makes a torus knot.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_shape("torus_knot");

  // The grid has 96 nodes along its longest side, and 10 % of the mesh's longest side as a margin on each side.
  const blum::GridSpec grid = blum::grid_around(blum::bounds(mesh), 96);
  const blum::Field field = blum::distance_field(mesh, grid);
  std::cout << "sign rule: " << to_string(field.sign_rule) << " (" << field.sign_reason << ")\n";

  // The value of node (i, j, k) is at index(i, j, k); x runs fastest.
  const std::size_t node = grid.index(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2);
  std::cout << "at the middle of the grid: distance " << field.distance[node] << ", closest site "
            << field.site[node].value << '\n';

  // The site is a vertex, an open edge or an open face.
  const blum::SiteTable sites(mesh);
  const std::array<std::int32_t, 3> corners = sites.vertices(field.site[node]);
  std::cout << "its vertices: " << corners[0] << ' ' << corners[1] << ' ' << corners[2] << " (-1: none)\n";

  std::size_t inside = 0;
  for (const float distance : field.distance) inside += distance < 0 ? 1 : 0;
  const double cell = grid.spacing.x * grid.spacing.y * grid.spacing.z;
  std::cout << "volume, estimated from nodes inside: " << static_cast<double>(inside) * cell << '\n';

  const blum::MeshView view = mesh;
  blum::write_field("field.npz", field, {.mesh = &view, .sites = &sites, .source = "field_of_mesh"});
  std::cout << "wrote field.npz\n";
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
