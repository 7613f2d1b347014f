// Proves the behaviour of calls of medial_axis(). Options out of range are rejected by name, and progress rises. A
// cancelled call stops in every phase.
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <optional>
#include <stop_token>
#include <thread>

#include "blum/grid/image_generators.hpp"
#include "blum/shapes/generators.hpp"
#include "support/medial_check.hpp"

namespace blum {
namespace {

void expect_refused(const MedialAxisOptions& options, const std::string& name) {
  try {
    (void)medial_axis(make_box({}), options);
    ADD_FAILURE() << name << " was not refused";
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
  }
}

TEST(MedialCall, OptionsOutOfRangeAreRefusedByName) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const int value : {-1, 0, 7, 801, 1 << 30}) {
    expect_refused({.resolution = value}, "resolution");
    expect_refused({.max_resolution = value}, "max_resolution");
  }
  for (const double value : {0.0, -1.0, nan, infinite, -infinite, 1e300}) {
    expect_refused({.spacing = value}, "spacing");
  }
  for (const double value : {-1e-9, nan, infinite, 1e300}) expect_refused({.lambda = value}, "lambda");
  for (const double value : {-1e-9, 180.1, nan}) expect_refused({.least_theta = value}, "least_theta");
  for (const double value : {-1e-9, 180.1, nan}) expect_refused({.greatest_theta = value}, "greatest_theta");
  expect_refused({.least_theta = 60, .greatest_theta = 59}, "greatest_theta");
  expect_refused({.spacing = 1e-9}, "too small");
}

TEST(MedialCall, OptionsAreCheckedForImages) {
  const VoxelImage image = make_ball_image({.size = 16});
  EXPECT_THROW((void)medial_axis(image, {.lambda = -1}), InvalidOption);
  MedialAxisOptions options;
  options.selection = LabelSelection::at_least(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW((void)medial_axis(image, options), InvalidOption);
}

TEST(MedialCall, AnglesOutOfRangeAreRefused) {
  const MedialAxis axis = medial_axis(make_box({}), {.resolution = 8});
  for (const double theta : {-1.0, -1e-9, 180.001, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)axis.simplify(theta), InvalidOption) << theta;
  }
  EXPECT_FALSE(axis.simplify(180).positions.empty());
}

TEST(MedialCall, TheGreatestAngleChangesNoAxis) {
  const TriangleMesh mesh = make_organic({.frequency = 24});
  const MedialAxis all = medial_axis(mesh, {.resolution = 48});
  const MedialAxis some = medial_axis(mesh, {.resolution = 48, .greatest_theta = 60});
  for (const double theta : {0.0, 20.0, 60.0}) {
    const Complex a = all.simplify(theta);
    const Complex b = some.simplify(theta);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.vertex_columns, b.vertex_columns);
    EXPECT_EQ(a.triangle_columns, b.triangle_columns);
  }
  EXPECT_EQ(some.greatest_theta(), 60);
  EXPECT_THROW((void)some.simplify(60.1), InvalidOption);
  EXPECT_THROW((void)some.nested(), InvalidOption);
}

TEST(MedialCall, TheLeastAndTheMostResolutionWork) {
  test::expect_certified(medial_axis(make_box({}), {.resolution = 8, .max_resolution = 8}), make_box({}), {1, 0, 0});
  const TriangleMesh rod = make_box({.size = {1, 0.02, 0.02}});
  test::expect_certified(medial_axis(rod, {.resolution = 800, .max_resolution = 800}), rod, {1, 0, 0});
  test::expect_certified(medial_axis(make_box({}), {.spacing = 1.7}), make_box({}), {1, 0, 0});
}

/// The reported fractions of a phase. Phases are listed in the order in which they began.
struct Told {
  std::string phase;
  std::vector<double> fractions;
};

std::vector<Told> progress_of(const MeshView& mesh, const MedialAxisOptions& options) {
  std::vector<Told> told;
  Context context;
  context.progress = [&](double fraction, std::string_view phase) {
    if (told.empty() || told.back().phase != phase) told.push_back({std::string(phase), {}});
    told.back().fractions.push_back(fraction);
  };
  (void)medial_axis(mesh, options, context);
  return told;
}

TEST(MedialCall, ProgressRisesInEveryPhase) {
  const std::vector<Told> all = progress_of(make_organic({.frequency = 24}), {.resolution = 64});
  EXPECT_GE(all.size(), 3U);
  for (const Told& told : all) {
    EXPECT_TRUE(std::is_sorted(told.fractions.begin(), told.fractions.end())) << told.phase;
    EXPECT_GE(told.fractions.front(), 0) << told.phase;
    EXPECT_LE(told.fractions.back(), 1) << told.phase;
    EXPECT_FALSE(told.phase.empty());
  }
}

using Clock = std::chrono::steady_clock;

/// Returns the seconds from the request to stop, made at `moment` seconds, to the end of the call; nullopt if the call
/// ended before.
std::optional<double> seconds_to_stop(const MeshView& mesh, double moment, double* whole = nullptr) {
  std::stop_source source;
  Clock::time_point asked = Clock::time_point::max();
  std::jthread waiting([&](const std::stop_token& token) {
    const auto until = Clock::now() + std::chrono::duration<double>(moment);
    while (Clock::now() < until && !token.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    asked = Clock::now();
    source.request_stop();
  });
  const auto begin = Clock::now();
  bool is_cancelled = false;
  try {
    (void)medial_axis(mesh, {}, {.cancel = source.get_token()});
  } catch (const Cancelled&) {
    is_cancelled = true;
  }
  const auto end = Clock::now();
  waiting.request_stop();
  waiting.join();
  if (whole != nullptr) *whole = std::chrono::duration<double>(end - begin).count();
  if (!is_cancelled) return std::nullopt;
  return std::chrono::duration<double>(end - asked).count();
}

TEST(SlowMedialCall, StopsSoonWheneverItIsAskedTo) {
  // The promise is 200 ms; the bound leaves room for a busy machine.
  constexpr double bound = 1.0;
  const TriangleMesh mesh = make_bracket({});
  double whole = 0;
  ASSERT_FALSE(seconds_to_stop(mesh, 1e9, &whole));
  double longest = 0;
  for (int k = 0; k < 10; ++k) {
    const double moment = whole * k / 10;
    const std::optional<double> seconds = seconds_to_stop(mesh, moment);
    if (!seconds) continue;
    longest = std::max(longest, *seconds);
    EXPECT_LE(*seconds, bound) << "asked to stop after " << moment << " of " << whole << " s";
  }
  RecordProperty("longest_ms", static_cast<int>(1000 * longest));
}

TEST(MedialCall, ACallThatIsCancelledBeforehandDoesNothing) {
  std::stop_source source;
  source.request_stop();
  const Context context{.cancel = source.get_token()};
  EXPECT_THROW((void)medial_axis(make_box({}), {.resolution = 16}, context), Cancelled);
  EXPECT_THROW((void)medial_axis(make_ball_image({.size = 16}), {}, context), Cancelled);
}

}  // namespace
}  // namespace blum
