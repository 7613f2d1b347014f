// Blum: what computes fields, on each device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/field_request.hpp"
#include "field/image_request.hpp"
#include "field/second_labels.hpp"

namespace blum {

struct FieldResult {
  /// Nodes that are left to exact queries: those that no site claimed in float32, and those whose side is too close to
  /// call; rising.
  std::vector<std::size_t> unsettled;
  /// Whether nodes got the signs that were asked for; else they are left to others.
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

  /// Makes `mesh` the current one; what depends on its connectivity alone is kept while that stays the same. The mesh
  /// must stay alive until compute() returns.
  virtual void set_mesh(const MeshView& mesh, const Context& context) = 0;
  [[nodiscard]] virtual const SiteTable& sites() const = 0;

  /// Whether others find the signs of a method, with the sites of the field.
  [[nodiscard]] virtual bool needs_sites_for(sign::Method method) const = 0;

  /// Fills the memory of a request, the host's, and appends phase times.
  [[nodiscard]] virtual FieldResult compute(const FieldRequest& request, const Context& context,
                                            std::vector<PhaseTime>& phases) = 0;

  /// Fills the second order of the field that compute() made; returns the nodes that are left to exact queries, rising.
  [[nodiscard]] virtual std::vector<std::size_t> compute_second(const SecondRequest& /*request*/,
                                                                const Context& /*context*/) {
    return {};
  }
};

/// Transforms images on one device that is not the CPU.
class ImageBackend {
 public:
  ImageBackend() = default;
  ImageBackend(const ImageBackend&) = delete;
  ImageBackend& operator=(const ImageBackend&) = delete;
  virtual ~ImageBackend() = default;

  [[nodiscard]] virtual Device device() const = 0;
  /// Makes a valid image the current one; it must stay alive. Requests for it may differ in selection and memory.
  virtual void set_image(const VoxelImageView& image, const detail::ImageRequest& request) = 0;
  /// How many voxels a request selects.
  [[nodiscard]] virtual std::size_t select(const detail::ImageRequest& request) = 0;
  /// Fills the memory, the host's, of the request that was selected last.
  virtual void transform(const detail::ImageRequest& request) = 0;
};

/// The back end of context.device for fields of an order. @param reason  gets why it is the CPU's where `automatic` was
/// asked for. @throws DeviceError; InvalidOption for order 2 on a device that is not the CPU.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(const Context& context, int order, std::string& reason);
/// Likewise; none for the CPU. @throws DeviceError.
[[nodiscard]] std::unique_ptr<ImageBackend> make_image_backend(const Context& context, std::string& reason);

}  // namespace blum
