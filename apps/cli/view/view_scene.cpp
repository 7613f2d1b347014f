#include "view/view_scene.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/surface_map_io.hpp"
#include "common/files.hpp"
#include "common/input_facts.hpp"
#include "view/axis_item.hpp"
#include "view/map_item.hpp"
#include "view/scene_parts.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

/// Largest number of nodes that a browser can store in one array and show in acceptable time: 512^3.
constexpr std::size_t most_nodes = std::size_t{1} << 27U;

void check_size(std::size_t count, std::size_t most, const char* what, const fs::path& path, const char* advice) {
  if (count <= most) return;
  throw FileError("'" + path.string() + "' has " + count_text(count) + " " + what + ", but the viewer shows at most " +
                  count_text(most) + "; " + advice);
}

Json mesh_item(SceneBlob& blob, const fs::path& path, const TriangleMesh& mesh) {
  validate(mesh);
  check_size(mesh.triangles.size(), most_triangles_shown, "triangles", path, "show a coarser mesh");
  const SiteTable sites(mesh);
  const Orientation facts = orientation(mesh, sites);
  const Box3 box = bounds(mesh);
  const Vec3d origin = box.is_empty() ? Vec3d{} : box.center();
  Json item = {{"kind", "mesh"}, {"content", "mesh"}, {"units", "mesh units"}};
  item["origin"] = to_json(origin);
  item["bounds"] = to_json(box);
  item["counts"] = {
      {"vertices", mesh.vertices.size()}, {"edges", sites.edge_count()}, {"triangles", mesh.triangles.size()}};
  item["closed"] = facts.closed;
  item["positions"] = add_places(blob, mesh.vertices, origin);
  item["triangles"] = add_cells(blob, mesh.triangles);
  item["segments"] = add_cells(blob, mesh.segments);
  item["points"] = blob.add(mesh.points);
  Json& list = item["facts"] =
      Json::array({fact("vertices", count_text(mesh.vertices.size())), fact("edges", count_text(sites.edge_count())),
                   fact("triangles", count_text(mesh.triangles.size()))});
  if (!mesh.segments.empty()) list.push_back(fact("segments", count_text(mesh.segments.size())));
  if (!mesh.points.empty()) list.push_back(fact("points", count_text(mesh.points.size())));
  if (!mesh.triangles.empty()) {
    list.push_back(fact("components", count_text(facts.components)));
    list.push_back(fact("surface", facts.closed ? "closed" : "open or not a manifold"));
    if (facts.closed && facts.oriented) list.push_back(fact("volume", rounded_text(facts.signed_volume)));
  }
  return item;
}

/// Adds a complex without its columns. Vertices are points if there are no other cells.
Json plain_item(SceneBlob& blob, const fs::path& path, const ShownAxis& shown) {
  const Complex& complex = shown.file.complex;
  TriangleMesh mesh{complex.positions, complex.triangles, {}, {}};
  mesh.segments.assign(complex.edges.begin(), complex.edges.end());
  if (mesh.triangles.empty() && mesh.segments.empty()) {
    mesh.points.resize(mesh.vertices.size());
    std::iota(mesh.points.begin(), mesh.points.end(), 0U);
  }
  Json item = mesh_item(blob, path, mesh);
  item["content"] = shown.content;
  item["facts"].push_back(fact("content", shown.content));
  return item;
}

/// Adds a complex: a medial axis, walls, curves or plain cells.
Json complex_item(SceneBlob& blob, const fs::path& path, const Context& context) {
  const ShownAxis shown = read_axis_or_curves(path);
  return shown.is_plain ? plain_item(blob, path, shown) : axis_item(blob, shown, context);
}

Json grid_facts(const GridSpec& grid) {
  return Json::array({fact("size", size_text(grid)), fact("nodes", count_text(grid.node_count())),
                      fact("spacing", vector_text(grid.spacing))});
}

Json grid_json(const GridSpec& grid) {
  Json directions = Json::array();
  for (const Vec3d& column : grid.direction.columns) directions.push_back(to_json(column));
  return {{"origin", to_json(grid.origin)},
          {"spacing", to_json(grid.spacing)},
          {"size", to_json(grid.size)},
          {"direction", directions}};
}

/// Returns the smallest and the largest finite number; null if no number is finite.
template <class Values>
Json range_of(const Values& values) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const auto value : values) {
    const auto number = static_cast<double>(value);
    if (!std::isfinite(number)) continue;
    least = std::min(least, number);
    most = std::max(most, number);
  }
  return least <= most ? Json::array({least, most}) : Json(nullptr);
}

std::string range_text(const Json& range) {
  return range.is_null() ? "no numbers" : rounded_text(range[0].number()) + " to " + rounded_text(range[1].number());
}

Json field_item(SceneBlob& blob, const fs::path& path) {
  const Field field = read_field(path);
  warn(field.warnings);
  check_size(field.distance.size(), most_nodes, "nodes", path, "make a coarser field");
  const bool is_of_voxels = field.site_ids == SiteIds::voxels;
  Json item = {{"kind", "field"}, {"units", is_of_voxels ? "units of the spacing" : "mesh units"}};
  item["grid"] = grid_json(field.grid);
  item["bounds"] = to_json(bounds(field.grid));
  item["distance"] = blob.add(field.distance.span());
  if (!field.site.empty()) {
    // Ids have 32 bits, and none() is -1 as an int32.
    item["sites"] = blob.add(std::span(reinterpret_cast<const std::int32_t*>(field.site.data()), field.site.size()));
  }
  item["site_ids"] = to_string(field.site_ids);
  item["signed"] = field.sign_rule != SignRule::none;
  item["band"] = field.band ? Json(*field.band) : Json(nullptr);
  item["range"] = range_of(field.distance.span());
  item["facts"] = grid_facts(field.grid);
  item["facts"].push_back(fact("distance", range_text(item["range"])));
  if (field.band) item["facts"].push_back(fact("band", "+-" + rounded_text(*field.band)));
  item["facts"].push_back(fact("sign", std::string(to_string(field.sign_rule))));
  item["facts"].push_back(
      fact("sites", field.site.empty() ? "none in the file" : std::string(to_string(field.site_ids))));
  return item;
}

/// Returns true if integer values are probably labels, not measurements: there are few different values, or outside of
/// the background most neighbours are equal.
template <class T>
bool are_labels(const std::vector<T>& values, std::int64_t row) {
  if constexpr (!std::is_integral_v<T>) return false;
  constexpr std::size_t few = 32;
  std::set<T> distinct;
  for (std::size_t i = 0; i < values.size() && distinct.size() <= few; ++i) distinct.insert(values[i]);
  if (distinct.size() <= few) return true;
  const T background = *std::min_element(values.begin(), values.end());
  std::size_t pairs = 0;
  std::size_t alike = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (i % static_cast<std::size_t>(row) == 0 || values[i - 1] == background || values[i] == background) continue;
    ++pairs;
    if (values[i - 1] == values[i]) ++alike;
  }
  return 2 * alike > pairs;
}

/// Throws if a number cannot be represented by a double, which the viewer uses.
template <class T>
void check_exact(const std::vector<T>& values, const fs::path& path) {
  constexpr std::int64_t most = std::int64_t{1} << 53U;
  for (const T value : values) {
    if (std::cmp_less_equal(value, most) && std::cmp_greater_equal(value, -most)) continue;
    throw FileError("'" + path.string() + "' contains " + std::to_string(value) +
                    "; whole numbers beyond 2^53 are not shown, because a browser would round them");
  }
}

Json image_item(SceneBlob& blob, const fs::path& path) {
  const ImageFile file = read_image_of_any_name(path);
  warn(file.warnings);
  const VoxelImage& image = file.image;
  validate(image);
  check_size(image.grid.node_count(), most_nodes, "voxels", path, "show a coarser image");
  Json item = {{"kind", "image"}, {"units", "units of the spacing"}};
  item["grid"] = grid_json(image.grid);
  item["bounds"] = to_json(bounds(image.grid));
  std::visit(
      [&]<class T>(const std::vector<T>& values) {
        item["labels"] = are_labels(values, image.grid.size[0]);
        if constexpr (sizeof(T) == 8) {
          if constexpr (std::is_integral_v<T>) check_exact(values, path);
          item["values"] = blob.add(std::vector<double>(values.begin(), values.end()));
        } else {
          item["values"] = blob.add(values);
        }
        item["range"] = range_of(values);
      },
      image.values);
  item["facts"] = grid_facts(image.grid);
  item["facts"].push_back(fact("type", type_name(image.values)));
  item["facts"].push_back(fact("values", range_text(item["range"])));
  if (!image.space.empty()) item["facts"].push_back(fact("world axes", image.space));
  return item;
}

/// Returns true if a file contains the sites of a field (OUT.site.nrrd). It is shown as an image of labels.
bool is_site_file(const fs::path& path) {
  return file_extension(path) == ".nrrd" && file_extension(path.stem()) == ".site";
}

Json item_of(SceneBlob& blob, const fs::path& path, std::optional<double> weld, const Context& context) {
  if (holds_surface_map(path)) return map_item(blob, path);
  if (holds_complex(path)) return complex_item(blob, path, context);
  switch (is_site_file(path) ? InputKind::image : input_kind(path)) {
    case InputKind::mesh:
      return mesh_item(blob, path, read_mesh_of_any_name(path, {weld}).mesh);
    case InputKind::image:
      return image_item(blob, path);
    case InputKind::field:
      return field_item(blob, path);
  }
  return {};
}

}  // namespace

Scene make_scene(const std::vector<fs::path>& files, std::optional<double> weld, bool compresses,
                 const Context& context) {
  Scene scene{{}, SceneBlob(compresses), {}};
  Json items = Json::array();
  for (const fs::path& path : files) {
    std::string message;
    try {
      Json item = item_of(scene.blob, path, weld, context);
      check_extent(item, "'" + path.string() + "'");
      item["name"] = path.filename().string();
      items.push_back(std::move(item));
      continue;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::bad_alloc&) {
      message = "'" + path.string() + "': not enough memory";
    } catch (const std::exception& error) {
      message = error.what();
      if (message.find("'pairs of primitives'") != std::string::npos) {
        message +=
            "; pairs are shown with the frames of a moving object: `blum proximity QUERY FRAME... --frames --self -o "
            "PAIRS.json`, then `blum view FRAME... --frames --pairs PAIRS.json`";
      } else if (message.find("the metadata state the content '") != std::string::npos) {
        message +=
            "; `blum view` shows meshes, images, fields, medial axes and extended ones, Voronoi diagrams, centrelines, "
            "points and surface maps";
      }
    }
    scene.problems.push_back(message);
    items.push_back({{"kind", "error"}, {"name", path.filename().string()}, {"message", message}});
  }
  scene.header = scene_header(scene.blob, std::move(items));
  return scene;
}

}  // namespace blum::cli
