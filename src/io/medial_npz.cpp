// Indices are int32: Blum's ids fit it, NumPy indexes with any integer type, and unlike unsigned ones differences of
// them are what they should be.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "io/medial_columns.hpp"
#include "io/medial_files.hpp"
#include "io/npz.hpp"

namespace blum::medial_files {
namespace {

using volume_io::ByteStream;
using volume_io::NpyHeader;
using volume_io::NpzReader;
using volume_io::NpzWriter;

/// Adds one array with `components` values of get(item, component) for each item.
template <class T, class Item, class Get>
void add_column(NpzWriter& npz, const std::string& name, std::string_view dtype, const std::vector<Item>& items,
                const std::vector<std::uint64_t>& tail, Get get) {
  std::vector<std::uint64_t> shape{items.size()};
  shape.insert(shape.end(), tail.begin(), tail.end());
  std::size_t components = 1;
  for (const std::uint64_t n : tail) components *= static_cast<std::size_t>(n);
  std::vector<T> values;
  values.reserve(items.size() * components);
  for (const Item& item : items) {
    for (std::size_t c = 0; c < components; ++c) values.push_back(get(item, c));
  }
  npz.add(name, dtype, shape, std::span<const T>(values));
}

void add_vertices(NpzWriter& npz, const std::vector<MedialVertex>& vertices) {
  using V = MedialVertex;
  add_column<double>(npz, "vertices", "f8", vertices, {3}, [](const V& v, std::size_t c) { return v.position[c]; });
  add_column<double>(npz, "radius", "f8", vertices, {}, [](const V& v, std::size_t) { return v.radius; });
  add_column<double>(npz, "separation_angle", "f8", vertices, {},
                     [](const V& v, std::size_t) { return v.separation_angle; });
  add_column<std::uint8_t>(npz, "role", "u1", vertices, {},
                           [](const V& v, std::size_t) { return static_cast<std::uint8_t>(v.role); });
  add_column<double>(npz, "footprints", "f8", vertices, {2, 3},
                     [](const V& v, std::size_t c) { return v.footprints[c / 3][c % 3]; });
  add_column<std::int32_t>(npz, "sites", "i4", vertices, {2},
                           [](const V& v, std::size_t c) { return v.sites[c].to_file(); });
}

void add_edges(NpzWriter& npz, const std::vector<MedialEdge>& edges) {
  using E = MedialEdge;
  add_column<std::int32_t>(npz, "edges", "i4", edges, {2},
                           [](const E& e, std::size_t c) { return static_cast<std::int32_t>(e.vertices[c]); });
  add_column<float>(npz, "edge_angle", "f4", edges, {}, [](const E& e, std::size_t) { return e.separation_angle; });
  add_column<std::uint8_t>(npz, "edge_role", "u1", edges, {},
                           [](const E& e, std::size_t) { return static_cast<std::uint8_t>(e.role); });
}

void add_triangles(NpzWriter& npz, const std::vector<MedialTriangle>& triangles) {
  using T = MedialTriangle;
  add_column<std::int32_t>(npz, "triangles", "i4", triangles, {3},
                           [](const T& t, std::size_t c) { return static_cast<std::int32_t>(t.vertices[c]); });
  add_column<float>(npz, "triangle_angle", "f4", triangles, {},
                    [](const T& t, std::size_t) { return t.separation_angle; });
  add_column<std::int32_t>(npz, "triangle_sheet", "i4", triangles, {},
                           [](const T& t, std::size_t) { return static_cast<std::int32_t>(t.sheet); });
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string out;
  for (const std::uint64_t n : shape) out += (out.empty() ? "" : ", ") + std::to_string(n);
  return "[" + out + "]";
}

class MedialNpzReader {
 public:
  explicit MedialNpzReader(const volume_io::ByteSource& source) : source_(source), npz_(source) {}

  MedialFile read() {
    // Fields of meshes have an array 'vertices', too.
    if (npz_.has("distance")) {
      throw FormatError(source_.name() + ": it holds a distance field (array 'distance'), not a medial axis");
    }
    read_vertices();
    read_edges();
    read_triangles();
    if (!has_roles_) keep_curves_only(file_.complex);
    if (npz_.has("metadata")) {
      file_.metadata = from_pairs(volume_io::from_json(npz_.text("metadata"), source_.name()), source_.name());
    }
    return std::move(file_);
  }

 private:
  [[nodiscard]] std::string where(const std::string& array) const { return source_.name() + "(" + array + ".npy)"; }
  [[noreturn]] void fail(const std::string& array, const std::string& reason) const {
    throw FormatError(where(array) + ": " + reason);
  }

  /// An array of items of so many numbers each, as many items as it has.
  VoxelImage::Values items(const std::string& array, std::uint64_t components) {
    return npz_.read(array, [&](ByteStream& stream, const NpyHeader& header) {
      if (header.shape.size() != 2 || header.shape[1] != components) {
        throw FormatError(stream.name() + ": its shape is " + shape_text(header.shape) + ", but should be [n, " +
                          std::to_string(components) + "]");
      }
      return volume_io::read_npy_values(stream, header);
    });
  }

  /// An array of exactly this shape.
  VoxelImage::Values column(const std::string& array, const std::vector<std::uint64_t>& shape) {
    return npz_.read(array, [&](ByteStream& stream, const NpyHeader& header) {
      if (header.shape != shape) {
        throw FormatError(stream.name() + ": its shape is " + shape_text(header.shape) + ", but should be " +
                          shape_text(shape));
      }
      return volume_io::read_npy_values(stream, header);
    });
  }

  /// Calls set(index, value) for the values of an array that need not be there; false when it is not.
  template <class Set>
  bool numbers(const std::string& array, const std::vector<std::uint64_t>& shape, Set set) {
    if (!npz_.has(array)) return false;
    for_each_number(column(array, shape), set);
    return true;
  }
  /// set gets a third argument, to call with what is wrong with a value.
  template <class Set>
  bool integers(const std::string& array, const std::vector<std::uint64_t>& shape, Set set) {
    if (!npz_.has(array)) return false;
    const auto bad = [&](const std::string& reason) { fail(array, reason); };
    for_each_integer(column(array, shape), where(array),
                     [&](std::size_t i, std::int64_t value) { set(i, value, bad); });
    return true;
  }

  void read_vertices() {
    const VoxelImage::Values places = items("vertices", 3);
    const std::size_t count = std::visit([](const auto& v) { return v.size(); }, places) / 3;
    if (count > max_id_count) fail("vertices", "too many vertices: 2^31 - 1 are the most");
    std::vector<MedialVertex>& vertices = file_.complex.vertices;
    vertices.resize(count);
    for_each_number(places, [&](std::size_t i, double value) { vertices[i / 3].position[i % 3] = value; });
    file_.has_radii = numbers("radius", {count}, [&](std::size_t i, double value) { vertices[i].radius = value; });
    file_.has_angles = numbers("separation_angle", {count},
                               [&](std::size_t i, double value) { vertices[i].separation_angle = value; });
    file_.has_labels = integers("role", {count}, [&](std::size_t i, std::int64_t value, const auto& bad) {
      vertices[i].role = role_from_file(value, bad);
    });
    file_.has_footprints = numbers("footprints", {count, 2, 3}, [&](std::size_t i, double value) {
      vertices[i / 6].footprints[i / 3 % 2][i % 3] = value;
    });
    file_.has_sites = integers("sites", {count, 2}, [&](std::size_t i, std::int64_t value, const auto& bad) {
      vertices[i / 2].sites[i % 2] = site_from_file(value, bad);
    });
  }

  /// The corners of cells, of which an array may hold none.
  template <std::size_t corners, class Cell>
  void read_cells(const std::string& array, std::vector<Cell>& cells) {
    if (!npz_.has(array)) return;
    const VoxelImage::Values values = items(array, corners);
    cells.resize(std::visit([](const auto& v) { return v.size(); }, values) / corners);
    const std::size_t count = file_.complex.vertices.size();
    for_each_integer(values, where(array), [&](std::size_t i, std::int64_t vertex) {
      if (vertex < 0 || std::cmp_greater_equal(vertex, count)) {
        fail(array, "vertex " + std::to_string(vertex) + " is named, but there are only " + std::to_string(count));
      }
      cells[i / corners].vertices[i % corners] = static_cast<std::uint32_t>(vertex);
    });
  }

  void read_edges() {
    std::vector<MedialEdge>& edges = file_.complex.edges;
    read_cells<2>("edges", edges);
    const bool angles = numbers("edge_angle", {edges.size()}, [&](std::size_t i, double value) {
      edges[i].separation_angle = angle_from_file(value);
    });
    has_roles_ = integers("edge_role", {edges.size()}, [&](std::size_t i, std::int64_t value, const auto& bad) {
      edges[i].role = role_from_file(value, bad);
    });
    file_.has_angles = file_.has_angles && (angles || edges.empty());
    file_.has_labels = file_.has_labels && (has_roles_ || edges.empty());
  }

  void read_triangles() {
    std::vector<MedialTriangle>& triangles = file_.complex.triangles;
    read_cells<3>("triangles", triangles);
    const bool angles = numbers("triangle_angle", {triangles.size()}, [&](std::size_t i, double value) {
      triangles[i].separation_angle = angle_from_file(value);
    });
    const bool sheets = integers(
        "triangle_sheet", {triangles.size()},
        [&](std::size_t i, std::int64_t value, const auto& bad) { triangles[i].sheet = sheet_from_file(value, bad); });
    file_.has_angles = file_.has_angles && (angles || triangles.empty());
    file_.has_labels = file_.has_labels && (sheets || triangles.empty());
  }

  const volume_io::ByteSource& source_;
  NpzReader npz_;
  MedialFile file_;
  bool has_roles_ = false;  ///< of edges
};

}  // namespace

void write_npz(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata,
               const Context& context) {
  constexpr std::uint64_t vertex_bytes = 24 + 8 + 8 + 1 + 48 + 8;
  constexpr std::uint64_t edge_bytes = 8 + 4 + 1;
  constexpr std::uint64_t triangle_bytes = 12 + 4 + 4;
  AtomicFile file(path);
  volume_io::FieldSink sink(vertex_bytes * complex.vertices.size() + edge_bytes * complex.edges.size() +
                                triangle_bytes * complex.triangles.size(),
                            context);
  NpzWriter npz(file, sink, context);
  add_vertices(npz, complex.vertices);
  add_edges(npz, complex.edges);
  add_triangles(npz, complex.triangles);
  npz.add_text("metadata", volume_io::to_json(to_pairs(metadata)));
  npz.finish();
  file.commit();
}

MedialFile read_npz(const volume_io::ByteSource& source) {
  return MedialNpzReader(source).read();
}

}  // namespace blum::medial_files
