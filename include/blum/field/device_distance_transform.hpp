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

/// Computes distance transforms of images in a CUDA device's memory, and leaves the results in that memory. The working
/// memory takes slightly more than 1/8 byte per voxel, and is kept between calls. The rules for streams and lifetimes
/// are those of DeviceFieldSolver.
class DeviceDistanceTransform {
 public:
  /// @param grid     grid of the images.
  /// @param context  selects a CUDA device; `automatic` selects the first one.
  /// @throws InvalidGrid.
  /// @throws InvalidImage if the image has more than max_id_count voxels, or an extent that 32-bit distances cannot
  /// represent.
  /// @throws InvalidOption, OutOfMemory, DeviceError.
  explicit DeviceDistanceTransform(const GridSpec& grid, const DistanceTransformOptions& options = {},
                                   const Context& context = {.device = Device::cuda()});
  DeviceDistanceTransform(DeviceDistanceTransform&&) noexcept;
  DeviceDistanceTransform& operator=(DeviceDistanceTransform&&) noexcept;
  ~DeviceDistanceTransform();

  [[nodiscard]] Device device() const;
  [[nodiscard]] const GridSpec& grid() const;
  [[nodiscard]] const DistanceTransformOptions& options() const;

  /// Queues a distance transform whose results are the same bytes as those of distance_transform(). This call does not
  /// wait for the device. The only exception: if 64 earlier calls are not completed yet, this call waits for the oldest
  /// of them.
  ///
  /// The selected voxels are known only on the device. If no voxel is selected, every voxel gets an infinite distance
  /// (with a band: the half-width of the band) and no site. In a signed transform, every voxel also gets this distance
  /// and no site if all voxels are selected.
  /// @param values  the values of the voxels, x fastest.
  /// @param field   memory that receives distances and sites.
  /// @throws InvalidImage if the number of values is not the number of voxels.
  /// @throws InvalidOption if a pointer to memory is missing, or memory for sites is given without the option `sites`.
  /// @throws OutOfMemory, DeviceError.
  void compute(const DeviceArrayView& values, const DeviceFieldView& field, void* stream = nullptr);

  [[nodiscard]] DeviceProgress progress() const;
  /// Makes a stream wait until the first `pieces` of the calls that progress() counts are completed. Work that is
  /// queued on the stream after follow() starts only then.
  void follow(std::uint64_t pieces, void* stream);
  /// Returns the device whose memory a pointer points to; nullopt for memory of the host.
  [[nodiscard]] std::optional<Device> device_of(const void* memory) const;
  /// Makes stream `after` wait for stream `before`. Work that is queued on `after` after this call starts when all work
  /// that was queued on `before` earlier is completed.
  void order(void* before, void* after);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
