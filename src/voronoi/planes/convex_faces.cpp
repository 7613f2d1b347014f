#include "voronoi/planes/convex_faces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "blum/core/sort_unique.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

/// Returns the exponent of the last binary digit of a number that is not 0.
int last_digit(double value) {
  int exponent = 0;
  const double part = std::frexp(std::abs(value), &exponent);
  const auto digits = static_cast<std::uint64_t>(std::ldexp(part, 53));
  return exponent - 53 + std::countr_zero(digits);
}

/// Returns value / 2^exponent, which must be an integer.
Integer in_units(double value, int exponent) {
  if (value == 0) return 0;
  const int last = last_digit(value);
  const Integer digits = static_cast<std::int64_t>(std::ldexp(value, -last));
  return detail::times_power(digits, last - exponent);
}

using IntegerPoint = std::array<Integer, 3>;

IntegerPoint minus(const IntegerPoint& a, const IntegerPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Integer dot(const IntegerPoint& a, const IntegerPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

class Finder {
 public:
  Finder(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
         std::span<const std::uint32_t> component, double flatness, const Context& context)
      : mesh_(mesh), table_(table), sites_(sites), component_(component), flatness_(flatness), context_(context) {
    for (const std::uint32_t t : component_) {
      faces_[sites_.face_of[t]].triangles.push_back(t);
      for (const std::uint32_t v : mesh_.triangles[t]) vertices_.push_back(v);
    }
    detail::sort_unique(vertices_);
    out_.origin = mesh_.vertices[vertices_.front()];
  }

  std::optional<ConvexFaces> find() {
    measure();
    const bool is_joined = flatness_ > 0 && join();
    if (!is_joined && has_reflex_edge()) return std::nullopt;
    set_unit();
    for (const auto& [face, found] : faces_) groups_[found.group].push_back(face);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;  // (smallest face, group)
    for (const auto& [group, faces] : groups_) order.emplace_back(faces.front(), group);
    std::sort(order.begin(), order.end());
    for (const auto& [first, group] : order) {
      if (!add(groups_[group])) return std::nullopt;
    }
    out_.spaces = HalfSpaces(planes_, reach_, std::ldexp(1.0, exponent_), context_);
    if (is_joined && !is_convex()) return std::nullopt;
    add_neighbours();
    return std::move(out_);
  }

 private:
  struct Face {
    std::vector<std::uint32_t> triangles;
    Vec3d normal;  ///< outward unit vector of its largest triangle
    Vec3d corner;  ///< a corner of that triangle
    double area = 0;
    double width = 0;                       ///< smallest height of that triangle
    std::vector<std::uint32_t> neighbours;  ///< faces across edges
    std::uint32_t group = 0;                ///< its face of the largest area
  };

  [[nodiscard]] Vec3d place(std::uint32_t vertex) const { return mesh_.vertices[vertex] - out_.origin; }

  /// Returns a triangle's unit normal, which is precise for needles, too.
  [[nodiscard]] Vec3d normal_of(std::uint32_t t) const {
    const auto [a, b, c] = triangle_corners(mesh_, t);
    return unit_normal(a, b, c);
  }

  void measure() {
    for (auto& [face, found] : faces_) {
      double largest = 0;
      for (const std::uint32_t t : found.triangles) {
        const auto& [a, b, c] = mesh_.triangles[t];
        const Vec3d area = cross(place(b) - place(a), place(c) - place(a)) * 0.5;
        const double size = length(area);
        found.area += size;
        if (size > largest) {
          largest = size;
          found.normal = normal_of(t);
          found.corner = place(a);
          const double longest =
              std::max({length(place(b) - place(a)), length(place(c) - place(b)), length(place(a) - place(c))});
          found.width = 2 * size / longest;
        }
        for (const EdgeId edge : table_.triangle_edges()[t]) {
          for (const std::uint32_t other : sites_.triangles_of[edge.value]) {
            if (sites_.face_of[other] != face) found.neighbours.push_back(sites_.face_of[other]);
          }
        }
      }
      detail::sort_unique(found.neighbours);
      found.group = face;
    }
  }

  [[nodiscard]] bool has_reflex_edge() const {
    return std::any_of(component_.begin(), component_.end(), [&](std::uint32_t t) {
      const auto& edges = table_.triangle_edges()[t];
      return std::any_of(edges.begin(), edges.end(),
                         [&](EdgeId edge) { return sites_.turn[edge.value] == EdgeTurn::reflex; });
    });
  }

  /// Joins faces to neighbours that lie in their planes, the largest faces first. Returns true if any were joined.
  bool join() {
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const auto& [face, found] : faces_) order.emplace_back(-found.area, face);
    std::sort(order.begin(), order.end());
    std::set<std::uint32_t> done;
    bool is_any = false;
    for (const auto& [area, seed] : order) {
      if (done.contains(seed)) continue;
      // The plane of a needle is known less well away from it. If a fitted plane contains more faces, it decides.
      std::vector<std::uint32_t> group = grown(seed, done, true);
      if (group.size() > 1 && !is_flat(group)) group = grown(seed, done, false);
      is_any = is_any || group.size() > 1;
      for (const std::uint32_t face : group) faces_[face].group = seed;
      done.insert(group.begin(), group.end());
    }
    return is_any;
  }

  /// Returns a face and all others that lie in its plane, reached over edges.
  /// @param done      faces that are left out.
  /// @param is_loose  also accept corners that lie in the plane as precisely as the face determines it.
  [[nodiscard]] std::vector<std::uint32_t> grown(std::uint32_t seed, const std::set<std::uint32_t>& done,
                                                 bool is_loose) {
    std::vector<std::uint32_t> out{seed};
    std::set<std::uint32_t> seen{seed};
    for (std::size_t k = 0; k < out.size(); ++k) {
      for (const std::uint32_t next : faces_[out[k]].neighbours) {
        if (done.contains(next) || seen.contains(next)) continue;
        if (!is_in_plane(faces_[next], faces_[seed], is_loose)) continue;
        seen.insert(next);
        out.push_back(next);
      }
    }
    return out;
  }

  [[nodiscard]] bool is_in_plane(const Face& face, const Face& plane, bool is_loose) const {
    constexpr double same_way = 0.9;
    if (!(blum::dot(face.normal, plane.normal) > same_way)) return false;
    return std::all_of(face.triangles.begin(), face.triangles.end(), [&](std::uint32_t t) {
      const Triangle& corners = mesh_.triangles[t];
      return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
        const Vec3d step = place(v) - plane.corner;
        const double most = is_loose ? flatness_ * (1 + length(step) / plane.width) : flatness_;
        return std::abs(blum::dot(plane.normal, step)) <= most;
      });
    });
  }

  /// Returns true if all corners of faces lie within `flatness` of the plane fitted to them.
  [[nodiscard]] bool is_flat(const std::vector<std::uint32_t>& faces) {
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t face : faces) {
      triangles.insert(triangles.end(), faces_[face].triangles.begin(), faces_[face].triangles.end());
    }
    return height_above(fitted(triangles), triangles) <= flatness_;
  }

  /// Plane fitted to triangles.
  struct Fit {
    Vec3d normal;  ///< unit vector that points inwards
    Vec3d middle;
  };

  [[nodiscard]] double twice_area(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return length(cross(place(b) - place(a), place(c) - place(a)));
  }

  /// Returns the centre of triangles by area.
  [[nodiscard]] Vec3d centre_of(const std::vector<std::uint32_t>& triangles) const {
    Vec3d sum;
    double weight = 0;
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = mesh_.triangles[t];
      const double area = twice_area(t);
      sum += (place(a) + place(b) + place(c)) * (area / 3);
      weight += area;
    }
    // The areas of needles may round to 0.
    return weight > 0 ? sum / weight : place(mesh_.triangles[triangles.front()][0]);
  }

  /// Returns the plane through the centre of triangles, across the sum of their areas as vectors.
  [[nodiscard]] Fit fitted(const std::vector<std::uint32_t>& triangles) const {
    Vec3d normal;
    for (const std::uint32_t t : triangles) normal -= normal_of(t) * twice_area(t);
    return {normal / length(normal), centre_of(triangles)};
  }

  /// Returns the largest distance of a corner of triangles from a plane.
  [[nodiscard]] double height_above(const Fit& plane, const std::vector<std::uint32_t>& triangles) const {
    double most = 0;
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        most = std::max(most, std::abs(blum::dot(plane.normal, place(v) - plane.middle)));
      }
    }
    return most;
  }

  void set_unit() {
    exponent_ = 0;
    bool is_first = true;
    for (const std::uint32_t v : vertices_) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = mesh_.vertices[v][axis];
        if (value == 0) continue;
        exponent_ = is_first ? last_digit(value) : std::min(exponent_, last_digit(value));
        is_first = false;
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) origin_[axis] = in_units(out_.origin[axis], exponent_);
    reach_ = 1;
    for (const std::uint32_t v : vertices_) {
      for (const Integer& value : point(v)) reach_ = std::max(reach_, Integer(2 * abs(value)));
    }
  }

  /// Returns a vertex in units, relative to the origin.
  [[nodiscard]] IntegerPoint point(std::uint32_t vertex) const {
    IntegerPoint out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[axis] = in_units(mesh_.vertices[vertex][axis], exponent_) - origin_[axis];
    }
    return out;
  }

  /// Adds the plane of faces.
  /// @return false if a corner is too far from a plane that was fitted.
  bool add(const std::vector<std::uint32_t>& faces) {
    std::vector<std::uint32_t>& triangles = out_.triangles.emplace_back();
    for (const std::uint32_t face : faces) {
      triangles.insert(triangles.end(), faces_[face].triangles.begin(), faces_[face].triangles.end());
    }
    std::sort(triangles.begin(), triangles.end());
    out_.site.push_back(faces.front());
    for (const std::uint32_t face : faces) {
      if (face != faces.front()) out_.joined.push_back({face, faces.front()});
    }
    if (faces.size() > 1) return add_fitted(triangles);
    const auto& [a, b, c] = mesh_.triangles[triangles.front()];
    const IntegerPoint p = point(a);
    const IntegerPoint u = minus(point(b), p);
    const IntegerPoint v = minus(point(c), p);
    // The normal of a triangle points outwards; that of a plane points inwards.
    IntegerPlane plane{{u[2] * v[1] - u[1] * v[2], u[0] * v[2] - u[2] * v[0], u[1] * v[0] - u[0] * v[1]}, 0};
    plane.offset = -dot(plane.normal, p);
    planes_.push_back(std::move(plane));
    return true;
  }

  bool add_fitted(const std::vector<std::uint32_t>& triangles) {
    const Fit fit = fitted(triangles);
    constexpr double digits = 0x1p60;
    // The middle is rounded to a small part of a unit, because the flatness may be smaller than a unit.
    constexpr int part = 60;
    IntegerPlane plane;
    IntegerPoint at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      plane.normal[axis] = static_cast<std::int64_t>(std::nearbyint(fit.normal[axis] * digits));
      at[axis] = rounded(fit.middle[axis], exponent_ - part);
    }
    plane.offset = -dot(plane.normal, at);
    for (Integer& value : plane.normal) value = detail::times_power(value, part);
    planes_.push_back(std::move(plane));
    out_.flatness = std::max(out_.flatness, height_above(fit, triangles));
    return out_.flatness <= 2 * flatness_;
  }

  void add_neighbours() {
    std::map<std::uint32_t, std::uint32_t> plane_of;
    for (std::uint32_t plane = 0; plane < out_.triangles.size(); ++plane) {
      for (const std::uint32_t t : out_.triangles[plane]) plane_of[sites_.face_of[t]] = plane;
    }
    out_.neighbours.resize(planes_.size());
    for (const auto& [face, found] : faces_) {
      std::vector<std::uint32_t>& list = out_.neighbours[plane_of[face]];
      for (const std::uint32_t other : found.neighbours) list.push_back(plane_of[other]);
    }
    for (std::uint32_t plane = 0; plane < out_.neighbours.size(); ++plane) {
      std::vector<std::uint32_t>& list = out_.neighbours[plane];
      detail::sort_unique(list);
      std::erase(list, plane);
      out_.middle.push_back(centre_of(out_.triangles[plane]));
    }
  }

  /// Returns value / 2^exponent, rounded.
  static Integer rounded(double value, int exponent) {
    if (value == 0 || last_digit(value) >= exponent) return in_units(value, exponent);
    return in_units(std::nearbyint(std::ldexp(value, -exponent)), 0);
  }

  /// Returns true if no corner lies clearly outside a plane.
  [[nodiscard]] bool is_convex() const {
    const HalfSpaces& spaces = out_.spaces;
    for (HalfSpaces::Index plane = 0; plane < spaces.plane_count(); ++plane) {
      for (const std::uint32_t v : vertices_) {
        if (blum::dot(spaces.normal(plane), place(v)) + spaces.offset(plane) < -2 * flatness_) return false;
      }
    }
    return true;
  }

  const MeshView& mesh_;
  const SiteTable& table_;
  const PolyhedronSites& sites_;
  const std::span<const std::uint32_t> component_;
  const double flatness_;
  std::vector<std::uint32_t> vertices_;
  std::map<std::uint32_t, Face> faces_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups_;
  const Context& context_;
  int exponent_ = 0;  ///< of the unit, a power of two: coordinates minus those of the origin are multiples of it
  IntegerPoint origin_;
  std::vector<IntegerPlane> planes_;  ///< in units
  Integer reach_;                     ///< bound on the coordinates of the polyhedron, in units
  ConvexFaces out_;
};

}  // namespace

double rounding_of_coordinates(const MeshView& mesh) {
  int digits = 0;
  double largest = 0;
  for (const Vec3d& p : mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (p[axis] == 0) continue;
      int exponent = 0;
      std::ignore = std::frexp(p[axis], &exponent);
      digits = std::max(digits, exponent - last_digit(p[axis]));
      largest = std::max(largest, std::abs(p[axis]));
    }
  }
  constexpr int exact = 20;
  constexpr int single = 24;
  if (digits <= exact) return 0;
  constexpr double times = 16;
  return times * largest * (digits <= single ? 0x1p-24 : 0x1p-53);
}

std::optional<ConvexFaces> convex_faces(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                        std::span<const std::uint32_t> component, double flatness,
                                        const Context& context) {
  return Finder(mesh, table, sites, component, flatness, context).find();
}

}  // namespace blum::voronoi
