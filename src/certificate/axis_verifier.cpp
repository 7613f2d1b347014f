#include "blum/certificate/axis_verifier.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "certificate/bounding_mesh.hpp"
#include "certificate/checks.hpp"
#include "certificate/scaling.hpp"
#include "certificate/shells.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum {
namespace {

using verifier::factor_for;
using verifier::KnownSolid;
using verifier::NoPolyhedron;
using verifier::ScaledMesh;

/// The solid that a mesh bounds, and the meshes to which it refers.
struct BoundedSolid {
  ScaledMesh given;
  std::optional<verifier::BoundingMesh> bounding;
  std::optional<ScaledMesh> own;
  std::optional<KnownSolid> solid;  ///< unset if the mesh bounds no polyhedron
  MeshSolidRule rule;

  BoundedSolid(const MeshView& mesh, double factor, const Context& context) : given(mesh, factor) {
    // Nearly all meshes bound a polyhedron without changes. They are then analysed only once.
    if (find_self_intersections(mesh, 0, context).complete) {
      try {
        solid = verifier::solid_of_mesh(given.view, given.view, context);
        rule = verifier::rule_of_polyhedron(false);
        return;
      } catch (const NoPolyhedron&) {  // NOLINT(bugprone-empty-catch): the next lines resolve it or say why
      }
    }
    try {
      bounding.emplace(mesh, context);
      own.emplace(bounding->view(), factor);
      solid = verifier::solid_of_mesh(own->view, given.view, context);
      rule = verifier::rule_of_polyhedron(bounding->is_resolved());
    } catch (const NoPolyhedron& error) {
      rule = {SolidRule::winding, error.reason()};
    }
  }
};

/// Turns off checks that depend on a check that is off.
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

/// Options that check only positions.
constexpr CertificateOptions only_places{.positions = true,
                                         .radii = false,
                                         .footprints = false,
                                         .angles = false,
                                         .sites = false,
                                         .labels = false,
                                         .balls = false,
                                         .medial = false};

/// Returns the cells of a complex with the columns of a medial axis. The columns are placeholders that are not checked.
Complex with_medial_columns(const Complex& complex) {
  Complex out;
  out.positions = complex.positions;
  out.edges = complex.edges;
  out.triangles = complex.triangles;
  add_missing_medial_columns(out);
  return out;
}

}  // namespace

/// A solid that is analysed when it is first needed.
class AxisVerifier::Reading {
 public:
  explicit Reading(double factor) : factor_(factor) {}
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  virtual ~Reading() = default;

  /// Returns the factor by which the solid was scaled: its lengths are this many times the caller's.
  [[nodiscard]] double factor() const { return factor_; }
  [[nodiscard]] virtual MeshSolidRule rule(const Context& context) const = 0;
  /// @throws InvalidMesh, InvalidGrid, Cancelled.
  [[nodiscard]] virtual const KnownSolid& solid(const Context& context) const = 0;
  /// Writes the kind of the solid and its voxel size into a certificate.
  virtual void describe(Certificate& certificate) const = 0;

 private:
  double factor_;
};

class AxisVerifier::MeshReading : public Reading {
 public:
  explicit MeshReading(const MeshView& mesh) : Reading(factor_for(bounds(mesh).diagonal())), mesh_(mesh) {}

  [[nodiscard]] MeshSolidRule rule(const Context& context) const override { return bounded(context).rule; }
  [[nodiscard]] const KnownSolid& solid(const Context& context) const override {
    const BoundedSolid& known = bounded(context);
    if (!known.solid) throw NoPolyhedron(known.rule.reason);
    return *known.solid;
  }
  void describe(Certificate& /*certificate*/) const override {}

 private:
  [[nodiscard]] const BoundedSolid& bounded(const Context& context) const {
    return *bounded_.get([&] { return std::make_unique<const BoundedSolid>(mesh_, factor(), context); });
  }

  MeshView mesh_;
  verifier::Lazy<std::unique_ptr<const BoundedSolid>> bounded_;
};

class AxisVerifier::VoxelReading : public Reading {
 public:
  VoxelReading(VoxelSet voxels, const GridSpec& grid, const MeshView* surface)
      : Reading(factor_for(length(grid.spacing))),
        voxels_(std::move(voxels)),
        grid_(grid),
        shortest_side_(std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z})) {
    grid_.origin *= factor();
    grid_.spacing *= factor();
    if (surface != nullptr) surface_.emplace(*surface, factor());
  }

  [[nodiscard]] MeshSolidRule rule(const Context& /*context*/) const override {
    return {surface_ ? SolidRule::winding : SolidRule::voxels, {}};
  }
  [[nodiscard]] const KnownSolid& solid(const Context& context) const override {
    return solid_.get(
        [&] { return verifier::solid_of_voxels(voxels_, grid_, surface_ ? &surface_->view : nullptr, context); });
  }
  void describe(Certificate& certificate) const override {
    certificate.voxel = shortest_side_;
    certificate.against = surface_ ? SolidRule::winding : SolidRule::voxels;
  }

 private:
  VoxelSet voxels_;
  GridSpec grid_;
  double shortest_side_;  ///< in the caller's units
  std::optional<ScaledMesh> surface_;
  verifier::Lazy<KnownSolid> solid_;
};

AxisVerifier::AxisVerifier(const MeshView& mesh) {
  validate(mesh);
  reading_ = std::make_unique<const MeshReading>(mesh);
}

AxisVerifier::AxisVerifier(VoxelSet voxels, const GridSpec& grid, const MeshView* surface) {
  validate(grid);
  if (grid.size != voxels.size())
    throw InvalidOption("the grid and the set of voxels have different sizes; they must be equal");
  if (voxels.count() == 0)
    throw InvalidOption("the set of voxels is empty, so there is no solid to check an axis against");
  if (surface != nullptr) validate(*surface);
  reading_ = std::make_unique<const VoxelReading>(std::move(voxels), grid, surface);
}

AxisVerifier::AxisVerifier(AxisVerifier&&) noexcept = default;
AxisVerifier& AxisVerifier::operator=(AxisVerifier&&) noexcept = default;
AxisVerifier::~AxisVerifier() = default;

MeshSolidRule AxisVerifier::rule(const Context& context) const {
  return reading_->rule(context);
}

Certificate AxisVerifier::certify(const Complex& axis, const CertificateOptions& options,
                                  const Context& context) const {
  const KnownSolid& solid = reading_->solid(context);
  const double factor = reading_->factor();
  Certificate certificate = factor == 1 ? verifier::certify_against(axis, solid, factor, consistent(options), context)
                                        : verifier::certify_against(verifier::scaled(axis, factor), solid, factor,
                                                                    consistent(options), context);
  reading_->describe(certificate);
  return certificate;
}

Certificate AxisVerifier::certify_topology(const Complex& complex, const Context& context) const {
  return certify(with_medial_columns(complex), only_places, context);
}

}  // namespace blum
