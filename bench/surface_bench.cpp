// Times distances over surfaces: maps of four million texels, and Hausdorff distances to a ten-thousandth of the
// diagonal. Also times thickness, and frames of deforming meshes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/surface_map/hausdorff_distance.hpp"
#include "blum/surface_map/surface_deviation.hpp"
#include "blum/surface_map/surface_distance_map.hpp"
#include "blum/surface_map/thickness.hpp"
#include "peers/peers.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

constexpr std::size_t many_texels = 4'000'000;

/// A mesh, moved and scaled to the centre and diagonal of another one.
TriangleMesh fitted(TriangleMesh mesh, const MeshView& to) {
  const Box3 from = bounds(mesh);
  const Box3 goal = bounds(to);
  const double scale = goal.diagonal() / from.diagonal();
  for (Vec3d& v : mesh.vertices) v = (v - from.center()) * scale + goal.center();
  return mesh;
}

/// The other mesh of a pair: a fitted shape, or a copy "shifted-X" or "noisy-X" by X of the diagonal.
TriangleMesh other_of(const TriangleMesh& mesh, const std::string& name) {
  const std::size_t dash = name.rfind('-');
  const double diagonal = bounds(mesh).diagonal();
  if (name.starts_with("shifted-")) {
    TriangleMesh out = mesh;
    const double by = std::stod(name.substr(dash + 1)) * diagonal;
    for (Vec3d& v : out.vertices) v += Vec3d{0.6, 0.64, 0.48} * by;
    return out;
  }
  if (name.starts_with("noisy-")) return make_noisy(mesh, std::stod(name.substr(dash + 1)) * diagonal, 1);
  return fitted(shape(name).mesh, mesh);
}

void map_case(benchmark::State& state, const std::string& name, const std::string& other_name) {
  const Shape& input = shape(name);
  const TriangleMesh other = other_of(input.mesh, other_name);
  const SurfaceMapper mapper(input.mesh, surface_atlas_of_size(input.mesh, many_texels), other);
  std::optional<SurfaceMap> map;
  const Times times = time_runs([&] { map = mapper.map(); });
  report(state, times, static_cast<double>(map->distance.size()));
  report_phases(state, map->phases);
  const reference::BruteForce slow(other);
  const SurfaceTexels all = surface_texels(input.mesh, *map->atlas);
  for (std::size_t k = 0; k < all.texels.size(); k += all.texels.size() / 40) {
    if (std::abs(slow.nearest(all.points[k]).distance - map->distance[all.texels[k]]) > 1e-6) {
      return state.SkipWithError("a wrong distance");
    }
  }
  state.counters["texels"] = static_cast<double>(all.texels.size());
  state.SetLabel(input.note);
}

/// Computes the same texels by Embree, with one query each.
void embree_map_case(benchmark::State& state, const std::string& name, const std::string& other_name, bool is_hinted) {
  const Shape& input = shape(name);
  const TriangleMesh other = other_of(input.mesh, other_name);
  const SurfaceAtlas atlas = surface_atlas_of_size(input.mesh, many_texels);
  const SurfaceTexels all = surface_texels(input.mesh, atlas);
  const std::optional<PeerPoints> found = embree_points(other, all.points, {}, is_hinted);
  if (!found) return state.SkipWithError("Embree is not installed");
  report(state, found->times, static_cast<double>(atlas.size()));
  state.counters["texels"] = static_cast<double>(all.texels.size());
  state.SetLabel(input.note);
}

double tolerance_of(const MeshView& a, const MeshView& b, double part) {
  Box3 box = bounds(a);
  box.extend(bounds(b));
  return part * box.diagonal();
}

void hausdorff_case(benchmark::State& state, const std::string& name, const std::string& other_name) {
  const Shape& input = shape(name);
  const TriangleMesh other = other_of(input.mesh, other_name);
  const HausdorffOptions options{.tolerance = tolerance_of(input.mesh, other, 1e-4)};
  HausdorffDistance found;
  report(state, time_runs([&] { found = hausdorff_distance(input.mesh, other, options); }), 1);
  state.counters["lower"] = found.lower;
  state.counters["upper"] = found.upper;
  state.counters["evaluations"] = static_cast<double>(found.forward.evaluations + found.backward.evaluations);
  if (found.upper - found.lower > *options.tolerance) return state.SkipWithError("a wide interval");
  state.SetLabel(input.note);
}

void cgal_case(benchmark::State& state, const std::string& name, const std::string& other_name) {
  const Shape& input = shape(name);
  const TriangleMesh other = other_of(input.mesh, other_name);
  const double tolerance = tolerance_of(input.mesh, other, 1e-4);
  const std::optional<PeerHausdorff> found = cgal_hausdorff(input.mesh, other, tolerance);
  if (!found) return state.SkipWithError("CGAL is not installed");
  report(state, found->times, 1);
  state.counters["distance"] = found->distance;
  const HausdorffDistance own = hausdorff_distance(input.mesh, other, {.tolerance = tolerance});
  if (found->distance < own.lower - tolerance || found->distance > own.upper + tolerance) {
    return state.SkipWithError("CGAL and Blum differ by more than both tolerances");
  }
  state.SetLabel(input.note);
}

/// Estimates the time of sampling with the same certainty: each surface point has a sample within the tolerance. Runs a
/// part of the samples with Blum's closest points, and scales the time.
void sampling_case(benchmark::State& state, const std::string& name, const std::string& other_name) {
  const Shape& input = shape(name);
  const TriangleMesh other = other_of(input.mesh, other_name);
  const double tolerance = tolerance_of(input.mesh, other, 1e-4);
  const ClosestPointQuery to_other(other, {.sign = SignMode::none});
  const SurfaceAtlas atlas = surface_atlas_of_size(input.mesh, many_texels);
  const SurfaceTexels part = surface_texels(input.mesh, atlas);
  const SurfaceDeviation area = surface_deviation(input.mesh, other, {.pieces = 1000});
  // Hexagons with the tolerance as radius cover a surface with the fewest points.
  const double needed = 2 * area.area / (1.5 * std::sqrt(3.0) * tolerance * tolerance);
  const Times times = time_runs([&] { (void)to_other.nearest(part.points); });
  const double fraction = static_cast<double>(part.points.size()) / needed;
  report(state, times, needed, fraction);
  state.counters["points"] = needed;
  state.SetLabel(input.note);
}

void thickness_case(benchmark::State& state, const std::string& name, ThicknessKind kind) {
  const Shape& input = shape(name);
  std::optional<SurfaceMap> map;
  report(state, time_once([&] { map = thickness_map(input.mesh, {}, {.kind = kind}); }), 1e6);
  report_phases(state, map->phases);
  state.SetLabel(input.note);
}

/// Two deforming meshes of 20,000 triangles, a million texels.
void frame_case(benchmark::State& state) {
  const Shape& rest = shape("organic-20000");
  TriangleMesh target = rest.mesh;
  TriangleMesh other = rest.mesh;
  for (Vec3d& v : other.vertices) v.x += 0.5;
  const TriangleMesh other_rest = other;
  SurfaceMapper mapper(target, other, {});
  std::vector<Times> runs;
  for (int frame = 0; frame < 12; ++frame) {
    for (std::size_t v = 0; v < target.vertices.size(); ++v) {
      const double bend = 0.05 * std::sin(3 * rest.mesh.vertices[v].z + 0.3 * frame);
      target.vertices[v] = rest.mesh.vertices[v] + Vec3d{bend, 0, 0};
      other.vertices[v] = other_rest.vertices[v] + Vec3d{0, bend, 0};
    }
    runs.push_back(time_once([&] {
      mapper.move_target(target.vertices);
      mapper.move_other(other.vertices);
      (void)mapper.map();
    }));
  }
  report(state, median(runs), 1e6);
  state.SetLabel(rest.note);
}

const bool registered = [] {
  for (const std::string other : {"rocker-arm", "noisy-0.001"}) {
    const std::string prefix = "surface-map/bunny/" + other + "/";
    add(prefix + "blum", [=](benchmark::State& state) { map_case(state, "bunny", other); });
    add(prefix + "embree", [=](benchmark::State& state) { embree_map_case(state, "bunny", other, false); });
    add(prefix + "embree-hinted", [=](benchmark::State& state) { embree_map_case(state, "bunny", other, true); });
  }
  for (const std::string other : {"organic", "shifted-0.01", "shifted-0.001", "noisy-0.001", "shifted-0"}) {
    const std::string prefix = "hausdorff/bunny/" + other + "/";
    add(prefix + "blum", [=](benchmark::State& state) { hausdorff_case(state, "bunny", other); });
    add(prefix + "cgal", [=](benchmark::State& state) { cgal_case(state, "bunny", other); });
    add(prefix + "sampling", [=](benchmark::State& state) { sampling_case(state, "bunny", other); });
  }
  add("thickness/rocker-arm/ray",
      [](benchmark::State& state) { thickness_case(state, "rocker-arm", ThicknessKind::ray); });
  add("thickness/rocker-arm/ball",
      [](benchmark::State& state) { thickness_case(state, "rocker-arm", ThicknessKind::ball); });
  add("surface-frame/organic-20000/blum", [](benchmark::State& state) { frame_case(state); });
  return true;
}();

}  // namespace
}  // namespace blum::bench
