// Blum: distance transforms of images in the memory of a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "blum/core/context.hpp"
#include "blum/field/device_memory.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

/// Transforms images that live in a CUDA device's memory, and leaves the results there; keeps its working memory, 1/8
/// byte per voxel and a little more, from one to the next. Streams and lifetimes are as DeviceFieldSolver has them.
class DeviceDistanceTransform {
 public:
  /// @param grid     of the images.
  /// @param context  its device: a CUDA device, or `automatic` for the first one.
  /// @throws InvalidGrid, InvalidImage (more voxels than ids; extents that 32-bit distances do not hold),
  ///         InvalidOption, OutOfMemory, DeviceError.
  explicit DeviceDistanceTransform(const GridSpec& grid, const DistanceTransformOptions& options = {},
                                   const Context& context = {.device = Device::cuda()});
  DeviceDistanceTransform(DeviceDistanceTransform&&) noexcept;
  DeviceDistanceTransform& operator=(DeviceDistanceTransform&&) noexcept;
  ~DeviceDistanceTransform();

  [[nodiscard]] Device device() const;
  [[nodiscard]] const GridSpec& grid() const;
  [[nodiscard]] const DistanceTransformOptions& options() const;

  /// Queues what distance_transform() computes, byte for byte; does not wait, but with 64 calls in flight for the
  /// oldest.
  ///
  /// Which voxels are selected shows only on the device: where no voxel is, or, signed, every one, distances are
  /// infinite (or the band's) and there are no sites.
  /// @param values  one per voxel, x fastest.
  /// @throws InvalidImage (another number of values), InvalidOption (no memory named), OutOfMemory, DeviceError.
  void compute(const DeviceArrayView& values, const DeviceFieldView& field, void* stream = nullptr);

  [[nodiscard]] DeviceProgress progress() const;
  /// Makes what is queued on a stream from now on wait for the first `pieces` of the work that progress() counts.
  void follow(std::uint64_t pieces, void* stream);
  /// The device that memory belongs to; none for the host's.
  [[nodiscard]] std::optional<Device> device_of(const void* memory) const;
  /// Makes what is queued on one stream from now on wait for what is queued on another one now.
  void order(void* before, void* after);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
