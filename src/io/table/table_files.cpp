#include "io/table/table_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <type_traits>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/archive/numpy.hpp"
#include "io/format_table.hpp"
#include "io/text/json.hpp"
#include "io/text/row_writer.hpp"

namespace blum::tables {
namespace {

/// Access to a column row by row.
template <class T>
class Rows {
 public:
  Rows(const Cells<T>& cells, std::size_t width) : cells_(cells), width_(width) {
    if (cells.make) made_.resize(width);
  }
  /// Returns a row. It is valid until the next call.
  std::span<const T> operator[](std::size_t row) {
    if (!cells_.make) return cells_.all.subspan(row * width_, width_);
    cells_.make(row, made_);
    return made_;
  }

 private:
  const Cells<T>& cells_;
  std::size_t width_;
  std::vector<T> made_;
};

template <class T>
constexpr std::string_view dtype_of = std::is_same_v<T, double>         ? "f8"
                                      : std::is_same_v<T, float>        ? "f4"
                                      : std::is_same_v<T, std::int64_t> ? "i8"
                                                                        : "i4";

void append(std::string& out, const std::string& text) {
  out += text;
}
template <class T>
  requires std::is_arithmetic_v<T>
void append(std::string& out, T value) {
  std::array<char, 40> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  out.append(digits.data(), result.ptr);
}

template <class T>
void append_json(std::string& out, const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    out += volume_io::json_text(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    if (std::isfinite(value)) {
      append(out, value);
    } else {
      out += "null";
    }
  } else {
    append(out, value);
  }
}

/// Appends the values of a row as nested lists, with the depth of its shape. A single value is written without a list.
template <class T>
void append_json(std::string& out, std::span<const T> values, std::span<const std::uint64_t> shape) {
  if (shape.empty()) return append_json(out, values.front());
  const std::size_t step = values.size() / shape.front();
  out += '[';
  for (std::size_t k = 0; k < shape.front(); ++k) {
    if (k > 0) out += ", ";
    append_json(out, values.subspan(k * step, step), shape.subspan(1));
  }
  out += ']';
}

std::size_t byte_size(const Table& table) {
  std::size_t bytes = 0;
  for (const TableColumn& column : table.columns) {
    bytes += std::visit([&]<class T>(const Cells<T>&) { return sizeof(T); }, column.cells) * column.width();
  }
  return bytes * table.rows;
}

/// Appends the values of one row to a line. Each value is preceded by a comma.
using AppendRow = std::function<void(std::string& line, std::size_t row)>;

AppendRow csv_row_of(const TableColumn& column) {
  return std::visit(
      [&]<class T>(const Cells<T>& cells) -> AppendRow {
        return [rows = Rows<T>(cells, column.width())](std::string& line, std::size_t row) mutable {
          for (const T& value : rows[row]) {
            line += ',';
            append(line, value);
          }
        };
      },
      column.cells);
}

void append_names(const TableColumn& column, std::string& line) {
  const std::size_t width = column.width();
  for (std::size_t k = 0; k < width; ++k) {
    line += ',';
    if (!column.names.empty()) {
      line += column.names[k];
    } else {
      line += column.name + (width > 1 ? '_' + std::to_string(k) : "");
    }
  }
}

void write_list(RowWriter& file, const TableColumn& column, std::size_t rows, bool is_dense) {
  file.text(",\n" + volume_io::json_text(column.name) + ": [");
  const bool has_lines = !is_dense || !column.shape.empty();
  std::string text;
  const auto write = [&]<class T>(const Cells<T>& cells) {
    Rows<T> values(cells, column.width());
    for (std::size_t row = 0; row < rows; ++row) {
      text = row == 0 ? (has_lines ? "\n" : "") : (has_lines ? ",\n" : ", ");
      append_json(text, values[row], column.shape);
      file.text(text);
      file.end_row();
    }
  };
  std::visit(write, column.cells);
  file.text("]");
}

template <class T>
void write_array(volume_io::NpzWriter& npz, const TableColumn& column, const Cells<T>& cells, std::size_t rows,
                 const Context& context) {
  if constexpr (std::is_same_v<T, std::string>) {
    throw InvalidOption("column '" + column.name + "' has texts, which .npz files do not hold");
  } else {
    std::vector<std::uint64_t> shape = column.shape;
    shape.insert(shape.begin(), rows);
    if (!cells.make) return npz.add(column.name, dtype_of<T>, shape, cells.all);
    constexpr std::size_t look_every = 65536;
    const std::size_t width = column.width();
    std::vector<T> values(rows * width);
    for (std::size_t row = 0; row < rows; ++row) {
      if (row % look_every == 0) throw_if_cancelled(context);
      cells.make(row, std::span(values).subspan(row * width, width));
    }
    npz.add(column.name, dtype_of<T>, shape, std::span<const T>(values));
  }
}

}  // namespace

std::size_t TableColumn::width() const {
  std::size_t width = 1;
  for (const std::uint64_t size : shape) width *= size;
  return width;
}

TableColumn column_of(std::string name, std::span<const Vec3d> vectors, std::vector<std::string> names) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double) && std::is_standard_layout_v<Vec3d>);
  const std::span numbers(reinterpret_cast<const double*>(vectors.data()), 3 * vectors.size());
  return column_of(std::move(name), {3}, numbers, std::move(names));
}

TableColumn column_of(const Column& column, std::vector<std::string> names) {
  std::vector<std::uint64_t> shape;
  if (column.components > 1) shape.push_back(column.components);
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        return column_of(column.name, std::move(shape), std::span<const T>(values), std::move(names));
      },
      column.values);
}

void write_npz(const std::filesystem::path& path, std::span<const Table> tables, const FileMetadata& metadata,
               const Context& context) {
  AtomicFile file(path);
  std::size_t bytes = 0;
  for (const Table& table : tables) bytes += byte_size(table);
  volume_io::FieldSink sink(bytes, context);
  volume_io::NpzWriter npz(file, sink, context);
  for (const Table& table : tables) {
    for (const TableColumn& column : table.columns) {
      std::visit([&](const auto& cells) { write_array(npz, column, cells, table.rows, context); }, column.cells);
    }
  }
  if (!metadata.empty()) npz.add_text("metadata", volume_io::to_json(metadata));
  npz.finish();
  file.commit();
}

void write_csv(const std::filesystem::path& path, const Table& table, const Context& context) {
  RowWriter file(path, table.rows, context);
  std::string line;
  const auto end_line = [&] {
    line += '\n';
    file.text(std::string_view(line).substr(1));  // drops the first comma
    line.clear();
  };
  std::vector<AppendRow> columns;
  for (const TableColumn& column : table.columns) {
    append_names(column, line);
    columns.push_back(csv_row_of(column));
  }
  end_line();
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (const AppendRow& append_row : columns) append_row(line, row);
    end_line();
    file.end_row();
  }
  file.finish();
}

void write_json(const std::filesystem::path& path, std::span<const Table> tables, const FileMetadata& metadata,
                const JsonStyle& style, const Context& context) {
  std::size_t rows = 0;
  for (const Table& table : tables) rows += table.columns.size() * table.rows;
  RowWriter file(path, rows, context);
  file.text("{\"metadata\": " + volume_io::to_typed_json(metadata, style.typed));
  for (const Table& table : tables) {
    for (const TableColumn& column : table.columns) write_list(file, column, table.rows, style.is_dense);
  }
  file.text("}\n");
  file.finish();
}

}  // namespace blum::tables

namespace blum::formats {
namespace {

void write_arrays(const fs::path& path, const tables::RowFile& file, const Context& context) {
  tables::write_npz(path, file.arrays(), file.metadata, context);
}

void write_rows(const fs::path& path, const tables::RowFile& file, const Context& context) {
  tables::write_csv(path, file.rows(), context);
}

void write_lists(const fs::path& path, const tables::RowFile& file, const Context& context) {
  tables::write_json(path, file.lists(), file.metadata, {file.typed_keys, file.has_dense_lists}, context);
}

void write_shapes(const fs::path& path, const tables::RowFile& file, const Context& context) {
  write_complex(path, file.shapes(), file.metadata, {}, context);
}

}  // namespace

constinit const RowCode rows_npz{write_arrays};
constinit const RowCode rows_csv{write_rows};
constinit const RowCode rows_json{write_lists};
constinit const RowCode rows_as_complex{write_shapes};

}  // namespace blum::formats
