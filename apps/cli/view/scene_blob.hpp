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

/// A header of JSON and arrays of numbers:
///
///   bytes 0-7    "BLUMVIEW"
///   bytes 8-11   version, 2 (all numbers are little endian)
///   bytes 12-15  length of the header, a multiple of 8
///   then         the header, then the arrays, each at a multiple of 8 bytes behind the header
///
/// The header names an array by {"type": "f4", "count": n, "offset": bytes behind the header, "bytes": as stored,
/// "coding": c}. Codings are "raw"; "deflate" (zlib); "delta": numbers of 4 bytes as differences of their bit patterns,
/// the first byte of each, then the second and so on, in zlib's form.
class SceneBlob {
 public:
  /// @param compresses  whether arrays are deflated: for pages that are kept. A server on the same machine is faster
  /// without.
  explicit SceneBlob(bool compresses) : compresses_(compresses) {}

  /// Adds an array, and returns what the header says of it.
  template <class T>
  [[nodiscard]] Json add(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    return add_bytes(std::as_bytes(values), type_of<T>(), values.size(), sizeof(T));
  }
  template <class T>
  [[nodiscard]] Json add(const std::vector<T>& values) {
    return add(std::span<const T>(values));
  }

  /// What a scene begins with.
  [[nodiscard]] static std::string head(const Json& header);
  /// What follows it, first to last; as long as nothing is added.
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
  std::vector<std::vector<std::byte>> arrays_;  ///< each filled up to a multiple of 8 bytes
  std::size_t size_ = 0;
};

}  // namespace blum::cli
