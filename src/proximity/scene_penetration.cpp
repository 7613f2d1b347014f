#include "proximity/scene_penetration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/solid/winding_surface.hpp"
#include "proximity/overlap.hpp"

namespace blum::detail {
namespace {

/// A part of a surface that lies inside another solid, and the surface of that solid.
struct DeepPatch {
  std::vector<std::array<Vec3d, 3>> triangles;  ///< at least one
  TriangleMesh surface;                         ///< not empty
};

/// The deepest point of patches, its depth, and the closest point of the surface.
struct DeepestPoint {
  double distance = 0;
  double bound = 0;  ///< no point of the patches is deeper than this, except by rounding
  Vec3d point;
  Vec3d closest;             ///< the closest point of the surface
  std::size_t patch = 0;     ///< the patch of the point
  std::size_t triangle = 0;  ///< the triangle of the patch that contains the point
  std::uint32_t other = 0;   ///< the triangle of the surface that contains `closest`
};

/// Facets of a surface, and their borders. A facet consists of connected triangles in one plane.
class Facets {
 public:
  /// @param rounding  points at most this far from a plane are treated as points of the plane.
  Facets(const MeshView& mesh, double rounding);

  /// Position of a triangle relative to a facet, in the projection along the facet's normal.
  struct Lie {
    bool is_over = false;  ///< true if the whole triangle is over the facet
    double furthest = 0;   ///< largest distance of the corners from the facet's plane
    bool is_crossed = false;
    /// If a side of the facet crosses the triangle: signed distances of the corners from the plane of this side and the
    /// facet's normal. At least one distance is above 0, and one is below.
    std::array<double, 3> sides{};
  };

  /// Returns the number of border sides plus the number of triangles of the facet of a triangle.
  [[nodiscard]] std::size_t size(std::uint32_t triangle) const {
    const Facet& facet = facets_[facet_of_[triangle]];
    return facet.border.size() + facet.triangles.size();
  }
  /// Returns the position of a triangle relative to a facet.
  /// @param points    the corners of the triangle.
  /// @param triangle  one of the facet's triangles.
  /// Cost: 10 ns for each side and each triangle of the facet.
  [[nodiscard]] Lie lie(const std::array<Vec3d, 3>& points, std::uint32_t triangle) const;

 private:
  using Point = std::array<double, 2>;
  struct Facet {
    Vec3d origin, u, v, normal;
    std::vector<std::array<Point, 2>> border;
    std::vector<std::array<Point, 3>> triangles;

    [[nodiscard]] Point seen(const Vec3d& p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
  };

  [[nodiscard]] bool holds(const Facet& facet, const Point& point) const;

  double rounding_;
  std::vector<std::uint32_t> facet_of_;  ///< for each triangle: its facet
  std::vector<Facet> facets_;
};

constexpr std::uint32_t no_facet = 0xffffffffU;

/// Returns the distance of p from the line from a to b, positive on its left side. Returns 0 if a and b are one point.
double left_of(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& p) {
  const double x = b[0] - a[0];
  const double y = b[1] - a[1];
  const double size = std::hypot(x, y);
  return size > 0 ? (x * (p[1] - a[1]) - y * (p[0] - a[0])) / size : 0;
}

/// Restricts a part of a segment to the points that lie more than a margin left of a line. The part is from `begin` to
/// `end`, as fractions of the segment's length.
/// @param from, to  distances of the segment's ends from the line, positive on the left.
void keep_left(double from, double to, double margin, double& begin, double& end) {
  from -= margin;
  to -= margin;
  if (from <= 0 && to <= 0) {
    end = -1;
  } else if (from < 0) {
    begin = std::max(begin, from / (from - to));
  } else if (to < 0) {
    end = std::min(end, from / (from - to));
  }
}

Facets::Facets(const MeshView& mesh, double rounding)
    : rounding_(rounding), facet_of_(mesh.triangles.size(), no_facet) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto by_edge = triangles_at_edges(mesh, all);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (facet_of_[seed] != no_facet) continue;
    const auto number = static_cast<std::uint32_t>(facets_.size());
    Facet& facet = facets_.emplace_back();
    const std::array<Vec3d, 3> p = triangle_corners(mesh, seed);
    const Vec3d area = cross(p[1] - p[0], p[2] - p[0]);
    const Vec3d along = p[1] - p[0];
    facet.origin = p[0];
    const bool is_flat = !(length(area) > 0) || !(length(along) > 0);
    if (!is_flat) {
      facet.normal = area / length(area);
      facet.u = along / length(along);
      facet.v = cross(facet.normal, facet.u);
    }
    const auto is_in_plane = [&](std::uint32_t t) {
      const std::array<Vec3d, 3> q = triangle_corners(mesh, t);
      return !is_flat && dot(cross(q[1] - q[0], q[2] - q[0]), facet.normal) > 0 &&
             std::all_of(q.begin(), q.end(),
                         [&](const Vec3d& x) { return std::abs(dot(x - facet.origin, facet.normal)) <= rounding; });
    };
    std::vector<std::uint32_t> open{seed};
    facet_of_[seed] = number;
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      const std::array<Vec3d, 3> q = triangle_corners(mesh, t);
      facet.triangles.push_back({facet.seen(q[0]), facet.seen(q[1]), facet.seen(q[2])});
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& both = by_edge.at(std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]));
        const std::uint32_t next = both.size() != 2 ? t : both[0] == t ? both[1] : both[0];
        if (next != t && facet_of_[next] == number) continue;
        if (next != t && facet_of_[next] == no_facet && is_in_plane(next)) {
          facet_of_[next] = number;
          open.push_back(next);
        } else {
          facet.border.push_back({facet.seen(q[k]), facet.seen(q[(k + 1) % 3])});
        }
      }
    }
  }
}

bool Facets::holds(const Facet& facet, const Point& point) const {
  return std::any_of(facet.triangles.begin(), facet.triangles.end(), [&](const std::array<Point, 3>& t) {
    return left_of(t[0], t[1], point) >= -rounding_ && left_of(t[1], t[2], point) >= -rounding_ &&
           left_of(t[2], t[0], point) >= -rounding_;
  });
}

Facets::Lie Facets::lie(const std::array<Vec3d, 3>& points, std::uint32_t triangle) const {
  const Facet& facet = facets_[facet_of_[triangle]];
  Lie out;
  std::array<Point, 3> p{};
  for (std::size_t c = 0; c < 3; ++c) {
    p[c] = facet.seen(points[c]);
    out.furthest = std::max(out.furthest, std::abs(dot(points[c] - facet.origin, facet.normal)));
  }
  if (left_of(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
  double best = 0;
  for (const auto& [a, b] : facet.border) {
    // The part of this side of the facet that lies within the triangle.
    double begin = 0;
    double end = 1;
    for (std::size_t k = 0; k < 3 && begin < end; ++k) {
      const Point& from = p[k];
      const Point& to = p[(k + 1) % 3];
      keep_left(left_of(from, to, a), left_of(from, to, b), rounding_, begin, end);
    }
    if (!(begin < end)) continue;
    std::array<double, 3> sides{};
    double low = 0;
    double high = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double side = left_of(a, b, facet.seen(points[c]));
      sides[c] = std::abs(side) <= rounding_ ? 0 : side;
      low = std::max(low, -sides[c]);
      high = std::max(high, sides[c]);
    }
    if (!(std::min(low, high) > best)) continue;
    best = std::min(low, high);
    out.is_crossed = true;
    out.sides = sides;
  }
  const Point middle{(p[0][0] + p[1][0] + p[2][0]) / 3, (p[0][1] + p[1][1] + p[2][1]) / 3};
  out.is_over = !out.is_crossed && holds(facet, middle);
  return out;
}

/// Greatest number of evaluated points. After this number, parts are not cut any more, and the bound may exceed the
/// depth by more than the tolerance.
constexpr std::size_t most_points = 200000;
/// Greatest total number of sides and triangles of facets that are examined.
constexpr std::size_t most_of_facets = 100'000'000;

/// A point of a patch, its distance from the surface, and the closest triangle of the surface.
struct Sample {
  Vec3d point;
  double distance = 0;
  std::uint32_t other = 0;
};

/// A triangle that is a part of a triangle of a patch.
struct Part {
  std::array<Sample, 3> corners;
  std::size_t patch = 0;
  std::size_t triangle = 0;
  double bound = 0;
  [[nodiscard]] friend bool operator<(const Part& a, const Part& b) {
    return std::tuple(a.bound, b.patch, b.triangle) < std::tuple(b.bound, a.patch, a.triangle);
  }
};

/// The surface of the solid in which a patch lies.
struct Surface {
  Surface(const TriangleMesh& of_patch, double rounding)
      : mesh(of_patch), sites(of_patch), bvh(of_patch, sites), facets(of_patch, 16 * rounding) {}

  MeshView mesh;
  SiteTable sites;
  Bvh bvh;
  Facets facets;
};

class Search {
 public:
  Search(std::span<const DeepPatch> patches, double known, double tolerance, const Context& context)
      : patches_(patches), known_(known), tolerance_(tolerance), context_(context) {
    for (const DeepPatch& patch : patches) {
      const Box3 box = bounds(patch.surface);
      rounding_ = std::max(rounding_, 1e-14 * (length(box.lower) + length(box.upper)));
      surfaces_.emplace_back(patch.surface, rounding_);
    }
  }

  DeepestPoint run() {
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      for (std::size_t t = 0; t < patches_[p].triangles.size(); ++t) {
        Part part;
        part.patch = p;
        part.triangle = t;
        for (std::size_t c = 0; c < 3; ++c) part.corners[c] = sample(patches_[p].triangles[t][c], part);
        push(part);
      }
    }
    while (!parts_.empty() && !is_done(parts_.top().bound) && points_ < most_points) {
      const Part part = parts_.top();
      parts_.pop();
      if (!cut_along_facets(part)) cut(part);
    }
    best_.bound = std::max({best_.distance, dropped_, parts_.empty() ? 0.0 : parts_.top().bound});
    return best_;
  }

 private:
  [[nodiscard]] bool is_done(double bound) const {
    return bound <= std::max(best_.distance, known_) * (1 + tolerance_) + rounding_;
  }

  Sample sample(const Vec3d& point, const Part& part) {
    const Surface& surface = surfaces_[part.patch];
    const NearestSite found = *surface.bvh.nearest(point);
    const Sample out{point, found.distance, surface.sites.triangle(found.site).value};
    if (out.distance > best_.distance || points_ == 0) {
      best_ = {out.distance, 0, point, found.point, part.patch, part.triangle, out.other};
    }
    constexpr std::size_t points_between_looks = 1024;
    if (++points_ % points_between_looks == 0) throw_if_cancelled(context_);
    return out;
  }

  /// Returns an upper bound on the distances of a part's points from the surface: the least of three kinds of bounds.
  /// The first is the distance from one triangle of the surface, which is largest at a corner of the part. The second
  /// is the distance of a corner from the surface plus the longest distance from that corner. If the whole part is over
  /// a facet, the third is the largest distance of a corner from the facet's plane.
  [[nodiscard]] double bound(const Part& part) {
    double least = std::numeric_limits<double>::infinity();
    for (const Sample& from : part.corners) {
      const std::array<Vec3d, 3> other = triangle_corners(surfaces_[part.patch].mesh, from.other);
      double furthest = 0;
      double longest = 0;
      for (const Sample& to : part.corners) {
        furthest = std::max(furthest, triangle_distance({to.point, to.point, to.point}, other).distance);
        longest = std::max(longest, length(to.point - from.point));
      }
      least = std::min({least, furthest, from.distance + longest});
    }
    for (std::size_t k = 0; k < 3 && !is_done(least); ++k) {
      const std::optional<Facets::Lie> lie = lie_to_facet(part, part.corners[k].other);
      if (lie && lie->is_over) least = std::min(least, lie->furthest);
    }
    return least;
  }

  void push(Part part) {
    part.bound = bound(part);
    if (is_done(part.bound)) {
      dropped_ = std::max(dropped_, part.bound);
    } else {
      parts_.push(part);
    }
  }

  /// Cuts a part along a side of a facet of the surface, because the distance from a facet is linear over it. In
  /// shallow contacts of large faces, these cuts yield few parts. Halving alone would need many parts.
  /// @return  true if a side of a facet crosses the part.
  bool cut_along_facets(const Part& part) {
    for (const Sample& corner : part.corners) {
      const std::optional<Facets::Lie> lie = lie_to_facet(part, corner.other);
      if (!lie || !lie->is_crossed) continue;
      cut_along(part, lie->sides);
      return true;
    }
    return false;
  }

  /// Returns the position of a part relative to the facet of a triangle.
  /// @return  nullopt if more than most_of_facets sides and triangles were examined.
  std::optional<Facets::Lie> lie_to_facet(const Part& part, std::uint32_t triangle) {
    const Facets& facets = surfaces_[part.patch].facets;
    looked_at_ += facets.size(triangle);
    if (looked_at_ > most_of_facets) return std::nullopt;
    return facets.lie(points_of(part), triangle);
  }

  static std::array<Vec3d, 3> points_of(const Part& part) {
    return {part.corners[0].point, part.corners[1].point, part.corners[2].point};
  }

  /// Cuts a part along a line.
  /// @param sides  signed distances of the corners from the line: at least one above 0 and one below.
  void cut_along(const Part& part, const std::array<double, 3>& sides) {
    // The corners of both pieces, in cyclic order. Points on the line belong to both pieces.
    std::vector<Sample> above;
    std::vector<Sample> below;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Sample& corner = part.corners[k];
      if (sides[k] >= 0) above.push_back(corner);
      if (sides[k] <= 0) below.push_back(corner);
      if (!(sides[k] * sides[next] < 0)) continue;
      const double t = sides[k] / (sides[k] - sides[next]);
      const Sample between = sample(corner.point + (part.corners[next].point - corner.point) * t, part);
      above.push_back(between);
      below.push_back(between);
    }
    for (const std::vector<Sample>& piece : {above, below}) {
      for (std::size_t k = 2; k < piece.size(); ++k) {
        Part out = part;
        out.corners = {piece[0], piece[k - 1], piece[k]};
        push(out);
      }
    }
  }

  /// Cuts a part in two halves at the middle of its longest side.
  void cut(const Part& part) {
    std::size_t at = 0;
    double longest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double square = squared_length(part.corners[(k + 1) % 3].point - part.corners[k].point);
      if (square > longest) {
        longest = square;
        at = k;
      }
    }
    const Vec3d middle = (part.corners[at].point + part.corners[(at + 1) % 3].point) * 0.5;
    const Sample between = sample(middle, part);
    Part first = part;
    Part second = part;
    first.corners[(at + 1) % 3] = between;
    second.corners[at] = between;
    push(first);
    push(second);
  }

  std::span<const DeepPatch> patches_;
  std::vector<Surface> surfaces_;
  double known_;
  double tolerance_;
  const Context& context_;
  double rounding_ = 0;  ///< a bound on the error of distances
  DeepestPoint best_;
  double dropped_ = 0;  ///< largest bound of parts that are not examined further
  std::size_t points_ = 0;
  std::size_t looked_at_ = 0;  ///< number of sides and triangles of facets examined
  std::priority_queue<Part> parts_;
};

/// Returns the point of all patches that is furthest from the surface of the solid in which its patch lies. Uses branch
/// and bound (Guthe and others 2005). The distance from a fixed triangle is convex, so over a part of a triangle it is
/// largest at a corner. The distance from a surface is no larger than that from any of its triangles.
/// @param known      depth of a point found before. Parts whose bound is not above this depth are not cut.
/// @param tolerance  largest allowed excess of the bound over the depth, relative to the depth. After 200,000 points
/// the search ends, even if the excess is still larger.
/// @throws Cancelled.
DeepestPoint deepest_point(std::span<const DeepPatch> patches, double known, double tolerance, const Context& context) {
  return Search(patches, known, tolerance, context).run();
}

}  // namespace
}  // namespace blum::detail

namespace blum {

void check(const PenetrationOptions& options) {
  if (options.depth_tolerance >= 1e-6 && options.depth_tolerance <= 1) return;
  throw InvalidOption("depth_tolerance is " + exact_text(options.depth_tolerance) + ", but must be 1e-6 to 1");
}

}  // namespace blum

namespace blum::detail {
namespace {

/// The surfaces of one or two objects in one mesh, and the triangles of the objects that they come from.
struct Surfaces {
  TriangleMesh mesh;
  std::vector<std::uint32_t> triangle_of;  ///< for each triangle, the triangle of its object
  std::size_t of_first = 0;                ///< number of triangles of the first object, which come first

  [[nodiscard]] bool is_of_first(std::uint32_t triangle) const { return triangle < of_first; }

  void add(const SolidSurface& surface) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), surface.mesh.vertices.begin(), surface.mesh.vertices.end());
    for (const auto& [a, b, c] : surface.mesh.triangles) mesh.triangles.push_back({base + a, base + b, base + c});
    triangle_of.insert(triangle_of.end(), surface.triangle_of.begin(), surface.triangle_of.end());
  }
};

/// The surfaces of the objects of a scene. Each is computed once.
class SolidSurfaces {
 public:
  explicit SolidSurfaces(const Context& context) : context_(&context) {}

  /// Returns the surface of the solid that an object bounds, without parts of triangles inside the solid. The surface
  /// winds around each point at most once. So points around which two of these surfaces wind twice are in both solids.
  /// @throws InvalidMesh; Cancelled.
  const SolidSurface& of(ObjectId id, const SceneObject& object) {
    const auto [at, is_new] = made_.try_emplace(id);
    if (is_new) {
      at->second = winding_surface(mesh_of(object), name_of(id, object), *context_);
      number_triangles(at->second);
    }
    return at->second;
  }
  /// Returns the surface of an object without changes.
  /// @throws InvalidMesh.
  static SolidSurface with_itself(ObjectId id, const SceneObject& object) {
    SolidSurface out{mesh_of(object), {}, {}};
    check_faces_outwards(out.mesh, name_of(id, object));
    number_triangles(out);
    return out;
  }

 private:
  static TriangleMesh mesh_of(const SceneObject& object) { return {object.positions(), object.mesh().triangles}; }
  static void number_triangles(SolidSurface& surface) {
    if (!surface.triangle_of.empty()) return;
    surface.triangle_of.resize(surface.mesh.triangles.size());
    std::iota(surface.triangle_of.begin(), surface.triangle_of.end(), 0U);
  }

  const Context* context_;
  std::map<ObjectId, SolidSurface> made_;
};

/// One connected part of an overlap.
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
  /// The source triangles of a patch, and of the surface of the solid in which it lies.
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
    // Rounding errors may make the volume of thin parts slightly negative.
    const double rounding = 1e-12 * bounds(overlap_.mesh).largest_coordinate() * (out.area[0] + out.area[1]);
    if (out.volume < 0 && out.volume > -rounding) out.volume = 0;
  }

  /// Measures the depth of the part: the largest distance of a point of one label's triangles from those of the other
  /// labels. Up to 8 labels are measured together; two solids have two. An object that meets itself may have thousands
  /// of labels. These labels are measured one by one, those with the largest bound first, until no further bound is
  /// above the depth found.
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

  /// Upper bound on the distance of points of a label's triangles from the triangles of other labels.
  struct Reach {
    std::uint32_t label = 0;
    double reach = 0;  ///< infinite if the triangles have no common edge with other labels
  };

  /// Returns the bounds of all labels, the largest first.
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

  /// Returns the triangles of one label as a patch, and the triangles of all other labels as the surface.
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

  /// Fills `surface` with the whole surface of the other solid. The whole surface is needed if a part lies in the other
  /// solid without meeting its surface.
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

/// Returns a normal of a triangle. Its length is twice the triangle's area.
Vec3d normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto [a, b, c] = triangle_corners(mesh, triangle);
  return cross(b - a, c - a);
}

/// Returns true if the first nonzero coordinate of a vector is negative.
bool is_backward(const Vec3d& v) {
  if (v.x != 0) return v.x < 0;
  if (v.y != 0) return v.y < 0;
  return v.z < 0;
}

/// Decides, for triangles of the overlap on which two surfaces coincide, which surface they belong to. Without this
/// decision, the overlap of two equal solids would have triangles of the first solid only, and no depth. The result is
/// as if the first solid were moved by an infinitely small step along x, and by smaller ones along y and z. So
/// triangles whose normal is_backward() belong to the first solid. If one object meets itself, the triangle with the
/// smaller index is treated as that of the first solid.
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

/// Returns a label for each triangle of an overlap. For two objects, the label is 0 or 1. If an object meets itself,
/// triangles of one part of the object have the same label. Triangles of a part are connected through common vertices,
/// or through equal positions if the mesh is not welded.
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

/// @throws InvalidMesh with the reason why the overlap of two objects cannot be computed.
[[noreturn]] void refuse(const TwoObjects& two, const std::string& obstacle) {
  const std::string first = name_of(two.first, *two.a);
  const std::string second = name_of(two.second, *two.b);
  check_is_closed(two.a->mesh(), first);
  check_is_closed(two.b->mesh(), second);
  throw InvalidMesh("the intersection of " +
                    (two.first == two.second ? "parts of " + first : first + " and " + second) +
                    " cannot be computed: " + obstacle);
}

/// Returns the parts of the overlap of two objects, the deepest first.
/// @throws InvalidMesh; Cancelled.
std::vector<Penetration> parts_of(const TwoObjects& two, SolidSurfaces& solids, double tolerance,
                                  const Context& context, std::vector<PhaseTime>& phases) {
  const bool is_self = two.first == two.second;
  PhaseTimer timer(phases);
  Surfaces surfaces;
  if (is_self) {
    surfaces.add(SolidSurfaces::with_itself(two.first, *two.a));
    surfaces.of_first = surfaces.mesh.triangles.size();
  } else {
    const SolidSurface& first = solids.of(two.first, *two.a);
    const SolidSurface& second = solids.of(two.second, *two.b);
    if (are_apart(two)) {
      timer.lap("surfaces");
      return {};
    }
    surfaces.add(first);
    surfaces.of_first = surfaces.mesh.triangles.size();
    surfaces.add(second);
  }
  timer.lap("surfaces");
  Overlap overlap = overlap_of(surfaces.mesh, context);
  if (!overlap.obstacle.empty()) refuse(two, overlap.obstacle);
  timer.lap("overlap");
  std::map<std::uint32_t, std::vector<std::uint32_t>> bodies;
  for (std::uint32_t t = 0; t < overlap.body_of.size(); ++t) bodies[overlap.body_of[t]].push_back(t);
  share_out_common_faces(surfaces, is_self, overlap);
  const std::vector<std::uint32_t> labels = labels_of(surfaces, overlap, is_self);
  std::vector<Penetration> parts;
  for (const auto& [body, triangles] : bodies) {
    throw_if_cancelled(context);
    parts.push_back(Body(surfaces, overlap, labels, triangles).measure(tolerance, context));
    parts.back().first_object = two.first;
    parts.back().second_object = two.second;
  }
  // Parts are first ordered by their smallest triangle. Equally deep parts keep this order.
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
    return std::pair(-parts[x].depth, x) < std::pair(-parts[y].depth, y);
  });
  std::vector<Penetration> sorted;
  for (const std::size_t k : order) sorted.push_back(std::move(parts[k]));
  timer.lap("depths");
  return sorted;
}

/// Adds the seconds of each phase to the phase with the same name.
void add(const std::vector<PhaseTime>& from, std::vector<PhaseTime>& to) {
  for (const PhaseTime& one : from) {
    const auto same =
        std::find_if(to.begin(), to.end(), [&](const PhaseTime& other) { return other.phase == one.phase; });
    if (same != to.end()) same->seconds += one.seconds;
  }
}

}  // namespace

bool are_apart(const TwoObjects& two) {
  return two.first != two.second && box_gap(two.a->bounds(), two.b->bounds()) > 0;
}

std::vector<std::vector<Penetration>> penetrations(std::span<const TwoObjects> pairs, const PenetrationOptions& options,
                                                   const Context& context, std::vector<PhaseTime>& phases) {
  check(options);
  std::vector<PhaseTime> spent{{"surfaces", 0}, {"overlap", 0}, {"depths", 0}};
  Context of_pair = context;
  const bool shows_pairs = context.progress && pairs.size() > 1;
  if (shows_pairs) of_pair.progress = {};
  SolidSurfaces solids(of_pair);
  std::vector<std::vector<Penetration>> out;
  for (const TwoObjects& two : pairs) {
    throw_if_cancelled(context);
    std::vector<PhaseTime> more;
    out.push_back(parts_of(two, solids, options.depth_tolerance, of_pair, more));
    add(more, spent);
    if (shows_pairs) {
      context.progress(static_cast<double>(out.size()) / static_cast<double>(pairs.size()), "penetration");
    }
  }
  if (!pairs.empty()) phases.insert(phases.end(), spent.begin(), spent.end());
  return out;
}

}  // namespace blum::detail

namespace blum {

PrimitivePair deepest_pair(const Penetration& part) {
  constexpr TriangleFeature inside{SiteKind::face, 0};
  PrimitivePair out{part.first_object,
                    part.second_object,
                    part.deep_triangle,
                    part.surface_triangle,
                    {-part.depth, part.deep_point, part.surface_point, inside, inside}};
  if (!part.is_first_deep) {
    std::swap(out.first, out.second);
    std::swap(out.between.first_point, out.between.second_point);
  }
  return out;
}

}  // namespace blum
