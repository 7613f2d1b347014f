#include "field/cuda/cuda_backend.hpp"

#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/field/phase_timer.hpp"
#include "field/connectivity_cache.hpp"
#include "field/cuda/load_module.hpp"

namespace blum::cuda {
namespace {

/// A call into the module.
Call call_of(const Context& context) {
  Call call;
  call.context = &context;
  call.is_cancelled = [](const void* of) { return static_cast<const Context*>(of)->cancel.stop_requested(); };
  call.report = [](const void* of, double fraction) {
    const auto& progress = static_cast<const Context*>(of)->progress;
    if (progress) progress(fraction, "field");
  };
  return call;
}

void check(Status status, const Call& call) {
  switch (status) {
    case Status::done:
      return;
    case Status::out_of_memory:
      throw OutOfMemory(call.message);
    case Status::invalid_grid:
      throw InvalidGrid(call.message);
    case Status::invalid_option:
      throw InvalidOption(call.message);
    case Status::cancelled:
      throw Cancelled();
    case Status::device_error:
      break;
  }
  throw DeviceError(call.message);
}

/// An engine of the module on one device.
class ModuleEngine {
 public:
  explicit ModuleEngine(int index) : module_(load_module()) {
    Call call;
    check(module_.create(index, &engine_, &call), call);
  }
  ModuleEngine(const ModuleEngine&) = delete;
  ModuleEngine& operator=(const ModuleEngine&) = delete;
  ~ModuleEngine() { module_.destroy(engine_); }

  /// Calls a function of the module with the engine, arguments and a call.
  template <class Function, class... Arguments>
  void run(Function function, const Context& context, Arguments... arguments) const {
    Call call = call_of(context);
    check((module_.*function)(engine_, arguments..., &call), call);
  }

 private:
  const Module& module_;
  void* engine_ = nullptr;
};

class CudaFieldBackend final : public FieldBackend {
 public:
  explicit CudaFieldBackend(int index) : index_(index), engine_(index) {}

  [[nodiscard]] Device device() const override { return Device::cuda(index_); }
  [[nodiscard]] bool can_tell_sides() const override { return false; }
  [[nodiscard]] bool can_count_crossings() const override { return true; }

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
    if (request.level) {
      memory.is_signed = true;
      memory.level = *request.level;
    }
    engine_.run(&Module::compute, context, &mesh_, &memory);
    timer.lap("field");
    return {{}, memory.is_simple};
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
