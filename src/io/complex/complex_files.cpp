#include "io/complex/complex_files.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <type_traits>

#include "blum/core/error.hpp"
#include "blum/io/complex_io.hpp"
#include "io/archive/numpy.hpp"
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

/// Returns true if a name can be displayed everywhere: it is UTF-8 and contains no zero byte.
bool is_text(std::string_view text) {
  std::uint32_t code = 0;
  std::uint32_t least = 0;  // smallest code point that needs a sequence of this length
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
  std::replace(place.begin(), place.end(), '\0', '?');  // a zero byte would end the message
  throw FormatError(place + ": the name of the " + what + " " + in_quotes(name) +
                    " is not UTF-8 text, or has a byte of 0; rename it in the program that wrote the file");
}

void add_column(Columns& columns, Column column, const std::string& where) {
  check_name(column.name, "column", where);
  if (columns.size() == max_file_columns || column.components > max_file_columns) {
    throw FormatError(where + ": there are more columns, or numbers in a row, than the limit of " +
                      std::to_string(max_file_columns));
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
  // Every count is at most the file's size, so the sum cannot overflow. But copies of long rows could exhaust memory,
  // so their size is limited.
  std::uint64_t width = 0;
  for (const Column& column : columns) width += column.components;
  constexpr std::uint64_t most_times = 8;
  if (rows > counts.size() && rows > (most_times * file_size + 1000) / std::max<std::uint64_t>(width, 1)) {
    throw FormatError(where +
                      ": cutting polylines and polygons into edges and triangles would copy attributes to more than " +
                      std::to_string(most_times) + " times the size of the file; save single edges and triangles");
  }
  std::vector<std::uint32_t> sources;
  sources.reserve(rows);
  for (std::size_t i = 0; i < counts.size(); ++i)
    sources.insert(sources.end(), counts[i], static_cast<std::uint32_t>(i));
  return columns.pick(sources);
}

namespace {

template <class Use>
void for_each_side(const ComplexView& complex, EdgeSet::Of which, Use use) {
  const auto add = [&](std::uint32_t a, std::uint32_t b) { use(std::min(a, b), std::max(a, b)); };
  if (which == EdgeSet::Of::edges_and_triangles) {
    for (const auto& edge : complex.edges) add(edge[0], edge[1]);
  }
  for (const auto& triangle : complex.triangles) {
    for (std::size_t i = 0; i < 3; ++i) add(triangle[i], triangle[(i + 1) % 3]);
  }
}

}  // namespace

EdgeSet::EdgeSet(const ComplexView& complex, Of which, const Context& context) : begin_(complex.vertex_count + 1, 0) {
  for_each_side(complex, which, [&](std::uint32_t a, std::uint32_t /*b*/) { ++begin_[a + std::size_t{1}]; });
  throw_if_cancelled(context);
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  others_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for_each_side(complex, which, [&](std::uint32_t a, std::uint32_t b) { others_[next[a]++] = b; });
  throw_if_cancelled(context);
  sort_and_merge();
}

void EdgeSet::sort_and_merge() {
  std::size_t kept = 0;
  std::size_t from = 0;
  for (std::size_t a = 0; a + 1 < begin_.size(); ++a) {
    const auto first = others_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto last = others_.begin() + static_cast<std::ptrdiff_t>(begin_[a + 1]);
    std::sort(first, last);
    const auto end = std::unique(first, last);
    std::copy(first, end, others_.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += static_cast<std::size_t>(end - first);
    from = begin_[a + 1];
    begin_[a + 1] = kept;
  }
  others_.resize(kept);
}

bool EdgeSet::contains(const std::array<std::uint32_t, 2>& edge) const {
  const auto [low, high] = std::minmax(edge[0], edge[1]);
  return std::binary_search(others_.begin() + static_cast<std::ptrdiff_t>(begin_[low]),
                            others_.begin() + static_cast<std::ptrdiff_t>(begin_[low + std::size_t{1}]), high);
}

std::vector<std::uint32_t> isolated_vertices(const ComplexView& complex) {
  std::vector<bool> used(complex.vertex_count, false);
  for (const auto& edge : complex.edges) {
    for (const std::uint32_t v : edge) used[v] = true;
  }
  for (const auto& triangle : complex.triangles) {
    for (const std::uint32_t v : triangle) used[v] = true;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) out.push_back(static_cast<std::uint32_t>(v));
  }
  return out;
}

namespace {

/// Returns the names of all columns except the one named `kept`, for messages.
std::string names_of(const Columns& columns, std::string_view kept) {
  std::string names;
  for (const Column& column : columns) {
    if (column.name != kept) names += (names.empty() ? "" : ", ") + column.name;
  }
  return names;
}

}  // namespace

void refuse_loss(const std::filesystem::path& path, std::string_view format, const Complex& complex,
                 const FileMetadata& metadata, const ComplexWriteOptions& options, std::string_view kept) {
  if (options.allow_loss) return;
  std::string lost;
  const auto lose = [&](const std::string& what) { lost += (lost.empty() ? "" : "; ") + what; };
  const auto lose_columns = [&](const char* of, const Columns& columns, std::string_view but) {
    if (const std::string names = names_of(columns, but); !names.empty()) {
      lose(std::string("columns of ") + of + " (" + names + ")");
    }
  };
  lose_columns("vertices", complex.vertex_columns, kept);
  lose_columns("edges", complex.edge_columns, {});
  lose_columns("triangles", complex.triangle_columns, {});
  if (!metadata.empty()) lose("metadata");
  if (lost.empty()) return;
  const std::string also = kept.empty() ? std::string() : ", the column '" + std::string(kept) + "' of vertices";
  throw InvalidOption("'" + path.string() + "': " + std::string(format) + " files hold positions, edges and triangles" +
                      also + " only, so these would be lost: " + lost +
                      "; write .vtp, .ply or .npz, or allow the loss");
}

}  // namespace blum::complex_files
