// Blum: launches kernels and keeps memory on a CUDA device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "field/cuda/cuda_block.cuh"
#include "field/cuda/cuda_check.cuh"
#include "field/kernels/host_device.hpp"

namespace blum::cuda {

/// Memory of the current device. The memory grows and never shrinks, so that later frames allocate nothing.
template <class T>
class CudaArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  CudaArray() = default;
  CudaArray(CudaArray&& other) noexcept { swap(other); }
  CudaArray& operator=(CudaArray&& other) noexcept {
    swap(other);
    return *this;
  }
  CudaArray(const CudaArray&) = delete;
  CudaArray& operator=(const CudaArray&) = delete;
  ~CudaArray() { (void)cudaFree(data_); }

  /// Sets the size. If the size exceeds the capacity, new memory is allocated and the content is lost.
  /// @param room  smallest capacity to allocate.
  /// @throws OutOfMemory.
  void resize(std::size_t count, std::size_t room = 0) {
    room = std::max(room, count);
    if (room > capacity_) {
      (void)cudaFree(std::exchange(data_, nullptr));
      capacity_ = 0;
      size_ = 0;
      check(cudaMalloc(reinterpret_cast<void**>(&data_), room * sizeof(T)),
            ("allocating " + std::to_string(room * sizeof(T)) + " bytes").c_str());
      capacity_ = room;
    }
    size_ = count;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] const T* data() const { return data_; }

  void swap(CudaArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

template <class T>
struct FillArray {
  T* data;
  T value;
  __device__ void operator()(std::size_t k) const { data[k] = value; }
};

template <class Body>
__global__ void for_each_kernel(const __grid_constant__ Body body, const std::size_t count) {
  const std::size_t index = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (index < count) body(index);
}

/// Checks that the current device can run the compiled code of this file.
/// @throws DeviceError.
template <class Body>
void expect_runnable() {
  cudaFuncAttributes attributes{};
  check(cudaFuncGetAttributes(&attributes, for_each_kernel<Body>),
        "loading kernels, which were not built for this device's compute capability");
}

template <class Body>
__global__ void __launch_bounds__(Body::threads, Body::blocks_per_processor)
    block_kernel(const __grid_constant__ Body body) {
  extern __shared__ __align__(16) unsigned char storage[];
  auto& shared = *reinterpret_cast<typename Body::Shared*>(storage);
  body(CudaBlock<Body::threads>{}, shared, blockIdx.x);
}

/// Queues all work on one stream. The functions download() and wait() wait for all queued work. The function await()
/// waits for the work before a mark. Only fetch() copies on a separate stream.
class CudaDevice {
 public:
  template <class T>
  using Array = CudaArray<T>;

  explicit CudaDevice(cudaStream_t stream) : stream_(stream) {
    check(cudaStreamCreateWithFlags(&copies_, cudaStreamNonBlocking), "making a stream");
    for (cudaEvent_t& mark : marks_) check(cudaEventCreateWithFlags(&mark, cudaEventDisableTiming), "making an event");
  }
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;
  ~CudaDevice() {
    for (const cudaEvent_t mark : marks_) (void)cudaEventDestroy(mark);
    (void)cudaStreamDestroy(copies_);
  }
  [[nodiscard]] cudaStream_t stream() const { return stream_; }
  /// Queues all later work on another stream.
  void use(cudaStream_t stream) { stream_ = stream; }

  template <class T>
  void upload(std::span<const T> from, Array<T>& to) const {
    to.resize(from.size());
    if (from.empty()) return;
    check(cudaMemcpyAsync(to.data(), from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream_), "upload");
  }
  template <class T>
  void download(const T* from, std::size_t count, T* to) const {
    check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream_), "download");
    wait();
  }
  template <class T>
  void fill(Array<T>& array, const T& value) const {
    for_each(array.size(), FillArray<T>{array.data(), value});
  }

  template <class Body>
  void for_each(std::size_t count, const Body& body) const {
    constexpr unsigned threads = 256;
    if (count == 0) return;
    for_each_kernel<<<static_cast<unsigned>((count + threads - 1) / threads), threads, 0, stream_>>>(body, count);
    check(cudaGetLastError(), "launching a kernel");
  }
  template <class Body>
  void run_blocks(std::size_t count, const Body& body) const {
    if (count == 0) return;
    constexpr std::size_t shared = sizeof(typename Body::Shared);
    check(
        cudaFuncSetAttribute(block_kernel<Body>, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(shared)),
        "requesting shared memory");
    block_kernel<Body><<<static_cast<unsigned>(count), Body::threads, shared, stream_>>>(body);
    check(cudaGetLastError(), "launching a kernel");
  }

  template <class Key>
  void sort_pairs(Array<Key>& keys, Array<std::uint32_t>& values, int bits) {
    Array<Key>& sorted_keys = sorted_keys_of(Key{});
    // Keys and scratch buffers are swapped below. Each gets room for the largest sort so far, so that later frames
    // allocate nothing.
    largest_sort_ = std::max(largest_sort_, keys.size());
    sorted_keys.resize(keys.size(), largest_sort_);
    sorted_values_.resize(keys.size(), largest_sort_);
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortPairs(scratch, bytes, keys.data(), sorted_keys.data(), values.data(),
                                             sorted_values_.data(), keys.size(), 0, bits, stream_);
    });
    keys.swap(sorted_keys);
    values.swap(sorted_values_);
  }
  void exclusive_sum(const Array<std::uint32_t>& in, Array<std::uint32_t>& out) {
    out.resize(in.size());
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(scratch, bytes, in.data(), out.data(), in.size(), stream_);
    });
  }
  template <class T, class Load, class Combine>
  void reduce(std::size_t count, const Load& load, const T& first, const Combine& combine, T* out) {
    // DeviceReduce::TransformReduce requires CUDA 12.5 or later. Counts fit in an int, because there are fewer than
    // 2^31 ids.
    const auto values = thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0), load);
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceReduce::Reduce(scratch, bytes, values, out, static_cast<int>(count), combine, first, stream_);
    });
  }
  void wait() const { check(cudaStreamSynchronize(stream_), "waiting for the device"); }
  void mark(int which) const { check(cudaEventRecord(marks_[which], stream_), "marking"); }
  void await(int which) const { check(cudaEventSynchronize(marks_[which]), "waiting for the device"); }
  template <class T>
  void fetch(const T* from, std::size_t count, T* to) const {
    check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, copies_), "download");
    check(cudaStreamSynchronize(copies_), "download");
  }

 private:
  /// Calls `work` twice, as CUB requires: first to get the size of its scratch memory, then with that memory.
  template <class Work>
  void with_scratch(const Work& work) {
    std::size_t bytes = 0;
    check(work(nullptr, bytes), "requesting scratch memory");
    scratch_.resize(bytes == 0 ? 1 : bytes);
    check(work(scratch_.data(), bytes), "a parallel primitive");
  }
  Array<std::uint32_t>& sorted_keys_of(std::uint32_t) { return sorted_short_keys_; }
  Array<std::uint64_t>& sorted_keys_of(std::uint64_t) { return sorted_long_keys_; }

  cudaStream_t stream_;
  cudaStream_t copies_ = nullptr;
  cudaEvent_t marks_[2] = {};
  Array<unsigned char> scratch_;
  std::size_t largest_sort_ = 0;
  Array<std::uint32_t> sorted_values_;
  Array<std::uint32_t> sorted_short_keys_;
  Array<std::uint64_t> sorted_long_keys_;
};

}  // namespace blum::cuda
