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
    find_arcs();
    detail::UnionFind classes(static_cast<std::uint32_t>(cells_.pieces.size()));
    for (const auto& [a, b] : out_.arcs) classes.join(a, b);
    if (rule_.is_medial()) find_corners();
    std::size_t class_count = 0;
    for (std::uint32_t k = 0; k < cells_.pieces.size(); ++k) class_count += classes.find(k) == k ? 1U : 0U;
    const std::size_t points = out_.corners.size() + (rule_.is_medial() ? square_.reflex_piercings : 0);
    out_.is_told = out_.is_told && out_.arcs.size() + class_count == cells_.pieces.size() + points;
    find_components(classes);
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::uint32_t piece_before(std::size_t event) const { return cells_.runs[event].piece; }
  [[nodiscard]] std::uint32_t piece_behind(std::size_t event) const {
    return cells_.runs[(event + 1) % cells_.runs.size()].piece;
  }
  [[nodiscard]] bool is_dropped(std::size_t event) const {
    return rule_.drops(cells_.pieces[piece_before(event)].site, cells_.pieces[piece_behind(event)].site);
  }

  void add_arc(std::uint32_t a, std::uint32_t b) { out_.arcs.push_back({std::min(a, b), std::max(a, b)}); }

  /// The piece of a site; of the outside, that next to an event. `outside` where there is none.
  [[nodiscard]] std::uint32_t piece_of(std::uint32_t site, std::uint32_t event) const {
    if (site == outside) {
      const auto at = std::find(cells_.events.begin(), cells_.events.end(), event);
      if (at == cells_.events.end()) return outside;
      const auto k = static_cast<std::size_t>(at - cells_.events.begin());
      return cells_.pieces[piece_before(k)].site == outside ? piece_before(k) : piece_behind(k);
    }
    const auto at = std::find_if(cells_.pieces.begin(), cells_.pieces.end(),
                                 [&](const SquareCells::Piece& piece) { return piece.site == site; });
    return at == cells_.pieces.end() ? outside : static_cast<std::uint32_t>(at - cells_.pieces.begin());
  }

  void find_arcs() {
    for (std::size_t k = 0; k < cells_.events.size(); ++k) {
      if (is_dropped(k)) add_arc(piece_before(k), piece_behind(k));
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

  /// Around the normal of a face at a vertex lie the face, one of its edges, the vertex, and the other edge.
  void find_corners() {
    const auto count = static_cast<std::uint32_t>(cells_.pieces.size());
    for (std::uint32_t v = 0; v < count; ++v) {
      if (!rule_.is_vertex(cells_.pieces[v].site)) continue;
      for (std::uint32_t f = 0; f < count; ++f) {
        if (!rule_.is_face(cells_.pieces[f].site)) continue;
        std::size_t edges = 0;
        for (std::uint32_t e = 0; e < count; ++e) {
          if (rule_.is_edge(cells_.pieces[e].site) && are_joined(f, e) && are_joined(e, v)) ++edges;
        }
        if (edges == 2) out_.corners.push_back({cells_.pieces[f].site, cells_.pieces[v].site});
        if (edges > 2) out_.is_told = false;
      }
    }
  }

  void find_components(detail::UnionFind& classes) {
    out_.component.assign(cells_.events.size(), outside);
    std::vector<std::uint32_t> kept;
    std::vector<std::uint32_t> class_before;
    for (std::uint32_t k = 0; k < cells_.events.size(); ++k) {
      if (is_dropped(k)) continue;
      kept.push_back(k);
      class_before.push_back(classes.find(piece_before(k)));
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
  return is_step && labels_.are_neighbours(low, high);
}

PartSquare part_square(const SquareCells& cells, const GridSquare& square, const PartRule& rule) {
  return PartOfSquare(cells, square, rule).find();
}

}  // namespace blum::voronoi
