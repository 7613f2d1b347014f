// Measures how long cancelled calls continue. Calls are cancelled at moments spread over their run. The result is the
// longest time from request to exception; the limit is 200 ms.
#include <atomic>
#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "blum/core/error.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/topology.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Work = std::function<void(const Context&)>;

constexpr int moments = 24;

/// Seconds from a request to cancel, `delay` after the start, to the end of the call; nullopt if it ended before.
std::optional<double> latency(const Work& work, std::chrono::duration<double> delay) {
  std::stop_source source;
  std::atomic<Clock::time_point> requested{Clock::time_point::max()};
  const std::jthread canceller([&] {
    std::this_thread::sleep_for(delay);
    requested = Clock::now();
    source.request_stop();
  });
  try {
    work(Context{.cancel = source.get_token()});
    return std::nullopt;
  } catch (const Cancelled&) {
    return std::chrono::duration<double>(Clock::now() - requested.load()).count();
  }
}

void cancel_case(benchmark::State& state, const Work& work) {
  const Times whole = time_once([&] { work({}); });
  double worst = 0;
  int cancelled = 0;
  for (int k = 0; k < moments; ++k) {
    const double delay = whole.wall * (k + 0.5) / moments;
    if (const auto seconds = latency(work, std::chrono::duration<double>(delay))) {
      worst = std::max(worst, *seconds);
      ++cancelled;
    }
  }
  state.SetIterationTime(worst);
  state.counters["worst_latency_ms"] = 1e3 * worst;
  state.counters["whole_s"] = whole.wall;
  state.counters["cancelled"] = cancelled;
  state.counters["load"] = whole.load;
}

void field_case(benchmark::State& state, const std::string& name, int n, SignMode sign) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  cancel_case(state, [&](const Context& context) { (void)distance_field(input.mesh, grid, {.sign = sign}, context); });
}

void image_case(benchmark::State& state, int n) {
  VoxelImage image{.grid = {.size = {n, n, n}},
                   .values = std::vector<std::uint8_t>(static_cast<std::size_t>(n) * n * n)};
  auto& values = std::get<std::vector<std::uint8_t>>(image.values);
  for (std::size_t k = 0; k < values.size(); k += 101) values[k] = 1;
  cancel_case(state, [&](const Context& context) { (void)distance_transform(image, {}, context); });
}

const bool registered = [] {
  for (const std::string name : {"bunny", "noisy-1.6M"}) {
    const std::string prefix = "cancel/" + name + "/";
    add(prefix + "field", [=](benchmark::State& state) { field_case(state, name, 256, SignMode::none); });
    add(prefix + "field-winding", [=](benchmark::State& state) { field_case(state, name, 256, SignMode::winding); });
    add(prefix + "topology", [=](benchmark::State& state) {
      cancel_case(state, [&](const Context& context) { (void)topology(shape(name).mesh, context); });
    });
    add(prefix + "closest-points", [=](benchmark::State& state) {
      const Shape& input = shape(name);
      std::vector<Vec3d> queries(input.mesh.vertices.begin(), input.mesh.vertices.end());
      for (Vec3d& query : queries) query *= 1.1;
      cancel_case(state, [&](const Context& context) { (void)closest_points(input.mesh, queries, {}, context); });
    });
  }
  add("cancel/image/512", [](benchmark::State& state) { image_case(state, 512); });
  return true;
}();

}  // namespace
}  // namespace blum::bench
