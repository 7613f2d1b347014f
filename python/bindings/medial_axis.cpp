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
#include "blum/medial_axis/ball_union.hpp"
#include "blum/medial_axis/prune_sheets.hpp"
#include "call.hpp"
#include "columns.hpp"
#include "fields.hpp"
#include "images.hpp"

namespace blum::python {
namespace {

using AnglesIn = In<float, nb::shape<-1>>;
using RolesIn = In<std::uint8_t, nb::shape<-1>>;
using NumbersIn = In<double, nb::shape<-1>>;

void check_length(const char* name, std::size_t length, std::size_t wanted) {
  if (length == wanted) return;
  throw InvalidOption(std::string(name) + " has " + std::to_string(length) + " entries, but must have " +
                      std::to_string(wanted));
}

std::vector<MedialVertex> vertices_of(const PointsIn& positions, const NumbersIn& radius, const PointsIn& footprints,
                                      const SegmentsIn& sites, const NumbersIn& angle, const RolesIn& role) {
  std::vector<MedialVertex> out(positions.shape(0));
  check_length("radius", radius.shape(0), out.size());
  check_length("footprints", footprints.shape(0), 2 * out.size());
  check_length("sites", sites.shape(0), out.size());
  check_length("separation_angle", angle.shape(0), out.size());
  check_length("role", role.shape(0), out.size());
  const auto feet = vectors(footprints);
  const auto ids = rows<std::array<std::uint32_t, 2>>(sites);
  for (std::size_t v = 0; v < out.size(); ++v) {
    out[v] = {vectors(positions)[v],
              radius.data()[v],
              {feet[2 * v], feet[2 * v + 1]},
              {SiteId(ids[v][0]), SiteId(ids[v][1])},
              angle.data()[v],
              static_cast<MedialRole>(role.data()[v])};
  }
  return out;
}

/// What complexes of one angle and of all have in common.
template <class Complex>
void bind_columns(nb::class_<Complex>& complex) {
  using Edge = typename decltype(Complex::edges)::value_type;
  using Face = typename decltype(Complex::triangles)::value_type;
  bind_column(complex, "vertices", &Complex::vertices, &MedialVertex::position);
  bind_column(complex, "radius", &Complex::vertices, &MedialVertex::radius);
  bind_column(complex, "footprints", &Complex::vertices, &MedialVertex::footprints);
  bind_column(complex, "sites", &Complex::vertices, &MedialVertex::sites);
  bind_column(complex, "separation_angle", &Complex::vertices, &MedialVertex::separation_angle);
  bind_column(complex, "role", &Complex::vertices, &MedialVertex::role);
  bind_column(complex, "edges", &Complex::edges, &Edge::vertices);
  bind_column(complex, "edge_angle", &Complex::edges, &Edge::separation_angle);
  bind_column(complex, "edge_role", &Complex::edges, &Edge::role);
  bind_column(complex, "triangles", &Complex::triangles, &Face::vertices);
  bind_column(complex, "triangle_angle", &Complex::triangles, &Face::separation_angle);
  bind_column(complex, "triangle_sheet", &Complex::triangles, &Face::sheet);
  complex.def_ro("sheet_count", &Complex::sheet_count);
}

void bind_nested(nb::module_& m) {
  nb::class_<NestedComplex> nested(m, "NestedComplex");
  bind_columns(nested);
  nested.def_ro("least_theta", &NestedComplex::least_theta);
  nested.def_prop_ro("vertex_until", [](nb::pointer_and_handle<NestedComplex> self) {
    const std::vector<float>& all = self.p->vertex_until;
    return view_of(all.data(), {all.size()}, self.h);
  });
  bind_column(nested, "edge_from", &NestedComplex::edges, &NestedEdge::from);
  bind_column(nested, "edge_until", &NestedComplex::edges, &NestedEdge::until);
  bind_column(nested, "triangle_until", &NestedComplex::triangles, &NestedTriangle::until);
}

void bind_complex(nb::module_& m) {
  nb::class_<MedialComplex> complex(m, "MedialComplex");
  bind_columns(complex);
  complex
      .def(
          "__init__",
          [](MedialComplex* self, const PointsIn& positions, const NumbersIn& radius, const PointsIn& footprints,
             const SegmentsIn& sites, const NumbersIn& angle, const RolesIn& role, const SegmentsIn& edges,
             const AnglesIn& edge_angle, const RolesIn& edge_role, const TrianglesIn& triangles,
             const AnglesIn& triangle_angle, const IndicesIn& sheet, std::uint32_t sheet_count) {
            MedialComplex complex;
            complex.vertices = vertices_of(positions, radius, footprints, sites, angle, role);
            complex.edges.resize(edges.shape(0));
            check_length("edge_angle", edge_angle.shape(0), complex.edges.size());
            check_length("edge_role", edge_role.shape(0), complex.edges.size());
            for (std::size_t e = 0; e < complex.edges.size(); ++e) {
              complex.edges[e] = {rows<std::array<std::uint32_t, 2>>(edges)[e], edge_angle.data()[e],
                                  static_cast<MedialRole>(edge_role.data()[e])};
            }
            complex.triangles.resize(triangles.shape(0));
            check_length("triangle_angle", triangle_angle.shape(0), complex.triangles.size());
            check_length("triangle_sheet", sheet.shape(0), complex.triangles.size());
            for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
              complex.triangles[t] = {rows<Triangle>(triangles)[t], triangle_angle.data()[t],
                                      static_cast<std::uint32_t>(sheet.data()[t])};
            }
            complex.sheet_count = sheet_count;
            new (self) MedialComplex(std::move(complex));
          },
          nb::arg("positions").noconvert(), nb::arg("radius").noconvert(), nb::arg("footprints").noconvert(),
          nb::arg("sites").noconvert(), nb::arg("separation_angle").noconvert(), nb::arg("role").noconvert(),
          nb::arg("edges").noconvert(), nb::arg("edge_angle").noconvert(), nb::arg("edge_role").noconvert(),
          nb::arg("triangles").noconvert(), nb::arg("triangle_angle").noconvert(),
          nb::arg("triangle_sheet").noconvert(), nb::arg("sheet_count"))
      .def("counts", [](const MedialComplex& complex) {
        const MedialCounts counts = count(complex);
        nb::dict out;
        out["vertices"] = counts.vertices;
        out["triangles"] = counts.triangles;
        out["sheets"] = counts.sheets;
        out["curve_edges"] = counts.curve_edges;
        out["rim_edges"] = counts.rim_edges;
        out["seam_edges"] = counts.seam_edges;
        out["junctions"] = counts.junctions;
        return out;
      });
}

nb::dict body_of(const BodyReport& body) {
  nb::dict out;
  out["solid"] = nb::cast(body.solid);
  out["voxels"] = nb::cast(body.voxels);
  out["is_right"] = body.is_right;
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
  out["turned_shells"] = report.turned_shells;
  out["solid"] = nb::cast(report.solid);
  out["voxels"] = nb::cast(report.voxels);
  out["is_right"] = report.is_right;
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
          "extract",
          [](const MedialAxis& axis, double theta) {
            return run({0, nb::none()}, [&](const Context&) { return axis.extract(theta); });
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
  bind_complex(m);
  bind_nested(m);
  bind_axis(m);
  m.def(
      "prune_sheets",
      [](const MedialComplex& complex, double theta, int threads, nb::object progress) {
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
