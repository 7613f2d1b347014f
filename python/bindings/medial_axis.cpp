#include "blum/medial_axis/medial_axis.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/axis/collapse_axis.hpp"
#include "blum/axis/decimate.hpp"
#include "blum/axis/prune_sheets.hpp"
#include "blum/certified/certified_axis.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/complex/sample_axis.hpp"
#include "blum/field/ball_union.hpp"
#include "call.hpp"
#include "images.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

using NumbersIn = In<double, nb::shape<-1>>;

void check_length(const char* name, std::size_t length, std::size_t wanted) {
  if (length == wanted) return;
  throw InvalidOption(std::string(name) + " has " + std::to_string(length) + " entries, but must have " +
                      std::to_string(wanted));
}

void bind_axis(nb::module_& m) {
  nb::class_<MedialAxis>(m, "MedialAxis")
      .def(
          "simplify",
          [](const MedialAxis& axis, double theta) {
            return run({0, nb::none()}, [&](const Context& context) { return axis.simplify(theta, context); });
          },
          nb::arg("theta"))
      .def(
          "fitted",
          [](const MedialAxis& axis, double theta) {
            return run({0, nb::none()}, [&](const Context& context) { return axis.fitted(theta, context); });
          },
          nb::arg("theta"))
      .def("nested",
           [](const MedialAxis& axis) {
             return run({0, nb::none()}, [&](const Context& context) { return axis.nested(context); });
           })
      .def_prop_ro("least_theta", &MedialAxis::least_theta)
      .def_prop_ro("greatest_theta", &MedialAxis::greatest_theta)
      .def_prop_ro("report", [](const MedialAxis& axis) { return result_of(axis.report()); });
  m.def(
      "medial_axis_of_mesh",
      [](const MeshArrays& mesh, const nb::dict& given, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const auto options = options_from<MedialAxisOptions>(given);
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return medial_axis(view, options, context); });
      },
      nb::arg("mesh"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "medial_axis_of_image",
      [](const ImageArrays& image, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<MedialAxisOptions>(given);
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return medial_axis(image.view, options, context); });
      },
      nb::arg("image"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

using VerifyAxis = FunctionRef<Certificate(const Complex& axis, const MedialClaims& claims, const Context& context)>;

/// Runs certified_axes() at one angle, starting from an existing axis of all angles. Returns (complex, deviation,
/// fitted, report, certificate, mismatches, warnings). The deviation bounds the distance from the axis with all
/// vertices. It is None if the complex has all vertices.
/// @param mesh, medial  input and options of the axis, to compute it again on a moved grid; nullptr for an image.
nb::tuple certified(const MedialAxis& first, const MeshView* mesh, const MedialAxisOptions& medial, VerifyAxis verify,
                    const CertifiedAxisOptions& options, int threads, nb::object progress) {
  CertifiedAxes made = run({threads, std::move(progress)}, [&](const Context& context) {
    const auto on_grid = [&](double shift) {
      if (shift == medial.grid_shift) return std::shared_ptr<const MedialAxis>(std::shared_ptr<void>(), &first);
      MedialAxisOptions moved = medial;
      moved.grid_shift = shift;
      return std::shared_ptr<const MedialAxis>(std::make_shared<const MedialAxis>(medial_axis(*mesh, moved, context)));
    };
    const auto certify = [&](const AxisCandidate& axis) { return verify(axis.axis.axis, {axis.metadata}, context); };
    return certified_axes({medial.grid_shift, mesh != nullptr, on_grid}, certify, options, context);
  });
  CertifiedAxis& axis = made.axes.front();
  std::vector<Warning>& warnings = made.warnings;
  warnings.insert(warnings.end(), axis.warnings.begin(), axis.warnings.end());
  return nb::make_tuple(std::move(axis.axis.axis), axis.metadata.deviation, axis.metadata.fitted,
                        result_of(made.report), result_of(axis.certificate), made.mismatches, result_of(warnings));
}

void bind_certified(nb::module_& m) {
  m.def(
      "certified_axis_of_mesh",
      [](const MedialAxis& first, const MeshAxisVerifier& verifier, const MeshArrays& mesh, const nb::dict& given,
         double theta, std::optional<double> tolerance, int threads, nb::object progress) {
        const auto options = options_from<MedialAxisOptions>(given);
        const MeshView view = mesh.view();
        const auto verify = [&](const Complex& axis, const MedialClaims& claims, const Context& context) {
          return verifier.verify(axis, claims, {}, HUGE_VAL, context);
        };
        return certified(first, &view, options, verify, {{theta}, tolerance}, threads, std::move(progress));
      },
      nb::arg("first"), nb::arg("verifier"), nb::arg("mesh"), nb::arg("options"), nb::arg("theta"),
      nb::arg("tolerance").none(), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "certified_axis_of_image",
      [](const MedialAxis& first, const ImageAxisVerifier& verifier, std::optional<std::int64_t> label,
         std::optional<double> threshold, double theta, std::optional<double> tolerance, int threads,
         nb::object progress) {
        const LabelSelection selection = LabelSelection::of(label, threshold);
        const auto verify = [&](const Complex& axis, const MedialClaims& claims, const Context& context) {
          return verifier.verify(axis, claims, selection, {}, context);
        };
        return certified(first, nullptr, {}, verify, {{theta}, tolerance}, threads, std::move(progress));
      },
      nb::arg("first"), nb::arg("verifier"), nb::arg("label").none(), nb::arg("threshold").none(), nb::arg("theta"),
      nb::arg("tolerance").none(), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace

void bind_medial_axis(nb::module_& m) {
  // Columns contain the numbers of roles, which are indices of blum.ROLES.
  static_assert([] {
    std::size_t number = 0;
    for (const auto& named : Description<MedialRole>::values) {
      if (static_cast<std::size_t>(named.value) != number++) return false;
    }
    return true;
  }());
  static_cast<void>(type_name<MedialRole>(m));
  bind_options<MedialAxisOptions>(m);
  bind_struct<MedialAxisReport>(m);
  bind_axis(m);
  bind_certified(m);
  m.def("medial_counts", [](const Complex& axis) { return dict_of(count(CompleteAxis(axis).get())); }, nb::arg("axis"));
  m.def(
      "medial_problem", [](const Complex& axis) { return problem_of_medial(CompleteAxis(axis).get()); },
      nb::arg("axis"));
  m.def("missing_medial_column", &missing_medial_column, nb::arg("kind"), nb::arg("name"));
  m.def("sheet_count", &sheet_count, nb::arg("axis"));
  m.def(
      "prune_sheets",
      [](const Complex& complex, double theta, int threads, nb::object progress) {
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return prune_sheets(complex, theta, context); });
      },
      nb::arg("complex"), nb::arg("theta"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "collapse_axis",
      [](const Complex& complex, double theta, int threads, nb::object progress) {
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return collapse_axis(complex, theta, context); });
      },
      nb::arg("complex"), nb::arg("theta"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "decimate",
      [](const Complex& complex, double tolerance, int threads, nb::object progress) {
        DecimatedAxis out = run({threads, std::move(progress)},
                                [&](const Context& context) { return decimate(complex, tolerance, context); });
        return nb::make_tuple(std::move(out.axis), out.deviation);
      },
      nb::arg("complex"), nb::arg("tolerance"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "sample_axis",
      [](const Complex& axis, double step) {
        const CompleteAxis all(axis);
        const std::vector<AxisSample> samples = sample_axis(MedialView(all.get()), step);
        std::vector<Vec3d> centres(samples.size());
        std::vector<double> radii(samples.size());
        for (std::size_t k = 0; k < samples.size(); ++k) {
          centres[k] = samples[k].position;
          radii[k] = samples[k].radius;
        }
        return nb::make_tuple(handed_over<double>(std::move(centres), 3), handed_over<double>(std::move(radii)));
      },
      nb::arg("axis"), nb::arg("step"));
  m.def(
      "ball_union_field",
      [](const PointsIn& centres, const NumbersIn& radii, const GridSpec& grid, int threads, nb::object progress) {
        check_length("radii", radii.shape(0), centres.shape(0));
        std::vector<Ball> balls(centres.shape(0));
        for (std::size_t b = 0; b < balls.size(); ++b) balls[b] = {vectors(centres)[b], radii.data()[b]};
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return ball_union_field(balls, grid, context); });
      },
      nb::arg("centres").noconvert(), nb::arg("radii").noconvert(), nb::arg("grid"), nb::arg("threads"),
      nb::arg("progress").none());
}

}  // namespace blum::python
