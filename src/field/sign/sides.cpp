#include "field/sign/sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blum/core/parallel.hpp"
#include "field/sign/patches.hpp"

namespace blum::sign {
namespace {

constexpr std::size_t patches_per_range = 16;

/// The winding number in front of a triangle's middle; nothing where that is not certain.
std::optional<int> winding_in_front(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh,
                                    const WindingNumber& winding, std::uint32_t triangle) {
  const SiteId face = sites.id({SiteKind::face, triangle});
  const Triangle& t = mesh.triangles[triangle];
  const Vec3d a = mesh.vertices[t[0]];
  const Vec3d u = mesh.vertices[t[1]] - a;
  const Vec3d v = mesh.vertices[t[2]] - a;
  const Vec3d normal = cross(u, v);
  const double size = length(normal);
  if (!(size > 0)) return std::nullopt;
  const Vec3d middle = a + (u + v) * (1.0 / 3);
  // Steps off the triangle get shorter until nothing else is as close.
  double step = 0.1 * std::sqrt(size);
  for (int k = 0; k < 24; ++k, step *= 0.25) {
    const Vec3d place = middle + normal * (step / size);
    const std::optional<NearestSite> nearest = bvh.nearest(place);
    if (!nearest || nearest->site != face || !(nearest->distance > 0.5 * step)) continue;
    const double found = winding.estimate(place, 1e-3).value;
    const double whole = std::round(found);
    if (std::abs(found - whole) < 0.05 && std::abs(whole) < 1e9) return static_cast<int>(whole);
  }
  return std::nullopt;
}

}  // namespace

Sides::Sides(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context)
    : method_(plan.method), level_(plan.level), bounds_(bvh.bounds()) {
  if (method_ == Method::none) return;
  if (method_ != Method::sums) normals_.emplace(mesh, sites, context);
  if (method_ == Method::pseudonormals || plan.is_simple) return;
  winding_.emplace(mesh, sites, context);
  if (method_ == Method::crossings) find_patches(mesh, sites, bvh, context);
}

void Sides::find_patches(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context) {
  Patches patches = sign::find_patches(mesh, sites, context);
  in_front_.resize(patches.count);
  std::vector<std::uint8_t> is_known(patches.count, 0);
  parallel_for(context, patches.count, patches_per_range, "", [&](const WorkRange& range) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      const std::optional<int> found = winding_in_front(mesh, sites, bvh, *winding_, patches.largest[p]);
      is_known[p] = found ? 1 : 0;
      in_front_[p] = found.value_or(0);
    }
  });
  for (std::uint32_t& patch : patches.of_site) {
    if (patch != no_patch && is_known[patch] == 0) patch = no_patch;
  }
  patch_ = std::move(patches.of_site);
}

std::size_t Sides::open_site_count() const {
  return static_cast<std::size_t>(std::count(patch_.begin(), patch_.end(), no_patch));
}

bool Sides::is_inside(const Vec3d& query, const NearestSite& nearest) const {
  const std::optional<bool> known = is_inside_by_site(query, nearest);
  return known ? *known : winding_->decide(query, nearest.distance).is_inside;
}

std::optional<bool> Sides::is_inside_by_site(const Vec3d& query, const NearestSite& nearest) const {
  if (method_ == Method::none) return false;
  // Of far sites rounding may name any, and the normal of the wrong one looks away.
  const bool is_beyond = min(query, bounds_.lower) != bounds_.lower || max(query, bounds_.upper) != bounds_.upper;
  if (method_ == Method::crossings && is_beyond) return level_ < 0;
  if (method_ == Method::sums) return std::nullopt;
  const bool is_behind = normals_->is_inside(query, nearest.point, nearest.site);
  if (method_ == Method::pseudonormals || !winding_) return is_behind;
  const std::uint32_t patch = patch_[nearest.site.value];
  if (patch != no_patch) return in_front_[patch] + (is_behind ? 1 : 0) > level_;
  if (level_ == 0) return std::nullopt;
  return winding_->estimate(query, 0.25).value > level_ + 0.5;
}

}  // namespace blum::sign
