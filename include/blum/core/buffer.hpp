// Blum: large uninitialised arrays. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

namespace blum {

namespace detail {
/// Returns uninitialised memory, aligned to 64 bytes. Large blocks use huge pages if the system has them.
/// @throws OutOfMemory.
[[nodiscard]] void* allocate_aligned(std::size_t bytes);
void free_aligned(void* memory, std::size_t bytes) noexcept;
}  // namespace detail

/// Array of fixed size for grid values. It is aligned to 64 bytes, not initialised, and movable; clone() copies it.
///
/// Writing a field to fresh 4 KiB pages takes longer than computing the field. So large buffers request huge pages, and
/// their memory is not zeroed.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  using value_type = T;

  Buffer() = default;
  /// @throws OutOfMemory.
  explicit Buffer(std::size_t size)
      : data_(size == 0 ? nullptr : static_cast<T*>(detail::allocate_aligned(checked_bytes(size)))), size_(size) {}
  Buffer(std::size_t size, const T& value) : Buffer(size) { std::fill(begin(), end(), value); }
  Buffer(Buffer&& other) noexcept : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { detail::free_aligned(data_, size_ * sizeof(T)); }

  [[nodiscard]] Buffer clone() const {
    Buffer copy(size_);
    std::copy(begin(), end(), copy.begin());
    return copy;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] const T* data() const { return data_; }
  [[nodiscard]] T* begin() { return data_; }
  [[nodiscard]] T* end() { return data_ + size_; }
  [[nodiscard]] const T* begin() const { return data_; }
  [[nodiscard]] const T* end() const { return data_ + size_; }
  [[nodiscard]] T& operator[](std::size_t index) { return data_[index]; }
  [[nodiscard]] const T& operator[](std::size_t index) const { return data_[index]; }
  [[nodiscard]] std::span<T> span() { return {data_, size_}; }
  [[nodiscard]] std::span<const T> span() const { return {data_, size_}; }

 private:
  /// Returns the size in bytes. If the size in bytes overflows, returns the largest std::size_t, for which
  /// allocate_aligned() throws OutOfMemory.
  static std::size_t checked_bytes(std::size_t size) {
    const std::size_t limit = static_cast<std::size_t>(-1);
    return size > limit / sizeof(T) ? limit : size * sizeof(T);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace blum
