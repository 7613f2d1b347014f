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
  std::vector<double> thetas{60};  ///< Degrees, each once, one axis per angle. Ascending if sheets are pruned.
  /// Tolerance for removing vertices (decimate()), mesh units, >= 0. 0 keeps all vertices, and the borders of sheets at
  /// the cells of the grid. Default: a quarter of the smallest side of a voxel.
  std::optional<double> tolerance = {};
  bool prunes_sheets = false;               ///< Removes whole sheets (prune_sheets()), each angle from the axis before.
  OptionStyle style = OptionStyle::python;  ///< Form of the options that mismatches recommend.
};

/// Axis to be certified.
struct AxisCandidate {
  const DecimatedAxis& axis;
  const MedialMetadata& metadata;  ///< Describes how it was made; source, version and selection are unset.
  const MedialAxis* whole;         ///< Axis of all angles from which it was taken; nullptr if none was.
  double grid_shift;               ///< MedialAxisOptions::grid_shift of that axis, voxels.
  std::vector<PhaseTime>& phases;  ///< Phases of the whole run, to be extended.
};

/// Certifies an axis. A program that writes files checks the written file.
using CertifyAxis = FunctionRef<Certificate(const AxisCandidate&)>;

/// Axis at one angle, in the best form that is certified, or in the last form.
struct CertifiedAxis {
  DecimatedAxis axis;
  MedialMetadata metadata;  ///< As AxisCandidate::metadata.
  Certificate certificate;  ///< May fail in results of certified_axes(): check Certificate::holds().
  /// Reasons against better forms (WarningCode::form_not_certified). Empty if the best form is certified. Also empty if
  /// no form is; then the certificate of the last one gives the reasons.
  std::vector<Warning> warnings;
};

/// Axes of one solid at several angles, made on one grid.
struct CertifiedAxes {
  std::vector<CertifiedAxis> axes;  ///< In the order of the angles.
  MedialAxisReport report;          ///< For the grid that was kept.
  double grid_shift = 0;            ///< Shift of that grid, voxels.
  std::vector<Warning> warnings;    ///< Warnings about the grid; each axis has its own.
  /// One sentence for each failure: model_problems(), then "at theta 60: ..." of each axis.
  std::vector<std::string> mismatches;
  std::vector<PhaseTime> phases;  ///< Seconds, including grids that were tried in vain.

  /// Returns true if the model of the solid passes and all axes are certified.
  [[nodiscard]] bool holds() const { return mismatches.empty(); }
};

/// Grids on which axes of a solid may be made.
struct AxisGrids {
  double shift = 0;      ///< MedialAxisOptions::grid_shift of the first grid, -1 to 1 voxels.
  bool may_move = true;  ///< False for an image.
  /// Computes the axis of all angles with a value of MedialAxisOptions::grid_shift.
  FunctionRef<std::shared_ptr<const MedialAxis>(double shift)> make;
};

/// Returns the axes of a solid as `blum medial` writes them.
///
/// Each axis is tried in up to three forms, the best first. The first has fitted borders and few vertices, the second
/// few vertices, the third all vertices, as the cells have them. Where walls are thin, a form may fail that the next
/// one passes. The last form is as good as the cells; the others are for people.
///
/// Parts much thinner than a voxel may lie badly in one grid and well in another. So the grid is moved by part of a
/// voxel if an axis is not certified in any form although the model passes. At most three other grids are tried, and
/// the grid with the fewest mismatches is kept.
/// @throws InvalidOption; as `make` and `certify`; as MedialAxis::lean(), decimate() and prune_sheets(). An axis that
/// is not certified is not an error: check holds().
/// Cost: `make` and `certify` for each form and grid that is tried, mostly one.
[[nodiscard]] CertifiedAxes certified_axes(const AxisGrids& grids, CertifyAxis certify,
                                           const CertifiedAxisOptions& options = {}, const Context& context = {});

/// Returns the axes of a mesh, certified by MeshAxisVerifier.
/// @param medial  its angles are replaced by those of the options.
/// @throws InvalidMesh; OutOfMemory; as medial_axis(); as certified_axes() above.
[[nodiscard]] CertifiedAxes certified_axes(const MeshView& mesh, const CertifiedAxisOptions& options = {},
                                           const MedialAxisOptions& medial = {}, const Context& context = {});
/// Returns the axes of MedialAxisOptions::selection of an image, certified by ImageAxisVerifier.
/// @throws InvalidImage; OutOfMemory; as medial_axis(); as certified_axes() above.
[[nodiscard]] CertifiedAxes certified_axes(const VoxelImageView& image, const CertifiedAxisOptions& options = {},
                                           const MedialAxisOptions& medial = {}, const Context& context = {});

/// Returns the certified axis of a mesh at one angle.
/// @param theta  degrees.
/// @param tolerance  as in CertifiedAxisOptions.
/// @return  with all warnings.
/// @throws NotCertified; as certified_axes().
[[nodiscard]] CertifiedAxis certified_axis(const MeshView& mesh, double theta, const MedialAxisOptions& medial = {},
                                           std::optional<double> tolerance = {}, const Context& context = {});
/// Returns the certified axis at one angle of an existing axis, whose grid is not moved.
/// @param axis  result of medial_axis(mesh).
/// @throws NotCertified; as certified_axes().
[[nodiscard]] CertifiedAxis certified_axis(const MedialAxis& axis, const MeshView& mesh, double theta,
                                           std::optional<double> tolerance = {}, const Context& context = {});

/// Certifies an axis that was made in another way, for example from a Voronoi complex. Returns it with few vertices if
/// that form is certified, else with all. An axis that is not certified is not an error.
/// @param whole      axis with all vertices.
/// @param metadata   of that axis; warnings mention its theta.
/// @param tolerance  as in CertifiedAxisOptions, but without a default; 0 keeps all vertices.
[[nodiscard]] CertifiedAxis certified_axis(Complex whole, const MedialMetadata& metadata, double tolerance,
                                           CertifyAxis certify, std::vector<PhaseTime>& phases,
                                           const Context& context = {});

/// Returns the smallest side of a voxel of any body, mesh units.
[[nodiscard]] double least_spacing(const MedialAxisReport& report);

/// Returns the metadata of an axis, without source, version and selection.
[[nodiscard]] MedialMetadata medial_metadata(const MedialAxis& axis, double theta);

/// Returns one sentence for each body whose model does not pass, with advice.
/// @param style  form of the options that it names.
[[nodiscard]] std::vector<std::string> model_problems(const MedialAxisReport& report,
                                                      OptionStyle style = OptionStyle::python);

}  // namespace blum
