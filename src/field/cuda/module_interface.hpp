// Blum: what the library and its CUDA module know of each other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/field/device_memory.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_image.hpp"
#include "field/image_plan.hpp"

// The module is a shared library of its own, loaded when a CUDA device is first asked for, so that one binary runs with
// and without one. Nothing is thrown across its border.
namespace blum::cuda {

/// To be raised with every change of this file.
inline constexpr std::uint32_t module_version = 4;
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

/// How a call runs and what it says.
struct Call {
  const void* context = nullptr;
  bool (*is_cancelled)(const void* context) = nullptr;
  void (*report)(const void* context, double fraction) = nullptr;
  char message[512] = {};
};

/// A field to be written, in the host's memory or the device's. Sites are feature ids; 0xffffffff beyond the band.
struct FieldMemory {
  const GridSpec* grid = nullptr;
  double band = 0;  ///< half-width; 0: the full grid
  float* distance = nullptr;
  std::uint32_t* site = nullptr;
  /// Whether nodes with a winding number above `level` (with a boundary: level + 1/2) are to get negative distances.
  bool wants_signs = false;
  int level = 0;
  /// Whether sites are to be the smallest triangles that they lie on. In the device's memory only.
  bool wants_triangles = false;
  /// Whether they got signs. In the host's memory only.
  bool is_signed = false;
};

/// The functions of the module.
struct Module {
  std::uint32_t version = module_version;
  /// Makes an engine on the device with this index.
  Status (*create)(int device, void** engine, Call* call) = nullptr;
  void (*destroy)(void* engine) = nullptr;
  /// Uploads a mesh's indices and finds its edges.
  Status (*set_connectivity)(void* engine, const MeshView* mesh, Call* call) = nullptr;
  /// Computes the field of the mesh's vertices.
  Status (*compute)(void* engine, const MeshView* mesh, FieldMemory* field, Call* call) = nullptr;
  /// The same two for a mesh and a field in the device's memory. compute_there() queues its work on a stream and does
  /// not wait.
  Status (*set_connectivity_there)(void* engine, const DeviceMeshView* mesh, void* stream, Call* call) = nullptr;
  Status (*compute_there)(void* engine, const DeviceArrayView* vertices, FieldMemory* field, void* stream,
                          Call* call) = nullptr;
  /// The same for an image and its selected voxels: uploads nothing and does not wait.
  Status (*transform_there)(void* engine, const DeviceArrayView* values, const detail::ImagePlan* plan,
                            const LabelSelection* selection, float* distance, std::uint32_t* site, void* stream,
                            Call* call) = nullptr;
  /// How often the three above have queued work, and how much of that, from the first on, is done.
  Status (*progress)(void* engine, std::uint64_t* queued, std::uint64_t* finished, Call* call) = nullptr;
  /// Makes what is queued on a stream from now on wait for the first pieces of that work.
  Status (*follow)(void* engine, std::uint64_t pieces, void* stream, Call* call) = nullptr;
  /// Makes what is queued on one stream from now on wait for what is queued on another one now.
  Status (*order)(void* engine, void* before, void* after, Call* call) = nullptr;
  /// The index of the device that memory belongs to; -1 for the host's.
  Status (*device_of)(void* engine, const void* memory, int* device, Call* call) = nullptr;
  /// Memory of a device.
  Status (*allocate)(int device, std::size_t bytes, void** memory, Call* call) = nullptr;
  void (*release)(int device, void* memory) = nullptr;
  /// Uploads an image.
  Status (*set_image)(void* engine, const VoxelImageView* image, const detail::ImagePlan* plan, Call* call) = nullptr;
  /// Counts the selected voxels.
  Status (*select_voxels)(void* engine, const LabelSelection* selection, std::size_t* selected, Call* call) = nullptr;
  /// Transforms the last selection.
  Status (*transform_image)(void* engine, float* distance, std::uint32_t* site, Call* call) = nullptr;
};

using ModuleFunction = const Module* (*)();

}  // namespace blum::cuda
