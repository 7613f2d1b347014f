// Times closest points and signed distances of scattered points: a million in a box, and a million near the surface.
// Also times frames of a deforming mesh, and one call with few points.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/winding_numbers.hpp"
#include "blum/points/sample_surface.hpp"
#include "peers/peers.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

constexpr std::size_t a_million = 1000000;

/// Random points in a box 1.2 times the mesh's bounds.
std::vector<Vec3d> in_box(const TriangleMesh& mesh, std::size_t count) {
  const Box3 box = bounds(mesh);
  Random random(1);
  std::vector<Vec3d> points(count);
  for (Vec3d& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = box.center()[axis] + random.uniform(-0.6, 0.6) * box.size()[axis];
    }
  }
  return points;
}

/// Points of the surface in random order, with normally distributed offsets of 0.5 % of the diagonal.
std::vector<Vec3d> near_surface(const TriangleMesh& mesh, std::size_t count) {
  NearSampleOptions options;
  options.sigma = 0.005 * bounds(mesh).diagonal();
  options.sign = SignMode::none;
  return sample_near(mesh, count, options).points;
}

std::vector<Vec3d> places(const TriangleMesh& mesh, const std::string& where, std::size_t count) {
  return where == "box" ? in_box(mesh, count) : near_surface(mesh, count);
}

/// Compares some points with brute force: distances, and sides by the full winding number.
void check_points(benchmark::State& state, const Shape& input, const std::vector<Vec3d>& points,
                  const std::vector<ClosestPoint>& found, bool is_signed) {
  const double tolerance = 1e-9 * bounds(input.mesh).diagonal();
  const std::size_t step = std::max<std::size_t>(points.size() / 40, 1);
  for (std::size_t k = 0; k < points.size(); k += step) {
    const double distance = input.brute_force().nearest(points[k]).distance;
    const bool is_far = std::abs(std::abs(found[k].distance) - distance) > tolerance;
    const bool is_inside = is_signed && reference::winding_number(input.mesh, points[k]) > 0.5;
    if (is_far || (distance > tolerance && is_inside != (found[k].distance < 0))) {
      return state.SkipWithError("a wrong distance");
    }
  }
}

void many_case(benchmark::State& state, const std::string& name, const std::string& where, SignMode sign) {
  const Shape& input = shape(name);
  const std::vector<Vec3d> points = places(input.mesh, where, a_million);
  const ClosestPointQuery query(input.mesh, {.sign = sign});
  std::vector<ClosestPoint> found;
  const Times first = time_once([&] { found = query.nearest(points); });
  const Times times = time_runs([&] { found = query.nearest(points); });
  report(state, times, static_cast<double>(points.size()));
  state.counters["first_call_s"] = first.wall;
  check_points(state, input, points, found, sign != SignMode::none);
  state.SetLabel(input.note);
}

void embree_case(benchmark::State& state, const std::string& name, const std::string& where) {
  const Shape& input = shape(name);
  const std::vector<Vec3d> points = places(input.mesh, where, a_million);
  const std::optional<PeerPoints> found = embree_points(input.mesh, points, {});
  if (!found) return state.SkipWithError("Embree is not installed");
  report(state, found->times, static_cast<double>(points.size()));
  state.SetLabel(input.note);
}

void numbers_case(benchmark::State& state, const std::string& name, const std::string& where) {
  const Shape& input = shape(name);
  const std::vector<Vec3d> points = places(input.mesh, where, a_million);
  std::vector<double> found;
  report(state, time_runs([&] { found = winding_numbers(input.mesh, points); }), static_cast<double>(points.size()));
  for (std::size_t k = 0; k < points.size(); k += points.size() / 40) {
    if (std::abs(found[k] - reference::winding_number(input.mesh, points[k])) > 1.1e-6) {
      return state.SkipWithError("a wrong winding number");
    }
  }
  state.SetLabel(input.note);
}

/// Times whole frames: refit to moved vertices, and 10,000 points near the surface.
void frame_case(benchmark::State& state, SignMode sign) {
  const Shape& rest = shape("organic-100000");
  TriangleMesh moved = rest.mesh;
  ClosestPointQuery query(rest.mesh, {.sign = sign});
  std::vector<Times> runs;
  std::vector<Times> refits;
  Shape last;
  std::vector<ClosestPoint> found;
  std::vector<Vec3d> points;
  for (int frame = 0; frame < 20; ++frame) {
    for (std::size_t v = 0; v < moved.vertices.size(); ++v) {
      const Vec3d& p = rest.mesh.vertices[v];
      const double angle = 0.3 * std::sin(2 * p.z + 0.1 * frame);
      moved.vertices[v] = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y,
                           p.z};
    }
    points = near_surface(moved, 10000);
    const Times refit = time_once([&] { query.refit(moved.vertices); });
    Times whole = time_once([&] { found = query.nearest(points); });
    whole.wall += refit.wall;
    whole.cpu += refit.cpu;
    if (frame < 3) continue;
    refits.push_back(refit);
    runs.push_back(whole);
  }
  report(state, median(runs), static_cast<double>(points.size()));
  state.counters["refit_s"] = median(refits).wall;
  last.mesh = moved;
  check_points(state, last, points, found, sign != SignMode::none);
  state.SetLabel(rest.note);
}

/// Times one call with 10,000 points and a new mesh of 2,000 triangles.
void call_case(benchmark::State& state, const std::string& where, SignMode sign) {
  const Shape& input = shape("organic-2000");
  const std::vector<Vec3d> points = places(input.mesh, where, 10000);
  std::vector<ClosestPoint> found;
  const Times times = time_runs([&] { found = closest_points(input.mesh, points, {.sign = sign}); });
  report(state, times, static_cast<double>(points.size()));
  check_points(state, input, points, found, sign != SignMode::none);
  state.SetLabel(input.note);
}

const bool registered = [] {
  for (const std::string where : {"box", "near"}) {
    for (const std::string name : {"bunny", "rocker-arm"}) {
      const std::string prefix = "points/" + name + "/" + where + "/";
      add(prefix + "blum", [=](benchmark::State& state) { many_case(state, name, where, SignMode::none); });
      add(prefix + "blum-signed", [=](benchmark::State& state) { many_case(state, name, where, SignMode::automatic); });
      add(prefix + "blum-winding-numbers", [=](benchmark::State& state) { numbers_case(state, name, where); });
      add(prefix + "embree", [=](benchmark::State& state) { embree_case(state, name, where); });
    }
    add("points-call/organic-2000/" + where + "/blum",
        [=](benchmark::State& state) { call_case(state, where, SignMode::none); });
    add("points-call/organic-2000/" + where + "/blum-signed",
        [=](benchmark::State& state) { call_case(state, where, SignMode::automatic); });
  }
  add("points-frame/organic-100000/blum", [](benchmark::State& state) { frame_case(state, SignMode::none); });
  add("points-frame/organic-100000/blum-signed",
      [](benchmark::State& state) { frame_case(state, SignMode::automatic); });
  return true;
}();

}  // namespace
}  // namespace blum::bench
