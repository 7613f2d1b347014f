// The layers that need no other library: the distance to a tetrahedron, by brute force.
#include <cmath>
#include <cstdio>

#include "blum/field/reference.hpp"

int main() {
  const blum::TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const double distance = blum::reference::BruteForce(mesh).nearest({0.25, 0.25, -2}).distance;
  std::printf("reference: %g\n", distance);
  return std::abs(distance - 2) < 1e-12 ? 0 : 1;
}
