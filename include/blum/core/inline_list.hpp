// Blum: short lists without allocation. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace blum {

/// List of up to `most` values, stored in the object itself. Unlike an array, the list does not initialise memory that
/// contains no value yet. So loops that construct a list in each iteration save time.
template <class T, std::size_t most>
class InlineList {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  InlineList() = default;
  InlineList(const InlineList& other) : size_(other.size_) { std::uninitialized_copy_n(other.data(), size_, data()); }
  InlineList& operator=(const InlineList& other) {
    if (this == &other) return *this;
    size_ = other.size_;
    std::uninitialized_copy_n(other.data(), size_, data());
    return *this;
  }
  ~InlineList() = default;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool is_full() const { return size_ == most; }
  /// Appends a value. The list must not be full.
  void push_back(const T& value) { std::construct_at(data() + size_++, value); }
  /// Appends a default-initialised value and returns a reference to it. The list must not be full.
  T& emplace_back() { return *std::construct_at(data() + size_++); }
  /// Removes the last value and returns it. The list must not be empty.
  T pop_back() { return data()[--size_]; }
  /// Keeps only the first `size` values. @param size  at most the current size.
  void shrink(std::size_t size) { size_ = size; }

  [[nodiscard]] T* data() { return std::launder(reinterpret_cast<T*>(storage_)); }
  [[nodiscard]] const T* data() const { return std::launder(reinterpret_cast<const T*>(storage_)); }
  [[nodiscard]] T& operator[](std::size_t k) { return data()[k]; }
  [[nodiscard]] const T& operator[](std::size_t k) const { return data()[k]; }
  [[nodiscard]] T* begin() { return data(); }
  [[nodiscard]] T* end() { return data() + size_; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }
  [[nodiscard]] std::span<const T> span() const { return {data(), size_}; }

 private:
  alignas(T) std::byte storage_[most * sizeof(T)];
  std::size_t size_ = 0;
};

}  // namespace blum
