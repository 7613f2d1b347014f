#include "blum/medial_axis/medial_axis.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/axis/collapse_axis.hpp"
#include "blum/axis/decimate.hpp"
#include "blum/axis/prune_sheets.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/complex/sample_axis.hpp"
#include "blum/field/ball_union.hpp"
#include "blum/medial_axis/axis_forms.hpp"
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
      .def(
          "lean",
          [](const MedialAxis& axis, double theta, double tolerance, int threads, nb::object progress) {
            DecimatedAxis out = run({threads, std::move(progress)},
                                    [&](const Context& context) { return axis.lean(theta, tolerance, context); });
            return nb::make_tuple(std::move(out.axis), out.deviation, out.vertices_before);
          },
          nb::arg("theta"), nb::arg("tolerance"), nb::arg("threads"), nb::arg("progress").none())
      .def("nested",
           [](const MedialAxis& axis) {
             return run({0, nb::none()}, [&](const Context& context) { return axis.nested(context); });
           })
      .def(
          "forms",
          [](const MedialAxis& axis, std::optional<double> tolerance) {
            nb::list out;
            for (const AxisForm& form : axis_forms(axis.report(), tolerance)) {
              out.append(nb::make_tuple(form.is_fitted, form.tolerance, form.without));
            }
            return out;
          },
          nb::arg("tolerance").none())
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

}  // namespace

void bind_medial_axis(nb::module_& m) {
  m.def(
      "moved_grids",
      [](double grid_shift) {
        nb::list grids;
        for (const MovedGrid& grid : moved_grids(grid_shift)) grids.append(nb::make_tuple(grid.shift, grid.as_it_was));
        return grids;
      },
      nb::arg("grid_shift"));
  // Columns hold numbers, and blum.ROLES is indexed by them.
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
