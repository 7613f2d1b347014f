// Impacts of moving features: the library always agrees with slow rational arithmetic.
#include "blum/proximity/impact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <sstream>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "proximity/exact/exact_impact.hpp"
#include "proximity/exact/shifted_impact.hpp"
#include "proximity/impact_filter.hpp"
#include "support/slow_impact.hpp"

namespace blum {
namespace {

using detail::FeatureKinds;
using detail::FilteredImpact;
using test::ContactTime;

std::string text(const FourMovingPoints& points) {
  std::ostringstream out;
  out.precision(17);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3d& a = points.start[k];
    const Vec3d& b = points.end[k];
    out << "(" << a.x << ", " << a.y << ", " << a.z << ") to (" << b.x << ", " << b.y << ", " << b.z << ")\n";
  }
  return out.str();
}

FourMovingPoints with_each(const FourMovingPoints& points, const std::function<Vec3d(const Vec3d&)>& move) {
  FourMovingPoints out = points;
  for (auto* ends : {&out.start, &out.end}) {
    for (Vec3d& p : *ends) p = move(p);
  }
  return out;
}

void expect_time(const std::optional<double>& found, const std::optional<ContactTime>& right, double tolerance) {
  ASSERT_EQ(found.has_value(), right.has_value());
  if (!found) return;
  EXPECT_LE(*found, right->high);
  EXPECT_GE(*found, right->low - tolerance);
}

std::optional<ContactTime> slow_impact(const FourMovingPoints& points, FeatureKinds kinds, double distance) {
  if (kinds == FeatureKinds::vertex_face) {
    return distance > 0 ? test::slow_vertex_face_approach(points, distance) : test::slow_vertex_face_impact(points);
  }
  return distance > 0 ? test::slow_edge_edge_approach(points, distance) : test::slow_edge_edge_impact(points);
}

std::optional<double> exact_impact(const FourMovingPoints& points, FeatureKinds kinds, const ImpactOptions& options) {
  const auto& [tolerance, distance] = options;
  if (kinds == FeatureKinds::vertex_face) {
    return distance > 0 ? detail::exact_vertex_face_approach(points, distance, tolerance)
                        : detail::exact_vertex_face_impact(points, tolerance);
  }
  return distance > 0 ? detail::exact_edge_edge_approach(points, distance, tolerance)
                      : detail::exact_edge_edge_impact(points, tolerance);
}

/// Checks the result, that of doubles alone and that of integers alone. @return true if the features meet.
bool expect_right(const FourMovingPoints& points, const ImpactOptions& options = {}) {
  SCOPED_TRACE(text(points));
  bool any = false;
  for (const FeatureKinds kinds : {FeatureKinds::vertex_face, FeatureKinds::edge_edge}) {
    const bool is_face = kinds == FeatureKinds::vertex_face;
    SCOPED_TRACE(is_face ? "vertex and face" : "edge and edge");
    const auto right = slow_impact(points, kinds, options.min_separation);
    const double tolerance = options.tolerance;
    const auto found = is_face ? vertex_face_impact(points, options) : edge_edge_impact(points, options);
    expect_time(found, right, tolerance);
    EXPECT_EQ(found, exact_impact(points, kinds, options));  // times do not depend on the arithmetic
    const FilteredImpact filtered = detail::filtered_impact(points, kinds, options);
    if (filtered.answer == FilteredImpact::Answer::never) {
      EXPECT_FALSE(right);
    } else if (filtered.answer == FilteredImpact::Answer::meets) {
      EXPECT_EQ(filtered.time, found);
    }
    any = any || right;
  }
  return any;
}

/// Checks the time at which the features come within a distance. @return true if they do.
bool expect_right_approach(const FourMovingPoints& points, double distance) {
  return expect_right(points, {.min_separation = distance});
}

FourMovingPoints random_points(const std::function<Vec3d()>& next) {
  FourMovingPoints out;
  for (auto* ends : {&out.start, &out.end}) {
    for (Vec3d& p : *ends) p = next();
  }
  return out;
}

/// Coordinates are integers from -most to most. Nearly all contacts are degenerate.
FourMovingPoints on_lattice(Random& random, std::uint64_t most) {
  const auto next = [&] { return static_cast<double>(random.below(2 * most + 1)) - static_cast<double>(most); };
  return random_points([&] {
    const double x = next();
    const double y = next();
    return Vec3d{x, y, next()};
  });
}

TEST(Impact, MatchesRationalArithmeticForRandomPoints) {
  Random random(1);
  int meet = 0;
  for (int k = 0; k < 60; ++k) meet += expect_right(random_points([&] { return random.in_cube(); })) ? 1 : 0;
  EXPECT_GT(meet, 6);
  EXPECT_LT(meet, 54);
}

TEST(Impact, MatchesRationalArithmeticForSmallIntegers) {
  Random random(2);
  for (const std::uint64_t most : {1U, 2U, 4U}) {
    int meet = 0;
    for (int k = 0; k < 200; ++k) meet += expect_right(on_lattice(random, most)) ? 1 : 0;
    EXPECT_GT(meet, 20);
    EXPECT_LT(meet, 180);
  }
}

/// All points lie in a plane that keeps its normal and may move along it.
TEST(Impact, MatchesRationalArithmeticInAPlane) {
  Random random(3);
  int meet = 0;
  for (int k = 0; k < 200; ++k) {
    FourMovingPoints points = on_lattice(random, k % 2 == 0 ? 2 : 20);
    const double heights[2] = {static_cast<double>(random.below(3)), static_cast<double>(random.below(3))};
    for (std::size_t n = 0; n < 4; ++n) {
      points.start[n].z = heights[0];
      points.end[n].z = heights[1];
    }
    // An integer matrix of determinant 1 transforms the points, so that no axis is special.
    meet += expect_right(with_each(points,
                                   [](const Vec3d& p) {
                                     return Vec3d{p.x + p.y + p.z, p.x + 2 * p.y + 2 * p.z, p.x + 2 * p.y + 3 * p.z};
                                   }))
                ? 1
                : 0;
  }
  EXPECT_GT(meet, 20);
  EXPECT_LT(meet, 420);
}

/// All points lie on a line that may move: triangles have no area, edges lie along each other.
TEST(Impact, MatchesRationalArithmeticOnALine) {
  Random random(4);
  int meet = 0;
  for (int k = 0; k < 300; ++k) {
    const FourMovingPoints points = on_lattice(random, 5);
    const Vec3d by{0, static_cast<double>(random.below(3)), 1};
    FourMovingPoints line = with_each(points, [](const Vec3d& p) { return Vec3d{p.x, 2 * p.x, -3 * p.x}; });
    for (Vec3d& p : line.end) p += by;
    meet += expect_right(line) ? 1 : 0;
  }
  EXPECT_GT(meet, 50);
}

/// Points coincide or rest: triangles become segments or points, edges become points.
TEST(Impact, MatchesRationalArithmeticForCoincidentPoints) {
  Random random(5);
  int meet = 0;
  for (int k = 0; k < 500; ++k) {
    FourMovingPoints points = on_lattice(random, 2);
    const std::size_t from = random.below(4);
    const std::size_t to = random.below(4);
    points.start[to] = points.start[from];
    if (k % 2 == 0) points.end[to] = points.end[from];
    if (k % 3 == 0) points.end = points.start;
    if (k % 5 == 0) points.end[from] = points.start[from];
    meet += expect_right(points) ? 1 : 0;
  }
  EXPECT_GT(meet, 50);
}

/// Features touch at their border at half time. Single roundings then disturb this contact.
TEST(Impact, MatchesRationalArithmeticWhenGrazing) {
  Random random(6);
  const auto nudged = [&](const Vec3d& p) {
    Vec3d out = p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint64_t which = random.below(4);
      if (which == 0) out[axis] = std::nextafter(out[axis], 1e9);
      if (which == 1) out[axis] = std::nextafter(out[axis], -1e9);
    }
    return out;
  };
  int meet = 0;
  for (int k = 0; k < 40; ++k) {
    FourMovingPoints points = random_points([&] { return random.in_cube(); });
    // At half time the first point lies on the border of the triangle.
    const double s = random.uniform();
    const Vec3d a = (points.start[1] + points.end[1]) * 0.5;
    const Vec3d b = (points.start[2] + points.end[2]) * 0.5;
    points.end[0] = (a * (1 - s) + b * s) * 2 - points.start[0];
    meet += expect_right(with_each(points, nudged)) ? 1 : 0;
  }
  EXPECT_GT(meet, 6);
  EXPECT_LT(meet, 39);
}

/// Features slide along a face or an edge, in it or a few roundings above or below it.
TEST(Impact, MatchesRationalArithmeticWhenSliding) {
  Random random(7);
  for (int k = 0; k < 60; ++k) {
    const double height = (static_cast<double>(random.below(5)) - 2) * 0x1p-53;
    FourMovingPoints points = random_points([&] {
      const Vec3d p = random.in_cube();
      return Vec3d{p.x, p.y, 1};
    });
    points.start[0].z += height;
    points.end[0].z += (static_cast<double>(random.below(5)) - 2) * 0x1p-53;
    expect_right(points);
  }
}

/// Shifts each feature of one of the two kinds by its own vector.
FourMovingPoints shifted(FourMovingPoints points, FeatureKinds kinds, const Vec3d& by, const Vec3d& other_by) {
  const std::size_t first_count = kinds == FeatureKinds::vertex_face ? 1 : 2;
  for (std::size_t k = 0; k < 4; ++k) points.end[k] = points.start[k] + (k < first_count ? by : other_by);
  return points;
}

/// Parallel, coplanar and general features shift. Factors give coordinates of few bits, of about 20 and of about 50:
/// each is decided by integers of another width.
TEST(Impact, MatchesRationalArithmeticForFeaturesThatShift) {
  Random random(21);
  for (const double factor : {1.0, 0x1.8p14 + 1, 0x1p45 + 1}) {
    int meet = 0;
    int decided = 0;
    for (int k = 0; k < 200; ++k) {
      const FeatureKinds kinds = k % 2 == 0 ? FeatureKinds::vertex_face : FeatureKinds::edge_edge;
      const FourMovingPoints own = on_lattice(random, 2);
      FourMovingPoints points = shifted(own, kinds, own.end[0], own.end[1]);
      points = with_each(points, [&](const Vec3d& p) { return p * factor; });
      meet += expect_right(points) ? 1 : 0;
      decided += detail::shifted_impact(points, kinds, 1e-6).answer == FilteredImpact::Answer::unknown ? 0 : 1;
    }
    EXPECT_GT(meet, 20);
    EXPECT_GT(decided, 140);  // the others are degenerate
  }
}

/// Edges that stay parallel, or move along a common line.
TEST(Impact, MatchesRationalArithmeticForParallelEdgesThatShift) {
  Random random(22);
  int meet = 0;
  for (int k = 0; k < 300; ++k) {
    FourMovingPoints points = on_lattice(random, 2);
    const Vec3d along = points.start[1];
    const auto scale = [&] { return static_cast<double>(random.below(5)) - 2; };
    points.start[1] = points.start[0] + along;
    points.start[3] = points.start[2] + along * scale();
    if (k % 3 == 0) points.start[2] = points.start[0] + along * scale();
    if (k % 3 == 0) points.start[3] = points.start[2] + along * scale();
    const Vec3d by = k % 2 == 0 ? along * scale() : points.end[0];
    points = shifted(points, FeatureKinds::edge_edge, by, points.end[1] * (k % 4 == 0 ? 0 : 1));
    meet += expect_right(points) ? 1 : 0;
  }
  EXPECT_GT(meet, 40);
  EXPECT_LT(meet, 260);
}

/// A search for the first contact passes the time from which a contact would be too late.
TEST(Impact, IsNothingIfItIsTooLate) {
  Random random(23);
  int late = 0;
  int kept = 0;
  for (int k = 0; k < 2000; ++k) {
    const FourMovingPoints points =
        k % 2 == 0 ? on_lattice(random, 3) : random_points([&] { return random.in_cube(); });
    const ImpactOptions options{.min_separation = k % 5 == 0 ? 0.25 : 0};
    for (const FeatureKinds kinds : {FeatureKinds::vertex_face, FeatureKinds::edge_edge}) {
      const auto time = detail::impact(points, kinds, options);
      const double step = std::ldexp(1.0, -detail::time_depth(options.tolerance));
      for (const double before : {0.25, 0.5, 1.0, time.value_or(0.125), time.value_or(0.125) + step}) {
        const bool is_early = time && *time < before;
        ASSERT_EQ(detail::impact(points, kinds, options, before), is_early ? time : std::nullopt);
        late += time && !is_early ? 1 : 0;
        kept += is_early ? 1 : 0;
      }
    }
  }
  EXPECT_GT(late, 100);
  EXPECT_GT(kept, 100);
}

TEST(Impact, ScaleAndPlaceChangeNothing) {
  Random random(8);
  for (int k = 0; k < 12; ++k) {
    const FourMovingPoints points = on_lattice(random, 3);
    for (const double scale : {0x1p-1000, 0x1p-400, 0x1p-100, 0x1p100, 0x1p400, 0x1p1000}) {
      expect_right(with_each(points, [&](const Vec3d& p) { return p * scale; }));
    }
    expect_right(with_each(points, [](const Vec3d& p) { return p + Vec3d{0x1p20, -0x1p30, 0x1p50}; }));
    expect_right(with_each(points, [](const Vec3d& p) { return Vec3d{p.x, p.y * 0x1p-40, p.z * 0x1p40}; }));
  }
}

TEST(Impact, ToleranceBoundsHowEarlyTimesAre) {
  Random random(9);
  for (int k = 0; k < 10; ++k) {
    const FourMovingPoints points = random_points([&] { return random.in_cube(); });
    for (const double tolerance : {1.0, 0.25, 1e-3, 1e-9, 0x1p-40}) expect_right(points, {.tolerance = tolerance});
  }
}

TEST(Impact, MatchesRationalArithmeticWithASeparation) {
  Random random(12);
  int meet = 0;
  for (int k = 0; k < 8; ++k) {
    meet += expect_right_approach(random_points([&] { return random.in_cube(); }), 0.1) ? 1 : 0;
  }
  EXPECT_GT(meet, 2);
  meet = 0;
  for (int k = 0; k < 40; ++k) meet += expect_right_approach(on_lattice(random, 3), k % 2 == 0 ? 1 : 0.5) ? 1 : 0;
  EXPECT_GT(meet, 5);
  EXPECT_LT(meet, 40);
  for (int k = 0; k < 20; ++k) {
    FourMovingPoints points = on_lattice(random, 3);
    points.start[random.below(4)] = points.start[random.below(4)];
    if (k % 2 == 0) points.end = points.start;
    if (k % 3 == 0) points.end[1] = points.end[0];
    expect_right_approach(points, 1);
  }
}

/// Features reach exactly the separation, or keep it all the time.
TEST(Impact, AtExactlyTheSeparationIsAnImpact) {
  const std::array<Vec3d, 3> triangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  const auto moving = [&](const Vec3d& from, const Vec3d& to) {
    return FourMovingPoints{{from, triangle[0], triangle[1], triangle[2]}, {to, triangle[0], triangle[1], triangle[2]}};
  };
  const ImpactOptions half{.min_separation = 0.5};
  const double below = std::nextafter(0.5, 0);
  EXPECT_EQ(vertex_face_impact(moving({1, 1, 0.5}, {2, 1, 0.5}), half), 0.0);
  EXPECT_EQ(vertex_face_impact(moving({1, 1, 0.5}, {2, 1, 0.5}), {.min_separation = below}), std::nullopt);
  const auto sliding = vertex_face_impact(moving({-4, 1, 0.5}, {4, 1, 0.5}), half);
  ASSERT_TRUE(sliding);
  EXPECT_NEAR(*sliding, 0.5, 1e-6);
  EXPECT_LE(*sliding, 0.5);
  EXPECT_FALSE(vertex_face_impact(moving({-4, 1, 0.5}, {4, 1, 0.5}), {.min_separation = below}));
  const auto beside = vertex_face_impact(moving({-1, 1, 0}, {1, 1, 0}), half);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(*beside, 0.25, 1e-6);
}

TEST(Impact, WithASeparationScaleChangesNothing) {
  Random random(13);
  const FourMovingPoints points = on_lattice(random, 2);
  for (const double scale : {0x1p-400, 0x1p-100, 0x1p300}) {
    expect_right_approach(with_each(points, [&](const Vec3d& p) { return p * scale; }), scale);
  }
  expect_right_approach(points, 0x1p-60);
  expect_right_approach(points, 0x1p300);
}

TEST(Impact, AtTheStartIsTimeZero) {
  const FourMovingPoints points{{{{0.25, 0.25, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                {{{9, 9, 9}, {0, 0, 1}, {1, 0, 2}, {0, 1, 3}}}};
  EXPECT_EQ(vertex_face_impact(points), 0.0);
}

TEST(Impact, FindsWhenAPointFallsOntoATriangle) {
  const FourMovingPoints points{{{{0.25, 0.25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                {{{0.25, 0.25, -2}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
  const auto time = vertex_face_impact(points);
  ASSERT_TRUE(time);
  EXPECT_LE(*time, 1.0 / 3);
  EXPECT_NEAR(*time, 1.0 / 3, 1e-6);
}

/// Doubles suffice for nearly all queries of a simulation; integers decide the rest.
TEST(Impact, DoublesDecideNearlyAllRandomQueries) {
  Random random(10);
  int unknown = 0;
  for (int k = 0; k < 2000; ++k) {
    const FourMovingPoints points = random_points([&] { return random.in_cube(); });
    for (const FeatureKinds kinds : {FeatureKinds::vertex_face, FeatureKinds::edge_edge}) {
      if (detail::filtered_impact(points, kinds, {}).answer == FilteredImpact::Answer::unknown) ++unknown;
    }
  }
  EXPECT_LE(unknown, 4);
}

TEST(Impact, BatchesMatchSingleQueries) {
  Random random(11);
  std::vector<FourMovingPoints> points;
  for (int k = 0; k < 2000; ++k) points.push_back(on_lattice(random, 3));
  for (const int threads : {1, 2, 7}) {
    const auto faces = vertex_face_impacts(points, {}, {.threads = threads});
    const auto edges = edge_edge_impacts(points, {}, {.threads = threads});
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_EQ(faces[k], vertex_face_impact(points[k]));
      ASSERT_EQ(edges[k], edge_edge_impact(points[k]));
    }
  }
}

TEST(Impact, RejectsInvalidMotions) {
  FourMovingPoints points{};
  EXPECT_THROW(static_cast<void>(vertex_face_impact(points, {.tolerance = 0})), InvalidOption);
  EXPECT_THROW(static_cast<void>(vertex_face_impact(points, {.tolerance = 2})), InvalidOption);
  EXPECT_THROW(static_cast<void>(edge_edge_impact(points, {.tolerance = std::nan("")})), InvalidOption);
  EXPECT_THROW(static_cast<void>(edge_edge_impact(points, {.min_separation = -1})), InvalidOption);
  EXPECT_THROW(static_cast<void>(edge_edge_impact(points, {.min_separation = std::nan("")})), InvalidOption);
  points.end[2].y = std::nan("");
  EXPECT_THROW(static_cast<void>(vertex_face_impact(points)), InvalidMesh);
  points.end[2].y = std::numeric_limits<double>::infinity();
  EXPECT_THROW(static_cast<void>(edge_edge_impact(points)), InvalidMesh);
}

}  // namespace
}  // namespace blum
