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
/// Returns the metadata in pairs of keys and values.
/// @throws FormatError with `name` if a known key has an invalid value.
[[nodiscard]] MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name);

/// Flags of the medial axis columns that a complex contained.
struct MedialColumns {
  bool radii = false, footprints = false, sites = false;
  bool angles = false;  ///< of vertices, edges and triangles
  bool labels = false;  ///< sheets and roles
};

// Both functions give the columns of MedialView (MedialLevels) in the complex of a file their order and types. They
// convert any numeric type that can hold the values; other columns follow. Both throw FormatError with `name` for a
// column that cannot belong to an axis.

/// Returns the complex of an axis. Missing columns of vertices, edges or triangles stay missing, unless the complex has
/// no elements of that kind. If edges have no roles, those that are sides of triangles are removed.
[[nodiscard]] Complex to_axis(Complex complex, const std::string& name, MedialColumns& found);
/// Returns the complex of nested axes. All columns must exist.
[[nodiscard]] Complex to_nested(const Complex& complex, const std::string& name);

/// Removes edges that are sides of triangles, because the triangles imply them.
[[nodiscard]] Complex without_sides(Complex complex);

}  // namespace blum::medial_files
