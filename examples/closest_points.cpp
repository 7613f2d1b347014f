// Example: exact closest points on a mesh, at any positions, without a grid.
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"

int main() try {
  const blum::TriangleMesh mesh = blum::make_sphere({.radius = 2});

  // Many queries at once, threaded.
  const std::vector<blum::Vec3d> queries = {{0, 0, 0.5}, {3, 0, 0}, {1, 2, 3}};
  const std::vector<blum::ClosestPoint> results = blum::closest_points(mesh, queries);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const blum::Vec3d& p = results[i].point;
    std::cout << "distance " << results[i].distance << " to (" << p.x << ", " << p.y << ", " << p.z << ") on triangle "
              << results[i].triangle.value << '\n';
  }

  // One at a time, for example from a solver's inner loop: the hierarchy is built once, queries allocate nothing.
  const blum::ClosestPointQuery query(mesh, {.sign = blum::SignMode::none, .max_distance = 0.25});
  std::size_t near = 0;
  constexpr int count = 1000;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    const blum::Vec3d at{2.5 * std::cos(angle), 1.5 * std::sin(angle), 0};
    if (query.nearest(at).site.has_value()) ++near;
  }
  std::cout << near << " of " << count << " points of an ellipse lie within 0.25 of the sphere\n";
  return near > 0 && near < count ? 0 : 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
