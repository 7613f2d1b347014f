// Blum: interface between the library and its CUDA module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/field/device_memory.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/voxel_image.hpp"
#include "field/field_request.hpp"
#include "field/image_request.hpp"

// The module is a shared library of its own. It is loaded when a CUDA device is first asked for, so that one binary
// runs with and without a device. No exception crosses its border.
namespace blum::cuda {

/// Raise it with every change of this file, and of the types that cross the border: FieldRequest, ImageRequest.
inline constexpr std::uint32_t module_version = 7;
inline constexpr const char* module_symbol = "blum_cuda_module";
inline constexpr const char* module_file = "libblum_cuda.so";

enum class Status : std::uint8_t {
  done,
  device_error,
  out_of_memory,
  invalid_mesh,
  invalid_grid,
  invalid_option,
  cancelled
};

/// Context of a call, and its error message.
struct Call {
  const void* context = nullptr;
  bool (*is_cancelled)(const void* context) = nullptr;
  void (*report)(const void* context, double fraction) = nullptr;
  char message[512] = {};
};

/// Functions of the module.
struct Module {
  std::uint32_t version = module_version;
  /// Makes an engine on the device with this index.
  Status (*create)(int device, void** engine, Call* call) = nullptr;
  void (*destroy)(void* engine) = nullptr;
  /// Uploads a mesh's indices and finds its edges.
  Status (*set_connectivity)(void* engine, const MeshView* mesh, Call* call) = nullptr;
  /// Computes the field of the mesh's vertices in the host's memory. `is_signed` says if it found the signs; see
  /// FieldEngine.
  Status (*compute)(void* engine, const MeshView* mesh, const FieldRequest* request, bool* is_signed,
                    Call* call) = nullptr;
  /// The same two for a mesh and a field in the device's memory. compute_there() queues its work on a stream and does
  /// not wait. It always finds signs by winding numbers.
  Status (*set_connectivity_there)(void* engine, const DeviceMeshView* mesh, void* stream, Call* call) = nullptr;
  Status (*compute_there)(void* engine, const DeviceArrayView* vertices, const FieldRequest* request, void* stream,
                          Call* call) = nullptr;
  /// The same for an image. It uploads nothing and does not wait.
  Status (*transform_there)(void* engine, const DeviceArrayView* values, const detail::ImageRequest* request,
                            void* stream, Call* call) = nullptr;
  /// Counts how often the three functions above have queued work, and how many of these pieces, from the first on, are
  /// done.
  Status (*progress)(void* engine, std::uint64_t* queued, std::uint64_t* finished, Call* call) = nullptr;
  /// Makes work that is queued on a stream from now on wait for the first `pieces` of that work.
  Status (*follow)(void* engine, std::uint64_t pieces, void* stream, Call* call) = nullptr;
  /// Makes work that is queued on stream `after` from now on wait for the work queued on `before` so far.
  Status (*order)(void* engine, void* before, void* after, Call* call) = nullptr;
  /// Finds the index of the device that owns memory; -1 for the host's.
  Status (*device_of)(void* engine, const void* memory, int* device, Call* call) = nullptr;
  /// Allocates memory of a device; release() frees it.
  Status (*allocate)(int device, std::size_t bytes, void** memory, Call* call) = nullptr;
  void (*release)(int device, void* memory) = nullptr;
  /// Uploads an image. Its requests may differ in selection and memory only.
  Status (*set_image)(void* engine, const VoxelImageView* image, const detail::ImageRequest* request,
                      Call* call) = nullptr;
  /// Counts the voxels that a request selects.
  Status (*select_voxels)(void* engine, const detail::ImageRequest* request, std::size_t* selected,
                          Call* call) = nullptr;
  /// Transforms the last selection, into the host's memory.
  Status (*transform_image)(void* engine, const detail::ImageRequest* request, Call* call) = nullptr;
  /// Writes the name of a device, which ends with a 0 byte, and its bytes of memory.
  Status (*describe_device)(int device, char* name, std::size_t capacity, std::uint64_t* memory, Call* call) = nullptr;
};

using ModuleFunction = const Module* (*)();

}  // namespace blum::cuda
