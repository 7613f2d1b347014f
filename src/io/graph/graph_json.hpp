// Blum: graphs of described parts as JSON. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum::graph_files {

using Json = nlohmann::ordered_json;

template <class T>
struct ListOf : std::false_type {};
template <class T>
struct ListOf<std::vector<T>> : std::true_type {};
template <class T, std::size_t count>
struct ListOf<std::array<T, count>> : std::true_type {};

/// Described structs by the names of their members, and what these consist of.
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
  } else if constexpr (requires { value.has_value(); }) {
    return value ? json_of(*value) : Json(nullptr);
  } else {
    static_assert(std::is_arithmetic_v<T> || std::same_as<T, std::string>);
    return value;
  }
}

/// The whole content of a file, with numbers and lists of them in one line.
[[nodiscard]] std::string text_of(const Json& json);

}  // namespace blum::graph_files
