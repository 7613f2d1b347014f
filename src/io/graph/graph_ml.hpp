// Blum: graphs of described parts as GraphML. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum::graph_files {

/// A named value of a graph, a node or an edge.
using Attribute = std::pair<std::string, std::variant<std::int64_t, double, bool, std::string>>;
using Attributes = std::vector<Attribute>;

/// The members of a struct that are numbers, words or truths, as attributes; of those within others with both names.
template <DescribedStruct T>
void add_members(const T& whole, Attributes& out, const std::string& prefix = {}) {
  for_each_member<T>([&](const auto& member) {
    const auto& value = member.of(whole);
    using Value = std::remove_cvref_t<decltype(value)>;
    const std::string name = prefix + std::string(member.name);
    if constexpr (DescribedStruct<Value>) {
      add_members(value, out, name + "_");
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

/// Undirected; nodes are named by their element and a number.
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

  /// A node with the members of what it stands for.
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

/// The whole content of a file. @param whole  the attributes of the graph.
[[nodiscard]] std::string graphml_text(const char* id, const Attributes& whole, const FlatGraph& graph);

}  // namespace blum::graph_files
