// Blum: reading meshes from text in tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum::test {

inline MeshFile parse_mesh(std::string_view content, MeshFormat format, const MeshReadOptions& options = {}) {
  return read_mesh_file(std::as_bytes(std::span(content.data(), content.size())), format, options, "test.mesh");
}

/// The message with which the content is refused; "read" if it is accepted.
inline std::string refusal(std::string_view content, MeshFormat format) {
  try {
    (void)parse_mesh(content, format);
  } catch (const FormatError& error) {
    return error.what();
  }
  return "read";
}

/// Builds binary content value by value.
class Bytes {
 public:
  explicit Bytes(bool big_endian = false) : big_endian_(big_endian) {}
  template <class T>
  Bytes& add(T value) {
    const char* const raw = reinterpret_cast<const char*>(&value);
    std::string bytes(raw, sizeof(T));
    if (big_endian_) bytes.assign(bytes.rbegin(), bytes.rend());
    content_ += bytes;
    return *this;
  }
  Bytes& text(std::string_view text) {
    content_ += text;
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return content_; }

 private:
  bool big_endian_;
  std::string content_;
};

/// A binary STL file of `count` triangles, whose header promises `promised`.
inline std::string binary_stl(std::uint32_t count, std::uint32_t promised, std::string header = "binary") {
  Bytes bytes;
  header.resize(80, ' ');
  bytes.text(header).add(promised);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const int v : {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) bytes.add(static_cast<float>(v));
    bytes.add(static_cast<float>(i)).add(std::uint16_t{0x2020});
  }
  return bytes.str();
}

}  // namespace blum::test
