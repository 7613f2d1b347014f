// Everything at once: a generated shape, written, read back, its field; glTF and PNG, whose libraries Blum brings.
#include <cstdio>
#include <filesystem>

#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/io/gltf_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/png_io.hpp"
#include "blum/shapes/generators.hpp"

int main() {
  const blum::TriangleMesh torus = blum::make_torus({.ring_segments = 24, .tube_segments = 12});
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "blum_install_test.ply";
  blum::write_mesh(file, torus);
  const blum::TriangleMesh read = blum::read_mesh(file);
  std::filesystem::remove(file);
  const blum::Field field = blum::distance_field(read, blum::grid_around(blum::bounds(read), 16));
  blum::GltfMesh shown;
  shown.vertices = read.vertices;
  shown.triangles = read.triangles;
  if (blum::encode_gltf(shown).empty() || blum::encode_png(blum::Picture(2, 2, {})).empty()) return 1;
  std::printf("all: %zu triangles, %zu nodes\n", read.triangles.size(), field.distance.size());
  return read.triangles.size() == torus.triangles.size() && field.distance.size() == field.grid.node_count() ? 0 : 1;
}
