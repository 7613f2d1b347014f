// Blum: files of centrelines (JSON, CSV, SWC, VTP, PLY, NPZ). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/medial_axis/centreline.hpp"

namespace blum {

/// Further content of a file of centrelines.
struct CentrelineFileInfo {
  std::string version = {};  ///< version of Blum, for .swc files; may be empty
  std::string head = {};     ///< text of a JSON object, whose members are written first in .json files; may be empty
};

/// Writes centrelines. The extension selects the format.
///
///   `.json`  Everything: the members of `info.head`, then the list `labels`. Each entry of `labels` is an object with
///            the members of a Centreline, including nested members. Names of members are those in C++.
///   `.csv`   A row for each branch. Columns: `label, branch, first_node, last_node, first_kind, last_kind, length,
///            mean_radius, min_radius, points`. The last column is the number of points. Closed curves have no nodes;
///            their `first_kind` and `last_kind` are `closed`.
///   `.swc`   A tree of points for each component; loops are cut. Columns: `number type x y z radius parent`. The type
///            is 0.
///   `.vtp`, `.ply`, `.npz`  Polylines with radii: the result of complex_of(), written as by write_complex().
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws FileError, Cancelled.
void write_centrelines(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& info = {},
                       const Context& context = {});

}  // namespace blum
