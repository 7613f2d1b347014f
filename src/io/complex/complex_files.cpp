#include "io/complex/file_columns.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "blum/io/complex_io.hpp"
#include "io/archive/npz.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::complex_files {

volume_io::ScalarType scalar_type(const Column& column) {
  using volume_io::ScalarType;
  constexpr std::array types{ScalarType::f64, ScalarType::f32, ScalarType::i64, ScalarType::i32};
  static_assert(types.size() == std::variant_size_v<Column::Values>);
  return types[column.values.index()];
}

void write_column(volume_io::NpzWriter& npz, const std::string& array, const Column& column) {
  std::vector<std::uint64_t> shape{column.rows()};
  if (column.components > 1) shape.push_back(column.components);
  std::visit(
      [&]<class T>(const std::vector<T>& values) {
        npz.add(array, volume_io::npy_dtype(scalar_type(column)), shape, std::span<const T>(values));
      },
      column.values);
}

Column::Values widened(VoxelImage::Values values, const std::string& where) {
  return std::visit(
      [&]<class T>(std::vector<T>& v) -> Column::Values {
        if constexpr (ColumnNumber<T>) {
          return std::move(v);
        } else if constexpr (sizeof(T) < 4) {
          return std::vector<std::int32_t>(v.begin(), v.end());
        } else {
          const bool fits = std::all_of(v.begin(), v.end(), [](T x) { return std::in_range<std::int64_t>(x); });
          if (!fits) throw FormatError(where + ": a value is too large");
          return std::vector<std::int64_t>(v.begin(), v.end());
        }
      },
      values);
}

namespace {

/// Whether a name can be shown everywhere: UTF-8, without bytes of 0.
bool is_text(std::string_view text) {
  std::uint32_t code = 0;
  std::uint32_t least = 0;  // of a sequence as long as this one
  int left = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (left > 0) {
      if (byte >> 6U != 2) return false;
      code = code << 6U | (byte & 0x3FU);
      const bool is_surrogate = code >> 11U == 0x1B;
      if (--left == 0 && (code < least || is_surrogate || code > 0x10FFFF)) return false;
    } else if (byte == 0 || (byte >= 0x80 && byte < 0xC0) || byte >= 0xF8) {
      return false;
    } else if (byte >= 0x80) {
      left = byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
      code = byte & (0x3FU >> static_cast<unsigned>(left));
      least = left == 1 ? 0x80 : left == 2 ? 0x800 : 0x10000;
    }
  }
  return left == 0;
}

}  // namespace

void check_name(std::string_view name, const char* what, const std::string& where) {
  if (is_text(name)) return;
  std::string place = where;
  std::replace(place.begin(), place.end(), '\0', '?');  // which would end the message
  throw FormatError(place + ": the name of the " + what + " " + in_quotes(name) +
                    " is not UTF-8 text, or has a byte of 0; rename it in the program that wrote the file");
}

void add_column(Columns& columns, Column column, const std::string& where) {
  check_name(column.name, "column", where);
  if (columns.size() == max_file_columns || column.components > max_file_columns) {
    throw FormatError(where + ": more than " + std::to_string(max_file_columns) + " columns, or numbers in a row");
  }
  try {
    columns.add(std::move(column));
  } catch (const InvalidOption& error) {
    throw FormatError(where + ": " + error.what());
  }
}

Columns repeated(const Columns& columns, std::span<const std::uint32_t> counts, std::uint64_t file_size,
                 const std::string& where) {
  std::uint64_t rows = 0;
  for (const std::uint32_t count : counts) rows += count;
  // Every count is at most the file's size, so the sum cannot overflow, but copies of wide rows could fill any memory.
  std::uint64_t width = 0;
  for (const Column& column : columns) width += column.components;
  constexpr std::uint64_t most_times = 8;
  if (rows > counts.size() && rows > (most_times * file_size + 1000) / std::max<std::uint64_t>(width, 1)) {
    throw FormatError(where + ": cells of many corners have so many attributes that cutting them takes more than " +
                      std::to_string(most_times) + " times the file; save it with single edges and triangles");
  }
  std::vector<std::uint32_t> sources;
  sources.reserve(rows);
  for (std::size_t i = 0; i < counts.size(); ++i)
    sources.insert(sources.end(), counts[i], static_cast<std::uint32_t>(i));
  return columns.pick(sources);
}

}  // namespace blum::complex_files
