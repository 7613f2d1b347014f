#include "blum/solid/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>

#include "blum/grid/image_values.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "solid/point_location.hpp"
#include "solid/polyhedron.hpp"

namespace blum {
namespace {

/// Six times the volume between the triangles of a mesh and the middle of its box.
double volume_around_middle(const MeshView& mesh) {
  const Vec3d middle = bounds(mesh).center();
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - middle;
    volume += dot(a, cross(mesh.vertices[t[1]] - middle, mesh.vertices[t[2]] - middle));
  }
  return volume;
}

/// Whether a point lies in a closed voxel of a set.
bool is_in_voxels(const VoxelSet& voxels, const GridSpec& grid, const Vec3d& p) {
  const Vec3d q = grid.direction.transposed_times(p - grid.origin);
  std::array<std::array<std::int64_t, 2>, 3> candidates{};  // two along an axis where the point lies between voxels
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
  detail::MeshSolid mesh;  ///< of an image: its rule and reason
  std::optional<BettiNumbers> betti;
  std::size_t reversed_shells = 0;
  bool faces_inwards = false;
  Box3 box;
  SiteTable sites;
  VoxelSet voxels;
  GridSpec grid;

  /// Built by the first who asks.
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
    data->faces_inwards = volume_around_middle(data->mesh.bodies.front().mesh) < 0;
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
std::optional<BettiNumbers> Solid::betti() const {
  return data_->betti;
}
std::span<const SolidBody> Solid::bodies() const& {
  return data_->mesh.bodies;
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

}  // namespace blum
