// Blum: files of centrelines (JSON, CSV, SWC, VTP, PLY, NPZ). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/medial_axis/centreline.hpp"

namespace blum {

/// What a file of centrelines says besides.
struct CentrelineFileInfo {
  std::string version = {};  ///< of Blum, which .swc files name; may be empty
  std::string head = {};     ///< a JSON object whose members come first in .json; empty: none
};

/// Writes centrelines; the format goes by the extension.
///
///   .json  all of it: the members of `info.head`, and `labels`, the members of Centreline and what they consist of,
///          by their names.
///   .csv   a row for each branch: label, branch, first_node, last_node, first_kind, last_kind, length, mean_radius,
///          min_radius, points (how many there are). Closed curves have no nodes, and the kind `closed`.
///   .swc   a tree of points for each component, where loops are cut: number, type 0, x, y, z, radius, parent.
///   .vtp, .ply, .npz  polylines with radii: complex_of(), see write_complex().
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension; FileError; Cancelled.
void write_centrelines(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& info = {},
                       const Context& context = {});

}  // namespace blum
