// Times FieldSolver on a deforming mesh of 2,000 triangles and one grid, frame by frame. A frame includes all work from
// moved vertices to distance, site and, if requested, sign at every node.
#include <cmath>

#include "blum/field/field.hpp"
#include "support/check.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

constexpr int frames = 30;

/// Deforms a body: vertices rotate about z by an angle that oscillates along z and in time.
void deform(const TriangleMesh& rest, double time, TriangleMesh& moved) {
  for (std::size_t v = 0; v < rest.vertices.size(); ++v) {
    const Vec3d& p = rest.vertices[v];
    const double angle = 0.3 * std::sin(2 * p.z + 6 * time);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    moved.vertices[v] = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  }
}

void frame_case(benchmark::State& state, int n, SignMode sign) {
  const Shape& rest = shape("organic-2000");
  Shape moved;
  moved.mesh = rest.mesh;
  const GridSpec grid = cube_grid(rest.mesh, n);
  FieldSolver solver(grid, {.sign = sign});
  const Field* field = nullptr;
  std::vector<Times> runs;
  double time = 0;
  for (int frame = -3; frame < frames; ++frame, time += 0.02) {
    const Times once = time_once([&] {
      deform(rest.mesh, time, moved.mesh);
      field = &solver.compute(moved.mesh);
    });
    if (frame >= 0) runs.push_back(once);
  }
  const Times times = median(runs);
  report(state, times, static_cast<double>(grid.node_count()));
  report_phases(state, field->phases);
  state.counters["frames_per_s"] = 1 / times.wall;
  // The rate if both cores worked only for this process.
  state.counters["frames_per_s_by_cpu"] = 2 / times.cpu;
  spot_check(state, moved, *field);
  state.SetLabel(rest.note);
}

const bool registered = [] {
  for (const int n : {64, 128}) {
    const std::string prefix = "frame/organic-2000/" + std::to_string(n) + "/";
    add(prefix + "blum", [=](benchmark::State& state) { frame_case(state, n, SignMode::none); });
    add(prefix + "blum-signed", [=](benchmark::State& state) { frame_case(state, n, SignMode::automatic); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
