#include "blum/proximity/first_contact.hpp"

#include <string>

#include "common/options.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

std::string edge_text(const Segment& edge, const std::string& name) {
  return "edge " + std::to_string(edge[0]) + " " + std::to_string(edge[1]) + " of " + name;
}

std::string vertex_text(const VertexFaceCollision& pair, const std::string& of_vertex, const std::string& of_face) {
  return "vertex " + std::to_string(pair.vertex) + " of " + of_vertex + ", face " + std::to_string(pair.face.value) +
         " of " + of_face;
}

Json edge_json(const Segment& edge) {
  return {edge[0], edge[1]};
}

}  // namespace

std::string contact_text(const std::optional<FirstContact>& contact, const std::vector<std::string>& names) {
  if (!contact) return "none";
  const std::string& first = names[contact->first.value];
  const std::string& second = names[contact->second.value];
  std::string text = "at time " + rounded_text(contact->time()) + ": ";
  if (contact->kind == ContactKind::edge_edge) {
    const auto& pair = std::get<EdgeEdgeCollision>(contact->features);
    return text + edge_text(pair.first, first) + ", " + edge_text(pair.second, second);
  }
  const auto& pair = std::get<VertexFaceCollision>(contact->features);
  return text + (contact->kind == ContactKind::vertex_face ? vertex_text(pair, first, second)
                                                           : vertex_text(pair, second, first));
}

Json contact_json(const std::optional<FirstContact>& contact) {
  if (!contact) return nullptr;
  Json json{{"time", contact->time()},
            {"object", {contact->first.value, contact->second.value}},
            {"kind", std::string(to_string(contact->kind))}};
  if (contact->kind == ContactKind::edge_edge) {
    const auto& pair = std::get<EdgeEdgeCollision>(contact->features);
    json["edges"] = Json::array({edge_json(pair.first), edge_json(pair.second)});
  } else {
    const auto& pair = std::get<VertexFaceCollision>(contact->features);
    json["vertex"] = pair.vertex;
    json["face"] = pair.face.value;
  }
  return json;
}

}  // namespace blum::cli
