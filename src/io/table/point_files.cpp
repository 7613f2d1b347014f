#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/point_io.hpp"
#include "io/archive/numpy.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/complex/complex_ply_names.hpp"
#include "io/format_table.hpp"
#include "io/table/table_files.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

std::string quoted(const std::filesystem::path& path) {
  return "'" + path.string() + "'";
}

/// @param name  name of the file, for messages.
void check_finite(const std::vector<Vec3d>& points, const std::string& name) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!is_finite(points[k])) {
      throw FormatError(name + ": point " + std::to_string(k) + " has a coordinate that is not finite");
    }
  }
}

std::vector<Vec3d> points_of_array(volume_io::ByteStream& stream, const volume_io::NpyHeader& header) {
  using Kind = volume_io::NpyHeader::Kind;
  if (header.kind != Kind::scalar || header.shape.size() != 2 || header.shape[1] != 3) {
    throw FormatError(stream.name() + ": points are an array of numbers [n, 3], a row for each");
  }
  std::vector<Vec3d> points(header.shape[0]);
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < values.size(); ++i) points[i / 3][i % 3] = static_cast<double>(values[i]);
      },
      volume_io::read_npy_values(stream, header));
  return points;
}

std::vector<Vec3d> read_npy(const std::filesystem::path& path) {
  const volume_io::FileSource source(path);
  volume_io::PlainStream stream(source);
  std::vector<Vec3d> points = points_of_array(stream, volume_io::read_npy_header(stream));
  stream.check_end();
  return points;
}

std::vector<Vec3d> read_npz(const std::filesystem::path& path) {
  const volume_io::FileSource source(path);
  volume_io::NpzReader npz(source);
  const std::string array = npz.has("points") ? "points" : "vertices";
  if (!npz.has(array)) throw FormatError(quoted(path) + ": it has no array 'points' and no 'vertices'");
  return npz.read(array, points_of_array);
}

/// Reader of rows of numbers from text.
class RowReader {
 public:
  RowReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
  }

  std::vector<Vec3d> read() {
    std::vector<Vec3d> points;
    bool may_be_names = true;
    while (next_row()) {
      if (row_.empty() || row_.front() == '#') continue;
      const bool is_names = may_be_names && !volume_io::parse_number<double>(take_word());
      may_be_names = false;
      if (is_names) continue;
      row_ = whole_row_;
      Vec3d& point = points.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = number(axis);
    }
    return points;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(name_ + ", line " + std::to_string(line_) + ": " + what);
  }

  bool next_row() {
    if (text_.empty()) return false;
    const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
    whole_row_ = row_ = volume_io::trim(text_.substr(0, end));
    const bool is_pair = text_.substr(end).starts_with("\r\n");
    text_.remove_prefix(std::min(end + (is_pair ? 2 : 1), text_.size()));
    ++line_;
    return true;
  }

  /// Returns the text up to the next comma, semicolon or blank, and moves behind it.
  std::string_view take_word() {
    const std::size_t end = std::min(row_.find_first_of(",; \t"), row_.size());
    const std::string_view word = row_.substr(0, end);
    row_.remove_prefix(end);
    const bool has_blank = !row_.empty() && row_.front() != ',' && row_.front() != ';';
    row_ = volume_io::trim(row_);
    if (!has_blank || row_.starts_with(',') || row_.starts_with(';')) {
      if (!row_.empty()) row_ = volume_io::trim(row_.substr(1));
    }
    return word;
  }

  double number(std::size_t axis) {
    const std::string coordinate(1, "xyz"[axis]);
    if (row_.empty()) fail("there is no " + coordinate + ": a row has three numbers or more");
    const std::string_view word = take_word();
    const auto value = volume_io::parse_number<double>(word);
    if (!value) fail(coordinate + " is not a number: " + in_quotes(word));
    if (!std::isfinite(*value)) fail(coordinate + " is not finite: " + in_quotes(word));
    return *value;
  }

  std::string_view text_;
  std::string name_;
  std::string_view whole_row_, row_;
  std::size_t line_ = 0;
};

/// Returns a table with the coordinates as `points`, followed by the columns. In .csv, values have the names of PLY's
/// properties.
tables::Table table_of(const Complex& points) {
  const std::vector<std::string> axes{"x", "y", "z"};
  const auto names = complex_files::property_names(points.vertex_columns, "vertex", axes).properties;
  tables::Table table{points.positions.size(), {tables::column_of("points", points.positions, axes)}};
  auto name = names.begin();
  for (const Column& column : points.vertex_columns) {
    const auto end = name + static_cast<std::ptrdiff_t>(column.components);
    table.columns.push_back(tables::column_of(column, {name, end}));
    name = end;
  }
  return table;
}

void write_npz(const std::filesystem::path& path, const Complex& points, const FileMetadata& metadata,
               const Context& context) {
  for (const Column& column : points.vertex_columns) {
    if (column.name == "points" || column.name == "metadata") {
      throw InvalidOption(quoted(path) + ": a column has the name '" + column.name + "', which the file uses itself");
    }
  }
  const tables::Table table = table_of(points);
  tables::write_npz(path, std::span(&table, 1), metadata, context);
}

/// Returns true if the first lines of a file are rows of numbers, perhaps after a row of names.
bool begins_as_rows(std::string_view head) {
  // The last line may be cut off.
  if (head.size() == head_size) head = head.substr(0, head.find_last_of("\r\n"));
  if (head.find('\0') != std::string_view::npos) return false;
  try {
    return !RowReader(head, "").read().empty();
  } catch (const FormatError&) {
    return false;
  }
}

/// Reads points from a file whose extension is not known. Its content decides the format.
std::vector<Vec3d> read_points_by_content(const std::filesystem::path& path) {
  const std::string head = read_file_head(path);
  if (head.starts_with("\x93NUMPY")) return read_npy(path);
  if (head.starts_with("PK\x03\x04")) return read_npz(path);
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) {
    return read_complex(read_whole_file(path).span(), ComplexFormat("PLY"), path.string()).complex.positions;
  }
  const auto mesh = mesh_format_by_content(path, head);
  if (mesh) return read_mesh(read_whole_file(path).span(), *mesh, {}, path.string()).vertices;
  if (begins_as_rows(head)) return read_point_rows(read_whole_file(path).span(), quoted(path));
  throw FileError(quoted(path) + ": its content shows no format of points; points are read from " +
                  extension_list(FileContent::points, FileAccess::read, ", ") +
                  " files. Give the file one of these extensions; a pipe can have it by a link, as in `ln -s "
                  "/dev/stdin points.csv`");
}

}  // namespace

std::vector<std::string> cloud_extensions() {
  std::vector<std::string> out;
  for (const std::string& extension : file_extensions(FileContent::points, FileAccess::read)) {
    if (formats::code_of(PointFormat(extension)).is_cloud) out.push_back(extension);
  }
  return out;
}

std::vector<Vec3d> read_point_rows(std::span<const std::byte> text, const std::string& name) {
  return RowReader({reinterpret_cast<const char*>(text.data()), text.size()}, name).read();
}

std::vector<Vec3d> read_points(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool is_named = PointFormat::by_name(path).has_value() || !std::filesystem::exists(path, ignored);
  std::vector<Vec3d> points =
      is_named ? formats::code_of(PointFormat::of(path)).read(path) : read_points_by_content(path);
  check_finite(points, quoted(path));
  return points;
}

void write_points(const std::filesystem::path& path, const Complex& points, const FileMetadata& metadata,
                  const Context& context) {
  const auto format = PointFormat::of(path, FileAccess::write);
  validate(points);
  if (!points.edges.empty() || !points.triangles.empty()) {
    throw InvalidMesh("points have edges or triangles: write them with write_complex()");
  }
  FileMetadata stated = metadata;
  const auto is_content = [](const auto& pair) { return pair.first == "content"; };
  if (std::none_of(stated.begin(), stated.end(), is_content)) stated.insert(stated.begin(), {"content", "points"});
  formats::code_of(format).write(path, points, stated, context);
}

namespace formats {
namespace {

std::vector<Vec3d> read_text(const fs::path& path) {
  return read_point_rows(read_whole_file(path).span(), quoted(path));
}
std::vector<Vec3d> read_positions(const fs::path& path) {
  return read_complex(path).complex.positions;
}
std::vector<Vec3d> read_vertices(const fs::path& path) {
  return read_mesh(path).vertices;
}

void write_csv(const fs::path& path, const Complex& points, const FileMetadata& /*metadata*/, const Context& context) {
  tables::write_csv(path, table_of(points), context);
}
void write_as_complex(const fs::path& path, const Complex& points, const FileMetadata& metadata,
                      const Context& context) {
  write_complex(path, points, metadata, {}, context);
}

}  // namespace

constinit const PointCode points_npy{read_npy, nullptr, true};
constinit const PointCode points_npz{read_npz, write_npz, true};
constinit const PointCode points_text{read_text, write_csv, true};
// A .vtp file may contain polygons. Their area would be lost.
constinit const PointCode points_as_complex{read_positions, write_as_complex};
constinit const PointCode points_of_mesh{read_vertices, nullptr};

}  // namespace formats
}  // namespace blum
