// Proves that sheets are those that an engineer counts. Each sheet keeps its number wherever the part lies, wherever
// the grid lies, and on a grid twice as fine. The parts are a box, an L-profile, a cylinder, a box with fillets and a
// bracket.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/axis/prune_sheets.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/known_axes.hpp"
#include "support/medial_check.hpp"

namespace blum {
namespace {

constexpr double theta = 60;

/// Merges points that are equal up to rounding.
class PointIndex {
 public:
  explicit PointIndex(std::vector<Vec3d>& points) : points_(points) {}

  std::uint32_t operator()(const Vec3d& p) {
    const auto whole = [](double x) { return std::llround(x * 1e9); };
    const auto [at, is_new] =
        known_.try_emplace({whole(p.x), whole(p.y), whole(p.z)}, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(p);
    return at->second;
  }

 private:
  std::vector<Vec3d>& points_;
  std::map<std::array<long long, 3>, std::uint32_t> known_;
};

/// Returns a box with rounded edges and corners: all points within `radius` of a smaller box, with facets.
/// @param parts  half the number of facets of a quarter of a circle.
TriangleMesh filleted_box(const Vec3d& size, double radius, int parts) {
  TriangleMesh mesh;
  PointIndex index(mesh.vertices);
  // Along an axis: a direction, and the end of the smaller box from which it starts. The middle direction exists for
  // both ends.
  std::vector<std::pair<double, double>> places;
  for (int k = -parts; k <= parts; ++k) {
    const double slope = std::tan(std::numbers::pi / 4 * k / parts);
    if (k <= 0) places.emplace_back(slope, -1);
    if (k == 0) places.emplace_back(slope, 1);
    if (k > 0) places.emplace_back(slope, 1);
  }
  const auto count = places.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto point = [&](std::size_t i, std::size_t j) {
        Vec3d way;
        Vec3d end;
        const std::array<std::pair<double, double>, 3> along{{{side, side}, places[i], places[j]}};
        for (std::size_t k = 0; k < 3; ++k) {
          way[(axis + k) % 3] = along[k].first;
          end[(axis + k) % 3] = along[k].second * (0.5 * size[(axis + k) % 3] - radius);
        }
        return index(end + way * (radius / length(way)));
      };
      for (std::size_t i = 0; i + 1 < count; ++i) {
        for (std::size_t j = 0; j + 1 < count; ++j) {
          const std::array<std::uint32_t, 4> corners{point(i, j), point(i + 1, j), point(i + 1, j + 1),
                                                     point(i, j + 1)};
          const auto& [a, b, c, d] = corners;
          mesh.triangles.push_back(side > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
          mesh.triangles.push_back(side > 0 ? Triangle{a, c, d} : Triangle{a, d, c});
        }
      }
    }
  }
  return mesh;
}

struct Part {
  std::string name;
  TriangleMesh mesh;
  std::size_t sheets = 0;  ///< the number that an engineer counts, at theta

  friend std::ostream& operator<<(std::ostream& out, const Part& part) { return out << part.name; }
};

std::vector<Part> parts() {
  return {{"Box", make_box({.size = {1.5, 1, 0.6}}), 13},  // the middle, four into each pair of ends, four upright ones
          {"L", test::known_l_beam(0.6, 1).mesh, 16},
          {"Cylinder", make_cylinder({}), 2},  // the cones at its ends, and a curve between
          // These parts have the sheets of the box. The facets of fillets have angles below theta and no sheets of
          // their own.
          {"FilletedBox", filleted_box({1.5, 1, 0.6}, 0.15, 4), 13},
          {"FinelyFilletedBox", filleted_box({1.5, 1, 0.6}, 0.15, 12), 13},
          {"Bracket", make_bracket(), 30}};
}

struct Sheet {
  double area = 0;
  Vec3d centroid;
};

/// Returns the area and centroid of each sheet, by its number.
/// @param turn  rotation of the part, which is undone.
std::vector<Sheet> sheets_of(const Complex& axis, const Mat3& turn = {}) {
  std::vector<Sheet> sheets(sheet_count(axis));
  const MedialView view(axis);
  for (std::size_t t = 0; t < view.triangles.size(); ++t) {
    const auto& [a, b, c] = view.triangles[t];
    const Vec3d& at = view.positions[a];
    const double area = 0.5 * length(cross(view.positions[b] - at, view.positions[c] - at));
    Sheet& sheet = sheets[static_cast<std::size_t>(view.sheet[t])];
    sheet.area += area;
    sheet.centroid += area / 3 * (at + view.positions[b] + view.positions[c]);
  }
  for (Sheet& sheet : sheets) sheet.centroid = turn.transposed_times(sheet.centroid / sheet.area);
  return sheets;
}

/// The largest allowed differences between centroids and areas of a sheet in two axes.
struct Tolerance {
  double distance = 0;
  double area = 0;  ///< relative
};

void expect_same(std::span<const Sheet> found, std::span<const Sheet> expected, const Tolerance& tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t s = 0; s < found.size(); ++s) {
    EXPECT_LE(length(found[s].centroid - expected[s].centroid), tolerance.distance) << "sheet " << s;
    EXPECT_NEAR(found[s].area, expected[s].area, tolerance.area * expected[s].area) << "sheet " << s;
  }
}

/// Expects sheets so far apart that expect_same() would notice two swapped numbers.
void expect_apart(std::span<const Sheet> sheets, const Tolerance& tolerance) {
  for (std::size_t a = 0; a < sheets.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_GT(length(sheets[a].centroid - sheets[b].centroid), 2 * tolerance.distance) << a << " and " << b;
    }
  }
}

/// Areas differ where sheets end at the facets of round surfaces, and by up to a voxel all around.
Tolerance tolerance_of(const TriangleMesh& mesh) {
  return {0.008 * bounds(mesh).diagonal(), 0.1};
}

class SheetNumbers : public testing::TestWithParam<Part> {
 protected:
  [[nodiscard]] static std::vector<Sheet> fitted(const TriangleMesh& mesh, const MedialAxisOptions& options,
                                                 const Mat3& turn = {}) {
    return sheets_of(medial_axis(mesh, options).fitted(theta), turn);
  }

  static void expect_same_when_turned(std::span<const Sheet> sheets, const Vec3d& around, int resolution) {
    SCOPED_TRACE(testing::Message() << "turned around " << around.x << ' ' << around.y << ' ' << around.z);
    const Mat3 turn = test::rotation(around, 17);
    expect_same(fitted(test::turned(GetParam().mesh, turn), {.resolution = resolution}, turn), sheets,
                tolerance_of(GetParam().mesh));
  }

  static void expect_same_on_shifted_grid(std::span<const Sheet> sheets, double shift, int resolution) {
    SCOPED_TRACE(testing::Message() << "shifted by " << shift);
    expect_same(fitted(GetParam().mesh, {.resolution = resolution, .grid_shift = shift}), sheets,
                tolerance_of(GetParam().mesh));
  }

  /// Expects the same sheets after a move by parts of a voxel. The grid moves with the mesh.
  static void expect_same_when_moved(std::span<const Sheet> sheets, int resolution) {
    TriangleMesh moved = GetParam().mesh;
    const Vec3d by = Vec3d{0.3, 0.3, 0.3} * (bounds(moved).size().x / resolution);
    for (Vec3d& v : moved.vertices) v += by;
    std::vector<Sheet> back = fitted(moved, {.resolution = resolution});
    for (Sheet& sheet : back) sheet.centroid -= by;
    expect_same(back, sheets, tolerance_of(GetParam().mesh));
  }

  static void expect_same_with_fewer_triangles(const MedialAxis& axis) {
    const Complex whole = axis.fitted(theta);
    const DecimatedAxis lean = decimate(whole, 0.25 * axis.report().bodies.front().spacing);
    EXPECT_LT(lean.axis.triangles.size(), whole.triangles.size());
    expect_same(sheets_of(lean.axis), sheets_of(whole), tolerance_of(GetParam().mesh));
  }
};

TEST_P(SheetNumbers, AreTheSameWhereverPartAndGridLie) {
  constexpr int resolution = 64;
  const MedialAxis axis = medial_axis(GetParam().mesh, {.resolution = resolution});
  const std::vector<Sheet> sheets = sheets_of(axis.fitted(theta));
  EXPECT_EQ(sheets.size(), GetParam().sheets);
  expect_apart(sheets, tolerance_of(GetParam().mesh));
  for (const Vec3d& around : {Vec3d{1, 2, 3}, Vec3d{3, -1, 0.5}}) expect_same_when_turned(sheets, around, resolution);
  for (const double shift : {0.3, -0.3}) expect_same_on_shifted_grid(sheets, shift, resolution);
  expect_same_when_moved(sheets, resolution);
  expect_same_with_fewer_triangles(axis);
}

class SlowSheetNumbers : public SheetNumbers {};

TEST_P(SlowSheetNumbers, AreTheSameAtTwiceTheResolution) {
  constexpr int resolution = 128;
  const std::vector<Sheet> sheets = fitted(GetParam().mesh, {.resolution = resolution});
  EXPECT_EQ(sheets.size(), GetParam().sheets);
  expect_same(fitted(GetParam().mesh, {.resolution = 2 * resolution}), sheets, tolerance_of(GetParam().mesh));
  expect_same_when_turned(sheets, {1, 2, 3}, resolution);
  expect_same_on_shifted_grid(sheets, 0.3, resolution);
}

std::string name_of(const testing::TestParamInfo<Part>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Parts, SheetNumbers, testing::ValuesIn(parts()), name_of);
INSTANTIATE_TEST_SUITE_P(Parts, SlowSheetNumbers, testing::ValuesIn(parts()), name_of);

// ---- Axes whose borders stay at the cells ----

/// Removes sheets with less than a thousandth of the area. A grid may or may not contain them, and they have the last
/// numbers.
std::vector<Sheet> without_crumbs(std::vector<Sheet> sheets) {
  double all = 0;
  for (const Sheet& sheet : sheets) all += sheet.area;
  const auto is_crumb = [&](const Sheet& sheet) { return sheet.area < 0.001 * all; };
  const auto first = std::find_if(sheets.begin(), sheets.end(), is_crumb);
  EXPECT_TRUE(std::all_of(first, sheets.end(), is_crumb));
  sheets.erase(first, sheets.end());
  return sheets;
}

TEST(SlowSheetNumbersAtTheCells, AreTheSameButForCrumbs) {
  constexpr int resolution = 128;
  for (const Part& part : {parts()[0], parts()[1]}) {
    SCOPED_TRACE(part.name);
    const Tolerance tolerance = tolerance_of(part.mesh);
    const std::vector<Sheet> sheets =
        without_crumbs(sheets_of(medial_axis(part.mesh, {.resolution = resolution}).simplify(theta)));
    EXPECT_EQ(sheets.size(), part.sheets);
    const Mat3 turn = test::rotation({1, 2, 3}, 17);
    const MedialAxis turned = medial_axis(test::turned(part.mesh, turn), {.resolution = resolution});
    expect_same(without_crumbs(sheets_of(turned.simplify(theta), turn)), sheets, tolerance);
    const MedialAxis finer = medial_axis(part.mesh, {.resolution = 2 * resolution});
    expect_same(without_crumbs(sheets_of(finer.simplify(theta))), sheets, tolerance);
  }
}

/// Returns a faceted ball without a smaller concentric ball.
TriangleMesh thin_shell(double thickness, int longitudes) {
  TriangleMesh mesh = make_uv_sphere({.longitudes = longitudes, .latitudes = longitudes / 2});
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t v = 0; v < count; ++v) mesh.vertices.push_back((1 - thickness) * mesh.vertices[v]);
  for (std::size_t t = 0, all = mesh.triangles.size(); t < all; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({c + count, b + count, a + count});
  }
  return mesh;
}

TEST(SheetNumbersOfAnything, AreOneForAShellHoweverThin) {
  for (const double thickness : {0.05, 0.01, 0.002, 0.0002}) {
    for (const int longitudes : {12, 32}) {
      SCOPED_TRACE(testing::Message() << thickness << " thick, " << longitudes << " longitudes");
      const MedialAxis axis = medial_axis(thin_shell(thickness, longitudes), {.resolution = 40});
      EXPECT_EQ(sheets_of(axis.fitted(theta)).size(), 1U);
    }
  }
}

TEST(SheetNumbersOfAnything, AreThoseOfTheLeastAngleInNestedAxes) {
  const TriangleMesh mesh = make_bracket();
  const MedialAxis axis = medial_axis(mesh, {.resolution = 64, .least_theta = theta});
  expect_same(sheets_of(axis.nested()), sheets_of(axis.simplify(theta)), tolerance_of(mesh));
}

TEST(SheetNumbersOfAnything, KeepTheirOrderWhereSheetsAreDropped) {
  const TriangleMesh mesh = make_star({});
  const Complex whole = medial_axis(mesh, {.resolution = 64}).fitted(40);
  const std::vector<Sheet> before = sheets_of(whole);
  const std::vector<Sheet> left = sheets_of(prune_sheets(whole, 100));
  ASSERT_GT(left.size(), 4U);
  ASSERT_LT(left.size(), before.size());
  std::size_t next = 0;
  for (const Sheet& sheet : left) {
    const auto is_same = [&](const Sheet& other) { return length(other.centroid - sheet.centroid) < 1e-9; };
    while (next < before.size() && !is_same(before[next])) ++next;
    EXPECT_LT(next++, before.size()) << "all are there before, in this order";
  }
}

TEST(SheetNumbersOfAnything, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = make_bracket();
  const Complex one = medial_axis(mesh, {.resolution = 48}, {.threads = 1}).fitted(theta, {.threads = 1});
  for (const int threads : {2, 7}) {
    const Complex many =
        medial_axis(mesh, {.resolution = 48}, {.threads = threads}).fitted(theta, {.threads = threads});
    EXPECT_TRUE(std::ranges::equal(MedialView(many).sheet, MedialView(one).sheet)) << threads;
  }
}

TEST(SheetNumbersOfAnything, FollowTheGridOfAnImage) {
  // Sheets of an image are numbered in the order of its voxels, so the first triangle has the first number.
  VoxelImage image;
  image.grid.size = {24, 20, 16};
  std::vector<std::uint8_t> values(image.grid.node_count(), 0);
  for (std::int64_t k = 3; k < 13; ++k) {
    for (std::int64_t j = 3; j < 17; ++j) {
      for (std::int64_t i = 3; i < 21; ++i) values[image.grid.index(i, j, k)] = 1;
    }
  }
  image.values = std::move(values);
  const Complex axis = medial_axis(image).simplify(theta);
  std::int32_t next = 0;
  for (const std::int32_t sheet : MedialView(axis).sheet) {
    EXPECT_LE(sheet, next);
    next = std::max(next, sheet + 1);
  }
  EXPECT_GT(next, 1);
}

TEST(GridShift, IsAtMostAVoxel) {
  EXPECT_THROW((void)medial_axis(make_box({}), {.grid_shift = 1.1}), InvalidOption);
  EXPECT_THROW((void)medial_axis(make_box({}), {.grid_shift = std::nan("")}), InvalidOption);
}

TEST(GridShift, MovesTheGridByPartsOfAVoxel) {
  const TriangleMesh mesh = make_box({.size = {1, 0.8, 0.6}});
  const auto place = [&](double shift) {
    const GridSpec grid = medial_axis(mesh, {.resolution = 16, .grid_shift = shift}).report().grid;
    const Vec3d steps = grid.origin / grid.spacing.x;
    return steps - Vec3d{std::floor(steps.x), std::floor(steps.y), std::floor(steps.z)};
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const double moved = place(0.3)[a] - place(0)[a];
    EXPECT_NEAR(moved - std::floor(moved), 0.3, 1e-9);
  }
}

}  // namespace
}  // namespace blum
