#include "blum/medial_axis/medial_axis.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/field/ball_union.hpp"
#include "blum/medial_axis/prune_sheets.hpp"
#include "call.hpp"
#include "fields.hpp"
#include "images.hpp"

namespace blum::python {
namespace {

using NumbersIn = In<double, nb::shape<-1>>;

void check_length(const char* name, std::size_t length, std::size_t wanted) {
  if (length == wanted) return;
  throw InvalidOption(std::string(name) + " has " + std::to_string(length) + " entries, but must have " +
                      std::to_string(wanted));
}

nb::dict counts_of(const Complex& axis) {
  const MedialCounts counts = count(axis);
  nb::dict out;
  out["vertices"] = counts.vertices;
  out["triangles"] = counts.triangles;
  out["sheets"] = counts.sheets;
  out["curve_edges"] = counts.curve_edges;
  out["rim_edges"] = counts.rim_edges;
  out["seam_edges"] = counts.seam_edges;
  out["junctions"] = counts.junctions;
  return out;
}

nb::dict body_of(const BodyReport& body) {
  nb::dict out;
  out["solid"] = nb::cast(body.solid);
  out["voxels"] = nb::cast(body.voxels);
  out["topology_matches"] = body.topology_matches;
  out["spacing"] = body.spacing;
  out["voxel_count"] = body.voxel_count;
  out["left_out"] = body.left_out;
  out["taken_in"] = body.taken_in;
  out["deviation"] = body.deviation;
  return out;
}

nb::dict report_of(const MedialAxisReport& report) {
  nb::dict out;
  out["rule"] = std::string(to_string(report.rule));
  out["reason"] = report.reason;
  out["reversed_shells"] = report.reversed_shells;
  out["solid"] = nb::cast(report.solid);
  out["voxels"] = nb::cast(report.voxels);
  out["topology_matches"] = report.topology_matches;
  out["grid"] = nb::cast(report.grid);
  nb::list bodies;
  for (const BodyReport& body : report.bodies) bodies.append(body_of(body));
  out["bodies"] = bodies;
  out["phases"] = phases_of(report.phases);
  return out;
}

void bind_axis(nb::module_& m) {
  nb::class_<MedialAxis>(m, "MedialAxis")
      .def(
          "simplify",
          [](const MedialAxis& axis, double theta) {
            return run({0, nb::none()}, [&](const Context&) { return axis.simplify(theta); });
          },
          nb::arg("theta"))
      .def("nested",
           [](const MedialAxis& axis) { return run({0, nb::none()}, [&](const Context&) { return axis.nested(); }); })
      .def_prop_ro("report", [](const MedialAxis& axis) { return report_of(axis.report()); });
  m.def(
      "medial_axis_of_mesh",
      [](const MeshArrays& mesh, int resolution, std::optional<double> spacing, int max_resolution, double lambda,
         double least_theta, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        MedialAxisOptions options;
        options.resolution = resolution;
        options.spacing = spacing;
        options.max_resolution = max_resolution;
        options.lambda = lambda;
        options.least_theta = least_theta;
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return medial_axis(view, options, context); });
      },
      nb::arg("mesh"), nb::arg("resolution"), nb::arg("spacing").none(), nb::arg("max_resolution"), nb::arg("lambda_"),
      nb::arg("least_theta"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "medial_axis_of_image",
      [](const ImageArrays& image, std::optional<std::int64_t> label, std::optional<double> threshold, double lambda,
         double least_theta, int threads, nb::object progress) {
        MedialAxisOptions options;
        if (label) options.selection = LabelSelection::of_label(*label);
        if (threshold) options.selection = LabelSelection::at_least(*threshold);
        options.lambda = lambda;
        options.least_theta = least_theta;
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return medial_axis(image.view, options, context); });
      },
      nb::arg("image"), nb::arg("label").none(), nb::arg("threshold").none(), nb::arg("lambda_"),
      nb::arg("least_theta"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace

void bind_medial_axis(nb::module_& m) {
  bind_axis(m);
  m.def("medial_counts", &counts_of, nb::arg("axis"));
  m.def("medial_problem", &problem_of_medial, nb::arg("axis"));
  m.def("sheet_count", &sheet_count, nb::arg("axis"));
  m.def(
      "prune_sheets",
      [](const Complex& complex, double theta, int threads, nb::object progress) {
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return prune_sheets(complex, theta, context); });
      },
      nb::arg("complex"), nb::arg("theta"), nb::arg("threads"), nb::arg("progress").none());
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
