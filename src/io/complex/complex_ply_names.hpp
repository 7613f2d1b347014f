// Blum: names of columns as properties of PLY files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "blum/complex/columns.hpp"
#include "io/text/ply.hpp"

namespace blum::complex_files {

/// Vertices repeat the numbers of the column `radius` in this property, by which MeshLab colours. If they have a column
/// of that name, there is no copy, and a comment declares the column.
inline constexpr std::string_view derived_property = "quality";
inline constexpr std::string_view derived_from = "radius";

/// Largest number of properties of an element, and largest number of those that are not columns.
inline constexpr std::size_t max_ply_properties = 100'000;
inline constexpr std::size_t max_known_properties = 4;

/// Consecutive properties of an element that form one column.
struct PlyColumn {
  std::string name;
  std::size_t first = 0;       ///< index of the first property
  std::size_t components = 1;  ///< number of properties
};

/// Properties of columns, for writing.
struct PlyNames {
  std::vector<std::string> properties;  ///< of all columns, one after the other
  std::string comments;                 ///< lines without which readers would find other columns
};

/// Returns the properties of columns.
/// @param element   as in the comments: "vertex", "face" or "edge".
/// @param reserved  other properties of the element.
[[nodiscard]] PlyNames property_names(const Columns& columns, std::string_view element,
                                      const std::vector<std::string>& reserved);

/// Returns the columns that properties form, for reading. Comments declare columns. Without them NAME_x, NAME_y, NAME_z
/// of one type form one column, and every other property is its own column. Comments that do not fit the properties are
/// ignored.
/// @param properties  must not be lists.
[[nodiscard]] std::vector<PlyColumn> find_columns(const std::vector<PlyProperty>& properties, std::string_view element,
                                                  const std::vector<std::string>& comments);

/// Returns true if a comment declares this property.
[[nodiscard]] bool is_listed(std::string_view property, std::string_view element,
                             const std::vector<std::string>& comments);

}  // namespace blum::complex_files
