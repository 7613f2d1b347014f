#include "blum/surface_map/surface_distance_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/core/scale.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/sites.hpp"
#include "surface_map/map_values.hpp"

namespace blum {
namespace {

using surface::SurfaceValue;

/// Number of texels in a batch. They are close to each other in space, and their results fit into the caches.
constexpr std::size_t texels_per_batch = 16384;
constexpr double no_limit = std::numeric_limits<double>::infinity();

bool have_common_vertex(const Triangle& a, const Triangle& b) {
  for (const std::uint32_t v : a) {
    if (std::find(b.begin(), b.end(), v) != b.end()) return true;
  }
  return false;
}

/// Rejects targets that are too large or too far away for a ClosestPointQuery, before threads start.
void check_range(const MeshView& target, const ClosestPointQuery& query) {
  const Box3 box = bounds(target);
  try {
    (void)query.nearest(std::vector<Vec3d>{box.lower, box.upper});
  } catch (const InvalidOption&) {
    throw InvalidMesh(
        "the target is too large for the other mesh, or too far from it: more than 1e140 times the size of that mesh");
  }
}

void fill_distances(SurfaceMap& map, const MeshView& target, const surface::TexelOrder& order,
                    const ClosestPointQuery& query, const Context& context) {
  const double scale = scale_to_one(bounds(target).largest_coordinate());
  // One thread computes a whole batch, so that data stay in its caches.
  const Context alone{.threads = 1};
  const auto fill_batch = [&](std::size_t begin, std::size_t end) {
    const std::span texels = std::span(order.texels).subspan(begin, end - begin);
    std::vector<Vec3d> points;
    surface::find_points(target, *map.atlas, scale, order, begin, end, points);
    const auto put = [&](std::span<const FoundPoint> group) {
      for (const FoundPoint& found : group) {
        surface::put(map, texels[found.query], points[found.query], {found.distance, found.point, found.site});
      }
    };
    query.for_each_nearest(points, put, alone);
  };
  surface::fill_texels(map, order, texels_per_batch, fill_batch, context);
}

void fill_vertices(SurfaceMap& map, const MeshView& target, const ClosestPointQuery& query, const Context& context) {
  const std::vector<TriangleId> triangles = surface::triangles_at_vertices(target);
  std::vector<Vec3d> points;
  for (std::size_t v = 0; v < triangles.size(); ++v) {
    if (triangles[v].has_value()) points.push_back(target.vertices[v]);
  }
  const std::vector<ClosestPoint> found = query.nearest(points, context);
  map.vertex_distance.assign(triangles.size(), std::numeric_limits<double>::quiet_NaN());
  std::size_t next = 0;
  for (std::size_t v = 0; v < triangles.size(); ++v) {
    if (triangles[v].has_value()) map.vertex_distance[v] = found[next++].distance;
  }
}

}  // namespace

std::optional<std::size_t> SurfaceMap::closest_texel() const {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < distance.size(); ++k) {
    if (site[k].has_value() && (!best || distance[k] < distance[*best])) best = k;
  }
  return best;
}

std::vector<std::uint32_t> SurfaceMap::texels_within(double limit) const {
  std::vector<std::uint32_t> out;
  for (std::uint32_t k = 0; k < distance.size(); ++k) {
    if (site[k].has_value() && distance[k] <= limit) out.push_back(k);
  }
  return out;
}

std::optional<std::pair<double, double>> SurfaceMap::finite_range() const {
  double smallest = HUGE_VAL;
  double largest = -HUGE_VAL;
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const double value = distance[k];
    if (!atlas->triangle[k].has_value() || !std::isfinite(value)) continue;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  if (smallest > largest) return std::nullopt;
  return std::pair{smallest, largest};
}

struct SurfaceMapper::Data {
  TriangleMesh target;
  TriangleMesh other;
  SurfaceMapOptions options;
  std::shared_ptr<const SurfaceAtlas> atlas;
  surface::TexelOrder order;
  std::optional<ClosestPointQuery> query;

  void set_other(const Context& context) {
    query.emplace(other, ClosestPointOptions{options.sign, options.max_distance}, context);
    query->prepare_for_many(order.texels.size(), context);
  }
};

SurfaceMapper::SurfaceMapper(const MeshView& target, const MeshView& other, const SurfaceMapOptions& options,
                             const Context& context) {
  surface::check(options);
  validate(target);
  validate(other);
  data_ = std::make_unique<Data>(
      Data{copy_of(target), copy_of(other), options, surface::make_atlas(target, options, context), {}, {}});
  data_->order = surface::texel_order(target, *data_->atlas, context);
  data_->set_other(context);
}

SurfaceMapper::SurfaceMapper(const MeshView& target, SurfaceAtlas atlas, const MeshView& other,
                             const SurfaceMapOptions& options, const Context& context) {
  surface::check(options);
  validate(target);
  validate(other);
  if (atlas.corners.size() != target.triangles.size()) {
    throw InvalidMesh("the mesh has " + std::to_string(target.triangles.size()) + " triangles, but its atlas has " +
                      std::to_string(atlas.corners.size()));
  }
  data_ = std::make_unique<Data>(
      Data{copy_of(target), copy_of(other), options, std::make_shared<const SurfaceAtlas>(std::move(atlas)), {}, {}});
  data_->order = surface::texel_order(target, *data_->atlas, context);
  data_->set_other(context);
}

SurfaceMapper::SurfaceMapper(SurfaceMapper&&) noexcept = default;
SurfaceMapper& SurfaceMapper::operator=(SurfaceMapper&&) noexcept = default;
SurfaceMapper::~SurfaceMapper() = default;

namespace {

/// Moves the vertices of a mesh.
/// @throws InvalidMesh if the number of positions differs from that of the vertices, or if they are not valid.
void move_vertices(TriangleMesh& mesh, std::span<const Vec3d> vertices) {
  if (vertices.size() != mesh.vertices.size()) {
    throw InvalidMesh("a mesh of " + std::to_string(mesh.vertices.size()) + " vertices cannot be moved to " +
                      std::to_string(vertices.size()) + "; give one position for each vertex");
  }
  validate({vertices, mesh.triangles, mesh.segments, mesh.points});
  mesh.vertices.assign(vertices.begin(), vertices.end());
}

}  // namespace

void SurfaceMapper::move_target(std::span<const Vec3d> vertices) {
  move_vertices(data_->target, vertices);
}

void SurfaceMapper::move_other(std::span<const Vec3d> vertices, const Context& context) {
  move_vertices(data_->other, vertices);
  data_->query->refit(vertices, context);
  data_->query->prepare_for_many(data_->order.texels.size(), context);
}

void SurfaceMapper::replace_other(const MeshView& other, const Context& context) {
  validate(other);
  data_->other = copy_of(other);
  data_->set_other(context);
}

SurfaceMap SurfaceMapper::map(const Context& context) const {
  SurfaceMap out = surface::empty_map(data_->atlas, SurfaceQuantity::distance);
  PhaseTimer timer(out.phases);
  check_range(data_->target, *data_->query);
  fill_distances(out, data_->target, data_->order, *data_->query, context);
  timer.lap("texels");
  fill_vertices(out, data_->target, *data_->query, context);
  timer.lap("vertices");
  surface::bound_errors(out, data_->target, data_->query->sign_may_jump(), context);
  timer.lap("errors");
  out.sign_rule = data_->query->sign_rule();
  out.sign_reason = data_->query->sign_reason();
  out.warnings = data_->query->warnings();
  surface::warn_of_nothing(out, surface::nothing_lies_within);
  return out;
}

SurfaceMap surface_distance_map(const MeshView& target, const MeshView& other, const SurfaceMapOptions& options,
                                const Context& context) {
  return SurfaceMapper(target, other, options, context).map(context);
}

SurfaceMap self_distance_map(const MeshView& target, const SurfaceMapOptions& options, const Context& context) {
  surface::check(options);
  validate(target);
  SurfaceMap out = surface::empty_map(surface::make_atlas(target, options, context), SurfaceQuantity::self_distance);
  PhaseTimer timer(out.phases);
  const SiteTable sites(target, context);
  const Bvh bvh(target, sites, context);
  const surface::TexelOrder order = surface::texel_order(target, *out.atlas, context);
  const double furthest = options.max_distance.value_or(no_limit);
  const auto value_at = [&](const Vec3d& point, TriangleId triangle, const SurfaceValue* last) {
    const Triangle& own = target.triangles[triangle.value];
    const auto is_other = [&](std::uint32_t primitive) {
      return !have_common_vertex(own, primitive_vertices(target, primitive));
    };
    // The closest point that was found for a nearby point bounds the search, if its triangle is allowed for this point.
    double limit = furthest;
    if (last != nullptr && last->site.has_value()) {
      const TriangleId on = sites.triangle(last->site);
      if (on.has_value() && is_other(on.value)) {
        limit = std::min(limit, length(point - last->closest) * (1 + 1e-9) + std::numeric_limits<double>::min());
      }
    }
    std::optional<NearestPrimitive> found = bvh.nearest_wanted(point, is_other, limit);
    if (!found && limit < furthest) found = bvh.nearest_wanted(point, is_other, furthest);
    if (!found) return SurfaceValue{no_limit, point, SiteId::none()};
    return SurfaceValue{found->distance, found->point, found->site};
  };
  timer.lap("hierarchy");
  surface::fill(out, target, order, value_at, context);
  timer.lap("texels");
  surface::bound_errors(out, target, false, context);
  timer.lap("errors");
  surface::warn_of_nothing(out, surface::nothing_lies_within);
  return out;
}

}  // namespace blum
