#include <array>
#include <string>
#include <utility>
#include <vector>

#include "blum/io/mesh_io.hpp"
#include "io/complex/complex_files.hpp"
#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"
#include "io/text/row_writer.hpp"

namespace blum::complex_files {
namespace {

/// Always returns false: a file with vertices, edges and triangles may also be a mesh.
bool never_matches(std::string_view, const std::filesystem::path&) {
  return false;
}

/// Written for a complex without vertices, because a file of 0 bytes looks as if it had never been written.
constexpr std::string_view empty_file = "# a complex without vertices\n";

template <std::size_t n>
void write_cell(RowWriter& out, std::string_view keyword, const std::array<std::uint32_t, n>& vertices) {
  out.text(keyword);
  for (const std::uint32_t v : vertices) out.number(std::uint64_t{v} + 1);
  out.text("\n");
  out.end_row();
}

}  // namespace

void write_obj(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context) {
  refuse_loss(path, "OBJ", complex, metadata, options);
  const std::vector<std::uint32_t> isolated = isolated_vertices(complex.view());
  RowWriter out(path, complex.positions.size() + complex.triangles.size() + complex.edges.size() + isolated.size(),
                context);
  if (complex.positions.empty()) out.text(empty_file);
  for (const Vec3d& position : complex.positions) {
    out.text("v");
    out.vector(position);
    out.text("\n");
    out.end_row();
  }
  for (const auto& triangle : complex.triangles) write_cell(out, "f", triangle);
  for (const auto& edge : complex.edges) write_cell(out, "l", edge);
  for (const std::uint32_t v : isolated) write_cell(out, "p", std::array{v});
  out.finish();
}

ComplexFile read_obj(std::string_view text, std::string_view name) {
  ComplexFile file;
  if (text == empty_file) return file;
  TriangleMesh mesh = formats::mesh_obj.read(text, name).mesh;
  file.complex.positions = std::move(mesh.vertices);
  file.complex.edges = std::move(mesh.segments);
  file.complex.triangles = std::move(mesh.triangles);
  return file;
}

}  // namespace blum::complex_files

namespace blum::formats {

constinit const ComplexCode complex_obj{nullptr,
                                        complex_files::read_obj,
                                        complex_files::write_obj,
                                        {.holds_this = complex_files::never_matches},
                                        false,
                                        false,
                                        false};

}  // namespace blum::formats
