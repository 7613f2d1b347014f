// Proves that the axis of a larger angle or a larger lambda is a subset of that of a smaller one. The number of threads
// changes no byte.
#include <gtest/gtest.h>

#include <functional>

#include "blum/grid/image_generators.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/data.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

using Place = std::array<double, 3>;

/// Represents cells by the positions of their corners, in rising order. Cells with two corners at one position become
/// points or edges.
struct Cells {
  std::vector<Place> vertices;
  std::vector<std::array<Place, 2>> edges;
  std::vector<std::array<Place, 3>> triangles;
};

template <class T>
void sort_once(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

Cells cells_of(const AxisRows& complex) {
  Cells cells;
  const auto place = [&](std::uint32_t v) {
    const Vec3d& p = complex.vertices[v].position;
    return Place{p.x, p.y, p.z};
  };
  const auto add_edge = [&](std::uint32_t a, std::uint32_t b) {
    if (place(a) != place(b)) cells.edges.push_back({std::min(place(a), place(b)), std::max(place(a), place(b))});
  };
  for (std::uint32_t v = 0; v < complex.vertices.size(); ++v) cells.vertices.push_back(place(v));
  for (const EdgeRow& edge : complex.edges) add_edge(edge.vertices[0], edge.vertices[1]);
  for (const TriangleRow& triangle : complex.triangles) {
    const auto& v = triangle.vertices;
    for (std::size_t k = 0; k < 3; ++k) add_edge(v[k], v[(k + 1) % 3]);
    std::array<Place, 3> corners{place(v[0]), place(v[1]), place(v[2])};
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) == corners.end()) cells.triangles.push_back(corners);
  }
  sort_once(cells.vertices);
  sort_once(cells.edges);
  sort_once(cells.triangles);
  return cells;
}

template <class T>
bool is_part(const std::vector<T>& small, const std::vector<T>& large) {
  return std::includes(large.begin(), large.end(), small.begin(), small.end());
}

void expect_nested(const MedialAxis& axis) {
  Cells larger = cells_of(axis.simplify(0));
  std::size_t steps = 0;
  for (double theta = 10; theta <= 180; theta += 10) {
    const Cells cells = cells_of(axis.simplify(theta));
    EXPECT_TRUE(is_part(cells.vertices, larger.vertices)) << "theta " << theta;
    EXPECT_TRUE(is_part(cells.edges, larger.edges)) << "theta " << theta;
    EXPECT_TRUE(is_part(cells.triangles, larger.triangles)) << "theta " << theta;
    steps += cells.vertices.size() < larger.vertices.size() ? 1 : 0;
    larger = cells;
  }
  EXPECT_GE(steps, 1U);
}

class MedialOrderOfShapes : public testing::TestWithParam<std::string> {};

TEST_P(MedialOrderOfShapes, AxesOfLargerAnglesAreSubsets) {
  expect_nested(medial_axis(make_shape(GetParam()), {.resolution = 64}));
}
INSTANTIATE_TEST_SUITE_P(Catalogue, MedialOrderOfShapes,
                         testing::Values("box", "ellipsoid", "plate", "star", "organic", "void_cube"),
                         [](const auto& info) { return info.param; });

TEST(MedialOrder, AxesOfLargerAnglesAreSubsetsInRealMeshes) {
  for (const char* const name : {"meshes/fandisk.obj", "meshes/rocker-arm.obj"}) {
    const auto file = test::data_file(name);
    if (!file) GTEST_SKIP() << test::no_data(name);
    expect_nested(medial_axis(read_mesh(*file), {.resolution = 64}));
  }
}

TEST(MedialOrder, AxesOfLargerAnglesAreSubsetsInImages) {
  expect_nested(medial_axis(make_tube_image({.nodes = 2, .pitch = 16})));
  expect_nested(medial_axis(make_ball_image({.size = 48, .spacing = {1, 1.5, 0.8}, .inner_radius = 0.5})));
}

void expect_same(const AxisRows& a, const AxisRows& b) {
  EXPECT_TRUE(a.vertices == b.vertices);
  EXPECT_TRUE(a.edges == b.edges);
  EXPECT_TRUE(a.triangles == b.triangles);
  EXPECT_EQ(a.sheet_count, b.sheet_count);
}

/// @param make  computes the axis in a given context.
void expect_same_for_all_threads(const std::function<MedialAxis(const Context&)>& make) {
  const MedialAxis one = make({.threads = 1});
  for (const int threads : {2, 7}) {
    const MedialAxis many = make({.threads = threads});
    EXPECT_EQ(many.report().betti, one.report().betti);
    for (const double theta : {0.0, 60.0}) expect_same(many.simplify(theta), one.simplify(theta));
  }
}

TEST(MedialThreads, ChangeNoByteOfTheAxisOfAMesh) {
  for (const char* const name : {"organic", "bracket", "linked_tori"}) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = make_shape(name);
    expect_same_for_all_threads([&](const Context& context) { return medial_axis(mesh, {.resolution = 48}, context); });
  }
}

TEST(MedialThreads, ChangeNoByteOfTheAxisOfANonPolyhedron) {
  const TriangleMesh mesh = make_organic({.frequency = 20, .holes = 3});
  expect_same_for_all_threads([&](const Context& context) { return medial_axis(mesh, {.resolution = 48}, context); });
}

TEST(MedialThreads, ChangeNoByteOfTheAxisOfAnImage) {
  const VoxelImage image = make_tube_image({.nodes = 3, .pitch = 14, .spacing = {1, 1, 1.5}});
  expect_same_for_all_threads([&](const Context& context) { return medial_axis(image, {}, context); });
}

TEST(MedialOrder, ALeastAngleChangesNoTopologyAndKeepsTheNesting) {
  const TriangleMesh mesh = make_shape("bracket");
  const MedialAxis axis = medial_axis(mesh, {.resolution = 64, .least_theta = 60});
  EXPECT_THROW((void)axis.simplify(59), InvalidOption);
  Cells larger = cells_of(axis.simplify(60));
  for (const double theta : {70.0, 90.0, 120.0, 170.0}) {
    const AxisRows complex = axis.simplify(theta);
    const Cells cells = cells_of(complex);
    EXPECT_TRUE(is_part(cells.vertices, larger.vertices) && is_part(cells.triangles, larger.triangles)) << theta;
    EXPECT_EQ(test::betti_of(complex), (BettiNumbers{1, 4, 0})) << theta;
    larger = cells;
  }
}

/// Keeps edges and triangles with a separation angle above theta, without those kept for the topology alone.
AxisRows kept_for_themselves(AxisRows complex, double theta) {
  std::erase_if(complex.edges, [&](const EdgeRow& e) { return !(e.separation_angle > theta); });
  std::erase_if(complex.triangles, [&](const TriangleRow& t) { return !(t.separation_angle > theta); });
  return complex;
}

double footprint_distance(const VertexRow& vertex) {
  return length(vertex.footprints[0] - vertex.footprints[1]);
}

class MedialLambda : public testing::TestWithParam<std::string> {};

TEST_P(MedialLambda, LargerValuesKeepLess) {
  const TriangleMesh mesh = make_shape(GetParam());
  const double extent = bounds(mesh).diagonal();
  constexpr double theta = 30;
  AxisRows larger = medial_axis(mesh, {.resolution = 64}).simplify(theta);
  for (const double part : {0.05, 0.1, 0.2}) {
    SCOPED_TRACE(testing::Message() << "lambda " << part << " of the diagonal");
    const MedialAxis axis = medial_axis(mesh, {.resolution = 64, .lambda = part * extent});
    const AxisRows complex = axis.simplify(theta);
    EXPECT_LE(complex.triangles.size(), larger.triangles.size());
    EXPECT_LE(test::furthest_from(test::shape_of(larger), test::positions(complex)), test::voxel_diagonal(axis));
    EXPECT_TRUE(is_part(cells_of(kept_for_themselves(complex, theta)).triangles,
                        cells_of(kept_for_themselves(larger, theta)).triangles));
    larger = complex;
  }
}

TEST_P(MedialLambda, KeepsPiecesWhoseFootprintsAreFurtherApart) {
  // Lambda judged the footprints of a point within a diagonal of each corner of a triangle. On a flat wall, footprints
  // move no further than that.
  const TriangleMesh mesh = make_shape(GetParam());
  const double lambda = 0.06 * bounds(mesh).diagonal();
  const MedialAxis axis = medial_axis(mesh, {.resolution = 64, .lambda = lambda});
  const AxisRows complex = kept_for_themselves(axis.simplify(30), 30);
  double least = HUGE_VAL;
  for (const TriangleRow& triangle : complex.triangles) {
    double apart = 0;
    for (const std::uint32_t v : triangle.vertices) apart = std::max(apart, footprint_distance(complex.vertices[v]));
    least = std::min(least, apart);
  }
  EXPECT_GE(least, lambda - 2 * test::voxel_diagonal(axis));
  EXPECT_FALSE(complex.triangles.empty());
}
INSTANTIATE_TEST_SUITE_P(Catalogue, MedialLambda, testing::Values("box", "bracket", "star"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace blum
