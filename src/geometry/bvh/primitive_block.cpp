#include "geometry/bvh/primitive_block.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/distance/site_feet.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum {
namespace {

/// If the ratio of altitude to longest side is below this, the triangle's plane is not used to exclude candidates.
constexpr double sliver_ratio = 1e-3;

void offer_edge(const Vec3d& query, const Vec3d& a, const Vec3d& b, std::uint32_t vertex_a, std::uint32_t vertex_b,
                std::uint32_t edge, SiteCandidate& best) {
  if (edge == SiteId::none().value) return;
  const EdgeFoot foot = foot_on_edge(query, a, b);
  if (foot.t <= 0) {
    best.offer(length(query - a), a, vertex_a);
  } else if (foot.t >= 1) {
    best.offer(length(query - b), b, vertex_b);
  } else {
    best.offer(length(query - foot.point), foot.point, edge);
  }
}

}  // namespace

void PrimitiveBlock::set(std::size_t lane, const std::array<Vec3d, 3>& corners,
                         const std::array<std::uint32_t, 3>& vertices, const std::array<SiteId, 3>& edges,
                         SiteId face_site) {
  for (std::size_t k = 0; k < 3; ++k) {
    vertex[k][lane] = vertices[k];
    edge[k][lane] = edges[k].value;
  }
  face[lane] = face_site.value;
  place(lane, corners);
}

void PrimitiveBlock::place(std::size_t lane, const std::array<Vec3d, 3>& corners) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) corner[k][axis][lane] = corners[k][axis];
  }
  const TriangleFrame frame = make_triangle_frame(corners);
  sliver_altitude[lane] = frame.altitude < sliver_ratio * frame.length ? frame.altitude : 0.0;
}

void offer_closest(const PrimitiveBlock& block, std::size_t lane, const Vec3d& query, SiteCandidate& best) {
  const std::array<Vec3d, 3> p{block.position(0, lane), block.position(1, lane), block.position(2, lane)};
  best.offer(length(query - p[0]), p[0], block.vertex[0][lane]);
  offer_edge(query, p[0], p[1], block.vertex[0][lane], block.vertex[1][lane], block.edge[0][lane], best);
  offer_edge(query, p[1], p[2], block.vertex[1][lane], block.vertex[2][lane], block.edge[1][lane], best);
  offer_edge(query, p[0], p[2], block.vertex[0][lane], block.vertex[2][lane], block.edge[2][lane], best);
  if (block.face[lane] == SiteId::none().value) return;
  const TriangleFrame f = make_triangle_frame(p);
  if (f.is_flat()) return;
  const FaceFoot foot(query, f);
  if (foot.is_inside(f)) best.offer(length(foot.rest), query - foot.rest, block.face[lane]);
}

ProbeTriangle::ProbeTriangle(const std::array<Vec3d, 3>& triangle) : corners(triangle) {
  for (const Vec3d& p : triangle) box.extend(p);
  const Vec3d v = triangle[1] - triangle[0];
  const Vec3d w = triangle[2] - triangle[0];
  for (std::size_t x = 0; x < 3; ++x) {
    const double left = v[(x + 1) % 3] * w[(x + 2) % 3];
    const double right = v[(x + 2) % 3] * w[(x + 1) % 3];
    normal[x] = left - right;
    magnitude[x] = std::abs(left) + std::abs(right);
  }
}

}  // namespace blum
