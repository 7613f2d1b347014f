// Proves that interpolated distances are trilinear. They are exact for trilinear functions at nodes, on borders and on
// rotated grids. Outside the grid they are NaN. Wrong input is rejected.
#include "blum/field/interpolate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "blum/core/random.hpp"

namespace blum {
namespace {

/// A function that is linear along each index axis.
double trilinear(double i, double j, double k) {
  return 1 + 2 * i - 3 * j + 0.5 * k + 0.25 * i * j - 0.125 * j * k + 0.0625 * i * j * k;
}

Field field_on(const GridSpec& grid) {
  Field field;
  field.grid = grid;
  field.distance = Buffer<float>(grid.node_count());
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i) {
        field.distance[grid.index(i, j, k)] =
            static_cast<float>(trilinear(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
      }
    }
  }
  return field;
}

GridSpec turned_grid() {
  GridSpec grid{{1, -2, 3}, {0.5, 0.25, 2}, {5, 7, 4}, {}};
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  grid.direction.columns[0] = {c, s, 0};
  grid.direction.columns[1] = {-s, c, 0};
  return grid;
}

Vec3d at(const GridSpec& grid, double i, double j, double k) {
  return grid.origin + grid.direction * Vec3d{i * grid.spacing.x, j * grid.spacing.y, k * grid.spacing.z};
}

TEST(Interpolate, IsExactForATrilinearFunctionOnATurnedGrid) {
  const GridSpec grid = turned_grid();
  const Field field = field_on(grid);
  Random random(7);
  std::vector<Vec3d> points;
  std::vector<double> expected;
  for (int n = 0; n < 1000; ++n) {
    const double i = random.uniform() * 4;
    const double j = random.uniform() * 6;
    const double k = random.uniform() * 3;
    points.push_back(at(grid, i, j, k));
    expected.push_back(trilinear(i, j, k));
  }
  const std::vector<double> values = interpolate(field, points);
  for (std::size_t n = 0; n < values.size(); ++n) EXPECT_NEAR(values[n], expected[n], 1e-12);
}

/// Computes central differences. They are exact, up to rounding, for functions that are linear along each axis.
Vec3d slopes(double i, double j, double k) {
  const double h = 0.5;
  return {trilinear(i + h, j, k) - trilinear(i - h, j, k), trilinear(i, j + h, k) - trilinear(i, j - h, k),
          trilinear(i, j, k + h) - trilinear(i, j, k - h)};
}

TEST(Interpolate, HasTheGradientOfATrilinearFunctionOnATurnedGrid) {
  const GridSpec grid = turned_grid();
  const Field field = field_on(grid);
  Random random(8);
  std::vector<Vec3d> points;
  std::vector<Vec3d> expected;
  for (int n = 0; n < 1000; ++n) {
    // A third of the points lie in layers or on borders of cells, where all cells agree.
    const auto place = [&](double last) {
      return n % 3 == 0 ? std::floor(random.uniform() * (last + 1)) : random.uniform() * last;
    };
    const double i = place(4);
    const double j = place(6);
    const double k = place(3);
    points.push_back(at(grid, i, j, k));
    const Vec3d s = slopes(i, j, k);
    expected.push_back(grid.direction * Vec3d{s.x / 0.5, s.y / 0.25, s.z / 2});
  }
  points.push_back(at(grid, -1, 0, 0));
  const InterpolatedGradients found = interpolate_with_gradient(field, points);
  const std::vector<double> values = interpolate(field, points);
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_NEAR(length(found.gradient[n] - expected[n]), 0, 1e-11);
    EXPECT_EQ(found.value[n], values[n]);
  }
  EXPECT_TRUE(std::isnan(found.gradient.back().x) && std::isnan(found.value.back()));
}

TEST(Interpolate, HasNoSlopeAcrossASingleLayer) {
  const GridSpec grid{{0, 0, 0}, {1, 1, 1}, {3, 1, 3}, {}};
  const Vec3d point{0.5, 0.2, 0.25};
  const Vec3d found = interpolate_with_gradient(field_on(grid), {&point, 1}).gradient[0];
  EXPECT_EQ(found, (Vec3d{2, 0, 0.5}));
}

TEST(Interpolate, GivesNodesTheirValuesAlsoOnTheBorderAndNextToInfinity) {
  const GridSpec grid{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {}};
  Field field = field_on(grid);
  field.distance[grid.index(1, 1, 1)] = std::numeric_limits<float>::infinity();
  for (std::int64_t k = 0; k < 3; ++k) {
    for (std::int64_t j = 0; j < 3; ++j) {
      for (std::int64_t i = 0; i < 3; ++i) {
        const Vec3d node = grid.position(i, j, k);
        EXPECT_EQ(interpolate(field, {&node, 1})[0], static_cast<double>(field.distance[grid.index(i, j, k)]));
      }
    }
  }
}

TEST(Interpolate, IsNotANumberOutsideAndConstantAcrossASingleLayer) {
  const Field box = field_on({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {}});
  const std::vector<Vec3d> outside{{-0.001, 1, 1}, {1, 2.001, 1}, {1, 1, 9}};
  for (const double value : interpolate(box, outside)) EXPECT_TRUE(std::isnan(value));
  const Field layer = field_on({{0, 0, 0}, {1, 1, 1}, {3, 3, 1}, {}});
  const std::vector<Vec3d> near{{1, 1, 0.4}, {1, 1, -0.5}, {1, 1, 0.6}};
  const std::vector<double> values = interpolate(layer, near);
  EXPECT_EQ(values[0], trilinear(1, 1, 0));
  EXPECT_EQ(values[1], trilinear(1, 1, 0));
  EXPECT_TRUE(std::isnan(values[2]));
}

TEST(Interpolate, RefusesPointsAndFieldsThatAreWrong) {
  Field field = field_on({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {}});
  const std::vector<Vec3d> points{{1, 1, 1}, {1, NAN, 1}, {NAN, 1, 1}};
  try {
    (void)interpolate(field, points);
    FAIL() << "accepted a point that is not a number";
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("point 1"), std::string::npos) << error.what();
  }
  field.distance = Buffer<float>(5);
  EXPECT_THROW((void)interpolate(field, {points.data(), 1}), InvalidGrid);
}

}  // namespace
}  // namespace blum
