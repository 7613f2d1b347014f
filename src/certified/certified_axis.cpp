#include "blum/certified/certified_axis.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "blum/axis/prune_sheets.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/plural.hpp"
#include "blum/solid/solid_rule.hpp"

namespace blum {
namespace {

/// A way to derive the axis of one angle theta from the axes of all angles.
struct AxisForm {
  bool is_fitted = false;  ///< true: by MedialAxis::lean(); false: by simplify()
  double tolerance = 0;    ///< largest deviation when vertices are removed; 0: no vertex is removed
};

/// A form that is not certified.
struct FailedForm {
  AxisForm form;
  std::string mismatch;
};

constexpr std::string_view without_borders =
    "borders of sheets stay at the cells of the grid; with moved borders, the axis is not certified: ";
constexpr std::string_view without_few_vertices =
    "the axis keeps all vertices; with fewer vertices, it is not certified: ";

double checked_tolerance(double tolerance) {
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
    throw InvalidOption("the tolerance of an axis must be a finite number of at least 0");
  }
  return tolerance;
}

/// Returns the forms to try, in the order of preference.
/// @param is_given  true if sheets were pruned. In this case, the axis exists only as a complex, which lean() cannot
///                  fit.
std::vector<AxisForm> forms_of(const MedialAxisReport& report, std::optional<double> tolerance, bool is_given) {
  const double most = checked_tolerance(tolerance.value_or(0.25 * least_spacing(report)));
  std::vector<AxisForm> forms;
  if (most > 0 && report.rule == SolidRule::polyhedron && !is_given) {
    forms.push_back({true, most});
    forms.push_back({true, 0});
  }
  if (most > 0) forms.push_back({false, most});
  forms.push_back({false, 0});
  return forms;
}

/// Returns one warning for each property that the certified form lacks, and a form that was not certified has.
std::vector<Warning> warnings_of(const std::vector<FailedForm>& failed, const AxisForm& kept, const std::string& of) {
  std::vector<Warning> out;
  const auto add = [&](std::string_view without, const auto& has) {
    const auto last = std::find_if(failed.rbegin(), failed.rend(), [&](const FailedForm& f) { return has(f.form); });
    if (last == failed.rend()) return;
    out.push_back({WarningCode::form_not_certified, of + " " + std::string(without) + last->mismatch});
  };
  if (!kept.is_fitted) add(without_borders, [](const AxisForm& form) { return form.is_fitted; });
  if (kept.tolerance == 0) add(without_few_vertices, [](const AxisForm& form) { return form.tolerance > 0; });
  return out;
}

DecimatedAxis with_all_vertices(Complex axis) {
  const std::size_t vertices = axis.positions.size();
  return {std::move(axis), 0, vertices};
}

DecimatedAxis in_form(const Complex& whole, const AxisForm& form, const Context& context) {
  return form.tolerance > 0 ? decimate(whole, form.tolerance, context) : with_all_vertices(whole);
}

DecimatedAxis in_form(const MedialAxis& axis, double theta, const AxisForm& form, const Context& context) {
  if (form.is_fitted) return axis.lean(theta, form.tolerance, context);
  return in_form(axis.simplify(theta, context), form, context);
}

std::string theta_text(const MedialMetadata& metadata) {
  return metadata.theta ? "at theta " + rounded_text(*metadata.theta) : "of the axis";
}

/// The function that certifies axes, its arguments, and the list to which the time is added.
struct Certifying {
  CertifyAxis certify;
  const MedialAxis* whole = nullptr;
  double grid_shift = 0;
  std::vector<PhaseTime>& phases;
};

/// Returns the axis in the first form that is certified. If no form is certified, returns the axis in the last form.
CertifiedAxis first_certified(const std::vector<AxisForm>& forms, const MedialMetadata& metadata,
                              FunctionRef<DecimatedAxis(const AxisForm&)> make, const Certifying& by) {
  CertifiedAxis out;
  std::vector<FailedForm> failed;
  for (const AxisForm& form : forms) {
    PhaseTimer timer(by.phases);
    out.axis = make(form);
    out.metadata = metadata;
    out.metadata.fitted = form.is_fitted;
    if (out.axis.axis.positions.size() < out.axis.vertices_before) out.metadata.deviation = out.axis.deviation;
    timer.lap("simplify");
    out.certificate = by.certify({out.axis, out.metadata, by.whole, by.grid_shift, by.phases});
    if (out.certificate.holds()) {
      out.warnings = warnings_of(failed, form, theta_text(metadata));
      return out;
    }
    failed.push_back({form, out.certificate.mismatches.front()});
  }
  return out;
}

/// Computes and certifies the axes of all requested angles on one grid.
CertifiedAxes axes_on(const AxisGrids& grids, double shift, CertifyAxis certify, const CertifiedAxisOptions& options,
                      const Context& context) {
  CertifiedAxes out;
  out.grid_shift = shift;
  const std::shared_ptr<const MedialAxis> axis = grids.make(shift);
  out.report = axis->report();
  out.phases = out.report.phases;
  out.mismatches = model_problems(out.report, options.style);
  const Certifying by{certify, axis.get(), shift, out.phases};
  const std::vector<AxisForm> forms = forms_of(out.report, options.tolerance, options.prunes_sheets);
  Complex pruned;
  if (options.prunes_sheets) pruned = axis->simplify(0, context);
  for (const double theta : options.thetas) {
    if (options.prunes_sheets) {
      PhaseTimer timer(out.phases);
      pruned = prune_sheets(pruned, theta, context);
      timer.lap("simplify");
    }
    const auto make = [&](const AxisForm& form) {
      return options.prunes_sheets ? in_form(pruned, form, context) : in_form(*axis, theta, form, context);
    };
    out.axes.push_back(first_certified(forms, medial_metadata(*axis, theta), make, by));
    for (const std::string& mismatch : out.axes.back().certificate.mismatches) {
      out.mismatches.push_back("at theta " + rounded_text(theta) + ": " + mismatch);
    }
  }
  return out;
}

/// Returns up to three further shifts of the grid to try, in voxels. The total shift stays within 1 voxel.
std::vector<double> steps_from(double grid_shift) {
  constexpr std::size_t most = 3;
  std::vector<double> out;
  for (const double step : {0.3, -0.3, 0.15, -0.15, 0.6, -0.6}) {
    if (out.size() < most && std::abs(grid_shift + step) <= 1) out.push_back(step);
  }
  return out;
}

/// Returns `medial` with the range of angles that certified_axes() needs.
MedialAxisOptions with_angles(MedialAxisOptions medial, const CertifiedAxisOptions& options) {
  const auto [least, most] = std::minmax_element(options.thetas.begin(), options.thetas.end());
  // Sheets are pruned as a whole, so the axis must contain whole sheets, which theta 0 ensures.
  medial.least_theta = options.prunes_sheets ? 0 : *least;
  medial.greatest_theta = options.prunes_sheets ? MedialAxisOptions{}.greatest_theta : *most;
  return medial;
}

void check(const CertifiedAxisOptions& options) {
  if (options.thetas.empty()) throw InvalidOption("thetas is empty: give at least one angle");
  for (auto theta = options.thetas.begin(); theta != options.thetas.end(); ++theta) {
    if (std::find(options.thetas.begin(), theta, *theta) != theta) {
      throw InvalidOption("thetas contain " + rounded_text(*theta) + " twice: give each angle once");
    }
  }
  if (options.tolerance) static_cast<void>(checked_tolerance(*options.tolerance));
  if (options.prunes_sheets && !std::is_sorted(options.thetas.begin(), options.thetas.end())) {
    throw InvalidOption(
        "thetas must increase if sheets are pruned, because each axis is pruned from that of the angle before it");
  }
}

CertifiedAxis the_only(CertifiedAxes axes) {
  if (!axes.holds()) throw NotCertified(std::move(axes.mismatches));
  CertifiedAxis out = std::move(axes.axes.front());
  std::vector<Warning> all = std::move(axes.warnings);
  all.insert(all.end(), axes.report.warnings.begin(), axes.report.warnings.end());
  all.insert(all.end(), out.warnings.begin(), out.warnings.end());
  out.warnings = std::move(all);
  return out;
}

/// Certifies an axis in memory, and adds the time to the candidate's phases.
Certificate timed(const AxisCandidate& candidate, FunctionRef<Certificate(const MedialClaims&)> verify) {
  PhaseTimer timer(candidate.phases);
  Certificate out = verify({candidate.metadata});
  timer.lap("certificate");
  return out;
}

/// Returns a function that certifies axes of a mesh in memory.
/// @param verifier, context  must outlive the returned function.
auto certified_by(const MeshAxisVerifier& verifier, const Context& context) {
  return [&verifier, &context](const AxisCandidate& candidate) {
    return timed(candidate, [&](const MedialClaims& claims) {
      return verifier.verify(candidate.axis.axis, claims, {}, 1e300, context);
    });
  };
}

std::string place_text(const Vec3d& p) {
  return "(" + rounded_text(p.x) + ", " + rounded_text(p.y) + ", " + rounded_text(p.z) + ")";
}

}  // namespace

double least_spacing(const MedialAxisReport& report) {
  double least = report.bodies.front().spacing;
  for (const BodyReport& body : report.bodies) least = std::min(least, body.spacing);
  return least;
}

MedialMetadata medial_metadata(const MedialAxis& axis, double theta) {
  const MedialAxisReport& report = axis.report();
  MedialMetadata out;
  out.site_ids = report.rule == SolidRule::voxels ? SiteIds::voxels : SiteIds::features;
  out.theta = theta;
  out.lambda = axis.lambda();
  out.spacing = least_spacing(report);
  out.solid_rule = to_string(report.rule);
  out.grid = report.grid;
  return out;
}

CertifiedAxes certified_axes(const AxisGrids& grids, CertifyAxis certify, const CertifiedAxisOptions& options,
                             const Context& context) {
  check(options);
  CertifiedAxes best = axes_on(grids, grids.shift, certify, options, context);
  const std::string reason = best.holds() ? "" : best.mismatches.front();
  const bool may_move = grids.may_move && best.report.topology_matches;
  for (const double step : steps_from(grids.shift)) {
    if (!may_move || best.holds()) break;
    CertifiedAxes next = axes_on(grids, grids.shift + step, certify, options, context);
    next.warnings.push_back({WarningCode::grid_moved,
                             "the grid was moved by " + rounded_text(step) + " voxels; before the move: " + reason});
    const bool is_better = next.report.topology_matches && next.mismatches.size() < best.mismatches.size();
    if (is_better) std::swap(best, next);
    // The times of grids that were not kept are included.
    best.phases.insert(best.phases.end(), next.phases.begin(), next.phases.end());
  }
  return best;
}

CertifiedAxes certified_axes(const MeshView& mesh, const CertifiedAxisOptions& options, const MedialAxisOptions& medial,
                             const Context& context) {
  check(options);
  const MeshAxisVerifier verifier(mesh);
  MedialAxisOptions moved = with_angles(medial, options);
  const auto make = [&](double shift) {
    moved.grid_shift = shift;
    return std::make_shared<const MedialAxis>(medial_axis(mesh, moved, context));
  };
  const auto certify = certified_by(verifier, context);
  return certified_axes({medial.grid_shift, true, make}, certify, options, context);
}

CertifiedAxes certified_axes(const VoxelImageView& image, const CertifiedAxisOptions& options,
                             const MedialAxisOptions& medial, const Context& context) {
  check(options);
  const ImageAxisVerifier verifier(image);
  const auto make = [&](double) {
    return std::make_shared<const MedialAxis>(medial_axis(image, with_angles(medial, options), context));
  };
  const auto certify = [&](const AxisCandidate& candidate) {
    return timed(candidate, [&](const MedialClaims& claims) {
      return verifier.verify(candidate.axis.axis, claims, medial.selection, {}, context);
    });
  };
  return certified_axes({0, false, make}, certify, options, context);
}

CertifiedAxis certified_axis(const MeshView& mesh, double theta, const MedialAxisOptions& medial,
                             std::optional<double> tolerance, const Context& context) {
  return the_only(certified_axes(mesh, {.thetas = {theta}, .tolerance = tolerance}, medial, context));
}

CertifiedAxis certified_axis(const MedialAxis& axis, const MeshView& mesh, double theta,
                             std::optional<double> tolerance, const Context& context) {
  const MeshAxisVerifier verifier(mesh);
  std::shared_ptr<const MedialAxis> same(std::shared_ptr<const MedialAxis>(), &axis);  // does not own the axis
  const auto certify = certified_by(verifier, context);
  return the_only(certified_axes({0, false, [&](double) { return same; }}, certify,
                                 {.thetas = {theta}, .tolerance = tolerance}, context));
}

CertifiedAxis certified_axis(Complex whole, const MedialMetadata& metadata, double tolerance, CertifyAxis certify,
                             std::vector<PhaseTime>& phases, const Context& context) {
  std::vector<AxisForm> forms;
  if (checked_tolerance(tolerance) > 0) forms.push_back({false, tolerance});
  forms.emplace_back();
  const auto make = [&](const AxisForm& form) {
    const bool is_last = form.tolerance == 0;
    return is_last ? with_all_vertices(std::exchange(whole, {})) : in_form(whole, form, context);
  };
  return first_certified(forms, metadata, make, {certify, nullptr, 0, phases});
}

std::vector<std::string> model_problems(const MedialAxisReport& report, OptionStyle style) {
  const std::string finer = style == OptionStyle::command_line ? "--max-resolution" : "max_resolution";
  std::vector<std::string> out;
  for (std::size_t b = 0; b < report.bodies.size(); ++b) {
    const BodyReport& body = report.bodies[b];
    if (body.topology_matches) continue;
    const std::vector<ModelFailure>& failures = body.failures;
    const Vec3d at = 0.5 * (failures.front().low + failures.front().high);
    const bool has_needle = std::any_of(failures.begin(), failures.end(), [](const ModelFailure& failure) {
      return failure.obstacle == ModelObstacle::slanted_needle;
    });
    const std::string advice =
        has_needle ? "fill the narrow holes, or rotate the part so that they run along a coordinate axis"
                   : "raise " + finer + ", or repair the mesh there";
    out.push_back("the model of " + (report.bodies.size() > 1 ? "body " + std::to_string(b + 1) : "the solid") +
                  " with voxels of side " + rounded_text(body.spacing) + " fails in " +
                  plural(failures.size(), "place", "places") + ", the first one at " + place_text(at) + " (" +
                  std::string(to_string(failures.front().obstacle)) + "): " + advice);
  }
  return out;
}

}  // namespace blum
