#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/ids.hpp"
#include "io/complex/complex_files.hpp"
#include "io/complex/complex_ply_names.hpp"
#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"
#include "io/text/json.hpp"
#include "io/text/ply.hpp"
#include "io/text/row_writer.hpp"

namespace blum::complex_files {
namespace {

/// Returns the metadata as comment lines. Each is a JSON object with one pair, so that lines stay short enough for
/// readers of PLY.
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

/// Returns the column that is written a second time for MeshLab. Null if there is no such column, or no room for the
/// copy.
const Column* derived_column(const Columns& columns) {
  if (columns.find(derived_property) != nullptr || columns.size() == max_file_columns) return nullptr;
  for (const std::string_view name : derived_from) {
    const Column* const column = columns.find(name);
    if (column != nullptr && column->components == 1 && column->type_name().starts_with("float")) return column;
  }
  return nullptr;
}

/// @throws InvalidOption if a row has more numbers than Blum's reader accepts.
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
  // Some readers, for example trimesh, treat everything in `edge` as corners. Some readers reject files with edges. So
  // edges are written only if they are needed.
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

/// Returns true if the file is an axis written by write_medial(), a Voronoi diagram or centrelines. Other complexes
/// cannot be distinguished from meshes, or are used as meshes.
bool holds_axis(std::string_view head, const std::filesystem::path&) {
  const std::string_view header = head.substr(0, head.find("end_header"));
  const auto states = [&](const char* content) {
    return header.find("comment blum {\"content\": \"" + std::string(content) + "\"}") != std::string_view::npos;
  };
  return states("medial axis") || states("Voronoi diagram") || states("walls of a Voronoi diagram") ||
         states("centreline");
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

namespace blum::complex_files {
namespace {

/// Use of a property by the reader: part of a column, a list to skip, or a property known by name.
struct Use {
  enum class What : std::uint8_t { column, nothing, known };
  What what = What::column;
  std::size_t index = 0;  ///< index of the column, or of the known name
};

/// Layout of an element: its known properties, and the columns that its other properties form.
struct Layout {
  std::vector<Use> uses;        ///< use of each property, in file order
  std::vector<Column> columns;  ///< filled while reading
};

Column::Values values_for(PlyType type) {
  if (type == PlyType::float64) return std::vector<double>{};
  if (type == PlyType::float32) return std::vector<float>{};
  if (type == PlyType::int64 || type == PlyType::uint64 || type == PlyType::uint32) return std::vector<std::int64_t>{};
  return std::vector<std::int32_t>{};
}

/// Converts to float. Values beyond float's range become infinite.
float to_float(double value) {
  constexpr double most = std::numeric_limits<float>::max();
  if (value > most) return std::numeric_limits<float>::infinity();
  return value < -most ? -std::numeric_limits<float>::infinity() : static_cast<float>(value);
}

/// Reader of the elements of a file. `Source` is PlyText or PlyBinary, which reads the values.
template <class Source>
class ComplexPlyReader {
 public:
  ComplexPlyReader(const PlyHeader& header, Source source, std::string_view name)
      : header_(header), source_(source), name_(name), file_size_(source.remaining()) {}

  ComplexFile read() {
    for (const PlyElement& element : header_.elements) read_element(element);
    source_.expect_end();
    if (!vertices_there_) source_.fail("the file has no element 'vertex'");
    if (const auto bad = builder_.bad_index()) {
      source_.fail_at(bad->where, "vertex " + std::to_string(bad->index) + " is used, but the file has only " +
                                      std::to_string(builder_.vertex_count()) + " vertices (counted from 0)");
    }
    return finish();
  }

 private:
  void read_element(const PlyElement& element) {
    if (element.properties.empty()) return;  // entries take no bytes, whatever their number
    const std::size_t least = std::max<std::size_t>(source_.least_size(element), 1);
    if (element.count > (source_.remaining() + 1) / least) {
      source_.fail("the header promises " + std::to_string(element.count) + " of element " + in_quotes(element.name) +
                   ", but the file is too short for them");
    }
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    if (element.name == "edge") return read_edges(element);
    if (element.name == "edge_attributes") return read_edge_attributes(element);
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) source_.skip(property);
    }
  }

  /// @param known  names of properties that are not columns. `vertex_index` and `vertex_indices` have the same meaning;
  /// only one may occur.
  template <std::size_t n>
  Layout layout_of(const PlyElement& element, const std::array<std::string_view, n>& known) {
    if (element.properties.size() > max_ply_properties) source_.fail("the header has too many properties");
    Layout layout;
    std::set<std::string_view> names;
    std::vector<PlyProperty> rest;
    for (const PlyProperty& property : element.properties) {
      const std::string shown = "property " + in_quotes(property.name) + " of element " + in_quotes(element.name);
      if (!names.insert(property.name).second) source_.fail(shown + " occurs twice");
      const auto found = std::find(known.begin(), known.end(), property.name);
      if (found != known.end()) {
        layout.uses.push_back({Use::What::known, static_cast<std::size_t>(found - known.begin())});
        check_known(property, shown);
      } else if (property.is_list) {
        layout.uses.push_back({Use::What::nothing, 0});
      } else {
        layout.uses.push_back({Use::What::column, 0});
        rest.push_back(property);
      }
    }
    add_columns(layout, element, rest);
    return layout;
  }

  void check_known(const PlyProperty& property, const std::string& shown) const {
    const bool list = property.name.starts_with("vertex_");
    if (property.is_list != list) source_.fail(shown + (list ? " must be a list" : " must not be a list"));
    if (property.name.starts_with("vertex") && is_floating(property.type)) {
      source_.fail(shown + " must be of a whole-number type");
    }
  }

  void add_columns(Layout& layout, const PlyElement& element, const std::vector<PlyProperty>& properties) {
    std::vector<std::size_t> column_of;
    for (const PlyColumn& column : find_columns(properties, element.name, header_.comments)) {
      column_of.insert(column_of.end(), column.components, layout.columns.size());
      layout.columns.push_back({column.name, column.components, values_for(properties[column.first].type)});
      std::visit([&](auto& values) { values.reserve(element.count * column.components); },
                 layout.columns.back().values);
    }
    std::size_t next = 0;
    for (Use& use : layout.uses) {
      if (use.what == Use::What::column) use.index = column_of[next++];
    }
  }

  void need(const PlyElement& element, std::string_view name) const {
    for (const PlyProperty& property : element.properties) {
      if (property.name == name) return;
    }
    source_.fail("element " + in_quotes(element.name) + " has no property " + in_quotes(name));
  }

  /// Reads the next entry of an element. For each known property, calls known(index, property), which reads the value.
  template <class Known>
  void read_entry(const PlyElement& element, Layout& layout, Known known) {
    for (std::size_t k = 0; k < layout.uses.size(); ++k) {
      const Use use = layout.uses[k];
      const PlyProperty& property = element.properties[k];
      if (use.what == Use::What::known) {
        known(use.index, property);
      } else if (use.what == Use::What::nothing) {
        source_.skip(property);
      } else {
        read_number(layout.columns[use.index].values, property);
      }
    }
  }

  void read_number(Column::Values& values, const PlyProperty& property) {
    std::visit(
        [&]<class T>(std::vector<T>& v) {
          if constexpr (std::is_same_v<T, double>) {
            v.push_back(source_.any_number(property.type, property.name));
          } else if constexpr (std::is_same_v<T, float>) {
            v.push_back(to_float(source_.any_number(property.type, property.name)));
          } else {
            const std::int64_t value = source_.integer(property.type, property.name);
            if (!std::in_range<T>(value)) source_.fail(property.name + " is too large: " + std::to_string(value));
            v.push_back(static_cast<T>(value));
          }
        },
        values);
  }

  void add_to(Columns& columns, Layout& layout) {
    for (Column& column : layout.columns) add_column(columns, std::move(column), std::string(name_));
  }

  void read_vertices(const PlyElement& element) {
    for (const char* name : {"x", "y", "z"}) need(element, name);
    if (element.count > max_id_count) source_.fail("too many vertices: 2^31 - 1 are the most");
    Layout layout = layout_of(element, std::array<std::string_view, 3>{"x", "y", "z"});
    vertices_there_ = true;
    builder_.reserve_vertices(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3d position;
      read_entry(element, layout, [&](std::size_t axis, const PlyProperty& property) {
        position[axis] = source_.number(property.type, "coordinate");
      });
      builder_.add_vertex(position);
    }
    Columns columns(element.count);
    add_to(columns, layout);
    drop_derived(columns);
    file_.complex.vertex_columns = std::move(columns);
  }

  /// Removes the copy of a column that is written for MeshLab.
  void drop_derived(Columns& columns) const {
    const Column* const copy = columns.find(derived_property);
    if (copy == nullptr || copy->type_name() != "float32") return;
    if (is_listed(derived_property, "vertex", header_.comments)) return;
    const auto& copies = std::get<std::vector<float>>(copy->values);
    const bool is_copy = std::any_of(derived_from.begin(), derived_from.end(), [&](std::string_view name) {
      const Column* const source = columns.find(name);
      return source != nullptr && source->components == 1 && are_copies(*source, copies);
    });
    if (is_copy) columns.erase(derived_property);
  }

  static bool are_copies(const Column& source, const std::vector<float>& copies) {
    return std::visit(
        [&](const auto& values) {
          return std::equal(values.begin(), values.end(), copies.begin(), copies.end(), [](auto from, float to) {
            return to_float(static_cast<double>(from)) == to ||
                   (std::isnan(static_cast<double>(from)) && std::isnan(to));
          });
        },
        source.values);
  }

  void read_faces(const PlyElement& element) {
    Layout layout = layout_of(element, std::array<std::string_view, 2>{"vertex_indices", "vertex_index"});
    const auto is_corners = [](const Use& use) { return use.what == Use::What::known; };
    const auto corners = std::count_if(layout.uses.begin(), layout.uses.end(), is_corners);
    if (corners == 0) need(element, "vertex_indices");
    if (corners > 1) source_.fail("element 'face' has the properties 'vertex_indices' and 'vertex_index'");
    const std::size_t most = std::min(element.count, source_.remaining() / 4 + 1);  // a list takes at least four bytes:
                                                                                    // a length and three corners
    triangle_counts_.reserve(most);
    builder_.reserve_triangles(most);
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::size_t where = source_.where();
      read_entry(element, layout, [&](std::size_t /*known*/, const PlyProperty& property) {
        triangle_counts_.push_back(read_corners(property, where));
      });
    }
    face_columns_ = Columns(element.count);
    add_to(face_columns_, layout);
  }

  std::uint32_t read_corners(const PlyProperty& property, std::size_t where) {
    const std::size_t count = source_.list_count(property);
    if (count < 3) {
      source_.fail_at(where, "a face of " + std::to_string(count) + " corners: it must have 3 or more");
    }
    if (count > max_id_count) source_.fail_at(where, "a face of too many corners");
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) corners_.push_back(index(property.type));
    builder_.add_face(corners_, where);
    return static_cast<std::uint32_t>(count - 2);
  }

  void read_edges(const PlyElement& element) {
    for (const char* name : {"vertex1", "vertex2"}) need(element, name);
    Layout layout = layout_of(element, std::array<std::string_view, 2>{"vertex1", "vertex2"});
    auto& edges = file_.complex.edges;
    edges.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::size_t where = source_.where();
      std::array<std::uint32_t, 2> edge{};
      read_entry(element, layout,
                 [&](std::size_t end, const PlyProperty& property) { edge[end] = index(property.type); });
      builder_.add_segment(edge[0], edge[1], where);
      edges.push_back(edge);
    }
    file_.complex.edge_columns = Columns(edges.size());
    add_to(file_.complex.edge_columns, layout);
  }

  /// Reads the columns of the edges: one entry per edge, in the order of the edges.
  void read_edge_attributes(const PlyElement& element) {
    const std::size_t edges = file_.complex.edges.size();
    if (edges != element.count) {
      source_.fail("there are " + std::to_string(element.count) + " of element 'edge_attributes', but " +
                   std::to_string(edges) + " edges before them");
    }
    Layout layout = layout_of(element, std::array<std::string_view, 0>{});
    for (std::size_t i = 0; i < element.count; ++i) {
      read_entry(element, layout, [](std::size_t /*known*/, const PlyProperty& /*property*/) {});
    }
    add_to(file_.complex.edge_columns, layout);
  }

  std::uint32_t index(PlyType type) {
    const std::int64_t value = source_.integer(type, "vertex index");
    if (value < 0 || value >= static_cast<std::int64_t>(max_id_count)) {
      source_.fail("vertex index " + std::to_string(value) + " is out of range");
    }
    return static_cast<std::uint32_t>(value);
  }

  ComplexFile finish() {
    Complex& complex = file_.complex;
    TriangleMesh mesh = builder_.finish(true).mesh;
    complex.positions = std::move(mesh.vertices);
    complex.triangles = std::move(mesh.triangles);
    if (complex.triangles.size() != triangle_counts_.size()) {
      face_columns_ = repeated(face_columns_, triangle_counts_, file_size_, std::string(name_));
    }
    complex.triangle_columns = std::move(face_columns_);
    file_.metadata = metadata();
    return std::move(file_);
  }

  FileMetadata metadata() const {
    constexpr std::string_view mark = "blum {";
    FileMetadata pairs;
    const std::string name(name_);
    for (const std::string_view comment : header_.comments) {
      if (!comment.starts_with(mark)) continue;
      for (auto& pair : volume_io::from_json(comment.substr(mark.size() - 1), name)) pairs.push_back(std::move(pair));
    }
    return pairs;
  }

  const PlyHeader& header_;
  Source source_;
  std::string_view name_;
  std::uint64_t file_size_;
  ComplexFile file_;
  MeshBuilder builder_;  ///< checks indices and cuts polygons into triangles
  Columns face_columns_;
  std::vector<std::uint32_t> triangle_counts_;  ///< for each face: the number of triangles that it becomes
  std::vector<std::uint32_t> corners_;
  bool vertices_there_ = false;
};

}  // namespace

ComplexFile read_ply(std::string_view bytes, std::string_view name) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.encoding == PlyEncoding::text) {
    return ComplexPlyReader<PlyText>(header, PlyText(bytes, header, name), name).read();
  }
  return ComplexPlyReader<PlyBinary>(header, PlyBinary(bytes, header, name), name).read();
}

}  // namespace blum::complex_files
