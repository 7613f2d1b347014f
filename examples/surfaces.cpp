// Example: distances over surfaces: clearance of two parts as a texture, wall thickness, and a Hausdorff distance.
//
//   surfaces [PART OTHER]     reads two meshes, or makes a torus and a ball
#include <algorithm>
#include <iostream>
#include <vector>

#include "blum/io/mesh_io.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/surface_map/hausdorff_distance.hpp"
#include "blum/surface_map/surface_distance_map.hpp"
#include "blum/surface_map/thickness.hpp"

int main(int argc, char** argv) {
  const blum::TriangleMesh part = argc > 2 ? blum::read_mesh(argv[1]) : blum::make_shape("torus");
  const blum::TriangleMesh other = argc > 2 ? blum::read_mesh(argv[2]) : blum::make_shape("sphere", {{"radius", 0.5}});

  // The texture holds the distance from each point of this part to the other part.
  const blum::SurfaceMap map = blum::surface_distance_map(part, other, {.texel = 0.02});
  const std::size_t closest = map.closest_texel().value();
  const blum::Vec3d at = blum::surface_point(part, *map.atlas, closest);
  std::cout << map.atlas->width << " x " << map.atlas->height << " texels; the smallest distance of a texel is "
            << map.distance[closest] << ", at " << at.x << ' ' << at.y << ' ' << at.z << "\n"
            << "largest error between texels: " << *std::max_element(map.error.begin(), map.error.end()) << '\n';

  // The thickness at a triangle is the diameter of the largest inner ball that touches the triangle.
  const std::vector<blum::Thickness> walls = blum::thickness(part, {.kind = blum::ThicknessKind::ball});
  double thinnest = walls[0].thickness;
  for (const blum::Thickness& wall : walls) thinnest = std::min(thinnest, wall.thickness);
  std::cout << "smallest thickness: " << thinnest << '\n';

  // The Hausdorff distance is the largest distance from a point of one surface to the other. Two bounds enclose it.
  const blum::HausdorffDistance apart = blum::hausdorff_distance(part, other, {.tolerance = 1e-6});
  std::cout << "Hausdorff distance " << apart.lower << " to " << apart.upper << '\n';
}
