#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"
#include "io/text/vtk_xml.hpp"

namespace blum::volume_io {
namespace {

std::string vector_text(const Vec3d& v) {
  return exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z);
}

/// Returns the numbers of a matrix as text, row by row.
std::string matrix_text(const Mat3& m) {
  std::string out;
  for (std::size_t row = 0; row < 3; ++row) {
    out += (row == 0 ? "" : " ") + vector_text({m.columns[0][row], m.columns[1][row], m.columns[2][row]});
  }
  return out;
}

std::string extent_text(const std::array<std::int64_t, 3>& size) {
  return "0 " + std::to_string(size[0] - 1) + " 0 " + std::to_string(size[1] - 1) + " 0 " + std::to_string(size[2] - 1);
}

std::string header_text(const Field& field, const FieldFileInfo& info) {
  const std::string extent = extent_text(field.grid.size);
  std::string out =
      vtk_opening("ImageData") + "  <ImageData WholeExtent=\"" + extent + "\" Origin=\"" +
      vector_text(field.grid.origin) + "\" Spacing=\"" + vector_text(field.grid.spacing) + "\" Direction=\"" +
      matrix_text(field.grid.direction) + "\">\n    <FieldData>\n" +
      vtk_string_array("metadata", to_json(field_metadata(field, info))) + "    </FieldData>\n    <Piece Extent=\"" +
      extent + "\">\n      <PointData Scalars=\"distance\">\n" + vtk_appended_array(ScalarType::f32, "distance", 1, 0);
  std::uint64_t offset = sizeof(std::uint64_t) + distance_bytes(field).size();
  const auto add = [&](ScalarType type, const char* name, std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    out += vtk_appended_array(type, name, 1, offset);
    offset += sizeof(std::uint64_t) + bytes.size();
  };
  add(ScalarType::i32, "site", site_bytes(field));
  add(ScalarType::f32, "distance2", distance2_bytes(field));
  add(ScalarType::i32, "site2", site2_bytes(field));
  out += "      </PointData>\n    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">\n_";
  return out;
}

void write_array(FieldSink& sink, AtomicFile& file, std::span<const std::byte> bytes) {
  const std::uint64_t size = bytes.size();
  sink.write(file, std::as_bytes(std::span(&size, 1)));
  sink.write(file, bytes);
}

}  // namespace

void write_field_vti(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                     const Context& context) {
  AtomicFile file(path);
  FieldSink sink(array_size(field), context);
  sink.write(file, header_text(field, info));
  write_array(sink, file, distance_bytes(field));
  for (const auto bytes : {site_bytes(field), distance2_bytes(field), site2_bytes(field)}) {
    if (!bytes.empty()) write_array(sink, file, bytes);
  }
  sink.write(file, "\n  </AppendedData>\n</VTKFile>\n");
  file.commit();
}

namespace {

bool begins_as_vti(std::string_view head) {
  return begins_as_vtk(head, "ImageData");
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const FieldCode field_vti{read_field_vti, write_field_vti, {begins_as_vti}};

}  // namespace blum::formats

namespace blum::volume_io {
namespace {

struct VtiHeader {
  GridSpec grid;
  VtkAppended appended;
  std::optional<VtkArray> distance, site, distance2, site2;
  std::string metadata;
};

class VtiParser {
 public:
  VtiParser(std::string_view text, const std::string& name) : tags_(text, name), text_(text), name_(name) {}

  VtiHeader parse() {
    while (const auto tag = tags_.next()) {
      if (tag->name == "VTKFile") read_file(*tag);
      if (tag->name == "ImageData") read_image(*tag);
      if (tag->name == "Piece") read_piece(*tag);
      if (tag->name == "FieldData" || tag->name == "PointData" || tag->name == "CellData") section_ = tag->name;
      if (tag->name == "DataArray" || tag->name == "Array") read_array(*tag);
      if (tag->name == "AppendedData") {
        read_appended(*tag);
        return std::move(header_);
      }
    }
    fail("it has no appended data; save it with raw appended data");
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw FormatError(name_ + ": " + reason); }

  template <class T, std::size_t n>
  std::optional<std::array<T, n>> numbers(const XmlTag& tag, std::string_view key) const {
    const auto text = tag.find(key);
    if (!text) return std::nullopt;
    const auto words = split_words(*text);
    std::array<T, n> out{};
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = i < words.size() ? parse_number<T>(words[i]) : std::nullopt;
      if (!value || words.size() != n) fail(std::string(key) + " must be " + std::to_string(n) + " numbers");
      out[i] = *value;
    }
    return out;
  }

  void read_file(const XmlTag& tag) {
    seen_file_ = true;
    header_.appended = vtk_layout(tag, "ImageData", name_);
  }

  void read_image(const XmlTag& tag) {
    const auto extent = numbers<std::int64_t, 6>(tag, "WholeExtent");
    if (!seen_file_ || !extent) fail("it has no WholeExtent in a VTKFile");
    extent_ = *extent;
    Vec3d start{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t low = extent_[2 * a];
      const std::int64_t high = extent_[2 * a + 1];
      constexpr std::int64_t limit = std::int64_t{1} << 40U;
      if (low < -limit || high > limit || high < low) fail("the extent is empty or too large");
      header_.grid.size[a] = high - low + 1;
      start[a] = static_cast<double>(low);
    }
    check_count(header_.grid.size, max_field_nodes, name_);
    const auto origin = numbers<double, 3>(tag, "Origin").value_or(std::array<double, 3>{0, 0, 0});
    const auto spacing = numbers<double, 3>(tag, "Spacing").value_or(std::array<double, 3>{1, 1, 1});
    const auto d = numbers<double, 9>(tag, "Direction").value_or(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
    GridSpec& grid = header_.grid;
    set_frame(grid, {Vec3d{d[0], d[3], d[6]}, Vec3d{d[1], d[4], d[7]}, Vec3d{d[2], d[5], d[8]}},
              {spacing[0], spacing[1], spacing[2]}, name_);
    // In VTK, the origin is the position of index 0, even if the extent starts at another index.
    const Vec3d offset{start.x * grid.spacing.x, start.y * grid.spacing.y, start.z * grid.spacing.z};
    grid.origin = Vec3d{origin[0], origin[1], origin[2]};
    if (start != Vec3d{}) grid.origin += grid.direction * offset;
    if (!is_finite(grid.origin)) fail("the origin is not finite");
  }

  void read_piece(const XmlTag& tag) const {
    if (numbers<std::int64_t, 6>(tag, "Extent") != extent_) fail("it is cut into several pieces; save it as one");
  }

  void read_array(const XmlTag& tag) {
    const std::string_view name = tag.find("Name").value_or("");
    if (section_ == "FieldData" && name == "metadata" && tag.find("type") == "String" &&
        tag.find("format") == "ascii") {
      header_.metadata = vtk_string(tag.text, name_);
    }
    std::optional<VtkArray>* const place = place_of(name);
    if (section_ != "PointData" || place == nullptr) return;
    const VtkArray array = vtk_array(tag, name_);
    if (array.components != 1) fail("'" + std::string(name) + "' has several components at each point");
    *place = array;
  }

  std::optional<VtkArray>* place_of(std::string_view name) {
    if (name == "distance") return &header_.distance;
    if (name == "site") return &header_.site;
    if (name == "distance2") return &header_.distance2;
    return name == "site2" ? &header_.site2 : nullptr;
  }

  void read_appended(const XmlTag& tag) {
    if (!seen_file_ || header_.grid.node_count() == 0) fail("it has no ImageData");
    if (!header_.distance) fail("it has no point data 'distance'");
    header_.appended.data_start = vtk_data_start(tag, text_, name_);
  }

  XmlTags tags_;
  std::string_view text_;
  const std::string& name_;
  VtiHeader header_;
  std::array<std::int64_t, 6> extent_{};
  std::string_view section_;
  bool seen_file_ = false;
};

}  // namespace

Field read_field_vti(const ByteSource& source, const std::filesystem::path&) {
  const std::string text = read_vtk_header(source);
  const VtiHeader header = VtiParser(text, source.name()).parse();
  const std::uint64_t count = header.grid.node_count();
  const auto reader = [&](PlainStream& stream, const VtkArray& place) {
    stream.check_left(count * scalar_size(place.type), "the array");
    return [&](std::span<std::byte> out) {
      stream.read(out, "the array");
      to_native(out, place.type, header.appended.order);
    };
  };
  Field field;
  field.grid = header.grid;
  const auto read_floats = [&](const std::optional<VtkArray>& place, Buffer<float>& out) {
    if (!place) return;
    PlainStream stream = open_vtk_array(source, header.appended, *place, count, "the extent");
    out = read_distances(place->type, count, reader(stream, *place));
  };
  const auto read_ids = [&](const std::optional<VtkArray>& place, Buffer<SiteId>& out) {
    if (!place) return;
    PlainStream stream = open_vtk_array(source, header.appended, *place, count, "the extent");
    out = read_sites(place->type, count, reader(stream, *place), source.name());
  };
  read_floats(header.distance, field.distance);
  read_ids(header.site, field.site);
  read_floats(header.distance2, field.distance2);
  read_ids(header.site2, field.site2);
  if (!header.metadata.empty()) {
    apply_metadata(from_json(header.metadata, source.name()), source.name(), field);
  }
  return field;
}

}  // namespace blum::volume_io
