#include "proximity/scene_penetration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/solid/winding_surface.hpp"
#include "proximity/deepest_point.hpp"
#include "proximity/overlap.hpp"

namespace blum {

void check(const PenetrationOptions& options) {
  if (options.depth_tolerance >= 1e-6 && options.depth_tolerance <= 1) return;
  throw InvalidOption("depth_tolerance is " + exact_text(options.depth_tolerance) + ", but must be 1e-6 to 1");
}

}  // namespace blum

namespace blum::detail {
namespace {

/// The surfaces of one object or two in one mesh, and where their triangles come from.
struct Surfaces {
  TriangleMesh mesh;
  std::vector<std::uint32_t> triangle_of;  ///< of each triangle, in its object
  std::size_t of_first = 0;                ///< triangles of the first object: these come first

  [[nodiscard]] bool is_of_first(std::uint32_t triangle) const { return triangle < of_first; }

  void add(const TriangleMesh& surface, const std::vector<std::uint32_t>& triangle) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const auto& [a, b, c] : surface.triangles) mesh.triangles.push_back({base + a, base + b, base + c});
    triangle_of.insert(triangle_of.end(), triangle.begin(), triangle.end());
  }
};

std::string name_of(ObjectId object) {
  return "object " + std::to_string(object.value);
}

/// Adds the surface of a solid; without what lies in it twice, so that what two surfaces wind around twice is in both.
void add_surface(const SceneObject& object, ObjectId id, bool is_self, const Context& context, Surfaces& out) {
  TriangleMesh mesh{object.positions(), object.mesh().triangles};
  if (is_self) check_faces_outwards(mesh, name_of(id));
  SolidSurface surface =
      is_self ? SolidSurface{std::move(mesh), {}, {}} : winding_surface(std::move(mesh), name_of(id), context);
  if (surface.triangle_of.empty()) {
    surface.triangle_of.resize(surface.mesh.triangles.size());
    std::iota(surface.triangle_of.begin(), surface.triangle_of.end(), 0U);
  }
  out.add(surface.mesh, surface.triangle_of);
}

/// One connected part of what solids have in common.
class Body {
 public:
  Body(const Surfaces& surfaces, const Overlap& overlap, const std::vector<std::uint32_t>& labels,
       std::vector<std::uint32_t> triangles)
      : surfaces_(surfaces), overlap_(overlap), labels_(labels), triangles_(std::move(triangles)) {}

  [[nodiscard]] Penetration measure(double tolerance, const Context& context) const {
    Penetration out;
    measure_size(out);
    out.curves = border_curves(overlap_.mesh, labels_, triangles_);
    measure_depth(tolerance, context, out);
    return out;
  }

 private:
  /// A patch, and where its triangles and those of the surface that it lies in come from.
  struct Sources {
    std::vector<std::uint32_t> patch;
    std::vector<std::uint32_t> surface;
  };

  void measure_size(Penetration& out) const {
    const Vec3d origin = triangle_corners(overlap_.mesh, triangles_.front())[0];
    for (const std::uint32_t t : triangles_) {
      const auto [a, b, c] = triangle_corners(overlap_.mesh, t);
      const Vec3d normal = cross(b - a, c - a);
      out.area[surfaces_.is_of_first(overlap_.source[t]) ? 0 : 1] += length(normal) / 2;
      out.volume += dot(normal, a - origin) / 6;
    }
    // Rounding may make that of thin parts slightly negative.
    const double rounding = 1e-12 * bounds(overlap_.mesh).largest_coordinate() * (out.area[0] + out.area[1]);
    if (out.volume < 0 && out.volume > -rounding) out.volume = 0;
  }

  /// A few sides, as those of two solids, are looked at together. What meets itself may have thousands: these are
  /// looked at one after the other, the largest first, and those that are smaller than the depth found are not.
  void measure_depth(double tolerance, const Context& context, Penetration& out) const {
    constexpr std::size_t few = 8;
    std::set<std::uint32_t> known;
    for (const std::uint32_t t : triangles_) known.insert(labels_[t]);
    const std::vector<std::uint32_t> labels(known.begin(), known.end());
    if (labels.size() <= few) return measure_labels(labels, tolerance, context, out);
    for (const Reach& one : reaches()) {
      throw_if_cancelled(context);
      if (one.reach <= out.depth) return;
      measure_labels({&one.label, 1}, tolerance, context, out);
    }
  }

  /// How far a point of the triangles of a label can be from the others at most.
  struct Reach {
    std::uint32_t label = 0;
    double reach = 0;  ///< infinite where they do not hang together with others
  };

  /// The largest first.
  [[nodiscard]] std::vector<Reach> reaches() const {
    std::map<std::uint32_t, Box3> boxes;
    for (const std::uint32_t t : triangles_) {
      for (const Vec3d& corner : triangle_corners(overlap_.mesh, t)) boxes[labels_[t]].extend(corner);
    }
    std::set<std::uint32_t> bordering;
    for (const auto& [edge, sides] : triangles_at_edges(overlap_.mesh, triangles_)) {
      for (const std::uint32_t t : sides) {
        if (labels_[t] == labels_[sides[0]]) continue;
        bordering.insert(labels_[t]);
        bordering.insert(labels_[sides[0]]);
      }
    }
    std::vector<Reach> out;
    for (const auto& [label, box] : boxes) {
      out.push_back({label, bordering.contains(label) ? box.diagonal() : std::numeric_limits<double>::infinity()});
    }
    std::sort(out.begin(), out.end(), [](const Reach& x, const Reach& y) {
      return std::pair(-x.reach, x.label) < std::pair(-y.reach, y.label);
    });
    return out;
  }

  void measure_labels(std::span<const std::uint32_t> labels, double tolerance, const Context& context,
                      Penetration& out) const {
    std::vector<DeepPatch> patches;
    std::vector<Sources> sources;
    for (const std::uint32_t label : labels) {
      Sources from;
      DeepPatch patch = patch_of(label, from);
      if (patch.surface.triangles.empty()) continue;
      patches.push_back(std::move(patch));
      sources.push_back(std::move(from));
    }
    if (patches.empty()) return;
    const DeepestPoint found = deepest_point(patches, out.depth, tolerance, context);
    out.depth_bound = std::max(out.depth_bound, found.bound);
    if (out.depth > 0 && found.distance <= out.depth) return;
    const std::uint32_t deep = sources[found.patch].patch[found.triangle];
    out.depth = found.distance;
    out.deep_point = found.point;
    out.surface_point = found.closest;
    out.is_first_deep = surfaces_.is_of_first(deep);
    out.deep_triangle = surfaces_.triangle_of[deep];
    out.surface_triangle = surfaces_.triangle_of[sources[found.patch].surface[found.other]];
    if (!(found.distance > 0)) return;
    const Vec3d out_of_it = (found.closest - found.point) / found.distance;
    out.direction = out.is_first_deep ? out_of_it : -out_of_it;
  }

  /// The triangles of one label, and those of the others, which they lie in.
  [[nodiscard]] DeepPatch patch_of(std::uint32_t label, Sources& from) const {
    DeepPatch out;
    out.surface.vertices = overlap_.mesh.vertices;
    for (const std::uint32_t t : triangles_) {
      if (labels_[t] == label) {
        out.triangles.push_back(triangle_corners(overlap_.mesh, t));
        from.patch.push_back(overlap_.source[t]);
      } else {
        out.surface.triangles.push_back(overlap_.mesh.triangles[t]);
        from.surface.push_back(overlap_.source[t]);
      }
    }
    if (out.surface.triangles.empty()) take_whole_surface(out.surface, from);
    return out;
  }

  /// Where a part lies in a solid without meeting its surface: all of that.
  void take_whole_surface(TriangleMesh& surface, Sources& from) const {
    const std::set<std::uint32_t> own(from.patch.begin(), from.patch.end());
    const bool is_of_first = surfaces_.is_of_first(*own.begin());
    const bool is_self = surfaces_.of_first == surfaces_.mesh.triangles.size();
    surface.vertices = surfaces_.mesh.vertices;
    for (std::uint32_t t = 0; t < surfaces_.mesh.triangles.size(); ++t) {
      if (is_self ? own.contains(t) : surfaces_.is_of_first(t) == is_of_first) continue;
      surface.triangles.push_back(surfaces_.mesh.triangles[t]);
      from.surface.push_back(t);
    }
  }

  const Surfaces& surfaces_;
  const Overlap& overlap_;
  const std::vector<std::uint32_t>& labels_;
  std::vector<std::uint32_t> triangles_;
};

/// Not of length 1.
Vec3d normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto [a, b, c] = triangle_corners(mesh, triangle);
  return cross(b - a, c - a);
}

/// Whether a vector comes before its opposite.
bool is_backward(const Vec3d& v) {
  if (v.x != 0) return v.x < 0;
  if (v.y != 0) return v.y < 0;
  return v.z < 0;
}

/// Where both surfaces are one, each part of the border could be either's; solids that are the same would all be the
/// first one's surface, with nothing of the other to be deep in. There the border is shared out as if the first solid
/// were moved by next to nothing along x, and by still less along y and z: what faces backward becomes the first's. Of
/// one object that meets itself, the first of two triangles that coincide is that with the smaller index.
void share_out_common_faces(const Surfaces& surfaces, bool is_self, Overlap& overlap) {
  if (overlap.source.empty()) return;
  const Bvh bvh(surfaces.mesh, SiteTable(surfaces.mesh));
  const double rounding = 1e-14 * bounds(surfaces.mesh).largest_coordinate();
  for (std::uint32_t t = 0; t < overlap.source.size(); ++t) {
    const std::uint32_t source = overlap.source[t];
    const Vec3d normal = normal_of(surfaces.mesh, source);
    const bool becomes_first = is_backward(normal);
    const auto may_have_it = [&](std::uint32_t other) {
      if (becomes_first ? other >= source : other <= source) return false;
      if (!is_self && surfaces.is_of_first(other) == surfaces.is_of_first(source)) return false;
      const Vec3d its_normal = normal_of(surfaces.mesh, other);
      return dot(normal, its_normal) > 0.999999 * length(normal) * length(its_normal);
    };
    const auto [p, q, r] = triangle_corners(overlap.mesh, t);
    const std::optional<NearestPrimitive> twin = bvh.nearest_wanted((p + q + r) / 3, may_have_it, rounding);
    if (twin) overlap.source[t] = twin->primitive;
  }
}

/// Which triangles of an overlap belong together: those of one object, or of one part of an object that meets itself.
/// Parts hang together over common vertices; where triangles have vertices of their own, over places.
std::vector<std::uint32_t> labels_of(const Surfaces& surfaces, const Overlap& overlap, bool is_self) {
  if (!is_self) {
    std::vector<std::uint32_t> out;
    for (const std::uint32_t s : overlap.source) out.push_back(surfaces.is_of_first(s) ? 0 : 1);
    return out;
  }
  std::vector<std::uint32_t> cluster(surfaces.mesh.vertices.size());
  std::iota(cluster.begin(), cluster.end(), 0U);
  if (open_edges(surfaces.mesh) > 0) cluster = weld_clusters(surfaces.mesh.vertices);
  return patches_of(overlap, [&](std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t v : surfaces.mesh.triangles[a]) {
      for (const std::uint32_t w : surfaces.mesh.triangles[b]) {
        if (cluster[v] == cluster[w]) return true;
      }
    }
    return false;
  });
}

}  // namespace

Penetrations penetrations(ObjectId first, const SceneObject& a, ObjectId second, const SceneObject& b,
                          const PenetrationOptions& options, const Context& context) {
  check(options);
  const bool is_self = first == second;
  Penetrations out;
  PhaseTimer timer(out.phases);
  Surfaces surfaces;
  add_surface(a, first, is_self, context, surfaces);
  surfaces.of_first = surfaces.mesh.triangles.size();
  if (!is_self) add_surface(b, second, is_self, context, surfaces);
  timer.lap("surfaces");
  Overlap overlap = overlap_of(surfaces.mesh, context);
  if (!overlap.obstacle.empty()) {
    check_is_closed(a.mesh(), name_of(first));
    check_is_closed(b.mesh(), name_of(second));
    throw InvalidMesh("what " + (is_self ? "parts of " + name_of(first) : name_of(first) + " and " + name_of(second)) +
                      " have in common cannot be told: " + overlap.obstacle);
  }
  timer.lap("overlap");
  std::map<std::uint32_t, std::vector<std::uint32_t>> bodies;
  for (std::uint32_t t = 0; t < overlap.body_of.size(); ++t) bodies[overlap.body_of[t]].push_back(t);
  share_out_common_faces(surfaces, is_self, overlap);
  const std::vector<std::uint32_t> labels = labels_of(surfaces, overlap, is_self);
  for (const auto& [body, triangles] : bodies) {
    throw_if_cancelled(context);
    out.parts.push_back(Body(surfaces, overlap, labels, triangles).measure(options.depth_tolerance, context));
  }
  // Parts come in the order of their smallest triangles; equally deep ones stay in it.
  std::vector<std::size_t> order(out.parts.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
    return std::pair(-out.parts[x].depth, x) < std::pair(-out.parts[y].depth, y);
  });
  std::vector<Penetration> sorted;
  for (const std::size_t k : order) sorted.push_back(std::move(out.parts[k]));
  out.parts = std::move(sorted);
  timer.lap("depths");
  return out;
}

}  // namespace blum::detail
