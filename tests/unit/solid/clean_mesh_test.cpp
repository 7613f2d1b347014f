// Proves that a cleaned mesh is a valid boundary of a solid. It keeps the topology and a part of the vertices, and does
// not contain needles. Thin, close and small parts stay. Invalid meshes are rejected with a reason.
// tests/property/clean_mesh_test.cpp measures the distance to the original mesh.
#include "blum/solid/clean_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/shapes/generators.hpp"
#include "solid/clean/mesh_cleaner.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;
using test::moved;

BettiNumbers betti_of(const MeshView& mesh) {
  return topology(mesh, SiteTable(mesh)).betti.value_or(BettiNumbers{-1, -1, -1});
}

/// Checks the facts that hold for every cleaned mesh, except distances.
void expect_sound(const MeshView& before, const CleanedMesh& after, double tolerance) {
  const CleanReport& report = after.report;
  EXPECT_EQ(betti_of(after.mesh), betti_of(before));
  EXPECT_TRUE(find_self_intersections(after.mesh, 1).pairs.empty());
  EXPECT_EQ(report.betti, report.betti_before);
  EXPECT_EQ(report.betti, betti_of(after.mesh));
  EXPECT_LE(report.deviation, tolerance);
  ASSERT_EQ(after.vertex_of.size(), after.mesh.vertices.size());
  for (std::size_t v = 0; v < after.vertex_of.size(); ++v) {
    EXPECT_EQ(after.mesh.vertices[v], before.vertices[after.vertex_of[v]]);
    EXPECT_TRUE(v == 0 || after.vertex_of[v - 1] < after.vertex_of[v]);
  }
  EXPECT_EQ(report.vertices, after.mesh.vertices.size());
  EXPECT_EQ(report.triangles, after.mesh.triangles.size());
  EXPECT_EQ(report.triangles_before, before.triangles.size());
  EXPECT_EQ(report.vertices_before - report.vertices, report.collapses);
  EXPECT_EQ(report.triangles_before - report.triangles, 2 * report.collapses);
}

CleanedMesh cleaned(const MeshView& mesh, double tolerance) {
  CleanedMesh out = clean_mesh(mesh, tolerance);
  expect_sound(mesh, out, tolerance);
  return out;
}

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// Cuts the edge from a to b in two at a point on or beside its two triangles.
void split_edge(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, const Vec3d& at) {
  const auto added = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(at);
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
    const Triangle triangle = mesh.triangles[t];
    if (std::count(triangle.begin(), triangle.end(), a) + std::count(triangle.begin(), triangle.end(), b) < 2) continue;
    Triangle other = triangle;
    std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), a, added);
    std::replace(other.begin(), other.end(), b, added);
    mesh.triangles.push_back(other);
  }
}

TEST(CleanMesh, LeavesCleanMeshes) {
  for (const double tolerance : {1e-9, 0.1, 1.0}) {
    const CleanedMesh out = cleaned(tetrahedron(), tolerance);
    EXPECT_EQ(out.mesh.triangles, tetrahedron().triangles);
    EXPECT_EQ(out.report.deviation, 0);
  }
  EXPECT_EQ(cleaned(make_sphere({.frequency = 8}), 1e-6).report.collapses, 0U);
  EXPECT_EQ(cleaned(make_gear(), 1e-9).report.collapses, 0U);
}

TEST(CleanMesh, RemovesNeedlessVertices) {
  const CleanedMesh box = cleaned(make_subdivided(make_box(), 4), 1e-6);
  EXPECT_EQ(box.mesh.triangles.size(), 12U);
  EXPECT_EQ(box.vertex_of, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_LT(box.report.deviation, 1e-12);
  const CleanedMesh rings = cleaned(make_cylinder({.sides = 24, .stacks = 40}), 1e-6);
  EXPECT_EQ(rings.mesh.vertices.size(), 50U) << "corners and middles of both ends: without these they were flatter";
  const CleanedMesh bracket = cleaned(make_subdivided(make_bracket(), 2), 1e-6);
  EXPECT_LE(bracket.mesh.vertices.size(), make_bracket().vertices.size());
}

TEST(CleanMesh, RemovesNoiseBelowTheTolerance) {
  const TriangleMesh fine = make_subdivided(make_box(), 4);
  for (const double part : {1e-4, 1e-2, 0.1}) {
    const TriangleMesh noisy = make_noisy(fine, part * 1e-3);
    EXPECT_LE(cleaned(noisy, 1e-3).mesh.triangles.size(), part < 0.1 ? 16U : 60U) << part;
  }
  EXPECT_GT(cleaned(make_noisy(fine, 1e-3), 1e-5).mesh.triangles.size(),
            0.9 * static_cast<double>(fine.triangles.size()));
}

TEST(CleanMesh, RemovesShortEdges) {
  TriangleMesh mesh = make_box();
  const auto [a, b, c] = mesh.triangles[0];
  split_edge(mesh, a, b, mesh.vertices[a] + (mesh.vertices[b] - mesh.vertices[a]) * 1e-7);
  split_edge(mesh, b, c, mesh.vertices[b] + (mesh.vertices[c] - mesh.vertices[b]) * 1e-7);
  const CleanedMesh out = cleaned(mesh, 1e-5);
  EXPECT_EQ(out.mesh.triangles.size(), 12U);
  EXPECT_LT(out.report.smallest_height_before, 1e-6);
  EXPECT_GT(out.report.smallest_height, 0.1);
}

/// A wedge-like solid with a necessary vertex just above an edge that another triangle shares.
TriangleMesh with_cap(double height) {
  // Triangle 0-1-2 is a cap of the given height.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0.5, 1, 0.8}, {0.5, 0.3, -1}, {0.5, -1, 0}};
  // 0-1 is the edge, 2 the vertex beside it, 3 far above, 4 below, 5 on the other side.
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 0, 2}, {1, 0, 5}, {1, 4, 3}, {3, 4, 0}, {0, 4, 5}, {5, 4, 1}};
  return mesh;
}

TEST(CleanMesh, FlipsTheLongSidesOfCaps) {
  const TriangleMesh mesh = with_cap(1e-6);
  ASSERT_EQ(betti_of(mesh), (BettiNumbers{1, 0, 0}));
  const CleanedMesh out = cleaned(mesh, 1e-5);
  EXPECT_EQ(out.report.flips + out.report.collapses, 1U);
  EXPECT_NEAR(out.report.smallest_height_before, 1e-6, 1e-9);
  EXPECT_GT(out.report.smallest_height, 0.1);
  EXPECT_GT(out.report.deviation, 0);
}

TEST(CleanMesh, FlipsTrianglesWithoutArea) {
  const TriangleMesh mesh = with_cap(0);
  ASSERT_EQ(topology(mesh, SiteTable(mesh)).degenerate_triangles, 1U);
  const CleanedMesh out = clean_mesh(mesh, 1e-9);
  EXPECT_EQ(out.report.flips, 1U);
  EXPECT_EQ(out.report.smallest_height_before, 0);
  EXPECT_GT(out.report.smallest_height, 0.1);
  EXPECT_EQ(betti_of(out.mesh), (BettiNumbers{1, 0, 0}));
}

TEST(CleanMesh, KeepsThinPlates) {
  for (const double part : {0.01, 0.3, 1.0, 1.5, 3.0}) {
    constexpr double tolerance = 1e-3;
    const TriangleMesh plate = make_subdivided(box_between({0, 0, 0}, {1, 0.7, part * tolerance}), 3);
    const CleanedMesh out = cleaned(plate, tolerance);
    EXPECT_GT(topology(out.mesh, SiteTable(out.mesh)).signed_volume, 0) << part;
    EXPECT_LE(out.mesh.triangles.size(), 12U) << part;
    static_cast<void>(cleaned(make_noisy(plate, 0.1 * part * tolerance), tolerance));
  }
}

TEST(CleanMesh, KeepsSlitsAndNearlyTouchingParts) {
  for (const double part : {0.01, 0.3, 1.0, 3.0}) {
    constexpr double tolerance = 1e-3;
    const double gap = part * tolerance;
    TriangleMesh slit = make_subdivided(box_between({0, 0, 0}, {1, 1, 1}), 3);
    append(slit, make_subdivided(box_between({0.2, 0.2, 0.5}, {0.8, 0.8, 0.5 + gap}, true), 3));
    EXPECT_EQ(betti_of(slit), (BettiNumbers{1, 0, 1}));
    static_cast<void>(cleaned(slit, tolerance));
    TriangleMesh pair = make_subdivided(box_between({0, 0, 0}, {1, 1, 1}), 3);
    append(pair, make_subdivided(box_between({0, 0, 1 + gap}, {1, 1, 2}), 3));
    static_cast<void>(cleaned(make_noisy(pair, 0.2 * gap), tolerance));
  }
}

/// A box with a dent in its top.
TriangleMesh dented_box(double depth) {
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  for (const Triangle& t : mesh.triangles) {
    if (mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z < 3) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (mesh.vertices[a].x == mesh.vertices[b].x || mesh.vertices[a].y == mesh.vertices[b].y) continue;
      split_edge(mesh, a, b, {0.5, 0.5, 1 - depth});
      return mesh;
    }
  }
  return mesh;
}

TEST(CleanMesh, SwallowsNoBodies) {
  // A body floats in a dent of a face that is flat within the tolerance.
  constexpr double tolerance = 0.01;
  const TriangleMesh box = dented_box(0.5 * tolerance);
  EXPECT_EQ(cleaned(box, tolerance).mesh.vertices.size(), 8U);
  for (const Vec3d& size : {Vec3d{0.02, 0.02, 0.001}, Vec3d{0.3, 0.02, 0.001}}) {
    TriangleMesh mesh = box;
    const Vec3d middle{0.5, 0.5, 1 - 0.35 * tolerance};
    append(mesh, box_between(middle - size * 0.5, middle + size * 0.5));
    if (!find_self_intersections(mesh, 1).pairs.empty()) continue;
    EXPECT_EQ(clean_mesh(mesh, tolerance).report.betti, (BettiNumbers{2, 0, 0}));
    EXPECT_GE(cleaned(mesh, tolerance).mesh.vertices.size(), 9U + 4U) << "the dent stays";
  }
}

/// The space between two pyramids with a common hexagonal base. The lower one lies inside the upper one.
TriangleMesh dented_pyramid() {
  TriangleMesh mesh;
  for (int k = 0; k < 6; ++k) mesh.vertices.push_back({std::cos(1.0471975512 * k), std::sin(1.0471975512 * k), 0});
  mesh.vertices.push_back({0, 0, 0.2});
  mesh.vertices.push_back({0, 0, 0.1});
  for (std::uint32_t k = 0; k < 6; ++k) {
    mesh.triangles.push_back({k, (k + 1) % 6, 6});
    mesh.triangles.push_back({(k + 1) % 6, k, 7});
  }
  return mesh;
}

TEST(CleanMesh, TurnsNothingInsideOut) {
  const TriangleMesh mesh = dented_pyramid();
  ASSERT_EQ(betti_of(mesh), (BettiNumbers{1, 0, 0}));
  for (const double tolerance : {0.05, 0.15, 0.3, 1.0}) static_cast<void>(cleaned(mesh, tolerance));

  detail::ShrinkingSurface surface(mesh);
  detail::StepCheck check(surface, {});
  detail::Star star;
  surface.find_star(6, star);
  detail::SurfaceStep step;
  step.old_triangles = star.triangles;
  const std::uint32_t w = star.ring[0];
  for (std::size_t k = 1; k < 5; ++k) {
    step.new_triangles.push_back({w, star.ring[k], star.ring[k + 1]});
    step.swept.push_back({6, w, star.ring[k], star.ring[k + 1]});
  }
  EXPECT_TRUE(check.passes(step)) << "no triangles touch";
  step.border.push_back({star.ring[1], star.ring[2], 6, w, 7});
  EXPECT_FALSE(check.passes(step)) << "the lower pyramid would be the upper one";
  step.border.back().old_apex = 7;
  step.border.back().outer_apex = 6;
  EXPECT_TRUE(check.passes(step)) << "the lower one moves away from the upper one";
}

TEST(CleanMesh, ShrinksLargeShapesAndKeepsTheirTopology) {
  for (const double tolerance : {0.01, 0.1, 0.5}) {
    EXPECT_LT(cleaned(make_torus({.ring_segments = 64, .tube_segments = 32}), tolerance).mesh.triangles.size(), 2500U);
    static_cast<void>(cleaned(make_nested_shells({.shells = 4, .frequency = 6}), tolerance));
    static_cast<void>(cleaned(make_plate(), tolerance));
    static_cast<void>(cleaned(make_linked_tori({.ring_segments = 32, .tube_segments = 12}), tolerance));
  }
}

TEST(CleanMesh, DoesNotDependOnScaleAndPlace) {
  const TriangleMesh mesh = make_subdivided(make_bracket(), 1);
  const CleanedMesh here = cleaned(mesh, 1e-5);
  for (const double scale : {0x1p-80, 0x1p-20, 0x1p140}) {
    const CleanedMesh there = cleaned(moved(mesh, scale), 1e-5 * scale);
    EXPECT_EQ(there.mesh.triangles, here.mesh.triangles) << scale;
  }
  EXPECT_LE(cleaned(moved(mesh, 1, {1e6, -1e6, 1e6}), 1e-5).mesh.vertices.size(), here.mesh.vertices.size() + 20);
}

TEST(CleanMesh, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = make_noisy(make_subdivided(make_gear(), 1), 1e-6);
  const CleanedMesh one = clean_mesh(mesh, 1e-4, {.threads = 1});
  for (const int threads : {2, 5}) {
    const CleanedMesh more = clean_mesh(mesh, 1e-4, {.threads = threads});
    EXPECT_EQ(more.mesh.triangles, one.mesh.triangles);
    EXPECT_EQ(more.vertex_of, one.vertex_of);
    EXPECT_EQ(more.report.deviation, one.report.deviation);
  }
}

TEST(CleanMesh, RemovesUnusedVerticesSegmentsAndPoints) {
  TriangleMesh mesh = make_box();
  mesh.vertices.insert(mesh.vertices.begin(), {50, 50, 50});
  for (Triangle& t : mesh.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
  mesh.segments.push_back({0, 1});
  mesh.points.push_back(0);
  const CleanedMesh out = clean_mesh(mesh, 1e-6);
  EXPECT_EQ(out.vertex_of.front(), 1U);
  EXPECT_TRUE(out.mesh.segments.empty() && out.mesh.points.empty());
  EXPECT_EQ(out.report.vertices_before, 8U);
}

TEST(CleanMesh, ReportsProgressAndStops) {
  const TriangleMesh mesh = make_subdivided(make_box(), 5);
  double last = 0;
  std::size_t steps = 0;
  std::stop_source stop;
  Context context;
  context.progress = [&](double fraction, std::string_view phase) {
    if (phase != "steps") return;
    EXPECT_GE(fraction, last);
    last = fraction;
    ++steps;
  };
  static_cast<void>(clean_mesh(mesh, 1e-6, context));
  EXPECT_EQ(last, 1);
  EXPECT_GT(steps, 5U);
  context.cancel = stop.get_token();
  context.progress = [&](double, std::string_view phase) {
    if (phase == "steps") stop.request_stop();
  };
  EXPECT_THROW(static_cast<void>(clean_mesh(mesh, 1e-6, context)), Cancelled);
}

std::string message_of(const MeshView& mesh, double tolerance) {
  try {
    static_cast<void>(clean_mesh(mesh, tolerance));
  } catch (const InvalidMesh& error) {
    return error.what();
  } catch (const InvalidOption& error) {
    return std::string("option: ") + error.what();
  }
  return "";
}

// Reversed triangles are corrected, and the mesh is then cleaned in the same way.
TEST(CleanMesh, CorrectsReversedTriangles) {
  const TriangleMesh box = make_subdivided(make_box(), 2);
  const CleanedMesh want = clean_mesh(box, 0.001);
  TriangleMesh inwards = box;
  inwards.triangles = reversed_triangles(inwards.triangles);
  std::swap(inwards.triangles[7][1], inwards.triangles[7][2]);
  const CleanedMesh out = clean_mesh(inwards, 0.001);
  EXPECT_EQ(out.report.reversed_shells, 1U);
  EXPECT_EQ(out.report.reversed_triangles, 1U);
  EXPECT_TRUE(want.warnings.empty());
  ASSERT_EQ(out.warnings.size(), 2U);
  EXPECT_EQ(out.warnings[0].code, WarningCode::reversed_shells);
  inwards.segments = {{0, 1}};
  EXPECT_EQ(clean_mesh(inwards, 0.001).warnings.back(),
            (Warning{WarningCode::left_out, "1 segment and 0 points besides the triangles were left out"}));
  EXPECT_EQ(out.report.betti, want.report.betti);
  EXPECT_EQ(out.mesh.triangles.size(), want.mesh.triangles.size());
}

// Crossings are resolved first. The surface of the solid is then cleaned.
TEST(CleanMesh, ResolvesCrossings) {
  TriangleMesh crossing = make_subdivided(box_between({0, 0, 0}, {1, 1, 1}), 2);
  append(crossing, box_between({0.5, 0.5, 0.5}, {2, 2, 2}));
  const CleanedMesh out = clean_mesh(crossing, 1e-6);
  const Topology facts = topology(out.mesh);
  EXPECT_EQ(facts.betti, (BettiNumbers{1, 0, 0}));
  EXPECT_NEAR(facts.signed_volume, 1 + 1.5 * 1.5 * 1.5 - 0.125, 1e-9);
  EXPECT_LT(out.mesh.triangles.size(), crossing.triangles.size());
  EXPECT_EQ(out.solid.betti(), facts.betti);
  for (std::size_t v = 0; v < out.vertex_of.size(); ++v) {
    if (out.vertex_of[v] == SolidBody::no_vertex) continue;
    EXPECT_EQ(out.mesh.vertices[v], crossing.vertices[out.vertex_of[v]]);
  }
}

TEST(CleanMesh, RejectsMeshesThatBoundNoSolid) {
  TriangleMesh open = make_box();
  open.triangles.pop_back();
  EXPECT_NE(message_of(open, 0.01).find("closed"), std::string::npos);
  TriangleMesh touching = box_between({0, 0, 0}, {1, 1, 1});
  append(touching, box_between({0.3, 0.3, 1}, {0.6, 0.6, 2}));
  EXPECT_NE(message_of(touching, 0.01).find("crosses or touches itself"), std::string::npos);
  TriangleMesh corners = box_between({0, 0, 0}, {1, 1, 1});
  append(corners, box_between({1, 1, 1}, {2, 2, 2}));
  EXPECT_NE(message_of(corners, 0.01).find("coincide"), std::string::npos);
  TriangleMesh crossing = box_between({0, 0, 0}, {1, 1, 1});
  append(crossing, box_between({0.5, 0.5, 0.5}, {2, 2, 2}));
  crossing.triangles.pop_back();
  EXPECT_NE(message_of(crossing, 0.01).find("closed"), std::string::npos);
  TriangleMesh twice = make_box();
  twice.triangles.push_back({0, 0, 1});
  EXPECT_NE(message_of(twice, 0.01).find("uses a vertex twice"), std::string::npos);
  TriangleMesh tiny = make_box();
  tiny.vertices[1].x = 1e-60;
  EXPECT_NE(message_of(tiny, 0.01).find("1e-60"), std::string::npos);
  EXPECT_NE(message_of(moved(make_box(), 1e50), 1e48).find("1e-45 to 1e45"), std::string::npos);
  EXPECT_NE(message_of({}, 0.01), "");
}

TEST(CleanMesh, RejectsInvalidTolerances) {
  for (const double tolerance :
       {0.0, -1.0, 1e-13, 3.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_NE(message_of(make_box(), tolerance).find("option: cleaning a mesh: the tolerance"), std::string::npos)
        << tolerance;
  }
}

}  // namespace
}  // namespace blum
