#include "blum/core/debug_dump.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <fstream>
#include <string_view>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// The arrays of a VTK file. Each array has a tag in the text of the file. The numbers of the array follow at the end
/// of the file, after a count of their bytes.
class Arrays {
 public:
  /// @param attributes  type and name of the array, as XML attributes.
  template <class T>
  [[nodiscard]] std::string add(std::string_view attributes, const std::vector<T>& numbers) {
    const std::string offset = std::to_string(bytes_.size());
    const std::uint64_t size = numbers.size() * sizeof(T);
    append(&size, sizeof(size));
    append(numbers.data(), size);
    return "<DataArray " + std::string(attributes) + R"( format="appended" offset=")" + offset + "\"/>\n";
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;
};

/// Cells of one kind, stored as the corners of the first cell, of the second, and so on.
struct Cells {
  std::string_view kind;
  std::size_t corners_each = 1;
  std::vector<std::int64_t> corners;

  [[nodiscard]] std::size_t size() const { return corners.size() / corners_each; }

  [[nodiscard]] std::string section(Arrays& arrays) const {
    std::vector<std::int64_t> ends(size());
    for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = static_cast<std::int64_t>((i + 1) * corners_each);
    std::string text = "<" + std::string(kind) + ">\n";
    text += arrays.add(R"(type="Int64" Name="connectivity")", corners);
    text += arrays.add(R"(type="Int64" Name="offsets")", ends);
    return text + "</" + std::string(kind) + ">\n";
  }
};

/// The points of a file, and a record of the points that no cell uses.
class Points {
 public:
  explicit Points(std::span<const Vec3d> points) : points_(points), is_alone_(points.size()) {
    std::transform(points.begin(), points.end(), is_alone_.begin(), [](const Vec3d& p) { return is_finite(p); });
  }

  /// Returns the cells whose points all exist and are finite, and records their points as used.
  template <std::size_t corners>
  [[nodiscard]] Cells drawn(std::string_view kind, std::span<const std::array<std::uint32_t, corners>> cells) {
    Cells out{kind, corners, {}};
    for (const auto& cell : cells) {
      const auto is_there = [&](std::uint32_t v) { return v < points_.size() && is_finite(points_[v]); };
      if (!std::all_of(cell.begin(), cell.end(), is_there)) continue;
      out.corners.insert(out.corners.end(), cell.begin(), cell.end());
      for (const std::uint32_t v : cell) is_alone_[v] = false;
    }
    return out;
  }

  [[nodiscard]] Cells alone() const {
    Cells out{"Verts", 1, {}};
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (is_alone_[v]) out.corners.push_back(static_cast<std::int64_t>(v));
    }
    return out;
  }

  [[nodiscard]] std::string section(Arrays& arrays) const {
    std::vector<Vec3d> places(points_.begin(), points_.end());
    for (Vec3d& place : places) {
      if (!is_finite(place)) place = {};
    }
    return "<Points>\n" + arrays.add(R"(type="Float64" Name="Points" NumberOfComponents="3")", places) + "</Points>\n";
  }

 private:
  std::span<const Vec3d> points_;
  std::vector<bool> is_alone_;
};

std::string count(std::string_view what, std::size_t number) {
  return " NumberOf" + std::string(what) + "=\"" + std::to_string(number) + "\"";
}

}  // namespace

void debug_dump(const std::string& path, std::span<const Vec3d> points,
                std::span<const std::array<std::uint32_t, 2>> edges,
                std::span<const std::array<std::uint32_t, 3>> triangles) {
  Points all(points);
  const Cells lines = all.drawn("Lines", edges);
  const Cells polygons = all.drawn("Polys", triangles);
  const Cells alone = all.alone();

  Arrays arrays;
  const std::string_view order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  std::string text = R"(<?xml version="1.0"?>)"
                     "\n"
                     R"(<VTKFile type="PolyData" version="1.0" header_type="UInt64" byte_order=")";
  text.append(order).append("\">\n<PolyData>\n<Piece");
  text += count("Points", points.size());
  for (const Cells* cells : {&alone, &lines, &polygons}) text += count(cells->kind, cells->size());
  text += ">\n" + all.section(arrays);
  for (const Cells* cells : {&alone, &lines, &polygons}) text += cells->section(arrays);
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + arrays.bytes();
  text += "\n</AppendedData>\n</VTKFile>\n";

  std::ofstream file(path, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) throw FileError(path + ": cannot be written");
}

}  // namespace blum
