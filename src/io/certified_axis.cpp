#include "blum/io/certified_axis.hpp"

#include <utility>

namespace blum {

CertifiedAxis first_certified(std::span<const AxisForm> forms, FunctionRef<DecimatedAxis(const AxisForm&)> make,
                              FunctionRef<Certificate(const DecimatedAxis&)> certify) {
  CertifiedAxis out;
  for (const AxisForm& form : forms) {
    out.axis = make(form);
    out.certificate = certify(out.axis);
    if (out.certificate.holds()) return out;
    out.warnings.push_back(form.without + out.certificate.mismatches.front());
  }
  out.warnings.clear();
  return out;
}

CertifiedAxis certified_axis(const MedialAxis& axis, const MeshView& mesh, double theta,
                             std::optional<double> tolerance, const Context& context) {
  return certified_axis(axis, AxisVerifier(mesh), theta, tolerance, context);
}

CertifiedAxis certified_axis(const MedialAxis& axis, const AxisVerifier& verifier, double theta,
                             std::optional<double> tolerance, const Context& context) {
  const auto certificate = [&](const DecimatedAxis& made) {
    CertificateOptions options;
    options.theta = theta;
    options.lambda = axis.lambda();
    options.spacing = axis.report().bodies.front().spacing;
    if (made.deviation > 0) options.deviation = made.deviation;
    return verifier.certify(made.axis, options, context);
  };
  return first_certified(
      axis_forms(axis.report(), tolerance),
      [&](const AxisForm& form) { return axis_in_form(axis, theta, form, context); }, certificate);
}

CertifiedAxis certified_axis(const MeshView& mesh, double theta, const MedialAxisOptions& options,
                             std::optional<double> tolerance, const Context& context) {
  const Solid solid = Solid::of(mesh, context);
  const AxisVerifier verifier(mesh);
  bool model_passes = false;
  const auto on_grid = [&](double shift) {
    MedialAxisOptions moved = options;
    moved.grid_shift = shift;
    const MedialAxis axis = medial_axis(solid, moved, context);
    model_passes = axis.report().topology_matches;
    return certified_axis(axis, verifier, theta, tolerance, context);
  };
  CertifiedAxis first = on_grid(options.grid_shift);
  return model_passes ? certified_on_some_grid(std::move(first), options.grid_shift, on_grid) : first;
}

CertifiedAxis certified_on_some_grid(CertifiedAxis first, double grid_shift, FunctionRef<CertifiedAxis(double)> make) {
  for (const MovedGrid& grid : moved_grids(grid_shift)) {
    if (first.certificate.holds()) break;
    CertifiedAxis moved = make(grid.shift);
    if (!moved.certificate.holds()) continue;
    moved.warnings.insert(moved.warnings.begin(), grid.as_it_was + first.certificate.mismatches.front());
    return moved;
  }
  return first;
}

}  // namespace blum
