#include "voronoi/part_square_test.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace blum::voronoi {

bool PartSquareTest::resolve(GridSquare& square) const {
  if (square.state == SquareState::resolved) return true;
  if (!test_.resolve(square)) return false;
  if (rule_.is_all()) return true;
  square.inner_arcs.clear();
  square.reflex_piercings = 0;
  // It was resolved, so there is no closed curve.
  if (const auto chains = surface_chains(tree_, surface_, square)) add_surface(*chains, square);
  const SquareCells cells = square_cells(tree_, labels_, square);
  bool is_told = true;
  if (rule_.is_medial()) is_told = add_walls(cells, square);
  is_told = is_told && part_square(cells, square, rule_).is_told;
  if (!is_told) square.state = SquareState::unknown;
  return is_told;
}

/// The surface lies between the outside and faces; where a reflex edge pierces the square, walls begin.
void PartSquareTest::add_surface(const SurfaceChains& chains, GridSquare& square) const {
  for (const auto& [chain, triangle] : chains.triangles) {
    square.inner_arcs.push_back({labels_[triangle].site, outside, chains.ends[chain][0]});
  }
  if (!rule_.is_medial()) return;
  for (const std::uint32_t edge : chains.edges) {
    const std::optional<std::uint32_t> site = labels_.site_of_edge(edge);
    if (!site) continue;
    ++square.reflex_piercings;
    for (const std::uint32_t t : sites_.triangles_of[edge]) {
      square.inner_arcs.push_back({labels_[t].site, *site, outside});
    }
  }
}

/// Adds walls between pieces that touch one component of walls. False where it is not known whether there is one.
bool PartSquareTest::add_walls(const SquareCells& cells, GridSquare& square) const {
  std::vector<std::array<std::uint32_t, 2>> touching;  // component, site
  std::vector<std::array<std::uint32_t, 2>> known;     // sites
  for (std::size_t k = 0; k < cells.events.size(); ++k) {
    const std::uint32_t before = cells.site_before(k);
    const std::uint32_t behind = cells.site_behind(k);
    known.push_back({std::min(before, behind), std::max(before, behind)});
    for (const std::uint32_t site : {before, behind}) {
      if (site != outside) touching.push_back({cells.component[k], site});
    }
  }
  for (const InnerArc& arc : square.inner_arcs) {
    known.push_back({std::min(arc.first, arc.second), std::max(arc.first, arc.second)});
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  std::sort(known.begin(), known.end());
  std::vector<std::array<std::uint32_t, 2>> asked;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    for (std::size_t k = i + 1; k < touching.size() && touching[k][0] == touching[i][0]; ++k) {
      const std::array<std::uint32_t, 2> pair{touching[i][1], touching[k][1]};
      if (rule_.drops(pair[0], pair[1]) && !std::binary_search(known.begin(), known.end(), pair)) asked.push_back(pair);
    }
  }
  std::sort(asked.begin(), asked.end());
  asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
  for (const auto& [low, high] : asked) {
    const Answer answer = have_wall(low, high, square);
    if (answer == Answer::unknown) return false;
    if (answer == Answer::yes) square.inner_arcs.push_back({low, high, outside});
  }
  return true;
}

/// Whether two pieces have a wall in common.
/// @param low, high  sites: a face and an edge of it, an edge and an end of it, or two edges in one line.
PartSquareTest::Answer PartSquareTest::have_wall(std::uint32_t low, std::uint32_t high,
                                                 const GridSquare& square) const {
  const std::uint32_t edge = rule_.is_edge(low) ? low : high;
  const std::uint32_t other = edge == low ? high : low;
  const ReflexCorner* corner = nullptr;
  std::optional<std::uint32_t> vertex = rule_.passing_vertex(low, high);
  if (rule_.is_vertex(other)) vertex = rule_.vertex_of(other);
  std::size_t facet = 0;
  if (vertex) {
    corner = &rule_.corner(*vertex);
    if (corner->is_thin) return Answer::unknown;  // its region has no runs but next to nodes in it, which contradict
    while (facet < corner->edges.size() && corner->edges[facet] != edge) ++facet;
    if (facet == corner->edges.size()) return Answer::no;
  }
  const auto own = std::find_if(square.governors.begin(), square.governors.end(),
                                [&](LabelIndex label) { return labels_[label].site == edge; });
  if (own == square.governors.end()) return Answer::no;
  const std::optional<DomainPlane> plane = plane_between(*own, other, vertex);
  if (!plane) return Answer::unknown;
  // In the plane between both domains one is as close as the other.
  const std::vector<Vec3d> strip = test_.along_plane(*own, *plane, square);
  if (strip.empty() || test_.is_closest_nowhere(*own, square.governors, strip)) return Answer::no;
  if (is_closest_on(strip, *own, other, square)) return Answer::yes;
  if (vertex && have_wall_at_vertex(place_of(*vertex), corner->rays[facet], square)) return Answer::yes;
  return Answer::unknown;
}

/// The plane that parts the domain of an edge from that of a face or vertex, or of the edge behind a vertex.
std::optional<DomainPlane> PartSquareTest::plane_between(LabelIndex edge, std::uint32_t other,
                                                         const std::optional<std::uint32_t>& vertex) const {
  const auto planes = labels_.planes(edge);
  if (vertex) return planes[labels_.corners(edge)[0] == place_of(*vertex) ? 0 : 1];
  const auto at = std::find_if(planes.begin(), planes.end(), [&](const DomainPlane& plane) {
    return plane.beyond != outside && labels_[plane.beyond].site == other;
  });
  return at == planes.end() ? std::nullopt : std::optional(*at);
}

/// Whether one of some points along a strip is closest to a label and a site beside it.
bool PartSquareTest::is_closest_on(const std::vector<Vec3d>& strip, LabelIndex label, std::uint32_t beside,
                                   const GridSquare& square) const {
  std::size_t far = 0;
  for (std::size_t k = 1; k < strip.size(); ++k) {
    if (squared_length(strip[k] - strip[0]) > squared_length(strip[far] - strip[0])) far = k;
  }
  constexpr int samples = 16;
  for (int k = 0; k < samples; ++k) {
    const Vec3d q = strip[0] + (strip[far] - strip[0]) * ((k + 0.5) / samples);
    if (is_closest(label, beside, q, square)) return true;
  }
  return false;
}

/// Whether a point of a facet of a vertex's cone is closest to the vertex, however narrow the facet is: then no label
/// that has this vertex for a corner is closer to it.
bool PartSquareTest::have_wall_at_vertex(const Vec3d& v, const std::array<Vec3d, 2>& rays,
                                         const GridSquare& square) const {
  const Vec3d low = tree_.lattice.at(square.low) - labels_.centre();
  const Vec3d high = tree_.lattice.at(square.high()) - labels_.centre();
  const double margin = 64 * labels_.rounding();
  constexpr int samples = 5;
  for (int k = 0; k < samples; ++k) {
    const Vec3d way = rays[0] + (rays[1] - rays[0]) * ((k + 0.5) / samples);
    const double reach = (low[square.axis] - v[square.axis]) / way[square.axis];
    if (!(reach > 0)) continue;
    const Vec3d q = v + way * reach;
    bool is_free = true;
    for (const std::size_t axis : {next_axis(square.axis), next_axis(next_axis(square.axis))}) {
      is_free = is_free && q[axis] > low[axis] + margin && q[axis] < high[axis] - margin;
    }
    const double least = length(q - v) + margin;
    is_free = is_free && std::all_of(square.governors.begin(), square.governors.end(), [&](LabelIndex other) {
                return labels_.has_corner(other, v) || length(labels_.closest_point(other, q) - q) > least;
              });
    if (is_free) return true;
  }
  return false;
}

/// Whether nothing but a label and a site beside it is as close to a point, and points as near to it as rounding.
bool PartSquareTest::is_closest(LabelIndex label, std::uint32_t beside, const Vec3d& q,
                                const GridSquare& square) const {
  const double distance = length(labels_.closest_point(label, q) - q);
  const double least = distance + 64 * labels_.rounding();
  return std::all_of(square.governors.begin(), square.governors.end(), [&](LabelIndex other) {
    const std::uint32_t site = labels_[other].site;
    return site == labels_[label].site || site == beside || length(labels_.closest_point(other, q) - q) > least;
  });
}

}  // namespace blum::voronoi
