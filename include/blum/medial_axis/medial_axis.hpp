// Blum: medial axes with the topology of the solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/complex/complex.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/solid/cellular_model.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

struct MedialAxisOptions {
  /// Meshes: voxels along the longest side of the box around the mesh, 8 to 800.
  int resolution = 256;
  /// Meshes: side of a voxel, > 0 and at most the diagonal of the solid, mesh units; instead of `resolution`.
  std::optional<double> spacing = {};
  /// Meshes: a body whose model does not pass (see CellularModel), or of which no voxel shows, is done again with
  /// voxels of half the side, as long as at most this many lie along its own longest side. Less than `resolution` says:
  /// never.
  int max_resolution = 512;
  /// Meshes: how far the grid is moved along each of its axes, -1 to 1 voxels. The grid lies around the mesh, and so
  /// goes where that goes; by this one sees what depends on where it lies.
  double grid_shift = 0;
  /// Pieces of the axis whose two footprints are closer than this count for nothing (the lambda-medial axis of Chazal
  /// and Lieutier 2005), >= 0 and at most the diagonal of the solid, mesh units.
  double lambda = 0;
  /// The smallest theta that will be asked for, 0 to 180 degrees: what is seen at less is not looked at closely, which
  /// saves time where much is. What joins the rest may then run elsewhere.
  double least_theta = 0;
  /// The largest theta that will be asked for, least_theta to 180 degrees: in which order the rest could go on is not
  /// found out. Axes are the same. MedialAxis::nested() needs 180.
  double greatest_theta = 180;
  /// medial_axis() of an image: which voxels are the solid. Not looked at where a Solid is given.
  LabelSelection selection = {};
};

template <>
struct Description<MedialAxisOptions> {
  static constexpr std::string_view name = "MedialAxisOptions";
  static constexpr std::string_view doc = "What a medial axis is asked for";
  static constexpr std::tuple members{
      Member{"resolution", &MedialAxisOptions::resolution, "",
             "meshes: voxels along the longest side of the box around the mesh, 8 to 800", Range::between(8, 800)},
      Member{"spacing", &MedialAxisOptions::spacing, "mesh units", "meshes: side of a voxel, instead of the resolution",
             Range::positive()},
      Member{"max_resolution", &MedialAxisOptions::max_resolution, "",
             "meshes: a body whose model does not pass is done again with finer voxels, up to this many "
             "along its longest side",
             Range::between(8, 800)},
      Member{"grid_shift", &MedialAxisOptions::grid_shift, "voxels",
             "meshes: how far the grid is moved along each axis, to see what depends on that", Range::between(-1, 1)},
      Member{"lambda", &MedialAxisOptions::lambda, "mesh units",
             "pieces whose two footprints are closer than this count for nothing", Range::at_least(0)},
      Member{"least_theta", &MedialAxisOptions::least_theta, "degrees",
             "the smallest theta that will be asked for: more is faster", Range::between(0, 180)},
      Member{"greatest_theta", &MedialAxisOptions::greatest_theta, "degrees",
             "the largest theta that will be asked for, at least least_theta: less is faster", Range::between(0, 180)},
      Member{"selection", &MedialAxisOptions::selection, "", "images: which voxels are the solid"},
  };
};

/// The cells that one body (a connected part of the solid) was made of.
struct BodyReport {
  BettiNumbers betti{};  ///< of the body
  /// Whether the cells have the homotopy type of the body, and so the axis has at every theta.
  bool topology_matches = false;
  double spacing = 0;                  ///< smallest side of a voxel, mesh units
  std::size_t voxels = 0;              ///< whose centres are inside
  std::size_t extra_cells = 0;         ///< polyhedra: cells of the model that are none of a voxel's
  std::vector<ModelFailure> failures;  ///< polyhedra: places where the model has not the homotopy type
};

template <>
struct Description<BodyReport> {
  static constexpr std::string_view name = "BodyReport";
  static constexpr std::string_view doc = "The cells that one connected part of a solid was made of";
  static constexpr std::tuple members{
      Member{"solid_betti", &BodyReport::betti, "", "components, tunnels, voids of the body"},
      Member{"topology_matches", &BodyReport::topology_matches, "",
             "whether the cells have its homotopy type, and so the axis has at every theta"},
      Member{"spacing", &BodyReport::spacing, "mesh units", "smallest side of a voxel"},
      Member{"voxels", &BodyReport::voxels, "", "whose centres are inside"},
      Member{"extra_cells", &BodyReport::extra_cells, "", "cells of its model that are none of a voxel's"},
      Member{"failures", &BodyReport::failures, "", "places where the model has not its homotopy type"},
  };
};

struct MedialAxisReport {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;               ///< one sentence: why this rule
  std::size_t reversed_shells = 0;  ///< shells that faced the solid and were reversed
  BettiNumbers betti{};             ///< of the whole solid: the sum of the bodies'
  bool topology_matches = false;    ///< whether the axis has its homotopy type, at every theta: all bodies' do
  GridSpec grid;                    ///< voxel centres: of the first body, or of the image
  std::vector<BodyReport> bodies;
  std::vector<PhaseTime> phases;  ///< seconds
  std::vector<Warning> warnings;  ///< that shells were reversed, or that the solid is known as voxels
};

template <>
struct Description<MedialAxisReport> {
  static constexpr std::string_view name = "MedialAxisReport";
  static constexpr std::string_view doc = "What a medial axis took as the solid, and what became of it";
  static constexpr std::tuple members{
      Member{"rule", &MedialAxisReport::rule, "", "what the solid is"},
      Member{"reason", &MedialAxisReport::reason, "", "why this rule, in one sentence"},
      Member{"reversed_shells", &MedialAxisReport::reversed_shells, "",
             "shells that faced the solid and were reversed"},
      Member{"solid_betti", &MedialAxisReport::betti, "", "components, tunnels, voids of the whole solid"},
      Member{"topology_matches", &MedialAxisReport::topology_matches, "",
             "whether the axis has its homotopy type, at every theta"},
      Member{"grid", &MedialAxisReport::grid, "", "voxel centres: of the first body, or of the image"},
      Member{"bodies", &MedialAxisReport::bodies, "", "one for each connected part of the solid"},
      Member{"seconds", &MedialAxisReport::phases, "s", "wall-clock, of each phase"},
      Member{"warnings", &MedialAxisReport::warnings, "", "whether the solid is not quite what was given"},
  };
};

/// The medial axis of a solid for all angles theta at once: a complex of polygons, edges and vertices that the
/// solid's cells collapse to, and the order in which it collapses further.
class MedialAxis {
 public:
  MedialAxis(MedialAxis&&) noexcept;
  MedialAxis& operator=(MedialAxis&&) noexcept;
  ~MedialAxis();

  /// The part where two footprints are seen at more than theta apart, and what homotopy needs to join it: a complex
  /// with the columns of MedialView and the Betti numbers report().betti. What a larger theta gives is part of what a
  /// smaller one gives.
  /// @param theta  degrees, MedialAxisOptions::least_theta to greatest_theta.
  /// @throws InvalidOption, Cancelled. Cost: linear in the result; about 0.5 s for a million triangles.
  [[nodiscard]] Complex simplify(double theta, const Context& context = {}) const;

  /// The same with its borders where they belong: of a polyhedron, seams and junctions lie where three or four walls
  /// are equally far, rims and ends where the separation angle is theta or, at convex edges, 0.02 voxels from the
  /// surface; ribbons without width are curves. The Betti numbers are those of simplify(); what a larger theta gives is
  /// no longer a part of what a smaller one gives. Of other solids, simplify(theta).
  /// @throws as simplify(). Cost: besides, about 0.1 ms for each vertex of seams, rims and curves.
  [[nodiscard]] Complex fitted(double theta, const Context& context = {}) const;

  /// What decimate() leaves of fitted() within a tolerance, but in less time and memory: what lies far inside of sheets
  /// is thinned out first, by up to a sixteenth of the tolerance, and not fitted. Of solids that are no polyhedra,
  /// decimate() of simplify().
  /// @param tolerance  mesh units, >= 0; 0 keeps all vertices.
  /// @throws as fitted() and decimate().
  [[nodiscard]] DecimatedAxis lean(double theta, double tolerance, const Context& context = {}) const;

  /// The axes of all angles from least_theta() to 180 as sets of points, in one complex: to show, and to simplify
  /// without computing anything again. It has the columns of MedialView and MedialLevels; at an angle, the triangles,
  /// curves and vertices that are there cover what simplify() gives for it. Vertices at the same place are one, and
  /// pieces without extent are left out, so that its topology need not be that of the solid. Sheets and the roles of
  /// vertices are those at the least angle. @throws Cancelled. Cost: near-linear in the axis at the least angle; about
  /// 1 s for a million triangles.
  [[nodiscard]] Complex nested(const Context& context = {}) const;

  /// MedialAxisOptions::least_theta.
  [[nodiscard]] double least_theta() const;
  /// MedialAxisOptions::greatest_theta.
  [[nodiscard]] double greatest_theta() const;

  /// MedialAxisOptions::lambda, mesh units.
  [[nodiscard]] double lambda() const;

  [[nodiscard]] const MedialAxisReport& report() const;

 private:
  friend class MedialAxisBuilder;
  void check_theta(double theta) const;
  struct Data;
  explicit MedialAxis(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// The medial axis of a solid.
///
/// Sheets of a mesh are numbered by the flat or smooth parts of the surface that they lie between, these by their first
/// faces; of one pair, by the distances of their centroids from vertices of the mesh; those with less than a thousandth
/// of the area come last. So the same sheet has the same number wherever the mesh lies and however fine the grid is,
/// where that shows the same sheets (docs/guide/medial-axes.md has the rule in full). Sheets of an image are numbered
/// in the order of their first triangles.
///
/// Vertices lie on the bisector of two parts of the surface where there are two, within 0.7 voxels of a corner of the
/// voxel lattice; their radius is the exact distance to the surface (1e-9 of the extent).
///
/// @return      report().topology_matches says whether the axis has the topology of the solid: look at it. Of a mesh,
///              sites are those of SiteTable(mesh). Of an image, distances are to the faces of the voxels, and sites
///              are voxels that are not selected, or that lie just outside of the image, where the id is that of the
///              image's voxel next to them. The same bytes for any number of threads.
/// @throws InvalidMesh for a solid without any interior that voxels could show: where triangles face inwards, the
/// message says so; InvalidOption, OutOfMemory, Cancelled.
/// Cost: near-linear in the voxels of the solid; about 10 bytes for each voxel of the box.
/// Method: docs/theory/medial-axis.md (Sud 2006, ch. 5; Liu, Chambers, Letscher, Ju 2010; Chaussard, Couprie 2009).
[[nodiscard]] MedialAxis medial_axis(const Solid& solid, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// The same of Solid::of(mesh) in one call; segments and points are ignored. @throws as both.
[[nodiscard]] MedialAxis medial_axis(const MeshView& mesh, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// The same of Solid::of(image, options.selection) in one call. @throws as both.
[[nodiscard]] MedialAxis medial_axis(const VoxelImageView& image, const MedialAxisOptions& options = {},
                                     const Context& context = {});

}  // namespace blum
