// Blum: NumPy arrays (.npy) and archives of them (.npz). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/voxel_image.hpp"
#include "io/archive/zip.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"

namespace blum::volume_io {

/// Header of a .npy file.
struct NpyHeader {
  enum class Kind : std::uint8_t { scalar, text };
  Kind kind = Kind::scalar;
  ScalarType type = ScalarType::u8;
  std::size_t text_length = 0;  ///< number of characters of a text entry; each takes 32 bits
  std::endian order = std::endian::native;
  bool fortran = false;
  std::vector<std::uint64_t> shape;

  /// Returns the number of values, which is the product of the shape.
  /// @throws FormatError with `name` if it exceeds 2^40.
  [[nodiscard]] std::uint64_t count(const std::string& name) const;
};

/// Returns the header of an array in C order and in the machine's byte order. The header has format version 1.0 and is
/// padded to a multiple of 64 bytes.
/// @param dtype  type without byte order, for example "f4".
[[nodiscard]] std::string npy_header(std::string_view dtype, const std::vector<std::uint64_t>& shape);
/// Returns the type of a scalar without byte order, for example "f4".
[[nodiscard]] std::string_view npy_dtype(ScalarType type);

/// Reads the header. Afterwards the stream is at the first value. @throws FormatError.
[[nodiscard]] NpyHeader read_npy_header(ByteStream& stream);
/// Returns the number of values of a scalar array.
/// @throws FormatError if the array contains text, or if the stream is too short for that many values.
[[nodiscard]] std::uint64_t check_npy_values(const ByteStream& stream, const NpyHeader& header);
/// Reads values in the order of the file. Converts the values to the machine's byte order. @throws FormatError.
void read_npy_raw(ByteStream& stream, const NpyHeader& header, std::span<std::byte> out);
/// Reads the values of a scalar array, in C order of its shape. @throws FormatError, OutOfMemory.
[[nodiscard]] VoxelImage::Values read_npy_values(ByteStream& stream, const NpyHeader& header);
/// Returns the size of an image, as x, y, z, from an array that is indexed [z, y, x].
/// @throws FormatError unless the array has 1 to 3 axes and 1 to 2^40 values.
[[nodiscard]] std::array<std::int64_t, 3> npy_image_size(const NpyHeader& header, const std::string& name);

/// Writer of a .npz archive. Arrays are added one after the other.
class NpzWriter {
 public:
  NpzWriter(AtomicFile& file, FieldSink& sink, const Context& context) : zip_(file, sink, context) {}

  template <class T>
  void add(const std::string& name, std::string_view dtype, const std::vector<std::uint64_t>& shape,
           std::span<const T> values) {
    const std::string header = npy_header(dtype, shape);
    zip_.add(name + ".npy", std::as_bytes(std::span(header)), std::as_bytes(values));
  }
  void add_vector(const std::string& name, const Vec3d& v) {
    const std::array<double, 3> values{v.x, v.y, v.z};
    add(name, "f8", {3}, std::span<const double>(values));
  }
  /// Adds an array that contains one NumPy string. Each ASCII character takes four bytes.
  void add_text(const std::string& name, const std::string& text);
  void finish() { zip_.finish(); }

 private:
  ZipWriter zip_;
};

/// Reader of a .npz archive. Arrays are found by their names.
class NpzReader {
 public:
  explicit NpzReader(const ByteSource& source) : source_(source), zip_(source) {}

  /// Returns the names of the arrays in the order of the archive's directory.
  [[nodiscard]] std::vector<std::string> arrays() const;
  /// Returns the sum of the compressed sizes of all entries, in bytes.
  [[nodiscard]] std::uint64_t packed_size() const;
  [[nodiscard]] bool has(const std::string& array) const { return zip_.find(array + ".npy") != nullptr; }

  /// Opens one array and returns the result of use(stream, header).
  template <class Use>
  auto read(const std::string& array, Use use) {
    const ZipEntry* entry = zip_.find(array + ".npy");
    if (entry == nullptr) throw FormatError(source_.name() + ": there is no array '" + array + "' in it");
    const auto stream = zip_.open(*entry);
    const NpyHeader header = read_npy_header(*stream);
    auto result = use(*stream, header);
    stream->check_finished();
    return result;
  }

  template <std::size_t n>
  std::array<double, n> numbers(const std::string& array, const std::vector<std::uint64_t>& shape) {
    return read(array, [&](ByteStream& stream, const NpyHeader& header) {
      if (header.kind != NpyHeader::Kind::scalar || header.shape != shape) {
        throw FormatError(stream.name() + ": it must be an array of " + std::to_string(n) + " numbers");
      }
      std::array<double, n> out{};
      std::visit(
          [&](const auto& values) {
            for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<double>(values[i]);
          },
          read_npy_values(stream, header));
      return out;
    });
  }

  /// Reads an array that contains one ASCII string.
  std::string text(const std::string& array);

 private:
  const ByteSource& source_;
  ZipReader zip_;
};

}  // namespace blum::volume_io
