// Proofs of traced junctions and seams: true structures are proven, and changed ones are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "support/mesh_places.hpp"
#include "voronoi/planes/convex_faces.hpp"
#include "voronoi/traced/proof/site_bounds.hpp"
#include "voronoi/traced/proof/structure_proof.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"

namespace blum::voronoi {
namespace {

/// A solid with its traced structure.
struct TracedSolid {
  explicit TracedSolid(TriangleMesh made)
      : mesh(std::move(made)),
        table(mesh),
        sites(*TracedSites::of(mesh, table, polyhedron_sites(mesh, table), rounding_of_coordinates(mesh),
                               TracedPlaces::separate)) {
    TracedResult result = traced_structure(sites, TraceEffort::usual, usual_work(sites), {});
    EXPECT_TRUE(result.structure) << result.problem;
    structure = std::move(*result.structure);
  }
  [[nodiscard]] StructureProof proof() const { return prove_structure(sites, mesh, table, structure, {}); }

  TriangleMesh mesh;
  SiteTable table;
  TracedSites sites;
  TracedStructure structure;
};

/// Returns an L whose sides have irregular lengths and directions, with bases that are not parallel. No five of its
/// sites meet in a point.
TriangleMesh irregular_ell(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 0.2);
  std::vector<Point2> outline;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}) {
    const double dx = part(random);
    const double dy = part(random);
    outline.push_back({x + dx, y + dy});
  }
  TriangleMesh mesh = make_extrusion(outline, {}, {.thickness = 1.3});
  const double a = part(random);
  const double b = part(random);
  for (Vec3d& p : mesh.vertices) p.z += p.z > 0.5 ? a * p.x - b * p.y : 0;
  return mesh;
}

void expect_proven(const StructureProof& proof) {
  EXPECT_GT(proof.junctions, 0U);
  EXPECT_EQ(proof.proven_junctions, proof.junctions);
  EXPECT_EQ(proof.proven_seams, proof.seams);
  for (const OpenPlace& place : proof.open) {
    ADD_FAILURE() << "open at " << place.at.x << ", " << place.at.y << ", " << place.at.z << ", size " << place.size
                  << ", " << place.sites.size() << " sites, doubt " << static_cast<int>(place.doubt);
  }
}

TEST(StructureProof, OfSolidsInGeneralPositionIsComplete) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const TracedSolid solid(irregular_ell(seed));
    expect_proven(solid.proof());
  }
}

/// Points further away than the bound on the ball's centre are in no proven ball, so the count of junctions falls.
TEST(StructureProof, RefusesAMovedJunction) {
  TracedSolid solid(irregular_ell(3));
  const std::size_t all = solid.proof().proven_junctions;
  for (TracedStructure::Junction& junction : solid.structure.junctions) {
    if (junction.vertex != TracedStructure::none) continue;
    const Vec3d before = std::exchange(junction.at, junction.at + Vec3d{0.3, 0.2, 0.1});
    EXPECT_LT(solid.proof().proven_junctions, all);
    junction.at = before;
  }
}

TEST(StructureProof, RefusesAWrongSiteOfAJunction) {
  TracedSolid solid(irregular_ell(4));
  const std::size_t all = solid.proof().proven_junctions;
  for (TracedStructure::Junction& junction : solid.structure.junctions) {
    if (junction.vertex != TracedStructure::none) continue;
    const std::vector<TracedSites::Index> before = junction.sites;
    for (std::size_t k = 0; k < before.size(); ++k) {
      for (TracedSites::Index other = 0; other < solid.sites.size(); ++other) {
        if (std::find(before.begin(), before.end(), other) != before.end()) continue;
        junction.sites = before;
        junction.sites[k] = other;
        std::sort(junction.sites.begin(), junction.sites.end());
        EXPECT_LT(solid.proof().proven_junctions, all);
      }
    }
    junction.sites = before;
  }
}

TEST(StructureProof, RefusesAWrongSiteOfASeam) {
  TracedSolid solid(irregular_ell(5));
  const std::size_t all = solid.proof().proven_seams;
  for (TracedStructure::Curve& curve : solid.structure.curves) {
    if (curve.is_edge) continue;
    const std::vector<TracedSites::Index> before = curve.curve.sites;
    for (TracedSites::Index other = 0; other < solid.sites.size(); ++other) {
      if (std::find(before.begin(), before.end(), other) != before.end()) continue;
      curve.curve.sites = before;
      curve.curve.sites[0] = other;
      std::sort(curve.curve.sites.begin(), curve.curve.sites.end());
      EXPECT_LT(solid.proof().proven_seams, all);
    }
    curve.curve.sites = before;
  }
}

/// A junction without one of its seams has the wrong degree.
TEST(StructureProof, RefusesAMissingSeam) {
  TracedSolid solid(irregular_ell(6));
  const std::vector<TracedStructure::Curve> before = solid.structure.curves;
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (before[c].is_edge) continue;
    const bool is_inside = std::any_of(before[c].ends.begin(), before[c].ends.end(), [&](std::uint32_t end) {
      return solid.structure.junctions[end].vertex == TracedStructure::none;
    });
    if (!is_inside) continue;
    solid.structure.curves = before;
    solid.structure.curves.erase(solid.structure.curves.begin() + static_cast<std::ptrdiff_t>(c));
    const StructureProof proof = solid.proof();
    EXPECT_TRUE(std::any_of(proof.open.begin(), proof.open.end(),
                            [](const OpenPlace& place) { return place.doubt == VoronoiDoubt::seams; }));
  }
}

/// A seam that is continued straight across a junction leaves its sites.
TEST(StructureProof, RefusesASeamThatPassesAJunction) {
  TracedSolid solid(irregular_ell(7));
  const std::size_t all = solid.proof().proven_seams;
  std::size_t tried = 0;
  for (TracedStructure::Curve& curve : solid.structure.curves) {
    if (curve.is_edge || solid.structure.junctions[curve.ends[1]].vertex != TracedStructure::none) continue;
    // It ends at another junction with the same sites, as if the one between did not exist.
    for (std::uint32_t j = 0; j < solid.structure.junctions.size(); ++j) {
      const TracedStructure::Junction& other = solid.structure.junctions[j];
      if (j == curve.ends[0] || j == curve.ends[1] || other.vertex != TracedStructure::none) continue;
      const TracedStructure::Curve before = curve;
      curve.ends[1] = j;
      curve.points.push_back(other.at);
      EXPECT_LT(solid.proof().proven_seams, all);
      ++tried;
      curve = before;
    }
  }
  EXPECT_GT(tried, 10U);
}

/// Two seams between the same junctions, where one of them counts for a missing one, do not agree with the count.
TEST(StructureProof, RefusesARepeatedSeam) {
  TracedSolid solid(irregular_ell(6));
  const std::vector<TracedStructure::Curve> before = solid.structure.curves;
  const std::size_t all = solid.proof().proven_junctions;
  std::size_t tried = 0;
  for (std::size_t c = 0; c < before.size(); ++c) {
    for (std::size_t other = 0; other < before.size(); ++other) {
      if (c == other || before[c].is_edge || before[other].is_edge) continue;
      solid.structure.curves = before;
      // The copy ends where the other seam ended.
      for (const std::size_t k : {0U, 1U}) {
        const std::uint32_t end = before[other].ends[0];
        if (before[c].ends[k] != end || solid.structure.junctions[end].vertex != TracedStructure::none) continue;
        solid.structure.curves[other] = before[c];
        solid.structure.curves[other].ends = {end, before[other].ends[1]};
        EXPECT_LT(solid.proof().proven_junctions, all);
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 10U);
}

/// A second junction at the same place, with seams of its own, does not exist.
TEST(StructureProof, RefusesARepeatedDiagram) {
  TracedSolid solid(irregular_ell(6));
  const auto count = static_cast<std::uint32_t>(solid.structure.junctions.size());
  for (std::uint32_t k = 0; k < count; ++k) solid.structure.junctions.push_back(solid.structure.junctions[k]);
  const std::size_t curves = solid.structure.curves.size();
  for (std::size_t c = 0; c < curves; ++c) {
    TracedStructure::Curve copy = solid.structure.curves[c];
    for (std::uint32_t& end : copy.ends) end += count;
    solid.structure.curves.push_back(std::move(copy));
  }
  EXPECT_EQ(solid.proof().proven_junctions, 0U);
}

VoronoiReport report_of(const TriangleMesh& mesh) {
  VoronoiReport report = voronoi_complex(mesh, {.part = VoronoiPart::walls, .method = VoronoiMethod::traced}).report;
  EXPECT_TRUE(report.traced) << report.trace_problem;
  return report;
}

/// Returns a bar with an irregular notch. Its ends have sections of 1 and the given thickness.
TriangleMesh notched_bar(double thickness) {
  const std::vector<Point2> outline{{0, 0}, {6, 0}, {6, 1}, {3.7, 1}, {3.5, 0.77}, {2.9, 0.83}, {2.4, 1}, {0, 1}};
  return make_extrusion(outline, {}, {.thickness = thickness});
}

/// Near the ends, four faces meet in seams and five in junctions. The widths are the same, exactly.
TEST(StructureProof, OfSquareEndsIsComplete) {
  const VoronoiReport report = report_of(notched_bar(1));
  EXPECT_TRUE(report.proven);
  for (const OpenVoronoiPlace& place : report.open) {
    ADD_FAILURE() << "open at " << place.position.x << ", " << place.position.y << ", " << place.position.z << ", size "
                  << place.size << ", " << place.sites.size() << " sites, doubt " << static_cast<int>(place.doubt);
  }
}

/// Sections that are nearly square count as square within the tolerance of traces. This is not the exact structure, so
/// it is not proven, and the places are named.
TEST(StructureProof, NamesPlacesOfNearlySquareEnds) {
  const VoronoiReport report = report_of(notched_bar(std::nextafter(1, 2)));
  EXPECT_FALSE(report.proven);
  EXPECT_LT(report.proven_junctions, report.junctions);
  EXPECT_LT(report.proven_seams, report.seams);
  EXPECT_EQ(report.open.size(), report.junctions - report.proven_junctions + report.seams - report.proven_seams);
  const auto is_degenerate = [](const OpenVoronoiPlace& place) { return place.doubt == VoronoiDoubt::degenerate; };
  EXPECT_TRUE(std::any_of(report.open.begin(), report.open.end(), is_degenerate));
  for (const OpenVoronoiPlace& place : report.open) {
    EXPECT_GE(place.sites.size(), 3U);
    EXPECT_GT(place.size, 0);
  }
}

/// One face leans by so little that its direction is rounded to that of the axis, so widths of slabs differ.
TEST(StructureProof, LeavesLeaningSquareEndsOpen) {
  TriangleMesh mesh = notched_bar(1);
  const auto is_on_top = [](const Vec3d& p) { return p.z > 0; };
  const double first = std::find_if(mesh.vertices.begin(), mesh.vertices.end(), is_on_top)->y;
  for (Vec3d& p : mesh.vertices) p.z += is_on_top(p) ? 3e-11 * (p.y - first) : 0;
  const VoronoiReport report = report_of(mesh);
  EXPECT_FALSE(report.proven);
  EXPECT_LT(report.proven_seams, report.seams);
}

/// The sides of a prism with four vertical edges are flat, exactly. If one is bent within rounding, the proof is that
/// of a polyhedron with other corners.
TEST(StructureProof, ReportsCornersOfBentFacesAsMoved) {
  const std::vector<Point2> outline{{0, 0}, {4, 0}, {4.1, 1.3}, {2.1, 1.3}, {0.1, 1.3}};
  TriangleMesh mesh = make_extrusion(outline, {}, {.thickness = 2});
  for (const double bent : {0.0, 4e-15}) {
    for (Vec3d& p : mesh.vertices) p.y -= p.x == 2.1 ? bent : 0;
    const SiteTable table(mesh);
    const auto sites = TracedSites::of(mesh, table, polyhedron_sites(mesh, table), rounding_of_coordinates(mesh),
                                       TracedPlaces::merged);
    const TracedResult traced = traced_structure(*sites, TraceEffort::usual, usual_work(*sites), {});
    const double moved = prove_structure(*sites, mesh, table, *traced.structure, {}).moved;
    if (bent > 0) {
      EXPECT_GE(moved, bent / 2);
    } else {
      EXPECT_EQ(moved, 0);
    }
  }
}

/// Returns a T whose stem is moved sideways.
TriangleMesh tee(double moved) {
  const std::vector<Point2> outline{
      {-2, 0}, {2, 0}, {2, 1}, {0.3 + moved, 1}, {0.3 + moved, 3}, {-0.3 + moved, 3}, {-0.3 + moved, 1}, {-2, 1}};
  return make_extrusion(outline, {}, {.thickness = 1.7});
}

/// Both faces of the stem have a reflex edge at the same height, so the sides of four domains meet in a seam.
TEST(StructureProof, OfAMirroredStemIsComplete) {
  for (const double moved : {0.0, 0.5}) {
    const VoronoiReport report = report_of(tee(moved));
    EXPECT_EQ(report.proven_seams, report.seams);
    EXPECT_EQ(report.proven_junctions, report.junctions);
    for (const OpenVoronoiPlace& place : report.open) {
      ADD_FAILURE() << "open at " << place.position.x << ", " << place.position.y << ", " << place.position.z << ", "
                    << place.sites.size() << " sites, doubt " << static_cast<int>(place.doubt);
    }
  }
}

/// One corner of the stem is higher by one bit, so the stem has no mirror.
TEST(StructureProof, LeavesANearlyMirroredStemOpen) {
  TriangleMesh mesh = tee(0);
  for (Vec3d& p : mesh.vertices) {
    if (p.x == 0.3 && p.y == 1) p.y = std::nextafter(1, 2);
  }
  const VoronoiReport report = report_of(mesh);
  EXPECT_LT(report.proven_seams, report.seams);
}

/// Turned by an angle, the same bar has no exact widths.
TEST(StructureProof, LeavesTurnedSquareEndsOpen) {
  const VoronoiReport report = report_of(test::turned(notched_bar(1)));
  EXPECT_FALSE(report.proven);
  EXPECT_GT(report.proven_seams, 0U);
}

/// The linear functions approximate distances of points nearby as closely as they state.
TEST(SiteBounds, HoldNearAPoint) {
  const TriangleMesh mesh = irregular_ell(8);
  const TracedSolid solid(mesh);
  const SiteBounds bounds(solid.sites, mesh);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> part(-1, 1);
  const auto vector = [&] {
    const double x = part(random);
    const double y = part(random);
    const double z = part(random);
    return Vec3d{x, y, z};
  };
  for (TracedSites::Index i = 0; i < solid.sites.size(); ++i) {
    for (int k = 0; k < 200; ++k) {
      const Vec3d x = vector() * 2;
      const Vec3d way = vector() * 0.2;
      const LinearBound f = bounds.distance(i, x, length(way));
      if (!std::isfinite(f.bend)) continue;
      const double there = solid.sites.distance(i, x + way);
      EXPECT_LE(std::abs(there - f.value.value - dot(f.slope, way)), f.value.error + f.error_over(length(way)));
      EXPECT_LE(length(solid.sites.gradient(i, x + way) - f.slope), f.slope_error(length(way)));
    }
  }
}

}  // namespace
}  // namespace blum::voronoi
