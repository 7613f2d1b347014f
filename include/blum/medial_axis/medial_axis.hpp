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
  /// Meshes: side of a voxel, > 0 and at most the diagonal of the solid, mesh units. Replaces `resolution`.
  std::optional<double> spacing = {};
  /// Meshes: most voxels along the longest side of a body, 8 to 800. A body is computed again with voxels of half the
  /// side if its model does not pass (see CellularModel) or contains no voxel. This limit ends the refinement; a value
  /// below `resolution` prevents it.
  int max_resolution = 512;
  /// Meshes: shift of the grid along each of its axes, -1 to 1 voxels. The grid moves with the mesh, so this shows how
  /// the result depends on its position.
  double grid_shift = 0;
  /// Parts of the axis whose two footprints are closer than this are ignored, >= 0 and at most the diagonal of the
  /// solid, mesh units. (Lambda-medial axis of Chazal and Lieutier 2005.)
  double lambda = 0;
  /// Smallest theta that will be requested, 0 to 180 degrees. Smaller angles are evaluated coarsely, which saves time
  /// if they are frequent. The parts that join the rest may then run elsewhere.
  double least_theta = 0;
  /// Largest theta that will be requested, least_theta to 180 degrees. The remaining collapse order is not computed.
  /// Axes are the same. MedialAxis::nested() needs 180.
  double greatest_theta = 180;
  /// For medial_axis() of an image: voxels of the solid. Ignored if a Solid is given.
  LabelSelection selection = {};
};

template <>
struct Description<MedialAxisOptions> {
  static constexpr std::string_view name = "MedialAxisOptions";
  static constexpr std::string_view doc = "Options of a medial axis";
  static constexpr std::tuple members{
      Member{"resolution", &MedialAxisOptions::resolution, "",
             "meshes: voxels along the longest side of the box around the mesh, 8 to 800", Range::between(8, 800)},
      Member{"spacing", &MedialAxisOptions::spacing, "mesh units", "meshes: side of a voxel, instead of the resolution",
             Range::positive()},
      Member{"max_resolution", &MedialAxisOptions::max_resolution, "",
             "meshes: most voxels along the longest side of a body; a body whose model does not pass is computed again "
             "with finer voxels",
             Range::between(8, 800)},
      Member{"grid_shift", &MedialAxisOptions::grid_shift, "voxels",
             "meshes: shift of the grid along each axis, which shows how the result depends on it",
             Range::between(-1, 1)},
      Member{"lambda", &MedialAxisOptions::lambda, "mesh units",
             "smallest distance of the two footprints of pieces that count", Range::at_least(0)},
      Member{"least_theta", &MedialAxisOptions::least_theta, "degrees",
             "smallest theta that will be requested: larger is faster", Range::between(0, 180)},
      Member{"greatest_theta", &MedialAxisOptions::greatest_theta, "degrees",
             "largest theta that will be requested, at least least_theta: smaller is faster", Range::between(0, 180)},
      Member{"selection", &MedialAxisOptions::selection, "", "images: voxels of the solid"},
  };
};

/// Cells of one body (a connected part of the solid).
struct BodyReport {
  BettiNumbers betti{};  ///< Betti numbers of the body.
  /// True if the cells have the homotopy type of the body. Then the axis has it at every theta.
  bool topology_matches = false;
  double spacing = 0;                  ///< Smallest side of a voxel, mesh units.
  std::size_t voxels = 0;              ///< Voxels whose centres are inside.
  std::size_t extra_cells = 0;         ///< Polyhedra: cells of the model that are not cells of voxels.
  std::vector<ModelFailure> failures;  ///< Polyhedra: places where the model lacks the body's homotopy type.
};

template <>
struct Description<BodyReport> {
  static constexpr std::string_view name = "BodyReport";
  static constexpr std::string_view doc = "Cells of one connected part of a solid";
  static constexpr std::tuple members{
      Member{"solid_betti", &BodyReport::betti, "", "components, tunnels, voids of the body"},
      Member{"topology_matches", &BodyReport::topology_matches, "",
             "true if the cells have its homotopy type, and so the axis at every theta"},
      Member{"spacing", &BodyReport::spacing, "mesh units", "smallest side of a voxel"},
      Member{"voxels", &BodyReport::voxels, "", "voxels with centres inside"},
      Member{"extra_cells", &BodyReport::extra_cells, "", "cells of its model that do not belong to a voxel"},
      Member{"failures", &BodyReport::failures, "", "places where the model does not have its homotopy type"},
  };
};

struct MedialAxisReport {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;               ///< One sentence: the reason for this rule.
  std::size_t reversed_shells = 0;  ///< Shells that faced the solid and were reversed.
  BettiNumbers betti{};             ///< Betti numbers of the solid: the sum over its bodies.
  bool topology_matches = false;    ///< True for all bodies. Then the axis has the solid's homotopy type at every
                                    ///< theta.
  GridSpec grid;                    ///< Voxel centres, of the first body or of the image.
  std::vector<BodyReport> bodies;
  std::vector<PhaseTime> phases;  ///< Seconds.
  std::vector<Warning> warnings;  ///< Report reversed triangles or shells, or a solid that is known as voxels.
};

template <>
struct Description<MedialAxisReport> {
  static constexpr std::string_view name = "MedialAxisReport";
  static constexpr std::string_view doc = "Solid of a medial axis, and the result of its construction";
  static constexpr std::tuple members{
      Member{"rule", &MedialAxisReport::rule, "", "rule for the solid"},
      Member{"reason", &MedialAxisReport::reason, "", "reason for this rule, in one sentence"},
      Member{"reversed_shells", &MedialAxisReport::reversed_shells, "",
             "shells that faced the solid and were reversed"},
      Member{"solid_betti", &MedialAxisReport::betti, "", "components, tunnels, voids of the whole solid"},
      Member{"topology_matches", &MedialAxisReport::topology_matches, "",
             "true if the axis has its homotopy type, at every theta"},
      Member{"grid", &MedialAxisReport::grid, "", "grid of voxel centres: of the first body, or of the image"},
      Member{"bodies", &MedialAxisReport::bodies, "", "connected parts of the solid"},
      Member{"seconds", &MedialAxisReport::phases, "s", "wall-clock time of each phase"},
      Member{"warnings", &MedialAxisReport::warnings, "", "differences between the solid and the input"},
  };
};

/// Medial axis of a solid for all angles theta at once. It is a complex of polygons, edges and vertices to which the
/// cells of the solid collapse, with the order in which it collapses further.
class MedialAxis {
 public:
  MedialAxis(MedialAxis&&) noexcept;
  MedialAxis& operator=(MedialAxis&&) noexcept;
  ~MedialAxis();

  /// Returns the part of the axis with a separation angle above theta, and the cells that connect it up to homotopy.
  /// The complex has the columns of MedialView. Its Betti numbers are report().betti if report().topology_matches. The
  /// result for a larger theta is part of that for a smaller one.
  /// @param theta  degrees, MedialAxisOptions::least_theta to greatest_theta.
  /// @throws InvalidOption if theta is out of range; Cancelled.
  /// Cost: linear in the result; about 0.5 s for a million triangles.
  [[nodiscard]] Complex simplify(double theta, const Context& context = {}) const;

  /// Returns the axis at theta with borders fitted to the surface of a polyhedron; for other solids simplify(theta).
  ///
  /// Seams and junctions lie where three or four walls are equally far. Rims and ends lie where the separation angle is
  /// theta or, at convex edges, 0.02 voxels from the surface. Ribbons without width become curves. The Betti numbers
  /// are those of simplify(). The result for a larger theta is no longer part of that for a smaller one.
  /// @throws as simplify().
  /// Cost: that of simplify(), and about 0.1 ms per vertex of seams, rims and curves.
  [[nodiscard]] Complex fitted(double theta, const Context& context = {}) const;

  /// Returns fitted() after decimation within a tolerance, but with less time and memory than both need. The insides of
  /// sheets are thinned first, by up to a sixteenth of the tolerance, and not fitted. Solids that are not polyhedra get
  /// decimate() of simplify().
  /// @param tolerance  mesh units, >= 0; 0 keeps all vertices.
  /// @throws as fitted() and decimate().
  [[nodiscard]] DecimatedAxis lean(double theta, double tolerance, const Context& context = {}) const;

  /// Returns the axes of all angles from least_theta() to 180 as sets of points, in one complex. It serves to show
  /// axes, and to simplify them without further computation.
  ///
  /// The complex has the columns of MedialView and MedialLevels. The triangles, curves and vertices that exist at an
  /// angle cover the result of simplify() for it. Vertices at the same place are merged, and parts without extent are
  /// left out. So the topology may differ from that of the solid. Sheets and roles of vertices are those at the least
  /// angle.
  /// @throws Cancelled; InvalidOption if greatest_theta() is below 180.
  /// Cost: near-linear in the axis at the least angle; about 1 s for a million triangles.
  [[nodiscard]] Complex nested(const Context& context = {}) const;

  /// Returns MedialAxisOptions::least_theta.
  [[nodiscard]] double least_theta() const;
  /// Returns MedialAxisOptions::greatest_theta.
  [[nodiscard]] double greatest_theta() const;

  /// Returns MedialAxisOptions::lambda, mesh units.
  [[nodiscard]] double lambda() const;

  [[nodiscard]] const MedialAxisReport& report() const;

 private:
  friend class MedialAxisBuilder;
  void check_theta(double theta) const;
  struct Data;
  explicit MedialAxis(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// Computes the medial axis of a solid.
///
/// Sheets of a mesh are numbered by the flat or smooth parts of the surface on both sides, and these by their first
/// faces. Sheets with the same two parts are ordered by the distances of their centroids from vertices of the mesh.
/// Those with less than a thousandth of the area come last. So a sheet has the same number wherever the mesh lies. It
/// also has it on every grid that shows the same sheets. (docs/guide/medial-axes.md has the full rule.) Sheets of an
/// image are numbered in the order of their first triangles.
///
/// Vertices lie on the bisector of two parts of the surface if two exist. Along each axis of the grid they are at most
/// 0.7 voxels from a corner of the voxel lattice. If no such point is found, a vertex may lie elsewhere in the solid
/// (docs/theory/medial-axis.md). The radius is the exact distance to the surface (1e-9 of the extent).
///
/// @return      the same bytes for any number of threads. Check report().topology_matches, which is true if the axis
///              has the topology of the solid. Sites of a mesh are those of SiteTable(mesh). In images, distances refer
///              to the faces of the voxels. Their sites are the voxels beyond these faces, which are not selected or
///              lie just outside the image. A voxel outside has the id of the image's voxel next to it.
/// @throws InvalidMesh if no voxel shows an interior of the solid (the message mentions triangles that face inwards).
/// Also if the solid is smaller than 5e-7 of its largest coordinate. InvalidOption; OutOfMemory; Cancelled.
/// Cost: near-linear in the voxels of the solid; about 10 bytes per voxel of the box.
/// Method: docs/theory/medial-axis.md (Sud 2006, ch. 5; Liu, Chambers, Letscher, Ju 2010; Chaussard, Couprie 2009).
[[nodiscard]] MedialAxis medial_axis(const Solid& solid, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// Computes the medial axis of Solid::of(mesh). Segments and points are ignored.
/// @throws as both.
[[nodiscard]] MedialAxis medial_axis(const MeshView& mesh, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// Computes the medial axis of Solid::of(image, options.selection).
/// @throws as both.
[[nodiscard]] MedialAxis medial_axis(const VoxelImageView& image, const MedialAxisOptions& options = {},
                                     const Context& context = {});

}  // namespace blum
