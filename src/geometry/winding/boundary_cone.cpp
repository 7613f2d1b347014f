#include "geometry/winding/boundary_cone.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

namespace blum {
namespace {

/// What rounding does to the terms of an angle, generously.
constexpr double rounding = 1e-14;

/// In the middle of the boundary, but not where a mesh may have anything that is aligned with it.
Vec3d apex_of(std::span<const BoundaryChain::Edge> edges) {
  Box3 box;
  for (const BoundaryChain::Edge& edge : edges) {
    box.extend(edge.from);
    box.extend(edge.to);
  }
  return box.center() + Vec3d{0.01371, 0.02917, -0.01733} * box.diagonal();
}

}  // namespace

BoundaryCone::BoundaryCone(std::span<const BoundaryChain::Edge> edges) {
  if (edges.empty()) return;
  const Vec3d apex = apex_of(edges);
  std::size_t lane = lanes;
  for (const BoundaryChain::Edge& edge : edges) {
    for (std::int64_t k = 0; k < edge.multiplicity; ++k) {
      if (lane == lanes) {
        TriangleBlock& block = blocks_.emplace_back();
        for (auto& corner : block.corner) {
          for (std::size_t axis = 0; axis < 3; ++axis) std::fill_n(corner[axis], lanes, apex[axis]);
        }
        lane = 0;
      }
      // Against the surface's direction.
      const std::array<Vec3d, 3> corners{edge.to, edge.from, apex};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t axis = 0; axis < 3; ++axis) blocks_.back().corner[c][axis][lane] = corners[c][axis];
      }
      ++lane;
    }
  }
}

std::optional<double> BoundaryCone::winding_number(const Vec3d& scaled_query) const {
  SolidAngleSum sum;
  alignas(64) double inverse[lanes] = {};
  for (const TriangleBlock& block : blocks_) add_watched_triangles(block, scaled_query, sum, inverse);
  const double badly = std::accumulate(inverse, inverse + lanes, 0.0);
  if (!(rounding * badly < error)) return std::nullopt;  // also where a corner was met, which is not a number
  return sum.winding_number();
}

}  // namespace blum
