#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/io/gltf_io.hpp"
#include "io/surface_map/surface_map_files.hpp"

namespace blum::surface_map_files {
namespace {

using Places = std::array<std::array<float, 2>, 3>;

/// Places of corners as glTF has them: parts of the texture's sides, v down as the rows.
std::vector<Places> texture_coordinates(const SurfaceAtlas& atlas) {
  std::vector<Places> out;
  out.reserve(atlas.corners.size());
  for (std::uint32_t t = 0; t < atlas.corners.size(); ++t) out.push_back(atlas.texture_coordinates(TriangleId(t)));
  return out;
}

/// Single precision, infinite beyond it.
std::vector<float> floats_of(const std::vector<double>& numbers) {
  std::vector<float> out;
  out.reserve(numbers.size());
  for (const double number : numbers) out.push_back(static_cast<float>(number));
  return out;
}

GltfExtras extras_of(const Request& request, const ColorScale& scale) {
  GltfExtras extras;
  const auto range = finite_range(request.map);
  for (const auto& pair : request.metadata) {
    const bool is_ours = pair.first == "color_range" || pair.first == "colors";
    if (pair.first == "range" && range) {
      extras.emplace_back("range", std::vector<double>{range->first, range->second});
    } else if (!is_ours) {
      extras.emplace_back(pair.first, pair.second);
    }
  }
  extras.emplace_back("colors", scale.diverges() ? "diverging" : "sequential");
  extras.emplace_back("color_range", std::vector<double>{scale.lowest(), scale.highest()});
  return extras;
}

}  // namespace

void write_glb(const Request& request) {
  const SurfaceMap& map = request.map;
  const ColorScale scale = color_scale_of(map, request.options);
  const std::vector<std::byte> png = encode_png(color_texture(map, scale, request.context).view());
  const std::vector<Places> places = texture_coordinates(*map.atlas);
  const std::vector<float> distances = floats_of(map.vertex_distance);
  GltfMesh shown;
  shown.name = title_of(map, request.options.units);
  shown.vertices = request.mesh.vertices;
  shown.triangles = request.mesh.triangles;
  shown.attributes.push_back({"DISTANCE", 1, distances});
  shown.texture_coordinates = places;
  shown.texture = png;
  shown.extras = extras_of(request, scale);
  write_gltf(request.path, shown, request.context);
}

}  // namespace blum::surface_map_files
