#include "blum/solid/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/facing.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/grid/image_values.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "solid/polyhedron.hpp"

namespace blum::detail {
namespace {

/// Decides whether points lie in the solid that a mesh bounds; see Solid::inside().
class PointLocation {
 public:
  explicit PointLocation(const MeshSolid& solid);

  [[nodiscard]] bool contains(const Vec3d& p) const;

 private:
  /// Returns true if the winding number, counted along a ray from the point, is above 0. Also returns true if the point
  /// lies on the surface of a polyhedron. Returns nullopt if the ray meets an edge, or starts on the surface of a mesh
  /// that bounds no polyhedron.
  [[nodiscard]] std::optional<bool> contains_along(const Vec3d& p, const Vec3d& direction) const;

  bool is_polyhedron_;
  TriangleMesh mesh_;  ///< mesh of all bodies
  std::optional<Bvh> bvh_;
  std::optional<WindingNumber> winding_;  ///< set for meshes that are not closed
};

/// Largest number of rays to try. One is nearly always enough: a ray in a random direction almost never meets an edge.
constexpr std::uint32_t most_rays = 64;

TriangleMesh joined(const std::vector<SolidBody>& bodies) {
  TriangleMesh mesh;
  for (const SolidBody& body : bodies) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    for (Triangle t : body.mesh.triangles) {
      for (std::uint32_t& v : t) v += first;
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

PointLocation::PointLocation(const MeshSolid& solid)
    : is_polyhedron_(solid.rule == SolidRule::polyhedron), mesh_(joined(solid.bodies)) {
  const SiteTable sites(mesh_);
  if (solid.is_closed) {
    bvh_.emplace(mesh_, sites);
  } else {
    winding_.emplace(mesh_, sites);
  }
}

bool PointLocation::contains(const Vec3d& p) const {
  if (winding_) return winding_->is_inside(p);
  Random random(1);
  for (std::uint32_t k = 0; k < most_rays; ++k) {
    const Vec3d direction{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
    if (const std::optional<bool> found = contains_along(p, direction)) return *found;
  }
  return true;  // all rays failed, so the point is taken to lie on the surface
}

std::optional<bool> PointLocation::contains_along(const Vec3d& p, const Vec3d& direction) const {
  int winding = 0;
  bool is_decisive = true;
  bool is_on_surface = false;
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  bvh_->for_each_crossing({p, direction}, no_limit, [&](const RayCrossing& crossing) {
    const Triangle& t = mesh_.triangles[crossing.triangle.value];
    // A ray crosses a plane only once. So if the point lies in the triangle's plane, the point is the crossing.
    is_on_surface = is_on_surface || orient3d(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], p) == 0;
    is_decisive = is_decisive && !crossing.on_border;
    winding += crossing.side;
    return is_on_surface ? -1 : no_limit;
  });
  if (is_on_surface && is_polyhedron_) return true;
  if (!is_decisive || is_on_surface) return std::nullopt;
  return winding > 0;
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

/// Returns true if a point lies in a closed voxel of the set.
bool is_in_voxels(const VoxelSet& voxels, const GridSpec& grid, const Vec3d& p) {
  const Vec3d q = grid.direction.transposed_times(p - grid.origin);
  std::array<std::array<std::int64_t, 2>, 3> candidates{};  // two along an axis if the point lies between two voxels
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = q[a] / grid.spacing[a] + 0.5;
    const double voxel = std::floor(at);
    if (!(voxel >= 0 && voxel <= static_cast<double>(grid.size[a]))) return false;
    const auto index = static_cast<std::int64_t>(voxel);
    candidates[a] = {index, at == voxel ? index - 1 : index};
  }
  for (const std::int64_t k : candidates[2]) {
    for (const std::int64_t j : candidates[1]) {
      for (const std::int64_t i : candidates[0]) {
        if (voxels.contains(i, j, k)) return true;
      }
    }
  }
  return false;
}

}  // namespace

struct Solid::Data {
  detail::MeshSolid mesh;  ///< for images, only `rule` and `reason` are set
  std::optional<BettiNumbers> betti;
  std::size_t reversed_shells = 0;
  bool faces_inwards = false;
  Box3 box;
  SiteTable sites;
  VoxelSet voxels;
  GridSpec grid;

  /// Built at the first use.
  mutable std::once_flag locates;
  mutable std::optional<detail::PointLocation> location;
};

Solid::Solid(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Solid Solid::of(const MeshView& mesh, const Context& context) {
  validate(mesh);
  auto data = std::make_shared<Data>();
  data->sites = SiteTable(mesh, context);
  data->mesh = detail::split_into_bodies(mesh, data->sites, context);
  data->box = bounds(mesh);
  for (const SolidShell& shell : data->mesh.shells) data->reversed_shells += shell.is_reversed ? 1 : 0;
  if (data->mesh.rule == SolidRule::polyhedron) {
    data->betti.emplace();
    for (const SolidBody& body : data->mesh.bodies) {
      for (std::size_t k = 0; k < 3; ++k) (*data->betti)[k] += body.betti[k];
    }
  } else {
    data->faces_inwards = detail::volume_around_middle(data->mesh.bodies.front().mesh) < 0;
  }
  return Solid(std::move(data));
}

Solid Solid::of(const VoxelImageView& image, const LabelSelection& selection, const Context& context) {
  auto data = std::make_shared<Data>();
  data->voxels = selected_voxels(image, selection, context);
  data->betti = betti_numbers(data->voxels, context);
  if ((*data->betti)[0] == 0) throw InvalidImage(nothing_selected_text(image, selection));
  data->mesh.rule = SolidRule::voxels;
  data->mesh.reason = "the solid is the union of the selected voxels";
  data->mesh.problem = mesh_problem::is_an_image;
  data->grid = image.grid;
  data->box = bounds(image.grid);
  return Solid(std::move(data));
}

SolidRule Solid::rule() const {
  return data_->mesh.rule;
}
const std::string& Solid::reason() const {
  return data_->mesh.reason;
}
const std::string& Solid::problem() const {
  return data_->mesh.problem;
}
std::optional<BettiNumbers> Solid::betti() const {
  return data_->betti;
}
std::span<const SolidBody> Solid::bodies() const& {
  return data_->mesh.bodies;
}
const SolidSurface& Solid::surface() const& {
  return data_->mesh.surface;
}
const Topology& Solid::topology() const& {
  return data_->mesh.topology;
}
std::span<const SolidShell> Solid::shells() const& {
  return data_->mesh.shells;
}
std::size_t Solid::reversed_shells() const {
  return data_->reversed_shells;
}
std::size_t Solid::reversed_triangles() const {
  return data_->mesh.reversed_triangles;
}
const std::optional<CrossingCounts>& Solid::resolved() const {
  return data_->mesh.resolved;
}
bool Solid::faces_inwards() const {
  return data_->faces_inwards;
}
const Box3& Solid::box() const {
  return data_->box;
}
const SiteTable& Solid::sites() const {
  return data_->sites;
}
const VoxelSet& Solid::voxels() const {
  return data_->voxels;
}
const GridSpec& Solid::grid() const {
  return data_->grid;
}

CellularModel Solid::model(const CellularModelOptions& options, const Context& context) const {
  return CellularModel::of(*this, detail::groups_apart(data_->mesh.bodies.size(), data_->mesh.touching), options,
                           context);
}

bool Solid::inside(const Vec3d& p) const {
  if (data_->mesh.rule == SolidRule::voxels) return is_in_voxels(data_->voxels, data_->grid, p);
  std::call_once(data_->locates, [&] { data_->location.emplace(data_->mesh); });
  return data_->location->contains(p);
}

void check_manifold(const Solid& solid) {
  if (solid.rule() != SolidRule::polyhedron) throw InvalidMesh(solid.problem());
  std::string problem = problem_of_places(solid.surface().mesh);
  if (!problem.empty() && solid.resolved()) problem = mesh_problem::touches_when_resolved;
  if (problem.empty()) problem = solid.problem();
  if (!problem.empty()) throw InvalidMesh(problem);
}

}  // namespace blum
