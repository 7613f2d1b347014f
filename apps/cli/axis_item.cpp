#include "axis_item.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "blum/io/medial_io.hpp"
#include "medial_report.hpp"

namespace blum::cli {
namespace {

constexpr float always = std::numeric_limits<float>::infinity();

/// A column of numbers: get(item, component) for each item.
template <class T, class Item, class Get>
Json column(SceneBlob& blob, const std::vector<Item>& items, std::size_t components, Get get) {
  std::vector<T> values;
  values.reserve(items.size() * components);
  for (const Item& item : items) {
    for (std::size_t c = 0; c < components; ++c) values.push_back(static_cast<T>(get(item, c)));
  }
  return blob.add(values);
}

Json add_vertices(SceneBlob& blob, const std::vector<MedialVertex>& vertices, const MedialFile& file) {
  using V = MedialVertex;
  Json json;
  json["positions"] = column<double>(blob, vertices, 3, [](const V& v, std::size_t c) { return v.position[c]; });
  json["roles"] = column<std::uint8_t>(blob, vertices, 1, [](const V& v, std::size_t) { return v.role; });
  if (file.has_radii) {
    json["radii"] = column<double>(blob, vertices, 1, [](const V& v, std::size_t) { return v.radius; });
  }
  if (file.has_angles) {
    json["angles"] = column<double>(blob, vertices, 1, [](const V& v, std::size_t) { return v.separation_angle; });
  }
  if (file.has_footprints) {
    json["footprints"] =
        column<double>(blob, vertices, 6, [](const V& v, std::size_t c) { return v.footprints[c / 3][c % 3]; });
  }
  if (file.has_sites) {
    json["sites"] =
        column<std::int32_t>(blob, vertices, 2, [](const V& v, std::size_t c) { return v.sites[c].to_file(); });
  }
  return json;
}

float from_of(const MedialEdge&) {
  return 0;
}
float until_of(const MedialEdge&) {
  return always;
}
float until_of(const MedialTriangle&) {
  return always;
}
float from_of(const NestedEdge& edge) {
  return edge.from;
}
float until_of(const NestedEdge& edge) {
  return edge.until;
}
float until_of(const NestedTriangle& triangle) {
  return triangle.until;
}

/// The cells of an axis of one angle or of all.
template <class E, class T>
void add_cells(SceneBlob& blob, const std::vector<E>& edges, const std::vector<T>& triangles, Json& json) {
  json["edges"] = column<std::uint32_t>(blob, edges, 2, [](const E& e, std::size_t c) { return e.vertices[c]; });
  json["edge_roles"] = column<std::uint8_t>(blob, edges, 1, [](const E& e, std::size_t) { return e.role; });
  json["edge_angles"] = column<float>(blob, edges, 1, [](const E& e, std::size_t) { return e.separation_angle; });
  json["edge_from"] = column<float>(blob, edges, 1, [](const E& e, std::size_t) { return from_of(e); });
  json["edge_until"] = column<float>(blob, edges, 1, [](const E& e, std::size_t) { return until_of(e); });
  json["triangles"] =
      column<std::uint32_t>(blob, triangles, 3, [](const T& t, std::size_t c) { return t.vertices[c]; });
  json["triangle_angles"] =
      column<float>(blob, triangles, 1, [](const T& t, std::size_t) { return t.separation_angle; });
  json["triangle_until"] = column<float>(blob, triangles, 1, [](const T& t, std::size_t) { return until_of(t); });
  json["sheets"] = column<std::int32_t>(blob, triangles, 1, [](const T& t, std::size_t) { return t.sheet; });
}

void add_facts(Json& item, const MedialFile& file, const BettiNumbers& betti) {
  const MedialMetadata& m = file.metadata;
  Json facts = Json::array();
  const auto add = [&](const char* label, const std::string& text) { facts.push_back(Json::array({label, text})); };
  add("axis", counts_text(count(file.complex), file.has_labels));
  add("topology", betti_text(betti));
  if (file.has_radii && !file.complex.vertices.empty()) {
    const auto [least, most] =
        std::minmax_element(file.complex.vertices.begin(), file.complex.vertices.end(),
                            [](const MedialVertex& a, const MedialVertex& b) { return a.radius < b.radius; });
    add("radii", rounded_text(least->radius) + " to " + rounded_text(most->radius));
  }
  if (!m.source.empty()) add("of", m.source + (m.solid_rule.empty() ? "" : ", as " + m.solid_rule));
  if (m.theta) add("theta", rounded_text(*m.theta) + " degrees");
  if (m.lambda && *m.lambda > 0) add("lambda", rounded_text(*m.lambda));
  if (m.spacing) add("voxels", "of side " + rounded_text(*m.spacing));
  if (file.nested) add("angles", angles_text(*file.nested));
  item["facts"] = facts;
}

}  // namespace

Json axis_item(SceneBlob& blob, const std::filesystem::path& path, const Context& context) {
  const MedialFile file = read_medial(path);
  Box3 box;
  for (const MedialVertex& v : file.complex.vertices) box.extend(v.position);
  Json item = {{"kind", "axis"}, {"units", "mesh units"}};
  if (file.metadata.site_ids == SiteIds::voxels) item["units"] = "units of the spacing";
  item["site_ids"] = to_string(file.metadata.site_ids);
  item["has_labels"] = file.has_labels;
  item["theta"] = file.metadata.theta ? Json(*file.metadata.theta) : Json(nullptr);
  const BettiNumbers betti = betti_of(file.complex, context);
  item["betti"] = to_json(betti);
  add_facts(item, file, betti);
  if (!file.nested) {
    item["vertices"] = add_vertices(blob, file.complex.vertices, file);
    add_cells(blob, file.complex.edges, file.complex.triangles, item);
  } else {
    // The complex of the file is that of the least angle, but for vertices that are at the same place.
    const NestedComplex& nested = *file.nested;
    item["least_theta"] = nested.least_theta;
    item["vertices"] = add_vertices(blob, nested.vertices, file);
    item["vertex_until"] = blob.add(nested.vertex_until);
    add_cells(blob, nested.edges, nested.triangles, item);
    for (const MedialVertex& v : nested.vertices) box.extend(v.position);
  }
  item["bounds"] = to_json(box);
  return item;
}

}  // namespace blum::cli
