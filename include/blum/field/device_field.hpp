// Blum: fields of meshes in the memory of a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "blum/core/context.hpp"
#include "blum/field/device_memory.hpp"
#include "blum/field/field.hpp"

namespace blum {

/// Computes fields of deforming meshes in a CUDA device's memory, and leaves them there, without copies. Between frames
/// it does not wait for the device.
///
/// The guarantees of FieldSolver hold. Streams are cudaStream_t; nullptr is the legacy default stream. All inputs must
/// have been queued on the stream before the call. The field is complete for work that is queued on the stream after
/// the call. Arrays must stay alive until the device has finished that call. Calls may use different streams. Only one
/// call may run at a time.
class DeviceFieldSolver {
 public:
  /// @param options  `sign`: both `automatic` and `winding` use the winding number. For closed meshes that face
  ///                 outwards, it gives the same sides as `normals`. `normals` itself needs a mesh in the host's
  ///                 memory. `order` must be 1.
  /// @param context  names a CUDA device; `automatic` is the first one. Fields cannot be cancelled.
  /// @throws InvalidGrid, InvalidOption, OutOfMemory, DeviceError.
  explicit DeviceFieldSolver(const GridSpec& grid, const FieldOptions& options = {},
                             const Context& context = {.device = Device::cuda()});
  DeviceFieldSolver(DeviceFieldSolver&&) noexcept;
  DeviceFieldSolver& operator=(DeviceFieldSolver&&) noexcept;
  ~DeviceFieldSolver();

  [[nodiscard]] Device device() const;
  [[nodiscard]] const GridSpec& grid() const;
  [[nodiscard]] const FieldOptions& options() const;

  /// Copies the triangles, segments and points of a mesh and finds its edges. Only the number of its vertices is used.
  /// Call it again when the connectivity changes. It waits for the device.
  /// @throws InvalidMesh if the mesh has no sites or too many, or an index is out of range.
  /// @throws InvalidOption for other element types, missing memory, or triangle ids of a mesh that has segments or
  /// points.
  /// @throws OutOfMemory, DeviceError.
  void set_connectivity(const DeviceMeshView& mesh, void* stream = nullptr);
  /// Returns the rule for the signs of fields with the current connectivity.
  [[nodiscard]] SignRule sign_rule() const;

  /// Queues the field of the current connectivity with these vertices. It does not wait, except for the oldest call
  /// when 64 calls are in flight.
  ///
  /// Two errors are known only on the device: vertices that are not finite, and extents that 32-bit distances do not
  /// hold. In these cases every node gets NaN and no site.
  /// @throws InvalidOption if set_connectivity() has not been called, memory is missing, or the element type is another
  /// one.
  /// @throws InvalidMesh for another number of vertices.
  /// @throws InvalidGrid, OutOfMemory, DeviceError.
  /// Cost: as distance_field(). If the mesh has a boundary, add its edges times the tiles of 8^3 nodes.
  void compute(const DeviceArrayView& vertices, const DeviceFieldView& field, void* stream = nullptr);

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
