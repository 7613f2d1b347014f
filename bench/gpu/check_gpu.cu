// Compares fields of a CUDA device with brute force in double, and with the same kernels on the host. The cases cover
// precision, signs, bands, slabs, determinism and arrays on the device. The program requires only a compiler and CUDA.
// It prints a line per case, and exits with 1 if a case fails.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/reference.hpp"
#include "blum/shapes/generators.hpp"
#include "field/cuda/cuda_device.cuh"
#include "field/kernels/emulated_device.hpp"
#include "field/kernels/field_engine.hpp"
#include "field/kernels/image_engine.hpp"
#include "gpu/meshes.hpp"

namespace blum::bench {
namespace {

struct Result {
  std::vector<float> distance;
  std::vector<std::uint32_t> site;

  [[nodiscard]] bool operator==(const Result& other) const {
    return distance.size() == other.distance.size() &&
           std::memcmp(distance.data(), other.distance.data(), distance.size() * sizeof(float)) == 0 &&
           site == other.site;
  }
};

template <class Device>
Result compute(Device& device, const TriangleMesh& mesh, FieldRequest request,
               std::size_t slab_nodes = std::size_t{1} << 23) {
  kernels::FieldEngine<Device> engine(device, slab_nodes);
  Result out;
  out.distance.resize(request.grid.node_count());
  out.site.resize(request.grid.node_count());
  request.distance = out.distance.data();
  request.site = out.site.data();
  engine.set_connectivity(mesh);
  (void)engine.compute(mesh, request, [] { return false; }, [](double) {});
  return out;
}

/// Computes the field from the caller's arrays on the device into arrays on the device.
Result compute_there(cuda::CudaDevice& device, const TriangleMesh& mesh, FieldRequest request) {
  cuda::CudaArray<Vec3d> vertices;
  cuda::CudaArray<Triangle> triangles;
  cuda::CudaArray<Segment> segments;
  cuda::CudaArray<std::uint32_t> points;
  device.upload(std::span<const Vec3d>(mesh.vertices), vertices);
  device.upload(std::span<const Triangle>(mesh.triangles), triangles);
  device.upload(std::span<const Segment>(mesh.segments), segments);
  device.upload(std::span<const std::uint32_t>(mesh.points), points);
  const DeviceMeshView view{{vertices.data(), ElementType::float64, vertices.size()},
                            {triangles.data(), ElementType::uint32, triangles.size()},
                            {segments.data(), ElementType::uint32, segments.size()},
                            {points.data(), ElementType::uint32, points.size()}};
  kernels::FieldEngine<cuda::CudaDevice> engine(device);
  engine.set_connectivity(view);
  const std::size_t nodes = request.grid.node_count();
  cuda::CudaArray<float> distance;
  cuda::CudaArray<std::uint32_t> site;
  distance.resize(nodes);
  site.resize(nodes);
  request.distance = distance.data();
  request.site = site.data();
  engine.compute(view.vertices, request);
  Result out;
  out.distance.resize(nodes);
  out.site.resize(nodes);
  device.download(distance.data(), nodes, out.distance.data());
  device.download(site.data(), nodes, out.site.data());
  return out;
}

struct Case {
  std::string name;
  TriangleMesh mesh;
  int resolution = 40;
  double band = 0;
  bool has_sides = false;
};

/// Errors as fractions of the diagonal of mesh and grid.
struct Errors {
  double distance = 0;
  double site = 0;
  double from_host = 0;
  std::size_t signs = 0;
};

Errors measure(const Case& c, const FieldRequest& request, const Result& device, const Result& host) {
  const GridSpec& grid = request.grid;
  Box3 box = bounds(c.mesh);
  box.extend(bounds(grid));
  const double diagonal = box.diagonal();
  const reference::BruteForce brute(c.mesh);
  Errors errors;
  Random random(7);
  const std::size_t sample = 200'000'000 / (200 * (brute.sites().size() + 1)) + 50;
  for (std::size_t k = 0; k < sample; ++k) {
    const auto node = static_cast<std::int64_t>(random.below(grid.node_count()));
    const Vec3d query =
        grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1], node / (grid.size[0] * grid.size[1]));
    const double truth = brute.nearest(query).distance;
    const double expected = c.band > 0 ? std::min(truth, c.band) : truth;
    const auto at = static_cast<std::size_t>(node);
    errors.distance = std::max(errors.distance, std::abs(std::abs(device.distance[at]) - expected) / diagonal);
    if (device.site[at] != kernels::dead_record) {
      errors.site = std::max(errors.site, (brute.site_distance(SiteId(device.site[at]), query) - truth) / diagonal);
    }
    if (c.has_sides && truth > 1e-6 * diagonal) {
      const double winding = reference::winding_number(c.mesh, query);
      if (std::abs(winding - 0.5) < 1e-9) continue;
      errors.signs += std::signbit(device.distance[at]) != (winding > 0.5) ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < device.distance.size(); ++k) {
    const double off = std::abs(static_cast<double>(device.distance[k]) - host.distance[k]) / diagonal;
    errors.from_host = std::max(errors.from_host, std::abs(off));
  }
  return errors;
}

bool run(cuda::CudaDevice& device, const Case& c) {
  FieldRequest request;
  request.grid = grid_around(bounds(c.mesh), c.resolution, 0.1);
  request.band = c.band;
  if (c.has_sides) request.sign = sign::Method::sums;
  const Result first = compute(device, c.mesh, request);
  const Result again = compute(device, c.mesh, request);
  const Result slabs = compute(device, c.mesh, request, 1);
  kernels::EmulatedDevice emulated;
  const Result host = compute(emulated, c.mesh, request);
  const Errors errors = measure(c, request, first, host);
  const bool is_same = first == again && first == slabs && first == compute_there(device, c.mesh, request);
  const bool is_good =
      errors.distance <= 1e-6 && errors.site <= 1e-6 && errors.from_host <= 2e-6 && errors.signs == 0 && is_same;
  std::printf("%-4s %-22s %8zu triangles %4d^3: distance %.1e, site %.1e, from the host's %.1e, %zu wrong signs, %s\n",
              is_good ? "ok" : "FAIL", c.name.c_str(), c.mesh.triangles.size(), c.resolution, errors.distance,
              errors.site, errors.from_host, errors.signs, is_same ? "same bytes" : "NOT THE SAME BYTES");
  return is_good;
}

/// An open sphere.
TriangleMesh bowl(int frequency) {
  TriangleMesh mesh = make_sphere({.frequency = frequency});
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return mesh.vertices[t[0]].z > 0.4; });
  return mesh;
}

/// @param is_quick  true for few, small cases, for compute-sanitizer.
std::vector<Case> cases(bool is_quick) {
  SoupOptions soup;
  soup.triangles = 500;
  soup.awkward = 0.5;
  if (is_quick) {
    return {{"box", make_box({}), 20, 0, true},
            {"knot in a band", noisy_knot(4'000), 24, 0.2, true},
            {"bowl", bowl(8), 20, 0, true},
            {"soup", make_soup(soup), 16}};
  }
  return {{"box", make_box({}), 40, 0, true},
          {"sphere", make_sphere({.frequency = 40}), 48, 0, true},
          {"gear", make_gear({}), 64, 0, true},
          {"knot", noisy_knot(20'000), 64, 0, true},
          {"knot in a band", noisy_knot(20'000), 64, 0.05, true},
          {"bowl", bowl(20), 48, 0, true},
          {"bowl in a band", bowl(20), 48, 0.1, true},
          {"soup", make_soup(soup), 40, 0, true},
          {"points", make_points(), 40},
          {"segments", make_segments(), 40}};
}

/// Runs one engine on meshes and grids that grow and shrink, in many slabs, so that it reuses its buffers.
bool run_frames(cuda::CudaDevice& device, bool is_quick) {
  kernels::FieldEngine<cuda::CudaDevice> engine(device, 1);
  bool is_same = true;
  for (const auto& [triangles, resolution] :
       {std::pair{4'000, 24}, {is_quick ? 4'000 : 60'000, is_quick ? 70 : 260}, {500, 12}, {8'000, 40}}) {
    const TriangleMesh mesh = noisy_knot(triangles);
    FieldRequest request;
    request.grid = grid_around(bounds(mesh), resolution, 0.1);
    // The size along z, where slabs are divided: 32 slices per slab.
    request.grid.size[2] = is_quick ? 70 : 170;
    request.sign = sign::Method::sums;
    Result out;
    out.distance.resize(request.grid.node_count());
    out.site.resize(request.grid.node_count());
    request.distance = out.distance.data();
    request.site = out.site.data();
    engine.set_connectivity(mesh);
    for (int frame = 0; frame < 2; ++frame) {
      (void)engine.compute(mesh, request, [] { return false; }, [](double) {});
    }
    is_same = is_same && out == compute(device, mesh, request, std::size_t{1} << 28);
  }
  std::printf("%-4s one engine, many frames and slabs: %s\n", is_same ? "ok" : "FAIL",
              is_same ? "same bytes" : "NOT THE SAME BYTES");
  return is_same;
}

/// Compares images with the kernels on the host, which the tests compare with brute force.
bool run_image(cuda::CudaDevice& device, const std::array<std::int64_t, 3>& size, const Vec3d& spacing,
               const DistanceTransformOptions& options) {
  VoxelImage image;
  image.grid.size = size;
  image.grid.spacing = spacing;
  Random random(3);
  std::vector<std::uint8_t> values(image.grid.node_count());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = random.below(1 + k % 400) == 0 ? 1 : 0;
  image.values = values;
  detail::ImageRequest request = detail::make_image_request(image.grid, options);
  const auto transform = [&](auto& on) {
    kernels::ImageEngine<std::decay_t<decltype(on)>> engine(on);
    Result out;
    out.distance.resize(values.size());
    out.site.resize(values.size());
    request.distance = out.distance.data();
    request.site = out.site.data();
    engine.set_image(image, request);
    (void)engine.select(request);
    engine.transform(request);
    return out;
  };
  kernels::EmulatedDevice emulated;
  const bool is_same = transform(device) == transform(emulated);
  std::printf("%-4s image %lldx%lldx%lld, %s, %s: %s\n", is_same ? "ok" : "FAIL", static_cast<long long>(size[0]),
              static_cast<long long>(size[1]), static_cast<long long>(size[2]),
              options.is_signed ? "signed" : "unsigned", request.integer ? "whole numbers" : "double",
              is_same ? "the host's bytes" : "NOT THE HOST'S BYTES");
  return is_same;
}

int run_images(cuda::CudaDevice& device, bool is_quick) {
  int failed = 0;
  const std::int64_t side = is_quick ? 40 : 150;
  for (const std::array<std::int64_t, 3>& size :
       std::vector<std::array<std::int64_t, 3>>{{side, side - 3, side + 5}, {3, 2 * side, 5}, {7, 1, 3 * side}}) {
    for (const Vec3d& spacing : {Vec3d{1, 1, 1}, Vec3d{0.7, 1.1, 0.3140001}}) {
      for (const bool is_signed : {true, false}) {
        failed += run_image(device, size, spacing, {.is_signed = is_signed}) ? 0 : 1;
      }
    }
  }
  return failed;
}

int main_of(bool is_quick) {
  cuda::check(cudaSetDevice(0), "choosing the device");
  cuda::CudaDevice device(nullptr);
  int failed = run_frames(device, is_quick) ? 0 : 1;
  failed += run_images(device, is_quick);
  const std::vector<Case> all = cases(is_quick);
  for (const Case& c : all) failed += run(device, c) ? 0 : 1;
  std::printf("%zu cases, %d failed\n", all.size() + 13, failed);
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace blum::bench

int main(int count, char** arguments) {
  try {
    return blum::bench::main_of(count > 1 && std::string(arguments[1]) == "--quick");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "check_gpu: %s\n", error.what());
    return 1;
  }
}
