// Blum: medial axes that are certified. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/certificate/axis_verifier.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/medial_axis/axis_forms.hpp"

namespace blum {

/// An axis in the best of its forms that is certified, or in the last one.
struct CertifiedAxis {
  DecimatedAxis axis;
  Certificate certificate;  ///< look whether it holds
  /// Why better forms were not taken, one sentence each; empty where the best one holds, and where none does: then the
  /// certificate of the last one says why.
  std::vector<std::string> warnings;
};

/// The first of some forms that is certified.
/// @param forms    not empty. They are tried in turn.
/// @param make     the axis in a form.
/// @param certify  its certificate.
/// @throws what these throw.
[[nodiscard]] CertifiedAxis first_certified(std::span<const AxisForm> forms,
                                            FunctionRef<DecimatedAxis(const AxisForm&)> make,
                                            FunctionRef<Certificate(const DecimatedAxis&)> certify);

/// The axis of a mesh at an angle as `blum medial` writes it: with its borders where they belong and few vertices, if
/// it is certified so; else simpler, see axis_forms().
/// @param axis       medial_axis(mesh).
/// @param verifier   AxisVerifier(mesh): one for all angles and grids.
/// @param theta      degrees.
/// @param tolerance  as for axis_forms().
/// @throws InvalidOption, Cancelled, as MedialAxis::fitted(), decimate() and certify(). Cost: theirs for each form that
/// is tried, mostly one.
[[nodiscard]] CertifiedAxis certified_axis(const MedialAxis& axis, const AxisVerifier& verifier, double theta,
                                           std::optional<double> tolerance = {}, const Context& context = {});

/// The same with a verifier for this axis alone.
[[nodiscard]] CertifiedAxis certified_axis(const MedialAxis& axis, const MeshView& mesh, double theta,
                                           std::optional<double> tolerance = {}, const Context& context = {});

/// The same from the mesh on. Where no form is certified although the model of the solid passes, the grid is moved by a
/// part of a voxel (moved_grids()), and warnings say so.
/// @throws InvalidMesh, OutOfMemory, as medial_axis(), and as above. Cost: of medial_axis() and of the above for each
/// grid that is tried, nearly always one.
[[nodiscard]] CertifiedAxis certified_axis(const MeshView& mesh, double theta, const MedialAxisOptions& options = {},
                                           std::optional<double> tolerance = {}, const Context& context = {});

/// What is first if it is certified, or the first that is of those on grids that are moved a little, or else what is
/// first. @param make  for a value of MedialAxisOptions::grid_shift. @throws what this throws.
[[nodiscard]] CertifiedAxis certified_on_some_grid(CertifiedAxis first, double grid_shift,
                                                   FunctionRef<CertifiedAxis(double)> make);

}  // namespace blum
