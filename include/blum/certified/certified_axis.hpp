// Blum: medial axes in the best form that is certified. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/certified/axis_solid.hpp"
#include "blum/certified/medial_metadata.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/medial_axis/medial_axis.hpp"

namespace blum {

struct CertifiedAxisOptions {
  std::vector<double> thetas{60};  ///< Angles of the axes, degrees, each once; ascending if sheets are pruned.
  /// Tolerance for removing vertices (decimate()), mesh units, >= 0. With 0, all vertices stay, and borders of sheets
  /// follow the cells of the grid. Default: a quarter of the smallest side of a voxel.
  std::optional<double> tolerance = {};
  /// If true, whole sheets are removed (prune_sheets()) instead of parts of sheets. The axis at each angle is made by
  /// pruning the axis at the previous angle.
  bool prunes_sheets = false;
  OptionStyle style = OptionStyle::python;  ///< Form of options in the sentences of `mismatches`.
};

/// Axis to be certified.
struct AxisCandidate {
  const DecimatedAxis& axis;
  const MedialMetadata& metadata;  ///< Describes how the axis was made; source, version and selection are unset.
  const MedialAxis* whole;         ///< Axis of all angles from which this axis was made; nullptr if none.
  double grid_shift;               ///< MedialAxisOptions::grid_shift of `whole`, voxels.
  std::vector<PhaseTime>& phases;  ///< Times of all phases so far; CertifyAxis may append further phases.
};

/// Function that certifies an axis. If a program writes the axis to a file, this function should check the written
/// file.
using CertifyAxis = FunctionRef<Certificate(const AxisCandidate&)>;

/// Axis at one angle, in the best form that is certified (see certified_axes()). If no form is certified, `axis` has
/// the last form.
struct CertifiedAxis {
  DecimatedAxis axis;
  MedialMetadata metadata;  ///< As AxisCandidate::metadata.
  Certificate certificate;  ///< The certificate may fail in results of certified_axes(): check Certificate::holds().
  /// Reasons why better forms are not used (WarningCode::form_not_certified). Empty if the best form is certified, or
  /// if no form is certified. If no form is certified, `certificate` contains the mismatches of the last form.
  std::vector<Warning> warnings;
};

/// Axes of one solid at several angles, made on one grid.
struct CertifiedAxes {
  std::vector<CertifiedAxis> axes;  ///< Axes in the order of CertifiedAxisOptions::thetas.
  MedialAxisReport report;          ///< Report of the construction on the grid that was kept.
  double grid_shift = 0;            ///< MedialAxisOptions::grid_shift of the grid that was kept, voxels.
  /// Warnings about the grid. Warnings about one axis are in CertifiedAxis::warnings.
  std::vector<Warning> warnings;
  /// One sentence for each failure: first the sentences of model_problems(), then those of each axis ("at theta 60:
  /// ...").
  std::vector<std::string> mismatches;
  std::vector<PhaseTime> phases;  ///< Time of each phase, including grids that were not kept.

  /// Returns true if model_problems() reports no problem and all axes are certified.
  [[nodiscard]] bool holds() const { return mismatches.empty(); }
};

/// Grids on which axes of a solid may be made.
struct AxisGrids {
  double shift = 0;      ///< MedialAxisOptions::grid_shift of the first grid, -1 to 1 voxels.
  bool may_move = true;  ///< True if other shifts may be tried; false for an image.
  /// Computes the axis of all angles on the grid with this MedialAxisOptions::grid_shift.
  FunctionRef<std::shared_ptr<const MedialAxis>(double shift)> make;
};

/// Returns the axes of a solid in the form in which `blum medial` writes them.
///
/// Each axis is made in up to four forms, until one form is certified. The first form has few vertices, and borders of
/// sheets fitted to the surface. The second form has all vertices and fitted borders. The third form has few vertices,
/// and borders that follow the cells of the grid. The fourth form has all vertices, and borders that follow the cells
/// of the grid. If walls are thin, a form may fail although the next form is certified. The fourth form has the full
/// detail of the grid's cells. The first three forms are easier to view.
///
/// Walls much thinner than a voxel may be represented badly on one grid and well on another. If an axis is not
/// certified in any form, the function moves the grid by a fraction of a voxel and tries again. The grid is moved only
/// if model_problems() reports no problem. At most three other grids are tried. The grid with the fewest mismatches is
/// kept.
/// @throws InvalidOption if an option is out of range. The function also throws the exceptions of `make`, `certify`,
/// MedialAxis::lean(), decimate() and prune_sheets(). Nothing is thrown if an axis is not certified: check holds().
/// Cost: one call of `make` for each grid, and one call of `certify` for each grid, angle and form. In most cases, one
/// grid and one form are enough.
[[nodiscard]] CertifiedAxes certified_axes(const AxisGrids& grids, CertifyAxis certify,
                                           const CertifiedAxisOptions& options = {}, const Context& context = {});

/// Returns the axes of a mesh, certified by MeshAxisVerifier.
/// @param medial  options of the construction; the angles in `options` replace `least_theta` and `greatest_theta`.
/// @throws InvalidMesh; OutOfMemory; as medial_axis(); as certified_axes() above.
[[nodiscard]] CertifiedAxes certified_axes(const MeshView& mesh, const CertifiedAxisOptions& options = {},
                                           const MedialAxisOptions& medial = {}, const Context& context = {});
/// Returns the axes of the voxels that MedialAxisOptions::selection selects in an image, certified by
/// ImageAxisVerifier.
/// @throws InvalidImage; OutOfMemory; as medial_axis(); as certified_axes() above.
[[nodiscard]] CertifiedAxes certified_axes(const VoxelImageView& image, const CertifiedAxisOptions& options = {},
                                           const MedialAxisOptions& medial = {}, const Context& context = {});

/// Returns the certified axis of a mesh at one angle.
/// @param theta  degrees.
/// @param tolerance  as in CertifiedAxisOptions.
/// @return  axis whose `warnings` also contain the warnings about the grid and the construction.
/// @throws NotCertified; as certified_axes().
[[nodiscard]] CertifiedAxis certified_axis(const MeshView& mesh, double theta, const MedialAxisOptions& medial = {},
                                           std::optional<double> tolerance = {}, const Context& context = {});
/// Returns the certified axis at one angle, taken from an existing axis of all angles. The grid is not moved.
/// @param axis  result of medial_axis(mesh).
/// @throws NotCertified; as certified_axes().
[[nodiscard]] CertifiedAxis certified_axis(const MedialAxis& axis, const MeshView& mesh, double theta,
                                           std::optional<double> tolerance = {}, const Context& context = {});

/// Certifies an axis that was made in another way, for example from a Voronoi complex. Returns the axis with few
/// vertices if this form is certified; otherwise, returns the axis with all vertices. Nothing is thrown if the axis is
/// not certified: check Certificate::holds().
/// @param whole      axis with all vertices.
/// @param metadata   metadata of that axis; warnings mention its theta.
/// @param tolerance  as in CertifiedAxisOptions, but without a default; 0 keeps all vertices.
[[nodiscard]] CertifiedAxis certified_axis(Complex whole, const MedialMetadata& metadata, double tolerance,
                                           CertifyAxis certify, std::vector<PhaseTime>& phases,
                                           const Context& context = {});

/// Returns the smallest side of a voxel over all bodies, mesh units.
[[nodiscard]] double least_spacing(const MedialAxisReport& report);

/// Returns the metadata of an axis, without source, version and selection.
[[nodiscard]] MedialMetadata medial_metadata(const MedialAxis& axis, double theta);

/// Returns one sentence, with advice, for each body whose cellular model has another topology than the body.
/// @param style  form of the options in these sentences.
[[nodiscard]] std::vector<std::string> model_problems(const MedialAxisReport& report,
                                                      OptionStyle style = OptionStyle::python);

}  // namespace blum
