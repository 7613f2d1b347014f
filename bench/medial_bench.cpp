// Times medial axes of meshes and images: seconds of each phase, time per voxel of the solid, and peak memory. Meshes
// include the certificate. bench/peers/skeleton_peers.py runs other programs on the same images.
#include <sys/resource.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/certificate/axis_verifier.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

constexpr double theta = 60;

/// Peak memory of this process so far.
double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void mesh_case(benchmark::State& state, const std::string& name, int resolution) {
  const Shape& solid = shape(name);
  MedialAxisOptions options;
  options.resolution = resolution;
  options.least_theta = theta;
  std::vector<PhaseTime> phases;
  double certificate_seconds = 0;
  bool is_certified = false;
  double voxels = 0;
  const Times times = time_runs([&] {
    const MedialAxis axis = medial_axis(solid.mesh, options);
    const Complex complex = axis.simplify(theta);
    phases = axis.report().phases;
    const Times check = time_once([&] { is_certified = certify(complex, solid.mesh).holds(); });
    certificate_seconds = check.wall;
    voxels = static_cast<double>(axis.report().bodies.front().voxels);
  });
  report(state, times, voxels);
  report_phases(state, phases);
  state.counters["phase certificate"] = certificate_seconds;
  state.counters["certified"] = is_certified ? 1 : 0;
  state.SetLabel(solid.note);
}

/// Certifies six axes of one solid with one shared verifier, and with one verifier each.
void verifier_case(benchmark::State& state, const std::string& name) {
  const Shape& solid = shape(name);
  const MedialAxis axis = medial_axis(solid.mesh, {.resolution = 128});
  std::vector<std::pair<Complex, CertificateOptions>> axes;
  for (const double angle : {10.0, 20.0, 40.0, 60.0, 90.0, 120.0}) {
    CertificateOptions options;
    options.theta = angle;
    options.lambda = 0;
    options.spacing = axis.report().bodies.front().spacing;
    DecimatedAxis lean = decimate(axis.fitted(angle), *options.spacing / 4);
    options.deviation = lean.deviation;
    axes.emplace_back(std::move(lean.axis), options);
  }
  std::size_t certified = 0;
  const Times together = time_runs([&] {
    const AxisVerifier verifier(solid.mesh);
    certified = 0;
    for (const auto& [complex, options] : axes) certified += verifier.certify(complex, options).holds() ? 1 : 0;
  });
  const Times one = time_runs([&] { (void)certify(axes[3].first, solid.mesh, axes[3].second); });
  const Times apart = time_runs([&] {
    for (const auto& [complex, options] : axes) (void)certify(complex, solid.mesh, options);
  });
  report(state, together, static_cast<double>(axes.size()));
  state.counters["one_axis"] = one.cpu;
  state.counters["six_verifiers"] = apart.cpu;
  state.counters["certified"] = static_cast<double>(certified);
  state.SetLabel(solid.note);
}

/// A smooth, bumpy body of a fifth of the voxels.
VoxelImage bumpy_image(std::int64_t n) {
  VoxelImage image;
  image.grid.size = {n, n, n};
  std::vector<std::uint8_t> values(image.grid.node_count());
  const double size = static_cast<double>(n);
  std::size_t index = 0;
  for (std::int64_t k = 0; k < n; ++k) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i, ++index) {
        const double x = (static_cast<double>(i) + 0.5) / size - 0.5;
        const double y = (static_cast<double>(j) + 0.5) / size - 0.5;
        const double z = (static_cast<double>(k) + 0.5) / size - 0.5;
        const double surface = 0.355 + 0.03 * std::sin(11 * x) * std::sin(13 * y + 1) + 0.05 * std::sin(7 * z);
        values[index] = std::sqrt(x * x + y * y + z * z) < surface ? 1 : 0;
      }
    }
  }
  image.values = std::move(values);
  return image;
}

void image_case(benchmark::State& state, std::int64_t side) {
  const VoxelImage image = bumpy_image(side);
  const double image_mib = static_cast<double>(image.grid.node_count()) / (1024 * 1024);
  MedialAxisOptions options;
  options.least_theta = theta;
  std::vector<PhaseTime> phases;
  double voxels = 0;
  const Times times = time_runs([&] {
    const MedialAxis axis = medial_axis(image, options);
    phases = axis.report().phases;
    voxels = static_cast<double>(axis.report().bodies.front().voxels);
  });
  report(state, times, voxels);
  report_phases(state, phases);
  state.counters["solid_voxels"] = voxels;
  state.counters["ns_per_solid_voxel"] = 1e9 * times.wall / voxels;
  // Cases run in ascending order of side, so that the peak so far belongs to this case.
  state.counters["peak_MiB_beyond_image"] = peak_mib() - image_mib;
}

const bool registered = [] {
  for (const std::string name : {"rocker-arm", "fandisk", "organic"}) {
    for (const int resolution : {128, 256}) {
      add("medial/" + name + "/" + std::to_string(resolution),
          [=](benchmark::State& state) { mesh_case(state, name, resolution); });
    }
  }
  for (const std::string name : {"fandisk", "organic"}) {
    add("medial-verifier/" + name, [=](benchmark::State& state) { verifier_case(state, name); });
  }
  for (const std::int64_t side : {64, 128, 256, 512, 640}) {
    add("medial-image/" + std::to_string(side), [=](benchmark::State& state) { image_case(state, side); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
