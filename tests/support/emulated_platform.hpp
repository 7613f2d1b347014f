// Blum: the CUDA module's functions on the host. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <string>

#include "blum/core/error.hpp"
#include "field/cuda/module_functions.hpp"
#include "field/kernels/emulated_device.hpp"

namespace blum::test {

/// One device that uses the host's memory and completes work as soon as it is queued.
struct EmulatedPlatform {
  using Device = kernels::EmulatedDevice;

  class Queue {
   public:
    [[nodiscard]] Device& device() { return device_; }
    void enter(void*) {}
    void leave() { ++queued_; }
    [[nodiscard]] std::uint64_t queued() const { return queued_; }
    [[nodiscard]] std::uint64_t finished() const { return queued_; }
    void follow(std::uint64_t, void*) {}
    void order(void*, void*) {}
    void wait() {}

   private:
    Device device_;
    std::uint64_t queued_ = 0;
  };
  struct Choice {
    explicit Choice(int) {}
  };

  static void expect_device(int device) {
    if (device == 0) return;
    throw DeviceError("there is no CUDA device " + std::to_string(device) + ": 1 visible, counted from 0");
  }
  static void expect_runnable() {}
  static int device_of(const void*) { return 0; }
  static void* allocate(std::size_t bytes) { return ::operator new(bytes); }
  static void release(void* memory) { ::operator delete(memory); }
  static std::string name_of(int) { return "emulated"; }
  static std::uint64_t memory_of(int) { return 0; }
  static std::size_t slab_nodes() { return wanted_slab_nodes; }

  inline static std::size_t wanted_slab_nodes = kernels::FieldEngine<Device>::default_slab_nodes;
};

}  // namespace blum::test
