#include <array>
#include <string>
#include <variant>
#include <vector>

#include "io/complex/complex_files.hpp"
#include "io/complex/complex_ply_names.hpp"
#include "io/format_table.hpp"
#include "io/text/json.hpp"
#include "io/text/row_writer.hpp"

namespace blum::complex_files {
namespace {

/// Metadata as comments, each a JSON object of one pair: no line becomes longer than readers of PLY like.
std::string comments_text(const FileMetadata& metadata) {
  std::string out;
  for (const auto& pair : metadata) out += "comment blum " + volume_io::to_json({pair}) + "\n";
  return out;
}

std::string property_lines(const Columns& columns, const PlyNames& names) {
  constexpr std::array<const char*, 4> types{"double", "float", "int64", "int"};
  static_assert(types.size() == std::variant_size_v<Column::Values>);
  std::string out;
  std::size_t next = 0;
  for (const Column& column : columns) {
    for (std::size_t i = 0; i < column.components; ++i) {
      out += std::string("property ") + types[column.values.index()] + " " + names.properties[next++] + "\n";
    }
  }
  return out;
}

/// The column that vertices have again for MeshLab; null where there is none, or no room.
const Column* derived_column(const Columns& columns) {
  if (columns.find(derived_property) != nullptr || columns.size() == max_file_columns) return nullptr;
  const Column* const column = columns.find(derived_from);
  const bool is_real = column != nullptr && column->components == 1 && column->type_name().starts_with("float");
  return is_real ? column : nullptr;
}

/// @throws InvalidOption where a row has more numbers than readers take.
void check_row(const std::filesystem::path& path, const Columns& columns) {
  std::size_t numbers = 0;
  for (const Column& column : columns) numbers += column.components;
  if (numbers + max_known_properties <= max_ply_properties) return;
  throw InvalidOption("'" + path.string() + "': " + std::to_string(numbers) +
                      " numbers for each vertex, edge or triangle are more than PLY files hold; write .npz");
}

std::string header_text(const Complex& complex, const FileMetadata& metadata) {
  std::vector<std::string> reserved{"x", "y", "z"};
  const bool has_derived = derived_column(complex.vertex_columns) != nullptr;
  if (has_derived) reserved.emplace_back(derived_property);
  const PlyNames of_vertices = property_names(complex.vertex_columns, "vertex", reserved);
  const PlyNames of_faces = property_names(complex.triangle_columns, "face", {"vertex_indices", "vertex_index"});
  const PlyNames of_edges = property_names(complex.edge_columns, "edge_attributes", {});
  const std::string edges = std::to_string(complex.edges.size());
  std::string out = "ply\nformat binary_little_endian 1.0\n" + comments_text(metadata) + of_vertices.comments +
                    of_faces.comments + of_edges.comments;
  out += "element vertex " + std::to_string(complex.positions.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\n" +
         property_lines(complex.vertex_columns, of_vertices);
  if (has_derived) out += "property float " + std::string(derived_property) + "\n";
  out += "element face " + std::to_string(complex.triangles.size()) + "\nproperty list uchar int vertex_indices\n" +
         property_lines(complex.triangle_columns, of_faces);
  // Readers such as trimesh's take all that is in `edge` for corners, and some take no files with edges.
  if (!complex.edges.empty() || !complex.edge_columns.empty()) {
    out += "element edge " + edges + "\nproperty int vertex1\nproperty int vertex2\n";
  }
  if (!complex.edge_columns.empty()) {
    out += "element edge_attributes " + edges + "\n" + property_lines(complex.edge_columns, of_edges);
  }
  return out + "end_header\n";
}

void write_attributes(RowWriter& out, const Columns& columns, std::size_t row) {
  for (const Column& column : columns) {
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = 0; i < column.components; ++i) out.bytes(values[row * column.components + i]);
        },
        column.values);
  }
}

void write_vertices(RowWriter& out, const Complex& complex) {
  const Column* const derived = derived_column(complex.vertex_columns);
  for (std::size_t v = 0; v < complex.positions.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) out.bytes(complex.positions[v][axis]);
    write_attributes(out, complex.vertex_columns, v);
    if (derived != nullptr) {
      std::visit([&](const auto& values) { out.bytes(static_cast<float>(values[v])); }, derived->values);
    }
    out.end_row();
  }
}

/// An axis that write_medial() wrote; of another complex, nothing tells that it is not a mesh.
bool holds_axis(std::string_view head, const std::filesystem::path&) {
  const std::string_view header = head.substr(0, head.find("end_header"));
  return header.find(R"(comment blum {"content": "medial axis"})") != std::string_view::npos;
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions&, const Context& context) {
  for (const Columns* columns : {&complex.vertex_columns, &complex.edge_columns, &complex.triangle_columns}) {
    check_row(path, *columns);
  }
  RowWriter out(path, complex.positions.size() + complex.triangles.size() + 2 * complex.edges.size(), context);
  out.text(header_text(complex, metadata));
  write_vertices(out, complex);
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    out.bytes(std::uint8_t{3});
    for (const std::uint32_t v : complex.triangles[t]) out.bytes(v);
    write_attributes(out, complex.triangle_columns, t);
    out.end_row();
  }
  for (const auto& edge : complex.edges) {
    for (const std::uint32_t v : edge) out.bytes(v);
    out.end_row();
  }
  for (std::size_t e = 0; e < complex.edges.size(); ++e) {
    write_attributes(out, complex.edge_columns, e);
    out.end_row();
  }
  out.finish();
}

}  // namespace blum::complex_files

namespace blum::formats {

constinit const ComplexCode complex_ply{
    nullptr, complex_files::read_ply, complex_files::write_ply, {.holds_this = complex_files::holds_axis}};

}  // namespace blum::formats
