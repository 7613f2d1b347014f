#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/complex/complex_files.hpp"
#include "io/complex/file_columns.hpp"
#include "io/text/json.hpp"
#include "io/text/text_scan.hpp"
#include "io/text/vtk_xml.hpp"

namespace blum::complex_files {
namespace {

using volume_io::VtkAppended;
using volume_io::VtkArray;
using volume_io::XmlTag;

struct NamedArray {
  std::string key;   ///< section and name, for example "PointData/radius"
  std::string name;  ///< without the section
  VtkArray array;
};

struct VtpHeader {
  VtkAppended appended;
  std::uint64_t points = 0, verts = 0, lines = 0, polys = 0;
  std::vector<NamedArray> arrays;  ///< of numbers, in the order of the file
  FileMetadata metadata;
  std::optional<FileMetadata> edge_columns, triangle_columns;  ///< columns and their arrays, where the file says

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
    // Whatever they call it, the one array of the points is their places.
    const std::string shown(section_ == "Points" ? "Points" : name);
    const std::string key = std::string(section_) + "/" + shown;
    if (header_.find(key) != nullptr) fail("the array '" + key + "' is there twice");
    constexpr std::size_t others = 10;  // places, corners and ends of cells
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

/// Corners of cells, one cell after the other.
struct Cells {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint64_t> ends;  ///< of each cell, in corners
};

class VtpReader {
 public:
  VtpReader(const volume_io::ByteSource& source, VtpHeader header) : source_(source), header_(std::move(header)) {}

  ComplexFile read() {
    check_sizes();
    read_points();
    read_lines();
    read_polys();
    (void)read_cells("Verts", header_.verts);  // say nothing that the points do not, but may be damaged
    file_.metadata = std::move(header_.metadata);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
    throw FormatError(where(key) + ": " + reason);
  }
  [[nodiscard]] std::string where(const std::string& key) const { return source_.name() + "(" + key + ")"; }

  [[nodiscard]] std::uint64_t cell_count() const { return header_.verts + header_.lines + header_.polys; }

  /// Arrays that lie upon each other could fill any memory.
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

  /// The values of an array for `count` points or cells.
  VoxelImage::Values values(const VtkArray& array, std::uint64_t count, const char* needed_by) const {
    const std::uint64_t numbers = count * array.components;
    auto stream = volume_io::open_vtk_array(source_, header_.appended, array, numbers, needed_by);
    VoxelImage::Values out = volume_io::make_values(array.type, static_cast<std::size_t>(numbers));
    stream.read(volume_io::as_bytes(out), "the array");
    volume_io::to_native(volume_io::as_bytes(out), array.type, header_.appended.order);
    return out;
  }

  /// An array that must be there, with so many components.
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
      complex.positions.resize(header_.points);  // the array that was just read is as long
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
                         fail(corners, "vertex " + std::to_string(vertex) + " is named, but there are only " +
                                           std::to_string(header_.points));
                       }
                       cells.corners.push_back(static_cast<std::uint32_t>(vertex));
                     });
    return cells;
  }

  /// The columns of the cells from `first` on, `count` of them.
  /// @param names  columns and their arrays; unset: all arrays are columns.
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

  /// A line through several points becomes as many edges as it has steps.
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
      if (cells.ends[i] != 3 * (i + 1)) fail("Polys", "polygon " + std::to_string(i) + " is no triangle");
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
