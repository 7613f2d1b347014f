#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"
#include "blum/io/collision_io.hpp"
#include "blum/io/formats.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/format_table.hpp"
#include "io/table/table_files.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

using Four = std::array<std::uint32_t, 4>;
using Two = std::array<std::uint32_t, 2>;

/// Collisions of one kind (vertex and face, or two edges), column by column.
struct Kind {
  std::string name;
  std::vector<Four> vertices = {};
  std::vector<double> times = {};
  std::vector<Two> objects = {};  ///< for scenes only: the objects of the two features
};

/// Content of a file.
struct Contents {
  bool is_scene = false;
  Kind vertex_face{"vertex_face"};
  Kind edge_edge{"edge_edge"};
  std::vector<std::uint32_t> faces = {};  ///< faces of the collisions in vertex_face

  /// @param mesh  mesh that has the face.
  void add(const VertexFaceCollision& one, const MeshView& mesh) {
    const auto& [a, b, c] = mesh.triangles[one.face.value];
    vertex_face.vertices.push_back({one.vertex, a, b, c});
    vertex_face.times.push_back(one.time);
    faces.push_back(one.face.value);
  }
  void add(const EdgeEdgeCollision& one) {
    edge_edge.vertices.push_back({one.first[0], one.first[1], one.second[0], one.second[1]});
    edge_edge.times.push_back(one.time);
  }

  [[nodiscard]] std::array<const Kind*, 2> kinds() const { return {&vertex_face, &edge_edge}; }
};

/// @param object  for scenes: the object that has the mesh. @throws InvalidOption if the mesh has no such face.
void check_face(const MeshView& mesh, TriangleId face, std::optional<ObjectId> object = {}) {
  if (face.value < mesh.triangles.size()) return;
  throw InvalidOption("a collision uses face " + std::to_string(face.value) +
                      (object ? " of object " + std::to_string(object->value) : "") + ", but that mesh has only " +
                      std::to_string(mesh.triangles.size()) +
                      " triangles; give the meshes in which the collisions were found");
}

Contents contents_of(const ContinuousCollisions& collisions, const MeshView& mesh) {
  Contents out;
  for (const VertexFaceCollision& one : collisions.vertex_face) {
    check_face(mesh, one.face);
    out.add(one, mesh);
  }
  for (const EdgeEdgeCollision& one : collisions.edge_edge) out.add(one);
  return out;
}

/// Objects of a scene, with checked indices.
class Objects {
 public:
  explicit Objects(std::span<const MeshMotion> meshes) : meshes_(meshes) {}

  [[nodiscard]] const MeshView& mesh(ObjectId object) const {
    if (object.value < meshes_.size()) return meshes_[object.value].start;
    throw InvalidOption("a collision uses object " + std::to_string(object.value) + ", but meshes of " +
                        std::to_string(meshes_.size()) + " objects are given; give one mesh for each object");
  }

 private:
  std::span<const MeshMotion> meshes_;
};

Contents contents_of(const SceneCollisions& collisions, std::span<const MeshMotion> meshes) {
  const Objects objects(meshes);
  Contents out;
  out.is_scene = true;
  const auto add_faces = [&](ObjectId vertices, ObjectId faces, const std::vector<VertexFaceCollision>& all) {
    if (all.empty()) return;
    const MeshView& mesh = objects.mesh(faces);
    for (const VertexFaceCollision& one : all) {
      check_face(mesh, one.face, faces);
      out.add(one, mesh);
      out.vertex_face.objects.push_back({vertices.value, faces.value});
    }
  };
  for (const ObjectCollisions& pair : collisions.objects) {
    static_cast<void>(objects.mesh(std::max(pair.first, pair.second)));
    add_faces(pair.first, pair.second, pair.vertex_face);
    add_faces(pair.second, pair.first, pair.face_vertex);
    for (const EdgeEdgeCollision& one : pair.edge_edge) {
      out.add(one);
      out.edge_edge.objects.push_back({pair.first.value, pair.second.value});
    }
  }
  return out;
}

/// Keys of metadata whose values are written as numbers, true or false in .json.
constexpr std::array<std::string_view, 3> typed_keys{"self", "tolerance", "min_separation"};

using tables::column_of;
using tables::made_column;
using tables::Table;
using tables::TableColumn;

template <std::size_t count>
TableColumn index_column(const std::string& name, const std::vector<std::array<std::uint32_t, count>>& rows) {
  const std::span numbers(reinterpret_cast<const std::uint32_t*>(rows.data()), count * rows.size());
  return column_of(name, {count}, numbers);
}

TableColumn time_column(const Kind& kind) {
  return column_of(kind.name + "_time", {}, std::span<const double>(kind.times));
}

/// Order of columns: which one follows the vertices of a kind.
enum class Order : std::uint8_t { times_first, objects_first };

/// Returns a table for each kind, and a table of the faces.
std::vector<Table> lists_of(const Contents& contents, Order order) {
  std::vector<Table> out;
  for (const Kind* one : contents.kinds()) {
    const Kind& kind = *one;
    std::vector<TableColumn> columns{index_column(kind.name, kind.vertices), time_column(kind)};
    if (contents.is_scene) {
      columns.insert(columns.end() - (order == Order::objects_first ? 1 : 0),
                     index_column(kind.name + "_object", kind.objects));
    }
    out.push_back({kind.times.size(), std::move(columns)});
  }
  out.push_back({contents.faces.size(), {column_of("face", {}, std::span<const std::uint32_t>(contents.faces))}});
  return out;
}

std::size_t rows_of(const Contents& contents) {
  return contents.vertex_face.times.size() + contents.edge_edge.times.size();
}

/// Returns a table with one row per collision: first those of vertices with faces, then those of two edges.
Table rows_of_text(const Contents& contents) {
  using Indices = std::span<std::uint32_t>;
  const std::size_t faces = contents.faces.size();
  const auto at = [&contents, faces](std::size_t row) {
    return row < faces ? std::pair(&contents.vertex_face, row) : std::pair(&contents.edge_edge, row - faces);
  };
  const auto kind = [at](std::size_t row, std::span<std::string> out) { out[0] = at(row).first->name; };
  const auto objects = [at](std::size_t row, Indices out) {
    const auto [of, n] = at(row);
    std::ranges::copy(of->objects[n], out.begin());
  };
  const auto vertices = [at](std::size_t row, Indices out) {
    const auto [of, n] = at(row);
    std::ranges::copy(of->vertices[n], out.begin());
  };
  const auto time = [at](std::size_t row, std::span<double> out) {
    const auto [of, n] = at(row);
    out[0] = of->times[n];
  };
  const auto face = [&contents, faces](std::size_t row, std::span<std::string> out) {
    out[0] = row < faces ? std::to_string(contents.faces[row]) : "";
  };
  Table table{rows_of(contents), {made_column<std::string>("kind", {}, kind)}};
  if (contents.is_scene) {
    table.columns.push_back(made_column<std::uint32_t>("objects", {2}, objects, {"first_object", "second_object"}));
  }
  table.columns.push_back(made_column<std::uint32_t>("vertices", {4}, vertices, {"a", "b", "c", "d"}));
  table.columns.push_back(made_column<double>("time", {}, time));
  table.columns.push_back(made_column<std::string>("face", {}, face));
  return table;
}

/// Returns the position of a vertex at a time from 0 to 1.
Vec3d position_at(const MeshMotion& mesh, std::uint32_t vertex, double time) {
  const std::span<const Vec3d> start = mesh.start.vertices;
  if (vertex >= start.size()) {
    throw InvalidOption("a collision uses vertex " + std::to_string(vertex) + " of a mesh that has only " +
                        std::to_string(start.size()) + " vertices; give the mesh in which the collisions were found");
  }
  if (mesh.end.empty()) return start[vertex];
  if (mesh.end.size() != start.size()) {
    throw InvalidOption("a mesh has " + std::to_string(start.size()) + " vertices at the start, but " +
                        std::to_string(mesh.end.size()) +
                        " at the end; give the same number, or none for a mesh at rest");
  }
  return start[vertex] * (1 - time) + mesh.end[vertex] * time;
}

/// Collects the features of colliding pairs, at their positions when they touch, as vertices, lines and triangles.
class Features {
 public:
  Features(const Contents& contents, std::span<const MeshMotion> objects)
      : contents_(contents), objects_(objects), faces_(contents.faces.size()) {
    const std::size_t rows = rows_of(contents);
    complex_.positions.reserve(4 * rows);
    complex_.vertex_columns = Columns(4 * rows);
    complex_.edge_columns = Columns(2 * (rows - faces_));
    complex_.triangle_columns = Columns(faces_);
    of_vertices_.add_to(complex_.vertex_columns);
    of_edges_.add_to(complex_.edge_columns);
    of_triangles_.add_to(complex_.triangle_columns);
    vertex_ = complex_.vertex_columns.add<std::int32_t>("vertex");
    if (contents.is_scene) object_ = complex_.vertex_columns.add<std::int32_t>("object");
    face_ = complex_.triangle_columns.add<std::int32_t>("face");
  }

  /// Returns the collected features. @throws InvalidOption if a vertex does not exist; Cancelled.
  Complex found(const Context& context) && {
    for (const Kind* kind : contents_.kinds()) {
      for (std::size_t n = 0; n < kind->times.size(); ++n) {
        if (n % 65536 == 0) throw_if_cancelled(context);
        add_vertices(*kind, n);
        if (is_of_faces(*kind)) {
          add_face(n);
        } else {
          add_edges(n, kind->times[n]);
        }
      }
    }
    return std::move(complex_);
  }

 private:
  /// Columns with the pair and time of each row.
  struct OfPair {
    std::span<std::int32_t> pair;
    std::span<double> time;

    void add_to(Columns& columns) {
      pair = columns.add<std::int32_t>("pair");
      time = columns.add<double>("time");
    }
    void set(std::size_t row, std::size_t number, double at) const {
      pair[row] = static_cast<std::int32_t>(number);
      time[row] = at;
    }
  };

  [[nodiscard]] bool is_of_faces(const Kind& kind) const { return &kind == &contents_.vertex_face; }

  void add_vertices(const Kind& kind, std::size_t n) {
    const std::size_t count_of_first = is_of_faces(kind) ? 1 : 2;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t object = contents_.is_scene ? kind.objects[n][k < count_of_first ? 0 : 1] : 0;
      const std::size_t row = complex_.positions.size();
      complex_.positions.push_back(position_at(objects_[object], kind.vertices[n][k], kind.times[n]));
      of_vertices_.set(row, row / 4, kind.times[n]);
      vertex_[row] = static_cast<std::int32_t>(kind.vertices[n][k]);
      if (!object_.empty()) object_[row] = static_cast<std::int32_t>(object);
    }
  }
  void add_face(std::size_t n) {
    const auto end = static_cast<std::uint32_t>(complex_.positions.size());
    complex_.triangles.push_back({end - 3, end - 2, end - 1});
    of_triangles_.set(n, n, contents_.vertex_face.times[n]);
    face_[n] = static_cast<std::int32_t>(contents_.faces[n]);
  }
  void add_edges(std::size_t n, double time) {
    const auto end = static_cast<std::uint32_t>(complex_.positions.size());
    for (const std::uint32_t start : {end - 4, end - 2}) {
      of_edges_.set(complex_.edges.size(), faces_ + n, time);
      complex_.edges.push_back({start, start + 1});
    }
  }

  const Contents& contents_;
  std::span<const MeshMotion> objects_;
  std::size_t faces_;
  Complex complex_;
  OfPair of_vertices_, of_edges_, of_triangles_;
  std::span<std::int32_t> vertex_, object_, face_;
};

void write(const std::filesystem::path& path, CollisionFormat format, const Contents& contents,
           std::span<const MeshMotion> objects, const FileMetadata& metadata, const Context& context) {
  const auto shapes = [&] {
    throw_if_cancelled(context);
    return Features(contents, objects).found(context);
  };
  const tables::RowFile file{[&] { return lists_of(contents, Order::times_first); },
                             [&] { return lists_of(contents, Order::objects_first); },
                             [&] { return rows_of_text(contents); },
                             shapes,
                             metadata,
                             typed_keys,
                             true};
  formats::code_of(format).write(path, file, context);
}

}  // namespace

void write_collisions(const std::filesystem::path& path, const ContinuousCollisions& collisions, const MeshMotion& mesh,
                      const FileMetadata& metadata, const Context& context) {
  const auto format = CollisionFormat::of(path, FileAccess::write);
  write(path, format, contents_of(collisions, mesh.start), std::span(&mesh, 1), metadata, context);
}

void write_collisions(const std::filesystem::path& path, const SceneCollisions& collisions,
                      std::span<const MeshMotion> objects, const FileMetadata& metadata, const Context& context) {
  const auto format = CollisionFormat::of(path, FileAccess::write);
  write(path, format, contents_of(collisions, objects), objects, metadata, context);
}

namespace {

constexpr std::size_t rows_per_query = 8;

class QueryReader {
 public:
  QueryReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
  }

  ImpactQueries read() {
    ImpactQueries out;
    FourMovingPoints points;
    std::optional<bool> truth;
    std::size_t row = 0;
    while (next_line()) {
      const Row own = read_row();
      (row < 4 ? points.start[row] : points.end[row - 4]) = own.point;
      if (row > 0 && own.truth != truth)
        fail("the answer differs from the answer in the row before, but both rows belong to the same query");
      truth = own.truth;
      if (++row < rows_per_query) continue;
      row = 0;
      out.points.push_back(points);
      out.truth.push_back(truth);
    }
    if (row != 0) fail("the file ends within a query: each query has eight rows");
    return out;
  }

 private:
  struct Row {
    Vec3d point;
    std::optional<bool> truth;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(name_ + ", line " + std::to_string(line_) + ": " + what);
  }

  /// Moves to the next non-empty line. Returns false at the end of the text.
  bool next_line() {
    while (!text_.empty()) {
      const std::size_t end = text_.find('\n');
      row_ = volume_io::trim(text_.substr(0, end));
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++line_;
      if (!row_.empty()) return true;
    }
    return false;
  }

  Row read_row() {
    constexpr std::size_t most_columns = 7;
    std::array<std::string_view, most_columns> columns;
    std::size_t count = 0;
    for (std::string_view rest = row_;; ++count) {
      if (count == most_columns) fail("more than seven columns");
      const std::size_t comma = rest.find(',');
      columns[count] = volume_io::trim(rest.substr(0, comma));
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    ++count;
    if (count < 6)
      fail("a row has six or seven columns, separated by commas, but this one has " + std::to_string(count));
    Row row;
    for (std::size_t axis = 0; axis < 3; ++axis) row.point[axis] = quotient(columns[2 * axis], columns[2 * axis + 1]);
    if (count == most_columns) {
      if (columns[6] != "0" && columns[6] != "1")
        fail("the answer is " + in_quotes(columns[6]) + ", but must be 0 or 1");
      row.truth = columns[6] == "1";
    }
    return row;
  }

  [[nodiscard]] double quotient(std::string_view numerator, std::string_view denominator) const {
    const double above = integer(numerator);
    const double below = integer(denominator);
    int exponent = 0;
    if (!(below > 0) || std::frexp(below, &exponent) != 0.5) {
      fail("the denominator " + in_quotes(denominator) + " is not a power of two, so the coordinate is not a double");
    }
    const double value = std::ldexp(above, 1 - exponent);
    if (std::ldexp(value, exponent - 1) != above) fail("a coordinate is too small for a double");
    return value;
  }

  /// Reads an integer. It must be one that a double represents exactly.
  [[nodiscard]] double integer(std::string_view text) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::size_t sign = text.starts_with('-') ? 1 : 0;
    const bool is_whole = text.size() > sign && text.find_first_not_of("0123456789", sign) == std::string_view::npos;
    if (!is_whole || end != text.data() + text.size()) fail(in_quotes(text) + " is not a whole number");
    constexpr std::size_t always_exact = 15;  // integers with this many digits are exact
    if (error == std::errc{} && text.size() - sign <= always_exact) return value;
    std::string_view rest = text.substr(sign);
    rest.remove_prefix(std::min(rest.find_first_not_of('0'), rest.size() - 1));
    const std::string shortest = (value < 0 ? "-" : "") + std::string(rest);
    std::array<char, 400> digits{};
    std::snprintf(digits.data(), digits.size(), "%.0f", value);
    if (error != std::errc{} || shortest != digits.data()) fail(in_quotes(text) + " is not exactly a double");
    return value;
  }

  std::string_view text_;
  std::string name_;
  std::string_view row_;
  std::size_t line_ = 0;
};

}  // namespace

ImpactQueries read_impact_queries(std::span<const std::byte> data, std::string_view name) {
  return QueryReader({reinterpret_cast<const char*>(data.data()), data.size()}, std::string(name)).read();
}

ImpactQueries read_impact_queries(const std::filesystem::path& path) {
  const volume_io::FileSource file(path);
  std::vector<std::byte> bytes(static_cast<std::size_t>(file.size()));
  file.read(0, bytes);
  return read_impact_queries(bytes, "'" + path.string() + "'");
}

}  // namespace blum
