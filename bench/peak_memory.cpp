// Computes one field and prints its peak memory, in MiB, beyond the input and output arrays:
//   peak_memory bunny|fandisk|noisy-1.6M|organic-N|image N none|normals|winding|unsigned
#include <malloc.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>

#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "support/shapes.hpp"

namespace {

constexpr double mib = 1024.0 * 1024.0;

/// The present (VmRSS) or peak (VmHWM) memory of this process.
double status_mib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kib = 0;
    if (word == key + ":" && status >> kib) return kib / 1024;
  }
  return 0;
}

/// Resets the peak, which may come from reading or generating the input.
void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

blum::Field image_field(int n, double& before) {
  blum::VoxelImage image;
  image.grid.size = {n, n, n};
  std::vector<std::uint8_t> values(image.grid.node_count());
  for (std::int64_t k = 0, index = 0; k < n; ++k) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i, ++index) {
        const blum::Vec3d p = blum::Vec3d{double(i), double(j), double(k)} / double(n) - blum::Vec3d{0.5, 0.5, 0.5};
        values[static_cast<std::size_t>(index)] = std::abs(length(p) - 0.33) < 0.8 / n ? 1 : 0;
      }
    }
  }
  image.values = std::move(values);
  reset_peak();
  before = status_mib("VmRSS");
  return blum::distance_transform(image, {.is_signed = false});
}

blum::Field mesh_field(const std::string& name, int n, const std::string& mode, double& before) {
  using blum::SignMode;
  const auto& mesh = blum::bench::shape(name).mesh;
  const auto sign = mode == "normals" ? SignMode::normals : mode == "winding" ? SignMode::winding : SignMode::none;
  const auto grid = blum::bench::cube_grid(mesh, n);
  reset_peak();
  before = status_mib("VmRSS");
  return blum::distance_field(mesh, grid, {.sign = sign});
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 4) {
    std::fputs("usage: peak_memory SHAPE N none|normals|winding|unsigned\n", stderr);
    return 2;
  }
  const std::string name = arguments[1];
  const int n = std::atoi(arguments[2]);
  double before = 0;
  const blum::Field field = name == "image" ? image_field(n, before) : mesh_field(name, n, arguments[3], before);
  const double peak = status_mib("VmHWM");
  const double outputs = static_cast<double>(field.distance.size() * (sizeof(float) + sizeof(blum::SiteId))) / mib;
  double seconds = 0;
  for (const auto& phase : field.phases) seconds += phase.seconds;
  std::printf("peak_MiB %.1f\nbefore_MiB %.1f\noutputs_MiB %.1f\nextra_MiB %.1f\nwall_s %.3f\n", peak, before, outputs,
              peak - before - outputs, seconds);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "peak_memory: %s\n", error.what());
  return 1;
}
