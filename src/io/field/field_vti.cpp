#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/bytes/field_sink.hpp"
#include "io/field/field_files.hpp"
#include "io/field/field_metadata.hpp"
#include "io/format_table.hpp"
#include "io/text/vtk_xml.hpp"

namespace blum::volume_io {
namespace {

std::string vector_text(const Vec3d& v) {
  return exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z);
}

/// Row after row.
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

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const FieldCode field_vti{read_field_vti, write_field_vti};

}  // namespace blum::formats
