// Example: a scene of meshes that move: how far apart they are, what meets, how deep, and when.
#include <iostream>
#include <optional>

#include "blum/core/error.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"

int main() try {
  // A ring around the z axis, and a ball in the middle of its hole. The scene keeps copies.
  blum::ProximityScene scene;
  const blum::ObjectId ring = scene.add(blum::make_torus({.ring_radius = 1, .tube_radius = 0.3}));
  const blum::ObjectId ball = scene.add(blum::make_sphere({.radius = 0.5}));

  // 1 - 0.3 - 0.5, but for the facets.
  const std::optional<blum::PrimitivePair> closest = scene.separation(ring, ball);
  if (!closest) return 1;
  std::cout << "apart by " << closest->between.distance << ", between triangles " << closest->first << " and "
            << closest->second << '\n';

  // Moved by 0.3, the ball lies in the ring by about 0.1.
  scene.update(ball, blum::RigidTransform{.rotation = {}, .translation = {0.3, 0, 0}});
  std::cout << "moved: " << scene.collisions().pairs.size() << " pairs of triangles meet\n";
  for (const blum::Penetration& part : scene.penetration(ball, ring).parts) {
    std::cout << "in each other by " << part.depth << " to " << part.depth_bound << "; move the ball along ("
              << part.direction.x << ", " << part.direction.y << ", " << part.direction.z << ")\n";
  }

  // A larger ball falls from z = 2 to z = -2, through a hole that it does not fit. At neither end does it touch the
  // ring. It does first where 1 + z^2 = (0.8 + 0.3)^2: at z = 0.458, after 0.385 of the way.
  scene.update(ball, blum::make_sphere({.radius = 0.8}).view());
  scene.update(ball, blum::RigidTransform{.rotation = {}, .translation = {0, 0, 2}});
  const blum::ObjectMotion fall{.object = ball,
                                .place = blum::RigidTransform{.rotation = {}, .translation = {0, 0, -2}}};
  const std::optional<double> time = scene.continuous({&fall, 1}).earliest();
  if (!time) return 1;
  std::cout << "falling: first contact after " << *time << " of the way\n";
  return *time > 0.38 && *time < 0.4 ? 0 : 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
