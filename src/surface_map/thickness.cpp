#include "blum/surface_map/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/plural.hpp"
#include "blum/core/scale.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "surface_map/facing_surface.hpp"
#include "surface_map/map_values.hpp"

namespace blum {
namespace {

using surface::SurfaceValue;

constexpr double nothing = std::numeric_limits<double>::infinity();
/// A point on the border of a triangle is moved towards the triangle's centroid by this fraction of its distance. Rays
/// from the border itself could run along neighbouring triangles.
constexpr double towards_centroid = 1e-7;
/// Shrinking ends when a step would reduce the radius of a ball by at most this fraction.
constexpr double settled = 1e-12;
/// Greatest number of shrinking steps. Usually 3 to 10 are enough.
constexpr int most_steps = 200;
constexpr std::size_t points_per_range = 256;

void check(const ThicknessOptions& options) {
  if (!(options.separation >= 0 && options.separation <= 180)) {
    throw InvalidOption("separation is " + exact_text(options.separation) + ", but must be 0 to 180 degrees");
  }
}

/// Computes thicknesses of a solid, which is scaled so that its largest coordinate is about 1.
class ThicknessSearch {
 public:
  ThicknessSearch(const MeshView& solid, const ThicknessOptions& options, const Context& context)
      : options_(options),
        scale_(scale_to_one(bounds(solid).largest_coordinate())),
        vertices_(solid.vertices.begin(), solid.vertices.end()),
        cosine_(std::cos(options.separation * std::numbers::pi / 180) + 1e-15),
        mesh_(solid) {
    for (Vec3d& v : vertices_) v *= scale_;
    mesh_.vertices = vertices_;
    // Only triangles bound a solid.
    mesh_.segments = {};
    mesh_.points = {};
    surface_.emplace(mesh_, context);
    normals_.resize(mesh_.triangles.size());
    for (std::size_t t = 0; t < normals_.size(); ++t) {
      const auto [a, b, c] = triangle_corners(mesh_, t);
      const Vec3d normal = cross(b - a, c - a);
      const double size = length(normal);
      normals_[t] = size > 0 ? normal / size : Vec3d{};
    }
  }

  [[nodiscard]] const SiteTable& sites() const { return surface_->sites(); }

  /// A point that a ball may touch, and the triangle that contains it.
  struct Hint {
    Vec3d point;
    TriangleId triangle;
  };

  /// Returns the thickness at a point of a triangle.
  /// @param hint  saves work if the ball touches the surface close to it.
  [[nodiscard]] Thickness at(const Vec3d& given, TriangleId triangle,
                             const Hint& hint = {{}, TriangleId::none()}) const {
    const auto [a, b, c] = triangle_corners(mesh_, triangle.value);
    const Vec3d scaled = given * scale_;
    const auto weights = weights_of({a, b, c}, scaled);
    const bool is_at_border = !weights || *std::min_element(weights->begin(), weights->end()) < towards_centroid;
    const Vec3d point = is_at_border ? scaled + ((a + b + c) / 3.0 - scaled) * towards_centroid : scaled;
    Thickness out{nothing, given, TriangleId::none()};
    if (normals_[triangle.value] == Vec3d{}) return out;
    const bool is_ray = options_.kind == ThicknessKind::ray;
    const Vec3d normal = is_ray ? normals_[triangle.value] : smooth_normal(point, triangle.value);
    const Thickness found = is_ray ? along_ray(point, normal, triangle.value)
                                   : of_ball(point, normal, triangle.value, {hint.point * scale_, hint.triangle});
    if (!found.triangle.has_value()) return out;
    return {found.thickness / scale_, found.opposite / scale_, found.triangle};
  }

 private:
  /// Returns the barycentric coordinates of a point; nullopt for triangles without area.
  [[nodiscard]] static std::optional<std::array<double, 3>> weights_of(const std::array<Vec3d, 3>& corners,
                                                                       const Vec3d& point) {
    const auto& [a, b, c] = corners;
    const Vec3d across = cross(b - a, c - a);
    const double whole = squared_length(across);
    if (!(whole > 0)) return std::nullopt;
    const double second = dot(cross(point - a, c - a), across) / whole;
    const double third = dot(cross(b - a, point - a), across) / whole;
    return std::array{1 - second - third, second, third};
  }

  /// Returns the mean normal of the triangles at a corner of a triangle, weighted by their angles at the corner. The
  /// mean includes only triangles whose normals differ from that of `triangle` by less than the separation.
  [[nodiscard]] Vec3d corner_normal(std::uint32_t triangle, std::size_t corner) const {
    const std::uint32_t vertex = mesh_.triangles[triangle][corner];
    Vec3d sum;
    for (const std::uint32_t other : surface_->primitives_at(SiteId(vertex))) {
      if (other != triangle && dot(normals_[other], normals_[triangle]) <= cosine_) continue;
      const Triangle& t = mesh_.triangles[other];
      const auto here = static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
      const Vec3d& at = mesh_.vertices[vertex];
      const Vec3d to_next = mesh_.vertices[t[(here + 1) % 3]] - at;
      const Vec3d to_last = mesh_.vertices[t[(here + 2) % 3]] - at;
      sum += normals_[other] * std::atan2(length(cross(to_next, to_last)), dot(to_next, to_last));
    }
    const double size = length(sum);
    return size > 0 ? sum / size : normals_[triangle];
  }

  /// Returns a normal of the smooth surface that the mesh approximates: interpolated between the corner_normal() of the
  /// three corners.
  [[nodiscard]] Vec3d smooth_normal(const Vec3d& point, std::uint32_t triangle) const {
    const auto weights = weights_of(triangle_corners(mesh_, triangle), point);
    if (!weights) return normals_[triangle];
    const double second = std::clamp((*weights)[1], 0.0, 1.0);
    const double third = std::clamp((*weights)[2], 0.0, 1.0 - second);
    const Vec3d mean = corner_normal(triangle, 0) * (1 - second - third) + corner_normal(triangle, 1) * second +
                       corner_normal(triangle, 2) * third;
    const double size = length(mean);
    return size > 0 ? mean / size : normals_[triangle];
  }

  [[nodiscard]] Thickness along_ray(const Vec3d& point, const Vec3d& normal, std::uint32_t own) const {
    Thickness out{nothing, point, TriangleId::none()};
    surface_->hierarchy().for_each_crossing({point, -normal}, nothing, [&](const RayCrossing& crossing) {
      const bool leaves = crossing.side > 0 && crossing.triangle.value != own;
      const bool is_first =
          crossing.t < out.thickness || (crossing.t == out.thickness && crossing.triangle < out.triangle);
      if (leaves && is_first) out = {crossing.t, point - normal * crossing.t, crossing.triangle};
      return out.thickness;
    });
    return out;
  }

  /// Returns the radius of the ball below a plane that touches the plane at `point` and contains `place` on its
  /// surface. Returns infinity if there is no such ball.
  static double touching_radius(const Vec3d& point, const Vec3d& normal, const Vec3d& place) {
    const Vec3d way = point - place;
    const double below = dot(way, normal);
    return below > 0 ? squared_length(way) / (2 * below) : nothing;
  }

  /// Shrinks a ball until no triangle that limits the ball is inside it. Each step finds the closest point to the
  /// ball's centre. The next ball touches both that point and the plane at `point`.
  [[nodiscard]] Thickness of_ball(const Vec3d& point, const Vec3d& normal, std::uint32_t own, const Hint& hint) const {
    const auto counts = [&](std::uint32_t triangle) {
      // Triangles without area have no normal to compare.
      return triangle != own && normals_[triangle] != Vec3d{} && dot(normals_[triangle], normal) <= cosine_;
    };
    Thickness out{nothing, point, TriangleId::none()};
    // A ball inside the box of the mesh has a smaller radius.
    double radius = 4 * surface_->hierarchy().bounds().diagonal();
    const auto touch = [&](const Vec3d& place, TriangleId triangle) {
      const double next = touching_radius(point, normal, place);
      if (!(next < radius)) return;
      out = {2 * next, place, triangle};
      radius = next;
    };
    // In most cases, a point close to the result is known.
    if (hint.triangle.has_value() && counts(hint.triangle.value)) touch(hint.point, hint.triangle);
    const Thickness far_side = along_ray(point, normal, own);
    if (far_side.triangle.has_value() && counts(far_side.triangle.value)) touch(far_side.opposite, far_side.triangle);
    for (int step = 0; step < most_steps; ++step) {
      const Vec3d center = point - normal * radius;
      const std::optional<NearestPrimitive> found =
          surface_->hierarchy().nearest_wanted(center, counts, radius * (1 - settled));
      if (!found) break;
      const double before = radius;
      touch(found->point, TriangleId(found->primitive));
      if (radius >= before * (1 - settled) || !(radius > 0)) break;
    }
    return out;
  }

  ThicknessOptions options_;
  double scale_ = 1;
  std::vector<Vec3d> vertices_;
  double cosine_ = 1;  ///< cosine of the separation, plus the rounding error of a product of two normals
  MeshView mesh_;
  std::optional<surface::FacingSurface> surface_;
  std::vector<Vec3d> normals_;  ///< unit normal of each triangle; 0 if it has no area
};

void check_solid(const MeshView& solid) {
  validate(solid);
  if (solid.triangles.empty())
    throw InvalidMesh("the mesh has no triangles, so it bounds no solid and has no thickness");
}

std::vector<Warning> warnings_of(const Orientation& found) {
  const auto edges = [](std::size_t count) { return plural(count, "edge", "edges"); };
  if (found.boundary_edges > 0) {
    return {{WarningCode::open_mesh, "the mesh is open (" + edges(found.boundary_edges) +
                                         " with one triangle): behind a hole the thickness is missing or too large; "
                                         "weld the mesh to merge equal vertices"}};
  }
  if (found.inconsistent_edges > 0) {
    return {{WarningCode::facing, "triangles face different ways (" + edges(found.inconsistent_edges) +
                                      "): where they face inwards, thickness is measured outside the solid"}};
  }
  if (!found.closed || found.outward) return {};
  return {{WarningCode::facing,
           found.signed_volume < 0
               ? "triangles face into the solid, so thickness is measured outside it; reverse them"
               : "shells lie in or cross each other and face the same way, or have no volume: thickness may be that of "
                 "one of them alone"}};
}

}  // namespace

std::vector<Thickness> thickness(const MeshView& solid, std::span<const Vec3d> points, const ThicknessOptions& options,
                                 const Context& context) {
  check(options);
  check_solid(solid);
  MeshView surface = solid;
  surface.segments = {};
  surface.points = {};
  const ClosestPointQuery query(surface, {SignMode::none, {}}, context);
  const std::vector<ClosestPoint> places = query.nearest(points, context);
  const ThicknessSearch search(solid, options, context);
  std::vector<Thickness> out(points.size());
  parallel_for(context, out.size(), points_per_range, "thickness", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) out[k] = search.at(places[k].point, places[k].triangle);
  });
  return out;
}

std::vector<Thickness> thickness(const MeshView& solid, const ThicknessOptions& options, const Context& context) {
  check(options);
  check_solid(solid);
  const ThicknessSearch search(solid, options, context);
  std::vector<Thickness> out(solid.triangles.size());
  parallel_for(context, out.size(), points_per_range, "thickness", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const auto [a, b, c] = triangle_corners(solid, t);
      out[t] = search.at((a + b + c) / 3.0, TriangleId(static_cast<std::uint32_t>(t)));
    }
  });
  return out;
}

SurfaceMap thickness_map(const MeshView& solid, const SurfaceMapOptions& map, const ThicknessOptions& options,
                         const Context& context) {
  check(options);
  surface::check(map);
  check_solid(solid);
  const bool is_ray = options.kind == ThicknessKind::ray;
  SurfaceMap out = surface::empty_map(surface::make_atlas(solid, map, context),
                                      is_ray ? SurfaceQuantity::ray_thickness : SurfaceQuantity::ball_thickness);
  PhaseTimer timer(out.phases);
  const ThicknessSearch search(solid, options, context);
  const surface::TexelOrder order = surface::texel_order(solid, *out.atlas, context);
  timer.lap("hierarchy");
  const double limit = map.max_distance.value_or(nothing);
  const auto value_at = [&](const Vec3d& point, TriangleId triangle, const SurfaceValue* last) {
    const bool has_last = last != nullptr && last->site.has_value();
    const TriangleId touched = has_last ? search.sites().triangle(last->site) : TriangleId::none();
    const Thickness found = search.at(point, triangle, {has_last ? last->closest : point, touched});
    if (!found.triangle.has_value() || found.thickness > limit) return SurfaceValue{nothing, point, SiteId::none()};
    const SiteId site = search.sites().id({SiteKind::face, found.triangle.value});
    return SurfaceValue{found.thickness, found.opposite, site};
  };
  surface::fill(out, solid, order, value_at, context);
  timer.lap("texels");
  out.warnings = warnings_of(orientation(solid, search.sites()));
  surface::warn_of_nothing(out, "no texel has a thickness");
  return out;
}

std::vector<Warning> thickness_warnings(const MeshView& solid, const Context& context) {
  return warnings_of(orientation(solid, SiteTable(solid, context)));
}

}  // namespace blum
