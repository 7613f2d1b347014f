#include "voronoi/traced/traced_sites.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/traced/planar_faces.hpp"

namespace blum::voronoi {
namespace {

/// Returns true if a ray along the first axis, from a point of a face's plane, crosses a side.
bool crosses(const DomainSide& side, double px, double py) {
  const double ax = side.from[0] - px, ay = side.from[1] - py;
  const double bx = side.to[0] - px, by = side.to[1] - py;
  return (ay > 0) != (by > 0) && (bx * ay - ax * by) / (ay - by) > 0;
}

double squared_distance(const DomainSide& side, double px, double py) {
  const double ax = side.from[0] - px, ay = side.from[1] - py;
  const double dx = side.to[0] - side.from[0], dy = side.to[1] - side.from[1];
  const double t = std::clamp(-(ax * dx + ay * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  const double qx = ax + t * dx, qy = ay + t * dy;
  return qx * qx + qy * qy;
}

bool is_in_polygon(const TracedSite& face, double px, double py) {
  bool is_inside = false;
  if (!face.index) {
    for (const DomainSide& side : face.sides) is_inside ^= crosses(side, px, py);
    return is_inside;
  }
  const double place = (py - face.index->low) * face.index->per_unit;
  const std::size_t bands = face.index->first.size() - 1;
  if (!(place >= 0 && place <= static_cast<double>(bands))) return false;
  const std::size_t band = std::min(static_cast<std::size_t>(place), bands - 1);
  for (std::uint32_t k = face.index->first[band]; k < face.index->first[band + 1]; ++k) {
    is_inside ^= crosses(face.sides[face.index->sides[k]], px, py);
  }
  return is_inside;
}

/// Returns the index of the sides of a face.
SideIndex index_of(const std::vector<DomainSide>& sides) {
  std::vector<Box3> boxes;
  Box3 all;
  for (const DomainSide& side : sides) {
    Box3& box = boxes.emplace_back();
    box.extend(Vec3d{side.from[0], side.from[1], 0});
    box.extend(Vec3d{side.to[0], side.to[1], 0});
    all.extend(box);
  }
  const std::size_t bands = sides.size();
  SideIndex out{BoxBvh(boxes), all.lower.y, static_cast<double>(bands) / all.size().y, {}, {}};
  // Rounding may move a side's end to a neighbour's band, so sides belong to one more band on either side.
  const auto band_of = [&](double y) {
    return std::min(static_cast<std::size_t>((y - out.low) * out.per_unit), bands - 1);
  };
  std::vector<std::vector<std::uint32_t>> lists(bands);
  for (std::uint32_t k = 0; k < sides.size(); ++k) {
    const std::size_t from = band_of(boxes[k].lower.y), to = band_of(boxes[k].upper.y);
    for (std::size_t band = from > 0 ? from - 1 : 0; band <= std::min(to + 1, bands - 1); ++band) {
      lists[band].push_back(k);
    }
  }
  for (const std::vector<std::uint32_t>& list : lists) {
    out.first.push_back(static_cast<std::uint32_t>(out.sides.size()));
    out.sides.insert(out.sides.end(), list.begin(), list.end());
  }
  out.first.push_back(static_cast<std::uint32_t>(out.sides.size()));
  return out;
}

/// Returns the differences that are treated as 0.
/// @param least  tolerance of distances from joined triangles that stay where they are; otherwise 0.
TracePrecision precision_of(const Box3& box, double least, TracedPlaces places) {
  // Tolerances are relative to the size of the solid. Coordinates far from the origin have larger rounding errors.
  const auto tolerance = [&](double relative, double rounding) {
    return std::max({relative * box.diagonal(), rounding * box.largest_coordinate(), least});
  };
  if (places == TracedPlaces::merged) {
    const double distance = tolerance(1e-10, 0x1p-47);
    return {distance, 16 * distance, 1e-6, 1e-5};
  }
  const double distance = tolerance(1e-13, 0x1p-50);
  return {distance, 16 * distance, 1e-13, 1e-10};
}

}  // namespace

/// Builds the sites. Coordinates are relative to the middle of the box.
class SiteFinder {
 public:
  SiteFinder(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites, double flatness,
             TracedPlaces places)
      : mesh_(mesh), table_(table), sites_(sites), flatness_(flatness), places_(places) {}

  std::optional<TracedSites> find() {
    place();
    if (!add_faces()) return std::nullopt;
    add_edges();
    add_vertices();
    if (!have_numbers_) return std::nullopt;
    std::vector<Box3> boxes;
    for (TracedSite& site : out_.sites_) {
      detail::sort_unique(site.vertices);
      site.is_convex = site.kind == SiteKind::face && is_convex(site);
      // A box tree takes longer than a short list.
      constexpr std::size_t many = 24;
      if (site.kind == SiteKind::face && site.sides.size() > many) site.index = index_of(site.sides);
      boxes.push_back(site.box);
    }
    out_.boxes_.emplace(boxes);
    boxes.assign(out_.vertices_.size(), {});
    for (std::size_t v = 0; v < boxes.size(); ++v) boxes[v].extend(out_.vertices_[v]);
    out_.vertex_boxes_.emplace(boxes);
    return std::move(out_);
  }

 private:
  using Index = TracedSites::Index;
  static constexpr Index none = 0xffffffff;

  void place() {
    const Box3 box = bounds(mesh_);
    out_.extent_ = box.diagonal();
    out_.precision_ = precision_of(box, 0, places_);
    out_.origin_ = box.center();
    for (const Vec3d& p : mesh_.vertices) out_.vertices_.push_back(p - out_.origin_);
  }

  [[nodiscard]] std::array<Vec3d, 3> corners_of(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {out_.vertices_[a], out_.vertices_[b], out_.vertices_[c]};
  }

  /// Moves vertices so that joined faces are flat.
  /// @return false if they stay bent, or triangles turn around.
  bool flatten(const std::vector<std::uint32_t>& face_of) {
    const std::vector<Vec3d> before = out_.vertices_;
    const double left = flatten_faces(mesh_, face_of, out_.vertices_);
    if (!(left <= 0.1 * out_.precision_.distance)) return false;
    return std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(), [&](const Triangle& t) {
      const auto normal = [&](const std::vector<Vec3d>& at) { return cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]]); };
      return dot(normal(before), normal(out_.vertices_)) > 0;
    });
  }

  /// Joins triangles to faces. Moves the vertices so that these are flat, if that is asked for.
  bool add_faces() {
    const std::vector<std::uint32_t> joined = join_flat_triangles(mesh_, out_.vertices_, table_, sites_, flatness_);
    if (places_ == TracedPlaces::separate && !flatten(joined)) return false;
    const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
    out_.face_of_.assign(count, none);
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t root = joined[t];
      if (out_.face_of_[root] == none) {
        out_.face_of_[root] = static_cast<Index>(out_.sites_.size());
        TracedSite& face = out_.sites_.emplace_back();
        face.number = static_cast<std::int32_t>(sites_.face_of[t]);
        face.triangle_or_element = t;
      }
      const Index own = out_.face_of_[t] = out_.face_of_[root];
      TracedSite& face = out_.sites_[own];
      face.number = std::min(face.number, static_cast<std::int32_t>(sites_.face_of[t]));
      const auto [a, b, c] = corners_of(t);
      const Vec3d normal = cross(c - a, b - a);
      for (const std::uint32_t v : mesh_.triangles[t]) {
        face.vertices.push_back(v);
        face.box.extend(out_.vertices_[v]);
      }
      if (squared_length(normal) <= squared_length(face.direction)) continue;
      face.point = a;
      face.direction = normal;
    }
    for (TracedSite& face : out_.sites_) {
      face.direction = unit(face.direction);
      face.axes = axes_across(face.direction);
    }
    if (places_ == TracedPlaces::merged) {
      out_.precision_ = precision_of(bounds(mesh_), std::max(flatness_, 4 * bend()), places_);
    }
    return true;
  }

  /// Returns the largest distance of a corner of a triangle from the plane of its face.
  [[nodiscard]] double bend() const {
    double most = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (const Vec3d& p : corners_of(t)) most = std::max(most, std::abs(out_.distance(out_.face_of_[t], p)));
    }
    return most;
  }

  /// Adds the boundaries of faces and the reflex edges.
  void add_edges() {
    for (std::uint32_t e = 0; e < table_.edge_count(); ++e) {
      const std::array<Index, 2> faces{out_.face_of_[sites_.triangles_of[e][0]],
                                       out_.face_of_[sites_.triangles_of[e][1]]};
      if (faces[0] == faces[1]) continue;
      const auto [a, b] = table_.edges()[e];
      const bool is_reflex = sites_.turn[e] == EdgeTurn::reflex;
      BorderEdge border{{a, b}, faces};
      const Vec3d& p = out_.vertices_[a];
      const Vec3d& q = out_.vertices_[b];
      const Vec3d along = unit(q - p);
      // The first triangle traverses the edge from a to b and has its inside on the left, as seen from outside.
      const std::array<Vec3d, 2> into{unit(cross(along, out_.sites_[faces[0]].direction)),
                                      -unit(cross(along, out_.sites_[faces[1]].direction))};
      for (const std::size_t k : {0U, 1U}) {
        TracedSite& face = out_.sites_[faces[k]];
        const std::array<Vec3d, 2> ends = k == 0 ? std::array{p, q} : std::array{q, p};
        face.sides.push_back({into[k], ends, is_reflex, plane_of(face, ends[0]), plane_of(face, ends[1])});
      }
      if (is_reflex) {
        const auto number = static_cast<std::uint32_t>(out_.edges_.size());
        border.own = static_cast<Index>(out_.sites_.size());
        TracedSite& site = out_.sites_.emplace_back();
        site.kind = SiteKind::edge;
        const auto place = std::lower_bound(sites_.reflex_edges.begin(), sites_.reflex_edges.end(), e);
        site.number = static_cast<std::int32_t>(sites_.face_count) +
                      static_cast<std::int32_t>(place - sites_.reflex_edges.begin());
        site.triangle_or_element = e;
        site.point = p;
        site.direction = along;
        site.length = length(q - p);
        site.sides = {{-into[0], {p, p}}, {-into[1], {p, p}}, {along, {p, p}}, {-along, {q, q}}};
        site.vertices = {a, b};
        site.border = number;
        site.box.extend(p);
        site.box.extend(q);
      }
      out_.edges_.push_back(border);
    }
  }

  /// Returns true if a face is the set of points inside all its sides. Large faces are not tested.
  [[nodiscard]] bool is_convex(const TracedSite& face) const {
    constexpr std::size_t most_sides = 12;
    if (face.sides.size() > most_sides) return false;
    return std::all_of(face.sides.begin(), face.sides.end(), [&](const DomainSide& side) {
      return std::all_of(face.sides.begin(), face.sides.end(),
                         [&](const DomainSide& other) { return side.height(other.ends[0]) >= -1e-14 * out_.extent_; });
    });
  }

  static std::array<double, 2> plane_of(const TracedSite& face, const Vec3d& p) {
    return {dot(face.axes[0], p - face.point), dot(face.axes[1], p - face.point)};
  }

  /// Adds vertices whose dual cone has an interior inside the solid.
  void add_vertices() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> at;
    for (std::uint32_t k = 0; k < out_.edges_.size(); ++k) {
      for (const std::uint32_t v : out_.edges_[k].vertices) at[v].push_back(k);
    }
    for (const auto& [v, list] : at) {
      std::vector<Vec3d> directions;
      for (const std::uint32_t k : list) {
        const auto [a, b] = out_.edges_[k].vertices;
        directions.push_back(unit(out_.vertices_[a == v ? b : a] - out_.vertices_[v]));
      }
      const std::size_t before = out_.sites_.size();
      add_vertex(v, list, directions);
      if (out_.sites_.size() == before && is_reflex(v) && !continues_an_edge(list)) out_.left_out_.push_back(v);
    }
  }

  [[nodiscard]] bool is_reflex(std::uint32_t v) const {
    return std::binary_search(sites_.reflex_vertices.begin(), sites_.reflex_vertices.end(), v);
  }

  /// Returns true if two of some edges lie between the same faces, so that they are on one line.
  [[nodiscard]] bool continues_an_edge(const std::vector<std::uint32_t>& edges) const {
    std::set<std::array<Index, 2>> pairs;
    return std::any_of(edges.begin(), edges.end(), [&](std::uint32_t k) {
      std::array<Index, 2> faces = out_.edges_[k].faces;
      if (faces[0] > faces[1]) std::swap(faces[0], faces[1]);
      return !pairs.insert(faces).second;
    });
  }

  void add_vertex(std::uint32_t v, const std::vector<std::uint32_t>& list, const std::vector<Vec3d>& directions) {
    if (std::none_of(list.begin(), list.end(), [&](std::uint32_t k) { return out_.edges_[k].is_reflex(); })) return;
    constexpr double flat = 1e-7;
    Vec3d middle;
    std::vector<std::size_t> bounding;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      std::size_t rays = 0;
      Vec3d first;
      for (std::size_t j = 0; j < directions.size(); ++j) {
        if (i == j) continue;
        Vec3d ray = cross(directions[i], directions[j]);
        if (length(ray) < flat) continue;
        ray = unit(ray);
        for (const double sign : {1.0, -1.0}) {
          const Vec3d w = ray * sign;
          if (std::any_of(directions.begin(), directions.end(), [&](const Vec3d& d) { return dot(w, d) > flat; })) {
            continue;
          }
          if (rays == 0 || length(w - first) > flat) ++rays;
          if (rays == 1) first = w;
          middle += w;
        }
      }
      if (rays > 1) bounding.push_back(i);
    }
    if (bounding.size() < 3 || length(middle) == 0) return;
    const Vec3d inner = unit(middle);
    if (std::any_of(directions.begin(), directions.end(), [&](const Vec3d& d) { return dot(inner, d) > -flat; }))
      return;
    if (!std::all_of(bounding.begin(), bounding.end(),
                     [&](std::size_t i) { return out_.edges_[list[i]].is_reflex(); })) {
      return;
    }
    const auto place = std::lower_bound(sites_.reflex_vertices.begin(), sites_.reflex_vertices.end(), v);
    if (place == sites_.reflex_vertices.end() || *place != v) {
      have_numbers_ = false;
      return;
    }
    TracedSite& site = out_.sites_.emplace_back();
    site.kind = SiteKind::vertex;
    site.number = static_cast<std::int32_t>(sites_.face_count + sites_.reflex_edges.size()) +
                  static_cast<std::int32_t>(place - sites_.reflex_vertices.begin());
    site.triangle_or_element = v;
    site.point = out_.vertices_[v];
    site.direction = inner;
    for (const std::size_t i : bounding) site.sides.push_back({-directions[i], {site.point, site.point}});
    site.vertices = {v};
    site.box.extend(site.point);
  }

  const MeshView& mesh_;
  const SiteTable& table_;
  const PolyhedronSites& sites_;
  const double flatness_;
  const TracedPlaces places_;
  TracedSites out_;
  bool have_numbers_ = true;  ///< false if a vertex is reflex only since triangles were joined
};

std::optional<TracedSites> TracedSites::of(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                           double flatness, TracedPlaces places) {
  return SiteFinder(mesh, table, sites, flatness, places).find();
}

std::size_t TracedSites::count(SiteKind kind) const {
  const auto is_of_kind = [kind](const TracedSite& site) { return site.kind == kind; };
  return static_cast<std::size_t>(std::count_if(sites_.begin(), sites_.end(), is_of_kind));
}

std::size_t TracedSites::hole_count() const {
  std::size_t holes = 0;
  for (const TracedSite& site : sites_) {
    if (site.kind != SiteKind::face) continue;
    // Sides of one loop are connected. A face that touches itself at a vertex has one loop there.
    detail::UnionFind joined(static_cast<std::uint32_t>(site.sides.size()));
    std::map<std::tuple<double, double, double>, std::uint32_t> first;
    std::size_t loops = site.sides.size();
    for (std::uint32_t k = 0; k < site.sides.size(); ++k) {
      for (const Vec3d& end : site.sides[k].ends) {
        const auto [place, is_new] = first.try_emplace({end.x, end.y, end.z}, k);
        if (is_new || joined.find(place->second) == joined.find(k)) continue;
        joined.join(place->second, k);
        --loops;
      }
    }
    holes += loops - 1;
  }
  return holes;
}

double TracedSites::distance(Index i, const Vec3d& x) const {
  const TracedSite& site = sites_[i];
  const Vec3d step = x - site.point;
  if (site.kind == SiteKind::face) return dot(site.direction, step);
  if (site.kind == SiteKind::edge) return length(cross(site.direction, step));
  return length(step);
}

Vec3d TracedSites::foot(Index i, const Vec3d& x) const {
  const TracedSite& site = sites_[i];
  const Vec3d step = x - site.point;
  if (site.kind == SiteKind::face) return x - site.direction * dot(site.direction, step);
  if (site.kind == SiteKind::edge) return site.point + site.direction * dot(site.direction, step);
  return site.point;
}

Vec3d TracedSites::gradient(Index i, const Vec3d& x) const {
  const TracedSite& site = sites_[i];
  if (site.kind == SiteKind::face) return site.direction;
  return unit(x - foot(i, x));
}

double TracedSites::outside_polygon(const TracedSite& face, const Vec3d& x, double most) const {
  const double px = dot(face.axes[0], x - face.point);
  const double py = dot(face.axes[1], x - face.point);
  if (is_in_polygon(face, px, py)) return 0;
  double least = std::numeric_limits<double>::infinity();  // squared
  if (face.index) {
    // Distances from boxes are rounded.
    constexpr double more = 1 + 1e-9;
    face.index->boxes.for_each_near({px, py, 0}, more * most, [&](Index k) {
      least = std::min(least, squared_distance(face.sides[k], px, py));
      return more * std::min(most, std::sqrt(least));
    });
  } else {
    for (const DomainSide& side : face.sides) least = std::min(least, squared_distance(side, px, py));
  }
  return std::sqrt(least);
}

double TracedSites::outside(Index i, const Vec3d& x, double most) const {
  const TracedSite& site = sites_[i];
  if (site.kind == SiteKind::face) return outside_polygon(site, x, most);
  double furthest = 0;
  for (const DomainSide& side : site.sides) furthest = std::max(furthest, -side.height(x));
  return furthest;
}

TracedSites::OutsideSide TracedSites::outside_side(Index i, const Vec3d& x) const {
  const TracedSite& face = sites_[i];
  const double px = dot(face.axes[0], x - face.point);
  const double py = dot(face.axes[1], x - face.point);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  OutsideSide out;
  double least = infinite, second = infinite;  // squared
  for (const DomainSide& side : face.sides) {
    const double squared = squared_distance(side, px, py);
    if (squared < least) {
      second = least;
      least = squared;
      out.side = &side;
    } else {
      second = std::min(second, squared);
    }
  }
  out.others = std::sqrt(second);
  return out;
}

double TracedSites::least_distance(Index i, const Vec3d& x, double beyond) const {
  const TracedSite& site = sites_[i];
  const auto both = [](double a, double b) { return std::sqrt(a * a + b * b); };
  if (site.kind == SiteKind::face) return both(distance(i, x), beyond);
  if (site.kind == SiteKind::edge) {
    const double t = dot(site.direction, x - site.point);
    return both(distance(i, x), std::max({0.0, -t, t - site.length}));
  }
  return distance(i, x);
}

const DomainSide* TracedSites::side_between(Index first, Index second) const {
  const TracedSite* large = &sites_[first];
  const TracedSite* small = &sites_[second];
  if (large->kind < small->kind) std::swap(large, small);
  const auto has = [](const TracedSite& site, std::uint32_t v) {
    return std::binary_search(site.vertices.begin(), site.vertices.end(), v);
  };
  if (large->kind == SiteKind::face && small->kind == SiteKind::edge) {
    const BorderEdge& edge = edges_[small->border];
    for (const std::size_t k : {0U, 1U}) {
      if (&sites_[edge.faces[k]] == large) return &small->sides[k];
    }
    return nullptr;
  }
  if (large->kind == SiteKind::edge && small->kind == SiteKind::vertex) {
    const std::uint32_t v = small->vertices[0];
    if (!has(*large, v)) return nullptr;
    const auto towards =
        std::max_element(small->sides.begin(), small->sides.end(), [&](const DomainSide& a, const DomainSide& b) {
          return std::abs(dot(a.normal, large->direction)) < std::abs(dot(b.normal, large->direction));
        });
    return &*towards;
  }
  if (large->kind != SiteKind::edge || small->kind != SiteKind::edge) return nullptr;
  constexpr double parallel = 1e-7;
  if (length(cross(large->direction, small->direction)) > parallel) return nullptr;
  for (const std::uint32_t v : small->vertices) {
    if (!has(*large, v)) continue;
    const bool is_start = length(vertices_[v] - small->point) <= 0.5 * small->length;
    return &small->sides[is_start ? 2 : 3];
  }
  return nullptr;
}

std::optional<TracedSites::EdgePlane> TracedSites::plane_between_edges(Index first, Index second) const {
  const TracedSite& a = sites_[first];
  const TracedSite& b = sites_[second];
  if (first == second || a.kind != SiteKind::edge || b.kind != SiteKind::edge) return std::nullopt;
  for (const std::uint32_t v : a.vertices) {
    if (v != b.vertices[0] && v != b.vertices[1]) continue;
    const Vec3d& apex = vertices_[v];
    const auto from_apex = [&](const TracedSite& edge) {
      return edge.point == apex ? edge.direction : -edge.direction;
    };
    const Vec3d normal = from_apex(a) - from_apex(b);
    if (length(normal) > 1e-6) return EdgePlane{unit(normal), apex};
  }
  return std::nullopt;
}

void TracedSites::remove_further_edges(const Vec3d& x, double tolerance, std::vector<Index>& sites) const {
  if (sites.size() < 2) return;
  const auto is_further = [&](Index i) {
    return std::any_of(sites.begin(), sites.end(), [&](Index other) {
      const auto plane = plane_between_edges(other, i);
      return plane && plane->height(x) > tolerance;
    });
  };
  std::vector<Index> kept;
  std::copy_if(sites.begin(), sites.end(), std::back_inserter(kept), [&](Index i) { return !is_further(i); });
  sites = std::move(kept);
}

std::vector<const DomainSide*> TracedSites::sides_at(Index i, const Vec3d& x, double tolerance) const {
  const TracedSite& site = sites_[i];
  std::vector<const DomainSide*> out;
  if (site.kind == SiteKind::face) {
    const Vec3d q = foot(i, x);
    for_each_side(i, x, tolerance, [&](const DomainSide& side) {
      const Vec3d along = side.ends[1] - side.ends[0];
      const double t = std::clamp(dot(q - side.ends[0], along) / squared_length(along), 0.0, 1.0);
      if (length(side.ends[0] + along * t - q) <= tolerance) out.push_back(&side);
    });
    std::sort(out.begin(), out.end());
    return out;
  }
  for (const DomainSide& side : site.sides) {
    if (std::abs(side.height(x)) <= tolerance) out.push_back(&side);
  }
  return out;
}

bool TracedSites::leads_inside(Index i, const std::vector<const DomainSide*>& sides, const Vec3d& h,
                               double tolerance) const {
  const auto is_inside = [&](const DomainSide* side) { return dot(side->normal, h) >= -tolerance; };
  if (sites_[i].kind != SiteKind::face || sides.size() != 2) {
    return std::all_of(sides.begin(), sides.end(), is_inside);
  }
  // At a corner of a face: beyond one of two sides if the corner is concave.
  const Vec3d first = sides[0]->ends[1] - sides[0]->ends[0];
  const Vec3d second = sides[1]->ends[1] - sides[1]->ends[0];
  const bool is_in_order = sides[0]->ends[1] == sides[1]->ends[0];
  const double turn = dot(sites_[i].direction, cross(first, second)) * (is_in_order ? 1 : -1);
  // Seen from inside, the boundary runs clockwise.
  if (turn < 0) return is_inside(sides[0]) && is_inside(sides[1]);
  return is_inside(sides[0]) || is_inside(sides[1]);
}

std::optional<std::uint32_t> TracedSites::vertex_near(const Vec3d& x, double distance) const {
  std::optional<std::uint32_t> best;
  double least = distance * distance;
  vertex_boxes_->for_each_near(x, distance, [&](std::uint32_t v) {
    const double away = squared_length(vertices_[v] - x);
    if (away < least || (away == least && (!best || v < *best))) {
      least = away;
      best = v;
    }
    return std::sqrt(least);
  });
  return best;
}

TracedSites::Closest TracedSites::closest_within(const Vec3d& x, double tolerance, double limit) const {
  Closest out;
  std::vector<std::pair<double, Index>> found;
  boxes_->for_each_near(x, limit, [&](Index i) {
    ++out.examined;
    const double d = distance(i, x);
    if (d >= -tolerance && d <= out.radius + tolerance && outside(i, x, tolerance) <= tolerance) {
      found.emplace_back(d, i);
      out.radius = std::min(out.radius, d);
    }
    return std::min(limit, out.radius + 2 * tolerance);
  });
  for (const auto& [d, i] : found) {
    if (d <= out.radius + tolerance) out.sites.push_back(i);
  }
  std::sort(out.sites.begin(), out.sites.end());
  remove_further_edges(x, tolerance, out.sites);
  return out;
}

TracedSites::Closest TracedSites::closest(const Vec3d& x, double tolerance, double guess) const {
  const double limit = guess + 4 * tolerance;
  Closest near = closest_within(x, tolerance, limit);
  // All closest sites are within the limit if the radius is.
  if (near.radius + 2 * tolerance <= limit || !std::isfinite(limit)) return near;
  Closest out = closest_within(x, tolerance, std::numeric_limits<double>::infinity());
  out.examined += near.examined;
  return out;
}

}  // namespace blum::voronoi
