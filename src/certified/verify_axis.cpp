#include "blum/certified/verify_axis.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/plural.hpp"
#include "blum/field/smooth_surface.hpp"
#include "blum/field/voxels_inside.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/solid/solid_rule.hpp"

namespace blum {
namespace {

/// Returns the requested checks, without those for which the file lacks data. Claims of the file fill in options that
/// are not set.
CertificateOptions checkable(const MedialClaims& claims, SiteIds sites, CertificateOptions options) {
  options.radii = options.radii && claims.has_radii;
  options.balls = options.balls && claims.has_radii;
  options.footprints = options.footprints && claims.has_footprints;
  options.angles = options.angles && claims.has_angles;
  options.sites = options.sites && claims.has_sites && claims.metadata.site_ids == sites;
  options.labels = options.labels && claims.has_labels;
  const MedialMetadata& metadata = claims.metadata;
  options.medial = options.medial && claims.has_radii && (claims.has_angles || metadata.theta);
  const auto take = [](std::optional<double>& own, const std::optional<double>& said) {
    if (!own) own = said;
  };
  take(options.theta, metadata.theta);
  take(options.lambda, metadata.lambda);
  take(options.spacing, metadata.spacing);
  take(options.deviation, metadata.deviation);
  options.fitted = options.fitted || metadata.fitted;
  return options;
}

bool has_same_sides(const GridSpec& a, const GridSpec& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(std::abs(a.spacing[axis] - b.spacing[axis]) <= 1e-9 * b.spacing[axis])) return false;
  }
  return true;
}

bool has_sides(const GridSpec& grid, double side) {
  GridSpec cubes = grid;
  cubes.spacing = {side, side, side};
  return has_same_sides(grid, cubes);
}

std::string sides_text(const GridSpec& grid) {
  return rounded_text(grid.spacing.x) + " " + rounded_text(grid.spacing.y) + " " + rounded_text(grid.spacing.z);
}

/// Reports the vertices that lack a site of a footprint. In a file that Blum wrote, every vertex has both sites.
std::vector<std::string> missing_sites(const MedialView& axis, const MedialClaims& claims) {
  std::size_t count = 0;
  for (std::size_t v = 0; v < axis.positions.size(); ++v) {
    count += axis.site(v, 0).has_value() && axis.site(v, 1).has_value() ? 0 : 1;
  }
  if (count == 0) return {};
  return {"the file says that Blum " + claims.metadata.version + " wrote it, but " +
          plural(count, "vertex has", "vertices have") + " a footprint without a site"};
}

/// @throws InvalidGrid if the longest side of a mesh has fewer than 8 voxels, the number in Blum's coarsest grid.
/// Voxels of such a grid may have other tunnels than the mesh, or miss parts of it.
void check_fine_enough(const GridSpec& grid, const MeshView& mesh) {
  constexpr double least = 8;
  constexpr double rounding = 1e-9;
  const Vec3d size = bounds(mesh).size();
  const double longest = std::max({size.x, size.y, size.z});
  const double step = std::max({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  if (step * least <= longest * (1 + rounding)) return;
  throw InvalidGrid("the grid that the file states has a spacing of " + sides_text(grid) +
                    ", which is fewer than 8 steps along the longest side of the mesh, " + rounded_text(longest));
}

bool selects_same(const LabelSelection& a, const LabelSelection& b) {
  if (a.rule != b.rule) return false;
  if (a.rule == LabelSelection::Rule::label) return a.label == b.label;
  return a.rule == LabelSelection::Rule::nonzero || a.threshold == b.threshold;
}

Certificate with_claims(Certificate certificate, const Complex& axis, const MedialClaims& claims,
                        const GridSpec* image_grid) {
  if (!claims.metadata.version.empty() && certificate.checked.sites) {
    for (std::string& claim : missing_sites(MedialView(axis), claims)) {
      certificate.mismatches.push_back(std::move(claim));
    }
  }
  for (std::string& claim : false_claims(claims, certificate.against, image_grid)) {
    certificate.mismatches.push_back(std::move(claim));
  }
  return certificate;
}

}  // namespace

std::vector<std::string> false_claims(const MedialClaims& claims, SolidRule found, const GridSpec* image_grid) {
  std::vector<std::string> out;
  const MedialMetadata& metadata = claims.metadata;
  const std::string rule(to_string(found));
  if (!metadata.solid_rule.empty() && metadata.solid_rule != rule) {
    out.push_back("the file says that its solid is '" + metadata.solid_rule + "', but it is '" + rule + "'");
  }
  if (image_grid != nullptr && metadata.grid && !has_same_sides(*metadata.grid, *image_grid)) {
    out.push_back("the file says that its voxels have the sides " + sides_text(*metadata.grid) +
                  ", but those of the image have " + sides_text(*image_grid));
  }
  if (found == SolidRule::winding && metadata.grid && metadata.spacing &&
      !has_sides(*metadata.grid, *metadata.spacing)) {
    out.push_back("the file says that its spacing is " + rounded_text(*metadata.spacing) +
                  ", but its grid has a spacing of " + sides_text(*metadata.grid));
  }
  if (metadata.version.empty()) return out;  // the file is by another program, which need not write all data
  const SiteIds sites = found == SolidRule::voxels ? SiteIds::voxels : SiteIds::features;
  for (const auto& [is_there, what] :
       {std::pair{claims.has_radii, "radii"}, std::pair{claims.has_footprints, "footprints"},
        std::pair{claims.has_angles, "separation angles"}, std::pair{claims.has_sites, "sites"},
        std::pair{claims.has_labels, "roles and sheets"},
        std::pair{!claims.has_sites || metadata.site_ids == sites, "sites of this kind of solid"}}) {
    if (!is_there)
      out.push_back("the file says that Blum " + metadata.version + " wrote it, but it contains no " + what);
  }
  return out;
}

MeshAxisVerifier::MeshAxisVerifier(const MeshView& mesh) : mesh_(mesh), polyhedron_(mesh) {}

Certificate MeshAxisVerifier::verify(const Complex& axis, const MedialClaims& claims, const CertificateOptions& options,
                                     double available_memory, const Context& context) const {
  const CertificateOptions checks = checkable(claims, SiteIds::features, options);
  const MeshSolidRule found = polyhedron_.rule(context);
  const CompleteAxis all(axis);
  if (found.rule == SolidRule::polyhedron) {
    return with_claims(polyhedron_.certify(all.get(), checks, context), all.get(), claims, nullptr);
  }
  if (!claims.metadata.grid) throw UnknownVoxels(found.reason);
  const auto voxels = voxels_on(*claims.metadata.grid, found.reason, available_memory, context);
  return with_claims(voxels->verifier.certify(all.get(), checks, context), all.get(), claims, nullptr);
}

std::shared_ptr<const MeshAxisVerifier::Voxels> MeshAxisVerifier::voxels_on(const GridSpec& grid,
                                                                            const std::string& reason,
                                                                            double available_memory,
                                                                            const Context& context) const {
  const std::scoped_lock lock(mutex_);
  if (voxels_ != nullptr && voxels_->grid == grid) return voxels_;
  validate(grid);
  check_fine_enough(grid, mesh_);
  // Bytes per node for distances, winding numbers and other fields.
  const double bytes = 16.0 * static_cast<double>(grid.node_count());
  if (bytes > available_memory) {
    throw OutOfMemory("the grid that the file states, of " + count_text(grid.node_count()) + " nodes, needs " +
                      rounded_text(bytes / 1e9) +
                      " GB of memory, which is more than is free; Blum would not choose such a grid on this machine");
  }
  VoxelSet voxels = voxels_inside(mesh_, grid, context);
  if (voxels.count() == 0) {
    throw InvalidMesh(
        "the mesh bounds no polyhedron (" + reason +
        "), and no voxel of the grid that the file states has its centre inside the mesh, so there is no solid");
  }
  voxels_ = std::make_shared<const Voxels>(Voxels{grid, AxisVerifier(std::move(voxels), grid, &mesh_)});
  return voxels_;
}

/// The solid of an image: the selected voxels, or a smooth surface of them.
struct ImageAxisVerifier::Selected {
  LabelSelection selection;
  std::optional<int> smooth;
  std::optional<SmoothSurface> surface;
  std::optional<MeshAxisVerifier> mesh;
  std::optional<AxisVerifier> voxels;
};

Certificate ImageAxisVerifier::verify(const Complex& axis, const MedialClaims& claims, const LabelSelection& selection,
                                      const CertificateOptions& options, const Context& context) const {
  const auto solid = selected(selection, claims.metadata.smooth, context);
  if (solid->mesh) return solid->mesh->verify(axis, claims, options, 1e300, context);
  const CertificateOptions checks = checkable(claims, SiteIds::voxels, options);
  const CompleteAxis all(axis);
  return with_claims(solid->voxels->certify(all.get(), checks, context), all.get(), claims, &image_.grid);
}

std::shared_ptr<const ImageAxisVerifier::Selected> ImageAxisVerifier::selected(const LabelSelection& selection,
                                                                               const std::optional<int>& smooth,
                                                                               const Context& context) const {
  const std::scoped_lock lock(mutex_);
  if (selected_ != nullptr && selects_same(selected_->selection, selection) && selected_->smooth == smooth) {
    return selected_;
  }
  const auto made = std::make_shared<Selected>();
  made->selection = selection;
  made->smooth = smooth;
  if (smooth) {
    made->surface = smooth_surface(image_, selection, {.iterations = *smooth}, context);
    made->mesh.emplace(made->surface->mesh);
  } else {
    made->voxels.emplace(selected_voxels(image_, selection, context), image_.grid, nullptr);
  }
  selected_ = made;
  return selected_;
}

Certificate verify(const Complex& axis, const MedialClaims& claims, const MeshView& mesh,
                   const CertificateOptions& options, double available_memory, const Context& context) {
  return MeshAxisVerifier(mesh).verify(axis, claims, options, available_memory, context);
}

Certificate verify(const Complex& axis, const MedialClaims& claims, const VoxelImageView& image,
                   const LabelSelection& selection, const CertificateOptions& options, const Context& context) {
  return ImageAxisVerifier(image).verify(axis, claims, selection, options, context);
}

}  // namespace blum
