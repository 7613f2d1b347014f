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

/// Computes fields of deforming meshes in a CUDA device's memory, and leaves the fields in that memory, without copies.
/// Between frames, the solver does not wait for the device.
///
/// The guarantees of FieldSolver hold. Streams are cudaStream_t; nullptr is the legacy default stream. The work that
/// computes the inputs must be queued on the stream before the call. Work that is queued on the stream after the call
/// can use the field. Arrays must stay alive until the device has completed the call (see progress()). Calls may use
/// different streams. Only one thread at a time may call functions of a solver.
class DeviceFieldSolver {
 public:
  /// @param options  With `sign` set to `automatic` or `winding`, winding numbers decide the sign. For closed meshes
  ///                 that face outwards, the signs are those of `normals`. `normals` is not allowed, because it needs a
  ///                 mesh in the host's memory. `order` must be 1.
  /// @param context  selects a CUDA device; `automatic` selects the first one. The computation of a field cannot be
  ///                 cancelled.
  /// @throws InvalidGrid, InvalidOption, OutOfMemory, DeviceError.
  explicit DeviceFieldSolver(const GridSpec& grid, const FieldOptions& options = {},
                             const Context& context = {.device = Device::cuda()});
  DeviceFieldSolver(DeviceFieldSolver&&) noexcept;
  DeviceFieldSolver& operator=(DeviceFieldSolver&&) noexcept;
  ~DeviceFieldSolver();

  [[nodiscard]] Device device() const;
  [[nodiscard]] const GridSpec& grid() const;
  [[nodiscard]] const FieldOptions& options() const;

  /// Copies the triangles, segments and points of a mesh and finds its edges. Only the number of vertices is used, not
  /// their positions. Call this function again when the connectivity changes. set_connectivity() waits for the device.
  /// @throws InvalidMesh if the mesh has no sites or too many sites, or if an index is out of range.
  /// @throws InvalidOption for an element type that is not supported, a missing pointer, or SiteIds::triangles for a
  /// mesh with segments or points.
  /// @throws OutOfMemory, DeviceError.
  void set_connectivity(const DeviceMeshView& mesh, void* stream = nullptr);
  /// Returns the rule that decides the signs of fields with the current connectivity.
  [[nodiscard]] SignRule sign_rule() const;

  /// Queues the computation of the field of the mesh with these vertices and the current connectivity. This call does
  /// not wait for the device. The only exception: if 64 earlier calls are not completed yet, this call waits for the
  /// oldest of them.
  ///
  /// Two errors are known only on the device: vertices that are not finite, and extents that 32-bit distances cannot
  /// represent. After such an error, every node has the distance NaN and no site.
  /// @throws InvalidOption if set_connectivity() has not been called, a pointer is missing, or the element type is not
  /// supported.
  /// @throws InvalidMesh if the number of vertices is not that of the mesh passed to set_connectivity().
  /// @throws InvalidGrid, OutOfMemory, DeviceError.
  /// Cost: as distance_field(). If the mesh has a boundary, the cost increases by O(boundary edges * tiles), with tiles
  /// of 8^3 nodes.
  void compute(const DeviceArrayView& vertices, const DeviceFieldView& field, void* stream = nullptr);

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
