// Proves that decimated axes stay within the tolerance, measured by an independent search. They keep their topology,
// sheets and certificate. Contraction of edges equals that in sets of simplices.
#include "blum/axis/decimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/axis/label_sheets.hpp"
#include "blum/axis/shrinking_complex.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/complex/homology.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/sample_axis.hpp"
#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using detail::label_sheets;
using detail::LinkScratch;
using detail::ShrinkingComplex;

using test::AxisRows;
using test::VertexRow;

/// All cells of an axis as a mesh, for distance queries.
TriangleMesh mesh_of(const Complex& axis) {
  TriangleMesh mesh;
  mesh.vertices = axis.positions;
  mesh.triangles.assign(axis.triangles.begin(), axis.triangles.end());
  for (const auto& [a, b] : axis.edges) mesh.segments.push_back({a, b});
  return mesh;
}

/// The largest distance of sampled points of an axis from another axis. The points are a third of a step apart.
double furthest(const Complex& from, const Complex& to, double step) {
  std::vector<Vec3d> points;
  for (const AxisSample& sample : sample_axis(MedialView(from), step / 3)) points.push_back(sample.position);
  double most = 0;
  for (const ClosestPoint& closest : closest_points(mesh_of(to), points, {.sign = SignMode::none}))
    most = std::max(most, closest.distance);
  return most;
}

struct Case {
  std::string shape;
  double theta = 0;
  int resolution = 32;
};

class Decimate : public testing::TestWithParam<Case> {};

TEST_P(Decimate, KeepsTopologySheetsAndCertificateWithinTheTolerance) {
  const TriangleMesh mesh = make_shape(GetParam().shape);
  MedialAxisOptions options;
  options.resolution = GetParam().resolution;
  const MedialAxis axis = medial_axis(mesh, options);
  const Complex whole = axis.simplify(GetParam().theta);
  const double voxel = axis.report().bodies.front().spacing;
  for (const double part : {0.01, 0.25, 2.0}) {
    SCOPED_TRACE(part);
    const DecimatedAxis lean = decimate(whole, part * voxel);
    EXPECT_LE(lean.deviation, part * voxel);
    EXPECT_LE(lean.axis.positions.size(), part > 1 ? 6 * whole.positions.size() / 10 : whole.positions.size());
    EXPECT_EQ(homology(lean.axis.view()), homology(whole.view()));
    EXPECT_EQ(problem_of_medial(lean.axis), "");
    EXPECT_EQ(sheet_count(lean.axis), sheet_count(whole));
    EXPECT_EQ(count(lean.axis).junctions, count(whole).junctions);
    EXPECT_LE(furthest(whole, lean.axis, voxel), lean.deviation + 1e-9 * voxel);
    EXPECT_LE(furthest(lean.axis, whole, voxel), lean.deviation + 1e-9 * voxel);
    const Certificate certificate = certify(lean.axis, mesh, {.balls = false});
    for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << mismatch;
  }
}

TEST_P(Decimate, KeepsColumnsOfVerticesAndAnglesOfSheets) {
  MedialAxisOptions options;
  options.resolution = GetParam().resolution;
  const MedialAxis axis = medial_axis(make_shape(GetParam().shape), options);
  const AxisRows whole = axis.simplify(GetParam().theta);
  const AxisRows lean = decimate(whole, 0.25 * axis.report().bodies.front().spacing).axis;
  auto next = whole.vertices.begin();
  for (const VertexRow& vertex : lean.vertices) {
    next = std::find(next, whole.vertices.end(), vertex);
    ASSERT_NE(next, whole.vertices.end());
  }
  const auto angles = [](const AxisRows& rows) {
    std::map<std::uint32_t, float> largest;
    for (const auto& t : rows.triangles) largest[t.sheet] = std::max(largest[t.sheet], t.separation_angle);
    return largest;
  };
  EXPECT_EQ(angles(lean), angles(whole));
  // New labels equal the existing ones.
  Complex again = lean;
  again.edges.clear();
  again.edge_columns = {};
  for (const auto& edge : lean.edges) {
    if (edge.role == MedialRole::curve) again.edges.push_back(edge.vertices);
  }
  add_missing_medial_columns(again);
  label_sheets(again, Incidence(again.view()));
  EXPECT_EQ(count(again).rim_edges, count(lean).rim_edges);
  EXPECT_EQ(count(again).seam_edges, count(lean).seam_edges);
  EXPECT_EQ(count(again).curve_edges, count(lean).curve_edges);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Decimate,
                         testing::Values(Case{"box", 60, 32}, Case{"box", 0, 24}, Case{"torus", 60, 32},
                                         Case{"bracket", 60, 64}, Case{"cylinder", 20, 32},
                                         Case{"torus_knot", 120, 48}),
                         [](const auto& info) {
                           return info.param.shape + "_" + std::to_string(static_cast<int>(info.param.theta));
                         });

/// A flat square sheet of n by n squares, with a height and a radius at each vertex.
template <class Height, class Radius>
Complex square(std::uint32_t n, const Height& height, const Radius& radius) {
  AxisRows rows;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = i;
      const double y = j;
      VertexRow& vertex = rows.vertices.emplace_back();
      vertex.position = {x, y, height(x, y)};
      vertex.radius = radius(x, y);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t v = j * (n + 1) + i;
      rows.triangles.push_back({{v, v + 1, v + n + 2}, 90, 0});
      rows.triangles.push_back({{v, v + n + 2, v + n + 1}, 90, 0});
    }
  }
  Complex axis = rows;
  label_sheets(axis, Incidence(axis.view()));
  return axis;
}
const auto flat = [](double, double) { return 0.0; };
const auto deep = [](double, double) { return 1000.0; };

TEST(DecimateSquare, FlatBecomesTwoTriangles) {
  const DecimatedAxis lean = decimate(square(20, flat, deep), 0.01);
  EXPECT_EQ(lean.axis.triangles.size(), 2U);
  EXPECT_EQ(lean.axis.positions.size(), 4U);
  EXPECT_EQ(lean.axis.edges.size(), 4U);
  EXPECT_LT(lean.deviation, 1e-9);
}

TEST(DecimateSquare, RadiiCountLikePlaces) {
  const auto ridge = [](double x, double) { return 1000 - std::abs(x - 10); };
  const DecimatedAxis lean = decimate(square(20, flat, ridge), 0.01);
  EXPECT_EQ(lean.axis.triangles.size(), 4U) << "the ridge of the radii must stay";
  const DecimatedAxis roof = decimate(square(20, [](double x, double) { return -0.3 * std::abs(x - 10); }, deep), 0.01);
  EXPECT_EQ(roof.axis.triangles.size(), 4U);
}

TEST(DecimateSquare, ThinPartsMoveLess) {
  const auto wavy = [](double x, double y) { return 0.05 * std::sin(x) * std::cos(y); };
  const std::size_t thick = decimate(square(20, wavy, deep), 2).axis.triangles.size();
  const std::size_t thin = decimate(square(20, wavy, [](double, double) { return 0.02; }), 2).axis.triangles.size();
  EXPECT_LT(thick, 10U);
  EXPECT_GT(thin, 100U);
}

TEST(DecimateSquare, ZeroToleranceKeepsAllAndInvalidTolerancesAreRejected) {
  const Complex axis = square(4, flat, deep);
  EXPECT_EQ(decimate(axis, 0).axis.triangles, axis.triangles);
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)decimate(axis, bad), InvalidOption);
  }
  EXPECT_THROW((void)decimate(Complex{{{0, 0, 0}}, {}, {}, {}, {}, {}}, 1), InvalidOption) << "no columns";
}

TEST(DecimateSquare, AClosedTubeOfThreeSidesKeepsItsTopology) {
  AxisRows rows;
  constexpr std::uint32_t rings = 12;
  for (std::uint32_t k = 0; k <= rings; ++k) {
    for (std::uint32_t s = 0; s < 3; ++s) {
      VertexRow& vertex = rows.vertices.emplace_back();
      vertex.position = {std::cos(2.0944 * s), std::sin(2.0944 * s), static_cast<double>(k)};
      vertex.radius = 1000;
    }
  }
  for (std::uint32_t k = 0; k < rings; ++k) {
    for (std::uint32_t s = 0; s < 3; ++s) {
      const std::uint32_t a = 3 * k + s;
      const std::uint32_t b = 3 * k + (s + 1) % 3;
      rows.triangles.push_back({{a, b, b + 3}, 90, 0});
      rows.triangles.push_back({{a, b + 3, a + 3}, 90, 0});
    }
  }
  Complex axis = rows;
  label_sheets(axis, Incidence(axis.view()));
  const DecimatedAxis lean = decimate(axis, 100);
  EXPECT_EQ(homology(lean.axis.view()), (BettiNumbers{1, 1, 0}));
  EXPECT_LT(lean.axis.triangles.size(), 6 * rings / 2);
}

TEST(DecimateSquare, CancelStopsIt) {
  std::stop_source source;
  source.request_stop();
  Context context;
  context.cancel = source.get_token();
  EXPECT_THROW((void)decimate(square(200, flat, deep), 0.01, context), Cancelled);
}

/// All simplices of a complex, as sets of vertices.
using Simplices = std::set<std::set<std::uint32_t>>;

template <class Cells>
void add_closure(Simplices& all, const Cells& cells) {
  for (const auto& cell : cells) {
    for (unsigned bits = 1; bits < 1U << cell.size(); ++bits) {
      std::set<std::uint32_t> face;
      for (std::size_t k = 0; k < cell.size(); ++k) {
        if ((bits >> k & 1U) != 0) face.insert(cell[k]);
      }
      all.insert(face);
    }
  }
}

/// The link of a simplex: all simplices that share no vertex with it and form a simplex together with it.
Simplices link_of(const Simplices& all, const std::set<std::uint32_t>& of) {
  Simplices link;
  for (const auto& simplex : all) {
    std::set<std::uint32_t> both = simplex;
    both.insert(of.begin(), of.end());
    if (both.size() == simplex.size() + of.size() && all.contains(both)) link.insert(simplex);
  }
  return link;
}

TEST(ShrinkingComplex, ContractsLikeSetsOfSimplices) {
  Random random(7);
  const auto below = [&](std::size_t most) { return static_cast<std::uint32_t>(random.below(most)); };
  std::size_t contracted = 0;
  std::size_t refused = 0;
  for (int round = 0; round < 400; ++round) {
    const std::uint32_t count = 5 + below(6);
    std::set<std::array<std::uint32_t, 2>> edges;
    std::set<std::array<std::uint32_t, 3>> triangles;
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t a = below(count);
      const std::uint32_t b = below(count);
      if (a < b) edges.insert({a, b});
    }
    for (int k = 0; k < 14; ++k) {
      std::array<std::uint32_t, 3> t{below(count), below(count), below(count)};
      std::sort(t.begin(), t.end());
      if (t[0] < t[1] && t[1] < t[2]) triangles.insert(t);
    }
    std::vector<std::array<std::uint32_t, 2>> edge_list(edges.begin(), edges.end());
    std::vector<std::array<std::uint32_t, 3>> triangle_list(triangles.begin(), triangles.end());
    LinkScratch scratch;
    ShrinkingComplex complex({count, edge_list, triangle_list});
    for (int step = 0; step < 6; ++step) {
      edge_list.clear();
      triangle_list.clear();
      for (std::uint32_t e = 0; e < edges.size(); ++e) {
        if (complex.has_edge(e)) edge_list.push_back(complex.edge(e));
      }
      for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (complex.has_triangle(t)) triangle_list.push_back(complex.triangle(t));
      }
      Simplices all;
      add_closure(all, edge_list);
      add_closure(all, triangle_list);
      std::vector<std::set<std::uint32_t>> joined;
      std::copy_if(all.begin(), all.end(), std::back_inserter(joined), [](const auto& s) { return s.size() == 2; });
      if (joined.empty()) break;
      const std::set<std::uint32_t>& pair = joined[below(joined.size())];
      const std::uint32_t from = *pair.begin();
      const std::uint32_t to = *pair.rbegin();
      Simplices common;
      const Simplices a = link_of(all, {from});
      const Simplices b = link_of(all, {to});
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(common, common.end()));
      const bool holds = common == link_of(all, pair);
      ASSERT_EQ(complex.may_contract(from, to, scratch), holds);
      if (!holds) {
        ++refused;
        continue;
      }
      ++contracted;
      complex.contract(from, to);
      Simplices expected;
      for (const auto& simplex : all) {
        std::set<std::uint32_t> moved = simplex;
        if (moved.erase(from) > 0) moved.insert(to);
        expected.insert(moved);
      }
      // A side that belonged only to a removed triangle does not become an edge. The decimation makes no such
      // contraction.
      Simplices found;
      found.insert({to});
      for (std::uint32_t e = 0; e < edges.size(); ++e) {
        if (complex.has_edge(e)) add_closure(found, std::vector{complex.edge(e)});
      }
      for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (complex.has_triangle(t)) add_closure(found, std::vector{complex.triangle(t)});
      }
      EXPECT_TRUE(std::includes(expected.begin(), expected.end(), found.begin(), found.end()));
      for (const auto& simplex : expected) {
        EXPECT_TRUE(simplex.size() < 3 || found.contains(simplex));
      }
    }
  }
  EXPECT_GT(contracted, 200U);
  EXPECT_GT(refused, 200U);
}

TEST(SampleAxis, EveryPointHasASampleWithinTheStep) {
  AxisRows rows;
  for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{7, 1, 0}, Vec3d{2, 5, 3}, Vec3d{2, 5, 9}}) {
    rows.vertices.emplace_back().position = p;
    rows.vertices.back().radius = p.x + p.y;
  }
  rows.triangles.push_back({{0, 1, 2}, 0, 0});
  rows.edges.push_back({{2, 3}});
  const Complex axis = rows;
  const MedialView view(axis);
  EXPECT_NEAR(area_of(view), 0.5 * length(cross(rows.vertices[1].position, rows.vertices[2].position)), 1e-12);
  const std::vector<AxisSample> samples = sample_axis(view, 0.5);
  const auto distance = [&](const Vec3d& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const AxisSample& sample : samples) least = std::min(least, length(sample.position - p));
    return least;
  };
  for (const AxisSample& sample : samples) {
    if (sample.vertex != 3 && sample.vertex != 2) {
      EXPECT_NEAR(sample.radius, sample.position.x + sample.position.y, 1e-12) << "radii are linear";
    }
  }
  Random random(3);
  for (int k = 0; k < 500; ++k) {
    double s = random.uniform();
    double t = random.uniform();
    if (s + t > 1) std::tie(s, t) = std::pair{1 - s, 1 - t};
    EXPECT_LE(distance(rows.vertices[1].position * s + rows.vertices[2].position * t), 0.5);
    EXPECT_LE(distance(rows.vertices[2].position * s + rows.vertices[3].position * (1 - s)), 0.5);
  }
  EXPECT_EQ(sample_axis(view, 100).size(), 4U);
  EXPECT_THROW((void)sample_axis(view, 0), InvalidOption);
  EXPECT_THROW((void)sample_axis(view, std::nan("")), InvalidOption);
}

/// A flat sheet lies between two pairs of patches, whose border is straight. Each pair keeps its area.
TEST(DecimatePatches, KeepsTheBorderBetweenPairsOfPatches) {
  constexpr std::uint32_t side = 12;
  AxisRows rows;
  for (std::uint32_t k = 0; k < side * side; ++k) {
    rows.vertices.emplace_back().position = {static_cast<double>(k % side), static_cast<double>(k / side), 0};
    rows.vertices.back().radius = 1;
  }
  std::vector<std::int32_t> patch;
  for (std::uint32_t k = 0; k + side < side * side; ++k) {
    if (k % side == side - 1) continue;
    rows.triangles.push_back({{k, k + 1, k + side + 1}, 90, 0});
    rows.triangles.push_back({{k, k + side + 1, k + side}, 90, 0});
    patch.insert(patch.end(), 2, k % side < 7 ? 1 : 2);
  }
  Complex axis = rows;
  label_sheets(axis, Incidence(axis.view()));
  axis.triangle_columns.add({"patch_a", 1, std::vector<std::int32_t>(patch.size(), 0)});
  axis.triangle_columns.add({"patch_b", 1, std::move(patch)});
  const Complex lean = decimate(axis, 1).axis;
  EXPECT_LT(lean.triangles.size(), 20U);
  std::map<std::int32_t, double> areas;
  const auto kept = lean.triangle_columns.get<std::int32_t>("patch_b");
  for (std::size_t t = 0; t < lean.triangles.size(); ++t) {
    const auto& [a, b, c] = lean.triangles[t];
    areas[kept[t]] += 0.5 * length(cross(lean.positions[b] - lean.positions[a], lean.positions[c] - lean.positions[a]));
  }
  EXPECT_DOUBLE_EQ(areas[1], 77);
  EXPECT_DOUBLE_EQ(areas[2], 44);
}

}  // namespace
}  // namespace blum
