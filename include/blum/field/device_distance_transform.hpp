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

/// Transforms images in a CUDA device's memory, and leaves the results there. Its working memory takes 1/8 byte per
/// voxel and a little more, and is kept between calls. Streams and lifetimes are those of DeviceFieldSolver.
class DeviceDistanceTransform {
 public:
  /// @param grid     grid of the images.
  /// @param context  names a CUDA device; `automatic` is the first one.
  /// @throws InvalidGrid.
  /// @throws InvalidImage if the image has more voxels than ids, or an extent that 32-bit distances do not hold.
  /// @throws InvalidOption, OutOfMemory, DeviceError.
  explicit DeviceDistanceTransform(const GridSpec& grid, const DistanceTransformOptions& options = {},
                                   const Context& context = {.device = Device::cuda()});
  DeviceDistanceTransform(DeviceDistanceTransform&&) noexcept;
  DeviceDistanceTransform& operator=(DeviceDistanceTransform&&) noexcept;
  ~DeviceDistanceTransform();

  [[nodiscard]] Device device() const;
  [[nodiscard]] const GridSpec& grid() const;
  [[nodiscard]] const DistanceTransformOptions& options() const;

  /// Queues the work of distance_transform(), with the same bytes as the result. It does not wait, except for the
  /// oldest call when 64 calls are in flight.
  ///
  /// The selected voxels are known only on the device. If no voxel is selected, all distances are
  /// infinite (with a band, its half-width), without sites. In a signed transform this also holds if all are selected.
  /// @param values  one per voxel, x fastest.
  /// @param field   memory for distances and sites.
  /// @throws InvalidImage for another number of values.
  /// @throws InvalidOption if memory is missing.
  /// @throws OutOfMemory, DeviceError.
  void compute(const DeviceArrayView& values, const DeviceFieldView& field, void* stream = nullptr);

  [[nodiscard]] DeviceProgress progress() const;
  /// Makes work that is queued on a stream from now on wait for the first `pieces` pieces of work that progress()
  /// counts.
  void follow(std::uint64_t pieces, void* stream);
  /// Returns the device that owns memory; nullopt for memory of the host.
  [[nodiscard]] std::optional<Device> device_of(const void* memory) const;
  /// Makes work that is queued on stream `after` from now on wait for the work queued on `before` so far.
  void order(void* before, void* after);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
