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
  std::vector<double> thetas{60};  ///< degrees, each once: an axis for each; rising where sheets are pruned
  /// Vertices go within it (decimate()), mesh units, >= 0; 0 keeps all, and borders of sheets at the cells of the grid.
  /// Default: a quarter of the smallest side of a voxel.
  std::optional<double> tolerance = {};
  bool prunes_sheets = false;  ///< whole sheets of at most theta go, each angle from the one before (prune_sheets())
  OptionStyle style = OptionStyle::python;  ///< of options in what mismatches say to do
};

/// An axis that waits for its certificate.
struct AxisCandidate {
  const DecimatedAxis& axis;
  const MedialMetadata& metadata;  ///< of how it was made; source, version and what was selected stay unset
  const MedialAxis* whole;         ///< the axis of all angles that it was taken from; nullptr where none was
  double grid_shift;               ///< MedialAxisOptions::grid_shift of this, voxels
  std::vector<PhaseTime>& phases;  ///< of the whole run, to add to
};

/// How axes are certified: a program that writes files looks at what it wrote.
using CertifyAxis = FunctionRef<Certificate(const AxisCandidate&)>;

/// An axis at one angle, in the best of its forms that is certified, or in the last one.
struct CertifiedAxis {
  DecimatedAxis axis;
  MedialMetadata metadata;  ///< as AxisCandidate::metadata
  Certificate certificate;  ///< certified_axes(): look whether it holds
  /// Why better forms were not taken (WarningCode::form_not_certified); empty where the best one holds, and where none
  /// does: then the certificate of the last one says why.
  std::vector<Warning> warnings;
};

/// Axes of one solid at several angles, made on one grid.
struct CertifiedAxes {
  std::vector<CertifiedAxis> axes;  ///< in the order of the angles
  MedialAxisReport report;          ///< on the grid that was kept
  double grid_shift = 0;            ///< of this, voxels
  std::vector<Warning> warnings;    ///< of the grid; those of each axis are with it
  /// All that is not certified, one sentence each: model_problems(), then "at theta 60: ..." of each axis.
  std::vector<std::string> mismatches;
  std::vector<PhaseTime> phases;  ///< seconds; also of grids that were tried in vain

  /// Whether the model of the solid passes and all axes are certified.
  [[nodiscard]] bool holds() const { return mismatches.empty(); }
};

/// The grids that axes of a solid may be made on.
struct AxisGrids {
  double shift = 0;      ///< MedialAxisOptions::grid_shift of the first one, voxels, from -1 to 1
  bool may_move = true;  ///< of an image, it may not
  /// The axis of all angles with a value of MedialAxisOptions::grid_shift.
  FunctionRef<std::shared_ptr<const MedialAxis>(double shift)> make;
};

/// The axes of a solid as `blum medial` writes them. Each is tried in forms, the best first: with its borders where
/// they belong and few vertices; with few vertices; as the cells have it. The last one is as good as the cells; the
/// others are for people, and where walls are thin one may fail that the next one does not. Parts much thinner than a
/// voxel may lie badly in one grid and well in the next: where an axis is not certified in any form although the model
/// of its solid passes, the grid is moved by a part of a voxel, at most three times, and the grid with the fewest
/// mismatches is kept.
/// @throws InvalidOption; what make and certify throw; as MedialAxis::lean(), decimate() and prune_sheets(). An axis
/// that is not certified is no error: look at holds(). Cost: that of make and of certify for each form and grid that is
/// tried, mostly one.
[[nodiscard]] CertifiedAxes certified_axes(const AxisGrids& grids, CertifyAxis certify,
                                           const CertifiedAxisOptions& options = {}, const Context& context = {});

/// The same of a mesh, certified by MeshAxisVerifier. @param medial  its angles are those of the options.
/// @throws InvalidMesh, OutOfMemory, as medial_axis(), and as above.
[[nodiscard]] CertifiedAxes certified_axes(const MeshView& mesh, const CertifiedAxisOptions& options = {},
                                           const MedialAxisOptions& medial = {}, const Context& context = {});
/// The same of MedialAxisOptions::selection of an image, certified by ImageAxisVerifier.
/// @throws InvalidImage, OutOfMemory, as medial_axis(), and as above.
[[nodiscard]] CertifiedAxes certified_axes(const VoxelImageView& image, const CertifiedAxisOptions& options = {},
                                           const MedialAxisOptions& medial = {}, const Context& context = {});

/// The axis of a mesh at one angle, certified. @param theta  degrees.  @param tolerance  as CertifiedAxisOptions.
/// @return  with all warnings. @throws NotCertified; as certified_axes().
[[nodiscard]] CertifiedAxis certified_axis(const MeshView& mesh, double theta, const MedialAxisOptions& medial = {},
                                           std::optional<double> tolerance = {}, const Context& context = {});
/// The same of an axis that is there, on its grid alone. @param axis  medial_axis(mesh).
[[nodiscard]] CertifiedAxis certified_axis(const MedialAxis& axis, const MeshView& mesh, double theta,
                                           std::optional<double> tolerance = {}, const Context& context = {});

/// An axis that was made in another way, as of a Voronoi complex: with few vertices if it is certified so, else with
/// all. An axis that is not certified is no error.
/// @param whole      with all vertices.
/// @param metadata   of it: theta is in warnings.
/// @param tolerance  as CertifiedAxisOptions, but 0 by default.
[[nodiscard]] CertifiedAxis certified_axis(Complex whole, const MedialMetadata& metadata, double tolerance,
                                           CertifyAxis certify, std::vector<PhaseTime>& phases,
                                           const Context& context = {});

/// The smallest side of a voxel of any body, mesh units.
[[nodiscard]] double least_spacing(const MedialAxisReport& report);

/// How an axis was made: what a file says of it but source, version and what was selected.
[[nodiscard]] MedialMetadata medial_metadata(const MedialAxis& axis, double theta);

/// Where the model of a solid does not pass, and what there is to do about it: one sentence for each body.
/// @param style  of the options that it names.
[[nodiscard]] std::vector<std::string> model_problems(const MedialAxisReport& report,
                                                      OptionStyle style = OptionStyle::python);

}  // namespace blum
