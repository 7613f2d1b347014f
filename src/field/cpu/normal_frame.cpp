#include "field/cpu/normal_frame.hpp"

#include "blum/core/error.hpp"

namespace blum::cpu {

NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named, const GridSpec& grid) {
  const bool is_axis_aligned = grid.direction == Mat3{};
  kernels::Bounds box;
  for (const std::uint32_t v : named) {
    box.extend(is_axis_aligned ? mesh.vertices[v] : grid.direction.transposed_times(mesh.vertices[v]));
  }
  const NormalFrame frame = kernels::make_normal_frame(box, grid);
  if (frame.fault == NormalFrame::Fault::too_large) {
    throw InvalidGrid("mesh and grid span more than 1e37, too far for 32-bit distances: scale them down");
  }
  if (frame.fault == NormalFrame::Fault::too_small) {
    throw InvalidGrid("mesh and grid span less than 1e-36, too little for 32-bit distances: scale them up");
  }
  return frame;
}

}  // namespace blum::cpu
