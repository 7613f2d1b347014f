// Blum: columns and the properties that they are in PLY files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "blum/complex/columns.hpp"
#include "io/text/ply.hpp"

namespace blum::complex_files {

/// Vertices have the numbers of the column `radius` again in this property, by which MeshLab colours, unless they have
/// a column of that name, which a comment then tells of.
inline constexpr std::string_view derived_property = "quality";
inline constexpr std::string_view derived_from = "radius";

/// The most properties of an element, and those of them at most that are no columns.
inline constexpr std::size_t max_ply_properties = 100'000;
inline constexpr std::size_t max_known_properties = 4;

/// Consecutive properties of an element that are one column.
struct PlyColumn {
  std::string name;
  std::size_t first = 0;       ///< property
  std::size_t components = 1;  ///< properties
};

/// The properties of columns, for writing.
struct PlyNames {
  std::vector<std::string> properties;  ///< of all columns, one after the other
  std::string comments;                 ///< lines without which readers would see other columns
};

/// @param element   as in the comments: "vertex", "face" or "edge".
/// @param reserved  properties that the element has besides.
[[nodiscard]] PlyNames property_names(const Columns& columns, std::string_view element,
                                      const std::vector<std::string>& reserved);

/// The columns that properties are, for reading: what comments say; else NAME_x, NAME_y, NAME_z of one type are one
/// column, and others one each. Comments that do not fit the properties are passed over.
/// @param properties  must not be lists.
[[nodiscard]] std::vector<PlyColumn> find_columns(const std::vector<PlyProperty>& properties, std::string_view element,
                                                  const std::vector<std::string>& comments);

/// Whether a comment tells of this property.
[[nodiscard]] bool is_told_of(std::string_view property, std::string_view element,
                              const std::vector<std::string>& comments);

}  // namespace blum::complex_files
