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
#include "fields.hpp"
#include "images.hpp"

namespace blum::python {
namespace {

using AnglesIn = In<float, nb::shape<-1>>;
using RolesIn = In<std::uint8_t, nb::shape<-1>>;
using NumbersIn = In<double, nb::shape<-1>>;

/// Steps between entries, in elements of a member's type.
template <class Entry, class T>
constexpr std::int64_t step = sizeof(Entry) / sizeof(T);
static_assert(sizeof(MedialVertex) % sizeof(double) == 0 && sizeof(MedialEdge) % sizeof(float) == 0 &&
              sizeof(MedialTriangle) % sizeof(float) == 0);

/// The first of some entries, or one that stands for it where there are none.
template <class Entry>
const Entry& first_of(const std::vector<Entry>& entries) {
  static const Entry none{};
  return entries.empty() ? none : entries.front();
}

/// A view of one number of every entry.
template <class T, class Entry, class Member>
Out<const T> column(const std::vector<Entry>& entries, const Member& first, nb::handle owner) {
  return view_of(reinterpret_cast<const T*>(&first), {entries.size()}, owner, {step<Entry, T>});
}
/// A view of several numbers of every entry, which follow each other.
template <class T, class Entry, class Member>
Out<const T> columns(const std::vector<Entry>& entries, const Member& first, std::size_t count, nb::handle owner) {
  return view_of(reinterpret_cast<const T*>(&first), {entries.size(), count}, owner, {step<Entry, T>, 1});
}

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

void bind_complex(nb::module_& m) {
  using Self = nb::pointer_and_handle<MedialComplex>;
  nb::class_<MedialComplex>(m, "MedialComplex")
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
      .def_prop_ro("vertices",
                   [](Self self) {
                     const auto& all = self.p->vertices;
                     return columns<double>(all, first_of(all).position, 3, self.h);
                   })
      .def_prop_ro("radius",
                   [](Self self) {
                     const auto& all = self.p->vertices;
                     return column<double>(all, first_of(all).radius, self.h);
                   })
      .def_prop_ro("footprints",
                   [](Self self) {
                     const auto& all = self.p->vertices;
                     return view_of(&first_of(all).footprints[0].x, {all.size(), 2, 3}, self.h,
                                    {step<MedialVertex, double>, 3, 1});
                   })
      .def_prop_ro("sites",
                   [](Self self) {
                     const auto& all = self.p->vertices;
                     return columns<std::int32_t>(all, first_of(all).sites, 2, self.h);
                   })
      .def_prop_ro("separation_angle",
                   [](Self self) {
                     const auto& all = self.p->vertices;
                     return column<double>(all, first_of(all).separation_angle, self.h);
                   })
      .def_prop_ro("role",
                   [](Self self) {
                     const auto& all = self.p->vertices;
                     return column<std::uint8_t>(all, first_of(all).role, self.h);
                   })
      .def_prop_ro("edges",
                   [](Self self) {
                     const auto& all = self.p->edges;
                     return columns<std::int32_t>(all, first_of(all).vertices, 2, self.h);
                   })
      .def_prop_ro("edge_angle",
                   [](Self self) {
                     const auto& all = self.p->edges;
                     return column<float>(all, first_of(all).separation_angle, self.h);
                   })
      .def_prop_ro("edge_role",
                   [](Self self) {
                     const auto& all = self.p->edges;
                     return column<std::uint8_t>(all, first_of(all).role, self.h);
                   })
      .def_prop_ro("triangles",
                   [](Self self) {
                     const auto& all = self.p->triangles;
                     return columns<std::int32_t>(all, first_of(all).vertices, 3, self.h);
                   })
      .def_prop_ro("triangle_angle",
                   [](Self self) {
                     const auto& all = self.p->triangles;
                     return column<float>(all, first_of(all).separation_angle, self.h);
                   })
      .def_prop_ro("triangle_sheet",
                   [](Self self) {
                     const auto& all = self.p->triangles;
                     return column<std::int32_t>(all, first_of(all).sheet, self.h);
                   })
      .def_ro("sheet_count", &MedialComplex::sheet_count)
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
