#include "field/cpu/normal_frame.hpp"

#include <algorithm>
#include <cmath>

#include "blum/core/error.hpp"

namespace blum::cpu {

NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named, const GridSpec& grid) {
  NormalFrame frame;
  frame.direction = grid.direction;
  const bool is_axis_aligned = grid.direction == Mat3{};
  Box3 box;
  for (const std::uint32_t v : named) {
    box.extend(is_axis_aligned ? mesh.vertices[v] : grid.direction.transposed_times(mesh.vertices[v]));
  }

  const Vec3d first = grid.direction.transposed_times(grid.origin);
  const Vec3d last = first + Vec3d{static_cast<double>(grid.size[0] - 1) * grid.spacing.x,
                                   static_cast<double>(grid.size[1] - 1) * grid.spacing.y,
                                   static_cast<double>(grid.size[2] - 1) * grid.spacing.z};
  box.extend(first);
  box.extend(last);
  const double diagonal = box.diagonal();
  if (!(diagonal < 1e37))
    throw InvalidGrid("mesh and grid span more than 1e37, too far for 32-bit distances: scale them down");
  int exponent = 0;
  if (diagonal > 0) (void)std::frexp(diagonal, &exponent);
  const Vec3d size = box.size();  // the diagonal's squares may underflow
  if (std::max({size.x, size.y, size.z}) > 0 && diagonal < 1e-36) {
    throw InvalidGrid("mesh and grid span less than 1e-36, too little for 32-bit distances: scale them up");
  }
  frame.scale = std::ldexp(1.0, -exponent);
  frame.center = box.center();
  frame.first_node = (first - frame.center) * frame.scale;
  frame.spacing = grid.spacing * frame.scale;
  return frame;
}

}  // namespace blum::cpu
