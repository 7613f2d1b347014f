// Blum: fields from and to the memory of a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "blum/core/context.hpp"
#include "blum/field/device_memory.hpp"
#include "blum/field/field.hpp"

namespace blum {

/// Computes fields of deforming meshes that live in a CUDA device's memory, and leaves them there: no copy, and from
/// frame to frame no wait for the device.
///
/// What FieldSolver promises, holds. Streams are cudaStream_t; nullptr is the legacy default stream. Whatever is read
/// must have been queued on the stream before the call; the field is complete for what is queued on it afterwards.
/// Arrays must stay until the device has passed there. Calls may change streams. One call at a time.
class DeviceFieldSolver {
 public:
  /// @param options  sign: `automatic` and `winding` are both the winding number, which tells the sides of closed
  /// meshes
  ///                 that face outwards as `normals` does; `normals` itself needs a mesh in the host's memory.
  /// @param context  its device: a CUDA device, or `automatic` for the first one. Fields cannot be cancelled.
  /// @throws InvalidGrid, InvalidOption, OutOfMemory, DeviceError.
  explicit DeviceFieldSolver(const GridSpec& grid, const FieldOptions& options = {},
                             const Context& context = {.device = Device::cuda()});
  DeviceFieldSolver(DeviceFieldSolver&&) noexcept;
  DeviceFieldSolver& operator=(DeviceFieldSolver&&) noexcept;
  ~DeviceFieldSolver();

  [[nodiscard]] Device device() const;
  [[nodiscard]] const GridSpec& grid() const;
  [[nodiscard]] const FieldOptions& options() const;

  /// Takes the triangles, segments and points of a mesh, which are copied, and finds its edges; of the vertices only
  /// the number counts. To be called again when the connectivity changes. Waits for the device.
  /// @throws InvalidMesh (no sites, too many, an index out of range), InvalidOption (element types, or triangle ids of
  /// a
  ///         mesh that has segments or points), OutOfMemory, DeviceError.
  void set_connectivity(const DeviceMeshView& mesh, void* stream = nullptr);
  /// How the signs of fields are found with the current connectivity.
  [[nodiscard]] SignRule sign_rule() const;

  /// Queues the field of the current connectivity with these vertices; does not wait, but with 64 calls in flight for
  /// the oldest.
  ///
  /// Vertices that are not finite, and extents that 32-bit distances do not hold, show only on the device: then every
  /// node gets NaN and no site.
  /// @throws InvalidOption (no connectivity yet, element type, no memory named), InvalidMesh (another number of
  /// vertices),
  ///         InvalidGrid, OutOfMemory, DeviceError.
  /// Cost: as distance_field's; where the mesh has a boundary, also tiles of 8^3 nodes times its edges.
  void compute(const DeviceArrayView& vertices, const DeviceFieldView& field, void* stream = nullptr);

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
