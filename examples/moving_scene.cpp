// Example: distances, collisions, penetration depths and contact times in a scene of moving meshes.
#include <iostream>
#include <optional>

#include "blum/core/error.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"

int main() try {
  // A ring lies around the z axis, with a ball in the middle of its hole. The scene keeps copies of both.
  blum::ProximityScene scene;
  const blum::ObjectId ring = scene.add(blum::make_torus({.ring_radius = 1, .tube_radius = 0.3}));
  const blum::ObjectId ball = scene.add(blum::make_sphere({.radius = 0.5}));

  // The distance is 1 - 0.3 - 0.5, except for the facets.
  const std::optional<blum::PrimitivePair> closest = scene.separation(ring, ball);
  if (!closest) return 1;
  std::cout << "distance " << closest->between.distance << ", between triangles " << closest->first << " and "
            << closest->second << '\n';

  // After a move by 0.3, the ball penetrates the ring by about 0.1.
  scene.update(ball, blum::RigidTransform{.rotation = {}, .translation = {0.3, 0, 0}});
  std::cout << "after a move: " << scene.collisions().pairs.size() << " pairs of triangles meet\n";
  for (const blum::Penetration& part : scene.penetration(ball, ring).parts) {
    std::cout << "penetration depth " << part.depth << " to " << part.depth_bound << "; move the ball along ("
              << part.direction.x << ", " << part.direction.y << ", " << part.direction.z << ")\n";
  }

  // A larger ball falls from z = 2 to z = -2, through a hole that is too narrow. The ball touches the ring at neither
  // end. First contact is at 1 + z^2 = (0.8 + 0.3)^2, that is z = 0.458, after 0.385 of the way.
  scene.update(ball, blum::make_sphere({.radius = 0.8}).view());
  scene.update(ball, blum::RigidTransform{.rotation = {}, .translation = {0, 0, 2}});
  const blum::ObjectMotion fall{.object = ball,
                                .place = blum::RigidTransform{.rotation = {}, .translation = {0, 0, -2}}};
  const std::optional<double> time = scene.continuous({&fall, 1}).earliest();
  if (!time) return 1;
  std::cout << "first contact after " << *time << " of the fall\n";
  return *time > 0.38 && *time < 0.4 ? 0 : 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
