// The fast field of a tetrahedron, on a small grid.
#include "blum/field/field.hpp"

#include <cmath>
#include <cstdio>

int main() {
  const blum::TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const blum::GridSpec grid{.origin = {0.25, 0.25, -2}, .spacing = {1, 1, 1}, .size = {4, 4, 4}};
  const blum::Field field = blum::distance_field(mesh, grid);
  std::printf("field: %g\n", static_cast<double>(field.distance[0]));
  return std::abs(static_cast<double>(field.distance[0]) - 2) < 1e-5 ? 0 : 1;
}
