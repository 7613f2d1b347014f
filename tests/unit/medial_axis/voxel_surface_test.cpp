// Proves that closest points on the faces of voxels equal those of a search over all voxels.
#include "medial_axis/surface/voxel_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_image.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::Footprint;
using detail::NearestPoint;
using detail::VoxelSurface;

using Place = std::array<std::int64_t, 3>;

struct Sample {
  Sample(VoxelSet set, const GridSpec& its_grid) : voxels(std::move(set)), grid(its_grid), surface(voxels, grid) {}

  [[nodiscard]] Place place(std::uint32_t voxel) const {
    const auto v = static_cast<std::int64_t>(voxel);
    return {v % grid.size[0], v / grid.size[0] % grid.size[1], v / (grid.size[0] * grid.size[1])};
  }
  [[nodiscard]] bool is_other(const Place& at) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] < 0 || at[a] >= grid.size[a]) return false;
    }
    return !voxels.contains(at[0], at[1], at[2]);
  }
  /// The point of a closed voxel that is closest to a query.
  [[nodiscard]] Vec3d closest_in(const Place& at, const Vec3d& query) const {
    Vec3d from_centre = grid.direction.transposed_times(query - grid.position(at[0], at[1], at[2]));
    for (std::size_t a = 0; a < 3; ++a) {
      from_centre[a] = std::clamp(from_centre[a], -0.5 * grid.spacing[a], 0.5 * grid.spacing[a]);
    }
    return grid.position(at[0], at[1], at[2]) + grid.direction * from_centre;
  }
  /// The distance to the closest voxel outside the set, among all in the box.
  [[nodiscard]] double distance(const Vec3d& query) const {
    double least = std::numeric_limits<double>::infinity();
    test::for_each_voxel(grid.size, 0, [&](auto i, auto j, auto k) {
      if (is_other({i, j, k})) least = std::min(least, length(query - closest_in({i, j, k}, query)));
    });
    return least;
  }
  [[nodiscard]] Vec3d random_point(Random& random) const {
    Vec3d index;
    for (std::size_t a = 0; a < 3; ++a) {
      index[a] = random.uniform(0, static_cast<double>(grid.size[a] - 1)) * grid.spacing[a];
    }
    return grid.origin + grid.direction * index;
  }
  /// A footprint on a random voxel outside the set.
  [[nodiscard]] Footprint random_footprint(Random& random) const {
    while (true) {
      const auto voxel = static_cast<std::uint32_t>(random.below(grid.node_count()));
      if (is_other(place(voxel))) return {closest_in(place(voxel), random_point(random)), voxel, 7};
    }
  }

  VoxelSet voxels;
  GridSpec grid;
  VoxelSurface surface;
};

std::vector<std::unique_ptr<Sample>> samples() {
  Random random(1);
  std::vector<std::unique_ptr<Sample>> all;
  for (const Place& size : {Place{12, 9, 7}, Place{16, 16, 16}, Place{5, 23, 6}, Place{70, 5, 6}, Place{3, 3, 3}}) {
    for (const double density : {0.5, 0.97, 1.0}) {  // at 1, the set fills all but the outermost layer
      const GridSpec plain{{0.5, 0, -1}, {1, 1, 1}, size, {}};
      all.push_back(std::make_unique<Sample>(test::random_voxels(size, density, random), plain));
      all.push_back(std::make_unique<Sample>(test::random_voxels(size, density, random), test::turned_grid(size)));
    }
  }
  return all;
}

TEST(VoxelSurface, NearestEqualsASearchOverAllVoxels) {
  Random random(2);
  for (const auto& s : samples()) {
    for (int n = 0; n < 60; ++n) {
      const Vec3d query = s->random_point(random);
      const NearestPoint found = s->surface.nearest(query, s->random_footprint(random));
      ASSERT_NEAR(found.distance, s->distance(query), 1e-12);
      ASSERT_NEAR(found.distance, length(query - found.point), 1e-12);
      ASSERT_TRUE(s->is_other(s->place(found.element)));
      ASSERT_EQ(found.site.value, found.element);
      ASSERT_LT(length(found.point - s->closest_in(s->place(found.element), query)), 1e-12);
    }
  }
}

TEST(VoxelSurface, NearestStaysIfItStartsAtTheNearest) {
  Random random(3);
  for (const auto& s : samples()) {
    for (int n = 0; n < 20; ++n) {
      const Vec3d query = s->random_point(random);
      const NearestPoint first = s->surface.nearest(query, s->random_footprint(random));
      const NearestPoint again = s->surface.nearest(query, {first.point, first.element, 7});
      ASSERT_NEAR(again.distance, first.distance, 1e-13);
    }
  }
}

/// True if no voxel that contains the footprint is closer.
bool is_least_around(const Sample& s, const Footprint& foot, const Vec3d& query) {
  const Place at = s.place(foot.element);
  const double distance = length(query - foot.point);
  for (int n = 0; n < 27; ++n) {
    const Place next{at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
    if (!s.is_other(next) || length(foot.point - s.closest_in(next, foot.point)) > 1e-12) continue;
    if (length(query - s.closest_in(next, query)) < distance - 1e-9) return false;
  }
  return true;
}

/// Following stops after 64 steps, so larger grids are left out.
TEST(VoxelSurface, FollowingEndsIfNoVoxelAtTheFootprintIsCloser) {
  Random random(4);
  for (const auto& s : samples()) {
    if (s->grid.size[0] > 64) continue;
    for (int n = 0; n < 60; ++n) {
      const Vec3d query = s->random_point(random);
      const Footprint start = s->random_footprint(random);
      const Footprint end = s->surface.follow(start, query, 1e9);
      ASSERT_TRUE(s->is_other(s->place(end.element)));
      ASSERT_LT(length(end.point - s->closest_in(s->place(end.element), query)), 1e-12);
      ASSERT_LE(length(query - end.point), length(query - s->closest_in(s->place(start.element), query)) + 1e-12);
      ASSERT_TRUE(is_least_around(*s, end, query));
    }
  }
}

/// Nothing else is in the way if the other walls are far.
TEST(VoxelSurface, FollowingAFlatWallFindsTheNearestPointOfIt) {
  Random random(5);
  const Place size{20, 20, 8};
  const Sample s(test::voxels_where(size, [](auto...) { return true; }), test::turned_grid(size));
  for (int n = 0; n < 200; ++n) {
    const std::int64_t layer = n % 2 == 0 ? 0 : size[2] - 1;
    const auto wall = [&] {
      return Place{7 + static_cast<std::int64_t>(random.below(6)), 5 + static_cast<std::int64_t>(random.below(10)),
                   layer};
    };
    const Place from = wall();
    const Place to = wall();
    Place inside = to;
    inside[2] = layer == 0 ? 1 : size[2] - 2;
    const Vec3d query = s.grid.position(inside[0], inside[1], inside[2]);
    const Footprint start{s.closest_in(from, query), static_cast<std::uint32_t>(s.grid.index(from[0], from[1], layer)),
                          7};
    const Footprint end = s.surface.follow(start, query, 1e9);
    ASSERT_NEAR(length(query - end.point), 0.5 * s.grid.spacing[2], 1e-12);
  }
}

TEST(VoxelSurface, FollowingStaysWithinItsReach) {
  Random random(6);
  for (const auto& s : samples()) {
    for (int n = 0; n < 60; ++n) {
      const Vec3d query = s->random_point(random);
      Footprint start = s->random_footprint(random);
      start.point = s->closest_in(s->place(start.element), query);
      const double reach = random.uniform(0, 4);
      const Footprint end = s->surface.follow(start, query, reach);
      ASSERT_LE(length(end.point - start.point), reach + 1e-12);
    }
  }
}

/// The site in a field is the closest voxel of the other kind.
TEST(VoxelSurface, FootprintsLieOnTheFacesBetweenAVoxelAndItsSite) {
  for (const Vec3d& spacing : {Vec3d{1, 1, 1}, Vec3d{1, 1.25, 1.5}}) {
    VoxelImage image = make_ball_image({.size = 32, .spacing = spacing, .inner_radius = 0.4});
    image.grid.direction = test::turned_grid(image.grid.size).direction;
    const Sample s(selected_voxels(image, {}), image.grid);
    const Field field = distance_transform(image);
    test::for_each_voxel(image.grid.size, 0, [&](auto i, auto j, auto k) {
      const std::size_t voxel = image.grid.index(i, j, k);
      const Vec3d centre = image.grid.position(i, j, k);
      const bool is_inside = s.voxels.contains(i, j, k);
      const Footprint foot = s.surface.footprint(field.site[voxel], centre, is_inside);
      const Place site = s.place(field.site[voxel].value);
      ASSERT_TRUE(s.is_other(s.place(foot.element)));
      ASSERT_EQ(foot.element, is_inside ? field.site[voxel].value : voxel);
      // The closest point of the site to the centre, or the closest point of the voxel itself to that one.
      const Vec3d expected =
          is_inside ? s.closest_in(site, centre) : s.closest_in({i, j, k}, s.closest_in(site, centre));
      ASSERT_LT(length(foot.point - expected), 1e-12);
      ASSERT_EQ(s.surface.site_of(foot).value, foot.element);
    });
  }
}

/// Rough footprints use the axes of the grid and the lower corner of the box, so they are exact up to a rotation.
TEST(VoxelSurface, RoughFootprintsAreAsFarApartAsTheirVoxelCentres) {
  const Place size{6, 5, 4};
  const Sample s(test::voxels_where(size, [](auto...) { return true; }), test::turned_grid(size));
  Random random(7);
  for (int n = 0; n < 100; ++n) {
    const Footprint a = s.random_footprint(random);
    const Footprint b = s.random_footprint(random);
    const Place at_a = s.place(a.element);
    const Place at_b = s.place(b.element);
    const Vec3d between = *s.surface.rough_footprint(SiteId(a.element)) - *s.surface.rough_footprint(SiteId(b.element));
    ASSERT_NEAR(length(between),
                length(s.grid.position(at_a[0], at_a[1], at_a[2]) - s.grid.position(at_b[0], at_b[1], at_b[2])), 1e-12);
  }
}

}  // namespace
}  // namespace blum
