// Blum: zip archives made byte by byte for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

#include "support/image_bytes.hpp"

namespace blum::test {

/// One entry of a zip archive, for its local header and its line in the directory.
struct ZipPart {
  std::string name, data;
  bool deflate = false;
};

template <class T>
std::string little(T value) {
  return bytes_of(std::vector<T>{value}, std::endian::little);
}

inline std::string zip_bytes(const std::vector<ZipPart>& parts) {
  std::string out;
  std::string directory;
  for (const ZipPart& part : parts) {
    const std::string packed = part.deflate ? compressed(part.data, -15) : part.data;
    const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(part.data.data()), part.data.size());
    const std::string common =
        little<std::uint16_t>(20) + std::string(2, '\0') + little<std::uint16_t>(part.deflate ? 8 : 0) +
        std::string(4, '\0') + little(static_cast<std::uint32_t>(crc)) +
        little(static_cast<std::uint32_t>(packed.size())) + little(static_cast<std::uint32_t>(part.data.size())) +
        little(static_cast<std::uint16_t>(part.name.size())) + std::string(2, '\0');
    directory += "PK\1\2" + little<std::uint16_t>(20) + common + std::string(10, '\0') +
                 little(static_cast<std::uint32_t>(out.size())) + part.name;
    out += "PK\3\4" + common + part.name + packed;
  }
  const auto count = little(static_cast<std::uint16_t>(parts.size()));
  const auto start = little(static_cast<std::uint32_t>(out.size()));
  return out + directory + "PK\5\6" + std::string(4, '\0') + count + count +
         little(static_cast<std::uint32_t>(directory.size())) + start + std::string(2, '\0');
}

}  // namespace blum::test
