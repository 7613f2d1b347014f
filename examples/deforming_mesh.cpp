// Example: fields of a deforming mesh, frame by frame, with progress and cancellation.
#include <cmath>
#include <iostream>
#include <stop_token>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"

namespace {

/// Bends a shape along x like a wave.
blum::TriangleMesh bent(const blum::TriangleMesh& rest, double phase) {
  blum::TriangleMesh mesh = rest;
  for (blum::Vec3d& p : mesh.vertices) p.z += 0.2 * std::sin(2 * p.x + phase);
  return mesh;
}

}  // namespace

int main() try {
  const blum::TriangleMesh rest = blum::make_torus();

  // One grid serves all frames. The solver keeps the buffers of the field and, while the triangles stay the same, the
  // list of edges. It keeps nothing else, so vertices may move freely.
  const blum::GridSpec grid = blum::grid_in({{-1.6, -1.6, -0.8}, {1.6, 1.6, 0.8}}, 64);
  std::stop_source stop;
  blum::Context context;
  context.cancel = stop.get_token();
  int reports = 0;
  context.progress = [&](double /*fraction*/, std::string_view /*phase*/) { ++reports; };
  blum::FieldSolver solver(grid, {.band = 6 * grid.spacing.x}, context);

  for (int frame = 0; frame < 5; ++frame) {
    const blum::Field& field = solver.compute(bent(rest, 0.3 * frame));  // valid until the next call
    std::size_t in_band = 0;
    for (const blum::SiteId site : field.site) in_band += site.has_value() ? 1 : 0;
    std::cout << "frame " << frame << ": " << in_band << " of " << grid.node_count() << " nodes in the band\n";
  }
  std::cout << (reports > 0 ? "progress was reported\n" : "no progress was reported\n");

  // Usually, another thread or a signal handler calls this.
  stop.request_stop();
  try {
    (void)solver.compute(rest);
  } catch (const blum::Cancelled&) {
    std::cout << "stopped\n";
    return reports > 0 ? 0 : 1;
  }
  std::cerr << "not stopped\n";
  return 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
