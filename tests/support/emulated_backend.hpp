// Blum: the CUDA back end's kernels, run on the host. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/backend.hpp"
#include "field/kernels/emulated_device.hpp"
#include "field/kernels/field_engine.hpp"
#include "field/kernels/image_engine.hpp"

namespace blum::test {

/// What CudaBackend does, with EmulatedDevice in place of the device.
class EmulatedBackend final : public FieldBackend {
 public:
  explicit EmulatedBackend(std::size_t slab_nodes) : fields_(device_, slab_nodes) {}

  [[nodiscard]] Device device() const override { return Device::cuda(); }
  [[nodiscard]] bool can_tell_sides() const override { return false; }
  [[nodiscard]] bool can_count_crossings() const override { return true; }
  void set_mesh(const MeshView& mesh, const Context& context) override {
    mesh_ = mesh;
    sites_ = SiteTable(mesh, context);
    fields_.set_connectivity(mesh);
  }
  [[nodiscard]] const SiteTable& sites() const override { return sites_; }
  [[nodiscard]] FieldResult compute(const FieldRequest& request, const Context& context, Field& field) override {
    const bool is_simple = fields_.compute(
        mesh_, {request.grid, request.band.value_or(0), request.level}, field.distance.data(),
        &field.site.data()->value, [&] { return context.cancel.stop_requested(); }, [](double) {});
    return {{}, is_simple};
  }

 private:
  kernels::EmulatedDevice device_;
  kernels::FieldEngine<kernels::EmulatedDevice> fields_;
  MeshView mesh_;
  SiteTable sites_;
};

/// Likewise for images.
class EmulatedImageBackend final : public ImageBackend {
 public:
  [[nodiscard]] Device device() const override { return Device::cuda(); }
  void set_image(const VoxelImageView& image, const detail::ImagePlan& plan) override {
    images_.set_image(image, plan);
  }
  [[nodiscard]] std::size_t select(const LabelSelection& selection) override { return images_.select(selection); }
  void transform(Field& field) override { images_.transform(field.distance.data(), &field.site.data()->value); }

 private:
  kernels::EmulatedDevice device_;
  kernels::ImageEngine<kernels::EmulatedDevice> images_{device_};
};

/// Lets Device::cuda() stand for these back ends while it is alive.
class EmulatedCuda {
 public:
  explicit EmulatedCuda(std::size_t slab_nodes = kernels::FieldEngine<kernels::EmulatedDevice>::default_slab_nodes) {
    replace_cuda({[=](int) { return std::make_unique<EmulatedBackend>(slab_nodes); },
                  [](int) { return std::make_unique<EmulatedImageBackend>(); }});
  }
  EmulatedCuda(const EmulatedCuda&) = delete;
  EmulatedCuda& operator=(const EmulatedCuda&) = delete;
  ~EmulatedCuda() { replace_cuda({}); }
};

}  // namespace blum::test
