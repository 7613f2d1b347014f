// Blum: arrays in the memory of a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "blum/core/device.hpp"

namespace blum {

/// Types of numbers, in the order of VoxelImageView::Values.
enum class ElementType : std::uint8_t { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

/// View of an array in a CUDA device's memory. The rows of the array follow each other without gaps.
struct DeviceArrayView {
  const void* data = nullptr;
  ElementType type = ElementType::float64;
  std::size_t rows = 0;
};

/// View of a mesh in a CUDA device's memory. See MeshView.
struct DeviceMeshView {
  DeviceArrayView vertices;   ///< n x 3, float32 or float64, mesh units
  DeviceArrayView triangles;  ///< n x 3, int32, uint32 or int64; the type is ignored if there are no rows
  DeviceArrayView segments;   ///< n x 2, with the same types as `triangles`
  DeviceArrayView points;     ///< n x 1, with the same types as `triangles`
};

/// Memory for a field on a CUDA device: arrays of one value per node of the grid, x fastest.
struct DeviceFieldView {
  float* distance = nullptr;
  std::uint32_t* site = nullptr;  ///< 0xffffffff if a node has no site; ignored if the options exclude sites
};

/// `queued` is the number of calls that have queued work so far. The device has completed the first `finished` of these
/// calls. Memory that completed calls read or wrote may be freed or changed.
struct DeviceProgress {
  std::uint64_t queued = 0;
  std::uint64_t finished = 0;
};

/// Memory of a CUDA device. Copies share the memory, and the last copy frees it.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  /// @throws DeviceError, OutOfMemory.
  /// @throws InvalidOption for the CPU.
  DeviceMemory(const Device& device, std::size_t bytes);

  [[nodiscard]] void* data() const { return data_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
  std::shared_ptr<void> data_;
};

}  // namespace blum
