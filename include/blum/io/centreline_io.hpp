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
  std::string version = {};  ///< version of Blum, named by .swc files; may be empty
  std::string head = {};     ///< JSON object whose members come first in .json; empty: none
};

/// Writes centrelines. The extension selects the format.
///
///   `.json`  Everything: the members of `info.head`, then `labels`. That list holds the members of each Centreline and
///            their members, by their names.
///   `.csv`   A row for each branch. Columns: `label, branch, first_node, last_node, first_kind, last_kind, length,
///            mean_radius, min_radius, points`. The last one counts the points. Closed curves have no nodes, and the
///            kind `closed`.
///   `.swc`   A tree of points for each component, with loops cut. Columns: `number type x y z radius parent`, with
///            type 0.
///   `.vtp`, `.ply`, `.npz`  Polylines with radii: complex_of(), see write_complex().
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws FileError, Cancelled.
void write_centrelines(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& info = {},
                       const Context& context = {});

}  // namespace blum
