// Indices are int32: Blum's ids fit it, NumPy indexes with any integer type, and unlike unsigned ones differences of
// them are what they should be.
#include <algorithm>
#include <array>
#include <cmath>
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

void add_vertices(NpzWriter& npz, const std::string& prefix, const std::vector<MedialVertex>& vertices) {
  using V = MedialVertex;
  add_column<double>(npz, prefix + "vertices", "f8", vertices, {3},
                     [](const V& v, std::size_t c) { return v.position[c]; });
  add_column<double>(npz, prefix + "radius", "f8", vertices, {}, [](const V& v, std::size_t) { return v.radius; });
  add_column<double>(npz, prefix + "separation_angle", "f8", vertices, {},
                     [](const V& v, std::size_t) { return v.separation_angle; });
  add_column<std::uint8_t>(npz, prefix + "role", "u1", vertices, {},
                           [](const V& v, std::size_t) { return static_cast<std::uint8_t>(v.role); });
  add_column<double>(npz, prefix + "footprints", "f8", vertices, {2, 3},
                     [](const V& v, std::size_t c) { return v.footprints[c / 3][c % 3]; });
  add_column<std::int32_t>(npz, prefix + "sites", "i4", vertices, {2},
                           [](const V& v, std::size_t c) { return v.sites[c].to_file(); });
}

template <class E>
void add_edges(NpzWriter& npz, const std::string& prefix, const std::vector<E>& edges) {
  add_column<std::int32_t>(npz, prefix + "edges", "i4", edges, {2},
                           [](const E& e, std::size_t c) { return static_cast<std::int32_t>(e.vertices[c]); });
  add_column<float>(npz, prefix + "edge_angle", "f4", edges, {},
                    [](const E& e, std::size_t) { return e.separation_angle; });
  add_column<std::uint8_t>(npz, prefix + "edge_role", "u1", edges, {},
                           [](const E& e, std::size_t) { return static_cast<std::uint8_t>(e.role); });
}

template <class T>
void add_triangles(NpzWriter& npz, const std::string& prefix, const std::vector<T>& triangles) {
  add_column<std::int32_t>(npz, prefix + "triangles", "i4", triangles, {3},
                           [](const T& t, std::size_t c) { return static_cast<std::int32_t>(t.vertices[c]); });
  add_column<float>(npz, prefix + "triangle_angle", "f4", triangles, {},
                    [](const T& t, std::size_t) { return t.separation_angle; });
  add_column<std::int32_t>(npz, prefix + "triangle_sheet", "i4", triangles, {},
                           [](const T& t, std::size_t) { return static_cast<std::int32_t>(t.sheet); });
}

void add_nested(NpzWriter& npz, const NestedComplex& nested) {
  const std::array<double, 1> theta{nested.least_theta};
  npz.add("nested_theta", "f8", {1}, std::span<const double>(theta));
  add_vertices(npz, "nested_", nested.vertices);
  add_edges(npz, "nested_", nested.edges);
  add_triangles(npz, "nested_", nested.triangles);
  using E = NestedEdge;
  using T = NestedTriangle;
  add_column<float>(npz, "nested_vertex_until", "f4", nested.vertex_until, {},
                    [](float until, std::size_t) { return until; });
  add_column<float>(npz, "nested_edge_from", "f4", nested.edges, {}, [](const E& e, std::size_t) { return e.from; });
  add_column<float>(npz, "nested_edge_until", "f4", nested.edges, {}, [](const E& e, std::size_t) { return e.until; });
  add_column<float>(npz, "nested_triangle_until", "f4", nested.triangles, {},
                    [](const T& t, std::size_t) { return t.until; });
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
    read_nested();
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
    const Found found = read_vertices("", file_.complex.vertices);
    file_.has_radii = found.radii;
    file_.has_angles = found.angles;
    file_.has_labels = found.roles;
    file_.has_footprints = found.footprints;
    file_.has_sites = found.sites;
  }

  /// Which attributes vertices have.
  struct Found {
    bool radii = false, angles = false, roles = false, footprints = false, sites = false;
  };
  Found read_vertices(const std::string& prefix, std::vector<MedialVertex>& vertices) {
    const VoxelImage::Values places = items(prefix + "vertices", 3);
    const std::size_t count = std::visit([](const auto& v) { return v.size(); }, places) / 3;
    if (count > max_id_count) fail(prefix + "vertices", "too many vertices: 2^31 - 1 are the most");
    vertices.resize(count);
    for_each_number(places, [&](std::size_t i, double value) { vertices[i / 3].position[i % 3] = value; });
    Found found;
    found.radii = numbers(prefix + "radius", {count}, [&](std::size_t i, double value) { vertices[i].radius = value; });
    found.angles = numbers(prefix + "separation_angle", {count},
                           [&](std::size_t i, double value) { vertices[i].separation_angle = value; });
    found.roles = integers(prefix + "role", {count}, [&](std::size_t i, std::int64_t value, const auto& bad) {
      vertices[i].role = role_from_file(value, bad);
    });
    found.footprints = numbers(prefix + "footprints", {count, 2, 3}, [&](std::size_t i, double value) {
      vertices[i / 6].footprints[i / 3 % 2][i % 3] = value;
    });
    found.sites = integers(prefix + "sites", {count, 2}, [&](std::size_t i, std::int64_t value, const auto& bad) {
      vertices[i / 2].sites[i % 2] = site_from_file(value, bad);
    });
    return found;
  }

  /// The corners of cells among so many vertices, of which an array may hold none.
  template <std::size_t corners, class Cell>
  void read_cells(const std::string& array, std::vector<Cell>& cells, std::size_t count) {
    if (!npz_.has(array)) return;
    const VoxelImage::Values values = items(array, corners);
    cells.resize(std::visit([](const auto& v) { return v.size(); }, values) / corners);
    for_each_integer(values, where(array), [&](std::size_t i, std::int64_t vertex) {
      if (vertex < 0 || std::cmp_greater_equal(vertex, count)) {
        fail(array, "vertex " + std::to_string(vertex) + " is named, but there are only " + std::to_string(count));
      }
      cells[i / corners].vertices[i % corners] = static_cast<std::uint32_t>(vertex);
    });
  }

  void read_edges() {
    std::vector<MedialEdge>& edges = file_.complex.edges;
    read_cells<2>("edges", edges, file_.complex.vertices.size());
    const bool angles = read_edge_angles("", edges);
    has_roles_ = read_edge_roles("", edges);
    file_.has_angles = file_.has_angles && (angles || edges.empty());
    file_.has_labels = file_.has_labels && (has_roles_ || edges.empty());
  }
  template <class Edge>
  bool read_edge_angles(const std::string& prefix, std::vector<Edge>& edges) {
    return numbers(prefix + "edge_angle", {edges.size()},
                   [&](std::size_t i, double value) { edges[i].separation_angle = angle_from_file(value); });
  }
  template <class Edge>
  bool read_edge_roles(const std::string& prefix, std::vector<Edge>& edges) {
    return integers(prefix + "edge_role", {edges.size()}, [&](std::size_t i, std::int64_t value, const auto& bad) {
      edges[i].role = role_from_file(value, bad);
    });
  }

  void read_triangles() {
    std::vector<MedialTriangle>& triangles = file_.complex.triangles;
    read_cells<3>("triangles", triangles, file_.complex.vertices.size());
    const bool angles = read_triangle_angles("", triangles);
    const bool sheets = read_sheets("", triangles);
    file_.has_angles = file_.has_angles && (angles || triangles.empty());
    file_.has_labels = file_.has_labels && (sheets || triangles.empty());
  }
  template <class Cell>
  bool read_triangle_angles(const std::string& prefix, std::vector<Cell>& triangles) {
    return numbers(prefix + "triangle_angle", {triangles.size()},
                   [&](std::size_t i, double value) { triangles[i].separation_angle = angle_from_file(value); });
  }
  template <class Cell>
  bool read_sheets(const std::string& prefix, std::vector<Cell>& triangles) {
    return integers(
        prefix + "triangle_sheet", {triangles.size()},
        [&](std::size_t i, std::int64_t value, const auto& bad) { triangles[i].sheet = sheet_from_file(value, bad); });
  }

  /// The axes of all angles, of which a file has all arrays or none.
  void read_nested() {
    if (!npz_.has("nested_theta")) return;
    NestedComplex& nested = file_.nested.emplace();
    numbers("nested_theta", {1}, [&](std::size_t, double value) { nested.least_theta = value; });
    const Found found = read_vertices("nested_", nested.vertices);
    const std::size_t count = nested.vertices.size();
    nested.vertex_until.resize(count);
    read_cells<2>("nested_edges", nested.edges, count);
    read_cells<3>("nested_triangles", nested.triangles, count);
    const auto levels = [&](const std::string& array, std::size_t size, const auto& set) {
      return numbers(array, {size}, [&](std::size_t i, double value) {
        if (std::isnan(value)) fail(array, "a value is not a number");
        set(i, angle_from_file(value));
      });
    };
    const bool is_whole =
        found.radii && found.angles && found.roles && found.footprints && found.sites &&
        levels("nested_vertex_until", count, [&](std::size_t i, float value) { nested.vertex_until[i] = value; }) &&
        read_edge_angles("nested_", nested.edges) && read_edge_roles("nested_", nested.edges) &&
        levels("nested_edge_from", nested.edges.size(),
               [&](std::size_t i, float value) { nested.edges[i].from = value; }) &&
        levels("nested_edge_until", nested.edges.size(),
               [&](std::size_t i, float value) { nested.edges[i].until = value; }) &&
        read_triangle_angles("nested_", nested.triangles) && read_sheets("nested_", nested.triangles) &&
        levels("nested_triangle_until", nested.triangles.size(),
               [&](std::size_t i, float value) { nested.triangles[i].until = value; });
    if (!is_whole) fail("nested_theta", "other arrays whose names begin with 'nested_' are missing");
    for (const NestedTriangle& t : nested.triangles) nested.sheet_count = std::max(nested.sheet_count, t.sheet + 1);
  }

  const volume_io::ByteSource& source_;
  NpzReader npz_;
  MedialFile file_;
  bool has_roles_ = false;  ///< of edges
};

}  // namespace

void write_npz(const std::filesystem::path& path, const MedialComplex& complex, const NestedComplex* nested,
               const MedialMetadata& metadata, const Context& context) {
  constexpr std::uint64_t vertex_bytes = 24 + 8 + 8 + 1 + 48 + 8;
  constexpr std::uint64_t edge_bytes = 8 + 4 + 1;
  constexpr std::uint64_t triangle_bytes = 12 + 4 + 4;
  std::uint64_t bytes = vertex_bytes * complex.vertices.size() + edge_bytes * complex.edges.size() +
                        triangle_bytes * complex.triangles.size();
  if (nested != nullptr) {
    bytes += 8 + (vertex_bytes + 4) * nested->vertices.size() + (edge_bytes + 8) * nested->edges.size() +
             (triangle_bytes + 4) * nested->triangles.size();
  }
  AtomicFile file(path);
  volume_io::FieldSink sink(bytes, context);
  NpzWriter npz(file, sink, context);
  add_vertices(npz, "", complex.vertices);
  add_edges(npz, "", complex.edges);
  add_triangles(npz, "", complex.triangles);
  if (nested != nullptr) add_nested(npz, *nested);
  npz.add_text("metadata", volume_io::to_json(to_pairs(metadata)));
  npz.finish();
  file.commit();
}

MedialFile read_npz(const volume_io::ByteSource& source) {
  return MedialNpzReader(source).read();
}

}  // namespace blum::medial_files
