#include "blum/medial_axis/certificate.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "call.hpp"
#include "images.hpp"

namespace blum::python {
namespace {

nb::dict geometry_of(const GeometryCheck& check) {
  nb::dict out;
  out["vertices"] = check.vertices;
  out["not_finite"] = check.not_finite;
  out["outside"] = check.outside;
  out["outside_by"] = check.outside_by;
  out["radius_error"] = check.radius_error;
  out["footprint_off_surface"] = check.footprint_off_surface;
  out["footprint_error"] = check.footprint_error;
  out["site_error"] = check.site_error;
  out["angle_error"] = check.angle_error;
  out["tolerance"] = check.tolerance;
  out["holds"] = check.holds;
  return out;
}

nb::dict edges_of(const EdgeCheck& check) {
  nb::dict out;
  out["edges"] = check.edges;
  out["pushed"] = check.pushed;
  out["pushed_by"] = check.pushed_by;
  out["outside"] = check.outside;
  out["outside_by"] = check.outside_by;
  out["where"] = triple(check.where);
  out["tolerance"] = check.tolerance;
  out["holds"] = check.holds;
  return out;
}

nb::dict balls_of(const BallUnionCheck& check) {
  nb::dict out;
  out["solid_to_balls"] = check.solid_to_balls;
  out["mean_solid_to_balls"] = check.mean_solid_to_balls;
  out["balls_beyond_solid"] = check.balls_beyond_solid;
  out["balls_to_surface"] = check.balls_to_surface;
  out["step"] = check.step;
  return out;
}

nb::dict certificate_of(const Certificate& certificate) {
  nb::dict out;
  out["against"] = std::string(to_string(certificate.against));
  out["solid"] = nb::cast(certificate.solid);
  out["axis"] = nb::cast(certificate.axis);
  nb::list bodies;
  for (const BodyCheck& body : certificate.bodies) bodies.append(nb::make_tuple(body.solid, body.axis));
  out["bodies"] = bodies;
  out["topology_holds"] = certificate.topology_holds;
  out["geometry"] = geometry_of(certificate.geometry);
  out["edges"] = edges_of(certificate.edges);
  out["balls"] = balls_of(certificate.balls);
  out["mismatches"] = certificate.mismatches;
  return out;
}

}  // namespace

void bind_certificate(nb::module_& m) {
  m.def(
      "homology",
      [](std::size_t vertex_count, const SegmentsIn& edges, const TrianglesIn& triangles, int threads,
         nb::object progress) {
        const ComplexView view{vertex_count, rows<std::array<std::uint32_t, 2>>(edges), rows<Triangle>(triangles)};
        return run({threads, std::move(progress)}, [&](const Context& context) { return homology(view, context); });
      },
      nb::arg("vertex_count"), nb::arg("edges").noconvert(), nb::arg("triangles").noconvert(), nb::arg("threads"),
      nb::arg("progress").none());
  m.def(
      "solid_rule",
      [](const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const MeshSolidRule rule =
            run({threads, std::move(progress)}, [&](const Context& context) { return solid_rule(view, context); });
        return std::pair(std::string(to_string(rule.rule)), rule.reason);
      },
      nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "certify_mesh",
      [](const MedialComplex& complex, const MeshArrays& mesh, bool positions, bool radii, bool footprints, bool angles,
         bool sites, bool balls, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const CertificateOptions options{positions, radii, footprints, angles, sites, balls};
        return certificate_of(run({threads, std::move(progress)},
                                  [&](const Context& context) { return certify(complex, view, options, context); }));
      },
      nb::arg("complex"), nb::arg("mesh"), nb::arg("positions"), nb::arg("radii"), nb::arg("footprints"),
      nb::arg("angles"), nb::arg("sites"), nb::arg("balls"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "certify_voxels",
      [](const MedialComplex& complex, const MaskIn& mask, const GridSpec& grid, bool positions, bool radii,
         bool footprints, bool angles, bool sites, bool balls, int threads, nb::object progress) {
        const CertificateOptions options{positions, radii, footprints, angles, sites, balls};
        return certificate_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return certify(complex, voxel_set(mask), grid, nullptr, options, context);
        }));
      },
      nb::arg("complex"), nb::arg("mask").noconvert(), nb::arg("grid"), nb::arg("positions"), nb::arg("radii"),
      nb::arg("footprints"), nb::arg("angles"), nb::arg("sites"), nb::arg("balls"), nb::arg("threads"),
      nb::arg("progress").none());
  m.def(
      "certify_winding",
      [](const MedialComplex& complex, const MeshArrays& mesh, const GridSpec& grid, bool positions, bool radii,
         bool footprints, bool angles, bool sites, bool balls, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const CertificateOptions options{positions, radii, footprints, angles, sites, balls};
        return certificate_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return certify(complex, voxels_inside(view, grid, context), grid, &view, options, context);
        }));
      },
      nb::arg("complex"), nb::arg("mesh"), nb::arg("grid"), nb::arg("positions"), nb::arg("radii"),
      nb::arg("footprints"), nb::arg("angles"), nb::arg("sites"), nb::arg("balls"), nb::arg("threads"),
      nb::arg("progress").none());
}

}  // namespace blum::python
