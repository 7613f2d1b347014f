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
  /// Linear indices, ascending, of the nodes that the caller must settle by exact queries. Because of rounding to
  /// float32, these nodes lie in no site's domain, or their side is undecided.
  std::vector<std::size_t> unsettled;
  /// True if the distances have the signs that the request asks for. If false, the caller must find the signs.
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

  /// Makes `mesh` the current mesh. If the connectivity is that of the previous mesh, data that depend only on
  /// connectivity are kept. The mesh must stay alive until compute() returns.
  virtual void set_mesh(const MeshView& mesh, const Context& context) = 0;
  [[nodiscard]] virtual const SiteTable& sites() const = 0;

  /// Returns true if, for this method of signs, the caller must find the signs from the closest sites of the field.
  [[nodiscard]] virtual bool needs_sites_for(sign::Method method) const = 0;

  /// Writes the field to the request's host memory. Appends the durations of the phases to `phases`.
  [[nodiscard]] virtual FieldResult compute(const FieldRequest& request, const Context& context,
                                            std::vector<PhaseTime>& phases) = 0;

  /// Writes the second order (second-closest sites and their distances) of the field that compute() made. Returns the
  /// linear indices, ascending, of the nodes that the caller must settle by exact queries.
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
  /// Makes a valid image the current one. The image must stay alive while it is used. Later requests for this image may
  /// differ from `request` only in selection and result memory.
  virtual void set_image(const VoxelImageView& image, const detail::ImageRequest& request) = 0;
  /// Returns the number of voxels that a request selects.
  [[nodiscard]] virtual std::size_t select(const detail::ImageRequest& request) = 0;
  /// Writes the field of the request that was last passed to select() to the request's host memory.
  virtual void transform(const detail::ImageRequest& request) = 0;
};

/// Returns the back end of context.device for fields of order 1 or 2.
/// @param reason  receives the reason if the device is `automatic` and the CPU is used.
/// @throws DeviceError; InvalidOption if the order is 2 and a CUDA device is requested.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(const Context& context, int order, std::string& reason);
/// Returns the image back end of context.device; null for the CPU. `reason` is as for make_field_backend().
/// @throws DeviceError.
[[nodiscard]] std::unique_ptr<ImageBackend> make_image_backend(const Context& context, std::string& reason);

}  // namespace blum
