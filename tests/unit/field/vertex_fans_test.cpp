// Proves that the vertex cones computed sixteen at a time agree with those computed one at a time, on random and
// degenerate fans.
#include "field/cpu/vertex_fans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "field/kernels/vertex_cone.hpp"

namespace blum::cpu {
namespace {

/// Returns directions of a fan: anywhere, in a half-space (a convex corner), nearly in a plane, or on a coarse lattice.
/// On the lattice, parallel and repeated directions are common.
std::vector<Vec3d> random_fan(Random& random, std::size_t count, int family) {
  std::vector<Vec3d> fan;
  while (fan.size() < count) {
    Vec3d e{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (family == 1) e.z = -0.2 - std::abs(e.z);
    if (family == 2) e.z *= 0.01;
    if (family == 3) e = {std::round(1.4 * e.x), std::round(1.4 * e.y), std::round(1.4 * e.z)};
    if (length(e) > 0.01) fan.push_back(e);
  }
  return fan;
}

void put(const std::vector<Vec3d>& fan, std::size_t lane, VertexFans& fans) {
  fans.count[lane] = static_cast<std::uint32_t>(fan.size());
  for (std::size_t k = 0; k < VertexFans::most; ++k) {
    const Vec3d& e = fan[k < fan.size() ? k : 0];
    for (std::size_t axis = 0; axis < 3; ++axis) fans.along[k][axis][lane] = static_cast<float>(e[axis]);
  }
}

/// True if every ray of `some` is among `all`.
bool are_among(std::span<const Vec3f> some, std::span<const Vec3f> all) {
  return std::all_of(some.begin(), some.end(), [&](const Vec3f& ray) {
    return std::any_of(all.begin(), all.end(), [&](const Vec3f& other) { return length(ray - other) < 1e-3F; });
  });
}

TEST(VertexFans, AgreeWithSingleConesOnEveryTarget) {
  for (const std::string& target : simd_targets()) {
    use_simd_target(target);
    Random random(7);
    int empty = 0;
    int bounded = 0;
    int uncertain = 0;
    for (int round = 0; round < 400; ++round) {
      VertexFans fans;
      std::array<std::vector<Vec3d>, cluster_size> input;
      for (std::size_t lane = 0; lane < cluster_size; ++lane) {
        if (lane % 5 == 4) continue;  // a lane without a vertex
        input[lane] = random_fan(random, 3 + static_cast<std::size_t>(random.below(VertexFans::most - 2)), round % 4);
        put(input[lane], lane, fans);
      }
      VertexFanCones cones;
      find_fan_cones(fans, cones);
      for (std::size_t lane = 0; lane < cluster_size; ++lane) {
        if (input[lane].empty()) continue;
        kernels::VertexCone cone;
        for (const Vec3d& e : input[lane]) cone.add(e / length(e));
        const bool exists = cone.find_facets();
        const bool is_certain = ((cones.is_uncertain >> lane) & 1U) == 0;
        EXPECT_EQ(exists, cones.ray_count[lane] > 0 || !is_certain) << target << " round " << round << " lane " << lane;
        empty += exists ? 0 : 1;
        uncertain += is_certain ? 0 : 1;
        if (!exists || cone.rays().empty()) continue;
        ++bounded;
        const std::span<const Vec3f> rays(cones.rays[lane].data(), std::min<std::size_t>(cones.ray_count[lane], 8));
        EXPECT_TRUE(are_among(cone.rays(), rays) && are_among(rays, cone.rays()));
        // Each plane that the single cone keeps also bounds the cone of the fan.
        for (std::size_t k = 0; k < cone.planes().count; ++k) {
          EXPECT_TRUE((cones.facets[lane] >> cone.planes().index[k]) & 1U) << target << " round " << round;
        }
      }
    }
    EXPECT_GT(empty, 100);
    EXPECT_GT(bounded, 100);
    EXPECT_GT(uncertain, 100);
  }
  use_simd_target("");
}

}  // namespace
}  // namespace blum::cpu
