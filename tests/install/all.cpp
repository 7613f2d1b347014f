// Everything at once: a generated shape, written, read back, and its field.
#include <cstdio>
#include <filesystem>

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"

int main() {
  const blum::TriangleMesh torus = blum::make_torus({.ring_segments = 24, .tube_segments = 12});
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "blum_install_test.ply";
  blum::write_mesh(file, torus);
  const blum::TriangleMesh read = blum::read_mesh(file);
  std::filesystem::remove(file);
  const blum::Field field = blum::distance_field(read, blum::grid_around(blum::bounds(read), 16));
  std::printf("all: %zu triangles, %zu nodes\n", read.triangles.size(), field.distance.size());
  return read.triangles.size() == torus.triangles.size() && field.distance.size() == field.grid.node_count() ? 0 : 1;
}
