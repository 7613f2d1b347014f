// Blum: back ends that compute fields, one per device. SPDX-License-Identifier: Apache-2.0
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
  /// Nodes left to exact queries, ascending: those that no site claimed in float32, and those whose side float32 cannot
  /// decide.
  std::vector<std::size_t> unsettled;
  /// True if the nodes have the requested signs; otherwise the caller finds them.
  bool is_signed = false;
};

/// Computes fields on one device. Keeps connectivity and memory between fields.
class FieldBackend {
 public:
  FieldBackend() = default;
  FieldBackend(const FieldBackend&) = delete;
  FieldBackend& operator=(const FieldBackend&) = delete;
  virtual ~FieldBackend() = default;

  [[nodiscard]] virtual Device device() const = 0;

  /// Makes `mesh` the current mesh. Data that depend only on connectivity are kept while the connectivity stays the
  /// same. The mesh must stay alive until compute() returns.
  virtual void set_mesh(const MeshView& mesh, const Context& context) = 0;
  [[nodiscard]] virtual const SiteTable& sites() const = 0;

  /// Returns true if the caller finds the signs of a method, from the sites of the field.
  [[nodiscard]] virtual bool needs_sites_for(sign::Method method) const = 0;

  /// Fills the host memory of a request, and appends phase times.
  [[nodiscard]] virtual FieldResult compute(const FieldRequest& request, const Context& context,
                                            std::vector<PhaseTime>& phases) = 0;

  /// Fills the second order of the field that compute() made. Returns the nodes left to exact queries, ascending.
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
  /// Makes a valid image the current one. The image must stay alive. Later requests for it may differ in selection and
  /// memory.
  virtual void set_image(const VoxelImageView& image, const detail::ImageRequest& request) = 0;
  /// Returns the number of voxels that a request selects.
  [[nodiscard]] virtual std::size_t select(const detail::ImageRequest& request) = 0;
  /// Fills the host memory of the request that was selected last.
  virtual void transform(const detail::ImageRequest& request) = 0;
};

/// Returns the back end of context.device for fields of an order.
/// @param reason  gets the reason if `automatic` falls back to the CPU.
/// @throws DeviceError; InvalidOption if the order is 2 and a CUDA device is asked for.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(const Context& context, int order, std::string& reason);
/// Returns the image back end of context.device; null for the CPU. `reason` is as above.
/// @throws DeviceError.
[[nodiscard]] std::unique_ptr<ImageBackend> make_image_backend(const Context& context, std::string& reason);

}  // namespace blum
