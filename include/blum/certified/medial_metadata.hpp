// Blum: metadata of a medial axis besides its complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "blum/core/describe.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

/// Metadata in a file of a medial axis; unknown members are unset.
struct MedialMetadata {
  std::string source = {};   ///< Source of the solid, for example a file name.
  std::string version = {};  ///< Version of Blum; written if the axis has all columns of MedialView.
  SiteIds site_ids = SiteIds::features;
  std::optional<double> theta = {};    ///< Degrees.
  std::optional<double> lambda = {};   ///< Mesh units.
  std::optional<double> spacing = {};  ///< Smallest side of a voxel, mesh units.
  /// DecimatedAxis::deviation, >= 0, mesh units; unset if no vertices were removed.
  std::optional<double> deviation = {};
  /// Rule of the solid to which the topology refers: "polyhedron", "winding" or "voxels" (SolidRule).
  std::string solid_rule = {};
  std::optional<GridSpec> grid = {};  ///< Voxel centres. Needed for SolidRule::winding, which knows only voxels.
  // Selection in the file of the solid. At most one of two rules selects the voxels of an image (neither: all that are
  // not 0). `weld` is for meshes.
  std::optional<std::int64_t> label = {};  ///< Voxels of this value.
  std::optional<double> threshold = {};    ///< Voxels of this value or more, in image values.
  std::optional<double> weld = {};  ///< MeshReadOptions::weld, >= 0, mesh units; unset: the default of the format.
  /// Images: the smooth surface of the voxels bounds the solid, with SmoothSurfaceOptions::iterations. Unset: the solid
  /// is the union of their boxes.
  std::optional<int> smooth = {};
};

template <>
struct Description<MedialMetadata> {
  static constexpr std::string_view name = "MedialMetadata";
  static constexpr std::string_view doc = "Metadata in a file of a medial axis";
  static constexpr std::tuple members{
      Member{"source", &MedialMetadata::source, "", "source of the solid, for example a file name"},
      Member{"version", &MedialMetadata::version, "", "version of Blum that wrote the file"},
      Member{"site_ids", &MedialMetadata::site_ids, "", "numbering of sites"},
      Member{"theta", &MedialMetadata::theta, "degrees", "angle of the axis"},
      Member{"lambda", &MedialMetadata::lambda, "mesh units", "MedialAxisOptions::lambda"},
      Member{"spacing", &MedialMetadata::spacing, "mesh units", "smallest side of a voxel"},
      Member{"deviation", &MedialMetadata::deviation, "mesh units", "largest distance from the axis with all vertices"},
      Member{"solid_rule", &MedialMetadata::solid_rule, "", "rule for the solid that the topology refers to"},
      Member{"grid", &MedialMetadata::grid, "", "grid of voxel centres"},
      Member{"label", &MedialMetadata::label, "", "label of the voxels of an image"},
      Member{"threshold", &MedialMetadata::threshold, "", "least value of the voxels of an image"},
      Member{"weld", &MedialMetadata::weld, "mesh units", "tolerance with which the vertices of a mesh were merged"},
      Member{"smooth", &MedialMetadata::smooth, "", "iterations of the smooth surface of the voxels of an image"},
  };
};

}  // namespace blum
