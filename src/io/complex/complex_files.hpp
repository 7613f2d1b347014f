// Blum: shared functions of readers and writers of complexes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/complex_io.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"

namespace blum::volume_io {
class NpzWriter;
}

namespace blum::complex_files {

/// Throws if a format cannot store all content of a complex, unless the options allow the loss.
/// @param format  name of the format, for messages. @param kept the only vertex column that the format stores; may be
/// empty.
/// @throws InvalidOption. The message lists the content that would be lost.
void refuse_loss(const std::filesystem::path& path, std::string_view format, const Complex& complex,
                 const FileMetadata& metadata, const ComplexWriteOptions& options, std::string_view kept = {});

// The writers require complexes without problems (problem_of), and names and metadata that files can store.
void write_vtp(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_ply(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_obj(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_npz(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_glb(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);

// The readers check only what makes them safe. Callers must call problem_of afterwards. All throw FormatError.
[[nodiscard]] ComplexFile read_vtp(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_npz(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_ply(std::string_view bytes, std::string_view name);
[[nodiscard]] ComplexFile read_obj(std::string_view text, std::string_view name);

/// Set of distinct undirected edges. Time and memory are proportional to the complex. Incidence has the same edges, but
/// also adjacencies that no file needs. For a million triangles Incidence takes 0.11 s and 60 MB, this class 0.02 s and
/// 16 MB.
class EdgeSet {
 public:
  enum class Of : std::uint8_t { triangles, edges_and_triangles };

  /// Builds the set. Indices must be in range.
  EdgeSet(const ComplexView& complex, Of which, const Context& context = {});
  [[nodiscard]] bool contains(const std::array<std::uint32_t, 2>& edge) const;
  [[nodiscard]] std::size_t size() const { return others_.size(); }

  /// Calls use(a, b) with a < b for every edge, in ascending order of a, then b.
  template <class Use>
  void for_each(Use use) const {
    for (std::size_t a = 0; a + 1 < begin_.size(); ++a) {
      for (std::size_t i = begin_[a]; i < begin_[a + 1]; ++i) use(static_cast<std::uint32_t>(a), others_[i]);
    }
  }

 private:
  void sort_and_merge();

  /// For each vertex: index of its first edge in others_; the last entry is the total.
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> others_;  ///< larger ends of the edges, grouped by the smaller end
};

/// Returns the vertices that no edge and no triangle uses, in ascending order.
[[nodiscard]] std::vector<std::uint32_t> isolated_vertices(const ComplexView& complex);

/// Returns the type that files use for the numbers of a column.
[[nodiscard]] volume_io::ScalarType scalar_type(const Column& column);

/// Adds an array for a column, with one row per element. If the column has several components, the rows have that many
/// numbers.
void write_column(volume_io::NpzWriter& npz, const std::string& array, const Column& column);

/// Converts numbers read from a file to the smallest column type that can represent all values of their type.
/// @throws FormatError with `where` if a uint64 value is beyond int64.
[[nodiscard]] Column::Values widened(VoxelImage::Values values, const std::string& where);

/// Checks that a name from a file can be displayed everywhere.
/// @throws FormatError with `where` if the name is not UTF-8 or contains a zero byte. `what` describes the thing that
/// has the name, for the message.
void check_name(std::string_view name, const char* what, const std::string& where);

/// Adds a column read from a file.
/// @throws FormatError with `where` if the name is already in use or not text, or if the number of rows differs from
/// other columns. FormatError is also thrown if there would be more than max_file_columns columns, or if the number of
/// components is not 1 to max_file_columns.
void add_column(Columns& columns, Column column, const std::string& where);

/// Returns columns in which row i is repeated counts[i] times. This is for cells of files that become several cells.
/// @param file_size  size of the file in bytes. It limits the size of the copies.
/// @throws FormatError with `where` if the copies would be many times as large as the file.
[[nodiscard]] Columns repeated(const Columns& columns, std::span<const std::uint32_t> counts, std::uint64_t file_size,
                               const std::string& where);

/// Calls set(index, value) for each value, converted to double.
template <class Set>
void for_each_number(const VoxelImage::Values& values, Set set) {
  std::visit(
      [&](const auto& v) {
        for (std::size_t i = 0; i < v.size(); ++i) set(i, static_cast<double>(v[i]));
      },
      values);
}

/// Calls set(index, value) for each value, converted to int64.
/// @throws FormatError with `where` if a value is not an integer or is beyond int64.
template <class Set>
void for_each_integer(const VoxelImage::Values& values, const std::string& where, Set set) {
  std::visit(
      [&]<class T>(const std::vector<T>& v) {
        if constexpr (std::is_floating_point_v<T>) {
          throw FormatError(where + ": the values must be whole numbers, but these are floating-point");
        } else {
          for (std::size_t i = 0; i < v.size(); ++i) {
            if (!std::in_range<std::int64_t>(v[i])) throw FormatError(where + ": a value is too large");
            set(i, static_cast<std::int64_t>(v[i]));
          }
        }
      },
      values);
}

}  // namespace blum::complex_files
