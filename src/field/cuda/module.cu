// The CUDA module, a shared library. No exception leaves its functions.
#include <algorithm>
#include <cstdint>
#include <string>

#include "field/cuda/cuda_device.cuh"
#include "field/cuda/module_functions.hpp"

namespace blum::cuda {
namespace {

/// Stream that is destroyed with this object.
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

/// Event that is destroyed with this object.
class Event {
 public:
  Event() { check(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "making an event"); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event() { (void)cudaEventDestroy(event_); }
  [[nodiscard]] cudaEvent_t get() const { return event_; }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Queues work on its own stream, or on a stream that the caller lends. All work uses the same memory, so each task
/// waits for the previous task.
class CudaQueue {
 public:
  CudaQueue() : device_(stream_.get()) {}
  CudaQueue(const CudaQueue&) = delete;
  CudaQueue& operator=(const CudaQueue&) = delete;

  [[nodiscard]] CudaDevice& device() { return device_; }
  void enter(void* stream) {
    const auto other = static_cast<cudaStream_t>(stream);
    if (queued_ > 0) check(cudaStreamWaitEvent(other, event_of(queued_ - 1), 0), "ordering streams");
    device_.use(other);
  }
  void leave() {
    // If all events are in use, wait for the oldest one before reusing it.
    if (queued_ - finished_ == events) {
      (void)cudaEventSynchronize(event_of(finished_));
      ++finished_;
    }
    // If the event cannot be recorded, wait for the whole device. Otherwise, waiting for this work would wait for the
    // older event of this slot.
    if (cudaEventRecord(event_of(queued_++), device_.stream()) != cudaSuccess) (void)cudaDeviceSynchronize();
    device_.use(stream_.get());
  }
  [[nodiscard]] std::uint64_t queued() const { return queued_; }
  [[nodiscard]] std::uint64_t finished() {
    while (finished_ < queued_ && cudaEventQuery(event_of(finished_)) == cudaSuccess) ++finished_;
    return finished_;
  }
  void wait() {
    if (queued_ > 0) (void)cudaEventSynchronize(event_of(queued_ - 1));
  }
  void follow(std::uint64_t pieces, void* stream) {
    pieces = std::min(pieces, queued_);
    if (pieces <= finished()) return;
    check(cudaStreamWaitEvent(static_cast<cudaStream_t>(stream), event_of(pieces - 1), 0), "ordering streams");
  }
  void order(void* before, void* after) {
    check(cudaEventRecord(other_.get(), static_cast<cudaStream_t>(before)), "ordering streams");
    check(cudaStreamWaitEvent(static_cast<cudaStream_t>(after), other_.get(), 0), "ordering streams");
  }

 private:
  static constexpr std::uint64_t events = 64;
  [[nodiscard]] cudaEvent_t event_of(std::uint64_t number) const { return done_[number % events].get(); }

  Stream stream_;
  Event done_[events];  ///< one for each recent task on a lent stream
  Event other_;         ///< used for streams that belong to others
  std::uint64_t queued_ = 0;
  std::uint64_t finished_ = 0;
  CudaDevice device_;
};

struct CudaPlatform {
  using Device = CudaDevice;
  using Queue = CudaQueue;

  /// Makes a device the current one, and restores the previous choice when destroyed.
  class Choice {
   public:
    explicit Choice(int device) : device_(device) {
      had_device_ = cudaGetDevice(&before_) == cudaSuccess;
      check(cudaSetDevice(device), "choosing the device");
    }
    Choice(const Choice&) = delete;
    Choice& operator=(const Choice&) = delete;
    ~Choice() {
      if (had_device_ && before_ != device_) (void)cudaSetDevice(before_);
      (void)cudaGetLastError();  // clears ignored errors; otherwise the next launch would report them
    }

   private:
    int device_;
    int before_ = 0;
    bool had_device_ = false;
  };

  static void expect_runnable() { cuda::expect_runnable<kernels::MakeFrame>(); }
  static void expect_device(int device) {
    int driver = 0;
    if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) {
      throw DeviceError(
          "no NVIDIA driver is visible: install one, or make its devices visible in the container; nvidia-smi lists "
          "them");
    }
    int count = 0;
    check(cudaGetDeviceCount(&count), "looking for devices");
    if (device < count) return;
    throw DeviceError("there is no CUDA device " + std::to_string(device) + ": " + std::to_string(count) +
                      " visible, counted from 0");
  }
  static int device_of(const void* memory) {
    cudaPointerAttributes attributes{};
    check(cudaPointerGetAttributes(&attributes, memory), "querying the owner of memory");
    const bool is_on_device = attributes.type == cudaMemoryTypeDevice || attributes.type == cudaMemoryTypeManaged;
    return is_on_device ? attributes.device : -1;
  }
  static void* allocate(std::size_t bytes) {
    void* memory = nullptr;
    check(cudaMalloc(&memory, bytes), ("allocating " + std::to_string(bytes) + " bytes").c_str());
    return memory;
  }
  static void release(void* memory) { (void)cudaFree(memory); }
  static std::string name_of(int device) { return properties_of(device).name; }
  static std::uint64_t memory_of(int device) { return properties_of(device).totalGlobalMem; }
  static cudaDeviceProp properties_of(int device) {
    cudaDeviceProp properties{};
    check(cudaGetDeviceProperties(&properties, device), "querying the device");
    return properties;
  }
  static std::size_t slab_nodes() { return kernels::FieldEngine<CudaDevice>::default_slab_nodes; }
};

}  // namespace
}  // namespace blum::cuda

extern "C" __attribute__((visibility("default"))) const blum::cuda::Module* blum_cuda_module() {
  return blum::cuda::ModuleFunctions<blum::cuda::CudaPlatform>::table();
}
