// What an octree says is closest along its edges, against exact comparisons of all labels; how squares and cubes read
// their borders.
#include "voronoi/subdivision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/shapes/generators.hpp"
#include "support/labelled_solid.hpp"
#include "support/mesh_places.hpp"
#include "support/random_transform.hpp"
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
      : solid(given),
        labels(solid.mesh, solid.table, solid.sites, solid.labels),
        loops(solid.mesh, solid.table, solid.sites) {
    Context context;
    context.threads = threads;
    cells = subdivide(solid.mesh, solid.table, solid.sites, solid.labels, labels, loops, {}, context);
  }

  LabelledSolid solid;
  voronoi::LabelGeometry labels;
  voronoi::FaceLoops loops;
  voronoi::Subdivision cells;
};

/// The number of places along edges at which something else is closest than what the edge says.
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
        const std::vector<voronoi::Label> closest = divided.solid.labels.closest_labels(q);
        const bool is_right = std::any_of(closest.begin(), closest.end(), [&](const voronoi::Label& other) {
          return divided.solid.labels.site_of(other) == divided.labels[label].site;
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

TEST(Subdivision, FindsWhatIsClosestAlongEdges) {
  for (const TriangleMesh& mesh : {make_box(), test::box_with_void(), make_cylinder({.sides = 12}), make_star(),
                                   make_bracket(), make_torus({.ring_segments = 12, .tube_segments = 8})}) {
    const Divided divided(mesh);
    EXPECT_EQ(divided.cells.failing.size(), 0U);
    EXPECT_EQ(divided.cells.contradictions, 0U);
    EXPECT_EQ(divided.cells.lines.undecided, 0U);
    EXPECT_EQ(wrong_places(divided, 1000), 0U);
  }
}

/// Faces that rounding has bent by 1e-16: what is closest next to their edges the structure tells.
TEST(Subdivision, FindsWhatIsClosestOverBentFaces) {
  for (TriangleMesh mesh : {make_box(), test::box_with_void(), make_cylinder({.sides = 24}), make_star()}) {
    for (Vec3d& v : mesh.vertices) v = test::turned(v);
    const Divided divided(mesh);
    EXPECT_EQ(divided.cells.failing.size(), 0U);
    EXPECT_EQ(divided.cells.contradictions, 0U);
    EXPECT_EQ(divided.cells.lines.undecided, 0U);
    EXPECT_EQ(wrong_places(divided, 1000), 0U);
  }
}

/// Every event lies on the borders of two squares for each cube around its edge; around a square, runs change at events
/// alone, and each component joins events of at least two runs.
TEST(SquareCells, AreOfTheBorder) {
  const Divided divided(make_bracket());
  const voronoi::CellTree& tree = divided.cells.tree;
  std::size_t with_walls = 0;
  for (const voronoi::GridSquare& square : tree.squares) {
    if (square.children != no_cell || square.state != voronoi::SquareState::resolved) continue;
    const voronoi::SquareCells cells = square_cells(tree, divided.labels, square);
    ASSERT_EQ(cells.runs.size(), std::max<std::size_t>(1, cells.events.size()));
    for (std::size_t k = 0; k < cells.events.size(); ++k) {
      const auto& before = cells.runs[k];
      const auto& behind = cells.runs[(k + 1) % cells.runs.size()];
      const auto site = [&](LabelIndex label) { return label == outside ? outside : divided.labels[label].site; };
      EXPECT_NE(site(before.label), site(behind.label));
      EXPECT_LT(cells.component[k], cells.component_count);
    }
    // Components and regions of a disc: one more of both than events, as each event cuts the border once.
    if (cells.events.empty()) continue;
    ++with_walls;
    EXPECT_EQ(cells.component_count + cells.pieces.size(), cells.events.size() + 1);
  }
  EXPECT_GT(with_walls, 1000U);
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
