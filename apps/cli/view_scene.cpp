#include "view_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <set>
#include <string>
#include <utility>

#include "axis_item.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/io/field_io.hpp"
#include "colors.hpp"
#include "files.hpp"
#include "input_facts.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

/// What a browser can hold as one array, and show before anyone leaves: 512^3.
constexpr std::size_t most_nodes = std::size_t{1} << 27U;
constexpr std::size_t most_triangles = 20'000'000;

/// A place as single precision keeps it best: seen from the middle of the box.
Json add_places(SceneBlob& blob, std::span<const Vec3d> places, const Vec3d& origin) {
  std::vector<float> numbers;
  numbers.reserve(3 * places.size());
  for (const Vec3d& p : places) {
    for (std::size_t a = 0; a < 3; ++a) numbers.push_back(static_cast<float>(p[a] - origin[a]));
  }
  return blob.add(numbers);
}

template <std::size_t corners>
Json add_cells(SceneBlob& blob, const std::vector<std::array<std::uint32_t, corners>>& cells) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(corners * cells.size());
  for (const auto& cell : cells) numbers.insert(numbers.end(), cell.begin(), cell.end());
  return blob.add(numbers);
}

Json fact(const char* label, const std::string& text) {
  return Json::array({label, text});
}

void check_size(std::size_t count, std::size_t most, const char* what, const fs::path& path, const char* advice) {
  if (count <= most) return;
  throw FileError("'" + path.string() + "' has " + count_text(count) + " " + what + ", and the viewer shows at most " +
                  count_text(most) + "; " + advice);
}

Json mesh_item(SceneBlob& blob, const fs::path& path, std::optional<double> weld) {
  const MeshFile file = read_mesh_of_any_name(path, {weld});
  const TriangleMesh& mesh = file.mesh;
  validate(mesh);
  check_size(mesh.triangles.size(), most_triangles, "triangles", path, "show a coarser mesh");
  const SiteTable sites(mesh);
  const Orientation facts = orientation(mesh, sites);
  const Box3 box = bounds(mesh);
  const Vec3d origin = box.is_empty() ? Vec3d{} : box.center();
  Json item = {{"kind", "mesh"}, {"units", "mesh units"}};
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

Json grid_facts(const GridSpec& grid) {
  return Json::array({fact("size", size_text(grid)), fact("nodes", count_text(grid.node_count())),
                      fact("spacing", vector_text(grid.spacing))});
}

Json grid_json(const GridSpec& grid) {
  Json directions = Json::array();
  for (const Vec3d& column : grid.direction.columns) directions.push_back(to_json(column));
  return {{"origin", to_json(grid.origin)},
          {"spacing", to_json(grid.spacing)},
          {"size", grid.size},
          {"direction", directions}};
}

/// The smallest and the largest number; null where there is none.
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
  return range.is_null() ? "no numbers"
                         : rounded_text(range[0].get<double>()) + " to " + rounded_text(range[1].get<double>());
}

Json field_item(SceneBlob& blob, const fs::path& path) {
  const Field field = read_field(path);
  check_size(field.distance.size(), most_nodes, "nodes", path, "make a coarser field");
  const bool is_of_voxels = field.site_ids == SiteIds::voxels;
  Json item = {{"kind", "field"}, {"units", is_of_voxels ? "units of the spacing" : "mesh units"}};
  item["grid"] = grid_json(field.grid);
  item["bounds"] = to_json(bounds(field.grid));
  item["distance"] = blob.add(field.distance.span());
  if (!field.site.empty()) {
    // Ids are numbers of 32 bits: none() is -1.
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

/// Whether whole numbers name things rather than measure something: there are few of them, or neighbours are alike
/// where they are not the background.
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

/// The viewer's numbers are doubles.
template <class T>
void check_exact(const std::vector<T>& values, const fs::path& path) {
  constexpr std::int64_t most = std::int64_t{1} << 53U;
  for (const T value : values) {
    if (std::cmp_less_equal(value, most) && std::cmp_greater_equal(value, -most)) continue;
    throw FileError("'" + path.string() + "' holds " + std::to_string(value) +
                    ": whole numbers beyond 2^53 are not shown, as a browser would round them");
  }
}

Json image_item(SceneBlob& blob, const fs::path& path) {
  const VoxelImage image = read_image_of_any_name(path);
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

/// The sites of a field, as an image of labels: OUT.site.nrrd, which is no field by itself.
bool is_site_file(const fs::path& path) {
  return file_extension(path) == ".nrrd" && file_extension(path.stem()) == ".site";
}

/// Browsers draw in single precision.
void check_extent(const Json& item, const fs::path& path) {
  if (item["bounds"].is_null()) return;
  double extent = 0;
  double farthest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto lower = item["bounds"]["lower"][a].get<double>();
    const auto upper = item["bounds"]["upper"][a].get<double>();
    extent = std::max(extent, upper - lower);
    farthest = std::max({farthest, std::abs(lower), std::abs(upper)});
  }
  constexpr double least = 1e-12;
  constexpr double most = 1e30;
  if ((extent == 0 || extent >= least) && farthest <= most) return;
  throw FileError(
      "'" + path.string() + "' cannot be drawn: " +
      (farthest > most ? "it reaches to " + rounded_text(farthest) : "its longest side is " + rounded_text(extent)) +
      ", and browsers draw what is between 1e-12 and 1e30; scale it");
}

Json item_of(SceneBlob& blob, const fs::path& path, std::optional<double> weld, const Context& context) {
  if (holds_complex(path)) return axis_item(blob, path, context);
  switch (is_site_file(path) ? InputKind::image : input_kind(path)) {
    case InputKind::mesh:
      return mesh_item(blob, path, weld);
    case InputKind::image:
      return image_item(blob, path);
    case InputKind::field:
      return field_item(blob, path);
  }
  return {};
}

/// A table of colours: red, green, blue and opacity in a byte each, as textures want them.
template <class ColorAt>
Json add_colors(SceneBlob& blob, std::uint32_t count, ColorAt color_at) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(std::size_t{4} * count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Color color = color_at(i);
    for (const float component : {color.r, color.g, color.b, 1.0F}) bytes.push_back(byte_of(component));
  }
  return blob.add(bytes);
}

/// The colours of the tool's pictures. Ramps run to 1, from -1 where they diverge.
Json colors_json(SceneBlob& blob) {
  constexpr std::uint32_t ramp_colors = 512;
  constexpr std::uint32_t legend_regions = 12;
  const auto add_ramp = [&](Color (*color_of)(double), double from) {
    const double step = (1 - from) / (ramp_colors - 1);
    return add_colors(blob, ramp_colors, [&](std::uint32_t i) { return color_of(from + step * i); });
  };
  return {{"diverging", add_ramp(diverging_color, -1)},
          {"sequential", add_ramp(sequential_color, 0)},
          {"palette", add_colors(blob, palette_rows * palette_hues, palette_color)},
          {"regions", add_colors(blob, legend_regions, region_color)}};
}

Json roles_json() {
  Json roles = Json::object();
  for (const auto& [role, name] : Description<MedialRole>::values) roles[std::string(name)] = role;
  return roles;
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
      check_extent(item, path);
      item["name"] = path.filename().string();
      items.push_back(std::move(item));
      continue;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::bad_alloc&) {
      message = "'" + path.string() + "': not enough memory";
    } catch (const std::exception& error) {
      message = error.what();
    }
    scene.problems.push_back(message);
    items.push_back({{"kind", "error"}, {"name", path.filename().string()}, {"message", message}});
  }
  scene.header = {
      {"blum", BLUM_VERSION}, {"items", items}, {"colors", colors_json(scene.blob)}, {"roles", roles_json()}};
  return scene;
}

}  // namespace blum::cli
