// Blum: arrays of others in a device's memory. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "blum/field/device_memory.hpp"
#include "field/kernels/connectivity.hpp"

namespace blum::kernels {

using MemoryArray = DeviceArrayView;
using MemoryMesh = DeviceMeshView;

/// Vertices in double, whatever they come in.
struct CopyVertices {
  MemoryArray from;
  Vec3d* to;

  BLUM_HD void operator()(std::size_t k) const {
    if (from.type == ElementType::float32) {
      const auto* const row = static_cast<const float*>(from.data) + 3 * k;
      to[k] = {row[0], row[1], row[2]};
    } else {
      const auto* const row = static_cast<const double*>(from.data) + 3 * k;
      to[k] = {row[0], row[1], row[2]};
    }
  }
};

/// Indices in 32 bits. Those that no vertex has become 0, and are told of.
struct CopyIndices {
  MemoryArray from;
  std::size_t limit;
  std::uint32_t* to;
  std::uint32_t* faults;

  BLUM_HD void operator()(std::size_t k) const {
    const std::int64_t index = value(k);
    const bool is_good = index >= 0 && static_cast<std::uint64_t>(index) < limit;
    to[k] = is_good ? static_cast<std::uint32_t>(index) : 0;
    if (!is_good) *faults = 1;
  }

 private:
  [[nodiscard]] BLUM_HD std::int64_t value(std::size_t k) const {
    switch (from.type) {
      case ElementType::int32:
        return static_cast<const std::int32_t*>(from.data)[k];
      case ElementType::uint32:
        return static_cast<const std::uint32_t*>(from.data)[k];
      default:
        return static_cast<const std::int64_t*>(from.data)[k];
    }
  }
};

/// The smallest triangle at each vertex. One thread per corner.
struct FindVertexTriangles {
  const Triangle* triangles;
  std::uint32_t* vertex_triangle;

  BLUM_HD void operator()(std::size_t k) const {
    const auto t = static_cast<std::uint32_t>(k / 3);
    std::uint32_t& least = vertex_triangle[triangles[t][k % 3]];
#if defined(__CUDA_ARCH__)
    atomicMin(&least, t);
#else
    least = smaller(least, t);
#endif
  }
};

/// The smallest triangle that a site lies on.
struct ShowTriangle {
  const std::uint32_t* vertex_triangle;
  const std::array<std::uint32_t, 2>* edge_faces;
  std::uint32_t vertex_count;
  std::uint32_t edge_count;
  std::uint32_t* site;

  BLUM_HD void operator()(std::size_t k) const {
    const std::uint32_t id = site[k];
    if (id == no_index) return;
    if (id < vertex_count) {
      site[k] = vertex_triangle[id];
    } else if (id - vertex_count < edge_count) {
      site[k] = edge_faces[id - vertex_count][0];
    } else {
      site[k] = id - vertex_count - edge_count;
    }
  }
};

}  // namespace blum::kernels
