#include "blum/geometry/rigid_transform.hpp"

#include "blum/core/error.hpp"

namespace blum {

Mat3 closest_rotation(const Mat3& matrix) {
  constexpr double farthest = 0.1;
  constexpr double close_enough = 1e-15;
  constexpr int most_rounds = 20;
  RigidTransform place{matrix, {}};
  auto& c = place.rotation.columns;
  const bool turns = dot(cross(c[0], c[1]), c[2]) > 0;
  if (!turns || !(place.rotation_error() <= farthest)) {
    throw InvalidOption(
        "the matrix is not a rotation to within 0.1: its columns must be orthonormal and right-handed; scale or mirror "
        "vertices instead");
  }
  for (int round = 0; round < most_rounds && place.rotation_error() > close_enough; ++round) {
    // Takes the mean of the matrix and its inverse transpose, as in Newton's method for the polar decomposition.
    const double volume = dot(cross(c[0], c[1]), c[2]);
    const Mat3 other{{cross(c[1], c[2]) / volume, cross(c[2], c[0]) / volume, cross(c[0], c[1]) / volume}};
    for (std::size_t k = 0; k < 3; ++k) c[k] = (c[k] + other.columns[k]) / 2;
  }
  return place.rotation;
}

}  // namespace blum
