// Blum: the header of PLY files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace blum {

enum class PlyEncoding : std::uint8_t { text, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] constexpr bool is_floating(PlyType type) {
  return type >= PlyType::float32;
}
/// Bytes of a value in a binary file.
[[nodiscard]] constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
  std::string name;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
  PlyType type = PlyType::float32;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties = {};
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements = {};
  std::vector<std::string> comments = {};
  std::size_t size = 0;  ///< bytes, up to where the data begins
};

/// @throws FormatError.
[[nodiscard]] PlyHeader read_ply_header(std::string_view bytes, std::string_view name);

}  // namespace blum
