// Blum: what computes fields, on each device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/image_plan.hpp"

namespace blum {

struct FieldRequest {
  GridSpec grid;
  std::optional<double> band = {};
  /// Signs by pseudonormals, of a closed, consistently oriented mesh. Only where the back end can_tell_sides().
  bool with_sides = false;
  /// Signs by winding numbers: nodes are inside where theirs is above this (above level + 1/2, where the mesh has a
  /// boundary). Back ends may leave it to others, see FieldResult.
  std::optional<int> level = {};
};

struct FieldResult {
  /// Nodes that are left to exact queries: those that no site claimed in float32, and those whose side is too close to
  /// call; rising.
  std::vector<std::size_t> unsettled;
  /// With a level: whether the field got signs.
  bool is_signed = false;
};

/// Computes fields on one device; keeps connectivity and memory from one to the next.
class FieldBackend {
 public:
  FieldBackend() = default;
  FieldBackend(const FieldBackend&) = delete;
  FieldBackend& operator=(const FieldBackend&) = delete;
  virtual ~FieldBackend() = default;

  [[nodiscard]] virtual Device device() const = 0;
  [[nodiscard]] virtual bool can_tell_sides() const = 0;

  /// Makes `mesh` the current one; what depends on its connectivity alone is kept while that stays the same. The mesh
  /// must stay alive until compute() returns.
  virtual void set_mesh(const MeshView& mesh, const Context& context) = 0;
  [[nodiscard]] virtual const SiteTable& sites() const = 0;

  /// Fills distance and site (as feature ids) of a field whose buffers have the grid's size, and appends phase times.
  [[nodiscard]] virtual FieldResult compute(const FieldRequest& request, const Context& context, Field& field) = 0;
};

/// Transforms images on one device that is not the CPU.
class ImageBackend {
 public:
  ImageBackend() = default;
  ImageBackend(const ImageBackend&) = delete;
  ImageBackend& operator=(const ImageBackend&) = delete;
  virtual ~ImageBackend() = default;

  [[nodiscard]] virtual Device device() const = 0;
  /// Makes a valid image the current one; it must stay alive.
  virtual void set_image(const VoxelImageView& image, const detail::ImagePlan& plan) = 0;
  /// How many voxels are selected.
  [[nodiscard]] virtual std::size_t select(const LabelSelection& selection) = 0;
  /// Fills distance and site of a field of the last selection, whose buffers have the image's size.
  virtual void transform(Field& field) = 0;
};

/// The back end of context.device. @throws DeviceError.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(const Context& context);
/// Likewise; none for the CPU. @throws DeviceError.
[[nodiscard]] std::unique_ptr<ImageBackend> make_image_backend(const Context& context);

}  // namespace blum
