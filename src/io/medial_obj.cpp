#include <array>
#include <string>
#include <vector>

#include "blum/io/mesh_io.hpp"
#include "io/medial_edges.hpp"
#include "io/medial_files.hpp"
#include "io/mesh_builder.hpp"
#include "io/row_writer.hpp"

namespace blum::medial_files {
namespace {

/// Stands in for the vertices of an empty axis: a file of no bytes might as well be one that was never written.
constexpr std::string_view empty_file = "# a medial axis without vertices\n";

template <std::size_t n>
void write_cell(RowWriter& out, std::string_view keyword, const std::array<std::uint32_t, n>& vertices) {
  out.text(keyword);
  for (const std::uint32_t v : vertices) out.number(std::uint64_t{v} + 1);
  out.text("\n");
  out.end_row();
}

}  // namespace

void write_obj(const std::filesystem::path& path, const MedialComplex& complex, const Context& context) {
  const std::vector<std::uint32_t> isolated = isolated_vertices(complex);
  const EdgeSet sides(complex, EdgeSet::Of::triangles, context);
  RowWriter out(path, complex.vertices.size() + complex.triangles.size() + complex.edges.size() + isolated.size(),
                context);
  if (complex.vertices.empty()) out.text(empty_file);
  for (const MedialVertex& v : complex.vertices) {
    out.text("v");
    out.vector(v.position);
    out.text("\n");
    out.end_row();
  }
  for (const MedialTriangle& t : complex.triangles) write_cell(out, "f", t.vertices);
  for (const MedialEdge& e : complex.edges) {
    if (sides.contains(e.vertices)) {
      out.end_row();
    } else {
      write_cell(out, "l", e.vertices);
    }
  }
  for (const std::uint32_t v : isolated) write_cell(out, "p", std::array{v});
  out.finish();
}

MedialFile read_obj(std::string_view text, std::string_view name) {
  MedialFile file;
  if (text == empty_file) return file;
  const TriangleMesh mesh = blum::read_obj(text, name).mesh;
  MedialComplex& complex = file.complex;
  complex.vertices.reserve(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) complex.vertices.emplace_back().position = v;
  complex.edges.reserve(mesh.segments.size());
  for (const Segment& s : mesh.segments) complex.edges.push_back({.vertices = s});
  complex.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) complex.triangles.push_back({.vertices = t});
  keep_curves_only(complex);
  return file;
}

}  // namespace blum::medial_files
