// Writes the files of debug_dump() for a mesh, points and a complex. Tests read them with other programs.
//   debug_dump_sample DIR   mesh.vtp, points.vtp, complex.vtp
#include <exception>
#include <iostream>
#include <string>

#include "blum/complex/complex.hpp"
#include "blum/core/debug_dump.hpp"
#include "blum/geometry/triangle_mesh.hpp"

int main(int argc, char** argv) try {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const blum::TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 0.3}, {9, 9, 9}},
                                .triangles = {{0, 1, 2}, {0, 2, 3}},
                                .segments = {{1, 3}}};
  blum::Complex complex;
  complex.positions = mesh.vertices;
  complex.edges = {{0, 4}, {3, 4}};
  complex.triangles = {{2, 1, 0}};
  blum::debug_dump(folder + "/mesh.vtp", mesh);
  blum::debug_dump(folder + "/points.vtp", mesh.vertices);
  blum::debug_dump(folder + "/complex.vtp", complex);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "debug_dump_sample: " << error.what() << '\n';
  return 1;
}
