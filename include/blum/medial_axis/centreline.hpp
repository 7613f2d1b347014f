// Blum: centrelines of voxel images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum {

struct CentrelineOptions {
  /// Selected voxels. By default (not zero), each value in the image is a label of its own, and all must be whole
  /// numbers.
  LabelSelection selection = {};
  /// A branch with a free end stays if its reach exceeds this many radii of the ball at its root by 1.5 voxels. At 1 a
  /// removed branch hardly leaves that ball. At 0 all longer branches stay.
  double spur = 1;
};

template <>
struct Description<CentrelineOptions> {
  static constexpr std::string_view name = "CentrelineOptions";
  static constexpr std::string_view doc = "Options of centrelines";
  static constexpr std::tuple members{
      Member{"selection", &CentrelineOptions::selection, "", "selected voxels"},
      Member{"spur", &CentrelineOptions::spur, "radii of the ball at their root",
             "shortest branch with a free end that stays; a voxel and a half is added", Range::between(0, 100)},
  };
};

enum class CentrelineNodeKind : std::uint8_t {
  point,    ///< Part without branches, for example a blob.
  end,      ///< End of one branch.
  junction  ///< End of several branches, or of one that returns to it.
};
template <>
struct Description<CentrelineNodeKind> {
  static constexpr std::string_view name = "CentrelineNodeKind";
  static constexpr std::array values{NamedValue{CentrelineNodeKind::point, "point"},
                                     NamedValue{CentrelineNodeKind::end, "end"},
                                     NamedValue{CentrelineNodeKind::junction, "junction"}};
};

struct CentrelineNode {
  CentrelineNodeKind kind = CentrelineNodeKind::point;
  Vec3d position{};   ///< World coordinates.
  double radius = 0;  ///< At an end that of its branch; otherwise the distance to the closest voxel outside.
};
template <>
struct Description<CentrelineNode> {
  static constexpr std::string_view name = "CentrelineNode";
  static constexpr std::string_view doc = "Point where branches end or meet";
  static constexpr std::tuple members{
      Member{"kind", &CentrelineNode::kind, "", "point (of a blob without branches), end or junction"},
      Member{"position", &CentrelineNode::position, "world units", "position"},
      Member{"radius", &CentrelineNode::radius, "world units",
             "end: radius of its branch there; else distance to the closest voxel outside"},
  };
};

/// Curve between two nodes, or a closed curve without nodes.
struct CentrelineBranch {
  std::array<std::int32_t, 2> nodes{-1, -1};  ///< Indices of its first and last node; -1 for closed curves.
  double length = 0;                          ///< Length of the polyline, including the nodes.
  double mean_radius = 0;                     ///< Mean along its length, outside the balls of its junctions.
  double min_radius = 0;                      ///< Least radius, likewise.
  std::vector<Vec3d> points = {};             ///< From node to node. Closed curves repeat the first point at the end.
  std::vector<double> radii = {};             ///< Radius of the circle with the area of the section, at each point.
};
template <>
struct Description<CentrelineBranch> {
  static constexpr std::string_view name = "CentrelineBranch";
  static constexpr std::string_view doc = "Curve between two nodes, or a closed curve without any";
  static constexpr std::tuple members{
      Member{"nodes", &CentrelineBranch::nodes, "", "first and last node; -1 for closed curves"},
      Member{"length", &CentrelineBranch::length, "world units", "length of its polyline"},
      Member{"mean_radius", &CentrelineBranch::mean_radius, "world units",
             "mean radius along its length, outside the balls of its junctions"},
      Member{"min_radius", &CentrelineBranch::min_radius, "world units", "smallest radius, likewise"},
      Member{"points", &CentrelineBranch::points, "world units",
             "polyline from node to node; for closed curves the first point is also the last"},
      Member{"radii", &CentrelineBranch::radii, "world units",
             "radius at each point: that of the circle with the area of the section there"},
  };
};

/// Centreline of the voxels of one label.
struct Centreline {
  std::optional<std::int64_t> label = {};  ///< Unset if a threshold selects.
  std::uint64_t voxels = 0;                ///< Number of voxels.
  std::vector<CentrelineNode> nodes = {};
  std::vector<CentrelineBranch> branches = {};
  BettiNumbers label_betti{};  ///< Components, tunnels and voids of the union of the closed voxels.
  BettiNumbers graph_betti{};  ///< Components, tunnels and voids of the nodes and branches.
  bool homotopy_kept = true;   ///< True if these are equal.
  std::string homotopy;        ///< One sentence: kept, or the difference and its reason.
};
template <>
struct Description<Centreline> {
  static constexpr std::string_view name = "Centreline";
  static constexpr std::string_view doc = "Centreline of the voxels of one label";
  static constexpr std::tuple members{
      Member{"label", &Centreline::label, "", "value of the voxels; null if a threshold selects them"},
      Member{"voxels", &Centreline::voxels, "", "number of voxels"},
      Member{"nodes", &Centreline::nodes, "", "points where branches end or meet"},
      Member{"branches", &Centreline::branches, "", "curves between nodes"},
      Member{"label_betti", &Centreline::label_betti, "", "components, tunnels, voids of the voxels"},
      Member{"graph_betti", &Centreline::graph_betti, "", "components, tunnels, voids of nodes and branches"},
      Member{"homotopy_kept", &Centreline::homotopy_kept, "", "true if both are equal"},
      Member{"homotopy", &Centreline::homotopy, "", "sentence: kept, or the difference and its reason"},
  };
};

struct Centrelines {
  std::vector<Centreline> labels;  ///< By ascending label.
  std::vector<PhaseTime> phases;
  std::vector<Warning> warnings;  ///< Result of centreline_warnings().
};

/// Returns the centreline of each label of an image, as a graph of curves.
///
/// Voxels touch in corners (26), the background by faces (6), as for betti_numbers(). Beyond the image is background.
/// Voids are filled first. Then the voxels are thinned in the order of their distance to the background. Each step
/// preserves the homotopy type. So do pruning and the merging of junctions that lie in each other's balls. Finally,
/// curves are moved to the centroids of the sections across them, no point by more than a voxel. The radius at a point
/// is that of the circle with the section's area. A free end lies where its ball touches the tip. See
/// docs/theory/centrelines.md for the method.
///
/// @param image  must pass validate(image).
/// @return  the same bytes for any number of threads. Labels without voxels have neither nodes nor branches.
/// @throws InvalidImage, also if values are labels and one is not a whole number; InvalidOption; OutOfMemory;
/// Cancelled.
/// Cost: about twice that of distance_transform(); 10 bytes per voxel of the largest box around a label.
[[nodiscard]] Centrelines centreline(const VoxelImageView& image, const CentrelineOptions& options = {},
                                     const Context& context = {});

/// Returns the centrelines of the given labels, in this order. options.selection is ignored.
[[nodiscard]] Centrelines centreline(const VoxelImageView& image, std::span<const std::int64_t> labels,
                                     const CentrelineOptions& options = {}, const Context& context = {});

/// Returns warnings about the centrelines of an image with this grid. An image may have a single layer of voxels
/// (WarningCode::single_layer). A label may have none (WarningCode::nothing_found), or another topology than its curves
/// (WarningCode::other_topology). At most six are returned; the last one counts those that are left out.
[[nodiscard]] std::vector<Warning> centreline_warnings(const Centrelines& lines, const GridSpec& grid);

/// Returns all branches as edges from point to point, for files. Vertices have the column `radius`. Edges have `label`
/// (int64; 0 if unset), `branch` (int32, counted over all labels), and its `length`, `mean_radius` and `min_radius`.
/// Branches share the vertices of their nodes.
[[nodiscard]] Complex complex_of(const Centrelines& lines);

}  // namespace blum
