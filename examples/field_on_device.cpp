// Example: fields on a graphics processor, or on the CPU if there is none.
#include <cstdint>
#include <iostream>
#include <string>

#include "blum/core/error.hpp"
#include "blum/field/device_field.hpp"
#include "blum/field/field.hpp"
#include "blum/shapes/shape_catalog.hpp"

int main() try {
  const blum::TriangleMesh mesh = blum::make_shape("torus_knot");
  const blum::GridSpec grid = blum::grid_around(blum::bounds(mesh), 64);

  // Uses the first CUDA device, or the CPU if there is none. Device::cuda() would throw instead.
  const blum::Field field = blum::distance_field(mesh, grid, {}, {.device = blum::Device::automatic()});
  std::cout << "computed on " << to_string(field.device) << '\n';

  // DeviceFieldSolver takes meshes in a device's memory and leaves fields there. The memory of a field may come from
  // cudaMalloc or from Blum. The work runs on your stream.
  try {
    blum::DeviceFieldSolver solver(grid, {.band = 0.2});
    const blum::DeviceMemory distance(solver.device(), grid.node_count() * sizeof(float));
    const blum::DeviceMemory site(solver.device(), grid.node_count() * sizeof(std::uint32_t));
    std::cout << to_string(solver.device()) << " holds " << distance.size() + site.size() << " bytes for a field\n";
    // Call solver.set_connectivity({vertices, triangles}, stream) once. Then call for each frame
    // solver.compute(vertices, {static_cast<float*>(distance.data()), static_cast<std::uint32_t*>(site.data())},
    // stream);
  } catch (const blum::DeviceError& error) {
    std::cout << "no device: " << error.what() << '\n';
  }
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
