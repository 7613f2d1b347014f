// Blum: names of columns as properties of PLY files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "blum/complex/columns.hpp"
#include "io/text/ply.hpp"

namespace blum::complex_files {

/// Property of vertices by which MeshLab colours. It holds a copy of the first of the columns `derived_from` that the
/// vertices have. If the vertices have a column of that name, no copy is written, and a comment declares the column.
inline constexpr std::string_view derived_property = "quality";
inline constexpr std::array<std::string_view, 2> derived_from{"radius", "distance"};

/// Largest number of properties of an element; below, the largest number of those that are not columns.
inline constexpr std::size_t max_ply_properties = 100'000;
inline constexpr std::size_t max_known_properties = 4;

/// Consecutive properties of an element that form one column.
struct PlyColumn {
  std::string name;
  std::size_t first = 0;       ///< index of the first property
  std::size_t components = 1;  ///< number of properties
};

/// Properties that represent columns, for writing.
struct PlyNames {
  std::vector<std::string> properties;  ///< names of the properties of all columns, in order
  std::string comments;                 ///< comment lines; without them, readers would find other columns
};

/// Returns the properties that represent columns.
/// @param element   name of the element in the comments: "vertex", "face" or "edge".
/// @param reserved  names of other properties of the element, which columns must not use.
[[nodiscard]] PlyNames property_names(const Columns& columns, std::string_view element,
                                      const std::vector<std::string>& reserved);

/// Returns the columns that properties represent, for reading. Comments may declare columns. Otherwise three properties
/// NAME_x, NAME_y, NAME_z of one type are one column, and every other property is a column. Comments that do not fit
/// the properties are ignored.
/// @param properties  must not be lists.
[[nodiscard]] std::vector<PlyColumn> find_columns(const std::vector<PlyProperty>& properties, std::string_view element,
                                                  const std::vector<std::string>& comments);

/// Returns true if a comment declares a column that starts with this property.
[[nodiscard]] bool is_listed(std::string_view property, std::string_view element,
                             const std::vector<std::string>& comments);

}  // namespace blum::complex_files
