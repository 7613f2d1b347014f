#include "blum/field/voxels_inside.hpp"

#include "blum/field/field.hpp"

namespace blum {

VoxelSet voxels_inside(const MeshView& mesh, const GridSpec& grid, const Context& context) {
  FieldOptions options;
  options.sign = SignMode::winding;
  const Field field = distance_field(mesh, grid, options, context);
  VoxelSet voxels(grid.size);
  std::size_t node = 0;
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i, ++node) {
        if (field.distance[node] < 0) voxels.insert(i, j, k);
      }
    }
  }
  return voxels;
}

}  // namespace blum
