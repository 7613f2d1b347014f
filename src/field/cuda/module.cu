// The CUDA module: everything behind its functions throws nothing.
#include "field/cuda/module_interface.hpp"

#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "field/cuda/cuda_device.cuh"
#include "field/kernels/field_engine.hpp"
#include "field/kernels/image_engine.hpp"

namespace blum::cuda {
namespace {

/// A stream that ends with its owner.
class Stream {
 public:
  Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream"); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() { (void)cudaStreamDestroy(stream_); }
  [[nodiscard]] cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

/// One device and what it keeps for a solver.
struct Engine {
  explicit Engine(int device_index) : index(device_index), device(stream.get()), fields(device), images(device) {}

  int index;
  Stream stream;
  CudaDevice device;
  kernels::FieldEngine<CudaDevice> fields;
  kernels::ImageEngine<CudaDevice> images;
};

/// Runs work on a device and turns what it throws into a status. The host's choice of a device is left as it was.
template <class Work>
Status guarded(int device, Call* call, const Work& work) {
  int before = 0;
  const bool had_device = cudaGetDevice(&before) == cudaSuccess;
  Status status = Status::done;
  const auto fail = [&](Status kind, const char* what) {
    std::snprintf(call->message, sizeof(call->message), "%s", what);
    status = kind;
  };
  try {
    check(cudaSetDevice(device), "choosing the device");
    work();
  } catch (const OutOfMemory& error) {
    fail(Status::out_of_memory, error.what());
  } catch (const InvalidGrid& error) {
    fail(Status::invalid_grid, error.what());
  } catch (const InvalidOption& error) {
    fail(Status::invalid_option, error.what());
  } catch (const std::bad_alloc&) {
    fail(Status::out_of_memory, "not enough memory on the host");
  } catch (const Cancelled& error) {
    fail(Status::cancelled, error.what());
  } catch (const std::exception& error) {
    fail(Status::device_error, error.what());
  }
  if (had_device && before != device) (void)cudaSetDevice(before);
  (void)cudaGetLastError();  // or the next launch would report what was ignored here
  return status;
}

void expect_device(int device) {
  int count = 0;
  check(cudaGetDeviceCount(&count), "looking for devices");
  if (device < count) return;
  throw DeviceError("there is no CUDA device " + std::to_string(device) + ": " + std::to_string(count) +
                    " can be seen, counted from 0");
}

Status create(int device, void** engine, Call* call) {
  *engine = nullptr;
  try {
    expect_device(device);
  } catch (const std::exception& error) {
    std::snprintf(call->message, sizeof(call->message), "%s", error.what());
    return Status::device_error;
  }
  return guarded(device, call, [&] {
    expect_runnable<kernels::MakeFrame>();
    *engine = new Engine(device);
  });
}

void destroy(void* engine) {
  auto* own = static_cast<Engine*>(engine);
  if (own == nullptr) return;
  Call call;
  (void)guarded(own->index, &call, [&] { delete own; });
}

Status set_connectivity(void* engine, const MeshView* mesh, Call* call) {
  auto& own = *static_cast<Engine*>(engine);
  return guarded(own.index, call, [&] { own.fields.set_connectivity(*mesh); });
}

Status compute(void* engine, const MeshView* mesh, FieldMemory* field, Call* call) {
  auto& own = *static_cast<Engine*>(engine);
  return guarded(own.index, call, [&] {
    const auto level = field->is_signed ? std::optional<std::int32_t>(field->level) : std::nullopt;
    field->is_simple = own.fields.compute(
        *mesh, {*field->grid, field->band, level}, field->distance, field->site,
        [&] { return call->is_cancelled(call->context); },
        [&](double fraction) { call->report(call->context, fraction); });
  });
}

Status set_image(void* engine, const VoxelImageView* image, const detail::ImagePlan* plan, Call* call) {
  auto& own = *static_cast<Engine*>(engine);
  return guarded(own.index, call, [&] { own.images.set_image(*image, *plan); });
}

Status select_voxels(void* engine, const LabelSelection* selection, std::size_t* selected, Call* call) {
  auto& own = *static_cast<Engine*>(engine);
  return guarded(own.index, call, [&] { *selected = own.images.select(*selection); });
}

Status transform_image(void* engine, float* distance, std::uint32_t* site, Call* call) {
  auto& own = *static_cast<Engine*>(engine);
  return guarded(own.index, call, [&] { own.images.transform(distance, site); });
}

}  // namespace
}  // namespace blum::cuda

extern "C" __attribute__((visibility("default"))) const blum::cuda::Module* blum_cuda_module() {
  using namespace blum::cuda;
  static const Module module{module_version, create,    destroy,       set_connectivity,
                             compute,        set_image, select_voxels, transform_image};
  return &module;
}
