#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/medial_files.hpp"
#include "io/mesh_builder.hpp"
#include "io/ply_header.hpp"
#include "io/ply_values.hpp"

namespace blum::medial_files {
namespace {

/// What a property of an element is for the medial axis.
enum class Column : std::uint8_t {
  x,
  y,
  z,
  radius,
  angle,
  footprint_0_x,
  footprint_0_y,
  footprint_0_z,
  footprint_1_x,
  footprint_1_y,
  footprint_1_z,
  site_0,
  site_1,
  role,
  sheet,
  corners,
  first,
  second,
  ignored,
};

struct NamedColumn {
  std::string_view name;
  Column column;
};
constexpr std::array<NamedColumn, 14> vertex_columns{{{"x", Column::x},
                                                      {"y", Column::y},
                                                      {"z", Column::z},
                                                      {"radius", Column::radius},
                                                      {"separation_angle", Column::angle},
                                                      {"footprint_0_x", Column::footprint_0_x},
                                                      {"footprint_0_y", Column::footprint_0_y},
                                                      {"footprint_0_z", Column::footprint_0_z},
                                                      {"footprint_1_x", Column::footprint_1_x},
                                                      {"footprint_1_y", Column::footprint_1_y},
                                                      {"footprint_1_z", Column::footprint_1_z},
                                                      {"site_0", Column::site_0},
                                                      {"site_1", Column::site_1},
                                                      {"role", Column::role}}};
constexpr std::array<NamedColumn, 4> face_columns{{{"vertex_indices", Column::corners},
                                                   {"vertex_index", Column::corners},
                                                   {"separation_angle", Column::angle},
                                                   {"sheet", Column::sheet}}};
constexpr std::array<NamedColumn, 4> edge_columns{{{"vertex1", Column::first},
                                                   {"vertex2", Column::second},
                                                   {"separation_angle", Column::angle},
                                                   {"role", Column::role}}};
constexpr std::array<NamedColumn, 2> edge_attribute_columns{
    {{"separation_angle", Column::angle}, {"role", Column::role}}};

/// The columns of one element: one for each property, in their order.
class Columns {
 public:
  void add(Column column) {
    if (column != Column::ignored) there_[static_cast<std::size_t>(column)] = true;
    columns_.push_back(column);
  }
  [[nodiscard]] bool has(Column column) const { return there_[static_cast<std::size_t>(column)]; }
  /// All from the first to the last.
  [[nodiscard]] bool has_all(Column first, Column last) const {
    return std::all_of(there_.begin() + static_cast<std::ptrdiff_t>(first),
                       there_.begin() + static_cast<std::ptrdiff_t>(last) + 1, [](bool there) { return there; });
  }
  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  [[nodiscard]] Column operator[](std::size_t i) const { return columns_[i]; }

 private:
  std::vector<Column> columns_;
  std::array<bool, static_cast<std::size_t>(Column::ignored) + 1> there_{};
};

/// The attributes of a face, which becomes one triangle or, as a polygon, several.
struct Face {
  std::size_t triangles = 0;
  float angle = 0;
  std::uint32_t sheet = 0;
};

/// Reads the elements of a file. Source is PlyText or PlyBinary.
template <class Source>
class MedialPlyReader {
 public:
  MedialPlyReader(const PlyHeader& header, Source source, std::string_view name)
      : header_(header), source_(source), name_(name) {}

  MedialFile read() {
    for (const PlyElement& element : header_.elements) read_element(element);
    source_.expect_end();
    if (!vertices_there_) source_.fail("the file has no element 'vertex'");
    if (const auto bad = builder_.bad_index()) {
      source_.fail_at(bad->where, "vertex " + std::to_string(bad->index) + " is named, but the file has only " +
                                      std::to_string(builder_.vertex_count()) + " (counted from 0)");
    }
    return finish();
  }

 private:
  void read_element(const PlyElement& element) {
    if (element.properties.empty()) return;  // takes no bytes, however many there are said to be
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

  template <std::size_t n>
  Columns columns_of(const PlyElement& element, const std::array<NamedColumn, n>& known) const {
    Columns columns;
    for (const PlyProperty& property : element.properties) {
      Column column = Column::ignored;
      for (const NamedColumn& candidate : known) {
        if (candidate.name == property.name) column = candidate.column;
      }
      if (column != Column::ignored) check_property(element, property, column, columns);
      columns.add(column);
    }
    return columns;
  }

  void check_property(const PlyElement& element, const PlyProperty& property, Column column,
                      const Columns& before) const {
    const std::string shown = "property " + in_quotes(property.name) + " of element " + in_quotes(element.name);
    const bool list = column == Column::corners;
    if (before.has(column)) source_.fail(shown + " is there twice");
    if (property.is_list != list) source_.fail(shown + (list ? " must be a list" : " must not be a list"));
    if (column >= Column::site_0 && is_floating(property.type)) {
      source_.fail(shown + " must be of a whole-number type");
    }
  }

  void need(const PlyElement& element, const Columns& columns, Column column, std::string_view name) const {
    if (columns.has(column)) return;
    source_.fail("element " + in_quotes(element.name) + " has no property " + in_quotes(name));
  }

  /// Calls use(column, property) for each property of the next entry that is known.
  template <class Use>
  void read_entry(const PlyElement& element, const Columns& columns, Use use) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k] == Column::ignored) {
        source_.skip(element.properties[k]);
      } else {
        use(columns[k], element.properties[k]);
      }
    }
  }

  void read_vertices(const PlyElement& element) {
    const Columns columns = columns_of(element, vertex_columns);
    need(element, columns, Column::x, "x");
    need(element, columns, Column::y, "y");
    need(element, columns, Column::z, "z");
    if (element.count > max_id_count) source_.fail("too many vertices: 2^31 - 1 are the most");
    vertices_there_ = true;
    file_.has_radii = columns.has(Column::radius);
    file_.has_footprints = columns.has_all(Column::footprint_0_x, Column::footprint_1_z);
    file_.has_sites = columns.has_all(Column::site_0, Column::site_1);
    has_angles_ = has_angles_ && columns.has(Column::angle);
    has_labels_ = has_labels_ && columns.has(Column::role);
    builder_.reserve_vertices(element.count);
    vertices_.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      MedialVertex vertex;
      read_entry(element, columns, [&](Column c, const PlyProperty& p) { set_attribute(vertex, c, p.type); });
      builder_.add_vertex(vertex.position);
      vertices_.push_back(vertex);
    }
  }

  void set_attribute(MedialVertex& vertex, Column column, PlyType type) {
    if (column == Column::role) {
      vertex.role = role_from_file(source_.integer(type, "role"), fail());
    } else if (column == Column::site_0 || column == Column::site_1) {
      vertex.sites[column == Column::site_0 ? 0 : 1] = site_from_file(source_.integer(type, "site"), fail());
    } else if (column <= Column::z) {
      vertex.position[static_cast<std::size_t>(column)] = source_.number(type, "coordinate");
    } else if (column == Column::radius) {
      vertex.radius = source_.number(type, "radius");
      if (vertex.radius < 0) source_.fail("a negative radius");
    } else if (column == Column::angle) {
      vertex.separation_angle = source_.number(type, "angle");
    } else {
      const std::size_t i = static_cast<std::size_t>(column) - static_cast<std::size_t>(Column::footprint_0_x);
      vertex.footprints[i / 3][i % 3] = source_.number(type, "footprint");
    }
  }

  void read_faces(const PlyElement& element) {
    const Columns columns = columns_of(element, face_columns);
    need(element, columns, Column::corners, "vertex_indices");
    has_angles_ = has_angles_ && columns.has(Column::angle);
    has_labels_ = has_labels_ && columns.has(Column::sheet);
    const std::size_t most = std::min(element.count, source_.remaining() / 4 + 1);  // a length and three corners
    faces_.reserve(most);
    builder_.reserve_triangles(most);
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::size_t where = source_.where();
      Face face;
      read_entry(element, columns, [&](Column column, const PlyProperty& property) {
        if (column == Column::corners) {
          face.triangles = read_corners(property, where);
        } else if (column == Column::angle) {
          face.angle = angle_from_file(source_.number(property.type, "angle"));
        } else {
          face.sheet = sheet_from_file(source_.integer(property.type, "sheet"), fail());
        }
      });
      faces_.push_back(face);
    }
  }

  std::size_t read_corners(const PlyProperty& property, std::size_t where) {
    const std::size_t count = source_.list_count(property);
    if (count < 3) {
      source_.fail_at(where, "a face of " + std::to_string(count) + " corners: it must have 3 or more");
    }
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) corners_.push_back(index(property.type));
    builder_.add_face(corners_, where);
    return count - 2;
  }

  void read_edges(const PlyElement& element) {
    const Columns columns = columns_of(element, edge_columns);
    need(element, columns, Column::first, "vertex1");
    need(element, columns, Column::second, "vertex2");
    // Blum wrote the attributes into this element, once.
    edges_have_roles_ = edges_have_roles_ || columns.has(Column::role);
    edges_have_angles_ = edges_have_angles_ || columns.has(Column::angle);
    edges_.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::size_t where = source_.where();
      MedialEdge edge{};
      read_entry(element, columns, [&](Column column, const PlyProperty& property) {
        if (column == Column::first || column == Column::second) {
          edge.vertices[column == Column::first ? 0 : 1] = index(property.type);
        } else {
          set_attribute(edge, column, property.type);
        }
      });
      builder_.add_segment(edge.vertices[0], edge.vertices[1], where);
      edges_.push_back(edge);
    }
  }

  /// One record for each edge, in their order.
  void read_edge_attributes(const PlyElement& element) {
    const Columns columns = columns_of(element, edge_attribute_columns);
    if (edges_.size() != element.count) {
      source_.fail("there are " + std::to_string(element.count) + " of element 'edge_attributes', but " +
                   std::to_string(edges_.size()) + " edges before them");
    }
    edges_have_roles_ = edges_have_roles_ || columns.has(Column::role);
    edges_have_angles_ = edges_have_angles_ || columns.has(Column::angle);
    for (MedialEdge& edge : edges_) {
      read_entry(element, columns,
                 [&](Column column, const PlyProperty& property) { set_attribute(edge, column, property.type); });
    }
  }

  void set_attribute(MedialEdge& edge, Column column, PlyType type) {
    if (column == Column::role) {
      edge.role = role_from_file(source_.integer(type, "role"), fail());
    } else {
      edge.separation_angle = angle_from_file(source_.number(type, "angle"));
    }
  }

  std::uint32_t index(PlyType type) {
    const std::int64_t value = source_.integer(type, "vertex index");
    if (value < 0 || value >= static_cast<std::int64_t>(max_id_count)) {
      source_.fail("vertex index " + std::to_string(value) + " is out of range");
    }
    return static_cast<std::uint32_t>(value);
  }
  auto fail() {
    return [this](const std::string& message) { source_.fail(message); };
  }

  MedialFile finish() {
    MedialComplex& complex = file_.complex;
    const TriangleMesh mesh = builder_.finish(MeshFormat::ply, true).mesh;
    complex.vertices = std::move(vertices_);
    complex.edges = std::move(edges_);
    complex.triangles.reserve(mesh.triangles.size());
    for (const Face& face : faces_) {
      for (std::size_t i = 0; i < face.triangles; ++i) {
        complex.triangles.push_back({mesh.triangles[complex.triangles.size()], face.angle, face.sheet});
      }
    }
    file_.has_angles = has_angles_ && (edges_have_angles_ || complex.edges.empty());
    file_.has_labels = has_labels_ && (edges_have_roles_ || complex.edges.empty());
    if (!edges_have_roles_) keep_curves_only(complex);
    file_.metadata = metadata();
    return std::move(file_);
  }

  MedialMetadata metadata() const {
    constexpr std::string_view mark = "blum {";
    volume_io::Metadata pairs;
    const std::string name(name_);
    for (const std::string_view comment : header_.comments) {
      if (!comment.starts_with(mark)) continue;
      for (auto& pair : volume_io::from_json(comment.substr(mark.size() - 1), name)) pairs.push_back(std::move(pair));
    }
    return from_pairs(pairs, name);
  }

  const PlyHeader& header_;
  Source source_;
  std::string_view name_;
  MedialFile file_;
  MeshBuilder builder_;  ///< looks after indices and polygons
  std::vector<MedialVertex> vertices_;
  std::vector<MedialEdge> edges_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> corners_;
  bool vertices_there_ = false;
  bool edges_have_roles_ = false;
  bool edges_have_angles_ = false;
  bool has_angles_ = true;  ///< of all vertices and faces so far
  bool has_labels_ = true;
};

}  // namespace

MedialFile read_ply(std::string_view bytes, std::string_view name) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.encoding == PlyEncoding::text) {
    return MedialPlyReader<PlyText>(header, PlyText(bytes, header, name), name).read();
  }
  return MedialPlyReader<PlyBinary>(header, PlyBinary(bytes, header, name), name).read();
}

}  // namespace blum::medial_files
