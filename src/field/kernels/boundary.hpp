// Blum: what the boundary of a mesh's triangles adds to winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/kernels/boundary_edges.hpp"
#include "field/kernels/row_crossings.hpp"

// Let a ray leave a point p along -x, and the boundary of a surface sweep out a strip along +x, edge by edge. Surface
// and strips together enclose: their winding number is a whole number, and as no strip meets the ray, it is the sum of
// the ray's signed crossings with the surface. What the strips have added, the sum of their solid angles, is taken off
// again. So the winding number of any soup is counted crossings plus one term for each edge of its boundary:
//   w(p) = N(p) + sum over edges (a, b) of count * arg(1 + conj(u_a) u_b) / 2 pi,
// where u is the direction to a vertex, projected from -x onto the plane of y and z, as a complex number (the solid
// angle of the spherical triangle a, b, +x; Martens, Trettner, Bessmeltsev 2026). N and a term jump by the same whole
// number where p passes a strip; one comparison decides both jumps, so that they cancel. docs/theory/fields.md, "On a
// device".
namespace blum::kernels {

inline constexpr double pi = 3.141592653589793;

/// The direction u to a vertex as a quotient (y, z) / weight, so that it may be infinite.
struct ProjectedDirection {
  double weight = 1;
  double y = 0;
  double z = 0;

  /// @param v  from the query to the vertex.
  BLUM_HD explicit ProjectedDirection(const Vec3d& v) {
    const double across = hypot(v.y, v.z);  // whose squares may underflow
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
  /// @param edges, count  in the device's memory.
  /// @param places        of the vertices, in units of nodes.
  BoundaryTerms(const BoundaryEdge* edges, const std::uint32_t* count, const Vec3d* places, const Vec3d& spacing,
                bool is_mirrored)
      : edges_(edges), count_(count), places_(places), spacing_(spacing), is_mirrored_(is_mirrored) {}

  [[nodiscard]] BLUM_HD std::uint32_t count() const { return *count_; }

  /// @param node  in units of nodes: whole numbers.
  [[nodiscard]] BLUM_HD double term(std::uint32_t index, const Vec3d& node) const {
    const BoundaryEdge edge = edges_[index];
    const double winding = edge.count * angle(places_[edge.from], places_[edge.to], node) * (0.5 / pi);
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
    return magnitude(edge.count) * root(squared) / (4 * pi * gap * gap);
  }

 private:
  [[nodiscard]] BLUM_HD Vec3d scaled(const Vec3d& v) const {
    return {v.x * spacing_.x, v.y * spacing_.y, v.z * spacing_.z};
  }

  /// How far the edge turns to the left around the ray of a node, seen from +x (y to the right, z up).
  ///
  /// The angles of edges that share a vertex have the same rounded direction in common, so their sums are right but for
  /// whole turns, however close the ray comes to the vertex. Which whole turn is due, the crossings decide: by the
  /// comparison that tells which rows cross a triangle with this edge, and not by a rounded angle's sign.
  [[nodiscard]] BLUM_HD double angle(const Vec3d& from, const Vec3d& to, const Vec3d& node) const {
    const Vec3d a = from - node;
    const Vec3d b = to - node;
    const ProjectedDirection u(scaled(a));
    const ProjectedDirection v(scaled(b));
    const double real = u.weight * v.weight + u.y * v.y + u.z * v.z;
    const double turned = u.y * v.z - u.z * v.y;
    const double angle = atan2(turned, real);
    const bool is_a_above = a.z > 0;
    const bool is_b_above = b.z > 0;
    if (is_a_above == is_b_above) {
      if (turned != 0) return angle;
      return (b.y > a.y) != is_a_above ? magnitude(angle) : -magnitude(angle);
    }
    const SlicePoint cut = is_b_above ? edge_point(from, to, node.z) : edge_point(to, from, node.z);
    if (!(cut.x < node.x)) return angle;  // no strip here
    const bool is_left = (cut.y <= node.y) != is_b_above;
    // The sign of `turned` is that of the angle, which may underflow.
    const bool is_contradicted = turned != 0 ? is_left != (turned > 0) : real < 0 && is_left != (angle > 0);
    if (!is_contradicted) return angle;
    return angle + (is_left ? 2 * pi : -2 * pi);
  }

  const BoundaryEdge* edges_ = nullptr;
  const std::uint32_t* count_ = nullptr;
  const Vec3d* places_ = nullptr;
  Vec3d spacing_;
  bool is_mirrored_ = false;
};

}  // namespace blum::kernels
