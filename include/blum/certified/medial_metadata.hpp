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

/// Metadata in a file of a medial axis. Unknown members are unset or empty.
struct MedialMetadata {
  std::string source = {};   ///< Source of the solid, for example a file name.
  std::string version = {};  ///< Version of Blum; written only if the axis has all columns of MedialView.
  SiteIds site_ids = SiteIds::features;
  std::optional<double> theta = {};    ///< Angle of the axis, degrees.
  std::optional<double> lambda = {};   ///< MedialAxisOptions::lambda, mesh units.
  std::optional<double> spacing = {};  ///< Smallest side of a voxel, mesh units.
  /// DecimatedAxis::deviation, >= 0, mesh units; unset if no vertices were removed.
  std::optional<double> deviation = {};
  /// True if borders were fitted to the surface (MedialAxis::fitted(), lean()). If true, certificates judge the ends of
  /// the axis in parts thinner than a voxel by the radius in these parts.
  bool fitted = false;
  /// Rule of the solid to which the topology refers: "polyhedron", "winding" or "voxels" (SolidRule).
  std::string solid_rule = {};
  /// Grid of the voxel centres. Needed if the rule is SolidRule::winding, because the solid then consists of voxels.
  std::optional<GridSpec> grid = {};
  // Selection of the solid in its file. In an image, `label` or `threshold` selects the voxels; at most one of the two
  // is set. If neither is set, all voxels that are not 0 are selected. `weld` is used for meshes.
  std::optional<std::int64_t> label = {};  ///< Voxels of this value.
  std::optional<double> threshold = {};    ///< Voxels of this value or more, in image values.
  std::optional<double> weld = {};  ///< MeshReadOptions::weld, >= 0, mesh units; unset: the default of the format.
  /// Images: SmoothSurfaceOptions::iterations of the smooth surface that bounds the solid. If unset, the solid is the
  /// union of the boxes of the selected voxels.
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
      Member{"lambda", &MedialMetadata::lambda, "mesh units", "option lambda of the axis"},
      Member{"spacing", &MedialMetadata::spacing, "mesh units", "smallest side of a voxel"},
      Member{"deviation", &MedialMetadata::deviation, "mesh units", "largest distance from the axis with all vertices"},
      Member{"fitted", &MedialMetadata::fitted, "", "true if borders were fitted to the surface"},
      Member{"solid_rule", &MedialMetadata::solid_rule, "", "rule that defines the solid of the axis"},
      Member{"grid", &MedialMetadata::grid, "", "grid of voxel centres"},
      Member{"label", &MedialMetadata::label, "", "label of the voxels of an image that are selected"},
      Member{"threshold", &MedialMetadata::threshold, "", "smallest value of the voxels of an image that are selected"},
      Member{"weld", &MedialMetadata::weld, "mesh units", "tolerance with which the vertices of a mesh were merged"},
      Member{"smooth", &MedialMetadata::smooth, "",
             "rounds of smoothing, if the axis is that of the smooth surface of an image"},
  };
};

}  // namespace blum
