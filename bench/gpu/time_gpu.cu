// Times fields on a CUDA device, with results in its memory: medians of many warm runs and times of the steps. The
// baseline computes the same field by one query of the hierarchy per node. Prints a table; --json FILE writes the
// figures.
//   time_gpu [--json FILE] [--mesh FILE.off|FILE.obj] [--runs N] [--quick]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "blum/grid/grid_spec.hpp"
#include "field/cuda/cuda_device.cuh"
#include "field/image_request.hpp"
#include "field/kernels/crossings.hpp"
#include "field/kernels/field_pipeline.hpp"
#include "field/kernels/image_transform.hpp"
#include "gpu/meshes.hpp"

namespace blum::bench {
namespace {

using cuda::check;
using cuda::CudaArray;
using cuda::CudaDevice;
using kernels::warp_size;

/// The baseline: each node searches the same trees by itself, and descends to the nearest box first.
struct QueryPerNode {
  kernels::Forest forest;
  const kernels::NormalFrame* frame;
  std::int32_t size[3];
  FieldRequest request;

  __device__ void operator()(std::size_t index) const {
    const auto x = static_cast<double>(index % size[0]);
    const auto y = static_cast<double>(index / size[0] % size[1]);
    const auto z = static_cast<double>(index / (static_cast<std::size_t>(size[0]) * size[1]));
    const Vec3f query = kernels::to_float(Vec3d{frame->at(0, x), frame->at(1, y), frame->at(2, z)});
    std::uint32_t stack[kernels::SearchStack::capacity];
    std::uint32_t top = 0;
    for (std::uint32_t kind = kernels::kind_count; kind-- > 0;) {  // vertices on top of the stack, as in NearestSearch
      const kernels::Tree& tree = forest.trees[kind];
      if (tree.levels > 0) stack[top++] = kernels::Entry::make(kind, tree.levels, 0).code;
    }
    float best = std::numeric_limits<float>::max();
    std::uint32_t id = kernels::dead_record;
    while (top > 0) {
      const kernels::Entry entry{stack[--top]};
      const kernels::Tree& tree = forest.trees[entry.kind()];
      const std::uint32_t first = entry.index() * warp_size;
      if (entry.level() == 0) {
        const std::uint32_t last = kernels::smaller(first + warp_size, tree.record_count);
        for (std::uint32_t k = first; k < last; ++k) {
          Vec3f point;
          if (!kernels::closest_on_record(entry.kind(), tree.records[k], query, point)) continue;
          const float squared = squared_length(query - point);
          if (squared < best) {
            best = squared;
            id = tree.records[k].id;
          }
        }
        continue;
      }
      const std::uint32_t level = entry.level() - 1;
      const std::uint32_t last = kernels::smaller(first + warp_size, tree.box_count[level]);
      std::uint32_t nearest = first;
      float nearest_squared = std::numeric_limits<float>::infinity();
      for (std::uint32_t k = first; k < last; ++k) {
        const float squared = kernels::squared_distance_to_box(query, tree.boxes[level][k]);
        if (squared < nearest_squared) {
          nearest_squared = squared;
          nearest = k;
        }
      }
      for (std::uint32_t k = first; k < last; ++k) {
        if (k != nearest && kernels::squared_distance_to_box(query, tree.boxes[level][k]) < best) {
          stack[top++] = kernels::Entry::make(entry.kind(), level, k).code;
        }
      }
      if (nearest_squared < best) stack[top++] = kernels::Entry::make(entry.kind(), level, nearest).code;
    }
    request.distance[index] = sqrtf(best) * static_cast<float>(1 / frame->scale);
    request.site[index] = id;
  }
};

/// Draws an image of balls on a lattice. Their sizes grow along x.
struct DrawBalls {
  std::uint32_t side;
  std::uint8_t* values;
  __device__ void operator()(std::size_t index) const {
    const auto cell = static_cast<float>(side) / 5;
    const float at[3] = {static_cast<float>(index % side), static_cast<float>(index / side % side),
                         static_cast<float>(index / side / side)};
    float squared = 0;
    for (const float x : at) squared += (fmodf(x, cell) - cell / 2) * (fmodf(x, cell) - cell / 2);
    const float radius = cell * (0.15F + 0.3F * at[0] / static_cast<float>(side));
    values[index] = squared < radius * radius ? 1 : 0;
  }
};

/// Measures the steps of one run by events.
class Laps {
 public:
  Laps() {
    for (cudaEvent_t& event : events_) check(cudaEventCreate(&event), "making an event");
  }
  Laps(const Laps&) = delete;
  Laps& operator=(const Laps&) = delete;
  ~Laps() {
    for (const cudaEvent_t event : events_) (void)cudaEventDestroy(event);
  }
  void start() { mark(count_ = 0); }
  void lap() { mark(++count_); }
  /// Milliseconds of each step. Waits for the last step.
  [[nodiscard]] std::vector<double> milliseconds() const {
    check(cudaEventSynchronize(events_[count_]), "waiting");
    std::vector<double> out;
    for (int k = 0; k < count_; ++k) {
      float ms = 0;
      check(cudaEventElapsedTime(&ms, events_[k], events_[k + 1]), "reading a clock");
      out.push_back(ms);
    }
    return out;
  }

 private:
  void mark(int which) { check(cudaEventRecord(events_[which], nullptr), "marking"); }
  cudaEvent_t events_[8] = {};
  int count_ = 0;
};

/// Memory bandwidth of the current device in gigabytes per second, from its clock and bus width.
double bandwidth() {
  int device = 0;
  int kilohertz = 0;
  int bits = 0;
  check(cudaGetDevice(&device), "asking for the device");
  check(cudaDeviceGetAttribute(&kilohertz, cudaDevAttrMemoryClockRate, device), "asking for the memory's clock");
  check(cudaDeviceGetAttribute(&bits, cudaDevAttrGlobalMemoryBusWidth, device), "asking for the memory's width");
  return 2.0 * kilohertz * (bits / 8) / 1e6;  // two transfers per clock
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Case {
  std::string name;
  TriangleMesh mesh;
  int resolution = 256;
  double must = 0;  ///< milliseconds
  double aim = 0;
  bool has_baseline = false;
  bool is_frame = false;  ///< a deforming mesh: its connectivity exists already
};

struct Timing {
  double total = 0;
  std::vector<double> steps;  ///< upload and connectivity; records and trees; tiles; signs, which total excludes
  double baseline = 0;
};

class Timer {
 public:
  explicit Timer(int runs) : device_(nullptr), runs_(runs) {}

  Timing run(const Case& c) {
    const GridSpec grid = grid_around(bounds(c.mesh), c.resolution, 0.1);
    kernels::FieldPipeline<CudaDevice> pipeline(device_);
    kernels::CrossingSigns<CudaDevice> signs(device_);
    distance_.resize(grid.node_count());
    site_.resize(grid.node_count());
    FieldRequest request;
    request.grid = grid;
    request.distance = distance_.data();
    request.site = site_.data();
    std::vector<std::vector<double>> samples;
    Laps laps;
    for (int k = -3; k < runs_; ++k) {  // the first three runs warm up
      laps.start();
      const kernels::DeviceMesh mesh = upload(c, k == -3 || !c.is_frame);
      if (k == -3 || !c.is_frame) {
        pipeline.set_connectivity(mesh);
        signs.set_connectivity(pipeline.connectivity());
      }
      laps.lap();
      pipeline.prepare(mesh, grid);
      laps.lap();
      pipeline.compute(0, grid.size[2], request);
      laps.lap();
      signs.prepare(mesh, grid);
      signs.apply(0, grid.size[2], request, pipeline.frame());
      laps.lap();
      const std::vector<double> steps = laps.milliseconds();
      if (k >= 0) samples.push_back(steps);
    }
    pipeline.check_frame();
    Timing timing;
    std::vector<double> totals;
    for (const auto& steps : samples) totals.push_back(steps[0] + steps[1] + steps[2]);
    timing.total = median(totals);
    for (std::size_t s = 0; s < 4; ++s) {
      std::vector<double> values;
      for (const auto& steps : samples) values.push_back(steps[s]);
      timing.steps.push_back(median(values));
    }
    if (c.has_baseline) timing.baseline = baseline(pipeline, request);
    return timing;
  }

  /// Milliseconds of a signed transform of an image of balls. Its values are on the device.
  double run_image(std::int64_t side) {
    const auto count = static_cast<std::size_t>(side * side * side);
    CudaArray<std::uint8_t> values;
    values.resize(count);
    device_.for_each(count, DrawBalls{static_cast<std::uint32_t>(side), values.data()});
    distance_.resize(count);
    site_.resize(count);
    GridSpec grid;
    grid.size = {side, side, side};
    kernels::ImageTransform<CudaDevice> transform(device_);
    transform.set_request(detail::make_image_request(grid, {}));
    std::vector<double> samples;
    Laps laps;
    for (int k = -3; k < runs_; ++k) {
      laps.start();
      transform.select(values.data(), LabelSelection{});
      transform.run(distance_.data(), site_.data());
      laps.lap();
      const double ms = laps.milliseconds()[0];
      if (k >= 0) samples.push_back(ms);
    }
    return median(samples);
  }

 private:
  kernels::DeviceMesh upload(const Case& c, bool with_indices) {
    device_.upload(std::span<const Vec3d>(c.mesh.vertices), vertices_);
    if (with_indices) device_.upload(std::span<const Triangle>(c.mesh.triangles), triangles_);
    return {vertices_.data(),
            triangles_.data(),
            nullptr,
            nullptr,
            static_cast<std::uint32_t>(c.mesh.vertices.size()),
            static_cast<std::uint32_t>(c.mesh.triangles.size()),
            0,
            0};
  }

  double baseline(const kernels::FieldPipeline<CudaDevice>& pipeline, const FieldRequest& request) {
    const GridSpec& grid = request.grid;
    const QueryPerNode body{pipeline.forest(),
                            pipeline.frame(),
                            {static_cast<std::int32_t>(grid.size[0]), static_cast<std::int32_t>(grid.size[1]),
                             static_cast<std::int32_t>(grid.size[2])},
                            request};
    std::vector<double> values;
    Laps laps;
    for (int k = -1; k < 3; ++k) {
      laps.start();
      device_.for_each(grid.node_count(), body);
      laps.lap();
      const double ms = laps.milliseconds()[0];
      if (k >= 0) values.push_back(ms);
    }
    return median(values);
  }

  CudaDevice device_;
  int runs_;
  CudaArray<Vec3d> vertices_;
  CudaArray<Triangle> triangles_;
  CudaArray<float> distance_;
  CudaArray<std::uint32_t> site_;
};

struct Options {
  std::string json, mesh;
  int runs = 25;
  bool is_quick = false;
};

std::vector<Case> cases(const Options& options) {
  const TriangleMesh bunny = options.mesh.empty() ? noisy_knot(69'451) : read_plain_mesh(options.mesh);
  TriangleMesh pair = noisy_knot(2'000);
  append(pair, noisy_knot(2'000), {0.1, 0.2, 0.1});
  std::vector<Case> all{{"69 k triangles, 256^3", bunny, 256, 8, 2, true, false},
                        {"two of 2 k triangles deforming, 256^3", pair, 256, 3, 1, true, true}};
  if (options.is_quick) return all;
  for (const int resolution : {64, 128, 192, 384}) {
    const std::string name = "69 k triangles, " + std::to_string(resolution) + "^3";
    all.push_back({name, bunny, resolution, 0, 0, resolution < 256, false});
  }
  for (const int triangles : {1'000, 8'000, 32'000, 128'000, 512'000}) {
    const std::string name = std::to_string(triangles / 1000) + " k triangles, 256^3";
    all.push_back({name, noisy_knot(triangles), 256, 0, 0, true, false});
  }
  all.push_back({"69 k triangles, 512^3", bunny, 512, 30, 8, false, false});
  all.push_back({"1.6 M triangles, 256^3", noisy_knot(1'600'000), 256, 40, 12, true, false});
  TriangleMesh open = bunny;
  open.triangles.resize(open.triangles.size() - open.triangles.size() / 50);
  all.push_back({"the same with an opening, 256^3", open, 256, 0, 0, false, false});
  all.push_back({"sphere of 320 k triangles, 256^3", make_sphere({.frequency = 126}), 256, 0, 0, true, false});
  return all;
}

int main_of(const Options& options) {
  check(cudaSetDevice(0), "choosing the device");
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, 0), "asking for the device's name");
  std::printf("%s, %d processors, %.0f GiB\n", properties.name, properties.multiProcessorCount,
              static_cast<double>(properties.totalGlobalMem) / (1 << 30));
  std::FILE* json = options.json.empty() ? nullptr : std::fopen(options.json.c_str(), "w");
  if (json != nullptr) {
    std::fprintf(json, "{\"device\": \"%s\", \"bandwidth_gb_per_s\": %.0f, \"cases\": [", properties.name, bandwidth());
  }
  std::printf("%-40s %9s %9s %9s %9s | %9s %9s | %9s %9s\n", "case", "ms", "upload", "trees", "tiles", "must", "aim",
              "signs", "per node");
  Timer timer(options.runs);
  bool is_first = true;
  for (const Case& c : cases(options)) {
    const Timing t = timer.run(c);
    std::printf("%-40s %9.3f %9.3f %9.3f %9.3f | %9.1f %9.1f | %9.3f %9.2f\n", c.name.c_str(), t.total, t.steps[0],
                t.steps[1], t.steps[2], c.must, c.aim, t.steps[3], t.baseline);
    if (json != nullptr) {
      std::fprintf(
          json,
          "%s\n  {\"name\": \"%s\", \"triangles\": %zu, \"resolution\": %d, \"ms\": %.4f, \"upload_ms\": %.4f, "
          "\"trees_ms\": %.4f, \"tiles_ms\": %.4f, \"signs_ms\": %.4f, \"must_ms\": %g, \"aim_ms\": %g, "
          "\"query_per_node_ms\": %.4f}",
          is_first ? "" : ",", c.name.c_str(), c.mesh.triangles.size(), c.resolution, t.total, t.steps[0], t.steps[1],
          t.steps[2], t.steps[3], c.must, c.aim, t.baseline);
    }
    is_first = false;
  }
  if (!options.is_quick) {
    const double ms = timer.run_image(512);
    std::printf("%-40s %9.3f %29s | %9.1f %9.1f |\n", "image 512^3, distance and feature", ms, "", 25.0, 8.0);
    if (json != nullptr) {
      std::fprintf(json, ",\n  {\"name\": \"image 512^3\", \"ms\": %.4f, \"must_ms\": 25, \"aim_ms\": 8}", ms);
    }
  }
  if (json != nullptr) {
    std::fprintf(json, "\n]}\n");
    std::fclose(json);
  }
  return 0;
}

Options parse(int count, char** arguments) {
  Options options;
  for (int k = 1; k < count; ++k) {
    const std::string name = arguments[k];
    const auto value = [&]() -> std::string {
      if (k + 1 == count) throw std::runtime_error(name + " needs a value");
      return arguments[++k];
    };
    if (name == "--json") {
      options.json = value();
    } else if (name == "--mesh") {
      options.mesh = value();
    } else if (name == "--runs") {
      options.runs = std::max(1, std::atoi(value().c_str()));
    } else if (name == "--quick") {
      options.is_quick = true;
    } else {
      throw std::runtime_error("unknown option " + name);
    }
  }
  return options;
}

}  // namespace
}  // namespace blum::bench

int main(int count, char** arguments) {
  try {
    return blum::bench::main_of(blum::bench::parse(count, arguments));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "time_gpu: %s\n", error.what());
    return 1;
  }
}
