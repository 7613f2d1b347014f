// Proves that the sites that an octree records along its edges equal those of exact comparisons of all labels. Squares
// and cubes derive their contents from their borders.
#include "voronoi/subdivision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "support/labelled_solid.hpp"
#include "support/mesh_places.hpp"
#include "voronoi/square_cells.hpp"

namespace blum {
namespace {

using test::LabelledSolid;
using voronoi::CellId;
using voronoi::GridEdge;
using voronoi::LabelIndex;
using voronoi::no_cell;
using voronoi::outside;

/// A solid with its octree.
struct Divided {
  explicit Divided(const TriangleMesh& given, int threads = 0)
      : mesh(given), table(mesh), solid(mesh, table, VoronoiPart::all) {
    Context context;
    context.threads = threads;
    cells = subdivide(solid, {}, context);
  }

  TriangleMesh mesh;
  SiteTable table;
  voronoi::VoronoiSolid solid;
  voronoi::Subdivision cells;
};

/// Returns the number of places along edges at which the recorded site is not the closest.
std::size_t wrong_places(const Divided& divided, std::size_t edges) {
  const voronoi::CellTree& tree = divided.cells.tree;
  std::size_t wrong = 0;
  const std::size_t step = std::max<std::size_t>(1, tree.edges.size() / edges);
  for (std::size_t e = 0; e < tree.edges.size(); e += step) {
    const GridEdge& edge = tree.edges[e];
    if (edge.children != no_cell) continue;
    double low = tree.lattice.at(edge.axis, edge.low[edge.axis]);
    double error = 0;
    LabelIndex label = edge.first;
    for (std::uint32_t k = edge.first_event; k <= edge.last_event; ++k) {
      const bool is_last = k == edge.last_event;
      const double high = is_last ? tree.lattice.at(edge.axis, edge.low[edge.axis] + edge.length) : tree.events[k].at;
      const double reach = error + (is_last ? 0 : tree.events[k].error);
      for (const double part : {0.01, 0.5, 0.99}) {
        Vec3d q = tree.lattice.at(edge.low);
        q[edge.axis] = low + (high - low) * part;
        if (label == outside || (high - low) * 0.01 <= 2 * reach) continue;
        const std::vector<voronoi::Label> closest = divided.solid.exact.closest_labels(q);
        const bool is_right = std::any_of(closest.begin(), closest.end(), [&](const voronoi::Label& other) {
          return divided.solid.exact.site_of(other) == divided.solid.labels[label].site;
        });
        if (!is_right) ++wrong;
      }
      if (is_last) break;
      low = high;
      error = tree.events[k].error;
      label = tree.events[k].after;
    }
  }
  return wrong;
}

void expect_right_edges(const TriangleMesh& mesh) {
  const Divided divided(mesh);
  EXPECT_EQ(divided.cells.failing.size(), 0U);
  EXPECT_EQ(divided.cells.contradictions, 0U);
  EXPECT_EQ(divided.cells.lines.undecided, 0U);
  EXPECT_EQ(wrong_places(divided, 1000), 0U);
}

TEST(Subdivision, FindsTheClosestSitesAlongEdges) {
  for (const TriangleMesh& mesh : {make_box(), test::box_with_void(), make_cylinder({.sides = 12}), make_star(),
                                   make_bracket(), make_torus({.ring_segments = 12, .tube_segments = 8})}) {
    expect_right_edges(mesh);
  }
}

/// Rounding has bent these faces by 1e-16. The structure of the mesh decides which site is closest next to their edges.
TEST(Subdivision, FindsTheClosestSitesOverBentFaces) {
  for (const TriangleMesh& mesh : {make_box(), test::box_with_void(), make_cylinder({.sides = 24}), make_star()}) {
    expect_right_edges(test::turned(mesh));
  }
}

/// Every event lies on the borders of two squares for each cube around its edge. Around a square, runs change only at
/// events. Each component joins events of at least two runs.
TEST(SquareCells, FollowFromTheBorder) {
  const Divided divided(make_bracket());
  const voronoi::CellTree& tree = divided.cells.tree;
  std::size_t with_walls = 0;
  for (const voronoi::GridSquare& square : tree.squares) {
    if (square.children != no_cell || square.state != voronoi::SquareState::resolved) continue;
    const voronoi::SquareCells cells = square_cells(tree, divided.solid.labels, square);
    ASSERT_EQ(cells.runs.size(), std::max<std::size_t>(1, cells.events.size()));
    for (std::size_t k = 0; k < cells.events.size(); ++k) {
      const auto& before = cells.runs[k];
      const auto& behind = cells.runs[(k + 1) % cells.runs.size()];
      EXPECT_NE(divided.solid.labels.site_of(before.label), divided.solid.labels.site_of(behind.label));
      EXPECT_LT(cells.component[k], cells.component_count);
    }
    // In a disc, components and regions together are one more than events, because each event cuts the border once.
    if (cells.events.empty()) continue;
    ++with_walls;
    EXPECT_EQ(cells.component_count + cells.pieces.size(), cells.events.size() + 1);
  }
  EXPECT_GT(with_walls, 1000U);
}

/// Returns a room over a floor, divided above the floor by a thin plate. Two small boxes place the grid so that one of
/// its squares crosses the part behind the plate. In the middle of that square the floor is closest, but the floor's
/// region does not reach its border. Planes seen from behind, like that of the plate, must not exclude the floor.
TriangleMesh room_with_a_plate() {
  constexpr double depth = 2.25;
  constexpr double plate = 0.05;
  constexpr double height = 6.5;
  TriangleMesh mesh;
  mesh.vertices = {{-3, depth, 0},      {3, depth, 0},  {3, -plate, 0},  {0, -4 - plate, 0},  {-3, -plate, 0},
                   {-3, 0, 1},          {3, 0, 1},      {3, -plate, 1},  {-3, -plate, 1},     {-3, depth, height},
                   {3, depth, height},  {3, 0, height}, {-3, 0, height}, {3, -plate, height}, {0, -4 - plate, height},
                   {-3, -plate, height}};
  mesh.triangles = {{0, 1, 3},   {1, 2, 3},   {0, 3, 4},   {0, 9, 1},   {9, 10, 1},  {2, 1, 6},   {2, 6, 7},
                    {1, 10, 6},  {10, 11, 6}, {4, 5, 0},   {4, 8, 5},   {0, 5, 9},   {9, 5, 12},  {5, 6, 11},
                    {5, 11, 12}, {8, 13, 7},  {8, 15, 13}, {8, 7, 6},   {8, 6, 5},   {3, 2, 7},   {3, 7, 13},
                    {3, 13, 14}, {3, 8, 4},   {3, 15, 8},  {3, 14, 15}, {9, 12, 11}, {9, 11, 10}, {15, 14, 13}};
  const Vec3d middle{-2.13 - 0.2834081, -2.113 + 0.2058874, 1.2 - 0.5569219};
  const Vec3d reach{5.9, 5.9, 6};
  const Vec3d side{0.1, 0.1, 0.1};
  append(mesh, test::box_between(middle - reach, middle - reach + side));
  append(mesh, test::box_between(middle + reach - side, middle + reach));
  return mesh;
}

TEST(SquareTest, FindsTheClosestSitesOfTheInteriorOnTheBorder) {
  Random random(5);
  for (const TriangleMesh& mesh :
       {room_with_a_plate(), test::turned(make_star()), make_bracket(), test::box_with_void()}) {
    const Divided divided(mesh);
    const Solid inside = Solid::of(mesh);
    const voronoi::CellTree& tree = divided.cells.tree;
    std::size_t asked = 0;
    for (std::size_t k = 0; k < tree.squares.size(); k += 1 + tree.squares.size() / 2000) {
      const voronoi::GridSquare& square = tree.squares[k];
      if (square.state != voronoi::SquareState::resolved || square.governors.empty()) continue;
      const voronoi::SquareCells cells = square_cells(tree, divided.solid.labels, square);
      const Vec3d low = tree.lattice.at(square.low);
      const bool is_large = square.length >= voronoi::Lattice::most / 8;
      for (int sample = 0; sample < (is_large ? 300 : 4); ++sample) {
        Vec3d q = low;
        const double side = tree.lattice.unit * square.length;
        for (const std::size_t axis :
             {voronoi::next_axis(square.axis), voronoi::next_axis(voronoi::next_axis(square.axis))}) {
          q[axis] += side * random.uniform(0, 1);
        }
        if (!inside.inside(q)) continue;
        ++asked;
        const std::vector<voronoi::Label> closest = divided.solid.exact.closest_labels(q);
        const bool is_decided = std::any_of(cells.pieces.begin(), cells.pieces.end(), [&](const auto& piece) {
          return std::any_of(closest.begin(), closest.end(), [&](const voronoi::Label& label) {
            return divided.solid.exact.site_of(label) == piece.site;
          });
        });
        EXPECT_TRUE(is_decided) << "at " << q.x << " " << q.y << " " << q.z;
      }
    }
    EXPECT_GT(asked, 300U);
  }
}

TEST(FaceLoops, CountHoles) {
  const LabelledSolid plate(make_plate());
  const voronoi::FaceLoops loops(plate.mesh, plate.table, plate.sites);
  EXPECT_EQ(loops.hole_count(), 12U) << "six holes, seen from both sides";
  const LabelledSolid box(make_box());
  const voronoi::FaceLoops of_box(box.mesh, box.table, box.sites);
  EXPECT_EQ(of_box.hole_count(), 0U);
  ASSERT_EQ(of_box.of(0).size(), 1U);
  EXPECT_EQ(of_box.of(0)[0].size(), 4U);
}

}  // namespace
}  // namespace blum
