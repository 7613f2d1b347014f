// Blum: files of several NumPy arrays (.npz). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "io/archive/npy.hpp"
#include "io/archive/zip_reader.hpp"
#include "io/archive/zip_writer.hpp"

namespace blum::volume_io {

/// Writes arrays one after the other.
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
  /// A NumPy string of one entry: four bytes for each (ASCII) character.
  void add_text(const std::string& name, const std::string& text);
  void finish() { zip_.finish(); }

 private:
  ZipWriter zip_;
};

/// The arrays of a file, by their names.
class NpzReader {
 public:
  explicit NpzReader(const ByteSource& source) : source_(source), zip_(source) {}

  /// The names of the arrays, in the order of the archive's directory.
  [[nodiscard]] std::vector<std::string> arrays() const;
  /// Bytes of all entries, as they are packed.
  [[nodiscard]] std::uint64_t packed_size() const;
  [[nodiscard]] bool has(const std::string& array) const { return zip_.find(array + ".npy") != nullptr; }

  /// Reads one array; `use` gets the stream and the header.
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
        throw FormatError(stream.name() + ": it should be " + std::to_string(n) + " numbers");
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

  /// An array of one ASCII string.
  std::string text(const std::string& array);

 private:
  const ByteSource& source_;
  ZipReader zip_;
};

}  // namespace blum::volume_io
