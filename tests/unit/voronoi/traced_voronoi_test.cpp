// Traced diagrams: counts of sheets, seams and junctions that are known by hand, and the maps of walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <stop_token>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "support/mesh_places.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/planes/convex_faces.hpp"
#include "voronoi/traced/line_contact.hpp"
#include "voronoi/traced/local_star.hpp"
#include "voronoi/traced/planar_faces.hpp"
#include "voronoi/traced/sheet_triangles.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"
#include "voronoi/traced/wall_map.hpp"

namespace blum::voronoi {
namespace {

using Counts = std::array<std::size_t, 3>;

TriangleMesh prism(const std::vector<Point2>& outline, double thickness,
                   const std::vector<std::vector<Point2>>& holes = {}) {
  return make_extrusion(outline, holes, {.thickness = thickness});
}

const std::vector<Point2> ell{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
const std::vector<Point2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
const std::vector<std::vector<Point2>> middle_hole{{{1, 1}, {1, 3}, {3, 3}, {3, 1}}};

VoronoiComplex walls_of(const TriangleMesh& mesh, const Context& context = {}) {
  return voronoi_complex(mesh, {.part = VoronoiPart::walls, .method = VoronoiMethod::traced}, context);
}

Counts counts_of(const TriangleMesh& mesh) {
  const VoronoiComplex walls = walls_of(mesh);
  EXPECT_TRUE(walls.report.traced) << walls.report.trace_problem;
  EXPECT_TRUE(walls.report.certified);
  const VoronoiGraph graph = voronoi_graph(walls.complex);
  return {graph.walls.size(), graph.seams.size(), graph.junctions.size()};
}

TracedSites sites_of(const TriangleMesh& mesh) {
  const SiteTable table(mesh);
  return *TracedSites::of(mesh, table, polyhedron_sites(mesh, table), 0, TracedPlaces::merged);
}

/// Returns the largest distance of a corner from the plane of its face's largest triangle.
double largest_height(const TriangleMesh& mesh, const std::vector<std::uint32_t>& face_of,
                      const std::vector<Vec3d>& at) {
  const auto normal_of = [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return cross(at[b] - at[a], at[c] - at[a]);
  };
  std::map<std::uint32_t, std::size_t> largest;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::size_t& of_face = largest.try_emplace(face_of[t], t).first->second;
    if (squared_length(normal_of(t)) > squared_length(normal_of(of_face))) of_face = t;
  }
  double worst = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t of_face = largest[face_of[t]];
    for (const std::uint32_t v : mesh.triangles[t]) {
      worst = std::max(worst, std::abs(dot(unit(normal_of(of_face)), at[v] - at[mesh.triangles[of_face][0]])));
    }
  }
  return worst;
}

/// Let a profile have n sides, r reflex corners, A arcs and N nodes. A long prism over it has 2 (n + r) + A sheets,
/// 2 A + N seams and 2 N + 2 n junctions. The L has 6, 1, 11 and 5.
TEST(TracedDiagram, OfALongPrismHasTheCountsOfItsProfile) {
  EXPECT_EQ(counts_of(prism(ell, 20)), (Counts{25, 27, 22}));
}

/// In the frame, the walls of opposite reflex edges meet in seams of four sites.
TEST(TracedDiagram, OfAFrameHasTheCountsOfItsProfile) {
  EXPECT_EQ(counts_of(prism(square, 20, middle_hole)), (Counts{48, 60, 40}));
}

/// In a thin plate, the sheet between both sides ends in one seam after the other.
TEST(TracedDiagram, OfAThinPrismHasASheetBetweenBothSides) {
  EXPECT_EQ(counts_of(prism(ell, 0.5)), (Counts{22, 21, 19}));
}

/// A side of the bar is bent inwards by a small angle. The region of its reflex edge is a thin wedge, within which more
/// sites than two are nearly equally close. The bar's profile has 5 sides, 1 reflex corner, 9 arcs and 4 nodes.
TEST(TracedDiagram, OfANearlyStraightBarHasTheCountsOfItsProfile) {
  for (const double bend : {0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    SCOPED_TRACE(bend);
    EXPECT_EQ(counts_of(prism({{0, 0}, {5, bend}, {8, 0}, {8, 2}, {0, 2}}, 20)), (Counts{21, 22, 18}));
  }
}

/// The roof of a tent is bent by a small angle along its ridge, so four planes nearly meet in lines from its vertices.
TEST(TracedDiagram, OfNearlyFlatVerticesIsTraced) {
  for (const double height : {1e-2, 1e-4, 1e-6}) {
    SCOPED_TRACE(height);
    TriangleMesh mesh = prism(ell, 20);
    for (Vec3d& p : mesh.vertices) {
      if (p.x == 1 && p.y == 1) p.y += height;
    }
    const VoronoiComplex walls = walls_of(mesh);
    EXPECT_TRUE(walls.report.traced) << walls.report.trace_problem;
  }
}

/// Returns a turned prism of 12 sides, 6 of whose edges are reflex. Rounding to 32 bits bends its bases.
TriangleMesh rounded_star() {
  std::vector<Point2> outline;
  for (int k = 0; k < 12; ++k) {
    const double angle = k * std::numbers::pi / 6;
    outline.push_back({(k % 2 == 0 ? 2 : 1) * std::cos(angle), (k % 2 == 0 ? 2 : 1) * std::sin(angle)});
  }
  return test::in_single_precision(test::turned(prism(outline, 1)));
}

/// Bent bases become flat, and vertices move by about the rounding.
TEST(TracedDiagram, JoinsAndFlattensFacesOfRoundedCoordinates) {
  const TriangleMesh mesh = rounded_star();
  const SiteTable table(mesh);
  const double flatness = rounding_of_coordinates(mesh);
  const std::vector<std::uint32_t> joined =
      join_flat_triangles(mesh, mesh.vertices, table, polyhedron_sites(mesh, table), flatness);
  EXPECT_EQ(std::set<std::uint32_t>(joined.begin(), joined.end()).size(), 14U);
  std::vector<Vec3d> vertices = mesh.vertices;
  EXPECT_GT(largest_height(mesh, joined, vertices), 1e-9) << "rounding bends faces";
  EXPECT_LT(flatten_faces(mesh, joined, vertices), 1e-15);
  EXPECT_LT(largest_height(mesh, joined, vertices), 1e-13);
  for (std::size_t v = 0; v < vertices.size(); ++v) EXPECT_LT(length(vertices[v] - mesh.vertices[v]), 2 * flatness);
}

/// Each face that is left has a region, and the region has the surface of the face's triangles.
TEST(TracedDiagram, ReportsJoinedFaces) {
  const TriangleMesh mesh = rounded_star();
  const VoronoiComplex all = voronoi_complex(mesh, {.method = VoronoiMethod::traced});
  ASSERT_TRUE(all.report.traced) << all.report.trace_problem;
  EXPECT_EQ(all.report.faces, 14U);
  EXPECT_FALSE(all.report.joined_faces.empty());
  std::map<std::int32_t, double> area_of;
  for (const VoronoiRegion& region : voronoi_regions(all.complex)) area_of[region.site] = region.surface_area;
  EXPECT_EQ(area_of.size(), 20U);
  const std::vector<VoronoiSite> sites = voronoi_sites(mesh, all.report);
  std::size_t faces = 0;
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(sites.size()); ++k) {
    const VoronoiSite& site = sites[static_cast<std::size_t>(k)];
    if (site.triangles.empty()) continue;
    double area = 0;
    for (const std::uint32_t t : site.triangles) {
      const auto [a, b, c] = triangle_corners(mesh, t);
      area += length(cross(b - a, c - a)) / 2;
    }
    EXPECT_NEAR(area_of[k], area, 1e-9);
    ++faces;
  }
  EXPECT_EQ(faces, all.report.faces);
}

/// Coordinates that are not rounded join no faces.
TEST(TracedDiagram, ReportsNoJoinedFacesOfFlatOnes) {
  const VoronoiReport report = walls_of(prism(ell, 20)).report;
  EXPECT_TRUE(report.traced);
  EXPECT_TRUE(report.joined_faces.empty());
}

TEST(TracedDiagram, DoesNotDependOnThePlaceOfTheSolid) {
  TriangleMesh mesh = prism(ell, 20);
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3d& p : mesh.vertices) p = Vec3d{c * p.x - s * p.z, p.y, s * p.x + c * p.z} * 1e-3 + Vec3d{7, -5, 3};
  EXPECT_EQ(counts_of(mesh), (Counts{25, 27, 22}));
}

TEST(TracedDiagram, DoesNotDependOnThreads) {
  const TriangleMesh mesh = make_bracket();
  const VoronoiComplex one = walls_of(mesh, {.threads = 1});
  const VoronoiComplex four = walls_of(mesh, {.threads = 4});
  EXPECT_TRUE(one.report.traced) << one.report.trace_problem;
  EXPECT_EQ(one.complex.positions, four.complex.positions);
  EXPECT_EQ(one.complex.triangles, four.complex.triangles);
  EXPECT_EQ(one.report.label_error, four.report.label_error);
}

TEST(TracedDiagram, IsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(std::ignore = walls_of(make_bracket(), {.cancel = stop.get_token()}), Cancelled);
}

/// Each point of a traced wall is as far from its two sites as from the border.
TEST(TracedDiagram, HasWallsBetweenTheirClosestSites) {
  const TriangleMesh mesh = make_bracket();
  const VoronoiComplex walls = walls_of(mesh);
  ASSERT_TRUE(walls.report.traced) << walls.report.trace_problem;
  EXPECT_LE(walls.report.label_error, 4 * walls.report.chord);
  const TracedSites sites = sites_of(mesh);
  const auto radii = walls.complex.vertex_columns.get<double>("radius");
  for (std::size_t v = 0; v < radii.size(); ++v) {
    const Vec3d at = walls.complex.positions[v] - sites.origin();
    EXPECT_NEAR(sites.closest(at, sites.tolerance()).radius, radii[v], 16 * sites.tolerance());
  }
}

/// A solid whose faces are bent by more than the tolerance has no traced diagram of its joined faces.
TEST(TracedDiagram, FallsBackToCubesWithAReason) {
  TriangleMesh mesh = prism(ell, 2);
  const VoronoiOptions options{.method = VoronoiMethod::traced, .flatness = 0.5};
  const VoronoiComplex all = voronoi_complex(mesh, options);
  EXPECT_TRUE(all.report.traced || !all.report.trace_problem.empty());
  EXPECT_TRUE(all.report.certified);
}

/// The limit on the work stops all runs at the same place, and does not change a diagram that needs less.
TEST(TracedDiagram, StopsAtALimitOfItsWork) {
  const TracedSites sites = sites_of(make_bracket());
  std::vector<TracedResult> whole, stopped;
  for (const int threads : {1, 4}) {
    Context context;
    context.threads = threads;
    whole.push_back(traced_structure(sites, TraceEffort::usual, usual_work(sites), context));
    stopped.push_back(traced_structure(sites, TraceEffort::usual, whole.back().work / 2, context));
  }
  ASSERT_TRUE(whole[0].structure) << whole[0].problem;
  EXPECT_LT(10 * whole[0].work, usual_work(sites));
  EXPECT_EQ(whole[0].work, whole[1].work);
  EXPECT_FALSE(stopped[0].structure);
  EXPECT_EQ(stopped[0].problem, "tracing is too much work");
  EXPECT_EQ(stopped[0].place, stopped[1].place);
  EXPECT_EQ(stopped[0].work, stopped[1].work);

  const TracedResult enough = traced_structure(sites, TraceEffort::usual, 8 * whole[0].work, {});
  ASSERT_TRUE(enough.structure);
  EXPECT_EQ(enough.structure->curves.size(), whole[0].structure->curves.size());
}

/// By default, fine tessellations are not traced if they have many sites.
TEST(TracedDiagram, HasALimitByDefault) {
  const auto default_work_of = [](const TriangleMesh& mesh) {
    return default_work(sites_of(mesh), mesh.triangles.size());
  };
  const TriangleMesh bracket = make_bracket();
  const TracedSites sites = sites_of(bracket);
  const std::uint64_t work = traced_structure(sites, TraceEffort::usual, usual_work(sites), {}).work;
  EXPECT_GT(default_work_of(bracket), 4 * work);
  const std::uint64_t coarse = default_work_of(make_torus({.ring_segments = 20, .tube_segments = 10}));
  EXPECT_GT(coarse, 0U);
  EXPECT_LT(coarse, default_work_of(bracket));
  EXPECT_EQ(default_work_of(make_torus({.ring_segments = 80, .tube_segments = 40})), 0U);
}

/// Only cubes bound the distance from the exact diagram.
TEST(TracedDiagram, IsTheDefaultExceptForTolerances) {
  const TriangleMesh mesh = prism(ell, 2);
  for (const VoronoiPart part : {VoronoiPart::all, VoronoiPart::walls, VoronoiPart::medial_axis}) {
    const VoronoiReport report = voronoi_complex(mesh, {.part = part}).report;
    EXPECT_TRUE(report.traced) << report.trace_problem;
    EXPECT_TRUE(report.certified);
    EXPECT_FALSE(voronoi_complex(mesh, {.part = part, .tolerance = 1}).report.traced);
    EXPECT_FALSE(voronoi_complex(mesh, {.part = part, .method = VoronoiMethod::cubes}).report.traced);
  }
}

/// The rims of the medial axis are the convex edges of the solid. All edges of its triangles are short.
TEST(TracedDiagram, AxesEndAtAllConvexEdges) {
  const double height = 2;
  const TriangleMesh mesh = prism(ell, height);
  constexpr int resolution = 8;
  const double longest = 4.0 / resolution;  // the solid is 4 long
  const Complex axis = voronoi_complex(mesh, {.part = VoronoiPart::medial_axis, .resolution = resolution}).complex;
  const auto radius = axis.vertex_columns.get<double>("radius");
  std::map<std::array<std::uint32_t, 2>, int> count;
  for (const Triangle& t : axis.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++count[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  }
  double rims = 0;
  for (const auto& [ends, triangles] : count) {
    const double size = length(axis.positions[ends[1]] - axis.positions[ends[0]]);
    EXPECT_LE(size, 1.001 * longest);
    if (triangles > 1) continue;
    rims += size;
    for (const std::uint32_t v : ends) EXPECT_EQ(radius[v], 0);
  }
  const double outline = 4 + 1 + 3 + 2 + 1 + 3;
  EXPECT_NEAR(rims, 2 * outline + 5 * height, 1e-12) << "five of the six upright edges are convex";
}

/// Returns a torus whose vertices are moved at random, so that many faces are nearly parallel, and no symmetry is left.
TriangleMesh rough_torus(std::uint32_t seed) {
  TriangleMesh mesh = make_torus({.ring_radius = 1, .tube_radius = 0.4, .ring_segments = 20, .tube_segments = 10});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> amount(-1e-3, 1e-3);
  for (Vec3d& p : mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += amount(random);
  }
  return mesh;
}

/// Separate places of a solid in general position have a structure. At events of faces at small angles, rounding of
/// distances moves the place by more than the tolerance. Some seams bend within small steps.
TEST(TracedDiagram, SeparatesPlacesOfRoughSolids) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    const TriangleMesh mesh = rough_torus(seed);
    const SiteTable table(mesh);
    const auto sites = TracedSites::of(mesh, table, polyhedron_sites(mesh, table), 0, TracedPlaces::separate);
    ASSERT_TRUE(sites);
    const TracedResult traced = traced_structure(*sites, TraceEffort::usual, usual_work(*sites), {});
    EXPECT_TRUE(traced.structure) << traced.problem << ", seed " << seed;
  }
}

/// Checks the way to the contact of a site with many points of the line.
void expect_first_contact(const TracedSites& sites, const SeamLine& line, TracedSites::Index other, double most) {
  const double way = way_to_contact(sites, line, other, most);
  ASSERT_GE(way, 0);
  const auto point = [&](double s) { return line.start + line.along * s; };
  const auto is_as_close = [&](double s, double slack) {
    const Vec3d x = point(s);
    const double d = sites.distance(other, x);
    return d >= -slack && d <= sites.distance(line.own, x) + slack && sites.outside(other, x) <= slack;
  };
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) EXPECT_FALSE(is_as_close(std::min(way, most) * k / count, 0)) << way;
  if (way < most && (sites[other].kind != SiteKind::face || sites[other].is_convex)) {
    EXPECT_TRUE(is_as_close(way, 8 * sites.tolerance()) || sites.distance(other, point(way)) < 0) << way;
  }
}

TEST(WayToContact, IsThatOfManyPointsOfALine) {
  const TracedSites sites = sites_of(make_bracket());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] {
    const double x = number(random);
    const double y = number(random);
    const double z = number(random);
    return Vec3d{x, y, z};
  };
  std::size_t contacts = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3d x = vector() * 1.4;
    const TracedSites::Closest closest = sites.closest(x, sites.tolerance());
    if (closest.sites.size() != 1) continue;  // outside of the solid, or not general
    const SeamLine line{closest.sites[0], x, unit(vector())};
    for (TracedSites::Index i = 0; i < sites.size(); ++i) {
      if (i == line.own) continue;
      expect_first_contact(sites, line, i, closest.radius);
      if (way_to_contact(sites, line, i, closest.radius) < closest.radius) ++contacts;
    }
  }
  EXPECT_GT(contacts, 100U);
}

/// The largest faces of a plate have 32 sides around each hole. Their sides are in an index.
TEST(TracedSites, FindSidesOfLargeFacesLikeASearchOfAllSides) {
  const TracedSites sites = sites_of(make_plate());
  TracedSites::Index face = 0;
  while (!sites[face].index) ++face;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1.6, 1.6);
  std::size_t inside = 0, outside = 0;
  for (int k = 0; k < 2000; ++k) {
    const double a = number(random);
    const double b = number(random);
    const Vec3d x{a, b, 0};
    const Vec3d q = sites.foot(face, x);
    double least = sites.extent();
    double turns = 0;
    for (const DomainSide& side : sites[face].sides) {
      const Vec3d way = side.ends[1] - side.ends[0];
      const double t = std::clamp(dot(q - side.ends[0], way) / squared_length(way), 0.0, 1.0);
      least = std::min(least, length(side.ends[0] + way * t - q));
      const Vec3d from = side.ends[0] - q, to = side.ends[1] - q;
      turns += std::atan2(dot(sites[face].direction, cross(from, to)), dot(from, to));
    }
    const bool is_inside = std::abs(turns) > 3;
    EXPECT_NEAR(sites.outside(face, x), is_inside ? 0 : least, 1e-12);
    if (!is_inside && least > 0.05) {
      EXPECT_GT(sites.outside(face, x, 0.05), 0.05);
    }
    EXPECT_EQ(sites.sides_at(face, x, 0.1).empty(), least > 0.1);
    ++(is_inside ? inside : outside);
  }
  EXPECT_GT(inside, 500U);
  EXPECT_GT(outside, 100U);
}

TEST(TracedSites, FindTheNearestVertexLikeASearchOfAll) {
  const TracedSites sites = sites_of(make_bracket());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  std::size_t found = 0;
  for (int k = 0; k < 300; ++k) {
    const double a = number(random);
    const double b = number(random);
    const double c = number(random);
    const Vec3d x{a, b, c};
    double least = sites.extent();
    for (const Vec3d& p : sites.vertices()) least = std::min(least, length(p - x));
    constexpr double within = 0.3;
    const auto v = sites.vertex_near(x, within);
    EXPECT_EQ(v.has_value(), least <= within);
    if (!v) continue;
    EXPECT_EQ(length(sites.vertices()[*v] - x), least);
    ++found;
  }
  EXPECT_GT(found, 10U);
  EXPECT_LT(found, 250U);
}

/// Around the middle line of a square bar, four regions meet along one seam.
TEST(LocalStar, FindsASeamOfFourRegions) {
  const TracedSites sites = sites_of(prism({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 10));
  const Vec3d middle{};
  const TracedSites::Closest closest = sites.closest(middle, sites.tolerance());
  ASSERT_EQ(closest.sites.size(), 4U);
  const std::vector<SeamRay> rays = LocalStar(sites, middle, closest.sites).rays();
  ASSERT_EQ(rays.size(), 2U);
  for (const SeamRay& ray : rays) {
    EXPECT_EQ(ray.ring.germs.size(), 4U);
    EXPECT_NEAR(std::abs(ray.direction.z), 1, 1e-12);
  }
}

TEST(WallMap, ReturnsThePointsOfCurvedWalls) {
  const TriangleMesh mesh = prism(ell, 20);
  const TracedSites sites = sites_of(mesh);
  TracedSites::Index edge = 0;
  while (sites[edge].kind != SiteKind::edge) ++edge;
  std::size_t count = 0;
  for (TracedSites::Index face = 0; face < edge; ++face) {
    if (sites.side_between(face, edge) != nullptr) continue;
    const Vec3d& n = sites[face].direction;
    const Vec3d foot = sites.foot(face, sites[edge].point + sites[edge].direction * 9.0);
    const Vec3d at = foot + n * touching_radius(sites[edge], foot, n);
    if (!(length(at) < 100)) continue;
    const WallMap map(sites, face, edge, {}, std::array{at});
    const Vec3d back = map.from_plane(map.to_plane(at));
    EXPECT_NEAR(length(back - at), 0, 1e-12);
    EXPECT_NEAR(sites.distance(face, at), sites.distance(edge, at), 1e-12);
    ++count;
  }
  EXPECT_GT(count, 2U);
}

}  // namespace
}  // namespace blum::voronoi
