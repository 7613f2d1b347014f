// Blum: image files made byte by byte for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/image_io.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum::test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline VoxelImage read_text(const std::string& bytes, ImageFormat format) {
  return read_image(std::as_bytes(std::span(bytes)), format, "sample");
}

/// The error message of reading the bytes; empty if reading succeeds.
inline std::string error_of(const std::string& bytes, ImageFormat format) {
  try {
    (void)read_text(bytes, format);
  } catch (const FormatError& error) {
    return error.what();
  }
  return {};
}

/// Compresses as gzip (window bits 31) or zlib (15).
inline std::string compressed(const std::string& bytes, int window_bits) {
  z_stream z{};
  EXPECT_EQ(deflateInit2(&z, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&z, bytes.size()) + 64, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}
inline std::string gzipped(const std::string& bytes) {
  return compressed(bytes, 31);
}

template <class T>
std::string bytes_of(const std::vector<T>& values, std::endian order) {
  std::string out;
  for (const T value : values) {
    std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    out.append(raw.data(), raw.size());
  }
  return out;
}

/// Writes a file into a folder.
inline std::filesystem::path put_in(const TemporaryFolder& folder, const std::string& name, const std::string& bytes) {
  put_file(folder / name, bytes);
  return folder / name;
}

inline std::string npy_bytes(const std::string& dtype, const std::string& shape, bool fortran,
                             const std::string& data) {
  std::string dict =
      "{'descr': '" + dtype + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
  dict.append((64 - (10 + dict.size() + 1) % 64) % 64, ' ');
  dict += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(dict.size());
  out += '\0';
  return out + dict + data;
}

/// A NIfTI-1 header of 352 bytes for a 4 x 3 x 2 image. Its numbers have the chosen byte order.
struct Nifti {
  std::endian order = std::endian::little;
  std::string bytes = std::string(352, '\0');

  template <class T>
  Nifti& set(std::size_t offset, T value) {
    bytes.replace(offset, sizeof(T), bytes_of(std::vector<T>{value}, order));
    return *this;
  }
  explicit Nifti(std::int16_t datatype, std::endian byte_order = std::endian::little) : order(byte_order) {
    set<std::int32_t>(0, 348);
    const std::array<std::int16_t, 8> dim{3, 4, 3, 2, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) set<std::int16_t>(40 + 2 * i, dim[i]).set<float>(76 + 4 * i, 1.0F);
    set<std::int16_t>(70, datatype);
    set<float>(108, 352.0F);
    bytes.replace(344, 4, std::string("n+1\0", 4));
  }
  Nifti& sform(const std::array<float, 12>& rows) {
    set<std::int16_t>(254, 1);
    for (std::size_t i = 0; i < 12; ++i) set<float>(280 + 4 * i, rows[i]);
    return *this;
  }
};

inline std::string vol_bytes(const std::string& version, const std::string& data) {
  return "Center-X: 1\nX: 4\nY: 3\nZ: 2\nVoxel-Size: 1\nInt-Endian: 0123\nVersion: " + version + "\n.\n" + data;
}

inline const std::string head8 = "type: uchar\nencoding: raw\n";
inline const std::string data24(24, '\7');

}  // namespace blum::test
