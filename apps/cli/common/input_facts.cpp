#include "common/input_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "blum/grid/image_values.hpp"
#include "common/files.hpp"

namespace blum::cli {

Json file_json(const std::filesystem::path& path, const MeshFile& file) {
  return {{"path", path.string()},
          {"kind", "mesh"},
          {"format", file.info.format.name()},
          {"binary", file.info.binary},
          {"file_vertices", file.info.vertices},
          {"file_faces", file.info.faces},
          {"polygons", file.info.polygons},
          {"fan_polygons", file.info.fan_polygons},
          {"welded", file.info.welded},
          {"merged_vertices", file.info.merged_vertices},
          {"vertices", file.mesh.vertices.size()},
          {"triangles", file.mesh.triangles.size()},
          {"segments", file.mesh.segments.size()},
          {"points", file.mesh.points.size()},
          {"bounds", to_json(bounds(file.mesh))}};
}

std::string file_text(const MeshFile& file) {
  std::string text = file.info.format.name() + (file.info.binary ? " (binary)" : " (text)") + ", " +
                     plural(file.info.vertices, "vertex", "vertices") + ", " + plural(file.info.faces, "face", "faces");
  if (file.info.polygons > 0) text += ", " + count_text(file.info.polygons) + " of them with more than 3 corners";
  if (file.info.fan_polygons > 0) text += ", " + count_text(file.info.fan_polygons) + " not simple";
  if (file.info.welded) text += "; welding removed " + plural(file.info.merged_vertices, "vertex", "vertices");
  return text;
}

bool is_welded_away(const MeshFile& file) {
  return file.info.welded && file.info.faces > 0 && file.mesh.triangles.empty();
}

std::string welded_away_text(const MeshFile& file) {
  return "welding removed all triangles of " + plural(file.info.faces, "face", "faces") +
         "; give --weld a tolerance below " + "the edge lengths of the mesh";
}

Json mesh_json(const std::filesystem::path& path, const MeshFile& file, const SiteTable& sites,
               const Orientation& facts) {
  Json json = file_json(path, file);
  json["edges"] = sites.edge_count();
  json["components"] = facts.components;
  json["closed"] = facts.closed;
  json["oriented"] = facts.oriented;
  json["faces_outwards"] = facts.outward;
  json["boundary_edges"] = facts.boundary_edges;
  json["nonmanifold_edges"] = facts.nonmanifold_edges;
  json["inconsistent_edges"] = facts.inconsistent_edges;
  return json;
}

TextTable mesh_table(const std::filesystem::path& path, const MeshFile& file, const SiteTable& sites,
                     const Orientation& facts) {
  TextTable table;
  std::string mesh = path.string() + ": " + plural(file.mesh.vertices.size(), "vertex", "vertices") + ", " +
                     plural(file.mesh.triangles.size(), "triangle", "triangles");
  if (!file.mesh.segments.empty()) mesh += ", " + plural(file.mesh.segments.size(), "segment", "segments");
  if (!file.mesh.points.empty()) mesh += ", " + plural(file.mesh.points.size(), "point", "points");
  if (!file.mesh.triangles.empty()) {
    mesh +=
        "; " + plural(facts.components, "component", "components") + ", " + (facts.closed ? "closed" : "not closed");
  }
  table.add("input", mesh);
  table.detail("file", file_text(file) + "; " + plural(sites.edge_count(), "edge", "edges"));
  return table;
}

void round_labels(ImageFile& file, std::span<const std::int64_t> labels, const Context& context) {
  auto rounded = rounded_labels(file.image, labels, context);
  if (!rounded) return;
  file.image.values = std::move(rounded->values);
  file.warnings.push_back(std::move(rounded->warning));
}

bool has_only_nan(const VoxelImage& image) {
  return std::visit(
      [](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_floating_point_v<Value>) {
          return !values.empty() && std::all_of(values.begin(), values.end(), [](Value v) { return std::isnan(v); });
        } else {
          return false;
        }
      },
      image.values);
}

std::string type_name(const VoxelImage::Values& values) {
  constexpr std::array<const char*, 10> names = {"uint8", "int8",   "uint16", "int16",   "uint32",
                                                 "int32", "uint64", "int64",  "float32", "float64"};
  static_assert(std::variant_size_v<VoxelImage::Values> == names.size());
  return names.at(values.index());
}

std::string format_name(const std::optional<ImageFormat>& format) {
  return format ? std::string(format->name()) : "unknown";
}

Json image_json(const std::filesystem::path& path, const VoxelImage& image, const std::optional<ImageFormat>& format) {
  Json json = {{"path", path.string()},
               {"kind", "image"},
               {"format", format_name(format)},
               {"type", type_name(image.values)},
               {"voxels", image.grid.node_count()}};
  json["grid"] = to_json(image.grid);
  json["space"] = image.space.empty() ? Json(nullptr) : Json(image.space);
  json["bounds"] = to_json(bounds(image.grid));
  return json;
}

TextTable image_table(const std::filesystem::path& path, const VoxelImage& image,
                      const std::optional<ImageFormat>& format) {
  TextTable table;
  table.add("input", path.string() + ": " + format_name(format) + " image, " + size_text(image.grid) + " voxels of " +
                         type_name(image.values));
  return table;
}

}  // namespace blum::cli
