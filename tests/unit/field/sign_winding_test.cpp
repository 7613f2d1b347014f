// Proves that signs by winding numbers equal those of the full sum over all triangles at every node, and need few
// queries.
#include "field/sign/winding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "blum/field/reference.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

Field unsigned_field(const MeshView& mesh, const GridSpec& grid, std::optional<double> band = {}) {
  const Bvh bvh(mesh, SiteTable(mesh));
  Field field;
  field.grid = grid;
  field.band = band;
  field.distance = Buffer<float>(grid.node_count());
  for (std::int64_t z = 0; z < grid.size[2]; ++z) {
    for (std::int64_t y = 0; y < grid.size[1]; ++y) {
      for (std::int64_t x = 0; x < grid.size[0]; ++x) {
        const double distance = bvh.nearest(grid.position(x, y, z))->distance;
        field.distance[grid.index(x, y, z)] = static_cast<float>(band ? std::min(distance, *band) : distance);
      }
    }
  }
  return field;
}

WindingSignCounts apply(Field& field, const MeshView& mesh, int threads = 0) {
  return apply_winding_sign(field, mesh, SiteTable(mesh), {.threads = threads});
}

/// Compares all nodes that are further from the surface than the promised precision.
void expect_true_signs(const MeshView& mesh, const GridSpec& grid, std::optional<double> band = {}) {
  Field field = unsigned_field(mesh, grid, band);
  const Buffer<float> before = field.distance.clone();
  (void)apply(field, mesh);
  Box3 box = bounds(mesh);
  box.extend(bounds(grid));
  std::size_t wrong = 0;
  for (std::int64_t z = 0; z < grid.size[2]; ++z) {
    for (std::int64_t y = 0; y < grid.size[1]; ++y) {
      for (std::int64_t x = 0; x < grid.size[0]; ++x) {
        const std::size_t node = grid.index(x, y, z);
        ASSERT_EQ(std::abs(field.distance[node]), before[node]);
        if (static_cast<double>(before[node]) < 1e-6 * box.diagonal()) continue;
        const double w = reference::winding_number(mesh, grid.position(x, y, z));
        if (std::abs(w - 0.5) < 1e-9) continue;
        wrong += (field.distance[node] < 0) != (w > 0.5) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TriangleMesh bowl(double height, int frequency = 8) {
  TriangleMesh mesh = make_sphere({.frequency = frequency});
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].z > height && mesh.vertices[t[1]].z > height && mesh.vertices[t[2]].z > height;
  });
  return mesh;
}

TEST(WindingSign, IsRightAtEveryNodeOfClosedMeshes) {
  for (const TriangleMesh& mesh :
       {make_sphere({.frequency = 5}), make_star({}), make_void_cube({}), make_gear({}), make_bodies({})}) {
    expect_true_signs(mesh, grid_around(bounds(mesh), 24));
  }
}

TEST(WindingSign, DoesNotFloodThroughHoles) {
  for (const double height : {-0.5, 0.0, 0.5, 0.8, 0.95}) {
    const TriangleMesh mesh = bowl(height);
    expect_true_signs(mesh, grid_around(bounds(mesh), 30, 0.3));
  }
  // The holes are much smaller, and much larger, than the grid's spacing.
  TriangleMesh pierced = make_sphere({.frequency = 12});
  pierced.triangles.erase(pierced.triangles.begin() + 100);
  pierced.triangles.erase(pierced.triangles.begin() + 500);
  expect_true_signs(pierced, grid_around(bounds(pierced), 13));
  expect_true_signs(pierced, grid_in({{0.8, -0.2, -0.2}, {1.2, 0.2, 0.2}}, 25));
}

TEST(WindingSign, IsRightOnSoupsAndMixedOrientations) {
  const TriangleMesh soup = make_soup({.triangles = 60, .triangle_size = 0.8, .awkward = 0.3, .seed = 3});
  expect_true_signs(soup, grid_around(bounds(soup), 26));
  TriangleMesh turned = make_sphere({.frequency = 4});
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  expect_true_signs(turned, grid_around(bounds(turned), 26));
  TriangleMesh crossing = make_sphere({.frequency = 4});
  append(crossing, make_sphere({.frequency = 4}), {0.7, 0.2, 0.1});
  expect_true_signs(crossing, grid_around(bounds(crossing), 26));
  TriangleMesh twice = make_sphere({.frequency = 4});
  TriangleMesh inverse = twice;
  reverse_triangles(inverse);
  append(twice, inverse);
  expect_true_signs(twice, grid_around(bounds(twice), 20));
}

TEST(WindingSign, FindsNoInsideInInvertedMeshes) {
  TriangleMesh mesh = make_sphere({.frequency = 5});
  reverse_triangles(mesh);
  Field field = unsigned_field(mesh, grid_around(bounds(mesh), 20));
  (void)apply(field, mesh);
  for (const float d : field.distance.span()) EXPECT_GE(d, 0);
}

TEST(WindingSign, WorksOnThinTinyAndTurnedGrids) {
  const TriangleMesh mesh = bowl(0.4);
  for (const std::array<std::int64_t, 3> size : {std::array<std::int64_t, 3>{40, 37, 1},
                                                 {1, 40, 9},
                                                 {33, 1, 8},
                                                 {1, 1, 60},
                                                 {1, 1, 1},
                                                 {2, 3, 2},
                                                 {17, 9, 16}}) {
    GridSpec grid;
    grid.size = size;
    grid.spacing = {0.06, 0.08, 0.11};
    grid.origin = {-0.03 * static_cast<double>(size[0]), -0.04 * static_cast<double>(size[1]),
                   -0.055 * static_cast<double>(size[2])};
    grid.direction.columns[0] = {0.8, 0.6, 0};
    grid.direction.columns[1] = {-0.6, 0.8, 0};
    expect_true_signs(mesh, grid);
  }
}

TEST(WindingSign, WorksInBandsHoweverNarrow) {
  for (const TriangleMesh& mesh : {bowl(0.4), make_star({})}) {
    const GridSpec grid = grid_around(bounds(mesh), 25);
    for (const double cells : {0.3, 1.0, 3.0}) expect_true_signs(mesh, grid, cells * grid.spacing.x);
  }
}

TEST(WindingSign, WorksFarFromTheOriginAndAtAnyScale) {
  for (const double scale : {1e-9, 1e9}) {
    const TriangleMesh mesh = test::moved(bowl(0.4), scale);
    expect_true_signs(mesh, grid_around(bounds(mesh), 20));
  }
  const TriangleMesh far = test::moved(bowl(0.4), 1, {1e6, 1e6, -1e6});
  expect_true_signs(far, grid_around(bounds(far), 20));
}

/// The search is fast because nodes share answers.
TEST(WindingSign, MakesFewQueries) {
  const TriangleMesh sphere = make_sphere({.frequency = 20});
  Field closed = unsigned_field(sphere, grid_around(bounds(sphere), 64));
  const WindingSignCounts counts = apply(closed, sphere);
  EXPECT_LT(counts.queries, closed.distance.size() / 100);
  EXPECT_GE(counts.queries, 2U);
  const TriangleMesh open = bowl(0.9, 20);
  Field holed = unsigned_field(open, grid_around(bounds(open), 64));
  EXPECT_LT(apply(holed, open).queries, holed.distance.size() / 6);
}

/// Blocks of nodes that contain boundary edges are cut into smaller boxes, not into nodes.
TEST(WindingSign, MakesFewQueriesOnSoups) {
  const TriangleMesh soup = make_soup({.triangles = 30});
  Field field = unsigned_field(soup, grid_around(bounds(soup), 64));
  EXPECT_LT(apply(field, soup).queries, field.distance.size() * 2 / 5);
}

TEST(WindingSign, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = bowl(0.3);
  Field one = unsigned_field(mesh, grid_around(bounds(mesh), 50));
  Field four;
  four.grid = one.grid;
  four.distance = one.distance.clone();
  const WindingSignCounts counts = apply(one, mesh, 1);
  EXPECT_EQ(apply(four, mesh, 4).queries, counts.queries);
  EXPECT_TRUE(std::equal(one.distance.begin(), one.distance.end(), four.distance.begin()));
}

TEST(WindingSign, LeavesNodesOnTheSurfaceAlone) {
  const TriangleMesh box = make_box({});
  Field field = unsigned_field(box, grid_in(bounds(box), 9));
  (void)apply(field, box);
  for (const float d : field.distance.span()) {
    if (d == 0) {
      EXPECT_FALSE(std::signbit(d));
    }
  }
}

}  // namespace
}  // namespace blum
