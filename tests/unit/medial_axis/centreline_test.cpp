// Proves that centrelines have the branches, lengths and radii of the tubes in an image. They keep the topology of its
// labels, for any number of threads.
#include "blum/medial_axis/centreline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {
namespace {

struct Tube {
  Vec3d from, to;
  double radius;
};

double distance_to(const Tube& tube, const Vec3d& point) {
  const Vec3d along = tube.to - tube.from;
  const double share = std::clamp(dot(point - tube.from, along) / squared_length(along), 0.0, 1.0);
  return length(point - tube.from - share * along);
}

/// An image with a label for each voxel whose centre lies in a solid.
VoxelImage image_of(const std::array<std::int64_t, 3>& size, const std::function<int(const Vec3d&)>& label_at,
                    const Vec3d& spacing = {1, 1, 1}) {
  VoxelImage image;
  image.grid.size = size;
  image.grid.spacing = spacing;
  std::vector<std::uint8_t> values;
  values.reserve(image.grid.node_count());
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) {
        values.push_back(static_cast<std::uint8_t>(label_at(image.grid.position(i, j, k))));
      }
    }
  }
  image.values = std::move(values);
  return image;
}

VoxelImage image_of(const std::array<std::int64_t, 3>& size, const std::vector<Tube>& tubes,
                    const Vec3d& spacing = {1, 1, 1}) {
  return image_of(
      size,
      [&](const Vec3d& point) {
        return std::any_of(tubes.begin(), tubes.end(),
                           [&](const Tube& t) { return distance_to(t, point) <= t.radius; });
      },
      spacing);
}

Centreline only_of(const VoxelImage& image, const CentrelineOptions& options = {}) {
  const Centrelines lines = centreline(image, options);
  EXPECT_EQ(lines.labels.size(), 1U);
  return lines.labels.empty() ? Centreline{} : lines.labels[0];
}

std::size_t count(const Centreline& line, CentrelineNodeKind kind) {
  return static_cast<std::size_t>(
      std::count_if(line.nodes.begin(), line.nodes.end(), [&](const CentrelineNode& n) { return n.kind == kind; }));
}

/// The branch whose middle is closest to the middle of a tube.
const CentrelineBranch& branch_near(const Centreline& line, const Tube& tube) {
  const Vec3d middle = 0.5 * (tube.from + tube.to);
  const auto off = [&](const CentrelineBranch& branch) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3d& point : branch.points) least = std::min(least, length(point - middle));
    return least;
  };
  return *std::min_element(line.branches.begin(), line.branches.end(),
                           [&](const auto& a, const auto& b) { return off(a) < off(b); });
}

/// The tree of five tubes from the issue that requested centrelines. Their radii are 4, 3, 2.5, 1.5 and 1.5 voxels.
const std::vector<Tube>& tree() {
  static const std::vector<Tube> tubes{{{30, 30, 6}, {30, 30, 30}, 4},
                                       {{30, 30, 30}, {18, 26, 50}, 3},
                                       {{30, 30, 30}, {44, 34, 48}, 2.5},
                                       {{18, 26, 50}, {10, 18, 66}, 1.5},
                                       {{18, 26, 50}, {24, 36, 68}, 1.5}};
  return tubes;
}

TEST(Centreline, ATreeOfFiveTubesHasFiveBranchesWithTheirRadii) {
  const Centreline line = only_of(image_of({60, 60, 76}, tree()));
  EXPECT_EQ(line.branches.size(), 5U);
  EXPECT_EQ(count(line, CentrelineNodeKind::end), 4U);
  EXPECT_EQ(count(line, CentrelineNodeKind::junction), 2U);
  EXPECT_TRUE(line.homotopy_kept) << line.homotopy;
  for (const Tube& tube : tree()) {
    const CentrelineBranch& branch = branch_near(line, tube);
    EXPECT_NEAR(branch.mean_radius, tube.radius, 0.1);
    EXPECT_LE(branch.min_radius, branch.mean_radius);
    EXPECT_NEAR(branch.length, length(tube.to - tube.from), 1);
    for (const Vec3d& point : branch.points) EXPECT_LT(distance_to(tube, point), 1.2);
  }
}

TEST(Centreline, RadiiOfStraightTubesAreWithinATenthOfAVoxelInAllDirections) {
  std::mt19937 random(16);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  for (const double radius : {1.5, 2.0, 3.0, 5.0}) {
    double sum = 0;
    constexpr int tubes = 12;
    for (int t = 0; t < tubes; ++t) {
      const Vec3d direction{normal(random), normal(random), normal(random)};
      const double half = 2 * radius + 10;
      const Vec3d along = half / length(direction) * direction;
      const double middle = half + radius + 3;
      const Vec3d centre{middle + shift(random), middle + shift(random), middle + shift(random)};
      const auto side = static_cast<std::int64_t>(2 * middle + 1);
      const Tube tube{centre - along, centre + along, radius};
      const Centreline line = only_of(image_of({side, side, side}, std::vector<Tube>{tube}));
      ASSERT_EQ(line.branches.size(), 1U);
      EXPECT_NEAR(line.branches[0].mean_radius, radius, 0.1);
      EXPECT_NEAR(line.branches[0].length, 2 * half, 1.5);
      sum += line.branches[0].mean_radius - radius;
    }
    EXPECT_NEAR(sum / tubes, 0, 0.02) << radius;
  }
}

TEST(Centreline, ARingBecomesAClosedCurve) {
  const Centreline line = only_of(image_of({41, 41, 15}, [](const Vec3d& p) {
    const double off = std::hypot(p.x - 20.3, p.y - 20.1) - 14;
    return std::hypot(off, p.z - 7.2) <= 3 ? 1 : 0;
  }));
  ASSERT_EQ(line.branches.size(), 1U);
  EXPECT_TRUE(line.nodes.empty());
  EXPECT_EQ(line.branches[0].nodes, (std::array<std::int32_t, 2>{-1, -1}));
  EXPECT_EQ(line.branches[0].points.front(), line.branches[0].points.back());
  EXPECT_NEAR(line.branches[0].length, 2 * std::numbers::pi * 14, 0.7);
  EXPECT_NEAR(line.branches[0].mean_radius, 3, 0.1);
  EXPECT_EQ(line.graph_betti, (BettiNumbers{1, 1, 0}));
  EXPECT_TRUE(line.homotopy_kept);
}

TEST(Centreline, ABallAndAVoxelBecomeAPoint) {
  const auto ball = [](double radius) {
    return image_of({21, 21, 21}, [=](const Vec3d& p) { return length(p - Vec3d{10, 10, 10}) <= radius ? 1 : 0; });
  };
  for (const double radius : {0.5, 3.0, 7.5}) {
    const Centreline line = only_of(ball(radius));
    EXPECT_TRUE(line.branches.empty()) << radius;
    ASSERT_EQ(line.nodes.size(), 1U);
    EXPECT_EQ(line.nodes[0].kind, CentrelineNodeKind::point);
    EXPECT_LT(length(line.nodes[0].position - Vec3d{10, 10, 10}), 1);
    EXPECT_TRUE(line.homotopy_kept);
  }
}

TEST(Centreline, CrossingTubesHaveOneJunction) {
  const Vec3d centre{25.3, 24.8, 25.1};
  const auto cross_of = [&](const std::vector<Vec3d>& directions, double radius) {
    std::vector<Tube> tubes;
    for (const Vec3d& d : directions) {
      tubes.push_back({centre - 18 / length(d) * d, centre + 18 / length(d) * d, radius});
    }
    return only_of(image_of({51, 51, 51}, tubes));
  };
  for (const auto& [line, branches] : {std::pair(cross_of({{1, 0.2, 0.1}, {-0.2, 1, 0.1}}, 3), 4U),
                                       std::pair(cross_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 2.5), 6U)}) {
    EXPECT_EQ(line.branches.size(), branches);
    EXPECT_EQ(count(line, CentrelineNodeKind::junction), 1U);
    EXPECT_EQ(count(line, CentrelineNodeKind::end), branches);
    for (const CentrelineNode& node : line.nodes) {
      if (node.kind == CentrelineNodeKind::junction) {
        EXPECT_LT(length(node.position - centre), 0.9);  // sections along the grid locate no better
      }
    }
    for (const CentrelineBranch& branch : line.branches) EXPECT_NEAR(branch.length, 18, 1.2);
  }
}

TEST(Centreline, AThinBarHasOneBranchAlongIt) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 2), std::pair(3, 2), std::pair(5, 5)}) {
    const Centreline line = only_of(image_of({20, 20, 60}, [&](const Vec3d& p) {
      return p.x >= 6 && p.x < 6 + width && p.y >= 6 && p.y < 6 + height && p.z >= 5 && p.z < 54 ? 1 : 0;
    }));
    ASSERT_EQ(line.branches.size(), 1U) << width << ' ' << height;
    EXPECT_NEAR(line.branches[0].length, 49 - std::max(width, height), 2.5);
    EXPECT_NEAR(line.branches[0].mean_radius, std::sqrt(width * height / std::numbers::pi), 0.1);
  }
  const Centreline diagonal = only_of(
      image_of({40, 40, 40}, [](const Vec3d& p) { return p.x == p.y && p.y == p.z && p.x > 4 && p.x < 35 ? 1 : 0; }));
  ASSERT_EQ(diagonal.branches.size(), 1U);
  EXPECT_NEAR(diagonal.branches[0].length, 29 * std::sqrt(3.0), 2);
}

TEST(Centreline, NoisySurfacesCauseNoSpurs) {
  // One in twenty voxels of the outermost layer is removed, and one in twenty of the next layer is added.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  for (int trial = 0; trial < 5; ++trial) {
    const Centreline line = only_of(image_of({60, 60, 76}, [&](const Vec3d& p) {
      double off = std::numeric_limits<double>::infinity();
      for (const Tube& tube : tree()) off = std::min(off, distance_to(tube, p) - tube.radius);
      const bool is_flipped = any(random) < 0.05 && std::abs(off) < 0.5;
      return (off <= 0) != is_flipped ? 1 : 0;
    }));
    // Topology caused by noise stays. Each loop adds up to three branches.
    EXPECT_EQ(line.label_betti[1], line.graph_betti[1]);
    EXPECT_EQ(line.label_betti[0], line.graph_betti[0]);
    std::size_t ends = 0;
    for (const CentrelineNode& node : line.nodes) ends += node.kind == CentrelineNodeKind::end ? 1 : 0;
    EXPECT_EQ(ends, 4U);
    EXPECT_LE(line.branches.size(), 5U + 3 * static_cast<std::size_t>(line.graph_betti[1]));
  }
}

TEST(Centreline, TouchingLabelsHaveSeparateCentrelines) {
  const VoxelImage image = image_of({41, 41, 60}, [](const Vec3d& p) {
    if (p.z < 6 || p.z > 53) return 0;
    if (std::hypot(p.x - 16, p.y - 20) <= 4) return 1;
    return std::hypot(p.x - 24, p.y - 20) <= 4 ? 2 : 0;
  });
  const Centrelines lines = centreline(image);
  ASSERT_EQ(lines.labels.size(), 2U);
  for (const Centreline& line : lines.labels) {
    ASSERT_EQ(line.branches.size(), 1U);
    EXPECT_NEAR(line.branches[0].mean_radius, 4, 0.15);
    for (const Vec3d& point : line.branches[0].points) EXPECT_NEAR(point.x, *line.label == 1 ? 16 : 24, 0.4);
  }
}

TEST(Centreline, ReportsFilledVoids) {
  const Centreline line = only_of(image_of({25, 25, 25}, [](const Vec3d& p) {
    const double off = length(p - Vec3d{12, 12, 12});
    return off <= 9 && off > 4 ? 1 : 0;
  }));
  EXPECT_EQ(line.label_betti, (BettiNumbers{1, 0, 1}));
  EXPECT_EQ(line.graph_betti, (BettiNumbers{1, 0, 0}));
  EXPECT_FALSE(line.homotopy_kept);
  EXPECT_NE(line.homotopy.find("1 void"), std::string::npos) << line.homotopy;
  EXPECT_EQ(line.nodes.size(), 1U);
}

TEST(Centreline, RotationByARightAngleHardlyChangesTheTree) {
  const Centreline line = only_of(image_of({60, 60, 76}, tree()));
  const Centreline turned = only_of(image_of({76, 60, 60}, [](const Vec3d& p) {
    const Vec3d back{p.y, p.z, p.x};
    return std::any_of(tree().begin(), tree().end(), [&](const Tube& t) { return distance_to(t, back) <= t.radius; });
  }));
  ASSERT_EQ(turned.branches.size(), line.branches.size());
  for (const Tube& tube : tree()) {
    const auto turn = [](const Vec3d& p) { return Vec3d{p.z, p.x, p.y}; };
    const CentrelineBranch& a = branch_near(line, tube);
    const CentrelineBranch& b = branch_near(turned, {turn(tube.from), turn(tube.to), tube.radius});
    EXPECT_NEAR(a.mean_radius, b.mean_radius, 0.05);
    EXPECT_NEAR(a.length, b.length, 1.5);
  }
}

TEST(Centreline, NonCubicVoxelsGiveTheSameRadii) {
  const Tube tube{{8, 8, 8}, {20, 22, 20}, 3};
  const Centreline line = only_of(image_of({60, 60, 30}, std::vector<Tube>{tube}, {0.5, 0.5, 1}));
  ASSERT_EQ(line.branches.size(), 1U);
  EXPECT_NEAR(line.branches[0].mean_radius, 3, 0.1);
  EXPECT_NEAR(line.branches[0].length, length(tube.to - tube.from), 1);
  for (const Vec3d& point : line.branches[0].points) EXPECT_LT(distance_to(tube, point), 0.5);
}

TEST(Centreline, TheComplexHasTheTopologyOfTheGraph) {
  const Centrelines lines = centreline(image_of({60, 60, 76}, tree()));
  const Complex complex = complex_of(lines);
  EXPECT_EQ(problem_of(complex), "");
  EXPECT_EQ(static_cast<std::int64_t>(complex.positions.size()) - static_cast<std::int64_t>(complex.edges.size()), 1);
  for (const double radius : complex.vertex_columns.get<double>("radius")) EXPECT_GT(radius, 1);
}

TEST(Centreline, AnImageWithoutVoxelsHasAnEmptyCentreline) {
  const VoxelImage image = image_of({5, 4, 3}, [](const Vec3d&) { return 0; });
  EXPECT_TRUE(centreline(image).labels.empty());
  const std::array<std::int64_t, 2> labels{3, 7};
  const Centrelines lines = centreline(image, labels);
  ASSERT_EQ(lines.labels.size(), 2U);
  EXPECT_EQ(lines.labels[1].label, 7);
  EXPECT_TRUE(lines.labels[1].nodes.empty());
}

TEST(Centreline, IsTheSameForAnyNumberOfThreads) {
  const VoxelImage image = image_of({60, 60, 76}, [](const Vec3d& p) {
    for (std::size_t t = 0; t < tree().size(); ++t) {
      if (distance_to(tree()[t], p) <= tree()[t].radius) return static_cast<int>(t / 2 + 1);
    }
    return 0;
  });
  Context context;
  context.threads = 1;
  const Centrelines one = centreline(image, {}, context);
  EXPECT_EQ(one.labels.size(), 3U);
  for (const int threads : {2, 7}) {
    context.threads = threads;
    const Centrelines more = centreline(image, {}, context);
    ASSERT_EQ(more.labels.size(), one.labels.size());
    for (std::size_t l = 0; l < one.labels.size(); ++l) {
      ASSERT_EQ(more.labels[l].branches.size(), one.labels[l].branches.size());
      for (std::size_t b = 0; b < one.labels[l].branches.size(); ++b) {
        EXPECT_EQ(more.labels[l].branches[b].points, one.labels[l].branches[b].points);
        EXPECT_EQ(more.labels[l].branches[b].radii, one.labels[l].branches[b].radii);
      }
    }
  }
}

TEST(Centreline, WarnsOfEmptySelectionsAndSingleLayers) {
  const VoxelImage image = image_of({4, 4, 4}, [](const Vec3d&) { return 1; });
  EXPECT_TRUE(centreline(image).warnings.empty());
  const std::vector<std::int64_t> labels{1, 5};
  EXPECT_EQ(centreline(image, labels).warnings,
            (std::vector<Warning>{{WarningCode::nothing_found, "no voxel has the label 5"}}));
  EXPECT_EQ(centreline(image, {.selection = LabelSelection::at_least(2)}).warnings,
            (std::vector<Warning>{{WarningCode::nothing_found, "no voxel reaches the threshold"}}));
  EXPECT_EQ(centreline(image_of({4, 4, 4}, [](const Vec3d&) { return 0; })).warnings,
            (std::vector<Warning>{{WarningCode::nothing_found, "no voxel is selected"}}));
  const std::vector<Warning> flat = centreline(image_of({4, 4, 1}, [](const Vec3d&) { return 1; })).warnings;
  ASSERT_EQ(flat.size(), 1U);
  EXPECT_EQ(flat[0].code, WarningCode::single_layer);
}

TEST(Centreline, WarnsOfFiveLabelsAndCountsTheRest) {
  Centrelines lines;
  for (int label = 1; label <= 7; ++label) {
    lines.labels.push_back({.label = label, .voxels = 9, .homotopy_kept = label == 1, .homotopy = "not kept"});
  }
  const GridSpec grid{{0, 0, 0}, {1, 1, 1}, {4, 4, 4}, {}};
  const std::vector<Warning> found = centreline_warnings(lines, grid);
  ASSERT_EQ(found.size(), 6U);
  EXPECT_EQ(found[0], (Warning{WarningCode::other_topology, "label 2: not kept"}));
  EXPECT_TRUE(found[5].text.starts_with("1 more label has no voxels, or another topology")) << found[5].text;
}

TEST(Centreline, RejectsInvalidOptionsImagesAndCancelledCalls) {
  VoxelImage image = image_of({4, 4, 4}, [](const Vec3d&) { return 1; });
  CentrelineOptions options;
  options.spur = -1;
  EXPECT_THROW(static_cast<void>(centreline(image, options)), InvalidOption);
  image.values = std::vector<float>(64, 0.5F);
  EXPECT_THROW(static_cast<void>(centreline(image)), InvalidImage);
  options = {};
  options.selection = LabelSelection::at_least(0.25);
  EXPECT_EQ(centreline(image, options).labels.size(), 1U);
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  EXPECT_THROW(static_cast<void>(centreline(image, options, context)), Cancelled);
}

}  // namespace
}  // namespace blum
