#include "blum/geometry/resolve_crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/geometry/weld.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/crossings/sheets.hpp"

namespace blum::detail {
namespace {

/// Mesh of the kept facets: facets with at least a given winding number behind them, and a smaller number in front.
struct Boundary {
  std::vector<Triangle> triangles;  ///< Corners are indices into `points`.
  /// Position of each point, as an edge: its two ends if the point is the middle of an edge that had to be cut. For
  /// other points both ends are equal. Where parts only touch, separate points are at the same position.
  std::vector<std::array<PointId, 2>> points;
  std::vector<std::uint32_t> source_of;  ///< input triangle that contains each triangle
  std::size_t touching_edges = 0;        ///< number of edges along which parts only touch
};

constexpr std::uint32_t nobody = 0xffffffffU;
/// Thousands of times the error in the position of a crossing, for a mesh of size 1. This requires that the ray is not
/// nearly parallel to the triangle.
constexpr double margin = 1e-12;

/// Side of a facet along an edge.
struct Side {
  PointId low = 0, high = 0;
  std::uint32_t corner = 0;  ///< 3 * facet + corner where the side begins
  bool rises = false;        ///< true if the facet traverses the edge from `low` to `high`

  [[nodiscard]] std::uint32_t facet() const { return corner / 3; }
};

std::vector<Side> sorted_sides(const std::vector<Facet>& facets) {
  std::vector<Side> sides;
  sides.reserve(3 * facets.size());
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const PointId a = facets[f].corners[k];
      const PointId b = facets[f].corners[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), 3 * f + k, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.corner < b.corner;
  });
  return sides;
}

/// Calls use(first, count) for each edge. The sides of the edge are sides[first], ..., sides[first + count - 1].
template <class Use>
void for_each_edge(std::span<const Side> sides, const Use& use) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    use(begin, end - begin);
    begin = end;
  }
}

class Windings {
 public:
  Windings(const CrossedMesh& mesh, const CutMesh& cut, int least_winding, const Context& context)
      : mesh_(mesh),
        space_(cut.space),
        facets_(cut.facets),
        sheet_of_(cut.sheet_of),
        least_(least_winding),
        context_(context),
        sides_(sorted_sides(cut.facets)),
        patches_(cut.facets.size()) {}

  Boundary boundary() {
    join_patches();
    spread();
    return kept();
  }

 private:
  void join_patches() {
    for_each_edge(sides_, [&](std::size_t first, std::size_t count) {
      std::int64_t sum = 0;
      for (std::size_t k = first; k < first + count; ++k) {
        sum += (sides_[k].rises ? 1 : -1) * facets_[sides_[k].facet()].times;
      }
      if (sum != 0) throw Unresolved("its parts do not fit together after they were cut");
      if (count == 2) {
        patches_.join(sides_[first].facet(), sides_[first + 1].facet());
      } else {
        sort_around(std::span(sides_).subspan(first, count));
        crowded_.emplace_back(first, count);
      }
    });
  }

  /// Returns the side of the facet `of` on which the far corner of the facet `other` lies. Both must be at the same
  /// edge. The result is 1 if the corner is on the side where the next facets are, counter-clockwise, seen from the
  /// edge's higher end.
  [[nodiscard]] int turns_to(const Side& of, const Side& other) const {
    const Facet& facet = facets_[of.facet()];
    const PointId tip = facets_[other.facet()].corners[(other.corner % 3 + 2) % 3];
    const Cut plane{mesh_.triangles[facet.source], -1};
    const int side = space_.side(plane, tip);
    return of.rises ? side : -side;
  }

  /// Sorts the facets at an edge counter-clockwise around it.
  void sort_around(std::span<Side> sides) const {
    const Side start = sides.front();
    const auto half = [&](const Side& side) {
      if (side.corner == start.corner) return 0;
      const int turn = turns_to(start, side);
      return turn > 0 ? 1 : turn == 0 ? 2 : 3;
    };
    std::vector<std::pair<int, Side>> order;
    for (const Side& side : sides) order.emplace_back(half(side), side);
    std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
      if (a.first != b.first) return a.first < b.first;
      const int turn = a.second.corner == b.second.corner ? 0 : turns_to(a.second, b.second);
      return turn != 0 ? turn > 0 : a.second.corner < b.second.corner;
    });
    for (std::size_t k = 0; k < sides.size(); ++k) sides[k] = order[k].second;
  }

  [[nodiscard]] std::uint32_t patch(const Side& side) { return patches_.find(side.facet()); }

  /// Finds the winding number in front of every patch. In each connected part, a ray determines the number of one
  /// patch. The numbers of the other patches follow from the order of facets around edges.
  void spread() {
    // For each patch: its edges with more than two facets.
    std::vector<std::vector<std::uint32_t>> edges_of(facets_.size());
    UnionFind parts(facets_.size());
    for (std::uint32_t f = 0; f < facets_.size(); ++f) parts.join(patches_.find(f), f);
    for (std::uint32_t e = 0; e < crowded_.size(); ++e) {
      for (std::size_t k = 0; k < crowded_[e].second; ++k) {
        edges_of[patch(sides_[crowded_[e].first + k])].push_back(e);
        parts.join(sides_[crowded_[e].first].facet(), sides_[crowded_[e].first + k].facet());
      }
    }
    std::vector<std::vector<std::uint32_t>> largest(facets_.size());
    for (std::uint32_t f = 0; f < facets_.size(); ++f) keep_largest(largest[parts.find(f)], f);
    front_.assign(facets_.size(), std::nullopt);
    for (std::uint32_t p = 0; p < facets_.size(); ++p) {
      if (largest[p].empty()) continue;
      throw_if_cancelled(context_);
      const auto [facet, winding] = winding_by_ray(largest[p]);
      std::vector<std::uint32_t> next{patches_.find(facet)};
      front_[next.front()] = winding;
      while (!next.empty()) {
        const std::uint32_t own = next.back();
        next.pop_back();
        for (const std::uint32_t e : edges_of[own]) spread_around(e, own, next);
      }
    }
  }

  void spread_around(std::uint32_t edge, std::uint32_t from, std::vector<std::uint32_t>& next) {
    const auto [first, count] = crowded_[edge];
    std::size_t start = 0;
    while (patch(sides_[first + start]) != from) ++start;
    // A rising facet faces the next facet, and its back the previous one. For a falling facet it is the reverse.
    const Side& known = sides_[first + start];
    std::int64_t winding = *front_[from] + (known.rises ? 0 : facets_[known.facet()].times);
    for (std::size_t k = 1; k <= count; ++k) {
      const Side& side = sides_[first + (start + k) % count];
      const std::int32_t times = facets_[side.facet()].times;
      const std::int64_t after = winding + (side.rises ? -times : times);
      const std::int64_t front = side.rises ? after : winding;
      std::optional<std::int64_t>& found = front_[patch(side)];
      if (found && *found != front) throw Unresolved("its winding numbers contradict each other");
      if (!found) next.push_back(patch(side));
      found = front;
      winding = after;
    }
  }

  [[nodiscard]] double area(std::uint32_t f) const {
    const auto& [a, b, c] = facets_[f].corners;
    return length(cross(space_.rounded(b) - space_.rounded(a), space_.rounded(c) - space_.rounded(a)));
  }

  /// Inserts a facet into the list of the few largest facets of a part, the largest first.
  void keep_largest(std::vector<std::uint32_t>& list, std::uint32_t f) const {
    constexpr std::size_t most = 8;
    const double own = area(f);
    const auto at = std::find_if(list.begin(), list.end(), [&](std::uint32_t g) { return area(g) < own; });
    if (at == list.end() && list.size() >= most) return;
    list.insert(at, f);
    if (list.size() > most) list.pop_back();
  }

  /// Returns a facet of a connected part, and the winding number in front of it.
  /// @param candidates  largest facets of the part.
  std::pair<std::uint32_t, std::int64_t> winding_by_ray(const std::vector<std::uint32_t>& candidates) {
    constexpr int attempts = 32;
    for (const std::uint32_t f : candidates) {
      Random random(f);
      for (int k = 0; k < attempts; ++k) {
        if (const auto winding = front_along_ray(f, random)) return {f, *winding};
      }
    }
    throw Unresolved("a part is so small that rounding hides if it lies inside another part");
  }

  /// Returns the winding number in front of a facet, from the crossings of a random ray through it. Returns nullopt if
  /// rounding could change the result.
  std::optional<std::int64_t> front_along_ray(std::uint32_t f, Random& random) {
    if (!bvh_) bvh_.emplace(MeshView{mesh_.vertices, mesh_.triangles}, SiteTable({mesh_.vertices, mesh_.triangles}));
    const auto& [i, j, k] = facets_[f].corners;
    const Vec3d a = space_.rounded(i);
    const Vec3d u = space_.rounded(j) - a;
    const Vec3d v = space_.rounded(k) - a;
    const Vec3d normal = cross(u, v);
    const double twice_area = length(normal);
    const double longest = std::max({length(u), length(v), length(u - v)});
    if (!(twice_area > 100 * margin * longest)) return std::nullopt;
    const Vec3d up = normal / twice_area;
    const Vec3d direction = up + random.in_ball() * 0.3;
    const double s = 0.1 + 0.4 * random.uniform();
    const double t = 0.1 + 0.4 * random.uniform();
    const double back = 0.1 * std::sqrt(twice_area);
    const Vec3d origin = a + u * s + v * t - direction * back;
    std::optional<double> own;
    bool is_certain = true;
    std::vector<RayCrossing> others;
    constexpr double no_limit = std::numeric_limits<double>::infinity();
    bvh_->for_each_crossing({origin, direction}, no_limit, [&](const RayCrossing& crossing) {
      is_certain = is_certain && !crossing.on_border;
      if (sheet_of_[crossing.triangle.value] == facets_[f].sheet) {
        own = crossing.t;
      } else {
        others.push_back(crossing);
      }
      return is_certain ? no_limit : -1;
    });
    if (!own || !is_certain || std::abs(*own - back) > margin) return std::nullopt;
    std::int64_t winding = 0;
    for (const RayCrossing& other : others) {
      std::optional<bool> is_ahead = lies_ahead(f, other);
      if (!is_ahead && std::abs(other.t - *own) > margin) is_ahead = other.t > *own;
      if (!is_ahead) return std::nullopt;
      if (*is_ahead) winding += other.side;
    }
    return winding;
  }

  /// Returns true if a ray through the inside of a facet crosses another triangle beyond the facet. The result is
  /// exact. Returns nullopt if the facet has corners on both sides of the triangle's plane, or all of them in the
  /// plane.
  [[nodiscard]] std::optional<bool> lies_ahead(std::uint32_t f, const RayCrossing& other) {
    const Cut plane{mesh_.triangles[other.triangle.value], -1};
    const auto& corners = facets_[f].corners;
    const bool has_made = !std::all_of(corners.begin(), corners.end(), [&](PointId p) { return space_.is_vertex(p); });
    // The corners of `other` are not exact in this space.
    if (has_made && !is_in_a_pair(other.triangle)) return std::nullopt;
    int side = 0;
    for (const PointId p : corners) {
      const int own = space_.side(plane, p);
      if (own * side < 0) return std::nullopt;
      if (own != 0) side = own;
    }
    if (side == 0) return std::nullopt;
    return side == -other.side;
  }

  [[nodiscard]] bool is_in_a_pair(TriangleId triangle) {
    if (is_in_pair_.empty()) {
      is_in_pair_.assign(mesh_.triangles.size(), false);
      for (const TrianglePair& pair : mesh_.pairs)
        is_in_pair_[pair.first.value] = is_in_pair_[pair.second.value] = true;
    }
    return is_in_pair_[triangle.value];
  }

  [[nodiscard]] bool is_kept(std::uint32_t f) {
    const std::int64_t front = *front_[patches_.find(f)];
    return front < least_ && front + facets_[f].times >= least_;
  }

  /// Two facets at an edge that are neighbours around the solid. The first facet falls (traverses the edge towards its
  /// lower end), the second facet rises.
  using Neighbours = std::array<Side, 2>;

  /// Returns pairs of neighbours among the kept facets at an edge.
  std::vector<Neighbours> neighbours_at(std::span<const Side> sides) {
    std::vector<Side> own;
    for (const Side& side : sides) {
      if (is_kept(side.facet())) own.push_back(side);
    }
    if (own.size() % 2 != 0) throw Unresolved("its boundary is not closed after it was cut");
    std::vector<Neighbours> out;
    // Counter-clockwise around the edge, the solid starts at a falling facet and ends at a rising one.
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (own[k].rises) continue;
      const Side& next = own[(k + 1) % own.size()];
      if (!next.rises) throw Unresolved("its boundary does not face one way after it was cut");
      out.push_back({own[k], next});
    }
    return out;
  }

  Boundary kept() {
    // Corners of kept facets at the same point become one vertex if their facets are neighbours around the solid.
    UnionFind corners(3 * facets_.size());
    std::vector<std::vector<Neighbours>> touching;
    for_each_edge(sides_, [&](std::size_t first, std::size_t count) {
      std::vector<Neighbours> found = neighbours_at(std::span(sides_).subspan(first, count));
      for (const auto& [falling, rising] : found) {
        corners.join(falling.corner, after(rising.corner));
        corners.join(after(falling.corner), rising.corner);
      }
      if (found.size() > 1) touching.push_back(std::move(found));
    });
    for (const std::vector<Neighbours>& edge : touching) {
      for (const auto& [falling, rising] : edge) parts_of_[falling.facet()] = parts_of_[rising.facet()] = {};
    }
    Boundary out;
    out.touching_edges = touching.size();
    std::vector<std::uint32_t> name(3 * facets_.size(), nobody);
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      if (!is_kept(f)) continue;
      Triangle triangle{};
      for (std::uint32_t k = 0; k < 3; ++k) {
        std::uint32_t& of_set = name[corners.find(3 * f + k)];
        if (of_set == nobody) {
          of_set = static_cast<std::uint32_t>(out.points.size());
          out.points.push_back({facets_[f].corners[k], facets_[f].corners[k]});
        }
        name[3 * f + k] = triangle[k] = of_set;
      }
      const auto parts = parts_of_.find(f);
      if (parts != parts_of_.end()) parts->second.push_back(static_cast<std::uint32_t>(out.triangles.size()));
      out.triangles.push_back(triangle);
      out.source_of.push_back(facets_[f].source);
    }
    for (const std::vector<Neighbours>& edge : touching) cut_where_ends_are_shared(edge, name, out);
    return out;
  }

  /// Handles parts that touch along an edge and share the vertices at both of its ends. Each part gets a separate
  /// vertex at the edge's middle.
  void cut_where_ends_are_shared(const std::vector<Neighbours>& edge, const std::vector<std::uint32_t>& name,
                                 Boundary& out) {
    const auto ends = [&](const Neighbours& pair) {
      return std::array{name[pair[1].corner], name[after(pair[1].corner)]};
    };
    for (const Neighbours& pair : edge) {
      const auto is_same = [&](const Neighbours& other) { return ends(other) == ends(pair); };
      if (std::count_if(edge.begin(), edge.end(), is_same) < 2) continue;
      const auto [low, high] = ends(pair);
      const auto middle = static_cast<std::uint32_t>(out.points.size());
      out.points.push_back({pair[0].low, pair[0].high});
      cut_edge(pair[0].facet(), {high, low}, middle, out);
      cut_edge(pair[1].facet(), {low, high}, middle, out);
    }
  }

  /// Cuts the triangle of a facet that has the given edge.
  void cut_edge(std::uint32_t f, const std::array<std::uint32_t, 2>& edge, std::uint32_t middle, Boundary& out) {
    for (const std::uint32_t part : std::vector<std::uint32_t>(parts_of_[f])) {
      for (std::size_t k = 0; k < 3; ++k) {
        Triangle& t = out.triangles[part];
        if (t[k] != edge[0] || t[(k + 1) % 3] != edge[1]) continue;
        Triangle rest = t;
        t[(k + 1) % 3] = middle;
        rest[k] = middle;
        parts_of_[f].push_back(static_cast<std::uint32_t>(out.triangles.size()));
        out.triangles.push_back(rest);
        out.source_of.push_back(facets_[f].source);
        return;
      }
    }
  }

  static std::uint32_t after(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  const CrossedMesh& mesh_;
  const ExactSpace& space_;
  const std::vector<Facet>& facets_;
  const std::vector<std::uint32_t>& sheet_of_;
  std::int64_t least_;
  const Context& context_;
  std::vector<Side> sides_;
  UnionFind patches_;  ///< facets joined across edges with exactly two facets
  /// Edges with more than two facets: index of the first in sides_, and number.
  std::vector<std::pair<std::size_t, std::size_t>> crowded_;
  std::vector<std::optional<std::int64_t>> front_;  ///< winding number in front of each patch
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>
      parts_of_;  ///< for facets at edges along which parts touch: their triangles in the boundary
  std::optional<Bvh> bvh_;
  std::vector<bool> is_in_pair_;  ///< per input triangle; filled when first needed
};

/// Returns the boundary of the region with a winding number of at least `least_winding`.
/// @param least_winding  smallest winding number that counts as inside.
/// @throws Unresolved if facets do not fit together; Cancelled.
Boundary boundary_of_inside(const CrossedMesh& mesh, const CutMesh& cut, int least_winding, const Context& context) {
  return Windings(mesh, cut, least_winding, context).boundary();
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

using detail::Unresolved;

std::string number(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// Returns the context without progress. Each part of the work would report progress from 0 again.
Context quiet(const Context& context) {
  Context out = context;
  out.progress = nullptr;
  return out;
}

/// Mesh scaled to size 1, with one vertex at each position.
struct Welded {
  double scale = 1;
  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;
  /// Per triangle: 0 if it has an area, 1 if its corners are collinear, 2 if it has at most two distinct corners.
  std::vector<std::uint8_t> is_flat;

  explicit Welded(const MeshView& mesh) : scale(coordinate_scale(bounds(mesh))) {
    const std::vector<std::uint32_t> cluster = weld_clusters(mesh.vertices);
    for (const Vec3d& v : mesh.vertices) vertices.push_back(v * scale);
    for (Triangle t : mesh.triangles) {
      for (std::uint32_t& v : t) v = cluster[v];
      triangles.push_back(t);
      const bool is_collapsed = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      const bool is_line = !is_collapsed && detail::has_no_area({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
      is_flat.push_back(is_collapsed ? 2 : is_line ? 1 : 0);
    }
  }
};

/// Returns the number of edges that more than two triangles use.
/// @throws Unresolved if the directions of triangles do not cancel at an edge.
std::size_t crowded_edges(const MeshView& mesh) {
  struct Side {
    std::uint32_t low, high;
    int way;
  };
  std::vector<Side> sides;
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::size_t open = 0;
  std::size_t crowded = 0;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    int sum = 0;
    for (; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high; ++end) {
      sum += sides[end].way;
    }
    open += sum != 0 ? 1 : 0;
    crowded += end - begin > 2 ? 1 : 0;
    begin = end;
  }
  if (open > 0) throw Unresolved("triangles do not meet in opposite directions at " + number(open, "edge"));
  return crowded;
}

/// Returns the genera of the shells of a closed surface, in ascending order.
std::vector<std::int64_t> genera(const Topology& topology) {
  std::vector<std::int64_t> out;
  for (const Shell& shell : topology.shells) out.push_back(shell.genus);
  std::sort(out.begin(), out.end());
  return out;
}

/// Returns the body of each triangle of a closed manifold.
std::vector<std::uint32_t> body_of_triangles(const TriangleMesh& mesh, const Topology& topology) {
  detail::UnionFind joined(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    joined.join(t[0], t[1]);
    joined.join(t[0], t[2]);
  }
  constexpr std::uint32_t nobody = 0xffffffffU;
  std::vector<std::uint32_t> shell(mesh.vertices.size(), nobody);
  std::uint32_t count = 0;
  std::vector<std::uint32_t> body;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& own = shell[joined.find(t[0])];
    if (own == nobody) own = count++;
    const Shell& facts = topology.shells[own];
    body.push_back(facts.depth % 2 == 0 ? own : static_cast<std::uint32_t>(facts.parent));
  }
  return body;
}

/// Returns the number of times that a body touches itself in a vertex: several vertices of one body at the same
/// position.
std::size_t pinches(const TriangleMesh& mesh, const Topology& topology) {
  const std::vector<std::uint32_t> body_of = body_of_triangles(mesh, topology);
  const std::vector<std::uint32_t> cluster = weld_clusters(mesh.vertices);
  std::vector<std::array<std::uint32_t, 3>> corners;  // (position, body, vertex) for each corner
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) corners.push_back({cluster[v], body_of[t], v});
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::size_t count = 0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    count += corners[k][0] == corners[k - 1][0] && corners[k][1] == corners[k - 1][1] ? 1 : 0;
  }
  return count;
}

/// Returns the reason why a mesh is not the boundary of a solid; an empty string if it is the boundary of a solid.
std::string obstacle_of(const TriangleMesh& mesh, const Topology& topology, const Context& context) {
  if (topology.nonmanifold_edges > 0) {
    return "the solid touches itself along " + number(topology.nonmanifold_edges, "edge");
  }
  if (!topology.closed || !topology.oriented || !topology.manifold) return "the result is not closed and manifold";
  if (topology.degenerate_triangles > 0) {
    return number(topology.degenerate_triangles, "triangle") + " lost their area by rounding";
  }
  if (!topology.faces_outwards) return "shells of the result do not face away from the solid";
  const std::vector<std::uint32_t> body_of = body_of_triangles(mesh, topology);
  const SelfIntersections found = find_self_intersections(mesh, 100000, context);
  std::size_t touching = 0;
  for (const TrianglePair& pair : found.pairs) {
    touching += !pair.crosses && body_of[pair.first.value] == body_of[pair.second.value] ? 1 : 0;
  }
  if (found.crossing + touching == 0 && found.complete) return "";
  return number(found.crossing, "pair") + " of triangles cross, and " + number(touching, "pair") +
         " touch, after rounding";
}

/// Returns the mesh after one round of resolution. The result is not yet checked.
ResolvedMesh resolved_once(const MeshView& mesh, const ResolveOptions& options, const Context& context) {
  ResolvedMesh out;
  out.counts.crowded_edges = crowded_edges(mesh);
  const SelfIntersections found = find_self_intersections(mesh, options.most_pairs, context);
  out.counts.crossing = found.crossing;
  out.counts.touching = found.touching;
  const Welded welded(mesh);
  out.counts.flat = static_cast<std::size_t>(
      std::count_if(welded.is_flat.begin(), welded.is_flat.end(), [](std::uint8_t flat) { return flat != 0; }));
  if (!found.complete) {
    out.obstacle = "more than " + number(options.most_pairs, "pair") + " of triangles cross or touch";
    return out;
  }
  const detail::CrossedMesh crossed{welded.vertices, welded.triangles, welded.is_flat, found.pairs};
  const detail::CutMesh cut = detail::cut_triangles(crossed, context);
  const detail::Boundary boundary = detail::boundary_of_inside(crossed, cut, options.least_winding, context);
  if (boundary.triangles.empty()) {
    out.has_inside = false;
    out.obstacle = "no point has a winding number above " + std::to_string(options.least_winding - 1) +
                   (options.least_winding == 1 ? ": the mesh faces inwards" : "");
    return out;
  }
  out.counts.cut = cut.cut;
  out.counts.touching_edges = boundary.touching_edges;
  out.mesh.triangles = boundary.triangles;
  out.triangle_of = boundary.source_of;
  for (const auto& [p, other] : boundary.points) {
    const bool is_old = p == other && cut.space.is_vertex(p);
    const Vec3d middle = (cut.space.rounded(p) + cut.space.rounded(other)) * 0.5;
    out.mesh.vertices.push_back(is_old ? mesh.vertices[p] : middle / welded.scale);
    out.vertex_of.push_back(is_old ? p : ResolvedMesh::no_vertex);
    out.counts.new_vertices += is_old ? 0 : 1;
  }
  return out;
}

/// Rewrites the result of a second round so that it refers to the first round's input.
ResolvedMesh chained(const ResolvedMesh& first, ResolvedMesh second) {
  for (std::uint32_t& v : second.vertex_of) v = v == ResolvedMesh::no_vertex ? v : first.vertex_of[v];
  for (std::uint32_t& t : second.triangle_of) t = first.triangle_of[t];
  const std::size_t touching_edges = second.counts.touching_edges;
  second.counts = first.counts;
  second.counts.touching_edges = touching_edges;
  second.counts.new_vertices =
      static_cast<std::size_t>(std::count(second.vertex_of.begin(), second.vertex_of.end(), ResolvedMesh::no_vertex));
  return second;
}

}  // namespace

ResolvedMesh resolve_crossings(const MeshView& mesh, const ResolveOptions& options, const Context& context) {
  validate(mesh);
  if (mesh.triangles.empty()) throw InvalidMesh("the mesh has no triangles, so it has no interior");
  const Context own = quiet(context);
  ResolvedMesh out;
  try {
    out = resolved_once(mesh, options, own);
    if (!out.is_resolved()) return out;
    Topology facts = topology(out.mesh, own);
    if (options.most_rounds == 0) {
      out.body_of = body_of_triangles(out.mesh, facts);
      return out;
    }
    const std::vector<std::int64_t> exact = genera(facts);
    ResolveOptions rest = options;
    rest.least_winding = 1;  // in the result of the first round, inside has winding number 1
    for (out.counts.rounds = 1;; ++out.counts.rounds) {
      out.obstacle = obstacle_of(out.mesh, facts, own);
      if (out.obstacle.empty() && genera(facts) != exact) out.obstacle = "rounding changed how its parts are connected";
      if (out.obstacle.empty()) {
        out.counts.pinches = pinches(out.mesh, facts);
        out.body_of = body_of_triangles(out.mesh, facts);
      }
      if (out.obstacle.empty() || out.counts.rounds >= static_cast<std::size_t>(options.most_rounds)) return out;
      out = chained(out, resolved_once(out.mesh, rest, own));
      if (!out.is_resolved()) return out;
      facts = topology(out.mesh, own);
    }
  } catch (const Unresolved& error) {
    out.obstacle = error.what();
  }
  return out;
}

}  // namespace blum
