#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

#include "blum/complex/sample_axis.hpp"
#include "blum/core/parallel.hpp"
#include "certificate/ball_union.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

constexpr double rounding_of_diagonal = 1e-9;

/// A ball around a sample of the axis, and the body that it should fill.
struct OwnedBall {
  Ball ball;
  std::uint32_t body = 0;
};

constexpr double parts_of_diagonal = 256;

/// Returns the largest distance between neighbouring samples of the axis. If the cells of the axis are finer, its
/// vertices suffice as samples.
double step_of_balls(const MedialView& axis, double diagonal) {
  constexpr double most_balls = 50'000;
  constexpr double parts = 200;
  return std::max(diagonal / parts, std::sqrt(area_of(axis) / most_balls));
}

/// Returns the median length of the edges, or 1/256 of the diagonal if that is less.
double default_step(const MedialView& axis, double diagonal) {
  std::vector<double> squares;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    const double squared = squared_length(axis.positions[a] - axis.positions[b]);
    if (squared > 0 && std::isfinite(squared)) squares.push_back(squared);
  };
  for (const auto& [a, b] : axis.edges) add(a, b);
  for (const auto& triangle : axis.triangles) add(triangle[0], triangle[1]);
  if (squares.empty()) return diagonal / parts_of_diagonal;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::clamp(std::sqrt(*middle), rounding_of_diagonal * diagonal, diagonal / parts_of_diagonal);
}

/// Measures the distances from samples of the surface to the balls.
void measure_surface(const std::vector<Sample>& samples, const BallUnion& balls, BallUnionCheck& check,
                     const Context& context) {
  struct Part {
    double largest = 0, moment = 0, area = 0;
  };
  constexpr std::size_t grain = 512;
  std::vector<Part> parts(samples.size() / grain + 1);
  parallel_for(context, samples.size(), grain, "surface to balls", [&](const WorkRange& range) {
    Part& part = parts[range.begin / grain];
    std::uint32_t closest = 0;
    for (std::size_t s = range.begin; s < range.end; ++s) {
      const double gap = std::max(balls.gap(samples[s].point, closest), 0.0);
      part.largest = std::max(part.largest, gap);
      part.moment += gap * samples[s].area;
      part.area += samples[s].area;
    }
  });
  Part all;
  for (const Part& part : parts) {
    all.largest = std::max(all.largest, part.largest);
    all.moment += part.moment;
    all.area += part.area;
  }
  check.solid_to_balls = all.largest;
  check.mean_solid_to_balls = all.area > 0 ? all.moment / all.area : 0;
}

constexpr std::size_t directions_per_ball = 32;
constexpr std::size_t most_directions = 100'000;

/// Returns directions spread evenly along a spiral from pole to pole.
std::array<Vec3d, directions_per_ball> directions() {
  std::array<Vec3d, directions_per_ball> result;
  for (std::size_t k = 0; k < directions_per_ball; ++k) {
    const double z = 1 - (2 * static_cast<double>(k) + 1) / directions_per_ball;
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / std::numbers::phi;
    const double out = std::sqrt(1 - z * z);
    result[k] = {out * std::cos(angle), out * std::sin(angle), z};
  }
  return result;
}

/// Returns the largest distance to the surface, over points on the spheres of balls that lie in no other ball.
double balls_to_surface(const std::vector<OwnedBall>& owned, const BallUnion& balls, const SolidOracle& solid,
                        const Context& context) {
  constexpr std::size_t grain = 64;
  const double margin = rounding_of_diagonal * solid.diagonal();
  // If there are very many balls, only every n-th one is sampled, because neighbouring balls are similar.
  const std::size_t every = owned.size() * directions_per_ball / most_directions + 1;
  const std::size_t count = (owned.size() + every - 1) / every;
  const auto ways = directions();
  std::vector<double> parts(count / grain + 1, 0);
  parallel_for(context, count, grain, "balls to surface", [&](const WorkRange& range) {
    BallUnion::Holders holders{};
    for (std::size_t b = range.begin; b < range.end; ++b) {
      const auto& [ball, body] = owned[b * every];
      if (ball.radius <= margin) continue;
      for (const Vec3d& way : ways) {
        const Vec3d p = ball.centre + way * ball.radius;
        if (balls.holds(p, margin, holders)) continue;
        double& most = parts[range.begin / grain];
        most = std::max(most, solid.distance_above(p, most, body));
      }
    }
  });
  return *std::max_element(parts.begin(), parts.end());
}

}  // namespace

BallUnionCheck check_balls(const MedialView& axis, const SolidOracle& solid, const std::vector<Location>& locations,
                           const Context& context) {
  BallUnionCheck check;
  std::vector<OwnedBall> owned;
  std::vector<Ball> balls;
  for (const AxisSample& sample : sample_axis(axis, step_of_balls(axis, solid.diagonal()))) {
    const bool is_ball =
        std::isfinite(squared_length(sample.position)) && std::isfinite(sample.radius) && sample.radius >= 0;
    if (!is_ball) continue;
    owned.push_back({{sample.position, sample.radius}, locations[sample.vertex].body});
    balls.push_back(owned.back().ball);
  }
  for (std::size_t v = 0; v < axis.positions.size(); ++v) {
    if (!all_finite(axis, v) || axis.radius[v] < 0) continue;
    const double room = locations[v].outside_by > 0 ? -locations[v].outside_by : locations[v].distance;
    check.balls_beyond_solid = std::max(check.balls_beyond_solid, axis.radius[v] - room);
  }
  if (balls.empty()) {
    check.solid_to_balls = check.mean_solid_to_balls = solid.diagonal();
    return check;
  }
  const BallUnion all(balls, context);
  const std::shared_ptr<const Samples> samples = solid.samples(default_step(axis, solid.diagonal()), context);
  check.step = samples->step;
  measure_surface(samples->list, all, check, context);
  check.balls_to_surface = balls_to_surface(owned, all, solid, context);
  return check;
}

}  // namespace blum::verifier
