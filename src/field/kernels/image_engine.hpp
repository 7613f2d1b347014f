// Blum: transforms of images in the host's memory, computed on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "blum/grid/voxel_image.hpp"
#include "field/kernels/image_transform.hpp"

namespace blum::kernels {

/// Keeps an image on a device while its selections are transformed.
template <class Device>
class ImageEngine {
 public:
  explicit ImageEngine(Device& device) : device_(device), transform_(device) {}

  /// Uploads an image. @throws OutOfMemory where the device cannot hold it.
  void set_image(const VoxelImageView& image, const detail::ImagePlan& plan) {
    image_ = image.values;
    transform_.set_plan(plan);
    voxels_ = plan.voxel_count();
    std::visit([&](const auto& values) { device_.upload(std::as_bytes(values), values_); }, image.values);
    distance_.resize(voxels_);
    site_.resize(voxels_);
  }

  /// How many voxels are selected.
  std::uint64_t select(const LabelSelection& selection) {
    std::visit(
        [&]<class T>(const std::span<const T>&) {
          transform_.select(reinterpret_cast<const T*>(values_.data()), selection);
        },
        image_);
    return transform_.selected_count();
  }

  /// Of the last selection.
  void transform(float* distance, std::uint32_t* site) {
    transform_.run(distance_.data(), site_.data());
    device_.download(distance_.data(), voxels_, distance);
    device_.download(site_.data(), voxels_, site);
  }

 private:
  Device& device_;
  ImageTransform<Device> transform_;
  VoxelImageView::Values image_;  ///< for its type
  std::size_t voxels_ = 0;
  typename Device::template Array<std::byte> values_;
  typename Device::template Array<float> distance_;
  typename Device::template Array<std::uint32_t> site_;
};

}  // namespace blum::kernels
