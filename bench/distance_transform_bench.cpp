// Times the distance transform of images: seconds per image, voxels per second, CPU seconds.
// bench/peers/image_peers.py runs other programs on the same shapes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "blum/field/distance_transform.hpp"

namespace {

enum Shape : int { shell, ball, sparse, half };

const char* name_of(int shape) {
  constexpr const char* names[] = {"shell", "ball20%", "random1%", "random50%"};
  return names[shape];
}

/// An image of one shape. Shell: a bumpy surface around a fifth of the image, one or two voxels thick, as in a
/// voxelised scan. Ball: solid, 20 % of the voxels. Sparse and half: 1 % and 50 % of the voxels at random.
blum::VoxelImage make_image(std::int64_t n, int shape) {
  blum::VoxelImage image;
  image.grid.size = {n, n, n};
  std::vector<std::uint8_t> values(image.grid.node_count());
  std::mt19937 random(1);
  const double size = static_cast<double>(n);
  std::size_t index = 0;
  for (std::int64_t k = 0; k < n; ++k) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i, ++index) {
        const double x = (static_cast<double>(i) + 0.5) / size - 0.5;
        const double y = (static_cast<double>(j) + 0.5) / size - 0.5;
        const double z = (static_cast<double>(k) + 0.5) / size - 0.5;
        const double r = std::sqrt(x * x + y * y + z * z);
        bool selected = false;
        if (shape == shell) {
          const double surface = 0.33 + 0.03 * std::sin(11 * x) * std::sin(13 * y + 1) + 0.05 * std::sin(7 * z);
          selected = std::abs(r - surface) < 0.8 / size;
        } else if (shape == ball) {
          selected = r < 0.3628;
        } else {
          selected = random() < (shape == sparse ? 42949673U : 2147483648U);
        }
        values[index] = selected ? 1 : 0;
      }
    }
  }
  image.values = std::move(values);
  return image;
}

/// Arguments: side, shape, signed, threads, anisotropic spacing.
void transform(benchmark::State& state) {
  blum::VoxelImage image = make_image(state.range(0), static_cast<int>(state.range(1)));
  const bool is_signed = state.range(2) != 0;
  if (state.range(4) != 0) image.grid.spacing = {0.488281, 0.488281, 1.25};
  std::vector<blum::PhaseTime> phases;
  for (auto _ : state) {
    blum::Field field =
        blum::distance_transform(image, {.is_signed = is_signed}, {.threads = static_cast<int>(state.range(3))});
    benchmark::DoNotOptimize(field.distance.data());
    phases = field.phases;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(image.grid.node_count()));
  for (const auto& phase : phases) state.counters[phase.phase + " ms"] = phase.seconds * 1000;
  state.SetLabel(std::string(name_of(static_cast<int>(state.range(1)))) + (is_signed ? " signed" : " unsigned") +
                 (state.range(4) != 0 ? " 0.488 x 0.488 x 1.25" : ""));
}

void cases(benchmark::internal::Benchmark* benchmark) {
  for (const std::int64_t side : {128, 256, 512}) {
    for (const std::int64_t shape : {shell, ball, sparse, half}) {
      for (const std::int64_t is_signed : {0, 1}) benchmark->Args({side, shape, is_signed, 0, 0});
    }
  }
  benchmark->Args({256, shell, 0, 1, 0});
  benchmark->Args({512, shell, 0, 1, 0});
  benchmark->Args({512, shell, 0, 0, 1});
}

BENCHMARK(transform)
    ->Apply(cases)
    ->ArgNames({"side", "shape", "signed", "threads", "anisotropic"})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
