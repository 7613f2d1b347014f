// Blum: solids whose medial axes are known, for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"

namespace blum::test {

inline constexpr double degrees = 180 / std::numbers::pi;

/// A point of the exact axis.
struct KnownSample {
  Vec3d position;
  double radius = 0;
  double angle = 0;  ///< separation angle, degrees
};

/// A solid and samples of its exact axis. Each point of the axis is at most `step` away from a sample.
struct KnownAxis {
  TriangleMesh mesh;
  std::vector<KnownSample> axis;
  double step = 0;
};

// ---- Prisms: solids below and above a planar region ----

/// A planar region: the depth of points in it (negative outside), and its medial axis.
struct Region {
  std::function<double(const Point2&)> depth;
  Point2 lower;
  Point2 upper;
  struct OnAxis {
    Point2 at;
    double angle = 0;
  };
  std::vector<OnAxis> axis;
};

inline void add_line(Region& region, const Point2& from, const Point2& to, double angle, double step) {
  const double size = std::hypot(to[0] - from[0], to[1] - from[1]);
  const int parts = static_cast<int>(std::ceil(size / step)) + 1;
  for (int k = 0; k <= parts; ++k) {
    const double t = static_cast<double>(k) / parts;
    region.axis.push_back({{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])}, angle});
  }
}

/// The axis of a prism with half height `half`. Each point has footprints on walls only, on both lids, or on a wall and
/// a lid, which are perpendicular.
inline std::vector<KnownSample> axis_of_prism(const Region& region, double half, double step) {
  std::vector<KnownSample> axis;
  for (const Region::OnAxis& s : region.axis) {
    const double depth = region.depth(s.at);
    if (depth > half) continue;
    const int parts = static_cast<int>(std::ceil(2 * (half - depth) / step)) + 1;
    for (int k = 0; k <= parts; ++k) {
      const double z = (half - depth) * (2.0 * k / parts - 1);
      axis.push_back({{s.at[0], s.at[1], z}, depth, s.angle});
    }
  }
  for (double x = region.lower[0]; x <= region.upper[0]; x += step) {
    for (double y = region.lower[1]; y <= region.upper[1]; y += step) {
      const double depth = region.depth({x, y});
      if (depth < 0) continue;
      if (depth >= half) {
        axis.push_back({{x, y, 0}, half, 180});
      } else {
        for (const double z : {depth - half, half - depth}) axis.push_back({{x, y, z}, depth, 90});
      }
    }
  }
  return axis;
}

inline Region rectangle(double width, double depth, double step) {
  Region region;
  const double a = 0.5 * width;
  const double b = 0.5 * depth;
  region.lower = {-a, -b};
  region.upper = {a, b};
  region.depth = [a, b](const Point2& p) { return std::min(a - std::abs(p[0]), b - std::abs(p[1])); };
  const double end = a - b;  // width >= depth
  add_line(region, {-end, 0}, {end, 0}, 180, step);
  for (const double side : {-1.0, 1.0}) {
    for (const double up : {-1.0, 1.0}) add_line(region, {side * a, up * b}, {side * end, 0}, 90, step);
  }
  return region;
}

inline KnownAxis known_box(const Vec3d& size, double step) {
  return {make_box({.size = size}), axis_of_prism(rectangle(size.x, size.y, step), 0.5 * size.z, step), step};
}

inline KnownAxis known_cylinder(double radius, double height, double step) {
  Region region;
  region.lower = {-radius, -radius};
  region.upper = {radius, radius};
  region.depth = [radius](const Point2& p) { return radius - std::hypot(p[0], p[1]); };
  region.axis = {{{0, 0}, 180}};
  return {make_cylinder({.radius = radius, .height = height, .sides = 192}), axis_of_prism(region, 0.5 * height, step),
          step};
}

inline const std::vector<Point2>& l_outline() {
  static const std::vector<Point2> outline = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  return outline;
}

/// Adds the half of the L's axis that belongs to one arm.
inline void add_arm(Region& region, std::size_t along, double step) {
  const auto point = [&](double s, double t) { return along == 0 ? Point2{s, t} : Point2{t, s}; };
  const double meet = 2 - std::numbers::sqrt2;  // equally far from two outer walls and from the inner corner
  for (double s = meet; s <= 1; s += step) {
    // A parabola: its focus is the inner corner (1, 1), its directrix the outer wall.
    const double t = 0.5 * (1 + (s - 1) * (s - 1));
    region.axis.push_back({point(s, t), 180 - degrees * std::atan2(1 - s, 1 - t)});
  }
  add_line(region, point(1, 0.5), point(2.5, 0.5), 180, step);
  add_line(region, point(2.5, 0.5), point(3, 0), 90, step);
  add_line(region, point(2.5, 0.5), point(3, 1), 90, step);
  add_line(region, point(0, 0), point(meet, meet), 90, step);
}

inline KnownAxis known_l_beam(double thickness, double step) {
  Region region;
  region.lower = {0, 0};
  region.upper = {3, 3};
  region.depth = [](const Point2& p) {
    const double to_outer_walls = std::min({p[0], p[1], 3 - p[0], 3 - p[1]});
    if (p[0] > 1 && p[1] > 1) return -1.0;
    if (p[0] > 1) return std::min(to_outer_walls, 1 - p[1]);
    if (p[1] > 1) return std::min(to_outer_walls, 1 - p[0]);
    return std::min(to_outer_walls, std::hypot(1 - p[0], 1 - p[1]));
  };
  add_arm(region, 0, step);
  add_arm(region, 1, step);
  return {make_extrusion(l_outline(), {}, {.thickness = thickness}), axis_of_prism(region, 0.5 * thickness, step),
          step};
}

// ---- Round solids ----

/// Facets lie less than 0.0001 inside the ball, so that they do not affect the measured axis.
inline KnownAxis known_ball(double step) {
  return {make_sphere({.frequency = 48}), {{{0, 0, 0}, 1, 180}}, step};
}

/// A point of the axis of an ellipse with half axes 1 and b, with its radius and separation angle. The normal at (s, t)
/// meets the long axis at s (1 - b^2).
inline KnownSample on_ellipse(double b, double s) {
  const double x = s * (1 - b * b);
  const double t = b * std::sqrt(std::max(0.0, 1 - s * s));
  return {{x, 0, 0}, std::hypot(s - x, t), 2 * degrees * std::atan2(t, std::abs(s - x))};
}

/// An ellipsoid of revolution around its long axis. Its medial axis is a segment.
inline KnownAxis known_prolate(double step) {
  KnownAxis known{make_ellipsoid({.radii = {1, 0.5, 0.5}, .frequency = 64}), {}, step};
  for (double s = -1; s <= 1; s += step) known.axis.push_back(on_ellipse(0.5, s));
  return known;
}

/// An ellipsoid of revolution around its short axis. Its medial axis is a disc. Curvature is largest at the rim, where
/// the separation angle is smallest. At resolution 256, the rim at 40 degrees is 1.02 diagonals off with
/// facets of 1/64. With facets of 1/96 or less, it is off by at most one diagonal.
inline KnownAxis known_oblate(double step) {
  KnownAxis known{make_ellipsoid({.radii = {1, 1, 0.4}, .frequency = 128}), {}, step};
  for (double s = 0; s <= 1; s += step) {
    const KnownSample sample = on_ellipse(0.4, s);
    const int around = static_cast<int>(std::ceil(2 * std::numbers::pi * sample.position.x / step)) + 1;
    for (int k = 0; k < around; ++k) {
      const double turn = 2 * std::numbers::pi * k / around;
      const Vec3d direction{std::cos(turn), std::sin(turn), 0};
      known.axis.push_back({direction * sample.position.x, sample.radius, sample.angle});
    }
  }
  return known;
}

struct KnownCase {
  std::string name;
  std::function<KnownAxis(double step)> make;
};

inline std::vector<KnownCase> known_cases() {
  return {{"FlatBox", [](double step) { return known_box({1.5, 1, 0.6}, step); }},
          {"TallBox", [](double step) { return known_box({0.9, 0.6, 1.4}, step); }},
          {"Rod", [](double step) { return known_cylinder(0.4, 2, step); }},
          {"Disc", [](double step) { return known_cylinder(1, 0.7, step); }},
          {"FlatL", [](double step) { return known_l_beam(0.6, step); }},
          {"TallL", [](double step) { return known_l_beam(1.8, step); }},
          {"Ball", known_ball},
          {"Prolate", known_prolate},
          {"Oblate", known_oblate}};
}

inline std::vector<KnownSample> above(const std::vector<KnownSample>& axis, double theta) {
  std::vector<KnownSample> kept;
  std::copy_if(axis.begin(), axis.end(), std::back_inserter(kept),
               [&](const KnownSample& s) { return s.angle > theta; });
  return kept;
}

inline TriangleMesh cloud(const std::vector<KnownSample>& axis) {
  TriangleMesh mesh;
  for (const KnownSample& sample : axis) {
    mesh.points.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(sample.position);
  }
  return mesh;
}

}  // namespace blum::test
