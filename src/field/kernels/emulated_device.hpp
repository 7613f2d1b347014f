// Blum: runs kernels on the host, for the tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "field/kernels/host_device.hpp"

namespace blum::kernels {

/// Lanes of a warp, run one after the other. A kernel is a sequence of steps that all lanes run together, and of
/// collective operations (ballot, smallest). Values that a lane keeps between steps are in Lanes.
class EmulatedWarp {
 public:
  template <class T>
  class Lanes {
   public:
    BLUM_HD T& operator[](std::uint32_t lane) { return value_[lane]; }
    BLUM_HD const T& operator[](std::uint32_t lane) const { return value_[lane]; }

   private:
    std::array<T, warp_size> value_{};
  };

  BLUM_HD explicit EmulatedWarp(std::uint32_t index) : index_(index) {}
  [[nodiscard]] BLUM_HD std::uint32_t index() const { return index_; }

  template <class Step>
  BLUM_HD void each(const Step& step) const {
    for (std::uint32_t lane = 0; lane < warp_size; ++lane) step(lane);
  }
  template <class Question>
  [[nodiscard]] BLUM_HD std::uint32_t ballot(const Question& question) const {
    std::uint32_t result = 0;
    for (std::uint32_t lane = 0; lane < warp_size; ++lane) result |= question(lane) ? 1U << lane : 0U;
    return result;
  }
  /// Returns the smallest value of all lanes.
  template <class Value>
  [[nodiscard]] BLUM_HD std::uint64_t smallest(const Value& value) const {
    std::uint64_t result = value(0);
    for (std::uint32_t lane = 1; lane < warp_size; ++lane) result = std::min<std::uint64_t>(result, value(lane));
    return result;
  }
  template <class T>
  [[nodiscard]] BLUM_HD T broadcast(const Lanes<T>& values, std::uint32_t lane) const {
    return values[lane];
  }
  /// Replaces each lane's value by the sum of the values of all lanes up to and including it.
  template <class T>
  BLUM_HD void add_up(Lanes<T>& values) const {
    for (std::uint32_t lane = 1; lane < warp_size; ++lane) values[lane] += values[lane - 1];
  }
  /// Adds `count` to a counter in shared memory and returns its previous value.
  [[nodiscard]] BLUM_HD std::uint32_t claim(std::uint32_t& counter, std::uint32_t count) const {
    return std::exchange(counter, counter + count);
  }

 private:
  std::uint32_t index_;
};

/// Threads of a block, run warp after warp. Code between two steps of a block must have the same effect on all threads.
template <std::uint32_t threads>
class EmulatedBlock {
 public:
  using Warp = EmulatedWarp;
  static constexpr std::uint32_t warps = threads / warp_size;

  /// Value that each thread keeps from step to step.
  template <class T>
  class PerThread {
   public:
    BLUM_HD T& at(const Warp& warp, std::uint32_t lane) { return value_[warp.index() * warp_size + lane]; }

   private:
    std::array<T, threads> value_{};
  };

  template <class Step>
  BLUM_HD void each_warp(const Step& step) const {
    for (std::uint32_t w = 0; w < warps; ++w) step(Warp(w));
  }
  /// Runs a step once, on one thread of the block. All threads see its effect.
  template <class Step>
  BLUM_HD void once(const Step& step) const {
    step();
  }
  /// Returns a value in shared memory. All threads read it before any thread can change it.
  template <class T>
  [[nodiscard]] BLUM_HD T read(const T& shared) const {
    return shared;
  }
};

/// Memory of a device. The emulated device uses the host's memory.
template <class T>
class EmulatedArray {
 public:
  void resize(std::size_t count) { value_.resize(count); }
  [[nodiscard]] std::size_t size() const { return value_.size(); }
  [[nodiscard]] T* data() { return value_.data(); }
  [[nodiscard]] const T* data() const { return value_.data(); }

 private:
  std::vector<T> value_;
};

/// Device that runs kernels as loops, with the same bodies, blocks and lists as on a GPU.
class EmulatedDevice {
 public:
  template <class T>
  using Array = EmulatedArray<T>;

  template <class T>
  void upload(std::span<const T> from, Array<T>& to) const {
    to.resize(from.size());
    std::copy(from.begin(), from.end(), to.data());
  }
  template <class T>
  void download(const T* from, std::size_t count, T* to) const {
    std::copy_n(from, count, to);
  }
  template <class T>
  void fill(Array<T>& array, const T& value) const {
    std::fill_n(array.data(), array.size(), value);
  }

  /// Calls body(index) for all indices in [0, count), in any order.
  template <class Body>
  void for_each(std::size_t count, const Body& body) const {
    for (std::size_t k = 0; k < count; ++k) body(k);
  }
  /// Runs `count` blocks of Body::threads threads: body(block, shared, index).
  template <class Body>
  void run_blocks(std::size_t count, const Body& body) const {
    const auto shared = std::make_unique<typename Body::Shared>();
    for (std::size_t k = 0; k < count; ++k) body(EmulatedBlock<Body::threads>{}, *shared, k);
  }

  /// Sorts pairs by the lowest `bits` bits of their keys. The sort is stable.
  template <class Key>
  void sort_pairs(Array<Key>& keys, Array<std::uint32_t>& values, int bits) const {
    const Key mask = bits >= static_cast<int>(8 * sizeof(Key)) ? ~Key{0} : (Key{1} << bits) - 1;
    std::vector<std::size_t> order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const Key key_a = keys.data()[a] & mask;
      const Key key_b = keys.data()[b] & mask;
      return key_a != key_b ? key_a < key_b : a < b;
    });
    Array<Key> sorted_keys;
    Array<std::uint32_t> sorted_values;
    sorted_keys.resize(keys.size());
    sorted_values.resize(keys.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      sorted_keys.data()[k] = keys.data()[order[k]];
      sorted_values.data()[k] = values.data()[order[k]];
    }
    std::swap(keys, sorted_keys);
    std::swap(values, sorted_values);
  }
  /// Computes exclusive sums: out[k] = in[0] + ... + in[k - 1].
  void exclusive_sum(const Array<std::uint32_t>& in, Array<std::uint32_t>& out) const {
    out.resize(in.size());
    std::exclusive_scan(in.data(), in.data() + in.size(), out.data(), std::uint32_t{0});
  }
  /// Sets *out to `first` combined with load(0), ..., load(count - 1), in any order and grouping.
  template <class T, class Load, class Combine>
  void reduce(std::size_t count, const Load& load, const T& first, const Combine& combine, T* out) const {
    T result = first;
    for (std::size_t k = 0; k < count; ++k) result = combine(result, load(k));
    *out = result;
  }
  void wait() const {}
  /// mark() marks the current end of the work queue. await() waits until the device has reached the mark.
  void mark(int) const {}
  void await(int) const {}
  /// Copies results that are already complete to the host, without waiting for queued work.
  template <class T>
  void fetch(const T* from, std::size_t count, T* to) const {
    download(from, count, to);
  }
};

}  // namespace blum::kernels
