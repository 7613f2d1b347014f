// Blum: content of graph files (JSON, GraphML). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/axis/axis_graph.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_sites.hpp"

namespace blum::graph_files {

using Json = nlohmann::ordered_json;

template <class T>
struct ListOf : std::false_type {};
template <class T>
struct ListOf<std::vector<T>> : std::true_type {};
template <class T, std::size_t count>
struct ListOf<std::array<T, count>> : std::true_type {};

template <class T>
struct OptionalOf : std::false_type {};
template <class T>
struct OptionalOf<std::optional<T>> : std::true_type {};

/// Converts a value to JSON. Described structs become objects whose keys are the names of their members.
template <class T>
Json json_of(const T& value) {
  if constexpr (DescribedStruct<T>) {
    Json json = Json::object();
    for_each_member<T>([&](const auto& member) { json[std::string(member.name)] = json_of(member.of(value)); });
    return json;
  } else if constexpr (DescribedEnum<T>) {
    return to_string(value);
  } else if constexpr (std::same_as<T, Vec3d>) {
    return Json::array({value.x, value.y, value.z});
  } else if constexpr (ListOf<T>::value) {
    Json json = Json::array();
    for (const auto& part : value) json.push_back(json_of(part));
    return json;
  } else if constexpr (OptionalOf<T>::value) {
    return value ? json_of(*value) : Json(nullptr);
  } else {
    static_assert(std::is_arithmetic_v<T> || std::same_as<T, std::string>);
    return value;
  }
}

/// Returns the content of a file with this JSON. A number, and a list of numbers, is written on one line.
[[nodiscard]] std::string text_of(const Json& json);

/// Name and value of an attribute of a graph, node or edge.
using Attribute = std::pair<std::string, std::variant<std::int64_t, double, bool, std::string>>;
using Attributes = std::vector<Attribute>;

/// Adds attributes for the members of a struct that are numbers, enumerations or truth values. For members of a nested
/// struct, the name is that of the struct, '_' and that of the member. An optional struct without a value adds none.
template <DescribedStruct T>
void add_members(const T& whole, Attributes& out, const std::string& prefix = {}) {
  for_each_member<T>([&](const auto& member) {
    const auto& value = member.of(whole);
    using Value = std::remove_cvref_t<decltype(value)>;
    const std::string name = prefix + std::string(member.name);
    if constexpr (DescribedStruct<Value>) {
      add_members(value, out, name + "_");
    } else if constexpr (OptionalOf<Value>::value) {
      if constexpr (DescribedStruct<typename Value::value_type>) {
        if (value) add_members(*value, out, name + "_");
      }
    } else if constexpr (DescribedEnum<Value>) {
      out.emplace_back(name, std::string(to_string(value)));
    } else if constexpr (std::same_as<Value, Vec3d>) {
      for (std::size_t axis = 0; axis < 3; ++axis) out.emplace_back(name + "_" + "xyz"[axis], value[axis]);
    } else if constexpr (std::same_as<Value, bool> || std::floating_point<Value>) {
      out.emplace_back(name, value);
    } else if constexpr (std::integral<Value>) {
      out.emplace_back(name, static_cast<std::int64_t>(value));
    }
  });
}

/// Undirected graph for GraphML. A node's id consists of the name of its kind and a number.
struct FlatGraph {
  struct Node {
    std::string name;
    Attributes attributes;
  };
  struct Edge {
    std::string from, to;
    Attributes attributes;
  };

  std::vector<Node> nodes;
  std::vector<Edge> edges;

  static std::string numbered(const char* element, std::size_t number) { return element + std::to_string(number); }

  /// Adds a node whose attributes are the members of `part`.
  template <class T>
  void add_node(const char* element, std::size_t number, const T& part) {
    Attributes attributes{{"element", std::string(element)}};
    add_members(part, attributes);
    nodes.push_back({numbered(element, number), std::move(attributes)});
  }
  template <class T>
  void add_nodes(const char* element, const std::vector<T>& parts) {
    for (std::size_t k = 0; k < parts.size(); ++k) add_node(element, k, parts[k]);
  }
  void add_incidence(std::string from, std::string to) {
    edges.push_back({std::move(from), std::move(to), {{"element", std::string("incidence")}}});
  }
};

/// Returns the content of a GraphML file.
/// @param whole  attributes of the graph.
[[nodiscard]] std::string graphml_text(const char* id, const Attributes& whole, const FlatGraph& graph);

/// Returns the metadata of the axis of a graph as attributes. Unknown values are omitted.
[[nodiscard]] Attributes attributes_of(const MedialMetadata& metadata);

/// Each of the following functions returns the content of a file.
[[nodiscard]] std::string json_text(const AxisGraph& graph, const MedialMetadata& metadata);
[[nodiscard]] std::string graphml_text(const AxisGraph& graph, const MedialMetadata& metadata);
[[nodiscard]] std::string json_text(const VoronoiGraph& graph, std::span<const VoronoiSite> sites,
                                    const FileMetadata& metadata);
[[nodiscard]] std::string graphml_text(const VoronoiGraph& graph, std::span<const VoronoiSite> sites,
                                       const FileMetadata& metadata);

}  // namespace blum::graph_files
