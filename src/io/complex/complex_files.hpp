// Blum: what readers and writers of complexes share. SPDX-License-Identifier: Apache-2.0
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

/// Refuses to write what a format cannot hold, unless the options allow the loss.
/// @param format  its name.  @param kept  the only column that it holds, of vertices; may be empty.
/// @throws InvalidOption naming what would be lost.
void refuse_loss(const std::filesystem::path& path, std::string_view format, const Complex& complex,
                 const FileMetadata& metadata, const ComplexWriteOptions& options, std::string_view kept = {});

// The writers get complexes without problems (problem_of), and names and metadata that files can hold.
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

// The readers check whatever they need to be safe; problem_of is asked afterwards. All throw FormatError.
[[nodiscard]] ComplexFile read_vtp(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_npz(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_ply(std::string_view bytes, std::string_view name);
[[nodiscard]] ComplexFile read_obj(std::string_view text, std::string_view name);

/// Distinct edges without direction. Costs time and memory in proportion to the complex. Incidence tells the same and
/// what touches what, which no file asks for: of a million triangles it takes 0.11 s and 60 MB, this 0.02 s and 16 MB.
class EdgeSet {
 public:
  enum class Of : std::uint8_t { triangles, edges_and_triangles };

  /// Indices must be in range.
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

  std::vector<std::size_t> begin_;     ///< of each vertex's edges in others_, and the end
  std::vector<std::uint32_t> others_;  ///< the larger ends of the edges, by the smaller end
};

/// The vertices of no edge and no triangle, in rising order.
[[nodiscard]] std::vector<std::uint32_t> isolated_vertices(const ComplexView& complex);

/// The type that files hold a column's numbers in.
[[nodiscard]] volume_io::ScalarType scalar_type(const Column& column);

/// Adds an array of a column: one number for each row, or as many as it has components.
void write_column(volume_io::NpzWriter& npz, const std::string& array, const Column& column);

/// The numbers of a file in the smallest type that a column may have and that holds all of theirs.
/// @throws FormatError with `where` for a uint64 beyond int64.
[[nodiscard]] Column::Values widened(VoxelImage::Values values, const std::string& where);

/// A name in a file as it can be shown everywhere. @throws FormatError with `where` for one that is not UTF-8 or has a
/// byte of 0, saying that it is that of `what`.
void check_name(std::string_view name, const char* what, const std::string& where);

/// Adds a column that a file has. @throws FormatError with `where` for a name that is there twice or is no text, more
/// than max_file_columns of them, components beyond it or none, or another count of rows.
void add_column(Columns& columns, Column column, const std::string& where);

/// The columns with row i as often as counts[i] says, for cells of files that become several.
/// @param file_size  of the file: the copies may not be many times as large. @throws FormatError with `where` if so.
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

/// Calls set(index, value) with each value as an int64. @throws FormatError with `where` when there are other values.
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
