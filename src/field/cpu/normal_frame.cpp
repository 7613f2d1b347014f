#include "field/cpu/normal_frame.hpp"

namespace blum::cpu {

NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named, const GridSpec& grid) {
  const bool is_axis_aligned = grid.direction == Mat3{};
  kernels::Bounds box;
  for (const std::uint32_t v : named) {
    box.extend(is_axis_aligned ? mesh.vertices[v] : grid.direction.transposed_times(mesh.vertices[v]));
  }
  const NormalFrame frame = kernels::make_normal_frame(box, grid);
  kernels::throw_if_faulty(frame);
  return frame;
}

}  // namespace blum::cpu
