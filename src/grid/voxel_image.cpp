#include "blum/grid/voxel_image.hpp"

#include <string>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"

namespace blum {

void validate(const VoxelImageView& image) {
  try {
    validate(image.grid);
  } catch (const InvalidGrid& error) {
    throw InvalidImage(std::string("the image's geometry is invalid: ") + error.what());
  }
  if (image.grid.node_count() > max_id_count) throw InvalidImage("the image has more than 2^31 - 1 voxels");
  const std::size_t count = std::visit([](const auto& values) { return values.size(); }, image.values);
  if (count != image.grid.node_count()) {
    throw InvalidImage("the image has " + std::to_string(count) + " values, but its grid has " +
                       std::to_string(image.grid.node_count()) + " voxels");
  }
}

}  // namespace blum
