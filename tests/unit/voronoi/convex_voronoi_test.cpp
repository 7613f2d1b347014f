// Proves that Voronoi diagrams of convex solids have the exact sheets, seams and junctions. Counts of plain and
// degenerate solids are known. Those of random polyhedra are compared with a search over all quadruples of planes.
// Regions fill the solid, and rounding of coordinates changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "support/double_cone.hpp"
#include "support/mesh_places.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

using Counts = std::array<std::size_t, 3>;  // sheets, seams, junctions

Counts counts_of(const VoronoiGraph& graph) {
  return {graph.walls.size(), graph.seams.size(), graph.junctions.size()};
}

VoronoiComplex walls_of(const TriangleMesh& mesh, std::optional<double> flatness = {}) {
  return voronoi_complex(mesh, {.part = VoronoiPart::walls, .flatness = flatness});
}

TriangleMesh turned(TriangleMesh mesh, std::uint64_t seed) {
  Random random(seed);
  const RigidTransform transform = test::random_transform(random, 0);
  for (Vec3d& v : mesh.vertices) v = transform(v);
  return mesh;
}

TriangleMesh box_of(double a, double b, double c) {
  TriangleMesh mesh = make_box();
  for (Vec3d& v : mesh.vertices) v = {v.x * a, v.y * b, v.z * c};
  return mesh;
}

TriangleMesh prism(double thickness) {
  TriangleMesh mesh;
  for (const double z : {0.0, 10.0}) {
    for (const Vec3d& p : {Vec3d{0, -thickness / 2, z}, Vec3d{0, thickness / 2, z}, Vec3d{8, 0, z}}) {
      mesh.vertices.push_back(p);
    }
  }
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
  return mesh;
}

TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// Pyramid with a square base. All five planes touch one ball if the height is sqrt(3) times half the side.
TriangleMesh pyramid(double height) {
  TriangleMesh mesh;
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, height}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return mesh;
}

/// Hull of random points on a sphere, by a search over all triples.
TriangleMesh random_hull(std::uint64_t seed, std::size_t points) {
  Random random(seed);
  TriangleMesh mesh;
  while (mesh.vertices.size() < points) {
    const Vec3d p = random.in_cube() * 2.0 - Vec3d{1, 1, 1};
    if (length(p) > 0.1 && length(p) < 1) mesh.vertices.push_back(p / length(p));
  }
  const auto count = static_cast<std::uint32_t>(points);
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      for (std::uint32_t c = b + 1; c < count; ++c) {
        std::set<int> sides;
        for (std::uint32_t d = 0; d < count; ++d) {
          if (d == a || d == b || d == c) continue;
          sides.insert(detail::orient3d(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]));
        }
        if (sides.size() == 1) mesh.triangles.push_back({a, b, c});
      }
    }
  }
  return mesh;
}

struct Known {
  std::string name;
  TriangleMesh mesh;
  Counts counts{};
};

/// Solids with counts that follow by hand or from the literature of the envelope; junctions include convex vertices.
std::vector<Known> known_solids() {
  std::vector<Known> out{{"Box", box_of(3, 2, 1), {13, 12, 12}},      {"Cube", make_box(), {12, 8, 9}},
                         {"SquareRod", box_of(1, 1, 3), {12, 9, 10}}, {"SquarePlate", box_of(3, 3, 1), {13, 12, 12}},
                         {"Plate", box_of(1, 1, 1e-4), {13, 12, 12}}, {"LongRod", box_of(1, 1e-4, 2e-4), {13, 12, 12}},
                         {"Octahedron", octahedron(), {12, 6, 7}},    {"Pyramid", pyramid(0.5), {8, 5, 6}}};
  for (const double thickness : {2.0, 0.1, 1e-3, 1e-5}) {
    out.push_back({"Prism" + std::to_string(out.size()), prism(thickness), {9, 7, 8}});
  }
  return out;
}

TEST(ConvexVoronoi, KnownSolidsHaveTheirSheetsSeamsAndJunctions) {
  for (const Known& known : known_solids()) {
    SCOPED_TRACE(known.name);
    const VoronoiComplex found = walls_of(known.mesh);
    EXPECT_TRUE(found.report.certified);
    EXPECT_TRUE(found.report.exact);
    EXPECT_EQ(counts_of(voronoi_graph(found.complex)), known.counts);
  }
}

/// Rotated corners are rounded, so flat quadrangles bend and degenerate junctions fall apart, unless they are joined.
TEST(ConvexVoronoi, RotatedSolidsHaveTheSameCounts) {
  for (const Known& known : known_solids()) {
    if (known.name == "Plate" || known.name == "LongRod") continue;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(known.name + " " + std::to_string(seed));
      const VoronoiComplex found = walls_of(turned(known.mesh, seed));
      EXPECT_TRUE(found.report.exact);
      EXPECT_TRUE(found.report.certified);
      EXPECT_EQ(counts_of(voronoi_graph(found.complex)), known.counts);
    }
  }
}

TEST(ConvexVoronoi, SolidsInSinglePrecisionFarAwayAndTinyHaveTheSameCounts) {
  for (const Known& known : known_solids()) {
    if (known.name == "Plate" || known.name == "LongRod" || known.name.starts_with("Prism")) continue;
    SCOPED_TRACE(known.name);
    const TriangleMesh single = test::in_single_precision(turned(known.mesh, 5));
    EXPECT_EQ(counts_of(voronoi_graph(walls_of(single).complex)), known.counts);
    TriangleMesh far = known.mesh;
    for (Vec3d& v : far.vertices) v += Vec3d{1e6, -1e6, 1e6};
    EXPECT_EQ(counts_of(voronoi_graph(walls_of(far).complex)), known.counts);
    TriangleMesh tiny = known.mesh;
    for (Vec3d& v : tiny.vertices) v = v * 0x1p-40;
    EXPECT_EQ(counts_of(voronoi_graph(walls_of(tiny).complex)), known.counts);
  }
}

/// Plane of a triangle: unit normal towards the inside, and offset.
struct Plane {
  Vec3d normal;
  double offset = 0;
};

/// Solves three equations normal . x - weight * h = -offset for the differences of four rows. Cramer's rule.
std::optional<std::array<double, 4>> solve(const std::array<std::array<double, 5>, 4>& rows) {
  std::array<std::array<double, 5>, 4> a = rows;
  for (std::size_t k = 0; k < 4; ++k) {
    std::size_t pivot = k;
    for (std::size_t m = k; m < 4; ++m) pivot = std::abs(a[m][k]) > std::abs(a[pivot][k]) ? m : pivot;
    if (std::abs(a[pivot][k]) < 1e-9) return std::nullopt;
    std::swap(a[k], a[pivot]);
    for (std::size_t m = 0; m < 4; ++m) {
      if (m == k) continue;
      const double factor = a[m][k] / a[k][k];
      for (std::size_t c = 0; c < 5; ++c) a[m][c] -= factor * a[k][c];
    }
  }
  return std::array{a[0][4] / a[0][0], a[1][4] / a[1][1], a[2][4] / a[2][2], a[3][4] / a[3][3]};
}

/// Counts sheets, seams and junctions in double, from the sets of planes of all points that four half-spaces determine.
Counts counts_by_search(const TriangleMesh& mesh) {
  std::vector<Plane> planes;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& p = mesh.vertices[t[0]];
    const Vec3d area = cross(mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p);
    Vec3d normal = area / length(area);
    Vec3d middle;
    for (const Vec3d& v : mesh.vertices) middle += v / static_cast<double>(mesh.vertices.size());
    if (dot(normal, middle - p) < 0) normal = normal * -1.0;
    planes.push_back({normal, -dot(normal, p)});
  }
  const std::size_t floor = planes.size();
  const auto row = [&](std::size_t k) -> std::array<double, 5> {
    if (k == floor) return {0, 0, 0, 1, 0};
    const Plane& plane = planes[k];
    return {plane.normal.x, plane.normal.y, plane.normal.z, -1, -plane.offset};
  };
  std::set<std::vector<std::size_t>> vertices;
  for (std::size_t a = 0; a <= floor; ++a) {
    for (std::size_t b = a + 1; b <= floor; ++b) {
      for (std::size_t c = b + 1; c <= floor; ++c) {
        for (std::size_t d = c + 1; d <= floor; ++d) {
          const auto point = solve({row(a), row(b), row(c), row(d)});
          if (!point) continue;
          std::vector<std::size_t> touching;
          bool is_inside = true;
          for (std::size_t k = 0; k <= floor; ++k) {
            const std::array<double, 5> r = row(k);
            double value = -r[4];
            for (std::size_t m = 0; m < 4; ++m) value += r[m] * (*point)[m];
            if (k != floor && value < -1e-9) is_inside = false;
            if (k == floor && (*point)[3] < -1e-9) is_inside = false;
            if (std::abs(value) < 1e-9) touching.push_back(k);
          }
          if (is_inside) vertices.insert(touching);
        }
      }
    }
  }
  Counts out{};
  const auto count_with = [&](const std::vector<std::size_t>& all) {
    return std::count_if(vertices.begin(), vertices.end(), [&](const std::vector<std::size_t>& v) {
      return std::includes(v.begin(), v.end(), all.begin(), all.end());
    });
  };
  // In general position, two planes with more than two vertices share a sheet, three with two vertices a seam.
  for (std::size_t a = 0; a < floor; ++a) {
    for (std::size_t b = a + 1; b < floor; ++b) {
      out[0] += count_with({a, b}) > 2 ? 1 : 0;
      for (std::size_t c = b + 1; c < floor; ++c) out[1] += count_with({a, b, c}) == 2 ? 1 : 0;
    }
  }
  out[2] = vertices.size();
  return out;
}

TEST(ConvexVoronoi, RandomPolyhedraHaveTheCountsOfASearch) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = random_hull(seed, 4 + seed % 7);
    const VoronoiComplex found = walls_of(mesh);
    EXPECT_TRUE(found.report.exact);
    EXPECT_EQ(counts_of(voronoi_graph(found.complex)), counts_by_search(mesh));
  }
}

/// Each point of a wall is equally far from both sites, and no other face is closer. Regions fill the solid.
TEST(ConvexVoronoi, WallsAreMidwayAndRegionsFillTheSolid) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    TriangleMesh mesh = random_hull(seed, 4 + seed);
    const VoronoiComplex found = voronoi_complex(mesh);
    ASSERT_TRUE(found.report.certified);
    double volume = 0;
    for (const VoronoiRegion& region : voronoi_regions(found.complex)) {
      EXPECT_GT(region.volume, 0);
      volume += region.volume;
    }
    const Solid solid = Solid::of(mesh);
    EXPECT_NEAR(volume, solid.shells()[0].volume, 1e-12);
    const std::vector<VoronoiSite> sites = voronoi_sites(solid.surface().mesh);
    const auto distance = [&](const Vec3d& q, std::size_t site) {
      const Triangle& t = mesh.triangles[sites[site].triangles.front()];
      const Vec3d& p = mesh.vertices[t[0]];
      const Vec3d normal = cross(mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p);
      return std::abs(dot(normal, q - p)) / length(normal);
    };
    const auto site_a = found.complex.triangle_columns.get<std::int32_t>("site_a");
    const auto site_b = found.complex.triangle_columns.get<std::int32_t>("site_b");
    for (std::size_t k = 0; k < found.complex.triangles.size(); ++k) {
      const auto& [a, b, c] = found.complex.triangles[k];
      const auto& p = found.complex.positions;
      const Vec3d middle = (p[a] + p[b] + p[c]) / 3.0;
      const double own = distance(middle, static_cast<std::size_t>(site_b[k]));
      if (site_a[k] >= 0) {
        EXPECT_NEAR(distance(middle, static_cast<std::size_t>(site_a[k])), own, 1e-13);
      } else {
        EXPECT_NEAR(own, 0, 1e-13);
      }
      for (std::size_t site = 0; site < sites.size(); ++site) EXPECT_GT(distance(middle, site), own - 1e-13);
    }
  }
}

TEST(ConvexVoronoi, FlatnessOfZeroTakesTrianglesAsGiven) {
  TriangleMesh bent = make_box();
  bent.vertices[0].x += 1e-13;
  EXPECT_TRUE(walls_of(bent, 1e-12).report.exact);
  EXPECT_EQ(walls_of(bent, 1e-12).report.faces, 6U);
  EXPECT_GT(walls_of(bent, 1e-12).report.flatness, 0);
  EXPECT_NE(walls_of(bent, 0.0).report.faces, 6U);
  EXPECT_THROW((void)walls_of(bent, -1.0), InvalidOption);
}

TEST(ConvexVoronoi, OtherSolidsAreDividedIntoCubes) {
  EXPECT_FALSE(walls_of(make_void_cube({.frequency = 1})).report.exact);
  EXPECT_FALSE(walls_of(make_star()).report.exact);
  EXPECT_FALSE(voronoi_complex(make_box(), {.method = VoronoiMethod::cubes}).report.exact);
}

TEST(ConvexVoronoi, BodiesHaveTheirOwnDiagrams) {
  TriangleMesh two = box_of(3, 2, 1);
  const TriangleMesh other = octahedron();
  const auto first = static_cast<std::uint32_t>(two.vertices.size());
  for (const Vec3d& v : other.vertices) two.vertices.push_back(v + Vec3d{10, 0, 0});
  for (const Triangle& t : other.triangles) two.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const VoronoiComplex found = walls_of(two);
  EXPECT_TRUE(found.report.exact);
  EXPECT_EQ(found.report.found, (BettiNumbers{2, 0, 0}));
  EXPECT_EQ(counts_of(voronoi_graph(found.complex)), (Counts{25, 18, 19}));
}

/// Returns the largest distance of the corners and middles of triangles from another complex.
double furthest(const Complex& from, const Complex& other) {
  double most = 0;
  for (const auto& [a, b, c] : from.triangles) {
    const auto& p = from.positions;
    for (const Vec3d& q : {p[a], (p[a] + p[b] + p[c]) / 3.0}) {
      double least = HUGE_VAL;
      for (const auto& [d, e, f] : other.triangles) {
        const std::array<Vec3d, 3> corners{other.positions[d], other.positions[e], other.positions[f]};
        least = std::min(least, length(closest_point_on_triangle(q, corners) - q));
      }
      most = std::max(most, least);
    }
  }
  return most;
}

/// Box whose upper side is an arch of strips.
TriangleMesh arch(std::uint32_t strips, double height) {
  TriangleMesh mesh;
  for (const double y : {0.0, 1.0}) {
    for (std::uint32_t k = 0; k <= strips; ++k) {
      const double x = 2.0 * k / strips - 1;
      mesh.vertices.push_back({x, y, 1 + height * (1 - x * x)});
    }
  }
  const std::uint32_t row = strips + 1;
  const std::uint32_t base = 2 * row;
  for (const double y : {0.0, 1.0}) {
    for (const double x : {-1.0, 1.0}) mesh.vertices.push_back({x, y, 0});
  }
  for (std::uint32_t k = 0; k < strips; ++k) {
    mesh.triangles.push_back({k, k + 1, row + k + 1});
    mesh.triangles.push_back({k, row + k + 1, row + k});
    mesh.triangles.push_back({base, k + 1, k});
    mesh.triangles.push_back({base + 2, row + k, row + k + 1});
  }
  const std::vector<Triangle> sides{
      {base, base + 1, strips},   {base + 2, row + strips, base + 3}, {base, 0, row},
      {base, row, base + 2},      {base + 1, base + 3, row + strips}, {base + 1, row + strips, strips},
      {base, base + 2, base + 3}, {base, base + 3, base + 1}};
  mesh.triangles.insert(mesh.triangles.end(), sides.begin(), sides.end());
  return mesh;
}

/// Prism over a regular polygon. Its ends are fans of needles around a corner.
TriangleMesh fan_prism(std::uint32_t sides) {
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.vertices.push_back({std::cos(angle), std::sin(angle), z});
    }
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    mesh.triangles.push_back({k, next, sides + next});
    mesh.triangles.push_back({k, sides + next, sides + k});
    if (k == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, k});
    mesh.triangles.push_back({sides, sides + k, sides + next});
  }
  return mesh;
}

/// Ball with rings of planes that each touch a common point of the axis.
TriangleMesh ringed_ball(std::uint32_t rings, std::uint32_t sides) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 1});
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    const double down = std::numbers::pi * ring / rings;
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.vertices.push_back({std::sin(down) * std::cos(angle), std::sin(down) * std::sin(angle), std::cos(down)});
    }
  }
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, -1});
  const auto at = [&](std::uint32_t ring, std::uint32_t k) { return 1 + (ring - 1) * sides + k % sides; };
  for (std::uint32_t k = 0; k < sides; ++k) {
    mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
    mesh.triangles.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
  }
  return mesh;
}

/// The ends of a rounded prism consist of needles, whose planes are not known well at the other side.
TEST(ConvexVoronoi, RoundedFansOfNeedlesAreOneFace) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const VoronoiComplex found = walls_of(test::in_single_precision(turned(fan_prism(200), seed)));
    EXPECT_TRUE(found.report.exact);
    EXPECT_TRUE(found.report.certified);
    EXPECT_EQ(found.report.faces, 202U);
    EXPECT_EQ(counts_of(voronoi_graph(found.complex)), (Counts{601, 600, 600}));
  }
}

/// A joined diagram may have the Euler number of a division without being one.
TEST(ConvexVoronoi, JoinedDiagramsDivideTheSolid) {
  EXPECT_TRUE(walls_of(ringed_ball(20, 40)).report.certified);
}

/// Chains of close junctions move further than each pair is apart.
TEST(ConvexVoronoi, TheDistanceBoundIncludesHowFarJunctionsMove) {
  std::size_t checked = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = random_hull(seed, 60);
    const VoronoiComplex exact = walls_of(mesh, 0.0);
    const VoronoiComplex joined = walls_of(mesh, 1e-5);
    if (joined.report.flatness > 0 || joined.report.joined == 0) continue;
    ++checked;
    EXPECT_LE(furthest(exact.complex, joined.complex), joined.report.hausdorff_bound);
    EXPECT_LE(furthest(joined.complex, exact.complex), joined.report.hausdorff_bound);
  }
  EXPECT_GE(checked, 3U);
}

/// The rounding error of the largest coordinate exceeds the rest of the solid: its triangles count as given.
TEST(ConvexVoronoi, ConvexSolidsThatJoiningWouldFlattenKeepTheirTriangles) {
  TriangleMesh mesh = random_hull(4, 20);
  for (Vec3d& v : mesh.vertices) v = {v.x * 0x1p66, v.y, v.z * 0x1p-66};
  const VoronoiComplex found = walls_of(mesh);
  EXPECT_TRUE(found.report.exact);
  EXPECT_TRUE(found.report.certified);
  EXPECT_EQ(found.report.faces, mesh.triangles.size());
}

/// In units of the smallest coordinate, the others exceed the range of doubles.
TEST(ConvexVoronoi, TinyCoordinatesKeepPositionsFinite) {
  for (const std::optional<double> flatness : {std::optional<double>(), std::optional(1e-12)}) {
    TriangleMesh mesh = make_box();
    const Vec3d corner = mesh.vertices[0];
    for (Vec3d& v : mesh.vertices) v = v - corner;
    mesh.vertices[0] = {1e-300, 1e-300, 1e-300};
    const VoronoiComplex found = walls_of(mesh, flatness);
    for (const Vec3d& p : found.complex.positions) EXPECT_TRUE(is_finite(p));
    EXPECT_EQ(counts_of(voronoi_graph(found.complex)), (Counts{12, 8, 9}));
  }
}

/// Doubles take planes at such angles for parallel; their order must still be one.
TEST(ConvexVoronoi, AlmostFlatArchesHaveAllSheets) {
  constexpr std::uint32_t strips = 40;
  for (const double bend : {1e-7, 1e-9, 1e-11}) {
    SCOPED_TRACE(bend);
    const VoronoiComplex found = walls_of(arch(strips, bend), 0.0);
    EXPECT_TRUE(found.report.exact);
    EXPECT_TRUE(found.report.certified);
    EXPECT_EQ(counts_of(voronoi_graph(found.complex)), (Counts{148, 165, 147}));
  }
}

/// Junctions within 8 times the flatness are one, even if the default would not join as much.
TEST(ConvexVoronoi, AGivenFlatnessJoinsJunctions) {
  const VoronoiComplex found = walls_of(turned(make_box(), 2), 1e-3);
  EXPECT_EQ(found.report.joined, 8e-3);
  EXPECT_EQ(counts_of(voronoi_graph(found.complex)), (Counts{12, 8, 9}));
}

/// In a degenerate solid, the region of one plane may take seconds.
TEST(ConvexVoronoi, RequestsToStopEndTheWork) {
  std::stop_source stop;
  std::chrono::steady_clock::time_point asked;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    asked = std::chrono::steady_clock::now();
    stop.request_stop();
  });
  EXPECT_THROW((void)voronoi_complex(test::double_cone(5000), {}, {.cancel = stop.get_token()}), Cancelled);
  const auto ended = std::chrono::steady_clock::now();
  later.join();
  EXPECT_LT(std::chrono::duration<double>(ended - asked).count(), 0.2);
}

TEST(ConvexVoronoi, ThreadsChangeNothing) {
  const TriangleMesh mesh = random_hull(3, 30);
  const VoronoiComplex one = voronoi_complex(mesh, {}, {.threads = 1});
  const VoronoiComplex four = voronoi_complex(mesh, {}, {.threads = 4});
  EXPECT_EQ(one.complex.positions, four.complex.positions);
  EXPECT_EQ(one.complex.triangles, four.complex.triangles);
  EXPECT_EQ(one.complex.vertex_columns, four.complex.vertex_columns);
  EXPECT_EQ(one.complex.triangle_columns, four.complex.triangle_columns);
}

}  // namespace
}  // namespace blum
