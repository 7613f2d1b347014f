// Blum: the boundary of a mesh's triangles, and what it adds to winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/kernels/connectivity.hpp"
#include "field/kernels/row_crossings.hpp"

// Let a ray leave a point p along -x, and the boundary of a surface sweep out a strip along +x, edge by edge. Surface
// and strips together enclose: their winding number is a whole number, and as no strip meets the ray, it is the sum of
// the ray's signed crossings with the surface. What the strips have added, the sum of their solid angles, is taken off
// again. So the winding number of any soup is counted crossings plus one term for each edge of its boundary:
//   w(p) = N(p) + sum over edges (a, b) of count * arg(1 + conj(u_a) u_b) / 2 pi,
// where u is the direction to a vertex, projected from -x onto the plane of y and z, as a complex number (the solid
// angle of the spherical triangle a, b, +x; Martens, Trettner, Bessmeltsev 2026). N and a term jump by the same whole
// number where p passes a strip; both decide there by the same comparison, so that the jumps cancel.
// docs/theory/fields.md, "On a device".
namespace blum::kernels {

/// An edge that triangles do not run along as often one way as the other.
struct BoundaryEdge {
  std::uint32_t from;
  std::uint32_t to;
  double count;  ///< surplus of triangles that run from `from` to `to`; > 0
};

struct FlagBoundary {
  const std::int32_t* balance;
  std::uint32_t* is_boundary;
  BLUM_HD void operator()(std::size_t e) const { is_boundary[e] = balance[e] != 0 ? 1 : 0; }
};

struct ListBoundary {
  const Segment* edges;
  const std::int32_t* balance;
  const std::uint32_t* place;
  BoundaryEdge* out;
  BLUM_HD void operator()(std::size_t e) const {
    if (balance[e] == 0) return;
    const bool is_forward = balance[e] > 0;
    out[place[e]] = {edges[e][is_forward ? 0 : 1], edges[e][is_forward ? 1 : 0],
                     static_cast<double>(is_forward ? balance[e] : -balance[e])};
  }
};

/// The direction u to a vertex as a quotient (y, z) / weight, so that it may be infinite.
struct ProjectedDirection {
  double weight = 1;
  double y = 0;
  double z = 0;

  /// @param v  from the query to the vertex.
  BLUM_HD explicit ProjectedDirection(const Vec3d& v) {
    const double across = root(v.y * v.y + v.z * v.z);
    const double distance = norm(v);
    if (v.x > 0) {
      weight = distance + v.x;
      y = v.y;
      z = v.z;
      return;
    }
    const double scale = distance - v.x;
    if (across > 0) {
      weight = across;
      y = v.y / across * scale;
      z = v.z / across * scale;
    } else if (scale > 0) {
      // On the ray itself. Crossings are counted for rays that are shifted towards larger y and, by less, larger z.
      weight = 0;
      y = -scale;
    }
  }
};

/// What an edge of the boundary adds to the winding number at a node, and how fast that may change around it.
class BoundaryTerms {
 public:
  BoundaryTerms() = default;
  /// @param edges   in the device's memory.
  /// @param places  of the vertices, in units of nodes.
  BoundaryTerms(const BoundaryEdge* edges, std::uint32_t count, const Vec3d* places, const Vec3d& spacing,
                bool is_mirrored)
      : edges_(edges), places_(places), spacing_(spacing), count_(count), is_mirrored_(is_mirrored) {}

  [[nodiscard]] BLUM_HD std::uint32_t count() const { return count_; }

  /// @param node  in units of nodes: whole numbers.
  [[nodiscard]] BLUM_HD double term(std::uint32_t index, const Vec3d& node) const {
    const BoundaryEdge edge = edges_[index];
    const Vec3d a = places_[edge.from] - node;
    const Vec3d b = places_[edge.to] - node;
    const ProjectedDirection u(scaled(a));
    const ProjectedDirection v(scaled(b));
    const double real = u.weight * v.weight + u.y * v.y + u.z * v.z;
    const double turned = u.y * v.z - u.z * v.y;
    const double angle = atan2(
        is_left(places_[edge.from], places_[edge.to], a, b, node, turned) ? magnitude(turned) : -magnitude(turned),
        real);
    const double winding = edge.count * angle * 0.15915494309189535;  // 1 / 2 pi
    return is_mirrored_ ? -winding : winding;
  }

  /// A bound on the gradient of the term along paths that cross no strip, within a distance of a node; infinite where
  /// the edge may be that close. The winding number's gradient is the Biot-Savart field of the boundary.
  /// @param reach  mesh units.
  [[nodiscard]] BLUM_HD double gradient_bound(std::uint32_t index, const Vec3d& node, double reach) const {
    const BoundaryEdge edge = edges_[index];
    const Vec3d a = scaled(places_[edge.from] - node);
    const Vec3d along = scaled(places_[edge.to] - node) - a;
    const double squared = squared_length(along);
    const double t = squared > 0 ? clamped(-dot(a, along) / squared, 0.0, 1.0) : 0.0;
    // Rounding of places and of this sum stays far below a hundredth of a percent of the distance and the edge.
    const double gap = 0.9999 * norm(a + along * t) - 1e-9 * root(squared) - reach;
    if (!(gap > 0)) return HUGE_VAL;
    return edge.count * root(squared) / (12.566370614359172 * gap * gap);
  }

 private:
  [[nodiscard]] BLUM_HD Vec3d scaled(const Vec3d& v) const {
    return {v.x * spacing_.x, v.y * spacing_.y, v.z * spacing_.z};
  }

  /// Whether the edge turns to the left around a query, seen from +x (y to the right, z up): by the comparison that
  /// decides which rows cross a triangle with this edge.
  /// @param a, b  from the query to the ends.
  [[nodiscard]] BLUM_HD static bool is_left(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b,
                                            const Vec3d& node, double turned) {
    const bool is_a_above = a.z > 0;
    const bool is_b_above = b.z > 0;
    if (is_a_above == is_b_above) return turned != 0 ? turned > 0 : b.y > a.y;
    const SlicePoint cut = is_b_above ? edge_point(from, to, node.z) : edge_point(to, from, node.z);
    return (cut.y <= node.y) != is_b_above;
  }

  const BoundaryEdge* edges_ = nullptr;
  const Vec3d* places_ = nullptr;
  Vec3d spacing_;
  std::uint32_t count_ = 0;
  bool is_mirrored_ = false;
};

}  // namespace blum::kernels
