#include "geometry/primitive_block.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_frame.hpp"

namespace blum {
namespace {

/// Below this ratio of altitude to longest side the plane of a triangle is not used to sort candidates out.
constexpr double sliver_ratio = 1e-3;

void offer_edge(const Vec3d& query, const Vec3d& a, const Vec3d& b, std::uint32_t vertex_a, std::uint32_t vertex_b,
                std::uint32_t edge, SiteCandidate& best) {
  if (edge == SiteId::none().value) return;
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  const double t = squared == 0 ? 0.0 : dot(query - a, direction) / squared;
  if (t <= 0) {
    best.offer(length(query - a), a, vertex_a);
  } else if (t >= 1) {
    best.offer(length(query - b), b, vertex_b);
  } else {
    // From the nearer end, so that rounding of t does not grow with the edge's length.
    const Vec3d point = t <= 0.5 ? a + direction * t : b - direction * (1 - t);
    best.offer(length(query - point), point, edge);
  }
}

}  // namespace

void PrimitiveBlock::set(std::size_t lane, const std::array<Vec3d, 3>& corners,
                         const std::array<std::uint32_t, 3>& vertices, const std::array<SiteId, 3>& edges,
                         SiteId face_site) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) corner[k][axis][lane] = corners[k][axis];
    vertex[k][lane] = vertices[k];
    edge[k][lane] = edges[k].value;
  }
  face[lane] = face_site.value;
  const TriangleFrame frame = make_triangle_frame(corners);
  sliver_altitude[lane] = frame.altitude < sliver_ratio * frame.length ? frame.altitude : 0.0;
}

BLUM_LANE_LOOPS void approximate_distances(const PrimitiveBlock& block, const Vec3d& query, double (&out)[lanes]) {
  const auto& p = block.corner;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double abx = p[1][0][i] - p[0][0][i], aby = p[1][1][i] - p[0][1][i], abz = p[1][2][i] - p[0][2][i];
    const double acx = p[2][0][i] - p[0][0][i], acy = p[2][1][i] - p[0][1][i], acz = p[2][2][i] - p[0][2][i];
    const double bcx = acx - abx, bcy = acy - aby, bcz = acz - abz;
    const double ax = query.x - p[0][0][i], ay = query.y - p[0][1][i], az = query.z - p[0][2][i];
    const double bx = query.x - p[1][0][i], by = query.y - p[1][1][i], bz = query.z - p[1][2][i];
    const double ab2 = abx * abx + aby * aby + abz * abz;
    const double ac2 = acx * acx + acy * acy + acz * acz;
    const double bc2 = bcx * bcx + bcy * bcy + bcz * bcz;
    constexpr double least = 1e-300;  // an edge of length zero has t = 0
    const double dab = ax * abx + ay * aby + az * abz;
    const double dac = ax * acx + ay * acy + az * acz;
    const double dbc = bx * bcx + by * bcy + bz * bcz;
    const double tab = std::min(std::max(dab / std::max(ab2, least), 0.0), 1.0);
    const double tac = std::min(std::max(dac / std::max(ac2, least), 0.0), 1.0);
    const double tbc = std::min(std::max(dbc / std::max(bc2, least), 0.0), 1.0);
    const double x1 = ax - tab * abx, y1 = ay - tab * aby, z1 = az - tab * abz;
    const double x2 = ax - tac * acx, y2 = ay - tac * acy, z2 = az - tac * acz;
    const double x3 = bx - tbc * bcx, y3 = by - tbc * bcy, z3 = bz - tbc * bcz;
    const double border =
        std::min(std::min(x1 * x1 + y1 * y1 + z1 * z1, x2 * x2 + y2 * y2 + z2 * z2), x3 * x3 + y3 * y3 + z3 * z3);
    const double nx = aby * acz - abz * acy, ny = abz * acx - abx * acz, nz = abx * acy - aby * acx;
    const double n2 = nx * nx + ny * ny + nz * nz;
    // Barycentric coordinates times n2: (n x ab) . aq etc.
    const double over_c = (ny * abz - nz * aby) * ax + (nz * abx - nx * abz) * ay + (nx * aby - ny * abx) * az;
    const double over_b = -((ny * acz - nz * acy) * ax + (nz * acx - nx * acz) * ay + (nx * acy - ny * acx) * az);
    const double height = nx * ax + ny * ay + nz * az;
    const double plane = height * height / std::max(n2, least);
    const double inside = std::min(std::min(over_b, over_c), n2 - over_b - over_c);
    const double squared = inside > 0 ? std::min(plane, border) : border;
    out[i] = std::sqrt(squared) - block.sliver_altitude[i];
  }
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
  const Vec3d w = query - f.base;
  const double s = dot(w, f.u);
  const double t = dot(w, f.v);
  const bool over_face = t > 0 && s * f.altitude > t * f.apex && (f.length - s) * f.altitude > t * (f.length - f.apex);
  if (!over_face) return;
  const Vec3d rest = w - f.u * s - f.v * t;
  best.offer(length(rest), query - rest, block.face[lane]);
}

}  // namespace blum
