#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/field_sink.hpp"
#include "io/medial_edges.hpp"
#include "io/medial_files.hpp"
#include "io/vtk_xml.hpp"

namespace blum::medial_files {
namespace {

using volume_io::FieldSink;
using volume_io::ScalarType;

template <class T>
constexpr ScalarType scalar_type_of = [] {
  if constexpr (std::is_same_v<T, double>) return ScalarType::f64;
  if constexpr (std::is_same_v<T, float>) return ScalarType::f32;
  if constexpr (std::is_same_v<T, std::int64_t>) return ScalarType::i64;
  if constexpr (std::is_same_v<T, std::int32_t>) return ScalarType::i32;
  return ScalarType::u8;
}();

/// Gathers the text that tells of the arrays, and how long they are.
class ArrayHeaders {
 public:
  void text(const std::string& text) { text_ += text; }
  template <class T, class Get>
  void add(const char* name, std::size_t count, std::size_t components, Get /*get*/) {
    text_ += volume_io::vtk_appended_array(scalar_type_of<T>, name, components, offset_);
    offset_ += sizeof(std::uint64_t) + sizeof(T) * count * components;
  }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::uint64_t data_size() const { return offset_; }

 private:
  std::string text_;
  std::uint64_t offset_ = 0;
};

/// Writes the arrays, each behind its length.
class ArrayData {
 public:
  ArrayData(AtomicFile& file, FieldSink& sink) : file_(file), sink_(sink) {}
  void text(const std::string& /*text*/) {}
  template <class T, class Get>
  void add(const char* /*name*/, std::size_t count, std::size_t components, Get get) {
    const std::uint64_t size = sizeof(T) * count * components;
    sink_.write(file_, std::as_bytes(std::span(&size, 1)));
    std::vector<T> piece;
    for (std::size_t begin = 0; begin < count; begin += piece_size) {
      piece.clear();
      for (std::size_t i = begin; i < std::min(count, begin + piece_size); ++i) {
        for (std::size_t c = 0; c < components; ++c) piece.push_back(get(i, c));
      }
      sink_.write(file_, std::as_bytes(std::span(piece)));
    }
  }

 private:
  static constexpr std::size_t piece_size = 65536;
  AtomicFile& file_;
  FieldSink& sink_;
};

constexpr std::uint8_t no_role = 255;  ///< of triangles: all around them is surface

/// The arrays of a file; Out is ArrayHeaders or ArrayData.
template <class Out>
class VtpArrays {
 public:
  VtpArrays(const MedialComplex& complex, const std::vector<std::uint32_t>& verts, Out& out)
      : complex_(complex), verts_(verts), out_(out) {}

  void write() {
    write_point_data();
    write_cell_data();
    out_.text("      <Points>\n");
    add_points<double>("Points", 3, [](const MedialVertex& v, std::size_t c) { return v.position[c]; });
    out_.text("      </Points>\n");
    write_cells("Verts", 1, verts_.size(), [&](std::size_t i, std::size_t /*corner*/) { return verts_[i]; });
    write_cells("Lines", 2, complex_.edges.size(),
                [&](std::size_t i, std::size_t corner) { return complex_.edges[i].vertices[corner]; });
    write_cells("Polys", 3, complex_.triangles.size(),
                [&](std::size_t i, std::size_t corner) { return complex_.triangles[i].vertices[corner]; });
  }

 private:
  template <class T, class Get>
  void add_points(const char* name, std::size_t components, Get get) {
    out_.template add<T>(name, complex_.vertices.size(), components,
                         [&](std::size_t i, std::size_t c) -> T { return get(complex_.vertices[i], c); });
  }

  void write_point_data() {
    using V = MedialVertex;
    out_.text("      <PointData Scalars=\"radius\">\n");
    add_points<double>("radius", 1, [](const V& v, std::size_t) { return v.radius; });
    add_points<double>("separation_angle", 1, [](const V& v, std::size_t) { return v.separation_angle; });
    add_points<std::uint8_t>("role", 1, [](const V& v, std::size_t) { return static_cast<std::uint8_t>(v.role); });
    add_points<double>("footprint_0", 3, [](const V& v, std::size_t c) { return v.footprints[0][c]; });
    add_points<double>("footprint_1", 3, [](const V& v, std::size_t c) { return v.footprints[1][c]; });
    add_points<std::int32_t>("site_0", 1, [](const V& v, std::size_t) { return v.sites[0].to_file(); });
    add_points<std::int32_t>("site_1", 1, [](const V& v, std::size_t) { return v.sites[1].to_file(); });
    out_.text("      </PointData>\n");
  }

  /// One value for each cell, in VTK's order.
  template <class T, class OfVertex, class OfEdge, class OfTriangle>
  void add_cells(const char* name, OfVertex of_vertex, OfEdge of_edge, OfTriangle of_triangle) {
    const std::size_t lines = verts_.size();
    const std::size_t polys = lines + complex_.edges.size();
    out_.template add<T>(name, polys + complex_.triangles.size(), 1, [&](std::size_t i, std::size_t /*c*/) -> T {
      if (i < lines) return of_vertex(complex_.vertices[verts_[i]]);
      return i < polys ? of_edge(complex_.edges[i - lines]) : of_triangle(complex_.triangles[i - polys]);
    });
  }

  void write_cell_data() {
    out_.text("      <CellData>\n");
    add_cells<float>(
        "separation_angle", [](const MedialVertex& v) { return static_cast<float>(v.separation_angle); },
        [](const MedialEdge& e) { return e.separation_angle; },
        [](const MedialTriangle& t) { return t.separation_angle; });
    add_cells<std::uint8_t>(
        "role", [](const MedialVertex& v) { return static_cast<std::uint8_t>(v.role); },
        [](const MedialEdge& e) { return static_cast<std::uint8_t>(e.role); },
        [](const MedialTriangle&) { return no_role; });
    add_cells<std::int32_t>(
        "sheet", [](const MedialVertex&) { return -1; }, [](const MedialEdge&) { return -1; },
        [](const MedialTriangle& t) { return static_cast<std::int32_t>(t.sheet); });
    out_.text("      </CellData>\n");
  }

  template <class Corner>
  void write_cells(const std::string& section, std::size_t corners, std::size_t count, Corner corner) {
    out_.text("      <" + section + ">\n");
    out_.template add<std::int64_t>("connectivity", count * corners, 1, [&](std::size_t i, std::size_t /*c*/) {
      return std::int64_t{corner(i / corners, i % corners)};
    });
    out_.template add<std::int64_t>("offsets", count, 1, [&](std::size_t i, std::size_t /*c*/) {
      return static_cast<std::int64_t>((i + 1) * corners);
    });
    out_.text("      </" + section + ">\n");
  }

  const MedialComplex& complex_;
  const std::vector<std::uint32_t>& verts_;
  Out& out_;
};

std::string opening_text(const MedialComplex& complex, std::size_t verts, const MedialMetadata& metadata) {
  return volume_io::vtk_opening("PolyData") + "  <PolyData>\n    <FieldData>\n" +
         volume_io::vtk_string_array("metadata", volume_io::to_json(to_pairs(metadata))) +
         "    </FieldData>\n    <Piece NumberOfPoints=\"" + std::to_string(complex.vertices.size()) +
         "\" NumberOfVerts=\"" + std::to_string(verts) + "\" NumberOfLines=\"" + std::to_string(complex.edges.size()) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(complex.triangles.size()) + "\">\n";
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata,
               const Context& context) {
  const std::vector<std::uint32_t> verts = isolated_vertices(complex);
  ArrayHeaders headers;
  VtpArrays(complex, verts, headers).write();
  AtomicFile file(path);
  FieldSink sink(headers.data_size(), context);
  sink.write(file, opening_text(complex, verts.size(), metadata) + headers.text() +
                       "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
  ArrayData data(file, sink);
  VtpArrays(complex, verts, data).write();
  sink.write(file, "\n  </AppendedData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace blum::medial_files
