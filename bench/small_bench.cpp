// Times small queries with one thread and with the default threads. Waking other threads takes longer than such a
// query, so both times should be equal. The counter `over_one` is their quotient.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/field/interpolate.hpp"
#include "blum/field/winding_numbers.hpp"
#include "blum/field/zero_surface.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/points/sample_surface.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/surface_map/hausdorff_distance.hpp"
#include "support/measure.hpp"

namespace blum::bench {
namespace {

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.vertices) p = p + by;
  return mesh;
}

std::vector<Vec3d> random_points(std::size_t count) {
  Random random(1);
  std::vector<Vec3d> points(count);
  for (Vec3d& p : points) p = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  return points;
}

ProximityScene scene_of(const std::vector<TriangleMesh>& meshes) {
  ProximityScene scene;
  for (const TriangleMesh& mesh : meshes) scene.add(mesh);
  return scene;
}

/// Boxes in a row, each of which meets the next one.
ProximityScene row_of(const TriangleMesh& box, double step) {
  std::vector<TriangleMesh> row;
  for (int k = 0; k < 16; ++k) row.push_back(moved(box, {step * k, 0.05 * k, 0}));
  return scene_of(row);
}

GridSpec grid_of(int nodes) {
  GridSpec grid;
  grid.origin = {-1, -1, -1};
  grid.spacing = Vec3d{1, 1, 1} * (2.0 / (nodes - 1));
  grid.size = {nodes, nodes, nodes};
  return grid;
}

VoxelImage small_image() {
  VoxelImage image;
  image.grid = grid_of(16);
  std::vector<std::uint8_t> voxels(image.grid.node_count());
  for (std::size_t k = 0; k < voxels.size(); k += 7) voxels[k] = 1;
  image.values = std::move(voxels);
  return image;
}

/// Input of the queries.
struct Input {
  TriangleMesh box = make_box();
  TriangleMesh ball = make_sphere();
  TriangleMesh next_box = moved(box, {1.3, 0.2, 0.1});
  std::vector<Vec3d> ten = random_points(10);
  std::vector<Vec3d> hundred = random_points(100);
  ClosestPointQuery of_box{box};
  ClosestPointQuery of_ball{ball};
  ProximityScene boxes = scene_of({box, next_box});
  ProximityScene balls = scene_of({ball, moved(ball, {2.5, 0.2, 0.1})});
  ProximityScene crossing_balls = scene_of({ball, moved(ball, {1.5, 0.2, 0.1})});
  ProximityScene row = row_of(box, 1.1);
  ProximityScene crossing_row = row_of(box, 0.9);
  Field field = distance_field(box, grid_of(16));
  VoxelImage image = small_image();
};

using Query = void (*)(const Input&, const Context&);

const std::vector<std::pair<std::string, Query>>& queries() {
  static const std::vector<std::pair<std::string, Query>> all{
      {"closest-box-10", [](const Input& in, const Context& c) { (void)in.of_box.nearest(in.ten, c); }},
      {"closest-box-100", [](const Input& in, const Context& c) { (void)in.of_box.nearest(in.hundred, c); }},
      {"closest-sphere-10", [](const Input& in, const Context& c) { (void)in.of_ball.nearest(in.ten, c); }},
      {"closest-sphere-100", [](const Input& in, const Context& c) { (void)in.of_ball.nearest(in.hundred, c); }},
      {"within-sphere-100", [](const Input& in, const Context& c) { (void)in.of_ball.within(in.hundred, 0.05, c); }},
      {"three-closest-sphere-100",
       [](const Input& in, const Context& c) { (void)in.of_ball.nearest_primitives(in.hundred, 3, c); }},
      {"one-shot-closest-box-10",
       [](const Input& in, const Context& c) { (void)closest_points(in.box, in.ten, {}, c); }},
      {"winding-box-100",
       [](const Input& in, const Context& c) { (void)winding_numbers(in.box, in.hundred, 1e-6, c); }},
      {"field-box-8", [](const Input& in, const Context& c) { (void)distance_field(in.box, grid_of(8), {}, c); }},
      {"field-box-16", [](const Input& in, const Context& c) { (void)distance_field(in.box, grid_of(16), {}, c); }},
      {"field-box-32", [](const Input& in, const Context& c) { (void)distance_field(in.box, grid_of(32), {}, c); }},
      {"interpolate-100", [](const Input& in, const Context& c) { (void)interpolate(in.field, in.hundred, c); }},
      {"zero-surface-16", [](const Input& in, const Context& c) { (void)zero_surface(in.field, 0, c); }},
      {"transform-16", [](const Input& in, const Context& c) { (void)distance_transform(in.image.view(), {}, c); }},
      {"sample-near-box-100", [](const Input& in, const Context& c) { (void)sample_near(in.box, 100, {}, c); }},
      {"crossings-box", [](const Input& in, const Context& c) { (void)find_self_intersections(in.box, 100, c); }},
      {"hausdorff-boxes",
       [](const Input& in, const Context& c) {
         (void)hausdorff_distance(in.box, in.next_box, {.tolerance = 0.05}, c);
       }},
      {"separation-boxes", [](const Input& in, const Context& c) { (void)in.boxes.separation(HUGE_VAL, c); }},
      {"separation-spheres", [](const Input& in, const Context& c) { (void)in.balls.separation(HUGE_VAL, c); }},
      {"separation-16-boxes", [](const Input& in, const Context& c) { (void)in.row.separation(HUGE_VAL, c); }},
      {"collisions-boxes", [](const Input& in, const Context& c) { (void)in.boxes.collisions(c); }},
      {"collisions-spheres", [](const Input& in, const Context& c) { (void)in.crossing_balls.collisions(c); }},
      {"collisions-16-boxes", [](const Input& in, const Context& c) { (void)in.crossing_row.collisions(c); }},
  };
  return all;
}

/// Runs both variants in turn, with pauses, and reports the medians. In a pause, idle threads fall asleep, as they do
/// in an interactive program. Calls without pauses would keep them awake.
void small_case(benchmark::State& state, Query run) {
  static const Input input;
  const auto timed = [&](const Context& context) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return time_once([&] { run(input, context); });
  };
  std::vector<Times> one;
  std::vector<Times> all;
  for (int k = 0; k < 101; ++k) {
    one.push_back(timed({.threads = 1}));
    all.push_back(timed({}));
  }
  const double one_s = median(one).wall;
  const double all_s = median(all).wall;
  state.SetIterationTime(all_s);
  state.counters["one_us"] = 1e6 * one_s;
  state.counters["default_us"] = 1e6 * all_s;
  state.counters["over_one"] = all_s / one_s;
  state.counters["load"] = one.front().load;
}

const bool registered = [] {
  for (const auto& [name, query] : queries()) {
    add("small/" + name, [run = query](benchmark::State& state) { small_case(state, run); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
