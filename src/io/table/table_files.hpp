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

/// Values of a column: all of them, row after row, or a function that computes those of one row.
template <class T>
struct Cells {
  std::span<const T> all = {};
  std::function<void(std::size_t row, std::span<T> values)> make = {};  ///< if set, `all` is ignored
};

/// Column with the same number of values, of one type, in each row.
struct TableColumn {
  std::string name;                  ///< of the array in .npz, of the list in .json
  std::vector<std::uint64_t> shape;  ///< of a row: {} one value, {3} a vector, {2, 3} two vectors
  /// Indices (uint32) become int32 in .npz files, which cannot hold texts.
  std::variant<Cells<double>, Cells<float>, Cells<std::int64_t>, Cells<std::int32_t>, Cells<std::uint32_t>,
               Cells<std::string>>
      cells;
  /// Names of the values of a row in .csv. If empty: the column's name, or NAME_0, NAME_1, ... for several values.
  std::vector<std::string> names = {};

  /// Returns the number of values in a row.
  [[nodiscard]] std::size_t width() const;
};

/// Table of columns. Values kept by reference must outlive it.
struct Table {
  std::size_t rows = 0;
  std::vector<TableColumn> columns;
};

/// Returns a column of existing values, row after row. They are kept by reference.
template <class T>
[[nodiscard]] TableColumn column_of(std::string name, std::vector<std::uint64_t> shape, std::span<const T> values,
                                    std::vector<std::string> names = {}) {
  return {std::move(name), std::move(shape), Cells<T>{values, {}}, std::move(names)};
}
[[nodiscard]] TableColumn column_of(std::string name, std::span<const Vec3d> vectors,
                                    std::vector<std::string> names = {});
[[nodiscard]] TableColumn column_of(const Column& column, std::vector<std::string> names = {});

/// Returns a column of T that make(row, values) fills row by row. Writers make one column after the other, so that only
/// one is in memory.
template <class T, class Make>
[[nodiscard]] TableColumn made_column(std::string name, std::vector<std::uint64_t> shape, Make make,
                                      std::vector<std::string> names = {}) {
  return {std::move(name), std::move(shape), Cells<T>{{}, std::move(make)}, std::move(names)};
}

/// Sources of files of rows. Formats call only those that they need.
struct RowFile {
  std::function<std::vector<Table>()> arrays;  ///< a column for each fact
  std::function<std::vector<Table>()> lists;   ///< the same, in the order of .json
  std::function<Table()> rows;                 ///< rows of text
  std::function<Complex()> shapes;             ///< shapes that represent the rows, with columns
  const FileMetadata& metadata;
  std::span<const std::string_view> typed_keys = {};  ///< keys of metadata that are numbers, true or false in .json
  bool has_dense_lists = false;                       ///< as JsonStyle::is_dense
};

/// Style of lists in .json files.
struct JsonStyle {
  std::span<const std::string_view> typed = {};  ///< keys of metadata that are numbers, true or false
  bool is_dense = false;                         ///< columns of one value a row take one line, not one per row
};

/// The writers. A file appears under its name when it is complete. In files of several tables, the columns of one
/// follow those of the other. Numbers in text are the shortest that read back as the same; in .json, numbers that are
/// not finite are `null`. @throws FileError, Cancelled.
///
/// Writes an array for each column, and `metadata`, a JSON object, unless there are none.
void write_npz(const std::filesystem::path& path, std::span<const Table> tables, const FileMetadata& metadata,
               const Context& context);
/// Writes a row of names, then the rows. Metadata are not written.
void write_csv(const std::filesystem::path& path, const Table& table, const Context& context);
/// Writes an object: `metadata`, then a list for each column, of values or of lists of them.
void write_json(const std::filesystem::path& path, std::span<const Table> tables, const FileMetadata& metadata,
                const JsonStyle& style, const Context& context);

}  // namespace blum::tables
