// Blum: the binary form of a scene, as the viewer reads it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/summary.hpp"

namespace blum::cli {

/// Binary form of a scene: a JSON header and arrays of numbers. All numbers are little-endian.
///
/// Bytes 0-7: "BLUMVIEW".
/// Bytes 8-11: format version, which is 2.
/// Bytes 12-15: length of the header in bytes, a multiple of 8.
/// Then: the header, and the arrays. Each array starts at a multiple of 8 bytes after the header.
///
/// The header describes an array by "type" (for example "f4"), "count", "offset" (bytes after the header), "bytes"
/// (stored size) and "coding". Codings are "raw", "deflate" (zlib) and "delta". The coding "delta" is for numbers of 4
/// bytes. It stores differences of their bit patterns, compressed by zlib: first the first bytes of all differences,
/// then the second bytes, and so on.
class SceneBlob {
 public:
  /// @param compresses  true to compress arrays, for pages that are written to files. For a server on the same machine,
  /// false is faster.
  explicit SceneBlob(bool compresses) : compresses_(compresses) {}

  /// Adds an array, and returns its description for the header.
  template <class T>
  [[nodiscard]] Json add(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    return add_bytes(std::as_bytes(values), type_of<T>(), values.size(), sizeof(T));
  }
  template <class T>
  [[nodiscard]] Json add(const std::vector<T>& values) {
    return add(std::span<const T>(values));
  }

  /// Returns the first bytes of a scene, up to the end of the header.
  [[nodiscard]] static std::string head(const Json& header);
  /// Returns the bytes that follow the header: all arrays in order. Valid until another array is added.
  [[nodiscard]] std::vector<std::string_view> arrays() const;

 private:
  template <class T>
  static constexpr const char* type_of() {
    if constexpr (std::is_floating_point_v<T>) return sizeof(T) == 4 ? "f4" : "f8";
    if constexpr (std::is_signed_v<T>) return sizeof(T) == 1 ? "i1" : sizeof(T) == 2 ? "i2" : "i4";
    return sizeof(T) == 1 ? "u1" : sizeof(T) == 2 ? "u2" : "u4";
  }
  Json add_bytes(std::span<const std::byte> bytes, const char* type, std::size_t count, std::size_t width);

  bool compresses_;
  std::vector<std::vector<std::byte>> arrays_;  ///< each is padded to a multiple of 8 bytes
  std::size_t size_ = 0;
};

}  // namespace blum::cli
