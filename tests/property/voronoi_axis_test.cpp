// Proves that medial axes from exact walls are certified at several angles, with all vertices and with few. The
// certificate is independent of their construction. The axes are close to those of the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "blum/axis/collapse_axis.hpp"
#include "blum/axis/decimate.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "support/data.hpp"
#include "support/mesh_places.hpp"
#include "support/model_solids.hpp"

namespace blum {
namespace {

struct Case {
  std::string name;
  TriangleMesh mesh;
};

void PrintTo(const Case& of, std::ostream* out) {
  *out << of.name;
}

/// Returns teeth with gaps so narrow that one cube contains parts of two teeth.
TriangleMesh comb() {
  std::vector<Point2> outline{{0, 0}};
  constexpr int teeth = 4;
  constexpr double gap = 0.1;
  const double width = teeth + (teeth - 1) * gap;
  outline.push_back({width, 0});
  for (int k = teeth - 1; k >= 0; --k) {
    const double left = k * (1 + gap);
    outline.push_back({left + 1, 4});
    outline.push_back({left, 4});
    if (k == 0) break;
    outline.push_back({left, 1});
    outline.push_back({left - gap, 1});
  }
  return make_extrusion(outline, {}, {.thickness = 0.5});
}

std::vector<Case> cases() {
  return {{"box", make_box()},
          {"bar", make_box({.size = {4, 1, 1}})},
          {"comb", comb()},
          {"wedge", make_wedge()},
          {"star", make_star()},
          {"cylinder", make_cylinder({.sides = 12})},
          {"bracket", make_bracket()},
          {"bracket_turned", test::turned(make_bracket())},
          {"menger", make_menger({.level = 1})},
          {"void_cube", make_void_cube({.frequency = 1})},
          {"torus", make_torus({.ring_segments = 12, .tube_segments = 8})},
          {"bodies", make_bodies()}};
}

class Shapes : public testing::TestWithParam<Case> {};

TEST_P(Shapes, AreCertifiedFromTheAxisAlone) {
  const TriangleMesh& mesh = GetParam().mesh;
  const VoronoiComplex walls = voronoi_complex(mesh, {.part = VoronoiPart::medial_axis, .resolution = 8});
  ASSERT_TRUE(walls.report.certified);
  const double tolerance = 1e-3 * bounds(mesh).diagonal();
  for (const double theta : {0.0, 30.0, 75.0, 95.0, 130.0}) {
    SCOPED_TRACE(theta);
    const Complex axis = collapse_axis(walls.complex, theta);
    EXPECT_TRUE(problem_of_medial(axis).empty());
    for (const Complex& form : {axis, decimate(axis, tolerance).axis}) {
      const Certificate certificate = certify(form, mesh);
      EXPECT_TRUE(certificate.topology_holds);
      EXPECT_TRUE(certificate.geometry.holds);
      EXPECT_TRUE(certificate.holds());
      for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << mismatch;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, Shapes, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

/// Expects that the Betti numbers are right if all cubes pass. A mesh that bounds no solid may be rejected.
void expect_never_wrong(const test::NamedMesh& solid, std::size_t& certified, std::size_t& all) {
  for (const VoronoiPart part : {VoronoiPart::all, VoronoiPart::walls, VoronoiPart::medial_axis}) {
    SCOPED_TRACE(solid.name + ", " + std::string(to_string(part)));
    VoronoiReport report;
    try {
      report = voronoi_complex(solid.mesh,
                               {.part = part, .method = VoronoiMethod::cubes, .resolution = 1, .max_cubes = 10'000})
                   .report;
    } catch (const InvalidMesh&) {
      return;
    }
    const bool all_pass = report.failing.empty() && report.undecided_lines == 0 && report.contradictions == 0;
    EXPECT_EQ(report.certified, all_pass);
    EXPECT_TRUE(!all_pass || report.found == report.expected);
    ++all;
    certified += report.certified ? 1U : 0U;
  }
}

TEST(VoronoiSolids, ThinOnesAreNeverCertifiedWrongly) {
  std::size_t certified = 0;
  std::size_t all = 0;
  for (const test::NamedMesh& solid : test::thin_solids()) expect_never_wrong(solid, certified, all);
  EXPECT_GT(certified, all / 2);
}

/// In these solids, many sites tie.
TEST(VoronoiSolids, OnesOfWholeNumbersAreNeverCertifiedWrongly) {
  std::size_t certified = 0;
  std::size_t all = 0;
  for (const test::NamedMesh& solid : test::whole_solids()) expect_never_wrong(solid, certified, all);
  EXPECT_EQ(certified, all);
}

/// Returns the largest distance, and the 95 % quantile, of the centroids of one axis's triangles from the other axis.
std::array<double, 2> distances(const Complex& from, const Complex& to) {
  const TriangleMesh target{to.positions, to.triangles};
  const SiteTable table(target);
  const Bvh bvh(target, table);
  std::vector<double> all;
  for (const auto& triangle : from.triangles) {
    const Vec3d middle =
        (from.positions[triangle[0]] + from.positions[triangle[1]] + from.positions[triangle[2]]) * (1.0 / 3);
    all.push_back(bvh.nearest(middle)->distance);
  }
  std::sort(all.begin(), all.end());
  return {all.back(), all[all.size() * 95 / 100]};
}

/// At this angle, no sheet of the solid begins or ends.
TEST(VoronoiAxis, IsNearThatOfTheGrid) {
  const TriangleMesh mesh = make_bracket();
  const double theta = 40;
  const VoronoiComplex walls = voronoi_complex(mesh, {.part = VoronoiPart::medial_axis, .resolution = 64});
  const Complex exact = collapse_axis(walls.complex, theta);
  const MedialAxis grid = medial_axis(mesh, {.resolution = 128});
  const Complex voxels = grid.fitted(theta);
  const double side = grid.report().bodies.front().spacing;
  const auto [most, usual] = distances(exact, voxels);
  const auto [most_back, usual_back] = distances(voxels, exact);
  EXPECT_LE(std::max(most, most_back), 1.5 * side) << "rims, which go along triangles and voxels";
  EXPECT_LE(std::max(usual, usual_back), 0.05 * side);
}

/// Real parts in single precision, with cylinders of many facets and faces bent by rounding, keep their sheets.
TEST(VoronoiSolids, OfRealPartsAreTraced) {
  for (const char* name : {"7_8ths_cube.stl", "abc9.stl", "eight.off", "plate_holes.STL", "round.stl"}) {
    const auto path = test::data_file(std::string("meshes/") + name);
    if (!path) GTEST_SKIP() << test::no_data(name);
    const VoronoiReport report = voronoi_complex(weld(read_mesh(*path)), {.part = VoronoiPart::walls}).report;
    EXPECT_TRUE(report.traced) << name << ": " << report.trace_problem;
    EXPECT_TRUE(report.certified) << name;
  }
}

/// Scanned parts have 32-bit coordinates, and vertices with cones of any width.
TEST(VoronoiSolids, OfScans) {
  struct Part {
    std::string file;
    BettiNumbers solid;
  };
  for (const auto& [file, solid] : {Part{"meshes/3holes.off", {1, 3, 0}}, Part{"meshes/screwdriver.off", {1, 0, 0}}}) {
    const auto path = test::data_file(file);
    if (!path) GTEST_SKIP() << test::no_data(file);
    const VoronoiReport report =
        voronoi_complex(weld(read_mesh(*path)),
                        {.part = VoronoiPart::medial_axis, .method = VoronoiMethod::cubes, .resolution = 1})
            .report;
    EXPECT_TRUE(report.certified) << file;
    EXPECT_EQ(report.found, solid) << file;
  }
}

}  // namespace
}  // namespace blum
