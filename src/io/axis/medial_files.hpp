// Blum: conversion of medial axes to complexes, columns and metadata of files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::medial_files {

/// Largest value of MedialMetadata::smooth.
constexpr int most_smoothing = 1000;

[[nodiscard]] FileMetadata to_pairs(const MedialMetadata& metadata);
/// Returns the metadata that pairs of keys and values contain.
/// @throws FormatError with `name` if a known key has an invalid value.
[[nodiscard]] MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name);

/// Flags of the columns of a medial axis that were found in a complex.
struct MedialColumns {
  bool radii = false, footprints = false, sites = false;
  bool angles = false;  ///< angle columns of vertices, edges and triangles
  bool labels = false;  ///< columns of sheets and roles
};

// The functions to_axis() and to_nested() convert the complex of a file. Columns that MedialView or MedialLevels
// requires get their order and types; other columns follow. Any numeric type that can represent the values is
// converted. Both functions throw FormatError with `name` if a column cannot belong to an axis.

/// Returns the complex of an axis. Columns that are missing for vertices, edges or triangles are added only if the
/// complex has no elements of that kind. If edges have no roles, edges that are sides of triangles are removed.
[[nodiscard]] Complex to_axis(Complex complex, const std::string& name, MedialColumns& found);
/// Returns the complex of nested axes (axes of all angles). All of their columns must exist.
[[nodiscard]] Complex to_nested(const Complex& complex, const std::string& name);

/// Removes edges that are sides of triangles, because the triangles imply them.
[[nodiscard]] Complex without_sides(Complex complex);

}  // namespace blum::medial_files
