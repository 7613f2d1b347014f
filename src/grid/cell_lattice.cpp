#include "blum/grid/cell_lattice.hpp"

#include <string>

namespace blum {

CellLattice::CellLattice(const std::array<std::int64_t, 3>& cubes) {
  for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = cubes[axis] + 1;
  stride_ = {1, static_cast<std::size_t>(size_[0]), static_cast<std::size_t>(size_[0] * size_[1])};
  count_ = stride_[2] * static_cast<std::size_t>(size_[2]);
  if (count_ >= std::size_t{1} << 29U) {
    throw InvalidGrid("the solid spans " + std::to_string(cubes[0]) + " x " + std::to_string(cubes[1]) + " x " +
                      std::to_string(cubes[2]) + " cells, but at most 2^29 can be numbered: use a coarser grid");
  }
}

}  // namespace blum
