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
    case Status::cancelled:
      throw Cancelled();
    case Status::device_error:
      break;
  }
  throw DeviceError(call.message);
}

class CudaBackend final : public FieldBackend {
 public:
  explicit CudaBackend(int index) : index_(index), module_(load_module()) {
    Call call;
    check(module_.create(index, &engine_, &call), call);
  }
  CudaBackend(const CudaBackend&) = delete;
  CudaBackend& operator=(const CudaBackend&) = delete;
  ~CudaBackend() override { module_.destroy(engine_); }

  [[nodiscard]] Device device() const override { return Device::cuda(index_); }
  [[nodiscard]] bool can_tell_sides() const override { return false; }
  [[nodiscard]] bool can_count_crossings() const override { return true; }

  void set_mesh(const MeshView& mesh, const Context& context) override {
    mesh_ = mesh;
    if (connectivity_.holds(mesh)) return;
    connectivity_.clear();
    sites_ = SiteTable(mesh, context);
    Call call = call_of(context);
    check(module_.set_connectivity(engine_, &mesh, &call), call);
    connectivity_.store(mesh);
  }
  [[nodiscard]] const SiteTable& sites() const override { return sites_; }

  [[nodiscard]] FieldResult compute(const FieldRequest& request, const Context& context, Field& field) override {
    PhaseTimer timer(field.phases);
    Call call = call_of(context);
    FieldMemory memory{&request.grid, request.band.value_or(0), field.distance.data(), &field.site.data()->value};
    if (request.level) {
      memory.is_signed = true;
      memory.level = *request.level;
    }
    check(module_.compute(engine_, &mesh_, &memory, &call), call);
    timer.lap("field");
    return {{}, memory.is_simple};
  }

 private:
  int index_;
  const Module& module_;
  void* engine_ = nullptr;
  MeshView mesh_;
  ConnectivityCache connectivity_;
  SiteTable sites_;
};

}  // namespace

std::unique_ptr<FieldBackend> make_backend(int index) {
  return std::make_unique<CudaBackend>(index);
}

}  // namespace blum::cuda
