#include "voronoi/planes/plane_regions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "blum/core/gather.hpp"
#include "blum/core/sort_unique.hpp"
#include "voronoi/planes/plane_tree.hpp"

namespace blum::voronoi {
namespace {

using Index = HalfSpaces::Index;
using Id = std::uint32_t;  // of a vertex or an edge of a region

/// The region of one plane: a convex polyhedron that half-spaces cut, one after the other. Its facets are those
/// half-spaces that bound it in a polygon; others may touch it.
class Region {
 public:
  /// @param cancel  after a request to stop, the region is not complete.
  Region(const HalfSpaces& spaces, const ConvexFaces& faces, const PlaneTree& tree, Index plane,
         const std::stop_token& cancel)
      : spaces_(spaces), tree_(tree), plane_(plane), cancel_(cancel) {
    add_box();
    cut_anywhere(spaces_.floor());
    cut_by_neighbours(faces.neighbours[plane]);
    settle_all();
  }

  /// Returns true if the region has an interior, and the box does not bound it.
  [[nodiscard]] bool is_bounded() const {
    return !is_empty_ && std::none_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
      return edge.is_left && std::max(edge.facets[0], edge.facets[1]) > spaces_.floor();
    });
  }

  /// Adds the vertices of which no plane has a smaller index than the region's.
  void add_corners(std::vector<PlaneCorner>& out) const {
    for (const Vertex& vertex : vertices_) {
      if (!vertex.is_left || (!vertex.planes.empty() && vertex.planes.front() < plane_)) continue;
      out.push_back({vertex.planes, vertex.base});
    }
  }

 private:
  struct Edge {
    std::array<Id, 2> ends{};
    std::array<Index, 2> facets{};
    bool is_left = true;  ///< not cut off
  };
  struct Vertex {
    HalfSpaces::Base base{};
    PlacedCorner placed;
    std::unique_ptr<ExactCorner> exact;  ///< if doubles could not decide
    std::vector<Id> edges;
    std::vector<Index> planes;  ///< if settled: all half-spaces that it touches, ascending
    bool is_settled = false;
    bool is_left = true;  ///< not cut off
    Index cut_by = none;  ///< the last half-space for which `side` was found
    int side = 0;
  };

  static constexpr Index none = UINT32_MAX;

  void add_box() {
    for (Id k = 0; k < 8; ++k) {
      add_vertex({plane_, spaces_.box_side(k & 1U), spaces_.box_side(2 + (k >> 1U & 1U)),
                  spaces_.box_side(4 + (k >> 2U & 1U))});
    }
    for (Id k = 0; k < 8; ++k) {
      for (const Id axis : {0U, 1U, 2U}) {
        const Id other = k | 1U << axis;
        if (other == k) continue;
        const HalfSpaces::Base& base = vertices_[k].base;
        add_edge(k, other, {base[1 + (axis + 1) % 3], base[1 + (axis + 2) % 3]});
      }
    }
  }

  Id add_vertex(const HalfSpaces::Base& base) {
    Vertex& vertex = vertices_.emplace_back();
    vertex.base = base;
    vertex.placed = spaces_.place(base);
    const auto id = static_cast<Id>(vertices_.size() - 1);
    open_.push_back(id);
    ++left_;
    return id;
  }

  void add_edge(Id a, Id b, const std::array<Index, 2>& facets) {
    const auto id = static_cast<Id>(edges_.size());
    edges_.push_back({{a, b}, facets});
    vertices_[a].edges.push_back(id);
    vertices_[b].edges.push_back(id);
  }

  [[nodiscard]] Id other_end(Id edge, Id vertex) const {
    const auto& [a, b] = edges_[edge].ends;
    return a == vertex ? b : a;
  }

  ExactCorner& exact(Vertex& vertex) const {
    if (!vertex.exact) vertex.exact = std::make_unique<ExactCorner>(spaces_.exact_corner(vertex.base));
    return *vertex.exact;
  }

  /// Returns 1, 0 or -1: a vertex is inside a half-space, on its border or outside.
  int side(Id id, Index of) {
    Vertex& vertex = vertices_[id];
    if (vertex.cut_by == of) return vertex.side;
    vertex.cut_by = of;
    if (vertex.is_settled) {
      vertex.side = std::binary_search(vertex.planes.begin(), vertex.planes.end(), of) ? 0 : 1;
      return vertex.side;
    }
    const double depth = spaces_.depth(vertex.placed, of);
    vertex.side = depth > 0 ? 1 : depth < 0 ? -1 : spaces_.position(exact(vertex), of).side;
    return vertex.side;
  }

  /// Cuts the region by a half-space that any vertex may be outside.
  void cut_anywhere(Index by) {
    for (Id k = 0; k < vertices_.size(); ++k) {
      if (vertices_[k].is_left && side(k, by) < 0) return cut(by, k);
    }
  }

  /// Neighbours bound the region. A few of them make it small enough for a search by its vertices.
  void cut_by_neighbours(const std::vector<Index>& neighbours) {
    constexpr std::size_t few = 12;
    const std::size_t step = (neighbours.size() + few - 1) / few;
    for (std::size_t k = 0; k < neighbours.size() && !is_empty_; k += step) cut_anywhere(neighbours[k]);
  }

  /// Cuts the region until its vertices are inside all half-spaces.
  void settle_all() {
    // In degenerate solids, a region may take longer than a caller may wait.
    while (!open_.empty() && !is_empty_ && !cancel_.stop_requested()) {
      const Id id = open_.back();
      if (!vertices_[id].is_left || vertices_[id].is_settled) {
        open_.pop_back();
      } else if (const std::optional<Index> by = settle(id)) {
        cut(*by, id);
      }
    }
  }

  /// Returns a plane that a vertex is outside, or finds all planes that it touches.
  std::optional<Index> settle(Id id) {
    Vertex& vertex = vertices_[id];
    if (!(vertex.placed.error <= spaces_.size_bound())) place_again(vertex);
    tree_.find(vertex.placed, found_);
    constexpr std::size_t many = 16;
    if (!found_.is_outside && found_.planes.size() > many && !(vertex.exact && vertex.exact->is_placed)) {
      place_again(vertex);
      tree_.find(vertex.placed, found_);
    }
    if (found_.is_outside) {
      vertex.cut_by = found_.planes.front();
      vertex.side = -1;
      return vertex.cut_by;
    }
    std::vector<Index> touched(vertex.base.begin(), vertex.base.end());
    for (const Id edge : vertex.edges) {
      touched.insert(touched.end(), edges_[edge].facets.begin(), edges_[edge].facets.end());
    }
    detail::sort_unique(touched);
    const std::size_t known = touched.size();
    std::optional<Index> outside;
    double lowest = 0;
    for (const Index k : found_.planes) {
      if (std::binary_search(touched.begin(), touched.begin() + static_cast<std::ptrdiff_t>(known), k)) continue;
      const HalfSpaces::Position at = spaces_.position(exact(vertex), k);
      if (at.side == 0) touched.push_back(k);
      if (at.side >= 0 || (outside && at.depth >= lowest)) continue;
      outside = k;
      lowest = at.depth;
    }
    if (outside) {
      vertex.cut_by = *outside;
      vertex.side = -1;
      return outside;
    }
    std::sort(touched.begin(), touched.end());
    vertex.planes = std::move(touched);
    vertex.is_settled = true;
    return std::nullopt;
  }

  /// Places a vertex without the errors of elimination.
  void place_again(Vertex& vertex) const {
    spaces_.place(exact(vertex));
    vertex.placed = HalfSpaces::rounded(exact(vertex));
  }

  /// A vertex on a facet, in the plane that cuts the region.
  struct Crossing {
    Index facet = 0;
    Id vertex = 0;
    friend auto operator<=>(const Crossing&, const Crossing&) = default;
  };

  /// Cuts the region by a half-space. The vertices outside of it are connected by edges.
  /// @param start  a vertex outside of it.
  void cut(Index by, Id start) {
    std::vector<Id> outside{start};
    std::vector<Id> border;
    std::vector<std::pair<Id, Id>> crossed;  // edges, and their ends outside
    std::vector<Index> facets;               // with vertices outside
    vertices_[start].is_left = false;
    for (std::size_t k = 0; k < outside.size(); ++k) {
      for (const Id edge : vertices_[outside[k]].edges) {
        facets.insert(facets.end(), edges_[edge].facets.begin(), edges_[edge].facets.end());
        const Id other = other_end(edge, outside[k]);
        if (!vertices_[other].is_left) continue;
        const int where = side(other, by);
        if (where > 0) {
          crossed.emplace_back(edge, outside[k]);
          continue;
        }
        if (where < 0) {
          vertices_[other].is_left = false;
          outside.push_back(other);
        } else {
          border.push_back(other);
        }
      }
    }
    detail::sort_unique(border);
    detail::sort_unique(facets);
    left_ -= outside.size();
    // Without a vertex inside, nothing but a polygon is left.
    if (crossed.empty() && border.size() == left_) {
      is_empty_ = true;
      return;
    }
    for (const Id id : outside) {
      for (const Id edge : vertices_[id].edges) edges_[edge].is_left = false;
    }
    std::vector<Crossing> crossings;
    for (const Id id : border) add_border(id, facets, crossings);
    for (const auto& [edge, end] : crossed) {
      const std::array<Index, 2> sides = edges_[edge].facets;
      const Id made = add_vertex({plane_, sides[0], sides[1], by});
      edges_[edge].is_left = true;
      edges_[edge].ends = {other_end(edge, end), made};
      vertices_[made].edges.push_back(edge);
      for (const Index facet : sides) crossings.push_back({facet, made});
    }
    detail::sort_unique(crossings);
    join_crossings(crossings, by);
  }

  /// Removes the edges of a vertex in the cutting plane that are cut off, and adds its facets with vertices outside.
  void add_border(Id id, const std::vector<Index>& facets, std::vector<Crossing>& crossings) {
    for (const Id edge : vertices_[id].edges) {
      for (const Index facet : edges_[edge].facets) {
        if (std::binary_search(facets.begin(), facets.end(), facet)) crossings.push_back({facet, id});
      }
    }
    std::erase_if(vertices_[id].edges, [&](Id edge) { return !edges_[edge].is_left; });
  }

  /// Makes the edges of the new facet. Each facet with vertices outside has two vertices in the cutting plane, unless
  /// all of it is cut off.
  void join_crossings(const std::vector<Crossing>& crossings, Index by) {
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
      const auto& [facet, a] = crossings[k];
      if (crossings[k + 1].facet != facet) continue;
      const Id b = crossings[k + 1].vertex;
      // An edge of this facet in the cutting plane: the new facet takes its place.
      const auto common = std::find_if(vertices_[a].edges.begin(), vertices_[a].edges.end(), [&](Id edge) {
        const auto& [first, second] = edges_[edge].facets;
        return other_end(edge, a) == b && (first == facet || second == facet);
      });
      if (common == vertices_[a].edges.end()) {
        add_edge(a, b, {facet, by});
      } else {
        std::replace(edges_[*common].facets.begin(), edges_[*common].facets.end(), facet, by);
      }
    }
  }

  const HalfSpaces& spaces_;
  const PlaneTree& tree_;
  Index plane_;
  const std::stop_token& cancel_;
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<Id> open_;  ///< vertices that may be outside a half-space
  std::size_t left_ = 0;  ///< number of vertices that are not cut off
  bool is_empty_ = false;
  PlaneTree::Found found_;
};

}  // namespace

std::vector<PlaneCorner> plane_corners(const HalfSpaces& spaces, const ConvexFaces& faces, bool& is_bounded,
                                       const Context& context) {
  is_bounded = true;
  const PlaneTree tree(spaces, faces.middle);
  // An empty list of planes marks a region that is not bounded.
  std::vector<PlaneCorner> all = detail::gather<PlaneCorner>(
      context, spaces.plane_count(), 1, "regions", [&](std::size_t plane, std::vector<PlaneCorner>& out) {
        const Region region(spaces, faces, tree, static_cast<Index>(plane), context.cancel);
        if (region.is_bounded()) {
          region.add_corners(out);
        } else {
          out.emplace_back();
        }
      });
  throw_if_cancelled(context);
  is_bounded = std::none_of(all.begin(), all.end(), [](const PlaneCorner& corner) { return corner.planes.empty(); });
  if (!is_bounded) return {};
  std::sort(all.begin(), all.end(), [](const PlaneCorner& a, const PlaneCorner& b) { return a.planes < b.planes; });
  return all;
}

}  // namespace blum::voronoi
