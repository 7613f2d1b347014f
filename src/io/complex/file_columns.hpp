// Blum: columns of numbers from and for files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/core/error.hpp"
#include "blum/grid/voxel_image.hpp"
#include "io/bytes/scalar_type.hpp"

namespace blum::volume_io {
class NpzWriter;
}

namespace blum::complex_files {

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
