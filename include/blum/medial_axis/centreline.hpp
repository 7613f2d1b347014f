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
  /// Selected voxels. By default (`nonzero`), each value other than 0 is a label of its own, and all values must be
  /// whole numbers.
  LabelSelection selection = {};
  /// Limit for the removal of branches with a free end (spurs). A spur is removed if it stays within spur * radius +
  /// 1.5 voxels of its junction. Here, `radius` is the radius of the ball at this junction. If spur is 1, removed
  /// branches leave the junction's ball by at most 1.5 voxels. If spur is 0, only branches that stay within 1.5 voxels
  /// are removed.
  double spur = 1;
};

template <>
struct Description<CentrelineOptions> {
  static constexpr std::string_view name = "CentrelineOptions";
  static constexpr std::string_view doc = "Options of centrelines";
  static constexpr std::tuple members{
      Member{"selection", &CentrelineOptions::selection, "", "selected voxels"},
      Member{"spur", &CentrelineOptions::spur, "radii r of the junction's ball",
             "limit N: branches with a free end are removed if they stay within N r + 1.5 voxels of their junction",
             Range::between(0, 100)},
  };
};

enum class CentrelineNodeKind : std::uint8_t {
  point,    ///< Node of a component without branches, for example of a blob.
  end,      ///< End of one branch.
  junction  ///< Common end of several branches, or of both ends of one branch.
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
  double radius = 0;  ///< Radius of the node's ball, world units. At an `end`, this is the radius of the branch at its
                      ///< end. At other nodes, this is the distance to the closest voxel outside the label.
};
template <>
struct Description<CentrelineNode> {
  static constexpr std::string_view name = "CentrelineNode";
  static constexpr std::string_view doc = "Point where branches end or meet";
  static constexpr std::tuple members{
      Member{"kind", &CentrelineNode::kind, "", "point (of a blob without branches), end or junction"},
      Member{"position", &CentrelineNode::position, "world units", "position"},
      Member{"radius", &CentrelineNode::radius, "world units",
             "end: radius of its branch there; other kinds: distance to the closest voxel outside"},
  };
};

/// Curve between two nodes, or a closed curve without nodes.
struct CentrelineBranch {
  std::array<std::int32_t, 2> nodes{-1, -1};  ///< Indices of the branch's first and last node; -1 for closed curves.
  double length = 0;                          ///< Length of the polyline `points`, world units.
  /// Mean of `radii` along the part of the branch that is at least 1.5 voxels away from the balls of its junctions. If
  /// no part of the branch is that far away, the mean is that of the whole branch.
  double mean_radius = 0;
  double min_radius = 0;  ///< Smallest of `radii` on the part of the branch that `mean_radius` uses.
  /// Polyline from the first to the last node. A closed curve ends with its first point.
  std::vector<Vec3d> points = {};
  /// For each point: radius of the circle that has the area of the cross-section at this point.
  std::vector<double> radii = {};
};
template <>
struct Description<CentrelineBranch> {
  static constexpr std::string_view name = "CentrelineBranch";
  static constexpr std::string_view doc = "Curve between two nodes, or a closed curve without nodes";
  static constexpr std::tuple members{
      Member{"nodes", &CentrelineBranch::nodes, "", "first and last node; -1 for closed curves"},
      Member{"length", &CentrelineBranch::length, "world units", "length of its polyline"},
      Member{"mean_radius", &CentrelineBranch::mean_radius, "world units",
             "mean radius along the part at least 1.5 voxels away from its junctions' balls; if there is none, along "
             "the whole branch"},
      Member{"min_radius", &CentrelineBranch::min_radius, "world units", "smallest radius on the same part"},
      Member{"points", &CentrelineBranch::points, "world units",
             "polyline from node to node; for closed curves the first point is also the last"},
      Member{"radii", &CentrelineBranch::radii, "world units",
             "radius at each point: that of the circle with the area of the cross-section there"},
  };
};

/// Centreline of the voxels of one label.
struct Centreline {
  std::optional<std::int64_t> label = {};  ///< Unset if a threshold selects the voxels.
  std::uint64_t voxels = 0;                ///< Number of voxels of the label.
  std::vector<CentrelineNode> nodes = {};
  std::vector<CentrelineBranch> branches = {};
  BettiNumbers label_betti{};  ///< Components, tunnels and voids of the union of the closed voxels.
  BettiNumbers graph_betti{};  ///< Components, tunnels and voids of the nodes and branches.
  bool homotopy_kept = true;   ///< True if label_betti and graph_betti are equal.
  /// One sentence: states that the homotopy type is kept, or gives the difference and its reason.
  std::string homotopy;
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
      Member{"homotopy_kept", &Centreline::homotopy_kept, "", "true if label_betti and graph_betti are equal"},
      Member{"homotopy", &Centreline::homotopy, "", "one sentence: kept, or the difference and its reason"},
  };
};

struct Centrelines {
  std::vector<Centreline> labels;  ///< By ascending label, or in the order of the labels given to centreline().
  std::vector<PhaseTime> phases;
  std::vector<Warning> warnings;  ///< Result of centreline_warnings().
};

/// Returns the centreline of each label of an image, as a graph of curves.
///
/// Voxels of a label are connected through corners (26 neighbours). Voxels of the background are connected through
/// faces (6 neighbours), as for betti_numbers(). Everything beyond the image is background. Voids of the label are
/// filled first. After that, voxels are removed in the order of their distance to the background, until only curves
/// remain. Next, short branches with a free end are removed (CentrelineOptions::spur), and junctions are merged if they
/// lie in each other's balls. All steps after the filling of voids preserve the homotopy type. Finally, each point of a
/// curve is moved to the centroid of the point's cross-section, by at most the longest side of a voxel. The radius at a
/// point is that of the circle with the area of the cross-section. The ball at a free end touches the tip of the label.
/// See docs/theory/centrelines.md for the method.
///
/// @param image  must pass validate(image).
/// @return  the same bytes for any number of threads. Labels without voxels have neither nodes nor branches.
/// @throws InvalidImage, also if values are labels and one is not a whole number; InvalidOption; OutOfMemory;
/// Cancelled.
/// Cost: about twice the time of distance_transform(); 10 bytes of memory per voxel of the largest box around a label.
[[nodiscard]] Centrelines centreline(const VoxelImageView& image, const CentrelineOptions& options = {},
                                     const Context& context = {});

/// Returns the centrelines of the given labels, in the given order. options.selection is ignored.
[[nodiscard]] Centrelines centreline(const VoxelImageView& image, std::span<const std::int64_t> labels,
                                     const CentrelineOptions& options = {}, const Context& context = {});

/// Returns warnings about the centrelines of an image with this grid. A warning may report that the image has a single
/// layer of voxels (WarningCode::single_layer), or that a label has no voxels (WarningCode::nothing_found). A warning
/// may also report that the topology of a label differs from that of the label's curves (WarningCode::other_topology).
/// At most six warnings are returned. If more than six apply, the sixth warning gives the number of labels that have no
/// separate warning.
[[nodiscard]] std::vector<Warning> centreline_warnings(const Centrelines& lines, const GridSpec& grid);

/// Returns all branches as a complex, for files. An edge joins each point of a branch to the next point. Vertices have
/// the column `radius`. Edges have the columns `label` (int64; 0 if unset) and `branch` (int32, counted over all
/// labels). Edges also have the columns `length`, `mean_radius` and `min_radius`, with the values of their branch.
/// Branches that end at the same node share the node's vertex.
[[nodiscard]] Complex complex_of(const Centrelines& lines);

}  // namespace blum
