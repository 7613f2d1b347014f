// Blum: interface between the library and its CUDA module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/field/device_memory.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/voxel_image.hpp"
#include "field/field_request.hpp"
#include "field/image_request.hpp"

// The module is a separate shared library. The module is loaded when a CUDA device is first requested, so that the same
// binary also runs on machines without CUDA. No exception leaves the module's functions.
namespace blum::cuda {

/// Must be increased with every change of this file, or of the types that are passed to the module: FieldRequest,
/// ImageRequest.
inline constexpr std::uint32_t module_version = 8;
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

/// Cancellation and progress callbacks of a call, and memory for its error message.
struct Call {
  const void* context = nullptr;
  bool (*is_cancelled)(const void* context) = nullptr;
  void (*report)(const void* context, double fraction) = nullptr;
  char message[512] = {};
};

/// Functions of the module. An `engine` keeps the data of one solver on one device.
struct Module {
  std::uint32_t version = module_version;
  /// Makes an engine on the device with this index.
  Status (*create)(int device, void** engine, Call* call) = nullptr;
  void (*destroy)(void* engine) = nullptr;
  /// Uploads a mesh's indices and finds its edges.
  Status (*set_connectivity)(void* engine, const MeshView* mesh, Call* call) = nullptr;
  /// Computes the field of a mesh whose vertices are in the host's memory. Sets `is_signed` if the distances have their
  /// signs; see FieldEngine::compute().
  Status (*compute)(void* engine, const MeshView* mesh, const FieldRequest* request, bool* is_signed,
                    Call* call) = nullptr;
  /// Counterparts of the two functions above for a mesh and a field in the device's memory. The function
  /// compute_there() queues its work on a stream and does not wait for it. The function compute_there() finds all
  /// requested signs by winding numbers.
  Status (*set_connectivity_there)(void* engine, const DeviceMeshView* mesh, void* stream, Call* call) = nullptr;
  Status (*compute_there)(void* engine, const DeviceArrayView* vertices, const FieldRequest* request, void* stream,
                          Call* call) = nullptr;
  /// Computes the transform of an image in the device's memory. Uploads nothing. Queues its work on a stream and does
  /// not wait for it.
  Status (*transform_there)(void* engine, const DeviceArrayView* values, const detail::ImageRequest* request,
                            void* stream, Call* call) = nullptr;
  /// Returns in `queued` how many tasks the three functions ending in `_there` have queued. Returns in `finished` how
  /// many of these are done, counted from the first.
  Status (*progress)(void* engine, std::uint64_t* queued, std::uint64_t* finished, Call* call) = nullptr;
  /// Makes later work on a stream wait for the first `pieces` of the tasks that progress() counts.
  Status (*follow)(void* engine, std::uint64_t pieces, void* stream, Call* call) = nullptr;
  /// Makes later work on the stream `after` wait for all work queued on the stream `before` so far.
  Status (*order)(void* engine, void* before, void* after, Call* call) = nullptr;
  /// Finds the index of the device that owns memory; -1 for the host's.
  Status (*device_of)(void* engine, const void* memory, int* device, Call* call) = nullptr;
  /// Allocates memory of a device; release() frees it.
  Status (*allocate)(int device, std::size_t bytes, void** memory, Call* call) = nullptr;
  void (*release)(int device, void* memory) = nullptr;
  /// Uploads an image. Later requests for it may differ from `request` only in selection and result memory.
  Status (*set_image)(void* engine, const VoxelImageView* image, const detail::ImageRequest* request,
                      Call* call) = nullptr;
  /// Counts the voxels that a request selects.
  Status (*select_voxels)(void* engine, const detail::ImageRequest* request, std::size_t* selected,
                          Call* call) = nullptr;
  /// Transforms the selection of the last select_voxels(), and copies the result to the host's memory.
  Status (*transform_image)(void* engine, const detail::ImageRequest* request, Call* call) = nullptr;
  /// Writes the name of a device (zero-terminated, at most `capacity` bytes) and the size of its memory in bytes.
  Status (*describe_device)(int device, char* name, std::size_t capacity, std::uint64_t* memory, Call* call) = nullptr;
};

using ModuleFunction = const Module* (*)();

}  // namespace blum::cuda
