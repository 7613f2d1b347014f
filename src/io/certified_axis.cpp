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
  const auto certificate = [&](const DecimatedAxis& made) {
    CertificateOptions options;
    options.theta = theta;
    options.lambda = axis.lambda();
    options.spacing = axis.report().bodies.front().spacing;
    if (made.deviation > 0) options.deviation = made.deviation;
    return certify(made.axis, mesh, options, context);
  };
  return first_certified(
      axis_forms(axis.report(), tolerance),
      [&](const AxisForm& form) { return axis_in_form(axis, theta, form, context); }, certificate);
}

}  // namespace blum
