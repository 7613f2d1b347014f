// Blum: transforms of images in the host's memory, computed on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "blum/field/device_memory.hpp"
#include "blum/grid/voxel_image.hpp"
#include "field/kernels/image_transform.hpp"

namespace blum::kernels {

/// Keeps an image on a device while its selections are transformed.
template <class Device>
class ImageEngine {
 public:
  explicit ImageEngine(Device& device) : device_(device), transform_(device) {}

  /// Uploads an image.
  /// @throws OutOfMemory if the device's memory is too small.
  void set_image(const VoxelImageView& image, const detail::ImageRequest& request) {
    image_ = image.values;
    transform_.set_request(request);
    voxels_ = request.voxel_count();
    std::visit([&](const auto& values) { device_.upload(std::as_bytes(values), values_); }, image.values);
    distance_.resize(voxels_);
    site_.resize(voxels_);
  }

  /// Returns the number of selected voxels.
  std::uint64_t select(const detail::ImageRequest& request) {
    std::visit(
        [&]<class T>(const std::span<const T>&) {
          transform_.select(reinterpret_cast<const T*>(values_.data()), request.selection);
        },
        image_);
    return transform_.selected_count();
  }

  /// Transforms the voxels that the last select() selected. Copies the result to the host's memory.
  void transform(const detail::ImageRequest& request) {
    transform_.run(distance_.data(), site_.data());
    device_.download(distance_.data(), voxels_, request.distance);
    if (request.site != nullptr) device_.download(site_.data(), voxels_, request.site);
  }

  /// Transforms an image in the device's memory, and writes to arrays there. Queues the work without waiting for it.
  void transform_there(const DeviceArrayView& values, const detail::ImageRequest& request) {
    transform_.set_request(request);
    with_type(values.type,
              [&]<class T>(T) { transform_.select(static_cast<const T*>(values.data), request.selection); });
    if (request.site == nullptr) site_.resize(request.voxel_count());  // the passes need them
    transform_.run(request.distance, request.site != nullptr ? request.site : site_.data());
  }

 private:
  /// Calls `work` with a value of the element type.
  template <class Work>
  static void with_type(ElementType type, const Work& work) {
    switch (type) {
      case ElementType::uint8:
        return work(std::uint8_t{});
      case ElementType::int8:
        return work(std::int8_t{});
      case ElementType::uint16:
        return work(std::uint16_t{});
      case ElementType::int16:
        return work(std::int16_t{});
      case ElementType::uint32:
        return work(std::uint32_t{});
      case ElementType::int32:
        return work(std::int32_t{});
      case ElementType::uint64:
        return work(std::uint64_t{});
      case ElementType::int64:
        return work(std::int64_t{});
      case ElementType::float32:
        return work(float{});
      case ElementType::float64:
        return work(double{});
    }
  }

  Device& device_;
  ImageTransform<Device> transform_;
  VoxelImageView::Values image_;  ///< only its type is used
  std::size_t voxels_ = 0;
  typename Device::template Array<std::byte> values_;
  typename Device::template Array<float> distance_;
  typename Device::template Array<std::uint32_t> site_;
};

}  // namespace blum::kernels
