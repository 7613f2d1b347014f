#include "view/axis_item.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "blum/complex/homology.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::cli {
namespace {

constexpr float always = std::numeric_limits<float>::infinity();

/// Adds `count` rows of numbers. get(row, component) returns each number.
template <class T, class Get>
Json column(SceneBlob& blob, std::size_t count, std::size_t components, Get get) {
  std::vector<T> values;
  values.reserve(count * components);
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t c = 0; c < components; ++c) values.push_back(static_cast<T>(get(row, c)));
  }
  return blob.add(values);
}

Json add_vertices(SceneBlob& blob, const MedialView& axis, const MedialFile& file) {
  const std::size_t count = axis.positions.size();
  Json json;
  json["positions"] =
      column<double>(blob, count, 3, [&](std::size_t v, std::size_t c) { return axis.positions[v][c]; });
  json["roles"] = column<std::uint8_t>(blob, count, 1, [&](std::size_t v, std::size_t) { return axis.role(v); });
  if (file.has_radii) {
    json["radii"] = column<double>(blob, count, 1, [&](std::size_t v, std::size_t) { return axis.radius[v]; });
  }
  if (file.has_angles) {
    json["angles"] =
        column<double>(blob, count, 1, [&](std::size_t v, std::size_t) { return axis.separation_angle[v]; });
  }
  if (file.has_footprints) {
    json["footprints"] =
        column<double>(blob, count, 6, [&](std::size_t v, std::size_t c) { return axis.footprint(v, c / 3)[c % 3]; });
  }
  if (file.has_sites) {
    json["sites"] =
        column<std::int32_t>(blob, count, 2, [&](std::size_t v, std::size_t c) { return axis.site(v, c).to_file(); });
  }
  return json;
}

/// Adds the cells of an axis to a scene. @param levels set only for an axis of all angles.
void add_cells(SceneBlob& blob, const MedialView& axis, const std::optional<MedialLevels>& levels, Json& json) {
  const std::size_t edges = axis.edges.size();
  const std::size_t triangles = axis.triangles.size();
  json["edges"] = column<std::uint32_t>(blob, edges, 2, [&](std::size_t e, std::size_t c) { return axis.edges[e][c]; });
  json["edge_roles"] =
      column<std::uint8_t>(blob, edges, 1, [&](std::size_t e, std::size_t) { return axis.edge_role(e); });
  json["edge_angles"] = column<float>(blob, edges, 1, [&](std::size_t e, std::size_t) { return axis.edge_angle[e]; });
  json["edge_from"] =
      column<float>(blob, edges, 1, [&](std::size_t e, std::size_t) { return levels ? levels->edge_from[e] : 0; });
  json["edge_until"] = column<float>(
      blob, edges, 1, [&](std::size_t e, std::size_t) { return levels ? levels->edge_until[e] : always; });
  json["triangles"] =
      column<std::uint32_t>(blob, triangles, 3, [&](std::size_t t, std::size_t c) { return axis.triangles[t][c]; });
  json["triangle_angles"] =
      column<float>(blob, triangles, 1, [&](std::size_t t, std::size_t) { return axis.triangle_angle[t]; });
  json["triangle_until"] = column<float>(
      blob, triangles, 1, [&](std::size_t t, std::size_t) { return levels ? levels->triangle_until[t] : always; });
  json["sheets"] = column<std::int32_t>(blob, triangles, 1, [&](std::size_t t, std::size_t) { return axis.sheet[t]; });
}

void add_facts(Json& item, const ShownAxis& shown, const BettiNumbers& betti) {
  const MedialFile& file = shown.file;
  const MedialMetadata& m = file.metadata;
  item["content"] = shown.content;
  Json facts = Json::array();
  const auto add = [&](const char* label, const std::string& text) { facts.push_back(Json::array({label, text})); };
  if (!shown.is_axis) add("content", shown.content);
  add(cells_label(shown), cells_text(shown));
  add("topology", betti_text(betti));
  if (!shown.certified.empty()) add("certified", shown.certified);
  if (file.has_radii && !file.complex.positions.empty()) {
    const MedialView axis(file.complex);
    const auto [least, most] = std::minmax_element(axis.radius.begin(), axis.radius.end());
    add("radii", rounded_text(*least) + " to " + rounded_text(*most));
  }
  if (!m.source.empty()) add("of", m.source + (m.solid_rule.empty() ? "" : ", as " + m.solid_rule));
  if (m.theta) add("theta", rounded_text(*m.theta) + " degrees");
  if (m.lambda && *m.lambda > 0) add("lambda", rounded_text(*m.lambda));
  if (m.spacing) add("voxels", "of side " + rounded_text(*m.spacing));
  if (file.nested) add("angles", angles_text(file.least_theta));
  item["facts"] = facts;
}

}  // namespace

Json axis_item(SceneBlob& blob, const ShownAxis& read, const Context& context) {
  const MedialFile& file = read.file;
  Box3 box;
  for (const Vec3d& position : file.complex.positions) box.extend(position);
  Json item = {{"kind", "axis"}, {"units", "mesh units"}};
  if (file.metadata.site_ids == SiteIds::voxels) item["units"] = "units of the spacing";
  item["site_ids"] = to_string(file.metadata.site_ids);
  item["has_labels"] = file.has_labels;
  item["theta"] = file.metadata.theta ? Json(*file.metadata.theta) : Json(nullptr);
  const BettiNumbers betti = homology(file.complex.view(), context);
  item["betti"] = to_json(betti);
  add_facts(item, read, betti);
  // In a file with the axes of all angles, `complex` is the axis of the smallest angle, with coincident vertices
  // merged.
  const Complex& shown = file.nested ? *file.nested : file.complex;
  const MedialView axis(shown);
  item["vertices"] = add_vertices(blob, axis, file);
  std::optional<MedialLevels> levels;
  if (file.nested) {
    levels.emplace(shown);
    item["least_theta"] = file.least_theta;
    item["vertex_until"] = blob.add(levels->vertex_until);
    for (const Vec3d& position : shown.positions) box.extend(position);
  }
  add_cells(blob, axis, levels, item);
  item["bounds"] = to_json(box);
  return item;
}

}  // namespace blum::cli
