#include "proximity/least_translation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/scale.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_components.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/solid/winding_surface.hpp"
#include "proximity/hull_depth.hpp"
#include "proximity/scene_object.hpp"
#include "proximity/scene_penetration.hpp"

namespace blum::detail {
namespace {

/// Corners that are above the plane of a neighbour by less than this are treated as points of the plane. Lengths are
/// scaled to about 1.
constexpr double flat = 1e-13;

/// A solid of a pair, in the units of the search.
struct TranslatedSolid {
  TriangleMesh mesh;  ///< welded
  bool is_convex = false;
  std::vector<Vec3d> inner;    ///< a vertex of each connected part of the surface
  std::vector<Vec3d> normals;  ///< unit normals of the largest flat parts
};

Vec3d unit(const Vec3d& v) {
  const double size = length(v);
  return size > 0 ? v / size : Vec3d{};
}

/// Gives equal vertices one index, so that neighbours share them.
void weld(TriangleMesh& mesh) {
  const std::vector<std::uint32_t> cluster = weld_clusters(mesh.vertices);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = cluster[v];
  }
  std::erase_if(mesh.triangles, names_vertex_twice);
}

/// A side of a triangle, with the smaller vertex first, and the corner opposite to it.
struct SideOf {
  std::array<std::uint32_t, 2> ends{};
  std::uint32_t triangle = 0;
  std::uint32_t opposite = 0;

  friend bool operator<(const SideOf& a, const SideOf& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle;
  }
};

std::vector<SideOf> sides_of(const TriangleMesh& mesh) {
  std::vector<SideOf> out;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k];
      const std::uint32_t b = v[(k + 1) % 3];
      out.push_back({{std::min(a, b), std::max(a, b)}, t, v[(k + 2) % 3]});
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

Vec3d normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto [a, b, c] = triangle_corners(mesh, triangle);
  return cross(b - a, c - a);
}

/// Returns the vertices that triangles use.
std::vector<Vec3d> used_vertices(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> is_used(mesh.vertices.size(), 0);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { is_used[v] = 1; });
  std::vector<Vec3d> out;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (is_used[v] != 0) out.push_back(mesh.vertices[v]);
  }
  return out;
}

/// Returns true if a surface is convex at each of its edges, and a sphere in shape. A surface with both properties is
/// convex.
bool is_convex(const TriangleMesh& mesh, const std::vector<SideOf>& sides, std::size_t parts) {
  if (parts != 1) return false;
  if (used_vertices(mesh).size() + mesh.triangles.size() != sides.size() / 2 + 2) return false;
  for (std::size_t k = 0; k < sides.size(); k += 2) {
    if (k + 1 >= sides.size() || sides[k].ends != sides[k + 1].ends) return false;
    if (k + 2 < sides.size() && sides[k + 2].ends == sides[k].ends) return false;
    const Vec3d own = unit(normal_of(mesh, sides[k].triangle));
    const Vec3d other = unit(normal_of(mesh, sides[k + 1].triangle));
    const Vec3d& end = mesh.vertices[sides[k].ends[0]];
    const double over = std::min(dot(own, mesh.vertices[sides[k + 1].opposite] - end),
                                 dot(other, mesh.vertices[sides[k].opposite] - end));
    if (over > flat) return false;
    if (over > -flat && dot(own, other) < 0) return false;
  }
  return true;
}

/// Returns a vertex of each connected part of a surface.
std::vector<Vec3d> vertex_of_each_part(const TriangleMesh& mesh) {
  UnionFind parts(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    parts.join(t[0], t[1]);
    parts.join(t[1], t[2]);
  }
  std::vector<std::uint32_t> roots;
  for (const Triangle& t : mesh.triangles) roots.push_back(parts.find(t[0]));
  sort_unique(roots);
  std::vector<Vec3d> out;
  for (const std::uint32_t v : roots) out.push_back(mesh.vertices[v]);
  return out;
}

/// Returns the normals of the parts with the largest area, at most `most`. Normals that differ by less than 0.6 degrees
/// are treated as one normal.
std::vector<Vec3d> largest_normals(const TriangleMesh& mesh, std::size_t most) {
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) order.emplace_back(-length(normal_of(mesh, t)), t);
  std::sort(order.begin(), order.end());
  std::vector<Vec3d> out;
  for (const auto& [area, t] : order) {
    const Vec3d normal = unit(normal_of(mesh, t));
    const auto is_same = [&](const Vec3d& other) { return dot(normal, other) > 0.99995; };
    if (normal == Vec3d{} || std::any_of(out.begin(), out.end(), is_same)) continue;
    out.push_back(normal);
    if (out.size() == most) break;
  }
  return out;
}

TranslatedSolid solid_of(TriangleMesh mesh) {
  constexpr std::size_t most_normals = 16;
  TranslatedSolid out;
  weld(mesh);
  out.inner = vertex_of_each_part(mesh);
  out.is_convex = is_convex(mesh, sides_of(mesh), out.inner.size());
  out.normals = largest_normals(mesh, most_normals);
  out.mesh = std::move(mesh);
  return out;
}

/// The inside of a solid, with distances from its surface.
class Inside {
 public:
  Inside(const TriangleMesh& mesh, const Context& context)
      : sites_(mesh, context), bvh_(mesh, sites_, context), winding_(mesh, sites_, context) {}

  [[nodiscard]] bool contains(const Vec3d& point) const { return winding_.is_inside(point); }
  /// Returns the distance of a point from the surface, negative outside.
  [[nodiscard]] double depth(const Vec3d& point) const {
    const std::optional<NearestSite> found = bvh_.nearest(point);
    const double distance = found ? found->distance : 0;
    return contains(point) ? distance : -distance;
  }

 private:
  SiteTable sites_;
  Bvh bvh_;
  WindingNumber winding_;
};

/// Two solids that overlap, of which at least one is not convex.
class OverlappingSolids {
 public:
  OverlappingSolids(const TranslatedSolid& first, const TranslatedSolid& second, const Context& context)
      : first_(first),
        second_(second),
        inside_first_(first.mesh, context),
        inside_second_(second.mesh, context),
        context_(context) {
    moving_ = scene_.add(first.mesh, {}, context);
    resting_ = scene_.add(second.mesh, {}, context);
  }

  /// Returns a lower bound. If balls around a point p lie in both solids, the first solid must move by at least the sum
  /// of their radii. The search divides the common box of both solids.
  [[nodiscard]] double lower_bound() const;

  /// Shortens a translation that separates the solids.
  /// @param depths  lengths that are tried along each direction.
  [[nodiscard]] Vec3d shortened(Vec3d best, std::span<const double> depths, std::size_t most_tests);

 private:
  /// Returns true if the solids have no common point after a translation of the first one.
  [[nodiscard]] bool are_apart(const Vec3d& translation);
  [[nodiscard]] std::vector<Vec3d> directions(const Vec3d& best) const;
  void shorten_along(const Vec3d& direction, std::span<const double> depths, Vec3d& best);
  void shorten_between(const Vec3d& direction, double free, Vec3d& best);
  void turn(Vec3d& best);
  [[nodiscard]] double sum_of_radii(const Vec3d& point) const {
    return inside_first_.depth(point) + inside_second_.depth(point);
  }
  [[nodiscard]] double climb(Vec3d point, double step) const;

  const TranslatedSolid& first_;
  const TranslatedSolid& second_;
  Inside inside_first_;
  Inside inside_second_;
  const Context& context_;
  ProximityScene scene_;
  ObjectId moving_;
  ObjectId resting_;
  std::size_t tests_left_ = 0;
};

double OverlappingSolids::lower_bound() const {
  constexpr std::size_t most = 4000;
  struct Cell {
    double bound = 0;
    Vec3d center;
    Vec3d half;
    bool operator<(const Cell& other) const { return bound < other.bound; }
  };
  Box3 box = bounds(first_.mesh);
  const Box3 other = bounds(second_.mesh);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::max(box.lower[axis], other.lower[axis]);
    box.upper[axis] = std::min(box.upper[axis], other.upper[axis]);
  }
  double best = 0;
  Vec3d at = box.center();
  double step = length(box.size()) / 2;
  std::priority_queue<Cell> cells;
  std::size_t count = 0;
  const auto add = [&](const Vec3d& center, const Vec3d& half) {
    const double here = sum_of_radii(center);
    ++count;
    if (here > best) {
      best = here;
      at = center;
      step = length(half);
    }
    cells.push({here + 2 * length(half), center, half});
  };
  add(box.center(), box.size() * 0.5);
  while (!cells.empty() && count < most) {
    const Cell cell = cells.top();
    cells.pop();
    if (cell.bound <= best * 1.001) break;
    if (count % 64 == 1) throw_if_cancelled(context_);
    for (unsigned k = 0; k < 8; ++k) {
      const Vec3d half = cell.half * 0.5;
      add(cell.center + Vec3d{(k & 1U) != 0 ? half.x : -half.x, (k & 2U) != 0 ? half.y : -half.y,
                              (k & 4U) != 0 ? half.z : -half.z},
          half);
    }
  }
  return best > 0 ? std::max(best, climb(at, step)) : 0;
}

/// Moves a point in ever smaller steps to larger sums of radii, and returns the sum.
double OverlappingSolids::climb(Vec3d point, double step) const {
  double best = sum_of_radii(point);
  for (int halvings = 0; halvings < 46;) {
    const Vec3d from = point;
    for (int k = 0; k < 27; ++k) {
      const Vec3d way{static_cast<double>(k % 3 - 1), static_cast<double>(k / 3 % 3 - 1),
                      static_cast<double>(k / 9 - 1)};
      const Vec3d to = from + unit(way) * step;
      const double here = sum_of_radii(to);
      if (here > best) {
        best = here;
        point = to;
      }
    }
    if (point == from) {
      step /= 2;
      ++halvings;
    }
  }
  return best;
}

bool OverlappingSolids::are_apart(const Vec3d& translation) {
  throw_if_cancelled(context_);
  if (tests_left_ == 0) return false;
  --tests_left_;
  RigidTransform place;
  place.translation = translation;
  scene_.update(moving_, place);
  if (scene_.meets(moving_, resting_, context_)) return false;
  const auto is_in_second = [&](const Vec3d& p) { return inside_second_.contains(p + translation); };
  const auto is_in_first = [&](const Vec3d& p) { return inside_first_.contains(p - translation); };
  return std::none_of(first_.inner.begin(), first_.inner.end(), is_in_second) &&
         std::none_of(second_.inner.begin(), second_.inner.end(), is_in_first);
}

/// Returns directions in which the first solid may leave the second.
std::vector<Vec3d> OverlappingSolids::directions(const Vec3d& best) const {
  std::vector<Vec3d> out{unit(best)};
  for (const Vec3d& normal : second_.normals) out.push_back(normal);
  for (const Vec3d& normal : first_.normals) out.push_back(-normal);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double way : {1.0, -1.0}) {
      Vec3d direction;
      direction[axis] = way;
      out.push_back(direction);
    }
  }
  std::vector<Vec3d> distinct;
  for (const Vec3d& direction : out) {
    const auto is_same = [&](const Vec3d& other) { return dot(direction, other) > 1 - 1e-12; };
    if (std::none_of(distinct.begin(), distinct.end(), is_same)) distinct.push_back(direction);
  }
  return distinct;
}

/// Halves the range between a length that separates the solids and a shorter length that does not.
void OverlappingSolids::shorten_between(const Vec3d& direction, double free, Vec3d& best) {
  double blocked = 0;
  const double least = 1e-13;
  while (free - blocked > least + 1e-13 * free) {
    const double middle = blocked + (free - blocked) / 2;
    (are_apart(direction * middle) ? free : blocked) = middle;
    if (tests_left_ == 0) break;
  }
  if (free < length(best)) best = direction * free;
}

void OverlappingSolids::shorten_along(const Vec3d& direction, std::span<const double> depths, Vec3d& best) {
  constexpr int steps = 6;
  const double most = length(best);
  std::vector<double> lengths;
  for (const double depth : depths) lengths.push_back(depth * (1 + 1e-9) + 1e-12);
  for (int k = 1; k < steps; ++k) {
    lengths.push_back(most * k / steps);
    lengths.push_back(std::ldexp(most, -k - 3));
  }
  lengths.push_back(most * (1 - 1e-9));
  std::sort(lengths.begin(), lengths.end());
  for (const double free : lengths) {
    if (free >= most || tests_left_ == 0) return;
    if (are_apart(direction * free)) return shorten_between(direction, free, best);
  }
}

/// Turns a translation in ever smaller steps, as long as it gets shorter.
void OverlappingSolids::turn(Vec3d& best) {
  constexpr double least = 1e-7;  // radians; the length changes by the square
  for (double angle = 0.3; angle > least && tests_left_ > 0;) {
    const Vec3d direction = unit(best);
    const Vec3d other = std::abs(direction.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d u = unit(cross(direction, other));
    const Vec3d v = cross(direction, u);
    const double before = length(best);
    for (int k = 0; k < 8; ++k) {
      const double around = 0.7853981633974483 * k;
      const Vec3d turned = unit(direction + (u * std::cos(around) + v * std::sin(around)) * angle);
      const double shorter = before * (1 - std::max(0.02 * angle, 1e-9));
      if (!are_apart(turned * shorter)) continue;
      shorten_between(turned, shorter, best);
      break;
    }
    if (!(length(best) < before)) angle /= 3;
  }
}

Vec3d OverlappingSolids::shortened(Vec3d best, std::span<const double> depths, std::size_t most_tests) {
  tests_left_ = most_tests;
  for (const Vec3d& direction : directions(best)) shorten_along(direction, depths, best);
  turn(best);
  return best;
}

/// The pair in the units of the search: the box around both has its centre at the origin, and a size of about 1.
class TranslationSearch {
 public:
  TranslationSearch(const TwoObjects& two, const TranslationOptions& options, const Context& context)
      : two_(two), options_(options), context_(context) {}

  [[nodiscard]] LeastTranslation find() {
    LeastTranslation out;
    TriangleMesh first = surface(*two_.a, two_.first);
    TriangleMesh second = surface(*two_.b, two_.second);
    normalise(first, second);
    const TranslatedSolid a = solid_of(std::move(first));
    const TranslatedSolid b = solid_of(std::move(second));
    out.are_convex = a.is_convex && b.is_convex;
    if (detail::are_apart(two_)) return out;
    const HullDepth hulls = hull_depth(used_vertices(a.mesh), used_vertices(b.mesh), options_.translation_tolerance,
                                       options_.max_planes, context_);
    double lower = hulls.lower;
    Vec3d translation = hulls.direction * hulls.upper;
    if (!out.are_convex && hulls.upper > 0) bound_by_tests(a, b, lower, translation);
    out.translation = translation / scale_;
    out.upper = length(out.translation);
    out.lower = std::min(lower / scale_, out.upper);
    return out;
  }

 private:
  [[nodiscard]] TriangleMesh surface(const SceneObject& object, ObjectId id) const {
    return winding_surface({object.positions(), object.mesh().triangles}, name_of(id, object), context_).mesh;
  }

  void normalise(TriangleMesh& first, TriangleMesh& second) {
    Box3 box = bounds(first);
    box.extend(bounds(second));
    const Vec3d size = box.size();
    scale_ = scale_to_one(std::max({size.x, size.y, size.z}));
    const Vec3d center = box.center();
    for (TriangleMesh* mesh : {&first, &second}) {
      for (Vec3d& v : mesh->vertices) v = (v - center) * scale_;
    }
  }

  /// Finds bounds for solids that are not both convex.
  void bound_by_tests(const TranslatedSolid& a, const TranslatedSolid& b, double& lower, Vec3d& translation) const {
    constexpr double rounding = 4e-15;
    std::vector<PhaseTime> phases;
    const std::vector<Penetration> parts =
        std::move(penetrations({&two_, 1}, {.depth_tolerance = 1}, context_, phases).front());
    lower = 0;
    if (parts.empty()) {
      translation = {};
      return;
    }
    std::vector<double> depths;
    for (const Penetration& part : parts) {
      depths.push_back(part.depth * scale_);
      if (depths.size() == 3) break;
    }
    OverlappingSolids solids(a, b, context_);
    lower = std::max(solids.lower_bound() - rounding, 0.0);
    translation = solids.shortened(translation, depths, options_.max_tests);
  }

  const TwoObjects& two_;
  const TranslationOptions& options_;
  const Context& context_;
  double scale_ = 1;
};

}  // namespace

LeastTranslation least_translation(const TwoObjects& two, const TranslationOptions& options, const Context& context) {
  check(options);
  if (two.first == two.second) {
    throw InvalidOption("least_translation() needs two objects, but both are object " +
                        std::to_string(two.first.value) + "; add the mesh twice to compare it with itself");
  }
  return TranslationSearch(two, options, context).find();
}

}  // namespace blum::detail

namespace blum {

void check(const TranslationOptions& options) {
  if (!(options.translation_tolerance >= 0 && options.translation_tolerance <= 1)) {
    throw InvalidOption("translation_tolerance is " + exact_text(options.translation_tolerance) +
                        ", but must be 0 to 1");
  }
  if (options.max_planes < 1) throw InvalidOption("max_planes is 0, but must be at least 1");
}

LeastTranslation least_translation(const MeshView& first, const MeshView& second, const TranslationOptions& options,
                                   const Context& context) {
  ProximityScene scene;
  const ObjectId a = scene.add(first, {.name = "the first solid"}, context);
  const ObjectId b = scene.add(second, {.name = "the second solid"}, context);
  return scene.least_translation(a, b, options, context);
}

}  // namespace blum
