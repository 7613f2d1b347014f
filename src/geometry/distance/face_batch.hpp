// Blum: feet of perpendiculars on many triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/core/vec3.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum {

/// Queries, each with the frame of its own triangle, as a structure of arrays.
struct alignas(64) FaceBatch {
  static constexpr std::size_t most = 64;
  static constexpr std::size_t step = 8;  ///< number of queries that are computed together
  using Column = std::array<double, most>;

  std::array<Column, 3> query, base, u, v;
  Column length, altitude, apex;

  void set(std::size_t k, const Vec3d& q, const TriangleFrame& frame) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      query[axis][k] = q[axis];
      base[axis][k] = frame.base[axis];
      u[axis][k] = frame.u[axis];
      v[axis][k] = frame.v[axis];
    }
    length[k] = frame.length;
    altitude[k] = frame.altitude;
    apex[k] = frame.apex;
  }
  /// Copies query k to another place.
  void repeat(std::size_t k, std::size_t to) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::array<Column, 3>* const vector : {&query, &base, &u, &v}) (*vector)[axis][to] = (*vector)[axis][k];
    }
    for (Column* const column : {&length, &altitude, &apex}) (*column)[to] = (*column)[k];
  }
};

/// Foot of each query of a batch on its triangle's plane.
struct alignas(64) FaceBatchFeet {
  std::array<FaceBatch::Column, 3> point;
  FaceBatch::Column squared;    ///< squared distance from the query
  FaceBatch::Column is_inside;  ///< 1 if the foot certainly lies in the triangle, as for FaceFoot::is_inside(); else 0
};

/// Computes the first feet of a batch. Each result has the bits of FaceFoot. Flat triangles contain no foot.
/// @param count  a multiple of FaceBatch::step.
void find_feet(const FaceBatch& batch, std::size_t count, double margin, FaceBatchFeet& out);

}  // namespace blum
