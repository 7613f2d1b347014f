// Blum: rows of named columns, and files of them (NPZ, CSV, JSON). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/io/file_metadata.hpp"

namespace blum::tables {

/// Values of a column: either all of them, row after row, or a function that computes those of one row.
template <class T>
struct Cells {
  std::span<const T> all = {};
  std::function<void(std::size_t row, std::span<T> values)> make = {};  ///< if set, `all` is ignored
};

/// Column that has the same number of values in each row, all of one type.
struct TableColumn {
  std::string name;                  ///< name of the array in .npz and of the list in .json
  std::vector<std::uint64_t> shape;  ///< shape of a row: {} for one value, {3} for a vector, {2, 3} for two vectors
  /// Indices (uint32) are written as int32 to .npz files. Columns of texts cannot be written there.
  std::variant<Cells<double>, Cells<float>, Cells<std::int64_t>, Cells<std::int32_t>, Cells<std::uint32_t>,
               Cells<std::string>>
      cells;
  /// Names of the values of a row in .csv. If empty, the column's name is used, or NAME_0, NAME_1, ... for several
  /// values.
  std::vector<std::string> names = {};

  /// Returns the number of values in a row.
  [[nodiscard]] std::size_t width() const;
};

/// Table of columns. Values that are kept by reference must outlive the table.
struct Table {
  std::size_t rows = 0;
  std::vector<TableColumn> columns;
};

/// Returns a column with existing values, row after row. The values are kept by reference.
template <class T>
[[nodiscard]] TableColumn column_of(std::string name, std::vector<std::uint64_t> shape, std::span<const T> values,
                                    std::vector<std::string> names = {}) {
  return {std::move(name), std::move(shape), Cells<T>{values, {}}, std::move(names)};
}
[[nodiscard]] TableColumn column_of(std::string name, std::span<const Vec3d> vectors,
                                    std::vector<std::string> names = {});
[[nodiscard]] TableColumn column_of(const Column& column, std::vector<std::string> names = {});

/// Returns a column of T. For each row, make(row, values) computes the values. Writers compute one column after the
/// other, so that only one is in memory.
template <class T, class Make>
[[nodiscard]] TableColumn made_column(std::string name, std::vector<std::uint64_t> shape, Make make,
                                      std::vector<std::string> names = {}) {
  return {std::move(name), std::move(shape), Cells<T>{{}, std::move(make)}, std::move(names)};
}

/// Functions that return the content of a file of rows. A format calls only those that it needs.
struct RowFile {
  std::function<std::vector<Table>()> arrays;  ///< for .npz: tables with a separate column for each kind of data
  std::function<std::vector<Table>()> lists;   ///< for .json: the same columns in the order of that format
  std::function<Table()> rows;                 ///< for text: one table of rows
  std::function<Complex()> shapes;             ///< for shapes: a complex that represents the rows, with columns
  const FileMetadata& metadata;
  /// Keys of metadata whose values are written as numbers, true or false in .json.
  std::span<const std::string_view> typed_keys = {};
  bool has_dense_lists = false;  ///< see JsonStyle::is_dense
};

/// Style of lists in .json files.
struct JsonStyle {
  /// Keys of metadata whose values are written as numbers, true or false.
  std::span<const std::string_view> typed = {};
  /// If true, a column with one value per row takes one line instead of one line per row.
  bool is_dense = false;
};

/// The following functions write files. A file appears under its name when it is complete. If there are several tables,
/// their columns follow each other. Numbers in text have as few digits as identify them exactly; in .json, numbers that
/// are not finite are `null`. @throws FileError, Cancelled.
///
/// Writes an array for each column. If there are metadata, also writes an array `metadata` with a JSON object.
void write_npz(const std::filesystem::path& path, std::span<const Table> tables, const FileMetadata& metadata,
               const Context& context);
/// Writes one row of names, then the rows of the table. Metadata are not written.
void write_csv(const std::filesystem::path& path, const Table& table, const Context& context);
/// Writes a JSON object: `metadata`, then a list for each column. Its entries are values or lists of values.
void write_json(const std::filesystem::path& path, std::span<const Table> tables, const FileMetadata& metadata,
                const JsonStyle& style, const Context& context);

}  // namespace blum::tables
