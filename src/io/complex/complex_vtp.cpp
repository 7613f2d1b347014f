#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/complex/complex_files.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"
#include "io/text/json.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"
#include "io/text/vtk_xml.hpp"

namespace blum::complex_files {
namespace {

using volume_io::ScalarType;

using Put = std::function<void(std::span<const std::byte>)>;

/// Array of a file. Its bytes are computed while they are written, so that they need no memory.
struct OutArray {
  std::string name;
  ScalarType type = ScalarType::f64;
  std::size_t components = 1;
  std::uint64_t numbers = 0;  ///< number of numbers in all rows
  std::function<void(const Put&)> write;

  [[nodiscard]] std::uint64_t size() const { return numbers * volume_io::scalar_size(type); }
};

struct Section {
  std::string tag;  ///< opening tag with its attributes
  std::vector<OutArray> arrays;
};

template <class T>
void put_numbers(const Put& put, std::span<const T> numbers) {
  put(std::as_bytes(numbers));
}

constexpr std::size_t piece_size = 65536;

/// Writes the same number `count` times.
template <class T>
void put_fill(const Put& put, T value, std::uint64_t count) {
  const std::vector<T> piece(static_cast<std::size_t>(std::min<std::uint64_t>(count, piece_size)), value);
  while (count > 0) {
    const std::uint64_t now = std::min<std::uint64_t>(count, piece.size());
    put_numbers(put, std::span<const T>(piece).first(static_cast<std::size_t>(now)));
    count -= now;
  }
}

template <class Get>
void put_integers(const Put& put, std::uint64_t count, Get get) {
  std::vector<std::int64_t> piece;
  for (std::uint64_t begin = 0; begin < count; begin += piece_size) {
    piece.clear();
    for (std::uint64_t i = begin; i < std::min<std::uint64_t>(count, begin + piece_size); ++i) piece.push_back(get(i));
    put_numbers(put, std::span<const std::int64_t>(piece));
  }
}

OutArray whole_column(const Column& column) {
  return {column.name, scalar_type(column), column.components, column.rows() * column.components,
          [&column](const Put& put) {
            std::visit([&](const auto& values) { put_numbers(put, std::span(values)); }, column.values);
          }};
}

template <class T>
constexpr T fill_value = std::is_floating_point_v<T> ? std::numeric_limits<T>::quiet_NaN() : static_cast<T>(-1);

/// One array of a file's cells. It contains a column of edges, of triangles, or of both.
struct CellColumn {
  std::string name;  ///< name of the array
  const Column* edges = nullptr;
  const Column* triangles = nullptr;
  [[nodiscard]] const Column& any() const { return edges != nullptr ? *edges : *triangles; }
};

bool is_alike(const Column& a, const Column& b) {
  return a.components == b.components && a.values.index() == b.values.index();
}

/// Arrays for the columns of a complex's edges and triangles.
struct CellColumns {
  std::vector<CellColumn> arrays;
  FileMetadata edge_names, triangle_names;  ///< pairs: name of a column, name of its array

  explicit CellColumns(const Complex& complex) {
    for (const Column& column : complex.edge_columns) {
      arrays.push_back({column.name, &column, nullptr});
      edge_names.emplace_back(column.name, column.name);
    }
    for (const Column& column : complex.triangle_columns) {
      const auto same =
          std::find_if(arrays.begin(), arrays.end(), [&](const CellColumn& c) { return c.name == column.name; });
      if (same != arrays.end() && same->edges != nullptr && is_alike(*same->edges, column)) {
        same->triangles = &column;
        triangle_names.emplace_back(column.name, column.name);
      } else {
        arrays.push_back({unused_name(complex, column), nullptr, &column});
        triangle_names.emplace_back(column.name, arrays.back().name);
      }
    }
  }

 private:
  /// Returns the column's name if no other column of edges or triangles uses it; otherwise a longer name.
  [[nodiscard]] std::string unused_name(const Complex& complex, const Column& column) const {
    if (complex.edge_columns.find(column.name) == nullptr && !has(column.name)) return column.name;
    std::string name = "triangle_" + column.name;
    while (complex.edge_columns.find(name) != nullptr || complex.triangle_columns.find(name) != nullptr || has(name)) {
      name += "_";
    }
    return name;
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::any_of(arrays.begin(), arrays.end(), [&](const CellColumn& c) { return c.name == name; });
  }
};

/// Returns the numbers for single vertices (cells of a vertex each). The numbers come from the vertex column with the
/// same name, converted to T. If T cannot represent the values, the numbers are the fill value.
template <class T>
std::vector<T> numbers_of_verts(const Columns& columns, const std::string& name, std::size_t components,
                                std::span<const std::uint32_t> verts) {
  std::vector<T> out(verts.size() * components, fill_value<T>);
  const Column* column = columns.find(name);
  if (column == nullptr || column->components != components) return out;
  std::visit(
      [&]<class From>(const std::vector<From>& values) {
        if constexpr (std::is_floating_point_v<T> || (!std::is_floating_point_v<From> && sizeof(From) <= sizeof(T))) {
          for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = static_cast<T>(values[verts[i / components] * components + i % components]);
          }
        }
      },
      column->values);
  return out;
}

OutArray cell_array(const CellColumn& cell, const Complex& complex, std::span<const std::uint32_t> verts) {
  const Column& any = cell.any();
  const std::size_t components = any.components;
  const std::uint64_t cells = verts.size() + complex.edges.size() + complex.triangles.size();
  return {cell.name, scalar_type(any), components, cells * components,
          [&complex, cell, verts, components](const Put& put) {
            std::visit(
                [&]<class T>(const std::vector<T>&) {
                  const std::vector<T> of_verts =
                      numbers_of_verts<T>(complex.vertex_columns, cell.any().name, components, verts);
                  put_numbers(put, std::span<const T>(of_verts));
                  const auto put_column = [&](const Column* column, std::size_t rows) {
                    if (column == nullptr) return put_fill(put, fill_value<T>, rows * components);
                    put_numbers(put, std::span<const T>(std::get<std::vector<T>>(column->values)));
                  };
                  put_column(cell.edges, complex.edges.size());
                  put_column(cell.triangles, complex.triangles.size());
                },
                cell.any().values);
          }};
}

Section cells(const std::string& tag, std::uint64_t corners, std::uint64_t count,
              std::function<std::uint32_t(std::uint64_t)> corner) {
  Section section{tag, {}};
  section.arrays.push_back({"connectivity", ScalarType::i64, 1, count * corners,
                            [count, corners, corner = std::move(corner)](const Put& put) {
                              put_integers(put, count * corners, [&](std::uint64_t i) { return corner(i); });
                            }});
  section.arrays.push_back(
      {"offsets", ScalarType::i64, 1, count, [count, corners](const Put& put) {
         put_integers(put, count, [&](std::uint64_t i) { return static_cast<std::int64_t>((i + 1) * corners); });
       }});
  return section;
}

/// Returns a tag that makes VTK display the first array with one component.
std::string point_data_tag(const Columns& columns) {
  for (const Column& column : columns) {
    if (column.components == 1) return "PointData Scalars=\"" + column.name + "\"";
  }
  return "PointData";
}

/// Returns the sections of a file. They refer to the arguments, which must outlive them.
std::vector<Section> sections_of(const Complex& complex, const std::vector<CellColumn>& columns,
                                 std::span<const std::uint32_t> verts) {
  std::vector<Section> out{{point_data_tag(complex.vertex_columns), {}}, {"CellData", {}}, {"Points", {}}};
  for (const Column& column : complex.vertex_columns) out[0].arrays.push_back(whole_column(column));
  for (const CellColumn& column : columns) out[1].arrays.push_back(cell_array(column, complex, verts));
  out[2].arrays.push_back({"Points", ScalarType::f64, 3, 3 * complex.positions.size(),
                           [&complex](const Put& put) { put(std::as_bytes(std::span(complex.positions))); }});
  out.push_back(cells("Verts", 1, verts.size(), [verts](std::uint64_t i) { return verts[i]; }));
  out.push_back(
      cells("Lines", 2, complex.edges.size(), [&complex](std::uint64_t i) { return complex.edges[i / 2][i % 2]; }));
  out.push_back(cells("Polys", 3, complex.triangles.size(),
                      [&complex](std::uint64_t i) { return complex.triangles[i / 3][i % 3]; }));
  return out;
}
static_assert(sizeof(Vec3d) == 3 * sizeof(double));

std::string opening_text(const Complex& complex, std::size_t verts, const CellColumns& columns,
                         const FileMetadata& metadata) {
  std::string fields;
  if (!metadata.empty()) fields += volume_io::vtk_string_array("metadata", volume_io::to_json(metadata));
  fields += volume_io::vtk_string_array("edge_columns", volume_io::to_json(columns.edge_names));
  fields += volume_io::vtk_string_array("triangle_columns", volume_io::to_json(columns.triangle_names));
  return volume_io::vtk_opening("PolyData") + "  <PolyData>\n    <FieldData>\n" + fields +
         "    </FieldData>\n    <Piece NumberOfPoints=\"" + std::to_string(complex.positions.size()) +
         "\" NumberOfVerts=\"" + std::to_string(verts) + "\" NumberOfLines=\"" + std::to_string(complex.edges.size()) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(complex.triangles.size()) + "\">\n";
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions&, const Context& context) {
  const std::vector<std::uint32_t> verts = isolated_vertices(complex.view());
  const CellColumns columns(complex);
  const std::vector<Section> sections = sections_of(complex, columns.arrays, verts);
  std::string text = opening_text(complex, verts.size(), columns, metadata);
  std::uint64_t offset = 0;
  for (const Section& section : sections) {
    text += "      <" + section.tag + ">\n";
    for (const OutArray& array : section.arrays) {
      text += volume_io::vtk_appended_array(array.type, array.name, array.components, offset);
      offset += sizeof(std::uint64_t) + array.size();
    }
    text += "      </" + section.tag.substr(0, section.tag.find(' ')) + ">\n";
  }
  AtomicFile file(path);
  volume_io::FieldSink sink(offset, context);
  sink.write(file, text + "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
  const Put put = [&](std::span<const std::byte> bytes) { sink.write(file, bytes); };
  for (const Section& section : sections) {
    for (const OutArray& array : section.arrays) {
      const std::uint64_t size = array.size();
      put(std::as_bytes(std::span(&size, 1)));
      array.write(put);
    }
  }
  sink.write(file, "\n  </AppendedData>\n</VTKFile>\n");
  file.commit();
}

namespace {

bool begins_as_vtp(std::string_view head) {
  return volume_io::begins_as_vtk(head, "PolyData");
}

}  // namespace

}  // namespace blum::complex_files

namespace blum::formats {

constinit const ComplexCode complex_vtp{
    complex_files::read_vtp, nullptr, complex_files::write_vtp, {complex_files::begins_as_vtp}};

}  // namespace blum::formats

namespace blum::complex_files {
namespace {

using volume_io::VtkAppended;
using volume_io::VtkArray;
using volume_io::XmlTag;

struct NamedArray {
  std::string key;   ///< section and name, for example "PointData/radius"
  std::string name;  ///< name without the section
  VtkArray array;
};

struct VtpHeader {
  VtkAppended appended;
  std::uint64_t points = 0, verts = 0, lines = 0, polys = 0;
  std::vector<NamedArray> arrays;  ///< arrays with numbers, in file order
  FileMetadata metadata;
  /// Pairs (name of a column, name of its array), if the file lists them.
  std::optional<FileMetadata> edge_columns, triangle_columns;

  [[nodiscard]] const VtkArray* find(std::string_view key) const {
    const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.key == key; });
    return found == arrays.end() ? nullptr : &found->array;
  }
};

class VtpParser {
 public:
  VtpParser(std::string_view text, const std::string& name) : tags_(text, name), text_(text), name_(name) {}

  VtpHeader parse() {
    while (const auto tag = tags_.next()) {
      if (tag->name == "VTKFile") read_file(*tag);
      if (tag->name == "Piece") read_piece(*tag);
      if (is_section(tag->name)) section_ = tag->name;
      if (tag->name == "DataArray" || tag->name == "Array") read_array(*tag);
      if (tag->name == "AppendedData") {
        if (!seen_file_ || !seen_piece_) fail("it has no piece of PolyData");
        header_.appended.data_start = volume_io::vtk_data_start(*tag, text_, name_);
        return std::move(header_);
      }
    }
    fail("it has no appended data; save it with raw appended data");
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw FormatError(name_ + ": " + reason); }

  static bool is_section(std::string_view name) {
    constexpr std::array<std::string_view, 8> sections{"FieldData", "PointData", "CellData", "Points",
                                                       "Verts",     "Lines",     "Strips",   "Polys"};
    return std::find(sections.begin(), sections.end(), name) != sections.end();
  }

  void read_file(const XmlTag& tag) {
    seen_file_ = true;
    header_.appended = volume_io::vtk_layout(tag, "PolyData", name_);
  }

  void read_piece(const XmlTag& tag) {
    if (seen_piece_) fail("it is cut into several pieces; save it as one");
    seen_piece_ = true;
    header_.points = count(tag, "NumberOfPoints");
    header_.verts = count(tag, "NumberOfVerts");
    header_.lines = count(tag, "NumberOfLines");
    header_.polys = count(tag, "NumberOfPolys");
    if (count(tag, "NumberOfStrips") != 0) fail("it has strips of triangles; save it with single triangles");
    if (header_.points > max_id_count) fail("too many vertices: 2^31 - 1 are the most");
  }

  std::uint64_t count(const XmlTag& tag, std::string_view key) const {
    const auto value = volume_io::parse_number<std::uint64_t>(tag.find(key).value_or("0"));
    constexpr std::uint64_t limit = std::uint64_t{1} << 40U;
    if (!value || *value > limit) fail(std::string(key) + " must be a number of at most 2^40");
    return *value;
  }

  void read_array(const XmlTag& tag) {
    const std::string name = volume_io::without_entities(tag.find("Name").value_or(""));
    const std::string_view type = tag.find("type").value_or("");
    if (section_ == "FieldData") return read_text(tag, name);
    const bool is_data = section_ == "PointData" || section_ == "CellData";
    if (is_data && (name.empty() || type == "String" || type == "Bit")) return;
    if (!is_data && section_ != "Points" && name != "connectivity" && name != "offsets") return;
    // The section "Points" has one array, with the positions. Its name can be anything.
    const std::string shown(section_ == "Points" ? "Points" : name);
    const std::string key = std::string(section_) + "/" + shown;
    if (header_.find(key) != nullptr) fail("the array '" + key + "' occurs twice");
    constexpr std::size_t others = 10;  // number of arrays for positions, corners and ends of cells
    if (header_.arrays.size() > 3 * max_file_columns + others) fail("it has too many arrays");
    header_.arrays.push_back({key, shown, volume_io::vtk_array(tag, name_)});
  }

  void read_text(const XmlTag& tag, std::string_view name) {
    if (tag.find("type") != "String" || tag.find("format") != "ascii") return;
    const auto pairs = [&] { return volume_io::from_json(volume_io::vtk_string(tag.text, name_), name_); };
    if (name == "metadata") header_.metadata = pairs();
    if (name == "edge_columns") header_.edge_columns = pairs();
    if (name == "triangle_columns") header_.triangle_columns = pairs();
  }

  volume_io::XmlTags tags_;
  std::string_view text_;
  const std::string& name_;
  VtpHeader header_;
  std::string_view section_;
  bool seen_file_ = false;
  bool seen_piece_ = false;
};

/// Corners of all cells, one cell after the other.
struct Cells {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint64_t> ends;  ///< for each cell: index after its last corner
};

class VtpReader {
 public:
  VtpReader(const volume_io::ByteSource& source, VtpHeader header) : source_(source), header_(std::move(header)) {}

  ComplexFile read() {
    check_sizes();
    read_points();
    read_lines();
    read_polys();
    (void)read_cells("Verts", header_.verts);  // adds nothing to the points, but reports damaged data
    file_.metadata = std::move(header_.metadata);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
    throw FormatError(where(key) + ": " + reason);
  }
  [[nodiscard]] std::string where(const std::string& key) const { return source_.name() + "(" + key + ")"; }

  [[nodiscard]] std::uint64_t cell_count() const { return header_.verts + header_.lines + header_.polys; }

  /// Throws if arrays overlap, because reading them could exhaust memory.
  void check_sizes() const {
    std::uint64_t room = source_.size();
    for (const auto& [key, name, array] : header_.arrays) {
      const bool of_points = key.starts_with("PointData/");
      if (!of_points && !key.starts_with("CellData/")) continue;
      if (array.components == 0 || array.components > max_file_columns) {
        fail(key, "it has " + std::to_string(array.components) + " components; 1 to " +
                      std::to_string(max_file_columns) + " are read");
      }
      const std::uint64_t rows = of_points ? header_.points : cell_count();
      const std::uint64_t size = rows * array.components * volume_io::scalar_size(array.type);
      if (size > room) {
        throw FormatError(source_.name() + ": the number of " + (of_points ? "points" : "cells") +
                          " needs more bytes than the file has; it is cut short");
      }
      room -= size;
    }
  }

  /// Reads an array with `count` rows, one per point or cell.
  VoxelImage::Values values(const VtkArray& array, std::uint64_t count, const char* needed_by) const {
    const std::uint64_t numbers = count * array.components;
    auto stream = volume_io::open_vtk_array(source_, header_.appended, array, numbers, needed_by);
    VoxelImage::Values out = volume_io::make_values(array.type, static_cast<std::size_t>(numbers));
    stream.read(volume_io::as_bytes(out), "the array");
    volume_io::to_native(volume_io::as_bytes(out), array.type, header_.appended.order);
    return out;
  }

  /// Reads a required array with `count` rows and the given number of components.
  VoxelImage::Values needed_values(const std::string& key, std::uint64_t count, std::uint64_t components,
                                   const char* needed_by) const {
    const VtkArray* array = header_.find(key);
    if (array == nullptr) throw FormatError(source_.name() + ": the array '" + key + "' is missing");
    if (array->components != components) {
      fail(key, "it has " + std::to_string(array->components) + " components, not " + std::to_string(components));
    }
    return values(*array, count, needed_by);
  }

  void read_points() {
    Complex& complex = file_.complex;
    if (header_.points > 0) {
      const VoxelImage::Values places = needed_values("Points/Points", header_.points, 3, "the number of points");
      // Memory is allocated only now: the array that was just read has the same length, so the file is large enough.
      complex.positions.resize(header_.points);
      for_each_number(places, [&](std::size_t i, double value) { complex.positions[i / 3][i % 3] = value; });
    }
    complex.vertex_columns = Columns(header_.points);
    for (const auto& [key, name, array] : header_.arrays) {
      if (!key.starts_with("PointData/")) continue;
      Column column{name, array.components, {}};
      column.values = widened(values(array, header_.points, "the number of points"), where(key));
      add_column(complex.vertex_columns, std::move(column), where(key));
    }
  }

  Cells read_cells(const std::string& section, std::uint64_t count) const {
    Cells cells;
    if (count == 0) return cells;
    const std::string offsets = section + "/offsets";
    std::int64_t last = 0;
    for_each_integer(needed_values(offsets, count, 1, "the number of cells"), where(offsets),
                     [&](std::size_t /*i*/, std::int64_t end) {
                       constexpr std::int64_t limit = std::int64_t{1} << 40U;
                       if (end < last || end > limit) fail(offsets, "the offsets do not rise");
                       last = end;
                       cells.ends.push_back(static_cast<std::uint64_t>(end));
                     });
    const std::string corners = section + "/connectivity";
    for_each_integer(needed_values(corners, cells.ends.back(), 1, "the last of the offsets"), where(corners),
                     [&](std::size_t /*i*/, std::int64_t vertex) {
                       if (vertex < 0 || vertex >= static_cast<std::int64_t>(header_.points)) {
                         fail(corners, "vertex " + std::to_string(vertex) + " is used, but there are only " +
                                           std::to_string(header_.points) + " vertices");
                       }
                       cells.corners.push_back(static_cast<std::uint32_t>(vertex));
                     });
    return cells;
  }

  /// Returns the columns of `count` cells, starting with `first`.
  /// @param names  pairs (name of a column, name of its array). If unset, every array is a column.
  Columns cell_columns(const std::optional<FileMetadata>& names, std::uint64_t first, std::uint64_t count) const {
    Columns columns(count);
    if (names) {
      std::set<std::string_view> used;
      for (const auto& [column, array] : *names) {
        if (!used.insert(array).second)
          throw FormatError(source_.name() + ": two columns are the array '" + array + "'");
        const VtkArray* const found = header_.find("CellData/" + array);
        if (found == nullptr) throw FormatError(source_.name() + ": the array 'CellData/" + array + "' is missing");
        add_cell_column(columns, column, "CellData/" + array, *found, first);
      }
    } else if (count > 0) {
      for (const auto& [key, name, array] : header_.arrays) {
        if (key.starts_with("CellData/")) add_cell_column(columns, name, key, array, first);
      }
    }
    return columns;
  }

  void add_cell_column(Columns& columns, const std::string& name, const std::string& key, const VtkArray& array,
                       std::uint64_t first) const {
    Column column{name, array.components, widened(values(array, cell_count(), "the number of cells"), where(key))};
    std::visit(
        [&](auto& numbers) {
          const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(first * array.components);
          numbers = std::decay_t<decltype(numbers)>(
              begin, begin + static_cast<std::ptrdiff_t>(columns.rows() * array.components));
        },
        column.values);
    add_column(columns, std::move(column), where(key));
  }

  /// Reads lines. A line through several points becomes several edges, one between each two consecutive points.
  void read_lines() {
    const Cells cells = read_cells("Lines", header_.lines);
    Complex& complex = file_.complex;
    std::vector<std::uint32_t> steps;
    std::uint64_t begin = 0;
    for (const std::uint64_t end : cells.ends) {
      if (end - begin < 2) fail("Lines", "line " + std::to_string(steps.size()) + " has fewer than two points");
      for (std::uint64_t k = begin + 1; k < end; ++k) complex.edges.push_back({cells.corners[k - 1], cells.corners[k]});
      steps.push_back(static_cast<std::uint32_t>(end - begin - 1));
      begin = end;
    }
    complex.edge_columns = cell_columns(header_.edge_columns, header_.verts, header_.lines);
    if (complex.edges.size() != steps.size()) {
      complex.edge_columns = repeated(complex.edge_columns, steps, source_.size(), where("Lines"));
    }
  }

  void read_polys() {
    const Cells cells = read_cells("Polys", header_.polys);
    auto& triangles = file_.complex.triangles;
    triangles.resize(cells.ends.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (cells.ends[i] != 3 * (i + 1)) fail("Polys", "polygon " + std::to_string(i) + " is not a triangle");
      for (std::size_t k = 0; k < 3; ++k) triangles[i][k] = cells.corners[3 * i + k];
    }
    file_.complex.triangle_columns =
        cell_columns(header_.triangle_columns, header_.verts + header_.lines, header_.polys);
  }

  const volume_io::ByteSource& source_;
  VtpHeader header_;
  ComplexFile file_;
};

}  // namespace

ComplexFile read_vtp(const volume_io::ByteSource& source) {
  const std::string text = volume_io::read_vtk_header(source);
  return VtpReader(source, VtpParser(text, source.name()).parse()).read();
}

}  // namespace blum::complex_files
