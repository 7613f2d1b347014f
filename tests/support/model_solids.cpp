#include "support/model_solids.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"

namespace blum::test {
namespace {

using Outline = std::vector<Point2>;

/// A mesh with a void: another mesh inside it, reversed.
TriangleMesh with_void(TriangleMesh outer, TriangleMesh inner) {
  inner.triangles = reversed_triangles(inner.triangles);
  append(outer, inner);
  return outer;
}

TriangleMesh extruded(const Outline& outline, double thickness, const std::vector<Outline>& holes = {}) {
  return make_extrusion(outline, holes, {.thickness = thickness});
}

Outline rectangle(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

/// A block with a slit from above. Little material remains at the bottom.
Outline slit(double width) {
  return {{-1, -1}, {1, -1}, {1, 1}, {width / 2, 1}, {width / 2, -0.9}, {-width / 2, -0.9}, {-width / 2, 1}, {-1, 1}};
}

/// A block with a pin on it.
Outline pin(double width) {
  return {{-1, -1},       {1, -1},         {1, -0.5},          {width / 2, -0.5},
          {width / 2, 1}, {-width / 2, 1}, {-width / 2, -0.5}, {-1, -0.5}};
}

/// A block with a notch that is a sharp groove.
Outline notch(double width) {
  return {{-1, -1}, {1, -1}, {1, 1}, {width / 2, 1}, {0.1, -0.8}, {-width / 2, 1}, {-1, 1}};
}

}  // namespace

TriangleMesh turned(const TriangleMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  std::array<double, 3> angles{};
  for (double& angle : angles) angle = random.uniform(0.1, 6);
  TriangleMesh out = mesh;
  for (Vec3d& p : out.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      const double c = std::cos(angles[axis]);
      const double s = std::sin(angles[axis]);
      const double at_u = c * p[u] - s * p[v];
      p[v] = s * p[u] + c * p[v];
      p[u] = at_u;
    }
  }
  return out;
}

TriangleMesh rounded(const TriangleMesh& mesh, double factor) {
  TriangleMesh out = mesh;
  for (Vec3d& p : out.vertices) p = {std::round(factor * p.x), std::round(factor * p.y), std::round(factor * p.z)};
  return out;
}

TriangleMesh random_star(Random& random, int frequency) {
  TriangleMesh out = make_sphere({.frequency = frequency});
  for (Vec3d& p : out.vertices) p *= random.uniform(0.3, 1);
  return out;
}

std::vector<NamedMesh> thin_solids() {
  std::vector<NamedMesh> out;
  const auto add = [&](std::string name, const TriangleMesh& mesh) {
    out.push_back({std::move(name), turned(mesh, out.size())});
  };
  add("box", make_box({.size = {2, 1, 0.5}}));
  add("thin box", make_box({.size = {2, 1, 1e-3}}));
  add("rod", make_box({.size = {2, 0.01, 0.01}}));
  for (const double angle : {60.0, 10.0, 1.0}) add("wedge", make_wedge({.angle = angle}));
  add("shell of boxes", with_void(make_box({.size = {2, 2, 2}}), make_box({.size = {1.98, 1.9, 1.99}})));
  for (const double inner : {0.5, 0.99, 0.9999}) {
    add("shell", with_void(make_sphere({.frequency = 3}), make_sphere({.radius = inner, .frequency = 3})));
  }
  add("small void", with_void(make_box({.size = {2, 2, 2}}), make_sphere({.radius = 0.01, .frequency = 1})));
  for (const double width : {0.3, 0.01, 1e-5}) {
    add("slit", extruded(slit(width), 1));
    add("pin", extruded(pin(width), 0.1));
    add("notch", extruded(notch(width), 1));
  }
  add("pinhole", extruded(rectangle(-1, -1, 2, 2), 0.2, {rectangle(0.3, 0.2, 0.01, 0.01)}));
  add("two pinholes",
      extruded(rectangle(-1, -1, 2, 2), 3, {rectangle(0.3, 0.2, 0.1, 0.1), rectangle(-0.3, 0, 0.1, 0.4)}));
  add("thin plate of holes", make_plate({.thickness = 0.01, .hole_segments = 8}));
  add("thin ring", make_torus({.tube_radius = 0.01, .ring_segments = 16, .tube_segments = 5}));
  Random random(17);
  for (const int frequency : {1, 2, 3, 4}) add("star", random_star(random, frequency));
  return out;
}

std::vector<NamedMesh> whole_solids() {
  std::vector<NamedMesh> out;
  const auto add = [&](const char* name, const TriangleMesh& mesh) {
    // Rounding may produce a solid that crosses itself.
    if (Solid::of(mesh).rule() == SolidRule::polyhedron) out.push_back({name, mesh});
  };
  add("box", make_box({.size = {2, 4, 6}, .segments = {1, 2, 3}}));
  add("box in box", with_void(make_box({.size = {6, 6, 6}}), make_box({.size = {2, 2, 2}})));
  add("sponge", rounded(make_menger({.level = 1}), 6));
  add("slit", rounded(extruded(slit(0.5), 1), 4));
  add("pin", rounded(extruded(pin(0.5), 1), 4));
  add("notch", rounded(extruded(notch(1), 1), 4));
  add("holes", rounded(extruded(rectangle(-5, -5, 10, 10), 2, {rectangle(-4, -4, 2, 2), rectangle(0, 0, 2, 4)}), 1));
  add("plate", rounded(make_plate({.hole_segments = 8}), 5));
  add("gear", rounded(make_gear({.teeth = 6, .openings = 0, .hole_segments = 6}), 8));
  Random random(19);
  for (int k = 0; k < 32; ++k) {
    const double factor = 2 + static_cast<double>(random.below(10));
    add("star", rounded(random_star(random, 1 + k % 3), factor));
    add("shell", rounded(with_void(random_star(random, 1), make_sphere({.radius = 0.29, .frequency = 1})), factor));
    add("ring", rounded(turned(make_torus({.tube_radius = 0.5, .ring_segments = 6, .tube_segments = 4}), random.bits()),
                        factor / 2));
    TriangleMesh t;
    t.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (int v = 0; v < 4; ++v) t.vertices.push_back(random.in_ball());
    add("tetrahedron", rounded(t, 3));
  }
  return out;
}

detail::GridPlanes planes_around(const TriangleMesh& mesh, const Vec3d& origin, double spacing, int spare) {
  const Box3 box = bounds(mesh);
  detail::Place first{};
  detail::Place last{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = static_cast<std::int32_t>(std::floor((box.lower[a] - origin[a]) / spacing)) - spare;
    last[a] = static_cast<std::int32_t>(std::floor((box.upper[a] - origin[a]) / spacing)) + 1 + spare;
  }
  return {origin, {spacing, spacing, spacing}, first, last};
}

}  // namespace blum::test
