// Blum: CUDA's warps and blocks, with the interface that field/kernels uses. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "field/kernels/host_device.hpp"

namespace blum::cuda {

inline constexpr unsigned whole_warp = 0xffffffffU;

/// Device counterpart of EmulatedWarp, which describes the members.
class CudaWarp {
 public:
  template <class T>
  class Lanes {
   public:
    __device__ T& operator[](std::uint32_t) { return value_; }
    __device__ const T& operator[](std::uint32_t) const { return value_; }

   private:
    T value_{};
  };

  [[nodiscard]] __device__ std::uint32_t index() const { return threadIdx.x / kernels::warp_size; }

  template <class Step>
  __device__ void each(const Step& step) const {
    step(lane());
    __syncwarp();
  }
  template <class Question>
  [[nodiscard]] __device__ std::uint32_t ballot(const Question& question) const {
    return __ballot_sync(whole_warp, question(lane()) ? 1 : 0);
  }
  template <class Value>
  [[nodiscard]] __device__ std::uint64_t smallest(const Value& value) const {
    std::uint64_t result = value(lane());
    for (int step = kernels::warp_size / 2; step > 0; step /= 2) {
      const std::uint64_t other = __shfl_xor_sync(whole_warp, result, step);
      result = other < result ? other : result;
    }
    return result;
  }
  template <class T>
  [[nodiscard]] __device__ T broadcast(const Lanes<T>& values, std::uint32_t from) const {
    static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
    T result = values[from];
    auto* words = reinterpret_cast<std::uint32_t*>(&result);
    for (std::size_t k = 0; k < sizeof(T) / sizeof(std::uint32_t); ++k) {
      words[k] = __shfl_sync(whole_warp, words[k], static_cast<int>(from));
    }
    return result;
  }
  template <class T>
  __device__ void add_up(Lanes<T>& values) const {
    T sum = values[lane()];
    for (unsigned step = 1; step < kernels::warp_size; step *= 2) {
      const T other = __shfl_up_sync(whole_warp, sum, step);
      if (lane() >= step) sum += other;
    }
    values[lane()] = sum;
  }
  [[nodiscard]] __device__ std::uint32_t claim(std::uint32_t& counter, std::uint32_t count) const {
    std::uint32_t before = 0;
    if (lane() == 0) before = atomicAdd(&counter, count);
    return __shfl_sync(whole_warp, before, 0);
  }

 private:
  [[nodiscard]] static __device__ std::uint32_t lane() { return threadIdx.x % kernels::warp_size; }
};

/// Device counterpart of EmulatedBlock, which describes the members.
template <std::uint32_t threads>
class CudaBlock {
 public:
  using Warp = CudaWarp;

  template <class T>
  class PerThread {
   public:
    __device__ T& at(const Warp&, std::uint32_t) { return value_; }

   private:
    T value_{};
  };

  template <class Step>
  __device__ void each_warp(const Step& step) const {
    step(Warp{});
    __syncthreads();
  }
  template <class Step>
  __device__ void once(const Step& step) const {
    if (threadIdx.x == 0) step();
    __syncthreads();
  }
  template <class T>
  [[nodiscard]] __device__ T read(const T& shared) const {
    const T value = shared;
    __syncthreads();
    return value;
  }
};

}  // namespace blum::cuda
