// Blum: exact theta-medial axes as meshes, for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"
#include "support/known_axes.hpp"

namespace blum::test {

/// A solid and its exact axis of one theta. Round parts of the axis consist of 720 flat parts, which are off by 1e-5
/// of their radius.
struct ExactAxis {
  TriangleMesh solid;
  TriangleMesh axis;         ///< triangles and segments
  TriangleMesh seams, rims;  ///< segments
  double tube_radius = 0;    ///< radius along the curve of the axis, if it is constant
};

/// The resolution of round solids. Facets are at most `off` away from the circle they approximate.
struct Fineness {
  double off = 1e-4;
  [[nodiscard]] int sides(double radius) const {
    return static_cast<int>(std::ceil(std::numbers::pi / std::acos(1 - off / radius)));
  }
};

inline void add_segment(TriangleMesh& mesh, const Vec3d& a, const Vec3d& b) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b});
  mesh.segments.push_back({first, first + 1});
}

inline void add_quad(TriangleMesh& mesh, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  for (const auto& t : {std::array{0U, 1U, 2U}, std::array{0U, 2U, 3U}}) {
    const std::array<Vec3d, 3> at{mesh.vertices[first + t[0]], mesh.vertices[first + t[1]],
                                  mesh.vertices[first + t[2]]};
    if (!(length(cross(at[1] - at[0], at[2] - at[0])) > 0)) continue;
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

// ---- Prisms ----

/// A point of the axis of a planar region, and one of its footprints.
struct Rib {
  Point2 wall, middle;
  [[nodiscard]] double depth() const { return std::hypot(middle[0] - wall[0], middle[1] - wall[1]); }
  [[nodiscard]] Vec3d at(double depth_there, double z) const {
    const double share = depth() > 0 ? depth_there / depth() : 0;
    return {wall[0] + share * (middle[0] - wall[0]), wall[1] + share * (middle[1] - wall[1]), z};
  }
};

/// The axis of a prism that extends a planar region up and down. Ribs describe the axis of the region. The separation
/// angles are 90 degrees or more, or those of the region's walls.
class PrismAxis {
 public:
  PrismAxis(ExactAxis& out, double half) : out_(out), half_(half) {}

  /// Adds the axis between two neighbouring ribs. If both have the same wall point, it is a reflex corner.
  void add(const Rib& a, const Rib& b) {
    const double over_a = a.depth() - half_;
    const double over_b = b.depth() - half_;
    if ((over_a < -1e-12 && over_b > 1e-12) || (over_a > 1e-12 && over_b < -1e-12)) {
      const double t = over_a / (over_a - over_b);
      const auto mixed = [t](const Point2& p, const Point2& q) {
        return Point2{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])};
      };
      const Rib between{mixed(a.wall, b.wall), mixed(a.middle, b.middle)};
      add(a, between);
      add(between, b);
      return;
    }
    const double da = std::min(half_, a.depth());
    const double db = std::min(half_, b.depth());
    for (const double side : {-1.0, 1.0}) {
      add_quad(out_.axis, a.at(0, side * half_), b.at(0, side * half_), b.at(db, side * (half_ - db)),
               a.at(da, side * (half_ - da)));
      if (squared_length(a.at(0, 0) - b.at(0, 0)) > 0) {
        add_segment(out_.rims, a.at(0, side * half_), b.at(0, side * half_));
      }
      add_segment(out_.seams, a.at(da, side * (half_ - da)), b.at(db, side * (half_ - db)));
    }
    add_quad(out_.axis, a.at(da, 0), b.at(db, 0), b.at(b.depth(), 0), a.at(a.depth(), 0));
    if (da < half_ || db < half_) {
      add_quad(out_.axis, a.at(da, half_ - da), b.at(db, half_ - db), b.at(db, db - half_), a.at(da, da - half_));
    }
  }
  /// Adds the seam at which three or more lines of the region's axis meet.
  void add_branch(const Point2& at, double depth) {
    if (depth < half_) add_segment(out_.seams, {at[0], at[1], depth - half_}, {at[0], at[1], half_ - depth});
  }
  /// Adds the upright rim at a convex corner of the region.
  void add_corner(const Point2& at) { add_segment(out_.rims, {at[0], at[1], -half_}, {at[0], at[1], half_}); }

 private:
  ExactAxis& out_;
  double half_;
};

/// Adds the axis between two ribs whose ends move along lines.
inline void add_straight(PrismAxis& prism, const Point2& wall_a, const Point2& middle_a, const Point2& wall_b,
                         const Point2& middle_b) {
  prism.add({wall_a, middle_a}, {wall_b, middle_b});
}

inline ExactAxis exact_box(double a, double b, double half) {
  ExactAxis out;
  out.solid = make_box({.size = {2 * a, 2 * b, 2 * half}});
  PrismAxis prism(out, half);
  const double end = a - b;  // a >= b
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      add_straight(prism, {0, y * b}, {0, 0}, {x * end, y * b}, {x * end, 0});
      add_straight(prism, {x * end, y * b}, {x * end, 0}, {x * a, y * b}, {x * a, y * b});
      add_straight(prism, {x * a, 0}, {x * end, 0}, {x * a, y * b}, {x * a, y * b});
      prism.add_corner({x * a, y * b});
    }
    prism.add_branch({x * end, 0}, b);
  }
  return out;
}

inline ExactAxis exact_l(double half) {
  ExactAxis out;
  out.solid = make_extrusion(l_outline(), {}, {.thickness = 2 * half});
  PrismAxis prism(out, half);
  const double meet = 2 - std::numbers::sqrt2;
  for (const bool mirrored : {false, true}) {
    const auto p = [mirrored](double s, double t) { return mirrored ? Point2{t, s} : Point2{s, t}; };
    add_straight(prism, p(0, 0), p(0, 0), p(meet, 0), p(meet, meet));
    constexpr int parts = 512;
    for (int k = 0; k < parts; ++k) {
      const auto on_parabola = [&](int n) {
        const double s = meet + (1 - meet) * n / parts;
        return std::pair{s, 0.5 * (1 + (s - 1) * (s - 1))};
      };
      const auto [s, t] = on_parabola(k);
      const auto [u, v] = on_parabola(k + 1);
      add_straight(prism, p(s, 0), p(s, t), p(u, 0), p(u, v));
      add_straight(prism, p(1, 1), p(s, t), p(1, 1), p(u, v));
    }
    for (const double wall : {0.0, 1.0}) {
      add_straight(prism, p(1, wall), p(1, 0.5), p(2.5, wall), p(2.5, 0.5));
      add_straight(prism, p(2.5, wall), p(2.5, 0.5), p(3, wall), p(3, wall));
      add_straight(prism, p(3, 0.5), p(2.5, 0.5), p(3, wall), p(3, wall));
      prism.add_corner(p(3, wall));
    }
    prism.add_branch(p(2.5, 0.5), 0.5);
  }
  prism.add_branch({meet, meet}, meet);
  prism.add_corner({0, 0});
  return out;
}

/// A prism over a regular polygon of radius 1.
inline ExactAxis exact_polygon(int corners, double half) {
  ExactAxis out;
  std::vector<Point2> outline;
  for (int k = 0; k < corners; ++k) {
    const double turn = 2 * std::numbers::pi * k / corners;
    outline.push_back({std::cos(turn), std::sin(turn)});
  }
  out.solid = make_extrusion(outline, {}, {.thickness = 2 * half});
  PrismAxis prism(out, half);
  for (int k = 0; k < corners; ++k) {
    const Point2& a = outline[static_cast<std::size_t>(k)];
    const Point2& b = outline[static_cast<std::size_t>((k + 1) % corners)];
    const Point2 between{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    add_straight(prism, a, a, between, {0, 0});
    add_straight(prism, between, {0, 0}, b, b);
    prism.add_corner(a);
  }
  prism.add_branch({0, 0}, std::cos(std::numbers::pi / corners));
  return out;
}

// ---- Solids of revolution ----

/// Distance from the axis of revolution, and along it.
struct ProfilePoint {
  double r = 0, z = 0;
  [[nodiscard]] Vec3d at(double turn) const { return {r * std::cos(turn), r * std::sin(turn), z}; }
};

constexpr int turns_of_axis = 720;

inline void add_revolved(TriangleMesh& mesh, const ProfilePoint& a, const ProfilePoint& b) {
  for (int k = 0; k < turns_of_axis; ++k) {
    const double from = 2 * std::numbers::pi * k / turns_of_axis;
    const double to = 2 * std::numbers::pi * (k + 1) / turns_of_axis;
    add_quad(mesh, a.at(from), a.at(to), b.at(to), b.at(from));
  }
}

inline void add_circle(TriangleMesh& mesh, const ProfilePoint& p) {
  for (int k = 0; k < turns_of_axis; ++k) {
    add_segment(mesh, p.at(2 * std::numbers::pi * k / turns_of_axis),
                p.at(2 * std::numbers::pi * (k + 1) / turns_of_axis));
  }
}

/// The closed surface of revolution of a profile that begins and ends at the axis of revolution (r = 0).
/// The profile starts at the lower end and runs outwards, with the solid on its left.
inline TriangleMesh revolved(const std::vector<ProfilePoint>& profile, int sides) {
  TriangleMesh mesh;
  const auto rings = static_cast<std::uint32_t>(profile.size() - 2);
  const auto around = static_cast<std::uint32_t>(sides);
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sides; ++k) {
      mesh.vertices.push_back(profile[ring + 1].at(2 * std::numbers::pi * k / sides));
    }
  }
  const std::uint32_t lower = rings * around;
  const std::uint32_t upper = lower + 1;
  mesh.vertices.push_back({0, 0, profile.front().z});
  mesh.vertices.push_back({0, 0, profile.back().z});
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around;
    mesh.triangles.push_back({lower, next, k});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t a = ring * around + k;
      const std::uint32_t b = ring * around + next;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
    mesh.triangles.push_back({upper, (rings - 1) * around + k, (rings - 1) * around + next});
  }
  return mesh;
}

/// If the cylinder is wider than high, the axis is a disc, and cones from its border seam to both edges. Else it is a
/// segment, and cones from its ends.
inline ExactAxis exact_cylinder(double radius, double half, const Fineness& fineness) {
  ExactAxis out;
  out.solid = make_cylinder({.radius = radius, .height = 2 * half, .sides = fineness.sides(radius)});
  const double deep = std::min(radius, half);
  for (const double side : {-1.0, 1.0}) {
    add_revolved(out.axis, {radius, side * half}, {radius - deep, side * (half - deep)});
    add_circle(out.rims, {radius, side * half});
  }
  if (radius > half) {
    add_revolved(out.axis, {radius - deep, 0}, {0, 0});
    add_circle(out.seams, {radius - deep, 0});
  } else {
    add_segment(out.axis, {0, 0, deep - half}, {0, 0, half - deep});
    out.tube_radius = radius;
  }
  return out;
}

/// A cone of radius r and height h, with its base at z = 0. A is the half angle at its tip: tan A = r / h. The segment
/// in the middle has the separation angle 180 - 2 A. The sheet between base and lateral surface has 90 + A. This sheet
/// runs from the edge of the base to the centre of the inscribed ball, at height rho = r h / (r + sqrt(r^2 + h^2)).
inline ExactAxis exact_cone(double radius, double height, const Fineness& fineness) {
  ExactAxis out;
  out.solid = revolved({{0, 0}, {radius, 0}, {0, height}}, fineness.sides(radius));
  const double rho = radius * height / (radius + std::hypot(radius, height));
  add_revolved(out.axis, {radius, 0}, {0, rho});
  add_circle(out.rims, {radius, 0});
  add_segment(out.axis, {0, 0, rho}, {0, 0, height});
  return out;
}

/// A cylinder with half balls on both ends. Its axis is the segment between their centres.
inline ExactAxis exact_capsule(double radius, double half, const Fineness& fineness) {
  ExactAxis out;
  const int sides = fineness.sides(radius);
  const int quarter = (sides + 3) / 4;
  std::vector<ProfilePoint> profile;
  for (const double end : {-1.0, 1.0}) {
    for (int k = 0; k <= quarter; ++k) {
      const double turn = 0.5 * std::numbers::pi * (end < 0 ? quarter - k : k) / quarter;
      const bool is_tip = (end < 0 && k == 0) || (end > 0 && k == quarter);
      profile.push_back({is_tip ? 0 : radius * std::cos(turn), end * (half + radius * std::sin(turn))});
    }
  }
  out.solid = revolved(profile, 4 * quarter);
  add_segment(out.axis, {0, 0, -half}, {0, 0, half});
  out.tube_radius = radius;
  return out;
}

/// The axis of a torus is its core circle.
inline ExactAxis exact_torus(double ring, double tube, const Fineness& fineness) {
  ExactAxis out;
  out.solid = make_torus({.ring_radius = ring,
                          .tube_radius = tube,
                          .ring_segments = fineness.sides(ring + tube),
                          .tube_segments = fineness.sides(tube)});
  add_circle(out.axis, {ring, 0});
  out.tube_radius = tube;
  return out;
}

/// The end of the theta-axis of an ellipse with half axes 1 and b: x = s (1 - b^2). The parameter s solves
/// tan(theta / 2) = sqrt(1 - s^2) / (b s); see on_ellipse().
inline double end_of_ellipse(double b, double theta) {
  const double slope = std::tan(0.5 * theta / degrees);
  const double s = 1 / std::sqrt(1 + b * b * slope * slope);
  return s * (1 - b * b);
}

inline int frequency_for(const Fineness& fineness) {
  // Edges of a geodesic sphere are at most 1.2 / frequency long; facets of edges e are e^2 / 6 off.
  return static_cast<int>(std::ceil(1.2 / std::sqrt(6 * fineness.off)));
}

inline ExactAxis exact_prolate(double b, double theta, const Fineness& fineness) {
  ExactAxis out;
  out.solid = make_ellipsoid({.radii = {1, b, b}, .frequency = frequency_for(fineness)});
  const double end = end_of_ellipse(b, theta);
  add_segment(out.axis, {-end, 0, 0}, {end, 0, 0});
  return out;
}

inline ExactAxis exact_oblate(double b, double theta, const Fineness& fineness) {
  ExactAxis out;
  out.solid = make_ellipsoid({.radii = {1, 1, b}, .frequency = frequency_for(fineness)});
  const double end = end_of_ellipse(b, theta);
  add_revolved(out.axis, {0, 0}, {end, 0});
  add_circle(out.rims, {end, 0});
  return out;
}

struct ExactCase {
  std::string name;
  double size = 0;  ///< length of the longest side
  std::function<ExactAxis(double theta, const Fineness& fineness)> make;
};

inline std::vector<ExactCase> exact_cases() {
  using F = const Fineness&;
  return {{"Box", 1.5, [](double, F) { return exact_box(0.75, 0.5, 0.3); }},
          {"TallBox", 1.4, [](double, F) { return exact_box(0.45, 0.3, 0.7); }},
          {"FlatL", 3, [](double, F) { return exact_l(0.3); }},
          {"TallL", 3, [](double, F) { return exact_l(0.9); }},
          {"Pentagon", 2, [](double, F) { return exact_polygon(5, 0.4); }},
          {"Triangle", 1.75, [](double, F) { return exact_polygon(3, 0.3); }},
          {"Disc", 2, [](double, F fine) { return exact_cylinder(1, 0.35, fine); }},
          {"Rod", 2, [](double, F fine) { return exact_cylinder(0.4, 1, fine); }},
          {"Cone", 1.5, [](double, F fine) { return exact_cone(0.6, 1.5, fine); }},
          {"WideCone", 2, [](double, F fine) { return exact_cone(1, 1.2, fine); }},
          {"Capsule", 2.4, [](double, F fine) { return exact_capsule(0.5, 0.7, fine); }},
          {"Torus", 2.8, [](double, F fine) { return exact_torus(1, 0.4, fine); }},
          {"Prolate", 2, [](double theta, F fine) { return exact_prolate(0.5, theta, fine); }},
          {"Oblate", 2, [](double theta, F fine) { return exact_oblate(0.4, theta, fine); }}};
}

/// Points on segments and triangles. Neighbours are at most a step apart.
inline std::vector<Vec3d> points_on(const MeshView& shape, double step) {
  std::vector<Vec3d> points;
  for (const auto& [a, b] : shape.segments) {
    const Vec3d way = shape.vertices[b] - shape.vertices[a];
    const int parts = static_cast<int>(std::ceil(length(way) / step));
    for (int k = 0; k <= parts; ++k) {
      points.push_back(shape.vertices[a] + way * (parts > 0 ? static_cast<double>(k) / parts : 0));
    }
  }
  for (const auto& [a, b, c] : shape.triangles) {
    const Vec3d& at = shape.vertices[a];
    const Vec3d u = shape.vertices[b] - at;
    const Vec3d v = shape.vertices[c] - at;
    const int rows = std::max(1, static_cast<int>(std::ceil(std::max(length(u), length(v)) / step)));
    for (int i = 0; i <= rows; ++i) {
      const Vec3d from = at + u * (static_cast<double>(i) / rows);
      const Vec3d way = (v - u) * (static_cast<double>(i) / rows);
      const int parts = static_cast<int>(std::ceil(length(way) / step));
      for (int k = 0; k <= parts; ++k) points.push_back(from + way * (parts > 0 ? static_cast<double>(k) / parts : 0));
    }
  }
  return points;
}

}  // namespace blum::test
