// Blum: arrays in the memory of a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "blum/core/device.hpp"

namespace blum {

/// In the order of VoxelImageView::Values.
enum class ElementType : std::uint8_t { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

/// Rows of an array in a CUDA device's memory, one after the other without gaps.
struct DeviceArrayView {
  const void* data = nullptr;
  ElementType type = ElementType::float64;
  std::size_t rows = 0;
};

/// A mesh in a CUDA device's memory. See MeshView.
struct DeviceMeshView {
  DeviceArrayView vertices;   ///< n x 3, float32 or float64, mesh units
  DeviceArrayView triangles;  ///< n x 3, int32, uint32 or int64; without rows the type does not matter
  DeviceArrayView segments;   ///< n x 2, likewise
  DeviceArrayView points;     ///< n, likewise
};

/// Where a field goes, in a CUDA device's memory: one value per node of the grid each, x fastest.
struct DeviceFieldView {
  float* distance = nullptr;
  std::uint32_t* site = nullptr;  ///< 0xffffffff where there is none; not looked at where no sites are asked for
};

/// How many calls have queued work so far, and how many of those, from the first on, the device has completed: what
/// they read and wrote is free again.
struct DeviceProgress {
  std::uint64_t queued = 0;
  std::uint64_t finished = 0;
};

/// Memory of a CUDA device that ends with its owner.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  /// @throws DeviceError, OutOfMemory, InvalidOption for the CPU.
  DeviceMemory(const Device& device, std::size_t bytes);

  [[nodiscard]] void* data() const { return data_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
  std::shared_ptr<void> data_;
};

}  // namespace blum
