#include "field/cuda/cuda_backend.hpp"

#include <utility>

#include "blum/core/phase_timer.hpp"
#include "field/connectivity_cache.hpp"
#include "field/cuda/module_engine.hpp"

namespace blum::cuda {
namespace {

class CudaFieldBackend final : public FieldBackend {
 public:
  explicit CudaFieldBackend(int index) : index_(index), engine_(index) {}

  [[nodiscard]] Device device() const override { return Device::cuda(index_); }
  [[nodiscard]] bool can_tell_sides() const override { return false; }

  void set_mesh(const MeshView& mesh, const Context& context) override {
    mesh_ = mesh;
    if (connectivity_.holds(mesh)) return;
    connectivity_.clear();
    sites_ = SiteTable(mesh, context);
    engine_.run(&Module::set_connectivity, context, &mesh);
    connectivity_.store(mesh);
  }
  [[nodiscard]] const SiteTable& sites() const override { return sites_; }

  [[nodiscard]] FieldResult compute(const FieldRequest& request, const Context& context, Field& field) override {
    PhaseTimer timer(field.phases);
    FieldMemory memory{&request.grid, request.band.value_or(0), field.distance.data(), &field.site.data()->value};
    memory.wants_signs = request.level.has_value();
    memory.level = request.level.value_or(0);
    engine_.run(&Module::compute, context, &mesh_, &memory);
    timer.lap("field");
    return {{}, memory.is_signed};
  }

 private:
  int index_;
  ModuleEngine engine_;
  MeshView mesh_;
  ConnectivityCache connectivity_;
  SiteTable sites_;
};

class CudaImageBackend final : public ImageBackend {
 public:
  explicit CudaImageBackend(int index) : index_(index), engine_(index) {}

  [[nodiscard]] Device device() const override { return Device::cuda(index_); }
  void set_image(const VoxelImageView& image, const detail::ImagePlan& plan) override {
    engine_.run(&Module::set_image, Context{}, &image, &plan);
  }
  [[nodiscard]] std::size_t select(const LabelSelection& selection) override {
    std::size_t selected = 0;
    engine_.run(&Module::select_voxels, Context{}, &selection, &selected);
    return selected;
  }
  void transform(Field& field) override {
    engine_.run(&Module::transform_image, Context{}, field.distance.data(), &field.site.data()->value);
  }

 private:
  int index_;
  ModuleEngine engine_;
};

}  // namespace

std::unique_ptr<FieldBackend> make_field_backend(int index) {
  return std::make_unique<CudaFieldBackend>(index);
}

std::unique_ptr<ImageBackend> make_image_backend(int index) {
  return std::make_unique<CudaImageBackend>(index);
}

}  // namespace blum::cuda
