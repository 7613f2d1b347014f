#include "blum/certificate/certificate.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/verify_medial.hpp"
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

/// What an axis says of itself: version, solid_rule, site_ids, grid (or None), has_radii and so on.
MedialClaims claims_from(const nb::dict& told) {
  MedialClaims claims;
  claims.metadata.version = nb::cast<std::string>(told["version"]);
  claims.metadata.solid_rule = nb::cast<std::string>(told["solid_rule"]);
  const auto sites = nb::cast<std::string>(told["site_ids"]);
  claims.metadata.site_ids = sites == to_string(SiteIds::voxels) ? SiteIds::voxels : SiteIds::features;
  const nb::object grid = told["grid"];
  if (!grid.is_none()) claims.metadata.grid = nb::cast<GridSpec>(grid);
  claims.has_radii = nb::cast<bool>(told["has_radii"]);
  claims.has_footprints = nb::cast<bool>(told["has_footprints"]);
  claims.has_angles = nb::cast<bool>(told["has_angles"]);
  claims.has_sites = nb::cast<bool>(told["has_sites"]);
  return claims;
}

}  // namespace

void bind_certificate(nb::module_& m) {
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
      "verify_mesh",
      [](const Complex& complex, const nb::dict& claims, const MeshArrays& mesh, bool positions, bool radii,
         bool footprints, bool angles, bool sites, bool balls, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const MedialClaims said = claims_from(claims);
        const CertificateOptions options{positions, radii, footprints, angles, sites, balls};
        return certificate_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return verify(complex, said, view, options, HUGE_VAL, context);
        }));
      },
      nb::arg("complex"), nb::arg("claims"), nb::arg("mesh"), nb::arg("positions"), nb::arg("radii"),
      nb::arg("footprints"), nb::arg("angles"), nb::arg("sites"), nb::arg("balls"), nb::arg("threads"),
      nb::arg("progress").none());
  m.def(
      "verify_image",
      [](const Complex& complex, const nb::dict& claims, const ImageArrays& image, std::optional<std::int64_t> label,
         std::optional<double> threshold, bool positions, bool radii, bool footprints, bool angles, bool sites,
         bool balls, int threads, nb::object progress) {
        const MedialClaims said = claims_from(claims);
        LabelSelection selection;
        if (label) selection = LabelSelection::of_label(*label);
        if (threshold) selection = LabelSelection::at_least(*threshold);
        const CertificateOptions options{positions, radii, footprints, angles, sites, balls};
        return certificate_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return verify(complex, said, image.view, selection, options, context);
        }));
      },
      nb::arg("complex"), nb::arg("claims"), nb::arg("image"), nb::arg("label").none(), nb::arg("threshold").none(),
      nb::arg("positions"), nb::arg("radii"), nb::arg("footprints"), nb::arg("angles"), nb::arg("sites"),
      nb::arg("balls"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace blum::python
