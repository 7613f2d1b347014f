#include "field/cuda/cuda_backend.hpp"

#include <vector>

#include "blum/core/phase_timer.hpp"
#include "field/connectivity_cache.hpp"
#include "field/cuda/module_engine.hpp"

namespace blum::cuda {
namespace {

class CudaFieldBackend final : public FieldBackend {
 public:
  explicit CudaFieldBackend(int index) : index_(index), engine_(index) {}

  [[nodiscard]] Device device() const override { return Device::cuda(index_); }
  void set_mesh(const MeshView& mesh, const Context& context) override {
    mesh_ = mesh;
    if (connectivity_.holds(mesh)) return;
    connectivity_.clear();
    sites_ = SiteTable(mesh, context);
    engine_.run(&Module::set_connectivity, context, &mesh);
    connectivity_.store(mesh);
  }
  [[nodiscard]] const SiteTable& sites() const override { return sites_; }

  [[nodiscard]] bool needs_sites_for(sign::Method method) const override {
    return method == sign::Method::pseudonormals;
  }
  [[nodiscard]] FieldResult compute(const FieldRequest& request, const Context& context,
                                    std::vector<PhaseTime>& phases) override {
    PhaseTimer timer(phases);
    FieldResult result;
    engine_.run(&Module::compute, context, &mesh_, &request, &result.is_signed);
    timer.lap("field");
    return result;
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
  void set_image(const VoxelImageView& image, const detail::ImageRequest& request) override {
    engine_.run(&Module::set_image, Context{}, &image, &request);
  }
  [[nodiscard]] std::size_t select(const detail::ImageRequest& request) override {
    std::size_t selected = 0;
    engine_.run(&Module::select_voxels, Context{}, &request, &selected);
    return selected;
  }
  void transform(const detail::ImageRequest& request) override {
    engine_.run(&Module::transform_image, Context{}, &request);
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
