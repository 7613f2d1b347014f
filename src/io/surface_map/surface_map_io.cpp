#include "blum/io/surface_map_io.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <set>
#include <string_view>

#include "blum/core/exact_text.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "io/format_table.hpp"
#include "io/surface_map/surface_map_files.hpp"

namespace blum {
namespace {

using surface_map_files::Request;

void check_count(std::size_t count, std::size_t wanted, const char* what, const char* of) {
  if (count == wanted) return;
  throw InvalidMesh("a surface map has " + std::to_string(count) + " " + what + ", not one for each of " +
                    std::to_string(wanted) + " " + of);
}

void check_of(const MeshView& mesh, const SurfaceMap& map) {
  validate(mesh);
  const std::size_t triangles = mesh.triangles.size();
  check_count(map.atlas->corners.size(), triangles, "charts", "triangles of the mesh");
  check_count(map.faces.size(), triangles, "summaries", "triangles of the mesh");
  check_count(map.vertex_distance.size(), mesh.vertices.size(), "distances of vertices", "vertices of the mesh");
  if (!map.error.empty()) check_count(map.error.size(), triangles, "errors", "triangles of the mesh");
}

void check_metadata(const FileMetadata& metadata) {
  std::set<std::string_view> keys;
  for (const auto& pair : metadata) {
    if (pair.first.empty()) throw InvalidOption("metadata need a key for each text");
    if (!keys.insert(pair.first).second) throw InvalidOption("the key '" + pair.first + "' is in the metadata twice");
  }
}

/// Returns the given metadata, and the metadata of the map whose keys are not among them.
FileMetadata all_metadata(const SurfaceMap& map, const FileMetadata& given, const SurfaceMapWriteOptions& options) {
  FileMetadata out = given;
  const auto add = [&](const char* key, const std::string& text) {
    const bool is_given = std::any_of(given.begin(), given.end(), [&](const auto& pair) { return pair.first == key; });
    if (!is_given && !text.empty()) out.emplace_back(key, text);
  };
  add("content", "surface map");
  add("quantity", std::string(to_string(map.quantity)));
  add("units", options.units);
  add("sign_rule", std::string(to_string(map.sign_rule)));
  add("sign_reason", map.sign_reason);
  if (const auto range = finite_range(map)) add("range", exact_text(range->first) + " " + exact_text(range->second));
  if (!map.error.empty()) add("largest_error", exact_text(*std::max_element(map.error.begin(), map.error.end())));
  return out;
}

/// Adds a column of triangles, with one member of their summaries.
void add_summary(Columns& columns, const char* name, const SurfaceMap& map, float SurfaceMap::FaceSummary::* part) {
  const std::span<float> column = columns.add<float>(name);
  for (std::size_t t = 0; t < map.faces.size(); ++t) column[t] = map.faces[t].*part;
}

}  // namespace

namespace surface_map_files {

void check(const SurfaceMap& map) {
  if (map.atlas == nullptr) throw InvalidMesh("a surface map has no atlas");
  const SurfaceAtlas& atlas = *map.atlas;
  check_count(atlas.size(), std::size_t{atlas.width} * atlas.height, "triangles of texels", "texels");
  check_count(map.distance.size(), atlas.size(), "distances", "texels");
  check_count(map.vector.size(), atlas.size(), "vectors", "texels");
  check_count(map.site.size(), atlas.size(), "sites", "texels");
  if (atlas.size() == 0) throw InvalidMesh("a surface map has no texels");
}

std::string title_of(const SurfaceMap& map, const std::string& units) {
  return std::string(to_string(map.quantity)) + (units.empty() ? "" : " (" + units + ")");
}

void write_columns(const Request& request) {
  const SurfaceMap& map = request.map;
  Complex complex;
  complex.positions.assign(request.mesh.vertices.begin(), request.mesh.vertices.end());
  complex.triangles.assign(request.mesh.triangles.begin(), request.mesh.triangles.end());
  complex.vertex_columns = Columns(complex.positions.size());
  complex.edge_columns = Columns(0);
  complex.triangle_columns = Columns(complex.triangles.size());
  complex.vertex_columns.add({"distance", 1, map.vertex_distance});
  add_summary(complex.triangle_columns, "smallest", map, &SurfaceMap::FaceSummary::smallest);
  add_summary(complex.triangle_columns, "largest", map, &SurfaceMap::FaceSummary::largest);
  add_summary(complex.triangle_columns, "mean", map, &SurfaceMap::FaceSummary::mean);
  if (!map.error.empty()) complex.triangle_columns.add({"error", 1, map.error});
  write_complex(request.path, complex, request.metadata, {}, request.context);
}

}  // namespace surface_map_files

void write_surface_map(const std::filesystem::path& path, const MeshView& mesh, const SurfaceMap& map,
                       const FileMetadata& metadata, const SurfaceMapWriteOptions& options, const Context& context) {
  const auto format = SurfaceMapFormat::of(path, FileAccess::write);
  surface_map_files::check(map);
  check_of(mesh, map);
  check_metadata(metadata);
  static_cast<void>(color_scale_of(map, options));  // throws if the range is invalid, for every format
  throw_if_cancelled(context);
  try {
    const FileMetadata all = all_metadata(map, metadata, options);
    formats::code_of(format).write({path, mesh, map, all, options, context});
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to write '" + path.string() + "'");
  }
}

namespace formats {

constinit const SurfaceMapCode surface_map_npz{surface_map_files::write_npz};
constinit const SurfaceMapCode surface_map_png{surface_map_files::write_picture};
constinit const SurfaceMapCode surface_map_glb{surface_map_files::write_glb};
constinit const SurfaceMapCode surface_map_as_complex{surface_map_files::write_columns};

}  // namespace formats
}  // namespace blum
