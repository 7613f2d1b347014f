#include "view/map_item.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/surface_map_io.hpp"
#include "view/scene_parts.hpp"

namespace blum::cli {
namespace {

/// A texel needs 24 bytes in the scene, 28 in the browser, and a few more while areas are summed.
constexpr std::size_t most_texels = std::size_t{1} << 25U;
/// Triangles do not share corners in the scene, because each triangle has its own chart.
constexpr std::size_t most_charts = 5'000'000;

void check_size(const SurfaceMapFile& file, const std::filesystem::path& path) {
  const auto check = [&](std::size_t count, std::size_t most, const char* what, const char* advice) {
    if (count <= most) return;
    throw FileError("'" + path.string() + "' has " + count_text(count) + " " + what +
                    ", but the viewer shows at most " + count_text(most) + "; " + advice);
  };
  check(file.map.atlas->size(), most_texels, "texels", "make a coarser map");
  check(file.mesh.triangles.size(), most_charts, "triangles", "make a map of a coarser mesh");
}

template <class Id>
Json add_ids(SceneBlob& blob, const Buffer<Id>& ids) {
  static_assert(sizeof(Id) == 4);  // none() is -1
  return blob.add(std::span(reinterpret_cast<const std::int32_t*>(ids.data()), ids.size()));
}

Json add_vectors(SceneBlob& blob, const Buffer<Vec3f>& vectors) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  return blob.add(std::span(reinterpret_cast<const float*>(vectors.data()), 3 * vectors.size()));
}

Json add_corners(SceneBlob& blob, const SurfaceAtlas& atlas) {
  std::vector<float> places;
  places.reserve(6 * atlas.corners.size());
  for (const auto& chart : atlas.corners) {
    for (const TexturePlace& at : chart) {
      places.push_back(static_cast<float>(at.x));
      places.push_back(static_cast<float>(at.y));
    }
  }
  return blob.add(places);
}

Json facts_of(const SurfaceMapFile& file, const Json& range) {
  const SurfaceMap& map = file.map;
  const SurfaceAtlas& atlas = *map.atlas;
  Json list = Json::array({fact("quantity", std::string(to_string(map.quantity))),
                           fact("triangles", count_text(file.mesh.triangles.size())),
                           fact("texture", count_text(atlas.width) + " x " + count_text(atlas.height) + " texels")});
  list.push_back(fact("values", range.is_null()
                                    ? "none within reach"
                                    : rounded_text(range[0].number()) + " to " + rounded_text(range[1].number())));
  if (!map.error.empty()) {
    list.push_back(fact("largest error", rounded_text(*std::max_element(map.error.begin(), map.error.end()))));
  }
  if (map.quantity == SurfaceQuantity::distance) {
    list.push_back(fact("sign", std::string(to_string(map.sign_rule))));
  }
  return list;
}

}  // namespace

Json map_item(SceneBlob& blob, const std::filesystem::path& path) {
  const SurfaceMapFile file = read_surface_map(path);
  check_size(file, path);
  const SurfaceMap& map = file.map;
  const std::string_view units = find_value(file.metadata, "units");
  const Box3 box = bounds(file.mesh);
  const Vec3d origin = box.is_empty() ? Vec3d{} : box.center();
  Json item = {{"kind", "map"}, {"units", units.empty() ? "mesh units" : units}};
  item["origin"] = to_json(origin);
  item["bounds"] = to_json(box);
  item["quantity"] = to_string(map.quantity);
  item["signed"] = is_signed(map);
  item["width"] = map.atlas->width;
  item["height"] = map.atlas->height;
  const auto range = finite_range(map);
  item["range"] = range ? Json::array({range->first, range->second}) : Json(nullptr);
  item["positions"] = add_places(blob, file.mesh.vertices, origin);
  item["triangles"] = add_cells(blob, file.mesh.triangles);
  item["corners"] = add_corners(blob, *map.atlas);
  item["distance"] = blob.add(map.distance.span());
  item["vectors"] = add_vectors(blob, map.vector);
  item["sites"] = add_ids(blob, map.site);
  item["owners"] = add_ids(blob, map.atlas->triangle);
  if (!map.error.empty()) item["errors"] = blob.add(map.error);
  item["facts"] = facts_of(file, item["range"]);
  return item;
}

}  // namespace blum::cli
