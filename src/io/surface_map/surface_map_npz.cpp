#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/archive/npz.hpp"
#include "io/surface_map/surface_map_files.hpp"
#include "io/text/json.hpp"

namespace blum::surface_map_files {
namespace {

using volume_io::NpzWriter;

std::uint64_t data_size(const MeshView& mesh, const SurfaceMap& map) {
  return 24 * map.atlas->size() + 32 * mesh.vertices.size() + (48 + 12 + 16) * mesh.triangles.size();
}

void add_texels(NpzWriter& npz, const SurfaceMap& map) {
  const SurfaceAtlas& atlas = *map.atlas;
  const std::vector<std::uint64_t> shape{atlas.height, atlas.width};
  npz.add("distance", "f4", shape, map.distance.span());
  npz.add("vector", "f4", {atlas.height, atlas.width, 3}, map.vector.span());
  npz.add("site", "i4", shape, map.site.span());
  npz.add("triangle", "i4", shape, atlas.triangle.span());
}

void add_mesh(NpzWriter& npz, const MeshView& mesh, const SurfaceMap& map) {
  using Corners = std::array<TexturePlace, 3>;
  static_assert(sizeof(Corners) == 6 * sizeof(double) && sizeof(Vec3d) == 3 * sizeof(double));
  static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(SiteId) == 4 && sizeof(TriangleId) == 4);
  npz.add("corners", "f8", {map.atlas->corners.size(), 3, 2}, std::span<const Corners>(map.atlas->corners));
  npz.add("vertices", "f8", {mesh.vertices.size(), 3}, mesh.vertices);
  npz.add("triangles", "i4", {mesh.triangles.size(), 3}, mesh.triangles);
  npz.add("vertex_distance", "f8", {map.vertex_distance.size()}, std::span<const double>(map.vertex_distance));
}

void add_summaries(NpzWriter& npz, const SurfaceMap& map) {
  const auto add = [&](const std::string& name, float SurfaceMap::FaceSummary::* part) {
    std::vector<float> numbers;
    numbers.reserve(map.faces.size());
    for (const SurfaceMap::FaceSummary& face : map.faces) numbers.push_back(face.*part);
    npz.add("triangle_" + name, "f4", {numbers.size()}, std::span<const float>(numbers));
  };
  if (!map.error.empty()) npz.add("triangle_error", "f4", {map.error.size()}, std::span<const float>(map.error));
  add("smallest", &SurfaceMap::FaceSummary::smallest);
  add("largest", &SurfaceMap::FaceSummary::largest);
  add("mean", &SurfaceMap::FaceSummary::mean);
}

/// What is read back from metadata must be what the map says.
FileMetadata own_metadata(const Request& request) {
  FileMetadata out = request.metadata;
  const auto keep = [&](std::string_view key, std::string_view text) {
    const std::string_view given = find_value(out, key);
    if (given.empty()) out.emplace_back(key, text);
    if (given.empty() || given == text) return;
    throw InvalidOption("the metadata name '" + std::string(given) + "' as " + std::string(key) +
                        ", but the map's is '" + std::string(text) + "'; .npz files say what the map is");
  };
  keep("quantity", to_string(request.map.quantity));
  keep("sign_rule", to_string(request.map.sign_rule));
  keep(separate_key, request.map.atlas->is_separate ? "true" : "false");
  return out;
}

}  // namespace

void write_npz(const Request& request) {
  const FileMetadata metadata = own_metadata(request);
  AtomicFile file(request.path);
  volume_io::FieldSink sink(data_size(request.mesh, request.map), request.context);
  NpzWriter npz(file, sink, request.context);
  add_texels(npz, request.map);
  add_mesh(npz, request.mesh, request.map);
  add_summaries(npz, request.map);
  npz.add_text("metadata", volume_io::to_json(metadata));
  npz.finish();
  file.commit();
}

}  // namespace blum::surface_map_files
