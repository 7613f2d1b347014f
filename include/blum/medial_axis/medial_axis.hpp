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
  /// Meshes: number of voxels along the longest side of the box around the mesh, 8 to 800.
  int resolution = 256;
  /// Meshes: side of a voxel, mesh units, > 0 and at most the diagonal of the box around the solid. Replaces
  /// `resolution`.
  std::optional<double> spacing = {};
  /// Meshes: largest number of voxels along the longest side of the box around a body, 8 to 800. If the cellular model
  /// of a body fails its test (see CellularModel) or has no cells, the side of the body's voxels is halved. Halving is
  /// repeated up to this limit. If the limit is at most `resolution`, a body as large as the mesh is computed only
  /// once.
  int max_resolution = 512;
  /// Meshes: shift of the grid relative to the mesh along each axis of the grid, -1 to 1 voxels. Results for different
  /// shifts show how the axis depends on the position of the grid.
  double grid_shift = 0;
  /// Least distance between the two footprints of a point of the axis, mesh units: >= 0, at most the diagonal of the
  /// solid's box. If the footprints are closer, the separation angle is set to 0. (Lambda-medial axis of Chazal and
  /// Lieutier 2005.)
  double lambda = 0;
  /// Smallest threshold theta of the separation angle that will be requested, 0 to 180 degrees. Smaller separation
  /// angles are set to 0, which saves time if they are frequent. The position of cells that are kept only to preserve
  /// the homotopy type may depend on this option.
  double least_theta = 0;
  /// Largest theta that will be requested, least_theta to 180 degrees. The order of collapses at larger angles is not
  /// computed. The axes that may be requested are the same with and without this limit. MedialAxis::nested() needs 180.
  double greatest_theta = 180;
  /// Images: voxels of the solid. Ignored if medial_axis() is called with a Solid.
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
             "meshes: limit for the voxels along the longest side of a body; a body whose topology is not proven is "
             "computed again with finer voxels",
             Range::between(8, 800)},
      Member{"grid_shift", &MedialAxisOptions::grid_shift, "voxels",
             "meshes: shift of the grid along each axis, to find how much the result depends on the grid",
             Range::between(-1, 1)},
      Member{"lambda", &MedialAxisOptions::lambda, "mesh units",
             "smallest distance between the two footprints of a point; if they are closer, its separation angle counts "
             "as 0",
             Range::at_least(0)},
      Member{"least_theta", &MedialAxisOptions::least_theta, "degrees",
             "smallest threshold theta that will be requested: a larger value is faster", Range::between(0, 180)},
      Member{"greatest_theta", &MedialAxisOptions::greatest_theta, "degrees",
             "largest theta that will be requested, at least least_theta: a smaller value is faster",
             Range::between(0, 180)},
      Member{"selection", &MedialAxisOptions::selection, "", "images: voxels of the solid"},
  };
};

/// Facts about the cells of one body: a connected part of the solid.
struct BodyReport {
  BettiNumbers betti{};  ///< Betti numbers of the body.
  /// True if the cells have the homotopy type of the body. If true, the axis in this body also has the homotopy type of
  /// the body, at every theta.
  bool topology_matches = false;
  double spacing = 0;                  ///< Smallest side of a voxel, mesh units.
  std::size_t voxels = 0;              ///< Number of voxels whose centres are inside.
  std::size_t extra_cells = 0;         ///< Polyhedra: number of cells of the model that are not cells of voxels.
  std::vector<ModelFailure> failures;  ///< Polyhedra: boxes in which the test of the model fails.
};

template <>
struct Description<BodyReport> {
  static constexpr std::string_view name = "BodyReport";
  static constexpr std::string_view doc = "Cells of one connected part of a solid";
  static constexpr std::tuple members{
      Member{"solid_betti", &BodyReport::betti, "", "components, tunnels, voids of the body"},
      Member{"topology_matches", &BodyReport::topology_matches, "",
             "true if the cells, and so the axis at every theta, have the homotopy type of the body"},
      Member{"spacing", &BodyReport::spacing, "mesh units", "smallest side of a voxel"},
      Member{"voxels", &BodyReport::voxels, "", "voxels with centres inside the body"},
      Member{"extra_cells", &BodyReport::extra_cells, "", "cells of its model that do not belong to a voxel"},
      Member{"failures", &BodyReport::failures, "",
             "places where the model may not have the homotopy type of the body"},
  };
};

struct MedialAxisReport {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;               ///< The reason for this rule, in one sentence.
  std::size_t reversed_shells = 0;  ///< Shells whose triangles faced the solid, and were reversed.
  BettiNumbers betti{};             ///< Betti numbers of the solid: the sum over its bodies.
  bool topology_matches = false;    ///< True if BodyReport::topology_matches is true for all bodies. If true, the axis
                                    ///< has the solid's homotopy type at every theta.
  GridSpec grid;                    ///< Grid of voxel centres: that of the first body, or of the image.
  std::vector<BodyReport> bodies;
  std::vector<PhaseTime> phases;  ///< Seconds.
  /// Warnings about reversed triangles and shells, and about a mesh whose solid is represented by voxels.
  std::vector<Warning> warnings;
};

template <>
struct Description<MedialAxisReport> {
  static constexpr std::string_view name = "MedialAxisReport";
  static constexpr std::string_view doc = "Solid of a medial axis, and the result of its construction";
  static constexpr std::tuple members{
      Member{"rule", &MedialAxisReport::rule, "", "rule that defines the solid"},
      Member{"reason", &MedialAxisReport::reason, "", "reason for this rule, in one sentence"},
      Member{"reversed_shells", &MedialAxisReport::reversed_shells, "",
             "shells that faced the solid and were reversed"},
      Member{"solid_betti", &MedialAxisReport::betti, "", "components, tunnels, voids of the whole solid"},
      Member{"topology_matches", &MedialAxisReport::topology_matches, "",
             "true if the axis has the homotopy type of the solid, at every theta"},
      Member{"grid", &MedialAxisReport::grid, "", "grid of voxel centres: of the first body, or of the image"},
      Member{"bodies", &MedialAxisReport::bodies, "", "connected parts of the solid"},
      Member{"seconds", &MedialAxisReport::phases, "s", "wall-clock time of each phase"},
      Member{"warnings", &MedialAxisReport::warnings, "", "differences between the solid and the input"},
  };
};

/// Medial axis of a solid for all angles theta at once. The cells of the solid collapse to a complex of polygons, edges
/// and vertices. MedialAxis stores this complex, and the order in which it collapses further for larger theta.
class MedialAxis {
 public:
  MedialAxis(MedialAxis&&) noexcept;
  MedialAxis& operator=(MedialAxis&&) noexcept;
  ~MedialAxis();

  /// Returns the cells of the axis with a separation angle above theta. The result also contains all cells that are
  /// needed to keep the homotopy type of the solid. The complex has the columns of MedialView. If
  /// report().topology_matches is true, the Betti numbers of the complex are report().betti. The axis for a larger
  /// theta is a part of the axis for a smaller theta.
  /// @param theta  degrees, MedialAxisOptions::least_theta to greatest_theta.
  /// @throws InvalidOption if theta is out of range; Cancelled.
  /// Cost: linear in the result; about 0.5 s for a million triangles.
  [[nodiscard]] Complex simplify(double theta, const Context& context = {}) const;

  /// Returns the axis at theta after its borders were fitted to the surface. If the solid is not a polyhedron, returns
  /// simplify(theta).
  ///
  /// Seams lie where three walls (parts of the surface around footprints) are equally far away. Junctions lie where
  /// four walls are equally far away. Rims and ends of curves lie where the separation angle is theta. At convex edges
  /// of the solid, rims and ends lie 0.02 voxels from the surface. Ribbons without width become curves. The Betti
  /// numbers are those of simplify(). Unlike in simplify(), the axis for a larger theta is not a part of the axis for a
  /// smaller theta.
  /// @throws as simplify().
  /// Cost: that of simplify(), plus about 0.1 ms per vertex of seams, rims and curves.
  [[nodiscard]] Complex fitted(double theta, const Context& context = {}) const;

  /// Returns fitted() after decimation within a tolerance. This function needs less time and memory than fitted()
  /// followed by decimate(). Vertices inside sheets are removed before the borders are fitted, which moves sheets by at
  /// most a sixteenth of the tolerance. If the solid is not a polyhedron, returns decimate() of simplify().
  /// @param tolerance  mesh units, >= 0; 0 keeps all vertices.
  /// @throws as fitted() and decimate().
  [[nodiscard]] DecimatedAxis lean(double theta, double tolerance, const Context& context = {}) const;

  /// Returns the axes of all angles from least_theta() to 180 degrees in one complex, for example for viewers. The axis
  /// at any angle can be selected from the complex without further computation.
  ///
  /// The complex has the columns of MedialView and MedialLevels. The triangles, curves and vertices that exist at an
  /// angle contain the same points as the result of simplify() for that angle. Vertices at the same position are
  /// merged, and edges and triangles without extent are left out. So the topology may differ from that of the solid.
  /// Sheets and roles of vertices are those of the axis at least_theta().
  /// @throws Cancelled; InvalidOption if greatest_theta() is below 180.
  /// Cost: near-linear in the cells of the axis at least_theta(); about 1 s for a million triangles.
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
/// Each sheet of a mesh's axis lies between two regions of the surface, which are flat or smooth. Regions are ordered
/// by their first face in the mesh. Sheets are ordered by their lower region, then by their higher region. Sheets
/// between the same two regions are ordered by the distances of their centroids from vertices of the mesh. Sheets with
/// less than a thousandth of the axis's total area come last. So numbers of sheets do not depend on the position of the
/// mesh. The grid does not change the numbers either, if the same sheets are found. (docs/guide/medial-axes.md contains
/// the full rule.) Sheets of an image's axis are numbered in the order of their first triangles.
///
/// If two walls (parts of the surface around footprints) are found for a vertex, the vertex lies on their bisector. A
/// vertex on a bisector is at most 0.7 voxels from a corner of a voxel, along each axis of the grid. If no point on a
/// bisector is found, the vertex may lie elsewhere in the solid (docs/theory/medial-axis.md). The radius is the
/// distance to the surface, exact to 1e-9 of the solid's extent.
///
/// @return      the same bytes for any number of threads. Check report().topology_matches, which is true if the axis
/// has the topology of the solid. Sites of a mesh are those of SiteTable(mesh). For an image, distances are measured to
/// the faces between selected voxels and voxels that are not selected. Sites of an image are the voxels on the far side
/// of these faces. Such a voxel is not selected, or lies just outside the image. A voxel outside the image has the id
/// of the image's voxel next to it.
/// @throws InvalidMesh if no interior of a body is found (the message mentions triangles that face inwards). Also
/// thrown if the longest side of the box around the solid is below 5e-7 of the largest coordinate. InvalidOption;
/// OutOfMemory; Cancelled.
/// Cost: near-linear in the voxels of the solid; about 10 bytes of memory per voxel of the box around it.
/// Method: docs/theory/medial-axis.md (Sud 2006, ch. 5; Liu, Chambers, Letscher, Ju 2010; Chaussard, Couprie 2009).
[[nodiscard]] MedialAxis medial_axis(const Solid& solid, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// Computes the medial axis of Solid::of(mesh). Segments and points are ignored.
/// @throws as Solid::of(), and as medial_axis() of a Solid.
[[nodiscard]] MedialAxis medial_axis(const MeshView& mesh, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// Computes the medial axis of Solid::of(image, options.selection).
/// @throws as Solid::of(), and as medial_axis() of a Solid.
[[nodiscard]] MedialAxis medial_axis(const VoxelImageView& image, const MedialAxisOptions& options = {},
                                     const Context& context = {});

}  // namespace blum
