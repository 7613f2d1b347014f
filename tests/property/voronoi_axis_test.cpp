// Proves that medial axes from exact walls are certified at several angles, with all vertices and with few. The
// certificate is independent of their construction. The axes are close to those of the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "blum/axis/axis_graph.hpp"
#include "blum/axis/collapse_axis.hpp"
#include "blum/axis/decimate.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "support/amount.hpp"
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

const std::vector<Point2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
const std::vector<std::vector<Point2>> square_hole{{{1, 1}, {1, 3}, {3, 3}, {3, 1}}};
const std::vector<std::vector<Point2>> acute_hole{{{2, 1}, {1.125, 2.5}, {2.875, 2.5}}};

std::vector<Case> cases() {
  return {{"box", make_box()},
          {"bar", make_box({.size = {4, 1, 1}})},
          {"comb", comb()},
          {"wedge", make_wedge()},
          {"star", make_star()},
          {"cylinder", make_cylinder({.sides = 12})},
          {"frame", make_extrusion(square, square_hole, {.thickness = 0.375})},
          {"acute_hole", make_extrusion(square, acute_hole, {.thickness = 0.5})},
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
      EXPECT_EQ(certificate.triangles.undecided, 0U);
      EXPECT_TRUE(certificate.holds());
      for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << mismatch;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, Shapes, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

/// Between neighbouring facets of fine prisms, sheets have small angles. At a theta below these angles, the axis has
/// all sheets.
TEST(VoronoiAxis, OfFinePrismsIsCertifiedBelowTheirBends) {
  const TriangleMesh mesh = make_cylinder({.sides = 96});
  const Complex axis = collapse_axis(voronoi_complex(mesh, {.part = VoronoiPart::medial_axis}).complex, 1);
  EXPECT_EQ(sheet_count(axis), 3U * 96U);
  const Certificate certificate = certify(axis, mesh, {.theta = 1});
  for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << mismatch;
}

/// The vertices of a site.
std::set<std::uint32_t> vertices_of(const VoronoiSite& site, const TriangleMesh& mesh) {
  std::set<std::uint32_t> out(site.vertices.begin(), site.vertices.end());
  for (const std::uint32_t t : site.triangles) out.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
  return out;
}

/// Returns true if two sites are the same, or if one is an edge or corner of the other one.
bool are_next(const VoronoiSite& a, const VoronoiSite& b, const TriangleMesh& mesh) {
  const std::set<std::uint32_t> first = vertices_of(a, mesh), second = vertices_of(b, mesh);
  if (a.kind == b.kind) return first == second;
  const bool is_first_less = first.size() < second.size();
  const std::set<std::uint32_t>& less = is_first_less ? first : second;
  const std::set<std::uint32_t>& more = is_first_less ? second : first;
  return std::includes(more.begin(), more.end(), less.begin(), less.end());
}

/// Expects that sheets end at all seams and nowhere else, and that seams have three sides or more. A sheet continues
/// smoothly where its footprints pass from a face to its own edge. Each sheet of patches has one pair of patches.
void expect_exact_sheets(const TriangleMesh& mesh) {
  VoronoiComplex made = voronoi_complex(mesh, {.part = VoronoiPart::medial_axis});
  ASSERT_TRUE(made.report.traced || made.report.exact) << made.report.trace_problem;
  const std::vector<VoronoiSite> sites = voronoi_sites(mesh, made.report);
  add_patch_columns(made.complex, voronoi_patches(mesh, sites));
  const Complex axis = collapse_axis(made.complex, 1);
  const auto column = [&](std::string_view name) { return axis.triangle_columns.get<std::int32_t>(name); };
  const auto sheet = column("sheet"), first = column("site_a"), second = column("site_b");
  const Incidence incidence(axis.view());
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const auto at = incidence.triangles_of_edge()[e];
    if (at.size() != 2) continue;
    EXPECT_EQ(sheet[at[0]], sheet[at[1]]);
    const auto site = [&](std::int32_t k) { return sites[static_cast<std::size_t>(k)]; };
    const auto continues = [&](std::int32_t a, std::int32_t b) {
      return are_next(site(first[at[0]]), site(a), mesh) && are_next(site(second[at[0]]), site(b), mesh);
    };
    EXPECT_TRUE(continues(first[at[1]], second[at[1]]) || continues(second[at[1]], first[at[1]]));
  }
  for (const bool of_patches : {false, true}) {
    const AxisGraph graph = axis_graph(axis, mesh, {.of_patches = of_patches});
    std::map<std::uint32_t, std::size_t> ends;  // how often each seam bounds a sheet
    for (const AxisSheet& part : graph.sheets) {
      for (const std::uint32_t seam : part.seams) ++ends[seam];
      EXPECT_EQ(part.sides.has_value(), of_patches);
    }
    EXPECT_EQ(ends.size(), graph.seams.size());
  }
  const auto patch_sheet = column("patch_sheet"), patch_a = column("patch_a"), patch_b = column("patch_b");
  std::map<std::int32_t, std::set<std::array<std::int32_t, 2>>> pairs;
  for (std::size_t t = 0; t < axis.triangles.size(); ++t) {
    if (patch_sheet[t] >= 0) pairs[patch_sheet[t]].insert({patch_a[t], patch_b[t]});
  }
  for (const auto& [number, own] : pairs) EXPECT_EQ(own.size(), 1U) << number;
  const auto roles = axis.edge_columns.get<std::int32_t>("role");
  const auto listed = incidence.edge_of_listed();
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    if (roles[e] != static_cast<std::int32_t>(MedialRole::seam)) continue;
    EXPECT_GE(incidence.triangles_of_edge()[listed[e]].size(), 3U);
  }
}

TEST(VoronoiAxis, HasSheetsThatEndAtSeams) {
  const std::vector<Point2> ell{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2.5}, {0, 2.5}};
  const std::vector<Point2> tee{{1, 0}, {2, 0}, {2, 2}, {3, 2}, {3, 3}, {0, 3}, {0, 2}, {1, 2}};
  const std::vector<Point2> channel{{0, 0}, {4, 0}, {4, 2}, {3.25, 2}, {3.25, 0.75}, {1, 0.75}, {1, 2}, {0, 2}};
  for (const auto& profile : {ell, tee, channel}) {
    for (const double thickness : {8.0, 0.375}) {
      SCOPED_TRACE(std::to_string(profile.size()) + " corners, " + std::to_string(thickness));
      expect_exact_sheets(make_extrusion(profile, {}, {.thickness = thickness}));
    }
  }
  for (const Case& shape : {Case{"box", make_box({.size = {3, 2, 1}})}, Case{"bracket", make_bracket()},
                            Case{"gear", make_gear({.teeth = 12, .openings = 3, .hole_segments = 16})}}) {
    SCOPED_TRACE(shape.name);
    expect_exact_sheets(shape.mesh);
  }
}

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
  const std::vector<test::NamedMesh> solids = test::thin_solids();
  for (const test::NamedMesh& solid : test::some(solids, solids.size() / 2)) expect_never_wrong(solid, certified, all);
  EXPECT_GT(certified, all / 2);
}

/// In these solids, many sites tie.
TEST(VoronoiSolids, OnesOfWholeNumbersAreNeverCertifiedWrongly) {
  std::size_t certified = 0;
  std::size_t all = 0;
  const std::vector<test::NamedMesh> solids = test::whole_solids();
  for (const test::NamedMesh& solid : test::some(solids, solids.size() / 2)) expect_never_wrong(solid, certified, all);
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
  const std::vector<Part> parts{{"meshes/3holes.off", {1, 3, 0}}, {"meshes/screwdriver.off", {1, 0, 0}}};
  for (const auto& [file, solid] : test::some(parts, 1)) {
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
