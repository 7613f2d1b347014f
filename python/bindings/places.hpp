// Blum: rigid transforms from arrays. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "arrays.hpp"
#include "blum/geometry/rigid_transform.hpp"

namespace blum::python {

/// Matrix with the rotation in its first three columns and the translation in the last one.
using PlaceIn = In<double, nb::shape<3, 4>>;

inline RigidTransform place_of(const PlaceIn& rows) {
  RigidTransform place;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 3; ++k) place.rotation.columns[k][row] = rows(row, k);
    place.translation[row] = rows(row, 3);
  }
  return place;
}

}  // namespace blum::python
