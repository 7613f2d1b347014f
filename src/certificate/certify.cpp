#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "certificate/bounding_mesh.hpp"
#include "certificate/checks.hpp"
#include "certificate/homology/homology_check.hpp"
#include "certificate/medial_check.hpp"
#include "certificate/scaling.hpp"
#include "certificate/shells.hpp"

namespace blum {
namespace {

using verifier::factor_for;
using verifier::Location;
using verifier::scaled;
using verifier::ScaledMesh;

void scale_back(BallUnionCheck& balls, double factor) {
  for (double* value : {&balls.solid_to_balls, &balls.mean_solid_to_balls, &balls.balls_beyond_solid,
                        &balls.balls_to_surface, &balls.step}) {
    *value /= factor;
  }
}

BettiNumbers sum(const std::vector<BettiNumbers>& all) {
  BettiNumbers total{};
  for (const BettiNumbers& one : all) {
    for (std::size_t k = 0; k < 3; ++k) total[k] += one[k];
  }
  return total;
}

std::string counted(std::int64_t count, const char* thing) {
  return count_text(static_cast<std::uint64_t>(count)) + " " + thing + (count == 1 ? "" : "s");
}

/// Compares body by body. @param name  of a body, by its number.
template <class Name>
void compare_topology(Certificate& certificate, const Name& name) {
  constexpr std::array<const char*, 3> things{"component", "tunnel", "void"};
  constexpr std::size_t most_named = 8;
  std::size_t wrong = 0;
  for (std::size_t b = 0; b < certificate.bodies.size(); ++b) {
    const BodyCheck& body = certificate.bodies[b];
    if (body.solid == body.axis) continue;
    if (++wrong > most_named) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (body.solid[k] == body.axis[k]) continue;
      certificate.mismatches.push_back(name(b) + " has " + counted(body.solid[k], things[k]) + ", the axis " +
                                       (certificate.bodies.size() > 1 ? "in it " : "") +
                                       count_text(static_cast<std::uint64_t>(body.axis[k])));
    }
  }
  certificate.topology_holds = wrong == 0;
  if (wrong > most_named) {
    certificate.mismatches.push_back("the axis in " + std::to_string(wrong - most_named) + " bodies more is wrong");
  }
}

Certificate certify_against(const Complex& complex, const verifier::KnownSolid& solid, double factor,
                            const CertificateOptions& options, const Context& context) {
  Certificate certificate;
  certificate.checked = options;
  certificate.solid = sum(solid.bodies);
  if (!options.positions) {
    certificate.axis = homology(complex.view(), context);
    certificate.bodies = {{certificate.solid, certificate.axis}};
    compare_topology(certificate, [](std::size_t) { return std::string("the solid"); });
    certificate.homology.shown = "nothing: places were not looked at";
    return certificate;
  }
  const MedialView axis(complex);
  const std::vector<Location> locations = verifier::locate_vertices(axis, *solid.solid, context);
  const auto body_count = static_cast<std::uint32_t>(solid.bodies.size());
  const verifier::AxisParts parts = verifier::parts_in_bodies(axis.cells(), locations, body_count, context);
  certificate.axis = sum(parts.betti);
  for (std::size_t b = 0; b < body_count; ++b) certificate.bodies.push_back({solid.bodies[b], parts.betti[b]});
  const auto name = [&](std::size_t b) {
    if (body_count == 1) return std::string("the solid");
    const Vec3d at = solid.solid->box(static_cast<std::uint32_t>(b)).center() / factor;
    return "body " + std::to_string(b + 1) + " of " + std::to_string(body_count) + " (around " +
           verifier::place_text(at) + ")";
  };
  compare_topology(certificate, name);
  certificate.geometry =
      verifier::check_vertices(axis, solid, locations, certificate.checked, factor, certificate.mismatches, context);
  verifier::check_claims(certificate.checked, solid.solid->diagonal() / factor, certificate.mismatches);
  const Incidence incidence(axis.cells(), context);
  verifier::EdgeWays ways;
  certificate.edges =
      verifier::check_edges(axis, incidence, solid, locations, parts, factor, ways, certificate.mismatches, context);
  certificate.homology =
      verifier::check_homology({axis, incidence, solid, locations, parts, ways, factor, certificate.edges.untold},
                               certificate.edges.holds && certificate.geometry.not_finite == 0, certificate.bodies,
                               name, certificate.mismatches, context);
  certificate.triangles = verifier::check_triangles(axis, solid, locations, parts, certificate.checked, factor,
                                                    certificate.mismatches, context);
  if (certificate.checked.labels) {
    certificate.labels = verifier::check_labels(axis, incidence, certificate.mismatches, context);
  }
  if (certificate.checked.angles) {
    certificate.angles = verifier::check_angles(axis, incidence, solid, parts.body_of, certificate.checked, factor,
                                                certificate.mismatches, context);
  }
  if (certificate.checked.medial) {
    certificate.medial = verifier::check_medial(axis, solid, parts.body_of, certificate.checked, factor,
                                                certificate.mismatches, context);
  }
  if (!certificate.checked.balls) return certificate;
  certificate.balls = verifier::check_balls(axis, *solid.solid, locations, context);
  scale_back(certificate.balls, factor);
  return certificate;
}

/// The solid of a mesh, and the meshes that it refers to.
struct BoundedSolid {
  ScaledMesh given;
  std::optional<verifier::BoundingMesh> bounding;
  std::optional<ScaledMesh> own;
  verifier::KnownSolid solid;

  BoundedSolid(const MeshView& mesh, double factor, const Context& context) : given(mesh, factor) {
    // Nearly always the mesh will do as it is, and is read once.
    if (find_self_intersections(mesh, 0, context).complete) {
      try {
        solid = verifier::solid_of_mesh(given.view, given.view, context);
        return;
      } catch (const verifier::NoPolyhedron&) {  // NOLINT(bugprone-empty-catch): the next lines resolve it or say why
      }
    }
    bounding.emplace(mesh, context);
    own.emplace(bounding->view(), factor);
    solid = verifier::solid_of_mesh(own->view, given.view, context);
  }
};

/// With what nothing can be said of left out.
CertificateOptions consistent(CertificateOptions options) {
  options.radii = options.radii && options.positions;
  options.footprints = options.footprints && options.radii;
  options.angles = options.angles && options.footprints;
  options.sites = options.sites && options.footprints;
  options.labels = options.labels && options.positions;
  options.balls = options.balls && options.radii;
  options.medial = options.medial && options.radii;
  return options;
}

/// Nothing but places.
constexpr CertificateOptions only_places{.positions = true,
                                         .radii = false,
                                         .footprints = false,
                                         .angles = false,
                                         .sites = false,
                                         .labels = false,
                                         .balls = false,
                                         .medial = false};

/// The cells of a complex, with columns of which nothing is looked at.
Complex with_medial_columns(const Complex& complex) {
  Complex out;
  out.positions = complex.positions;
  out.edges = complex.edges;
  out.triangles = complex.triangles;
  add_missing_medial_columns(out);
  return out;
}

}  // namespace

Certificate certify_topology(const Complex& complex, const MeshView& mesh, const Context& context) {
  return certify(with_medial_columns(complex), mesh, only_places, context);
}

Certificate certify_topology(const Complex& complex, const VoxelSet& voxels, const GridSpec& grid,
                             const MeshView* surface, const Context& context) {
  return certify(with_medial_columns(complex), voxels, grid, surface, only_places, context);
}

Certificate certify(const Complex& axis, const MeshView& mesh, const CertificateOptions& options,
                    const Context& context) {
  validate(mesh);
  const double factor = factor_for(bounds(mesh).diagonal());
  const BoundedSolid known(mesh, factor, context);
  const verifier::KnownSolid& solid = known.solid;
  return certify_against(factor == 1 ? axis : scaled(axis, factor), solid, factor, consistent(options), context);
}

Certificate certify(const Complex& axis, const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                    const CertificateOptions& options, const Context& context) {
  validate(grid);
  if (grid.size != voxels.size()) throw InvalidOption("the grid of a certificate is not that of its voxels");
  if (voxels.count() == 0) throw InvalidOption("there are no voxels, and so no solid to check an axis against");
  if (surface != nullptr) validate(*surface);
  const double factor = factor_for(length(grid.spacing));
  GridSpec own_grid = grid;
  own_grid.origin *= factor;
  own_grid.spacing *= factor;
  const ScaledMesh own(surface == nullptr ? MeshView{} : *surface, factor);
  const verifier::KnownSolid solid =
      verifier::solid_of_voxels(voxels, own_grid, surface == nullptr ? nullptr : &own.view, context);
  Certificate certificate =
      certify_against(factor == 1 ? axis : scaled(axis, factor), solid, factor, consistent(options), context);
  certificate.voxel = std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  certificate.against = surface == nullptr ? SolidRule::voxels : SolidRule::winding;
  return certificate;
}

}  // namespace blum
