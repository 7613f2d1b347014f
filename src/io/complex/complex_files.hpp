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

/// Refuses to write content that a format cannot hold, unless the options allow the loss.
/// @param format  name of the format.  @param kept  the only vertex column that the format holds; may be empty.
/// @throws InvalidOption naming the content that would be lost.
void refuse_loss(const std::filesystem::path& path, std::string_view format, const Complex& complex,
                 const FileMetadata& metadata, const ComplexWriteOptions& options, std::string_view kept = {});

// The writers need complexes without problems (problem_of), and names and metadata that files can hold.
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

// The readers check only what they need to be safe. Callers check problem_of afterwards. All throw FormatError.
[[nodiscard]] ComplexFile read_vtp(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_npz(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_ply(std::string_view bytes, std::string_view name);
[[nodiscard]] ComplexFile read_obj(std::string_view text, std::string_view name);

/// Set of distinct undirected edges. Its cost in time and memory is proportional to the complex. Incidence contains the
/// same edges, and adjacencies that no file needs. For a million triangles Incidence takes 0.11 s and 60 MB, this class
/// 0.02 s and 16 MB.
class EdgeSet {
 public:
  enum class Of : std::uint8_t { triangles, edges_and_triangles };

  /// Builds the set. Indices must be in range.
  EdgeSet(const ComplexView& complex, Of which, const Context& context = {});
  [[nodiscard]] bool contains(const std::array<std::uint32_t, 2>& edge) const;
  [[nodiscard]] std::size_t size() const { return others_.size(); }

  /// Calls use(a, b) with a < b for every edge, in rising order.
  template <class Use>
  void for_each(Use use) const {
    for (std::size_t a = 0; a + 1 < begin_.size(); ++a) {
      for (std::size_t i = begin_[a]; i < begin_[a + 1]; ++i) use(static_cast<std::uint32_t>(a), others_[i]);
    }
  }

 private:
  void sort_and_merge();

  std::vector<std::size_t> begin_;     ///< start of each vertex's edges in others_, and the end
  std::vector<std::uint32_t> others_;  ///< larger ends of the edges, grouped by the smaller end
};

/// Returns the vertices of no edge and no triangle, in rising order.
[[nodiscard]] std::vector<std::uint32_t> isolated_vertices(const ComplexView& complex);

/// Returns the type in which files hold a column's numbers.
[[nodiscard]] volume_io::ScalarType scalar_type(const Column& column);

/// Adds the array of a column. A row has one number, or as many as the column has components.
void write_column(volume_io::NpzWriter& npz, const std::string& array, const Column& column);

/// Converts the numbers of a file to the smallest column type that holds all values of their type.
/// @throws FormatError with `where` for a uint64 beyond int64.
[[nodiscard]] Column::Values widened(VoxelImage::Values values, const std::string& where);

/// Checks that a name in a file can be shown everywhere.
/// @throws FormatError with `where` for a name that is not UTF-8 or has a byte of 0. The message calls it the name of
/// `what`.
void check_name(std::string_view name, const char* what, const std::string& where);

/// Adds a column of a file.
/// @throws FormatError with `where` if its name exists already or is not text, or if its count of rows differs. The
/// same holds beyond max_file_columns columns, and unless it has 1 to max_file_columns components.
void add_column(Columns& columns, Column column, const std::string& where);

/// Returns the columns with row i repeated counts[i] times, for cells of files that become several cells.
/// @param file_size  size of the file. The copies may not be many times as large.
/// @throws FormatError with `where` if they are.
[[nodiscard]] Columns repeated(const Columns& columns, std::span<const std::uint32_t> counts, std::uint64_t file_size,
                               const std::string& where);

/// Calls set(index, value) with each value as a double.
template <class Set>
void for_each_number(const VoxelImage::Values& values, Set set) {
  std::visit(
      [&](const auto& v) {
        for (std::size_t i = 0; i < v.size(); ++i) set(i, static_cast<double>(v[i]));
      },
      values);
}

/// Calls set(index, value) with each value as an int64.
/// @throws FormatError with `where` if a value is not a whole number or is beyond int64.
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
