// Proves that linking numbers equal Gauss's integral, and ranks equal plain elimination. An axis with the right Betti
// numbers is rejected if its loops or surfaces enclose other tunnels or voids, or none.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "certificate/homology/closed_surfaces.hpp"
#include "certificate/homology/complement.hpp"
#include "certificate/homology/edge_labels.hpp"
#include "certificate/homology/elimination.hpp"
#include "certificate/homology/generating_cycles.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using verifier::Apex;
using verifier::Complement;
using verifier::Curtains;
using verifier::Elimination;
using verifier::Label;
using verifier::SparseRow;

constexpr double pi = std::numbers::pi;

using Loop = std::vector<Vec3d>;

/// The signed solid angle between the pairs of points of two segments (Klenin, Langowski 2000).
double gauss(const Vec3d& p1, const Vec3d& p2, const Vec3d& p3, const Vec3d& p4) {
  const auto unit = [](const Vec3d& v) { return length(v) > 0 ? v / length(v) : v; };
  const std::array<Vec3d, 4> n{unit(cross(p3 - p1, p4 - p1)), unit(cross(p4 - p1, p4 - p2)),
                               unit(cross(p4 - p2, p3 - p2)), unit(cross(p3 - p2, p3 - p1))};
  double area = 0;
  for (std::size_t k = 0; k < 4; ++k) area += std::asin(std::clamp(dot(n[k], n[(k + 1) % 4]), -1.0, 1.0));
  return dot(cross(p4 - p3, p2 - p1), p3 - p1) > 0 ? area : -area;
}

int gauss_linking(const Loop& a, const Loop& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      sum += gauss(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()]);
    }
  }
  return static_cast<int>(std::lround(sum / (4 * pi)));
}

int curtain_linking(const Loop& a, const Loop& b, std::uint32_t attempt) {
  std::vector<Complement::Step> steps;
  for (std::uint32_t k = 0; k < a.size(); ++k) {
    steps.push_back({{k, (k + 1) % static_cast<std::uint32_t>(a.size())}, 0, 1});
  }
  const Complement around(a, steps, {0}, {});
  Box3 box;
  for (const Vec3d& p : a) box.extend(p);
  for (const Vec3d& p : b) box.extend(p);
  const Apex apex(box, attempt);
  const Curtains curtains(around, apex, {});
  Loop closed = b;
  closed.push_back(b.front());
  std::vector<Label> labels;
  EXPECT_TRUE(curtains.add(closed, 0, labels));
  int sum = 0;
  for (const Label& label : labels) sum += label.times * around.paths_along(label.segment)[0].times;
  return sum;
}

Loop ring(std::size_t parts, const Vec3d& centre, double radius, const Vec3d& u, const Vec3d& v, int turns = 1,
          double wobble = 0) {
  Loop loop;
  for (std::size_t k = 0; k < parts; ++k) {
    const double angle = 2 * pi * turns * static_cast<double>(k) / static_cast<double>(parts);
    const double own = radius + wobble * std::cos(angle / turns);
    loop.push_back(centre + u * (own * std::cos(angle)) + v * (own * std::sin(angle)));
  }
  return loop;
}

TEST(Linking, AgreesWithGauss) {
  const Vec3d x{1, 0, 0};
  const Vec3d y{0, 1, 0};
  const Vec3d z{0, 0, 1};
  const Loop first = ring(17, {}, 1, x, y);
  EXPECT_EQ(std::abs(curtain_linking(first, ring(13, {1, 0, 0}, 0.5, x, z), 0)), 1);
  EXPECT_EQ(curtain_linking(first, ring(13, {1, 0, 0}, 0.5, y, z), 0), 0) << "crosses neither disc twice one way";
  EXPECT_EQ(curtain_linking(first, ring(13, {3, 0, 0}, 0.5, x, z), 0), 0);
  EXPECT_EQ(std::abs(curtain_linking(first, ring(41, {1, 0, 0}, 0.5, x, z, 3, 0.1), 0)), 3);
  Random random(7);
  std::set<int> seen;
  for (int k = 0; k < 300; ++k) {
    const auto random_loop = [&] {
      Loop loop(5 + random.below(20));
      for (Vec3d& p : loop) p = random.in_ball();
      return loop;
    };
    const Loop a = random_loop();
    const Loop b = random_loop();
    const int exact = curtain_linking(a, b, 0);
    EXPECT_EQ(curtain_linking(a, b, 1), exact);
    EXPECT_EQ(curtain_linking(b, a, 2), exact);
    seen.insert(exact);
    EXPECT_EQ(exact, gauss_linking(a, b));
  }
  EXPECT_GT(seen.size(), 4U);
}

TEST(Linking, TouchingIsUndecided) {
  const Loop square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<Complement::Step> steps;
  for (std::uint32_t k = 0; k < 4; ++k) steps.push_back({{k, (k + 1) % 4}, 0, 1});
  const Complement around(square, steps, {0}, {});
  const Apex apex({{-1, -1, -1}, {2, 2, 2}}, 0);
  const Curtains curtains(around, apex, {});
  std::vector<Label> labels;
  EXPECT_FALSE(curtains.add(Loop{{0.5, -1, 0}, {0.5, 0.5, 0}}, 0, labels)) << "through a side";
  EXPECT_FALSE(curtains.add(Loop{{0.5, 0, 0}, {0.5, 0.5, 0.5}}, 0, labels)) << "from a side";
  EXPECT_TRUE(curtains.add(Loop{{0.5, 0.25, 0}, {0.5, 0.5, 0}}, 0, labels));
  EXPECT_TRUE(curtains.add(Loop{{0.5, 0, 0}, {0.5, 0.5, 0.5}}, 1, labels)) << "of another body";
}

TEST(Complement, RunsAlongEachSegmentOnce) {
  const Complement twice({{}, {1, 0, 0}, {0, 1, 0}},
                         {{{0, 1}, 0, 1}, {{1, 0}, 1, 1}, {{1, 2}, 0, 1}, {{2, 1}, 0, 1}, {{0, 1}, 1, 2}}, {0, 0}, {});
  ASSERT_EQ(twice.segments().size(), 1U);
  ASSERT_EQ(twice.paths_along(0).size(), 2U);
  EXPECT_EQ(twice.paths_along(0)[0].times, 1);
  EXPECT_EQ(twice.paths_along(0)[1].times, 1) << "once back and twice forth";
}

std::size_t plain_rank_modulo_2(std::vector<SparseRow> rows, std::uint32_t columns) {
  std::size_t rank = 0;
  std::vector<std::vector<int>> all;
  for (const SparseRow& row : rows) {
    all.emplace_back(columns, 0);
    for (const auto& [column, entry] : row) all.back()[column] = static_cast<int>(entry & 1);
  }
  for (std::uint32_t c = 0; c < columns; ++c) {
    std::size_t p = rank;
    while (p < all.size() && all[p][c] == 0) ++p;
    if (p == all.size()) continue;
    std::swap(all[p], all[rank]);
    for (std::size_t r = 0; r < all.size(); ++r) {
      if (r == rank || all[r][c] == 0) continue;
      for (std::uint32_t k = 0; k < columns; ++k) all[r][k] ^= all[rank][k];
    }
    ++rank;
  }
  return rank;
}

TEST(Elimination, RanksEqualThoseOfPlainElimination) {
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    const auto columns = static_cast<std::uint32_t>(1 + random.below(90));
    std::vector<SparseRow> rows(random.below(40));
    for (SparseRow& row : rows) {
      for (std::size_t n = random.below(6); n > 0; --n) {
        row.emplace_back(static_cast<std::uint32_t>(random.below(columns)), random.below(2) == 0 ? 1 : -1);
      }
      verifier::tidy(row);
    }
    const std::size_t rank = plain_rank_modulo_2(rows, columns);
    EXPECT_EQ(verifier::rank_modulo_2(rows, columns), rank);
    Elimination two(Elimination::Over::two, columns, 1'000'000);
    Elimination exact(Elimination::Over::integers, columns, 1'000'000);
    for (const SparseRow& row : rows) {
      two.add(row);
      exact.add(row);
    }
    EXPECT_TRUE(two.is_complete());
    EXPECT_EQ(two.rank(), rank);
    if (exact.is_complete()) {
      EXPECT_EQ(exact.rank(), rank) << "where all pivots are 1 or -1";
    }
  }
}

TEST(Elimination, ThriceIsNotOnceOverTheIntegers) {
  Elimination exact(Elimination::Over::integers, 2, 1000);
  exact.add({{0, 3}});
  EXPECT_FALSE(exact.is_complete());
  exact.add({{0, 1}, {1, 1}, {3, 5}});
  EXPECT_FALSE(exact.is_complete());
  exact.add({{1, 1}});
  EXPECT_TRUE(exact.is_complete());
  EXPECT_EQ(exact.rank(), 2U);
  ASSERT_EQ(exact.left().size(), 1U);
  EXPECT_EQ(exact.left()[0], (SparseRow{{3, -15}}));
  EXPECT_EQ(verifier::rank_modulo_2({{{0, 2}}, {{0, 3}, {1, 4}}}, 2), 1U);
}

TEST(GeneratingCycles, CoverAllHandlesAndClose) {
  for (const auto& [mesh, count] : {std::pair{make_torus(), 2U}, {make_sphere({}), 0U}, {make_plate(), 12U}}) {
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({t[0], t[1], t[2]});
    const Incidence incidence({mesh.vertices.size(), {}, faces});
    const verifier::GeneratingCycles cycles(
        {mesh.vertices.size(), incidence.edges(), {incidence.sides().front().data(), 3 * faces.size()}, 3}, {});
    EXPECT_GE(cycles.closing().size(), count);
    EXPECT_LE(cycles.closing().size(), 2 * count);
    for (const std::uint32_t closing : cycles.closing()) {
      std::vector<int> at(mesh.vertices.size(), 0);
      cycles.walk(closing, [&](std::uint32_t e, int sign) {
        at[incidence.edges()[e][0]] -= sign;
        at[incidence.edges()[e][1]] += sign;
      });
      EXPECT_EQ(std::count(at.begin(), at.end(), 0), static_cast<std::ptrdiff_t>(at.size())) << "it closes";
    }
  }
}

/// Adds a closed polygon. Unless it is the first one, an edge joins it to vertex `from`.
void add_loop(Complex& complex, const Loop& loop, std::uint32_t from = 0) {
  const auto first = static_cast<std::uint32_t>(complex.positions.size());
  const auto count = static_cast<std::uint32_t>(loop.size());
  complex.positions.insert(complex.positions.end(), loop.begin(), loop.end());
  for (std::uint32_t k = 0; k < count; ++k) complex.edges.push_back({first + k, first + (k + 1) % count});
  if (first > 0) complex.edges.push_back({from, first});
}

bool mentions(const Certificate& certificate, const std::string& text) {
  return std::any_of(certificate.mismatches.begin(), certificate.mismatches.end(),
                     [&](const std::string& one) { return one.find(text) != std::string::npos; });
}

constexpr Vec3d along_x{1, 0, 0};
constexpr Vec3d along_y{0, 1, 0};
constexpr Vec3d along_z{0, 0, 1};

TEST(HomologyCheck, LoopsOfATorus) {
  const TriangleMesh torus = make_torus();
  const auto certificate_of = [&](const Loop& loop) {
    Complex complex;
    add_loop(complex, loop);
    return certify_topology(complex, torus);
  };
  const Certificate once = certificate_of(ring(96, {}, 1, along_x, along_y));
  EXPECT_TRUE(once.holds());
  EXPECT_EQ(once.homology.proven, Proven::homology);
  EXPECT_EQ(once.bodies[0].tunnels_met, 1);
  EXPECT_EQ(once.homology.paths, 2U);

  const Certificate none = certificate_of(ring(16, {1, 0, 0}, 0.1, along_x, along_z));
  EXPECT_TRUE(none.topology_holds) << "the numbers are right";
  EXPECT_TRUE(none.edges.holds);
  EXPECT_FALSE(none.homology.holds);
  EXPECT_EQ(none.homology.proven, Proven::betti_numbers);
  EXPECT_TRUE(mentions(none, "loops of the axis run around 0 of the 1 tunnel of the solid"));

  const Certificate twice = certificate_of(ring(192, {}, 1, along_x, along_y, 2, 0.05));
  EXPECT_TRUE(twice.edges.holds);
  EXPECT_TRUE(mentions(twice, "around 0 of the 1 tunnel"));

  const Certificate thrice = certificate_of(ring(289, {}, 1, along_x, along_y, 3, 0.05));
  EXPECT_EQ(thrice.homology.proven, Proven::homology_modulo_2) << "not over the integers";
}

TEST(HomologyCheck, LoopsOfAPlate) {
  const TriangleMesh plate = make_plate({.holes_x = 2, .holes_y = 1});
  const Vec3d middle = bounds(plate).center();
  const Vec3d left = middle - Vec3d{0.5, 0, 0};
  const Vec3d right = middle + Vec3d{0.5, 0, 0};
  Complex good;
  add_loop(good, ring(64, left, 0.4, along_x, along_y));
  add_loop(good, ring(64, right, 0.4, -along_x, along_y));
  const Certificate both = certify_topology(good, plate);
  EXPECT_TRUE(both.holds());
  EXPECT_EQ(both.homology.proven, Proven::homology);

  Complex wrong;  // both loops run around the same hole
  add_loop(wrong, ring(64, left, 0.4, along_x, along_y));
  add_loop(wrong, ring(64, left, 0.35, along_x, along_y));
  const Certificate one = certify_topology(wrong, plate);
  EXPECT_TRUE(one.topology_holds && one.edges.holds);
  EXPECT_TRUE(mentions(one, "loops of the axis run around 1 of the 2 tunnels"));

  Complex across;  // one hole is filled, and a loop beside it compensates for it
  add_loop(across, ring(64, left, 0.4, along_x, along_y));
  add_loop(across, ring(64, right, 0.4, -along_x, along_y));
  add_loop(across, ring(8, right + Vec3d{0.42, 0, 0.05}, 0.02, along_x, along_z), 64);
  across.edges.pop_back();
  across.edges.push_back({64 + 32, 128});
  for (std::uint32_t k = 1; k + 1 < 64; ++k) across.triangles.push_back({64, 64 + k, 64 + k + 1});
  const Certificate filled = certify_topology(across, plate);
  EXPECT_TRUE(filled.topology_holds);
  EXPECT_FALSE(filled.edges.holds) << "the edges of the fan cross the hole";
}

/// The sides of a triangle pass a narrow hole, which it fills. A small loop compensates for the hole.
TEST(HomologyCheck, TrianglesAcrossAHole) {
  const TriangleMesh plate = make_plate({.holes_x = 1, .holes_y = 1, .hole_radius = 0.1});
  const Vec3d middle = bounds(plate).center();
  Complex complex;
  add_loop(complex, ring(3, middle, 0.4, along_x, along_y));
  EXPECT_EQ(certify_topology(complex, plate).homology.proven, Proven::homology);
  complex.triangles.push_back({0, 1, 2});
  add_loop(complex, ring(8, middle + Vec3d{0.42, 0, 0}, 0.02, along_x, along_z));
  const Certificate found = certify_topology(complex, plate);
  EXPECT_TRUE(found.topology_holds && found.edges.holds);
  EXPECT_EQ(found.homology.across, 1U);
  EXPECT_NEAR(length(found.homology.where - middle), 0, 1e-12);
  EXPECT_TRUE(mentions(found, "1 triangle of the axis spans a tunnel of the solid"));
  EXPECT_TRUE(mentions(found, "around 0 of the 1 tunnel"));
}

TEST(HomologyCheck, AFlapAcrossAHoleIsRejected) {
  const TriangleMesh plate = make_plate({.holes_x = 1, .holes_y = 1, .hole_radius = 0.1});
  const Vec3d middle = bounds(plate).center();
  Complex complex;
  add_loop(complex, ring(4, middle, 0.4, along_x, along_y));
  complex.positions.push_back(middle + Vec3d{-0.3, -0.3, 0});
  complex.triangles.push_back({0, 1, 4});  // its free edges pass the hole on the other side
  const Certificate found = certify_topology(complex, plate);
  EXPECT_TRUE(found.topology_holds && found.edges.holds);
  EXPECT_EQ(found.homology.across, 1U);
  EXPECT_TRUE(mentions(found, "1 triangle of the axis spans a tunnel of the solid"));
  EXPECT_EQ(found.homology.proven, Proven::betti_numbers) << "which way round the loop runs is not told";
}

/// An edge that touches a path exactly does not decide its linking by itself. Moved past the path on the inside, it is
/// linked with nothing.
TEST(HomologyCheck, AnEdgeThatTouchesAPathHidesNothing) {
  const TriangleMesh plate = make_plate({.holes_x = 1, .holes_y = 1, .hole_radius = 0.25, .hole_segments = 4});
  const Vec3d middle = bounds(plate).center();
  const auto add_touching = [&](Complex& complex) {  // edges that touch all four upright edges of the hole
    for (const Vec3d& out : {along_x, along_y, -along_x, -along_y}) {
      const Vec3d aside = 0.125 * cross(out, along_z);
      const auto first = static_cast<std::uint32_t>(complex.positions.size());
      complex.positions.insert(complex.positions.end(), {middle + 0.25 * out - aside, middle + 0.25 * out + aside});
      complex.edges.push_back({first, first + 1});
      complex.edges.push_back({first + 1, first > 16 ? first - 2 : 0});
    }
  };
  Complex good;
  add_loop(good, ring(16, middle, 0.375, along_x, along_y));
  add_touching(good);
  const Certificate around = certify_topology(good, plate);
  EXPECT_TRUE(around.holds()) << (around.mismatches.empty() ? "" : around.mismatches.front());
  EXPECT_EQ(around.homology.proven, Proven::homology);
  EXPECT_EQ(around.homology.doubtful, 0U);

  Complex small;  // loops around nothing
  add_loop(small, ring(16, middle + Vec3d{0.375, 0, 0}, 0.05, along_x, along_z));
  add_touching(small);
  const Certificate nothing = certify_topology(small, plate);
  EXPECT_TRUE(nothing.topology_holds);
  EXPECT_FALSE(nothing.homology.holds);
  EXPECT_LE(nothing.homology.proven, Proven::betti_numbers);
}

/// The surface of a mesh as an axis.
Complex surface_of(const TriangleMesh& mesh) {
  Complex complex;
  complex.positions = mesh.vertices;
  for (const Triangle& t : mesh.triangles) complex.triangles.push_back({t[0], t[1], t[2]});
  return complex;
}

TEST(HomologyCheck, SurfacesAroundAVoid) {
  const TriangleMesh cube = make_void_cube({.size = 2, .void_radius = 0.3});
  const Vec3d middle = bounds(cube).center();
  const TriangleMesh sphere = make_sphere({.radius = 1});
  Complex around = surface_of(test::moved(sphere, 0.6, middle));
  const Certificate good = certify_topology(around, cube);
  EXPECT_TRUE(good.holds());
  EXPECT_EQ(good.homology.proven, Proven::homotopy_type);
  EXPECT_EQ(good.bodies[0].voids_met, 1);

  const Certificate bubble = certify_topology(surface_of(test::moved(sphere, 0.1, middle + Vec3d{0.7, 0.7, 0})), cube);
  EXPECT_TRUE(bubble.topology_holds && bubble.edges.holds);
  EXPECT_TRUE(mentions(bubble, "closed surfaces of the axis enclose 0 of the 1 void"));

  // A punctured surface around the void, and a bubble attached to it.
  const Complex small = surface_of(test::moved(sphere, 0.1, middle + Vec3d{0.7, 0.7, 0}));
  const auto first = static_cast<std::uint32_t>(around.positions.size());
  around.triangles.pop_back();
  around.positions.insert(around.positions.end(), small.positions.begin(), small.positions.end());
  for (const auto& [a, b, c] : small.triangles) around.triangles.push_back({first + a, first + b, first + c});
  const auto near =
      std::min_element(around.positions.begin(), around.positions.begin() + first, [&](const Vec3d& p, const Vec3d& q) {
        return squared_length(p - small.positions[0]) < squared_length(q - small.positions[0]);
      });
  around.edges.push_back({static_cast<std::uint32_t>(near - around.positions.begin()), first});
  const Certificate punctured = certify_topology(around, cube);
  EXPECT_TRUE(punctured.topology_holds && punctured.edges.holds);
  EXPECT_TRUE(mentions(punctured, "closed surfaces of the axis enclose 0 of the 1 void"));
}

/// A tetrahedron with a face through the middle of a void encloses half of it.
TEST(HomologyCheck, ASurfaceThroughAVoidIsNotAroundIt) {
  TriangleMesh mesh = make_box();
  const Vec3d middle = bounds(mesh).center();
  TriangleMesh hole = make_box();
  for (Vec3d& p : hole.vertices) p = (p - middle) / 64.0 + middle;
  append(mesh, hole);
  Complex complex;
  complex.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  for (const double z : {0.0, 0.05, -0.05}) {
    complex.positions.clear();
    for (const Vec3d& p : {Vec3d{0.4, 0.3, z}, Vec3d{-0.4, 0.3, z}, Vec3d{0, -0.4, z}, Vec3d{0, 0, z + 0.3}}) {
      complex.positions.push_back(p + middle);
    }
    const Certificate found = certify_topology(complex, mesh);
    EXPECT_TRUE(found.topology_holds && found.edges.holds) << z;
    EXPECT_EQ(found.homology.holds, z < 0) << z;
    EXPECT_EQ(mentions(found, "closed surfaces of the axis enclose 0 of the 1 void"), z >= 0) << z;
  }
}

/// A flat void is nearly as wide as the solid. A surface cuts it in two, away from its middle.
TEST(HomologyCheck, ASurfaceAroundAPartOfAVoidIsNotAroundIt) {
  TriangleMesh mesh = make_box();
  const Vec3d middle = bounds(mesh).center();
  TriangleMesh hole = make_box({.segments = {8, 8, 1}});
  for (Vec3d& p : hole.vertices) {
    const Vec3d from = p - middle;
    p = middle + Vec3d{0.8 * from.x, 0.25 + 0.3 * from.y, 0.01 * from.z};  // off the diagonals of the surface
  }
  append(mesh, hole);
  for (const double cut : {-0.45, 0.25}) {  // beside the void, and through it
    TriangleMesh around = make_box();
    for (Vec3d& p : around.vertices) {
      p = middle + 0.9 * (p - middle);
      if (p.x < middle.x) p.x = middle.x + cut;
    }
    const Certificate found = certify_topology(surface_of(around), mesh);
    EXPECT_TRUE(found.topology_holds && found.edges.holds) << cut;
    EXPECT_EQ(found.homology.holds, cut < 0) << cut;
  }
}

TEST(Windings, ReportsUndecidedIfAllPointsLieOnTheSurface) {
  const Complex complex = surface_of(make_box());
  const ComplexView view = complex.view();
  const Incidence incidence(view);
  const Box3 box = bounds(make_box());
  const std::vector<std::uint32_t> body_of(complex.positions.size(), 0);
  const Vec3d on_face{box.center().x, box.center().y, box.lower.z};
  for (const bool has_other : {false, true}) {
    std::vector<Vec3d> points{on_face};
    if (has_other) points.push_back(box.center());
    const Complement complement({}, {}, {}, {{points, 0}});
    const verifier::Windings found =
        verifier::windings(view, incidence, complex.positions, body_of, complement, 1, box, {});
    EXPECT_EQ(found.undecided[0].has_value(), !has_other);
    EXPECT_EQ(found.rank[0], has_other ? 1U : 0U);
  }
}

TEST(HomologyCheck, SheetsAcrossAClosedSurface) {
  // A shell with two voids. Its axis is a sphere around both and a wall between them: three sheets, two cycles.
  TriangleMesh mesh = make_sphere({.radius = 1});
  TriangleMesh left = test::moved(make_sphere({.frequency = 4}), 0.2, {-0.45, 0, 0});
  TriangleMesh right = test::moved(make_sphere({.frequency = 4}), 0.2, {0.45, 0, 0});
  append(mesh, left);
  append(mesh, right);
  const std::uint32_t parts = 24;
  const auto build = [&](double wall) {  // poles at -x and x, a ring at x = wall, and the centre of the ring
    Complex complex;
    complex.positions = {{-0.85, 0, 0}, {0.85, 0, 0}, {wall, 0, 0}};
    const std::array<double, 5> at{-0.75, -0.4, wall, 0.4, 0.75};
    for (const double x : at) {
      for (const Vec3d& p : ring(parts, {x, 0, 0}, std::sqrt(0.85 * 0.85 - x * x), along_y, along_z)) {
        complex.positions.push_back(p);
      }
    }
    const auto corner = [&](std::uint32_t row, std::uint32_t k) { return 3 + row * parts + k % parts; };
    for (std::uint32_t k = 0; k < parts; ++k) {
      complex.triangles.push_back({0, corner(0, k), corner(0, k + 1)});
      complex.triangles.push_back({corner(4, k + 1), 1, corner(4, k)});
      complex.triangles.push_back({2, corner(2, k + 1), corner(2, k)});
      for (std::uint32_t row = 0; row < 4; ++row) {
        complex.triangles.push_back({corner(row, k), corner(row + 1, k), corner(row + 1, k + 1)});
        complex.triangles.push_back({corner(row, k), corner(row + 1, k + 1), corner(row, k + 1)});
      }
    }
    return complex;
  };
  const Certificate good = certify_topology(build(0), mesh);
  EXPECT_TRUE(good.holds()) << (good.mismatches.empty() ? "" : good.mismatches.front());
  EXPECT_EQ(good.solid, (BettiNumbers{1, 0, 2}));
  EXPECT_EQ(good.homology.proven, Proven::homotopy_type);
  Complex complex = build(0);
  complex.triangles.push_back(complex.triangles.front());  // a duplicate counts once
  EXPECT_EQ(certify_topology(complex, mesh).homology.proven, Proven::homotopy_type);
}

TEST(HomologyCheck, HollowTorusAndChains) {
  TriangleMesh hollow = make_torus({.tube_radius = 0.3});
  append(hollow, make_torus({.tube_radius = 0.1}));
  const Certificate certificate = certify_topology(surface_of(make_torus({.tube_radius = 0.2})), hollow);
  EXPECT_TRUE(certificate.holds());
  EXPECT_EQ(certificate.solid, (BettiNumbers{1, 2, 1}));
  EXPECT_EQ(certificate.bodies[0].tunnels_met, 2);
  EXPECT_EQ(certificate.bodies[0].voids_met, 1);
  EXPECT_EQ(certificate.homology.proven, Proven::homology);

  const TriangleMesh chain = make_linked_tori({.count = 2});
  const Certificate linked = certify_topology(surface_of(test::moved(make_torus({.tube_radius = 0.1}), 1)), chain);
  EXPECT_FALSE(linked.topology_holds) << "one ring of two";
}

TEST(HomologyCheck, WithoutPositionsNothingIsProven) {
  Complex nothing;
  nothing.positions = {{0, 0, 0}};
  CertificateOptions options;
  options.positions = false;
  EXPECT_EQ(certify(nothing, make_sphere({}), options).homology.proven, Proven::nothing);
  EXPECT_EQ(certify_topology(nothing, make_sphere({})).homology.proven, Proven::homotopy_type);
}

}  // namespace
}  // namespace blum
