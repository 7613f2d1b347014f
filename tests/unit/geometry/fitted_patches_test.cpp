// Fitted patches are the planes, spheres, cylinders and cones from which a mesh was made. Positions, rounding and noise
// below the tolerance do not matter. Shapes that are not there are not found. Slow checks confirm the stated limits.
#include "blum/geometry/fitted_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/surface_patches.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using detail::FittedPatches;
using detail::SurfacePatches;

constexpr double pi = std::numbers::pi;

/// Numbers of planes, spheres, cylinders and cones.
using Kinds = std::array<std::size_t, 4>;

FittedPatches fitted(const TriangleMesh& mesh, double tolerance, double angle = 30, int threads = 1) {
  const SiteTable sites(mesh);
  const std::vector<Vec3d> normals = detail::triangle_normals(mesh);
  const SurfacePatches flat(mesh, sites, normals, 0, {});
  std::vector<std::uint32_t> face_of;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) face_of.push_back(flat.of_face(t));
  Context context;
  context.threads = threads;
  return detail::fit_patches(mesh, sites, {face_of, normals, tolerance, angle}, context);
}

Kinds kinds_of(const FittedPatches& found) {
  Kinds out{};
  for (const SurfaceShape& shape : found.shapes) ++out[static_cast<std::size_t>(shape.kind)];
  return out;
}

/// Surface of revolution about the z axis. Each point of the profile (radius, z) becomes a ring of vertices, or one
/// vertex on the axis. Rings of the first and the last point are closed by flat caps.
TriangleMesh revolved(const std::vector<std::array<double, 2>>& profile, std::uint32_t sides) {
  TriangleMesh out;
  std::vector<std::vector<std::uint32_t>> rings;
  for (const auto& [radius, z] : profile) {
    std::vector<std::uint32_t>& ring = rings.emplace_back();
    for (std::uint32_t k = 0; k < sides; ++k) {
      if (radius > 0 || k == 0) {
        const double angle = 2 * pi * (k + 0.25) / sides;
        out.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
      }
      ring.push_back(static_cast<std::uint32_t>(out.vertices.size() - 1));
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) out.triangles.push_back({a, b, c});
  };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t next = (k + 1) % sides;
      add(rings[r][k], rings[r][next], rings[r + 1][next]);
      add(rings[r][k], rings[r + 1][next], rings[r + 1][k]);
    }
  }
  for (std::uint32_t k = 1; k + 1 < sides; ++k) {
    add(rings.front()[0], rings.front()[k + 1], rings.front()[k]);
    add(rings.back()[0], rings.back()[k], rings.back()[k + 1]);
  }
  return out;
}

/// Box with round edges and corners. Each edge has 2 n strips. Positions on the surface of a lattice become directions.
TriangleMesh rounded_box(const Vec3d& size, double radius, int n) {
  const int most = 2 * n + 1;
  TriangleMesh out;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [place, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(out.vertices.size()));
    if (!is_new) return place->second;
    Vec3d middle, way;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_low = at[k] <= n;
      middle[k] = (is_low ? -1 : 1) * (size[k] / 2 - radius);
      way[k] = std::tan(pi / 4 * (is_low ? at[k] - n : at[k] - n - 1) / n);
    }
    out.vertices.push_back(middle + radius / length(way) * way);
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int end : {0, most}) {
      for (int i = 0; i < most; ++i) {
        for (int j = 0; j < most; ++j) {
          std::array<std::uint32_t, 4> corners{};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> at{};
            at[axis] = end;
            at[u] = i + (k == 1 || k == 2 ? 1 : 0);
            at[v] = j + (k >= 2 ? 1 : 0);
            corners[static_cast<std::size_t>(k)] = vertex(at);
          }
          if (end == 0) std::swap(corners[1], corners[3]);
          out.triangles.push_back({corners[0], corners[1], corners[2]});
          out.triangles.push_back({corners[0], corners[2], corners[3]});
        }
      }
    }
  }
  return out;
}

/// A mesh, and the same mesh turned, in single precision, far off and tiny. Numbers: tolerances.
std::vector<std::pair<TriangleMesh, double>> places_of(const TriangleMesh& mesh) {
  const TriangleMesh turned = test::turned(mesh);
  return {{mesh, 1e-9},
          {turned, 1e-9},
          {test::in_single_precision(turned), 1e-6},
          {test::moved(turned, 1, {1e6, -2e6, 3e6}), 1e-8},
          {test::moved(turned, 1e-9), 1e-18}};
}

/// Checks the limits that fit_patches() states: connected parts, distances of all vertices, and numbers in order.
void expect_valid(const TriangleMesh& mesh, const FittedPatches& found, double tolerance) {
  std::uint32_t next = 0;
  std::vector<double> largest(found.shapes.size(), 0);
  const double rounding = 1e-15 * bounds(mesh).largest_coordinate(), size = bounds(mesh).diagonal();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t patch = found.patch_of[t];
    if (patch == SurfacePatches::none) continue;
    ASSERT_LE(patch, next);
    next = std::max(next, patch + 1);
    const SurfaceShape& shape = found.shapes[patch];
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vec3d way = mesh.vertices[v] - shape.point;
      const double along = dot(way, shape.axis), across = length(way - along * shape.axis);
      const double half = shape.half_angle * pi / 180;
      const double distance = shape.kind == SurfaceKind::plane      ? along
                              : shape.kind == SurfaceKind::sphere   ? length(way) - shape.radius
                              : shape.kind == SurfaceKind::cylinder ? across - shape.radius
                                                                    : across * std::cos(half) - along * std::sin(half);
      largest[patch] = std::max(largest[patch], std::abs(distance));
    }
  }
  ASSERT_EQ(next, found.shapes.size());
  for (std::size_t k = 0; k < largest.size(); ++k) {
    EXPECT_LE(found.shapes[k].deviation, 1.000001 * tolerance + rounding);
    EXPECT_NEAR(largest[k], found.shapes[k].deviation, 1e-9 * size + 10 * rounding);
  }
}

TEST(FittedPatches, AreTheShapesOfMadeSolids) {
  struct Case {
    std::string name;
    TriangleMesh mesh;
    Kinds kinds;
  };
  std::vector<std::array<double, 2>> dome{{1, -1}};
  for (int k = 0; k <= 16; ++k) dome.push_back({k == 16 ? 0 : std::cos(pi / 2 * k / 16), std::sin(pi / 2 * k / 16)});
  const std::vector<Case> cases{
      {"cylinder of 64", revolved({{1, 0}, {1, 3}}, 64), {2, 0, 1, 0}},
      {"cylinder of 256", revolved({{1, 0}, {1, 3}}, 256), {2, 0, 1, 0}},
      {"cylinder of 64, of rings", revolved({{1, 0}, {1, 0.5}, {1, 0.6}, {1, 3}}, 64), {2, 0, 1, 0}},
      {"cylinder of 13", revolved({{1, 0}, {1, 3}}, 13), {2, 0, 1, 0}},
      {"frustum", revolved({{2, 0}, {1, 1.5}}, 64), {2, 0, 0, 1}},
      {"cone to an apex", revolved({{2, 0}, {0, 3}}, 48), {1, 0, 0, 1}},
      {"two cones", revolved({{1, 0}, {2, 1}, {1.5, 2}}, 48), {2, 0, 0, 2}},
      {"chamfer of 20 degrees", revolved({{1, 0}, {1, 2}, {1 - 0.2 * std::tan(pi / 9), 2.2}}, 64), {2, 0, 1, 1}},
      {"step", revolved({{2, 0}, {2, 1}, {1, 1}, {1, 2}}, 48), {3, 0, 2, 0}},
      {"bar with a dome", revolved(dome, 64), {1, 1, 1, 0}},
      {"ball of triangles", make_sphere(), {0, 1, 0, 0}},
      {"ball of rings", make_uv_sphere(), {0, 1, 0, 0}},
      {"rounded box", rounded_box({3, 2, 1.5}, 0.3, 3), {6, 8, 12, 0}},
      {"rounded box, finer", rounded_box({3, 2, 1.5}, 0.3, 5), {6, 8, 12, 0}},
      {"rounded plate", rounded_box({10, 8, 0.5}, 0.1, 3), {6, 8, 12, 0}},
      {"box", make_box(), {6, 0, 0, 0}},
      {"wedge", make_wedge(), {5, 0, 0, 0}},
  };
  for (const Case& one : cases) {
    for (const auto& [mesh, tolerance] : places_of(one.mesh)) {
      const FittedPatches found = fitted(mesh, tolerance);
      EXPECT_EQ(kinds_of(found), one.kinds) << one.name << ", " << tolerance;
      expect_valid(mesh, found, tolerance);
    }
  }
}

/// The shape with most triangles of a kind.
SurfaceShape first_of(const FittedPatches& found, SurfaceKind kind) {
  const auto at = std::find_if(found.shapes.begin(), found.shapes.end(),
                               [&](const SurfaceShape& shape) { return shape.kind == kind; });
  return at == found.shapes.end() ? SurfaceShape{} : *at;
}

TEST(FittedPatches, ReportParametersOfShapes) {
  const FittedPatches step = fitted(revolved({{2, 0}, {2, 1}, {0.75, 1}, {0.75, 2}}, 48), 1e-9);
  std::vector<double> radii;
  for (const SurfaceShape& shape : step.shapes) {
    if (shape.kind == SurfaceKind::cylinder) radii.push_back(shape.radius);
    EXPECT_NEAR(std::abs(shape.axis.z), 1, 1e-12);
    EXPECT_FALSE(shape.concave);
    EXPECT_LT(shape.deviation, 1e-14);
  }
  std::sort(radii.begin(), radii.end());
  ASSERT_EQ(radii.size(), 2U);
  EXPECT_NEAR(radii[0], 0.75, 1e-12);
  EXPECT_NEAR(radii[1], 2, 1e-12);

  const SurfaceShape cone = first_of(fitted(revolved({{2, 0}, {1, 1}}, 48), 1e-9), SurfaceKind::cone);
  EXPECT_NEAR(cone.half_angle, 45, 1e-10);
  EXPECT_NEAR(length(cone.point - Vec3d{0, 0, 2}), 0, 1e-11);
  EXPECT_NEAR(cone.axis.z, -1, 1e-12) << "from the apex to the part";
  EXPECT_EQ(cone.radius, 0);

  const SurfaceShape ball = first_of(fitted(test::moved(make_sphere(), 3, {5, 6, 7}), 1e-9), SurfaceKind::sphere);
  EXPECT_NEAR(ball.radius, 3 * length(make_sphere().vertices.front()), 1e-10);
  EXPECT_NEAR(length(ball.point - Vec3d{5, 6, 7}), 0, 1e-10);
  EXPECT_EQ(ball.axis, Vec3d{});

  TriangleMesh inside_out = revolved({{1, 0}, {1, 3}}, 32);
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  const FittedPatches hole = fitted(inside_out, 1e-9);
  EXPECT_EQ(kinds_of(hole), (Kinds{2, 0, 1, 0}));
  EXPECT_TRUE(first_of(hole, SurfaceKind::cylinder).concave);
  EXPECT_NEAR(first_of(hole, SurfaceKind::plane).axis.z, first_of(hole, SurfaceKind::plane).point.z < 1 ? 1 : -1,
              1e-12);
}

/// Noise below the tolerance changes no shape. Noise above it leaves no cylinder, sphere or cone.
TEST(FittedPatches, NoiseBelowTheToleranceDoesNotMatter) {
  std::vector<std::array<double, 2>> rings{{1, 0}};
  for (int k = 1; k <= 40; ++k) rings.push_back({1, 0.1 * k});
  const TriangleMesh tube = revolved(rings, 64);
  const TriangleMesh ball = make_sphere();
  for (const double noise : {1e-5, 1e-4, 1e-3}) {
    // make_noisy() moves vertices by at most this along each axis.
    const FittedPatches found = fitted(make_noisy(tube, noise), 4 * noise);
    EXPECT_EQ(kinds_of(found)[2], 1U) << noise;
    EXPECT_NEAR(first_of(found, SurfaceKind::cylinder).radius, 1, noise);
    const FittedPatches round = fitted(make_noisy(ball, noise), 4 * noise);
    EXPECT_EQ(kinds_of(round), (Kinds{0, 1, 0, 0})) << noise;
    for (const TriangleMesh& mesh : {make_noisy(tube, noise), make_noisy(ball, noise)}) {
      const Kinds kinds = kinds_of(fitted(mesh, noise / 50));
      EXPECT_EQ(kinds[1] + kinds[2] + kinds[3], 0U) << noise;
    }
  }
}

TEST(FittedPatches, FreeShapesAreLeftAlone) {
  for (const TriangleMesh& mesh : {make_ellipsoid(), make_torus(), make_torus_knot()}) {
    const double tolerance = 1e-6 * bounds(mesh).diagonal();
    const FittedPatches found = fitted(mesh, tolerance);
    const Kinds kinds = kinds_of(found);
    EXPECT_EQ(kinds[1] + kinds[2] + kinds[3], 0U);
    expect_valid(mesh, found, tolerance);
  }
}

/// Each face of a fillet, of a ball and of a plane belongs to the shape on which it lies. This holds even if the
/// tolerance is so large that a neighbouring shape fits it, too.
TEST(FittedPatches, TheLeastDeviationDecidesBetweenTangentShapes) {
  for (const double tolerance : {1e-9, 1e-6, 1e-4, 1e-3, 1e-2}) {
    const TriangleMesh mesh = rounded_box({3, 2, 1.5}, 0.3, 6);
    const FittedPatches found = fitted(mesh, tolerance);
    EXPECT_EQ(kinds_of(found), (Kinds{6, 8, 12, 0})) << tolerance;
    std::vector<std::size_t> counts(found.shapes.size(), 0);
    for (const std::uint32_t patch : found.patch_of) ++counts[patch];
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const SurfaceKind kind = found.shapes[k].kind;
      EXPECT_EQ(counts[k], kind == SurfaceKind::plane ? 2U : kind == SurfaceKind::cylinder ? 24U : 216U) << tolerance;
      EXPECT_LT(found.shapes[k].deviation, 1e-12);
      EXPECT_NEAR(found.shapes[k].radius, kind == SurfaceKind::plane ? 0 : 0.3, 1e-11);
    }
  }
}

/// A flat on a shaft is a plane, though its four vertices lie on the cylinder. The sides of a prism with larger bends
/// are planes. A cap whose vertices lie on the same sphere or cone as the side is a plane.
TEST(FittedPatches, FlatFacesStayPlanes) {
  TriangleMesh shaft = revolved({{1, 0}, {1, 3}}, 96);
  std::vector<std::uint32_t> number(shaft.vertices.size());
  TriangleMesh cut;
  for (std::uint32_t v = 0; v < shaft.vertices.size(); ++v) {
    const std::uint32_t k = v % 96;
    number[v] = k > 0 && k < 7 ? number[v - 1] : static_cast<std::uint32_t>(cut.vertices.size());
    if (number[v] == cut.vertices.size()) cut.vertices.push_back(shaft.vertices[v]);
  }
  for (const auto& [a, b, c] : shaft.triangles) {
    const Triangle t{number[a], number[b], number[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) cut.triangles.push_back(t);
  }
  EXPECT_EQ(kinds_of(fitted(cut, 1e-9)), (Kinds{3, 0, 1, 0}));
  EXPECT_EQ(kinds_of(fitted(revolved({{1, 0}, {1, 3}}, 8), 1e-9)), (Kinds{10, 0, 0, 0}));
  EXPECT_EQ(kinds_of(fitted(revolved({{1, 0}, {1, 3}}, 8), 1e-9, 45)), (Kinds{2, 0, 1, 0}));
  EXPECT_EQ(kinds_of(fitted(revolved({{2, 0}, {1, 0.1}}, 64), 1e-9)), (Kinds{2, 0, 0, 1}));
}

TEST(FittedPatches, DoNotDependOnThreadsOrOnTheOrderOfTriangles) {
  const TriangleMesh mesh = rounded_box({3, 2, 1.5}, 0.3, 4);
  const FittedPatches one = fitted(mesh, 1e-6, 30, 1);
  const FittedPatches many = fitted(mesh, 1e-6, 30, 4);
  EXPECT_EQ(one.patch_of, many.patch_of);
  ASSERT_EQ(one.shapes.size(), many.shapes.size());
  for (std::size_t k = 0; k < one.shapes.size(); ++k) {
    EXPECT_EQ(one.shapes[k].point, many.shapes[k].point);
    EXPECT_EQ(one.shapes[k].deviation, many.shapes[k].deviation);
  }
  std::mt19937 random(3);
  TriangleMesh other = mesh;
  std::shuffle(other.triangles.begin(), other.triangles.end(), random);
  EXPECT_EQ(kinds_of(fitted(other, 1e-6)), kinds_of(one));
}

TEST(FittedPatches, BadTolerancesAreRefused) {
  EXPECT_NO_THROW(detail::check_patch_fit({}));
  EXPECT_NO_THROW(detail::check_patch_fit(1e-300));
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(detail::check_patch_fit(bad), InvalidOption);
}

/// Triangles without area belong to no part, or to that of their flat face.
TEST(FittedPatches, TrianglesWithoutAreaAreLeftOut) {
  TriangleMesh mesh = revolved({{1, 0}, {1, 3}}, 32);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 0, 0});
  const FittedPatches found = fitted(mesh, 1e-9);
  EXPECT_EQ(kinds_of(found), (Kinds{2, 0, 1, 0}));
  EXPECT_EQ(found.patch_of.back(), SurfacePatches::none);
  EXPECT_TRUE(fitted(TriangleMesh{}, 1e-9).shapes.empty());
}

}  // namespace
}  // namespace blum
