#include "scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "blum/shapes/generators.hpp"

namespace simulations {
namespace {

using blum::TriangleMesh;
using blum::Vec3d;

constexpr double pi = std::numbers::pi;

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.vertices) p += by;
  return mesh;
}

Vec3d turned(const Vec3d& p, double angle) {
  return {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
}

/// Triangles of a grid that closes around an axis.
std::vector<blum::Triangle> around(std::uint32_t rows, std::uint32_t columns) {
  std::vector<blum::Triangle> out;
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t next = (column + 1) % columns;
      const std::uint32_t a = row * columns + column, b = row * columns + next;
      const std::uint32_t c = a + columns, d = b + columns;
      out.push_back({a, b, c});
      out.push_back({b, d, c});
    }
  }
  return out;
}

/// An ellipsoid in a skirt; the uppermost row of the skirt moves with the body.
class Cloth : public Scene {
 public:
  Cloth() : Scene({.thickness = 0.008, .iterations = 20}) {
    body_ = blum::make_ellipsoid({.radii = {0.35, 0.28, 0.6}, .frequency = 14});
    Object body;
    body.mesh = body_;
    body.kind = Kind::driven;
    world.add(std::move(body));
    constexpr std::uint32_t rows = 28;
    constexpr std::uint32_t columns = 96;
    Object skirt;
    for (std::uint32_t row = 0; row < rows; ++row) {
      const double down = static_cast<double>(row) / (rows - 1);
      for (std::uint32_t column = 0; column < columns; ++column) {
        const double angle = 2 * pi * column / columns;
        const double wide = 1.06 + 1.1 * down;
        skirt.mesh.vertices.push_back(
            {0.35 * wide * std::cos(angle), 0.29 * wide * std::sin(angle), 0.1 - 0.55 * down});
      }
    }
    skirt.mesh.triangles = around(rows, columns);
    skirt.kind = Kind::cloth;
    skirt.self = true;
    skirt.springs = springs_of(skirt.mesh, 0.05);
    skirt.pinned.assign(skirt.mesh.vertices.size(), false);
    std::fill_n(skirt.pinned.begin(), columns, true);
    skirt_ = skirt.mesh.vertices;
    world.add(std::move(skirt));
  }

  void drive(double time, const StepReport&) override {
    const double ease = std::min(1.0, 2 * time);
    const double angle = ease * 1.0 * std::sin(5 * time);
    const Vec3d by{ease * 0.25 * std::sin(3.2 * time), 0, ease * 0.1 * std::sin(6.4 * time)};
    world.object(0).goal = placed(body_, angle, by);
    world.object(1).goal = placed({skirt_}, angle, by);
  }

 private:
  static std::vector<Vec3d> placed(const TriangleMesh& rest, double angle, const Vec3d& by) {
    std::vector<Vec3d> out;
    for (const Vec3d& p : rest.vertices) out.push_back(turned(p, angle) + by);
    return out;
  }

  TriangleMesh body_;
  std::vector<Vec3d> skirt_;
};

class Bowl : public Scene {
 public:
  // Contacts are at most a few edge lengths wide. Otherwise each triangle would touch dozens of others.
  Bowl(int bodies, int frequency) : Scene({.thickness = std::min(0.012, 0.12 / frequency)}) {
    Object bowl;
    bowl.mesh = bowl_mesh();
    bowl.kind = Kind::driven;
    world.add(std::move(bowl));
    for (int k = 0; k < bodies; ++k) {
      Object one;
      // Each level has two bodies on opposite sides.
      const int level = k / 2;
      const double angle = pi * (k % 2) + 0.8 * level;
      one.mesh = moved(shape(k, frequency), {0.28 * std::cos(angle), 0.28 * std::sin(angle), 0.1 + 0.46 * level});
      one.velocity.assign(one.mesh.vertices.size(), {0, 0, -2});
      world.add(std::move(one));
    }
  }

 private:
  /// Balls, rings, boxes and lumps in turn, each about 0.4 wide.
  static TriangleMesh shape(int k, int frequency) {
    switch (k % 4) {
      case 0:
        return blum::make_sphere({.radius = 0.2, .frequency = frequency});
      case 1:
        return blum::make_torus(
            {.ring_radius = 0.17, .tube_radius = 0.07, .ring_segments = 5 * frequency, .tube_segments = 2 * frequency});
      case 2: {
        const int parts = std::max(1, static_cast<int>(std::lround(1.29 * frequency)));
        TriangleMesh box = blum::make_box({.size = {0.32, 0.28, 0.24}, .segments = {parts, parts, parts}});
        return moved(box, -blum::bounds(box).center());
      }
      default:
        return blum::make_organic({.radius = 0.17, .frequency = frequency, .seed = static_cast<std::uint64_t>(k)});
    }
  }
  /// Half a sphere, open above.
  static TriangleMesh bowl_mesh() {
    constexpr std::uint32_t rows = 20;
    constexpr std::uint32_t columns = 48;
    TriangleMesh mesh;
    for (std::uint32_t row = 0; row < rows; ++row) {
      const double down = 0.02 + (pi / 2 + 0.25 - 0.02) * row / (rows - 1);
      for (std::uint32_t column = 0; column < columns; ++column) {
        const double angle = 2 * pi * column / columns;
        mesh.vertices.push_back(
            {0.9 * std::sin(down) * std::cos(angle), 0.9 * std::sin(down) * std::sin(angle), -0.9 * std::cos(down)});
      }
    }
    mesh.triangles = around(rows, columns);
    const auto bottom = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({0, 0, -0.9});
    for (std::uint32_t column = 0; column < columns; ++column) {
      mesh.triangles.push_back({bottom, (column + 1) % columns, column});
    }
    return mesh;
  }
};

/// A wall of bricks with fine cracks between the bricks, on a floor.
class Breaking : public Scene {
 public:
  Breaking() : Scene({.step = 1.0 / 480, .thickness = 0.006, .iterations = 8, .friction = 0.02}) {
    Object floor;
    floor.mesh = moved(blum::make_box({.size = {5, 5, 0.2}, .segments = {5, 5, 1}}), {0, 0, -0.11});
    floor.kind = Kind::driven;
    world.add(std::move(floor));
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < 6; ++column) bricks_.push_back(brick(row, column));
    }
    Object wall;
    wall.mesh = all_of(bricks_);
    wall.self = true;
    wall_ = world.add(std::move(wall));
    Object ball;
    ball.mesh = moved(blum::make_sphere({.radius = 0.22, .frequency = 10}), {0.1, 1.6, 0.62});
    ball.mass = 4;
    ball.velocity.assign(ball.mesh.vertices.size(), {0, -6, 1.2});
    ball_ = world.add(std::move(ball));
  }

  /// Bricks close to the ball leave the wall, so the wall gets other triangles.
  void drive(double, const StepReport&) override {
    if (bricks_.empty()) return;
    const auto gap = world.scene().separation(world.object(wall_).id, world.object(ball_).id);
    if (!gap || gap->between.distance > 0.03) return;
    const Vec3d at = gap->between.first_point;
    const std::vector<Vec3d>& now = world.object(wall_).mesh.vertices;
    std::vector<TriangleMesh> staying;
    std::vector<TriangleMesh> leaving;
    std::size_t first = 0;
    for (TriangleMesh& one : bricks_) {
      std::copy_n(now.begin() + static_cast<std::ptrdiff_t>(first), one.vertices.size(), one.vertices.begin());
      first += one.vertices.size();
      const bool is_near = length(blum::bounds(one).center() - at) < 0.42;
      (is_near ? leaving : staying).push_back(one);
    }
    if (leaving.empty() || staying.empty()) return;
    bricks_ = staying;
    Object wall;
    wall.mesh = all_of(bricks_);
    wall.self = true;
    world.replace(wall_, std::move(wall));
    for (const TriangleMesh& one : leaving) {
      Object piece;
      piece.mesh = one;
      piece.mass = 0.5;
      world.add(std::move(piece));
    }
  }

 private:
  static TriangleMesh brick(int row, int column) {
    constexpr double crack = 0.013;
    const TriangleMesh one = blum::make_box({.size = {0.3 - crack, 0.2, 0.22 - crack}, .segments = {4, 3, 3}});
    const double shift = row % 2 == 0 ? 0 : 0.15;
    return moved(one, {-0.8 + 0.3 * column + shift, 0, 0.11 + 0.22 * row});
  }
  static TriangleMesh all_of(const std::vector<TriangleMesh>& parts) {
    TriangleMesh out;
    for (const TriangleMesh& part : parts) {
      const auto base = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.insert(out.vertices.end(), part.vertices.begin(), part.vertices.end());
      for (const auto& [a, b, c] : part.triangles) out.triangles.push_back({base + a, base + b, base + c});
    }
    return out;
  }

  std::vector<TriangleMesh> bricks_;
  std::size_t wall_ = 0;
  std::size_t ball_ = 0;
};

}  // namespace

std::unique_ptr<Scene> make_cloth_scene() {
  return std::make_unique<Cloth>();
}
std::unique_ptr<Scene> make_bowl_scene(int bodies, int frequency) {
  return std::make_unique<Bowl>(bodies, frequency);
}
std::unique_ptr<Scene> make_breaking_scene() {
  return std::make_unique<Breaking>();
}

}  // namespace simulations
