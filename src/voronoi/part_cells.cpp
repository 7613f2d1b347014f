#include "voronoi/part_cells.hpp"

#include <algorithm>

#include "blum/core/union_find.hpp"

namespace blum::voronoi {
namespace {

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
    out_.is_told = out_.is_told && out_.arcs.size() + joins + class_count == cells_.pieces.size() + points;
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

  /// Between two places on the border pieces around a thin region are joined by walls between faces and edges, and
  /// across it all are. Returns how many arcs it stands for.
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
          out_.is_told = false;
        }
      }
    }
    return joins;
  }

  void add_arc(std::uint32_t a, std::uint32_t b) { out_.arcs.push_back({std::min(a, b), std::max(a, b)}); }

  /// The piece of a site; of the outside, that next to an event. `outside` where there is none.
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
        out_.is_told = false;
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

  /// Around the normal of a face at a reflex vertex lie the face, one of its edges, the vertex, and the other edge; at
  /// a vertex in which edges in one line meet, the face and both edges.
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
        // It is looked at from the first of its edges.
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

  /// Whether pieces of all faces and edges of a vertex are joined around it.
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
      if (edges > 2) out_.is_told = false;
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

bool PartRule::drops(std::uint32_t first, std::uint32_t second) const {
  if (first == second || part_ == VoronoiPart::all) return false;
  if (first == outside) return is_face(second);
  if (second == outside) return is_face(first);
  if (part_ != VoronoiPart::medial_axis) return false;
  // Sites are numbered as faces, edges, vertices.
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
