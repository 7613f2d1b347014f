#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "io/medial_columns.hpp"
#include "io/medial_files.hpp"
#include "io/text_scan.hpp"
#include "io/vtk_xml.hpp"

namespace blum::medial_files {
namespace {

using volume_io::VtkAppended;
using volume_io::VtkArray;
using volume_io::XmlTag;

struct VtpHeader {
  VtkAppended appended;
  std::uint64_t points = 0, verts = 0, lines = 0, polys = 0;
  /// By section and name, for example "PointData/radius"; those that mean something here, in the order of the file.
  std::vector<std::pair<std::string, VtkArray>> arrays;
  std::string metadata;

  [[nodiscard]] const VtkArray* find(std::string_view key) const {
    const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.first == key; });
    return found == arrays.end() ? nullptr : &found->second;
  }
};

constexpr std::array<std::string_view, 17> known_arrays{"PointData/radius",      "PointData/separation_angle",
                                                        "PointData/role",        "PointData/footprint_0",
                                                        "PointData/footprint_1", "PointData/site_0",
                                                        "PointData/site_1",      "CellData/separation_angle",
                                                        "CellData/role",         "CellData/sheet",
                                                        "Points/Points",         "Verts/connectivity",
                                                        "Verts/offsets",         "Lines/connectivity",
                                                        "Lines/offsets",         "Polys/connectivity",
                                                        "Polys/offsets"};

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
    const std::string_view name = tag.find("Name").value_or("");
    if (section_ == "FieldData" && name == "metadata" && tag.find("type") == "String" &&
        tag.find("format") == "ascii") {
      header_.metadata = volume_io::vtk_string(tag.text, name_);
      return;
    }
    // Whatever they call it, the one array of the points is their places.
    const std::string key = std::string(section_) + "/" + (section_ == "Points" ? "Points" : std::string(name));
    if (std::find(known_arrays.begin(), known_arrays.end(), key) == known_arrays.end()) return;
    if (header_.find(key) != nullptr) fail("the array '" + key + "' is there twice");
    header_.arrays.emplace_back(key, volume_io::vtk_array(tag, name_));
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

  MedialFile read() {
    read_points();
    read_lines();
    read_polys();
    (void)read_cells("Verts", header_.verts);  // say nothing that the points do not, but may be damaged
    file_.has_angles = header_.find("PointData/separation_angle") != nullptr && has_cells("separation_angle");
    file_.has_labels =
        header_.find("PointData/role") != nullptr && has_cells("role") && (has_cells("sheet") || header_.polys == 0);
    if (!has_cells("role")) keep_curves_only(file_.complex);
    if (!header_.metadata.empty()) {
      file_.metadata = from_pairs(volume_io::from_json(header_.metadata, source_.name()), source_.name());
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
    throw FormatError(where(key) + ": " + reason);
  }
  [[nodiscard]] std::string where(const std::string& key) const { return source_.name() + "(" + key + ")"; }
  [[nodiscard]] bool has_cells(const std::string& name) const {
    return header_.find("CellData/" + name) != nullptr || header_.verts + header_.lines + header_.polys == 0;
  }

  /// The values of one array, which must be there, with so many components.
  VoxelImage::Values values(const std::string& key, std::uint64_t count, std::uint64_t components,
                            const char* needed_by) const {
    const VtkArray* array = header_.find(key);
    if (array == nullptr) throw FormatError(source_.name() + ": the array '" + key + "' is missing");
    if (array->components != components) {
      throw FormatError(where(key) + ": it has " + std::to_string(array->components) + " components, not " +
                        std::to_string(components));
    }
    auto stream = volume_io::open_vtk_array(source_, header_.appended, *array, count * components, needed_by);
    VoxelImage::Values out = volume_io::make_values(array->type, static_cast<std::size_t>(count * components));
    stream.read(volume_io::as_bytes(out), "the array");
    volume_io::to_native(volume_io::as_bytes(out), array->type, header_.appended.order);
    return out;
  }

  // The functions that are called with integers get one more argument, to call with what is wrong with a value.

  /// Calls set(vertex, component, value) for all values of an array of the points; false when it is not there.
  template <class Set>
  bool point_numbers(const std::string& key, std::uint64_t components, Set set) {
    if (header_.find(key) == nullptr) return false;
    for_each_number(values(key, header_.points, components, "the number of points"), [&](std::size_t i, double value) {
      set(file_.complex.vertices[i / components], i % components, value);
    });
    return true;
  }
  template <class Set>
  bool point_integers(const std::string& key, Set set) {
    if (header_.find(key) == nullptr) return false;
    const auto bad = [&](const std::string& reason) { fail(key, reason); };
    for_each_integer(values(key, header_.points, 1, "the number of points"), where(key),
                     [&](std::size_t i, std::int64_t value) { set(file_.complex.vertices[i], value, bad); });
    return true;
  }

  void read_points() {
    using V = MedialVertex;
    if (header_.points == 0) {
      file_.has_radii = header_.find("PointData/radius") != nullptr;
      file_.has_footprints = header_.find("PointData/footprint_1") != nullptr;
      file_.has_sites = header_.find("PointData/site_1") != nullptr;
      return;
    }
    const VoxelImage::Values places = values("Points/Points", header_.points, 3, "the number of points");
    file_.complex.vertices.resize(header_.points);  // the array that was just read is as long
    for_each_number(places,
                    [&](std::size_t i, double value) { file_.complex.vertices[i / 3].position[i % 3] = value; });
    file_.has_radii = point_numbers("PointData/radius", 1, [](V& v, std::size_t, double value) { v.radius = value; });
    point_numbers("PointData/separation_angle", 1, [](V& v, std::size_t, double value) { v.separation_angle = value; });
    point_integers("PointData/role",
                   [&](V& v, std::int64_t value, const auto& bad) { v.role = role_from_file(value, bad); });
    file_.has_footprints = file_.has_sites = true;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::string number = std::to_string(side);
      const bool there = point_numbers("PointData/footprint_" + number, 3,
                                       [&](V& v, std::size_t c, double value) { v.footprints[side][c] = value; });
      const std::string key = "PointData/site_" + number;
      const bool named = point_integers(
          key, [&](V& v, std::int64_t value, const auto& bad) { v.sites[side] = site_from_file(value, bad); });
      file_.has_footprints = file_.has_footprints && there;
      file_.has_sites = file_.has_sites && named;
    }
  }

  Cells read_cells(const std::string& section, std::uint64_t count) const {
    Cells cells;
    if (count == 0) return cells;
    const std::string offsets = section + "/offsets";
    std::int64_t last = 0;
    for_each_integer(values(offsets, count, 1, "the number of cells"), where(offsets),
                     [&](std::size_t /*i*/, std::int64_t end) {
                       constexpr std::int64_t limit = std::int64_t{1} << 40U;
                       if (end < last || end > limit) fail(offsets, "the offsets do not rise");
                       last = end;
                       cells.ends.push_back(static_cast<std::uint64_t>(end));
                     });
    const std::string corners = section + "/connectivity";
    for_each_integer(values(corners, cells.ends.back(), 1, "the last of the offsets"), where(corners),
                     [&](std::size_t /*i*/, std::int64_t vertex) {
                       if (vertex < 0 || vertex >= static_cast<std::int64_t>(header_.points)) {
                         fail(corners, "vertex " + std::to_string(vertex) + " is named, but there are only " +
                                           std::to_string(header_.points));
                       }
                       cells.corners.push_back(static_cast<std::uint32_t>(vertex));
                     });
    return cells;
  }

  /// Calls set(cell, value) for the cells from `first` on, `count` of them.
  template <class Set>
  void cell_numbers(const std::string& key, std::uint64_t first, std::uint64_t count, Set set) const {
    if (header_.find(key) == nullptr || count == 0) return;
    for_each_number(values(key, header_.verts + header_.lines + header_.polys, 1, "the number of cells"),
                    [&](std::size_t i, double value) {
                      if (i >= first && i - first < count) set(i - first, value);
                    });
  }
  template <class Set>
  void cell_integers(const std::string& key, std::uint64_t first, std::uint64_t count, Set set) const {
    if (header_.find(key) == nullptr || count == 0) return;
    const auto bad = [&](const std::string& reason) { fail(key, reason); };
    for_each_integer(values(key, header_.verts + header_.lines + header_.polys, 1, "the number of cells"), where(key),
                     [&](std::size_t i, std::int64_t value) {
                       if (i >= first && i - first < count) set(i - first, value, bad);
                     });
  }

  /// A line through several points becomes as many edges as it has steps.
  void read_lines() {
    const Cells cells = read_cells("Lines", header_.lines);
    std::vector<MedialEdge> lines(cells.ends.size());
    cell_numbers("CellData/separation_angle", header_.verts, header_.lines,
                 [&](std::size_t i, double value) { lines[i].separation_angle = angle_from_file(value); });
    cell_integers(
        "CellData/role", header_.verts, header_.lines,
        [&](std::size_t i, std::int64_t value, const auto& bad) { lines[i].role = role_from_file(value, bad); });
    std::uint64_t begin = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (cells.ends[i] - begin < 2) fail("Lines", "line " + std::to_string(i) + " has fewer than two points");
      for (std::uint64_t k = begin + 1; k < cells.ends[i]; ++k) {
        lines[i].vertices = {cells.corners[k - 1], cells.corners[k]};
        file_.complex.edges.push_back(lines[i]);
      }
      begin = cells.ends[i];
    }
  }

  void read_polys() {
    const Cells cells = read_cells("Polys", header_.polys);
    std::vector<MedialTriangle>& triangles = file_.complex.triangles;
    triangles.resize(cells.ends.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (cells.ends[i] != 3 * (i + 1)) fail("Polys", "polygon " + std::to_string(i) + " is no triangle");
      for (std::size_t k = 0; k < 3; ++k) triangles[i].vertices[k] = cells.corners[3 * i + k];
    }
    const std::uint64_t first = header_.verts + header_.lines;
    cell_numbers("CellData/separation_angle", first, header_.polys,
                 [&](std::size_t i, double value) { triangles[i].separation_angle = angle_from_file(value); });
    cell_integers("CellData/sheet", first, header_.polys, [&](std::size_t i, std::int64_t value, const auto& bad) {
      triangles[i].sheet = sheet_from_file(value, bad);
    });
  }

  const volume_io::ByteSource& source_;
  VtpHeader header_;
  MedialFile file_;
};

}  // namespace

MedialFile read_vtp(const volume_io::ByteSource& source) {
  const std::string text = volume_io::read_vtk_header(source);
  return VtpReader(source, VtpParser(text, source.name()).parse()).read();
}

}  // namespace blum::medial_files
