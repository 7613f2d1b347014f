#include "voronoi/part_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "blum/core/union_find.hpp"
#include "blum/geometry/orient3d.hpp"
#include "voronoi/dual_cone.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::voronoi {
namespace {

/// Returns the indices of the constraints whose planes contain facets of a dual cone, in the order around the cone.
/// Constraints that touch the cone only in a ray are left out.
std::vector<std::uint32_t> facets(const Vec3d& v, std::span<const Vec3d> ends) {
  std::vector<std::uint32_t> out = dual_cone(v, ends);
  for (std::size_t k = 0; k < out.size() && out.size() > 3;) {
    const Vec3d& before = ends[out[(k + out.size() - 1) % out.size()]];
    const Vec3d& behind = ends[out[(k + 1) % out.size()]];
    if (detail::orient3d(v, before, ends[out[k]], behind) != 0) {
      ++k;
    } else {
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(k));
      k = 0;
    }
  }
  return out;
}

/// Returns the corner at a passing vertex: two of its edges are reflex, and all others are flat. Then all faces at the
/// vertex lie in two planes, and both reflex edges lie in their common line.
std::optional<ReflexCorner> passing_corner(std::uint32_t v, std::span<const std::uint32_t> edges,
                                           const PolyhedronSites& sites, const LabelGeometry& labels) {
  std::vector<std::uint32_t> bent;
  for (const std::uint32_t edge : edges) {
    if (sites.turn[edge] != EdgeTurn::flat) bent.push_back(edge);
  }
  if (bent.size() != 2 || labels.site_of_vertex(v)) return std::nullopt;
  ReflexCorner out;
  out.is_passing = true;
  const auto [first, second] = sites.triangles_of[bent[0]];
  out.faces = {sites.face_of[first], sites.face_of[second]};
  if (out.faces[0] == out.faces[1]) return std::nullopt;
  for (const std::uint32_t edge : bent) {
    const std::optional<std::uint32_t> site = labels.site_of_edge(edge);
    if (!site) return std::nullopt;
    out.edges.push_back(*site);
    out.rays.push_back({labels[first].direction, labels[second].direction});
  }
  return out;
}

/// The dual cone of a vertex's edges.
struct Cone {
  std::vector<std::uint32_t> edges;  ///< edges whose constraints contain facets, in order around the cone
  std::vector<Vec3d> rays;           ///< unit vectors; ray k lies between facets k and k + 1
};

Cone cone_at(std::uint32_t v, std::span<const std::uint32_t> edges, const MeshView& mesh, const SiteTable& table) {
  const std::vector<Vec3d> ends = far_ends(mesh, table, v, edges);
  Vec3d against;
  for (const Vec3d& end : ends) against -= unit(end - mesh.vertices[v]);
  const std::vector<std::uint32_t> bounds = facets(mesh.vertices[v], ends);
  Cone out;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const Vec3d normal = unit_normal(mesh.vertices[v], ends[bounds[k]], ends[bounds[(k + 1) % bounds.size()]]);
    out.edges.push_back(edges[bounds[k]]);
    out.rays.push_back(dot(normal, against) > 0 ? normal : -normal);
  }
  return out;
}

std::optional<ReflexCorner> thin_corner(const Cone& cone, std::span<const std::uint32_t> edges,
                                        const PolyhedronSites& sites, const LabelGeometry& labels) {
  ReflexCorner out;
  out.is_thin = true;
  out.rays.push_back({cone.rays.front(), cone.rays.front()});
  for (const std::uint32_t edge : edges) {
    if (sites.turn[edge] == EdgeTurn::convex) return std::nullopt;
    if (const std::optional<std::uint32_t> site = labels.site_of_edge(edge)) out.edges.push_back(*site);
  }
  return out;
}

ReflexCorner corner_of(const Cone& cone, const PolyhedronSites& sites, const LabelGeometry& labels) {
  ReflexCorner out;
  const std::size_t count = cone.edges.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t edge = cone.edges[k];
    const std::uint32_t next = cone.edges[(k + 1) % count];
    const std::optional<std::uint32_t> site = labels.site_of_edge(edge);
    if (!site) continue;
    out.edges.push_back(*site);
    out.rays.push_back({cone.rays[(k + count - 1) % count], cone.rays[k]});
    if (!labels.site_of_edge(next)) continue;
    for (const std::uint32_t t : sites.triangles_of[edge]) {
      for (const std::uint32_t u : sites.triangles_of[next]) {
        if (sites.face_of[t] == sites.face_of[u]) out.faces.push_back(sites.face_of[t]);
      }
    }
  }
  return out;
}

using Pair = std::array<std::uint32_t, 2>;

class PartOfSquare {
 public:
  PartOfSquare(const SquareCells& cells, const GridSquare& square, const PartRule& rule)
      : cells_(cells), square_(square), rule_(rule) {}

  PartSquare find() {
    find_thin();
    find_arcs();
    detail::UnionFind classes(static_cast<std::uint32_t>(cells_.pieces.size()));
    for (const auto& [a, b] : out_.arcs) classes.join(a, b);
    const std::size_t joins = join_across_thin(classes);
    if (rule_.is_medial()) find_corners();
    std::size_t class_count = 0;
    for (std::uint32_t k = 0; k < cells_.pieces.size(); ++k) class_count += classes.find(k) == k ? 1U : 0U;
    const std::size_t points = out_.corners.size() + (rule_.is_medial() ? square_.reflex_piercings : 0);
    out_.is_decided = out_.is_decided && out_.arcs.size() + joins + class_count == cells_.pieces.size() + points;
    find_components(classes);
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool is_dropped_thin(std::size_t event) const {
    return rule_.dropped_thin(cells_.thin[event]).has_value();
  }
  [[nodiscard]] bool is_dropped(std::size_t event) const {
    return is_dropped_thin(event) || rule_.drops(cells_.site_before(event), cells_.site_behind(event));
  }

  void find_thin() {
    for (std::size_t k = 0; k < cells_.events.size(); ++k) {
      const std::optional<std::uint32_t> v = rule_.dropped_thin(cells_.thin[k]);
      if (!v) continue;
      const auto at = std::find_if(out_.thin.begin(), out_.thin.end(),
                                   [&](const ThinRegion& region) { return region.vertex == *v; });
      if (at != out_.thin.end()) {
        at->events.push_back(k);
      } else {
        out_.thin.push_back({*v, {k}});
      }
    }
  }

  /// Joins pieces across thin regions. If a thin region reaches the border in several events, all pieces around it are
  /// joined. Dropped walls between faces and edges join them along the region. The region itself joins them across.
  /// Returns the number of arcs to which the thin regions correspond.
  std::size_t join_across_thin(detail::UnionFind& classes) {
    std::size_t joins = 0;
    for (const ThinRegion& region : out_.thin) {
      for (std::size_t k = 0; k < region.events.size(); ++k) {
        const std::uint32_t before = cells_.piece_before(region.events[k]);
        const std::uint32_t behind = cells_.piece_behind(region.events[k]);
        if (k + 1 < region.events.size()) {
          ++joins;
          classes.join(before, behind);
        } else if (classes.find(before) != classes.find(behind)) {
          out_.is_decided = false;
        }
      }
    }
    return joins;
  }

  void add_arc(std::uint32_t a, std::uint32_t b) { out_.arcs.push_back({std::min(a, b), std::max(a, b)}); }

  /// Returns the piece of a site; for the outside, the piece next to the event. Returns `outside` if there is no such
  /// piece.
  [[nodiscard]] std::uint32_t piece_of(std::uint32_t site, std::uint32_t event) const {
    if (site == outside) {
      const auto at = std::find(cells_.events.begin(), cells_.events.end(), event);
      if (at == cells_.events.end()) return outside;
      const auto k = static_cast<std::size_t>(at - cells_.events.begin());
      return cells_.site_before(k) == outside ? cells_.piece_before(k) : cells_.piece_behind(k);
    }
    const auto at = std::find_if(cells_.pieces.begin(), cells_.pieces.end(),
                                 [&](const SquareCells::Piece& piece) { return piece.site == site; });
    return at == cells_.pieces.end() ? outside : static_cast<std::uint32_t>(at - cells_.pieces.begin());
  }

  void find_arcs() {
    for (std::size_t k = 0; k < cells_.events.size(); ++k) {
      if (is_dropped(k) && !is_dropped_thin(k)) add_arc(cells_.piece_before(k), cells_.piece_behind(k));
    }
    for (const InnerArc& arc : square_.inner_arcs) {
      const std::uint32_t first = piece_of(arc.first, arc.event);
      const std::uint32_t second = piece_of(arc.second, arc.event);
      if (first == outside || second == outside) {
        out_.is_decided = false;
      } else {
        add_arc(first, second);
      }
    }
    std::sort(out_.arcs.begin(), out_.arcs.end());
    out_.arcs.erase(std::unique(out_.arcs.begin(), out_.arcs.end()), out_.arcs.end());
  }

  [[nodiscard]] bool are_joined(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(out_.arcs.begin(), out_.arcs.end(), Pair{std::min(a, b), std::max(a, b)});
  }

  /// Finds points in the square around which all walls are dropped. Such a point lies on the normal of a face at a
  /// vertex. At a reflex vertex, the regions around the normal are those of the face, one edge, the vertex and another
  /// edge. At a passing vertex, they are those of the face and both edges.
  void find_corners() {
    for (const auto& [a, b] : out_.arcs) {
      const std::uint32_t low = cells_.pieces[a].site;
      const std::uint32_t high = cells_.pieces[b].site;
      if (const auto v = rule_.passing_vertex(low, high)) {
        for (std::uint32_t f = 0; f < cells_.pieces.size(); ++f) {
          const bool is_beside = rule_.is_face(cells_.pieces[f].site) && are_joined(f, a) && are_joined(f, b);
          if (is_beside) out_.corners.push_back({cells_.pieces[f].site, *v});
        }
      }
    }
    for (std::uint32_t k = 0; k < cells_.pieces.size(); ++k) {
      const std::uint32_t site = cells_.pieces[k].site;
      if (rule_.is_vertex(site)) find_corners_of(k);
      if (!rule_.is_edge(site)) continue;
      for (const auto& [edge, v] : rule_.thin_ends(site)) {
        // Each vertex is examined only once, at its first edge.
        if (rule_.corner(v).edges.front() == site && !reaches_border(v) && is_surrounded(v)) {
          out_.corners.push_back({outside, v});
        }
      }
    }
  }

  [[nodiscard]] bool reaches_border(std::uint32_t v) const {
    return std::any_of(out_.thin.begin(), out_.thin.end(),
                       [&](const ThinRegion& region) { return region.vertex == v; });
  }

  /// Returns true if the pieces of all faces and edges of a vertex exist, and each edge is joined with its two faces.
  [[nodiscard]] bool is_surrounded(std::uint32_t v) const {
    const std::vector<std::uint32_t>& edges = rule_.corner(v).edges;
    return std::all_of(edges.begin(), edges.end(), [&](std::uint32_t edge) {
      const std::uint32_t of_edge = piece_of(edge, outside);
      const std::array<std::uint32_t, 2> faces = rule_.faces_of(edge);
      return of_edge != outside && std::all_of(faces.begin(), faces.end(), [&](std::uint32_t face) {
               const std::uint32_t of_face = piece_of(face, outside);
               return of_face != outside && are_joined(of_edge, of_face);
             });
    });
  }

  void find_corners_of(std::uint32_t v) {
    const auto count = static_cast<std::uint32_t>(cells_.pieces.size());
    for (std::uint32_t f = 0; f < count; ++f) {
      if (!rule_.is_face(cells_.pieces[f].site)) continue;
      std::size_t edges = 0;
      for (std::uint32_t e = 0; e < count; ++e) {
        if (rule_.is_edge(cells_.pieces[e].site) && are_joined(f, e) && are_joined(e, v)) ++edges;
      }
      if (edges == 2) out_.corners.push_back({cells_.pieces[f].site, rule_.vertex_of(cells_.pieces[v].site)});
      if (edges > 2) out_.is_decided = false;
    }
  }

  void find_components(detail::UnionFind& classes) {
    out_.component.assign(cells_.events.size(), outside);
    std::vector<std::uint32_t> kept;
    std::vector<std::uint32_t> class_before;
    for (std::uint32_t k = 0; k < cells_.events.size(); ++k) {
      if (is_dropped(k)) continue;
      kept.push_back(k);
      class_before.push_back(classes.find(cells_.piece_before(k)));
    }
    const EventComponents components = join_events(class_before);
    for (std::size_t k = 0; k < kept.size(); ++k) out_.component[kept[k]] = components.of[k];
    out_.component_count = components.count;
  }

  const SquareCells& cells_;
  const GridSquare& square_;
  const PartRule& rule_;
  PartSquare out_;
};

}  // namespace

std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                         const LabelGeometry& labels) {
  std::vector<ReflexCorner> out(table.vertex_count());
  const IndexRows edges_of = edges_of_vertices(table);
  for (std::uint32_t v = 0; v < out.size(); ++v) {
    if (auto passing = passing_corner(v, edges_of[v], sites, labels)) out[v] = std::move(*passing);
  }
  for (const std::uint32_t v : sites.reflex_vertices) {
    const Cone cone = cone_at(v, edges_of[v], mesh, table);
    if (labels.site_of_vertex(v)) {
      out[v] = corner_of(cone, sites, labels);
    } else if (auto thin = thin_corner(cone, edges_of[v], sites, labels)) {
      out[v] = std::move(*thin);
    }
  }
  return out;
}

bool PartRule::drops(std::uint32_t first, std::uint32_t second) const {
  if (first == second || part_ == VoronoiPart::all) return false;
  if (first == outside) return is_face(second);
  if (second == outside) return is_face(first);
  if (part_ != VoronoiPart::medial_axis) return false;
  // Sites are numbered in the order faces, edges, vertices, so `low` cannot be a vertex if `high` is an edge.
  const std::uint32_t low = std::min(first, second);
  const std::uint32_t high = std::max(first, second);
  const bool is_step = (is_face(low) && is_edge(high)) || (is_edge(low) && is_vertex(high));
  return is_step ? labels_.are_neighbours(low, high) : passing_vertex(low, high).has_value();
}

std::optional<std::uint32_t> PartRule::passing_vertex(std::uint32_t edge, std::uint32_t other) const {
  const PassingPair key{std::min(edge, other), std::max(edge, other), 0};
  const auto at = std::lower_bound(passing_.begin(), passing_.end(), key);
  if (at == passing_.end() || (*at)[0] != key[0] || (*at)[1] != key[1]) return std::nullopt;
  return (*at)[2];
}

std::span<const std::array<std::uint32_t, 2>> PartRule::thin_ends(std::uint32_t edge) const {
  const auto first = std::lower_bound(thin_ends_.begin(), thin_ends_.end(), Pair{edge, 0});
  const auto last = std::lower_bound(first, thin_ends_.end(), Pair{edge + 1, 0});
  return {first, last};
}

std::array<std::uint32_t, 2> PartRule::faces_of(std::uint32_t edge) const {
  const auto [first, second] = sites_.triangles_of[sites_.reflex_edges[edge - first_edge_]];
  return {sites_.face_of[first], sites_.face_of[second]};
}

std::vector<std::array<std::uint32_t, 2>> PartRule::thin_ends_of(std::span<const ReflexCorner> corners) {
  std::vector<Pair> out;
  for (std::uint32_t v = 0; v < corners.size(); ++v) {
    if (!corners[v].is_thin) continue;
    for (const std::uint32_t edge : corners[v].edges) out.push_back({edge, v});
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<PartRule::PassingPair> PartRule::passing_pairs(std::span<const ReflexCorner> corners) {
  std::vector<PassingPair> out;
  for (std::uint32_t v = 0; v < corners.size(); ++v) {
    const std::vector<std::uint32_t>& edges = corners[v].edges;
    if (corners[v].is_passing) out.push_back({std::min(edges[0], edges[1]), std::max(edges[0], edges[1]), v});
  }
  std::sort(out.begin(), out.end());
  return out;
}

PartSquare part_square(const SquareCells& cells, const GridSquare& square, const PartRule& rule) {
  return PartOfSquare(cells, square, rule).find();
}

}  // namespace blum::voronoi
