#include "voronoi/square_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "voronoi/label_geometry.hpp"
#include "voronoi/square_cells.hpp"
#include "voronoi/surface_in_cells.hpp"

namespace blum::voronoi {
namespace {

/// Returns the part of a convex polygon where a linear function `height` is at least -margin. This is mostly the whole
/// polygon, or nothing.
template <class Height>
std::vector<Vec3d> clipped(std::vector<Vec3d> polygon, double margin, const Height& height) {
  const auto is_in = [&](const Vec3d& q) { return height(q) + margin >= 0; };
  if (std::all_of(polygon.begin(), polygon.end(), is_in)) return polygon;
  if (std::none_of(polygon.begin(), polygon.end(), is_in)) return {};
  std::vector<Vec3d> out;
  out.reserve(polygon.size() + 1);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3d& p = polygon[k];
    const Vec3d& q = polygon[(k + 1) % polygon.size()];
    const double at_p = height(p) + margin;
    const double at_q = height(q) + margin;
    if (at_p >= 0) out.push_back(p);
    if ((at_p >= 0) != (at_q >= 0)) out.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return out;
}

/// Returns the part of a polygon where the heights over all given planes are at least -margin.
std::vector<Vec3d> clipped_by(std::vector<Vec3d> polygon, double margin, std::span<const DomainPlane> planes) {
  for (const DomainPlane& plane : planes) {
    polygon = clipped(std::move(polygon), margin, [&](const Vec3d& q) { return plane.height(q); });
    if (polygon.empty()) break;
  }
  return polygon;
}

/// Returns the largest distance of a polygon's corner from its first corner.
double extent(const std::vector<Vec3d>& polygon) {
  double largest = 0;
  for (const Vec3d& p : polygon) largest = std::max(largest, length(p - polygon[0]));
  return largest;
}

/// Returns true if a quadratic function with these Bernstein coefficients is positive on [0, 1].
bool is_positive(double first, double middle, double last) {
  return first > 0 && last > 0 && (middle >= 0 || middle * middle < first * last);
}

}  // namespace

bool PartSquareTest::resolve(GridSquare& square) const {
  if (square.state == SquareState::resolved) return true;
  if (!test_.resolve(square)) return false;
  if (rule_.is_all()) return true;
  square.inner_arcs.clear();
  square.reflex_piercings = 0;
  // The square is resolved, so the surface has no closed curve in it.
  if (const auto chains = surface_chains(tree_, surface_, square)) add_surface(*chains, square);
  const SquareCells cells = square_cells(tree_, labels_, square);
  bool is_decided = true;
  if (rule_.is_medial()) is_decided = add_walls(cells, square);
  is_decided = is_decided && part_square(cells, square, rule_).is_decided;
  if (!is_decided) square.state = SquareState::unknown;
  return is_decided;
}

/// Adds arcs of the surface, between the outside and faces. Adds arcs of walls that start where a reflex edge pierces
/// the square.
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

/// Adds arcs of dropped walls between pieces that touch the same component of walls. Returns false if the existence of
/// such a wall is unknown.
bool PartSquareTest::add_walls(const SquareCells& cells, GridSquare& square) const {
  std::vector<std::array<std::uint32_t, 2>> touching;  // (component, site)
  std::vector<std::array<std::uint32_t, 2>> known;     // pairs of sites
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

/// Answers if the regions of two sites have a common wall in the square.
/// @param low, high  sites: a face and its edge, an edge and its end, or the two edges at a passing vertex.
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
    if (corner->is_thin) return Answer::unknown;  // thin regions have no runs, except at contradictory nodes
    while (facet < corner->edges.size() && corner->edges[facet] != edge) ++facet;
    if (facet == corner->edges.size()) return Answer::no;
  }
  const auto own = std::find_if(square.governors.begin(), square.governors.end(),
                                [&](LabelIndex label) { return labels_[label].site == edge; });
  if (own == square.governors.end()) return Answer::no;
  const std::optional<DomainPlane> plane = plane_between(*own, other, vertex);
  if (!plane) return Answer::unknown;
  // Both sites are equally close in the plane between their domains.
  const std::vector<Vec3d> strip = test_.along_plane(*own, *plane, square);
  if (strip.empty() || test_.is_closest_nowhere(*own, square.governors, strip)) return Answer::no;
  if (is_closest_on(strip, *own, other, square)) return Answer::yes;
  if (vertex && have_wall_at_vertex(place_of(*vertex), corner->rays[facet], square)) return Answer::yes;
  return Answer::unknown;
}

/// Returns the plane between the domain of an edge and that of a face, a vertex, or the other edge at a passing vertex.
std::optional<DomainPlane> PartSquareTest::plane_between(LabelIndex edge, std::uint32_t other,
                                                         const std::optional<std::uint32_t>& vertex) const {
  const auto planes = labels_.planes(edge);
  if (vertex) return planes[labels_.corners(edge)[0] == place_of(*vertex) ? 0 : 1];
  const auto at = std::find_if(planes.begin(), planes.end(), [&](const DomainPlane& plane) {
    return plane.beyond != outside && labels_[plane.beyond].site == other;
  });
  return at == planes.end() ? std::nullopt : std::optional(*at);
}

/// Returns true if one of 16 points along a strip certainly has no closer site than `label` and `beside`.
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

/// Returns true if one of 5 points on a facet of a vertex's dual cone certainly has no closer label than the vertex.
/// This works for narrow facets, too. Labels with this vertex as corner need no test, because none of them is closer on
/// the facet.
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

/// Returns true if no sites except those of `label` and `beside` are closest to a point, or to points within rounding
/// of it.
bool PartSquareTest::is_closest(LabelIndex label, std::uint32_t beside, const Vec3d& q,
                                const GridSquare& square) const {
  const double distance = length(labels_.closest_point(label, q) - q);
  const double least = distance + 64 * labels_.rounding();
  return std::all_of(square.governors.begin(), square.governors.end(), [&](LabelIndex other) {
    const std::uint32_t site = labels_[other].site;
    return site == labels_[label].site || site == beside || length(labels_.closest_point(other, q) - q) > least;
  });
}

bool SquareTest::resolve(GridSquare& square) const {
  if (square.state == SquareState::resolved) return true;
  std::optional<SurfaceChains> chains = surface_chains(tree_, surface_, square);
  if (!chains) return false;
  square.chains = std::move(chains->ends);
  const std::vector<BorderArc> arcs = border(square);
  const bool is_outside = square.chains.empty() && std::all_of(arcs.begin(), arcs.end(), [](const BorderArc& arc) {
                            return arc.label == outside;
                          });
  if (is_outside) {
    square.state = SquareState::resolved;
    return true;
  }
  std::vector<std::uint32_t> sites;
  for (const BorderArc& arc : arcs) {
    if (arc.label != outside) sites.push_back(labels_[arc.label].site);
  }
  std::sort(sites.begin(), sites.end());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
  const Polygon whole = polygon(square);
  std::vector<LabelIndex> present;
  // Labels that are doubtful one by one may be decided together if all have a common vertex.
  const auto is_cone = [&] { return square.chains.empty() && is_over_one_vertex(present, whole); };
  bool is_any_doubtful = false;
  for (const LabelIndex label : square.governors) {
    // Thin regions are treated as parts of walls, so they may exist.
    if (labels_.is_thin(label) || std::binary_search(sites.begin(), sites.end(), labels_[label].site)) {
      present.push_back(label);
      continue;
    }
    if (is_absent(label, square.governors, whole)) continue;
    if (labels_[label].kind == SiteKind::vertex) return false;
    present.push_back(label);
    if (!is_any_doubtful && !is_cone()) return false;
    is_any_doubtful = true;
  }
  // is_cone() takes time linear in the number of labels, is_star_shaped() quadratic time.
  const bool is_known_cone = is_cone();
  if (is_any_doubtful && !is_known_cone) return false;
  const std::vector<std::uint32_t> single = is_known_cone ? sites_of_one_run(square) : std::vector<std::uint32_t>{};
  const bool is_each_connected = std::all_of(sites.begin(), sites.end(), [&](std::uint32_t site) {
    return std::binary_search(single.begin(), single.end(), site) || is_star_shaped(site, arcs, present, whole);
  });
  if (!is_each_connected) return false;
  square.state = SquareState::resolved;
  return true;
}

/// Returns true if all labels that may be closest in a square have a common vertex as corner. The feet of the square on
/// them must be close to it. Then distances in the square are those from a cone about the vertex: from the sectors and
/// rays that contain the labels. Points of a face's or edge's region move straight to their footprints, on its sectors
/// or ray. So if the square does not meet the surface, no region of a face or edge has a component strictly inside the
/// square. The region of the vertex itself may lie strictly inside.
bool SquareTest::is_over_one_vertex(std::span<const LabelIndex> present, const Polygon& whole) const {
  if (present.empty()) return false;
  const std::span<const std::uint32_t> corners = labels_.vertices(present.front());
  return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
    return std::all_of(present.begin(), present.end(), [&](LabelIndex label) {
      return labels_.has_vertex(label, v) && is_near_corner(label, v, whole);
    });
  });
}

/// Returns true if all feet of a square on a label's plane or line lie closer to corner v than the opposite side or
/// end.
bool SquareTest::is_near_corner(LabelIndex label, std::uint32_t v, const Polygon& whole) const {
  const std::span<const Vec3d> corners = labels_.corners(label);
  if (corners.size() == 1) return true;
  const std::span<const std::uint32_t> own = labels_.vertices(label);
  const auto k = static_cast<std::size_t>(std::find(own.begin(), own.end(), v) - own.begin());
  const Vec3d& at = corners[k];
  double reach = length(corners[(k + 1) % corners.size()] - at);
  if (corners.size() == 3) {
    const Vec3d side = corners[(k + 2) % 3] - corners[(k + 1) % 3];
    reach = length(cross(corners[(k + 1) % 3] - at, side)) / length(side);
  }
  const double margin = 64 * labels_.rounding();
  return std::all_of(whole.begin(), whole.end(),
                     [&](const Vec3d& q) { return length(labels_[label].foot(q) - at) + margin < reach * (1 - 1e-9); });
}

/// Returns the sites that have exactly one run on a square's border, in ascending order.
std::vector<std::uint32_t> SquareTest::sites_of_one_run(const GridSquare& square) const {
  std::vector<std::uint32_t> of_runs;
  for (const SquareCells::Run& run : square_cells(tree_, labels_, square).runs) {
    if (run.label != outside) of_runs.push_back(labels_[run.label].site);
  }
  std::sort(of_runs.begin(), of_runs.end());
  std::vector<std::uint32_t> out;
  for (auto first = of_runs.begin(); first != of_runs.end();) {
    const auto last = std::upper_bound(first, of_runs.end(), *first);
    if (last - first == 1) out.push_back(*first);
    first = last;
  }
  return out;
}

/// Returns true if a label is closest nowhere in a square. Also returns true if the label is closest only near a point
/// over one of its corners, where its region cannot be a separate component.
bool SquareTest::is_absent(LabelIndex label, std::span<const LabelIndex> all, const Polygon& whole) const {
  const Polygon part = in_domain(label, whole);
  const bool by_incident = !is_thin(label, whole);
  if (is_absent(label, all, part, {by_incident, std::nullopt}, 0)) return true;
  if (labels_[label].kind == SiteKind::vertex) return false;
  const std::span<const std::uint32_t> corners = labels_.vertices(label);
  return std::any_of(corners.begin(), corners.end(),
                     [&](std::uint32_t v) { return is_absent(label, all, part, {by_incident, v}, 0); });
}

std::vector<SquareTest::BorderArc> SquareTest::border(const GridSquare& square) const {
  std::vector<BorderArc> out;
  for (const CellId id : square.edges) {
    const GridEdge& edge = tree_.edges[id];
    const Vec3d low = tree_.lattice.at(edge.low) - labels_.centre();
    const auto point = [&](double at) {
      Vec3d p = low;
      p[edge.axis] = at - labels_.centre()[edge.axis];
      return p;
    };
    BorderArc arc{edge.first, low, low, 0};
    for (std::uint32_t k = edge.first_event; k < edge.last_event; ++k) {
      const LineEvent& event = tree_.events[k];
      arc.high = point(event.at);
      arc.error = std::max(arc.error, event.error);
      out.push_back(arc);
      const Vec3d upper = point(event.upper());
      arc = {event.after, upper, upper, event.error};
    }
    arc.high = point(tree_.lattice.at(edge.axis, edge.low[edge.axis] + edge.length));
    out.push_back(arc);
  }
  return out;
}

SquareTest::Polygon SquareTest::polygon(const GridSquare& square) const {
  const std::size_t u = next_axis(square.axis);
  const std::size_t v = next_axis(u);
  Polygon out;
  for (const auto& [at_u, at_v] : {std::array{0U, 0U}, {1U, 0U}, {1U, 1U}, {0U, 1U}}) {
    Node node = square.low;
    node[u] += at_u * square.length;
    node[v] += at_v * square.length;
    out.push_back(tree_.lattice.at(node) - labels_.centre());
  }
  return out;
}

/// @param plane  bisector(other, label), if it exists.
bool SquareTest::is_further(LabelIndex label, LabelIndex other, const std::optional<Bisector>& plane,
                            const Polygon& part) const {
  if (plane) {
    return std::all_of(part.begin(), part.end(),
                       [&](const Vec3d& q) { return plane->height(q) > 2 * labels_.rounding(); });
  }
  const PolarDifference difference(labels_, label, other);
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      if (!(difference.at(part[i], part[k]) > 4 * difference.error(part[i], part[k]))) return false;
    }
  }
  return true;
}

/// Returns a part of a polygon that contains all points where `label` may be at least as close as `other`.
SquareTest::Polygon SquareTest::not_further(LabelIndex label, LabelIndex other, const std::optional<Bisector>& plane,
                                            const Polygon& part) const {
  const double margin = 2 * labels_.rounding();
  if (plane) {
    return clipped(part, margin, [&](const Vec3d& q) { return -plane->height(q); });
  }
  const PlacedLabel& near = labels_[other];
  const PlacedLabel& far = labels_[label];
  if (near.kind != SiteKind::face) return part;
  // The distance from an edge or vertex minus that from a plane is convex. If it is positive at a corner, it is also
  // positive where its tangent at the corner is.
  Polygon left = part;
  for (const Vec3d& corner : part) {
    const Vec3d away = corner - far.foot(corner);
    const double distance = length(away);
    if (!(distance - near.height(corner) > 4 * margin)) continue;
    const Vec3d slope = away / distance - near.direction;
    left = clipped(left, margin,
                   [&](const Vec3d& q) { return -(distance - near.height(corner) + dot(slope, q - corner)); });
  }
  return left;
}

bool SquareTest::is_absent(LabelIndex label, std::span<const LabelIndex> all, Polygon part, const Allowance& allowed,
                           int depth) const {
  constexpr int most = 6;
  if (part.empty() || (allowed.vertex && is_at_corner(part, *allowed.vertex, all))) return true;
  if (depth > most) return false;
  Vec3d middle;
  for (const Vec3d& p : part) middle += p;
  middle *= 1.0 / static_cast<double>(part.size());
  // The surface point closest to the middle is searched on all sites except the label's own.
  std::vector<LabelIndex> others;
  for (const LabelIndex other : all) {
    if (labels_[other].site != labels_[label].site) others.push_back(other);
  }
  if (others.empty()) return false;
  // That point may suffice. The squared distance from the label minus that from the point is concave, so the corners
  // decide.
  const Vec3d foot = closest_surface_point(labels_, others, middle);
  const bool is_beyond_foot = std::all_of(part.begin(), part.end(), [&](const Vec3d& q) {
    const double distance = length(q - foot) + labels_.rounding();
    return labels_[label].squared_distance(q) > distance * distance + labels_.rounding_of_squares(distance);
  });
  if (is_beyond_foot) return true;
  // Otherwise another label may exclude this one where the other label is as close as its plane, line or point. Further
  // labels must cover the rest. Labels that have a bisector with this label are tried first.
  struct Candidate {
    bool is_curved = false;
    double squared = 0;
    LabelIndex label = outside;
    [[nodiscard]] bool operator<(const Candidate& other) const {
      return std::tie(is_curved, squared, label) < std::tie(other.is_curved, other.squared, other.label);
    }
  };
  std::vector<Candidate> candidates;
  const double own = labels_[label].squared_distance(middle);
  for (const LabelIndex other : others) {
    const double squared = labels_[other].squared_distance(middle);
    if (!(squared < own) || !is_attained(other, is_behind(other, middle), middle)) continue;
    candidates.push_back({!labels_.bisector(other, label), squared, other});
  }
  std::sort(candidates.begin(), candidates.end());
  constexpr std::size_t tries = 3;
  if (candidates.size() > tries) candidates.resize(tries);
  for (const Candidate& candidate : candidates) {
    const LabelIndex other = candidate.label;
    const bool are_incident = labels_.are_incident(labels_[label].site, other);
    // Points over a face are not in the domains of its edges. The converse need not hold.
    const bool is_part_of_it = labels_[other].kind < labels_[label].kind;
    if (are_incident && (!allowed.by_incident || is_part_of_it)) continue;
    const bool from_behind = is_behind(other, middle);
    const std::vector<DomainPlane> planes = attained_between(other, from_behind);
    const Polygon inside = clipped_by(part, 2 * labels_.rounding(), planes);
    const std::optional<Bisector> plane =
        from_behind ? labels_.bisector_behind(other, label) : labels_.bisector(other, label);
    Polygon left;
    // The domains of incident labels meet only in their borders, so nothing is left inside.
    if (!are_incident && !is_further(label, other, plane, inside)) {
      if (from_behind && !plane) continue;
      left = not_further(label, other, plane, inside);
      if (left == inside) continue;
    }
    return is_absent(label, all, std::move(left), allowed, depth + 1) &&
           is_absent_outside(label, planes, all, std::move(part), allowed, depth);
  }
  return false;
}

/// Returns the planes between which a label is as close as its plane, line or point. For a triangle, its own plane is
/// added. The signed height is the distance in front of the triangle; minus the height is the distance behind it.
std::vector<DomainPlane> SquareTest::attained_between(LabelIndex label, bool from_behind) const {
  const std::span<const DomainPlane> ends = labels_.ends(label);
  std::vector<DomainPlane> out(ends.begin(), ends.end());
  const PlacedLabel& placed = labels_[label];
  if (placed.kind == SiteKind::face) {
    const Vec3d side = from_behind ? -placed.direction : placed.direction;
    out.push_back({side, dot(side, placed.point), outside, outside});
  }
  return out;
}

bool SquareTest::is_attained(LabelIndex label, bool from_behind, const Vec3d& q) const {
  const std::vector<DomainPlane> planes = attained_between(label, from_behind);
  return std::all_of(planes.begin(), planes.end(),
                     [&](const DomainPlane& plane) { return plane.height(q) >= -labels_.rounding(); });
}

/// Returns true if a point lies behind a triangle, on the side away from the solid. The triangle is then not the
/// closest label of a point in the solid. But its distance can still show that another label is not the closest one.
bool SquareTest::is_behind(LabelIndex label, const Vec3d& q) const {
  return labels_[label].kind == SiteKind::face && labels_[label].height(q) < -labels_.rounding();
}

/// Returns true if a label is closest nowhere in the part of a polygon that lies outside at least one of the given
/// planes.
bool SquareTest::is_absent_outside(LabelIndex label, std::span<const DomainPlane> planes,
                                   std::span<const LabelIndex> all, Polygon part, const Allowance& allowed,
                                   int depth) const {
  for (const DomainPlane& plane : planes) {
    // Slivers that exist only by rounding are covered by the part between the planes.
    const auto beyond = [&](const Vec3d& q) { return -plane.height(q); };
    const bool leaves =
        std::any_of(part.begin(), part.end(), [&](const Vec3d& q) { return beyond(q) > 2 * labels_.rounding(); });
    if (!leaves) continue;
    if (!is_absent(label, all, clipped(part, 0, beyond), allowed, depth + 1)) return false;
    part = clipped(part, 0, [&](const Vec3d& q) { return plane.height(q); });
  }
  return true;
}

bool SquareTest::is_star_shaped(std::uint32_t site, std::span<const BorderArc> arcs, std::span<const LabelIndex> others,
                                const Polygon& square) const {
  std::vector<const BorderArc*> own;
  for (const BorderArc& arc : arcs) {
    if (arc.label != outside && labels_[arc.label].site == site) own.push_back(&arc);
  }
  std::sort(own.begin(), own.end(), [](const BorderArc* a, const BorderArc* b) {
    return squared_length(a->high - a->low) > squared_length(b->high - b->low);
  });
  const SiteKind kind = labels_[own[0]->label].kind;
  if (kind == SiteKind::vertex) return true;
  // The domain of an edge is convex, so its part of the square suffices. It may be thinner than rounding.
  const Polygon part = kind == SiteKind::edge ? in_domain(own[0]->label, square) : square;
  if (kind == SiteKind::face) {
    std::erase_if(own, [&](const BorderArc* arc) {
      return length(arc->high - arc->low) <= 4 * arc->error + 4 * labels_.rounding();
    });
  }
  constexpr std::size_t tries = 3;
  if (own.size() > tries) own.resize(tries);
  std::vector<LabelIndex> own_labels;
  std::copy_if(others.begin(), others.end(), std::back_inserter(own_labels),
               [&](LabelIndex label) { return labels_[label].site == site; });
  std::vector<std::optional<Polygon>> domains(others.size());  // domains of `others` in `part`, computed on demand
  const auto is_centre = [&](const BorderArc* arc, const Vec3d& from) {
    for (std::size_t k = 0; k < others.size(); ++k) {
      const LabelIndex other = others[k];
      if (labels_[other].site == site || stays_behind(arc->label, other, from, part)) continue;
      if (!domains[k]) domains[k] = in_domain(other, part);
      if (returns_nowhere(arc->label, other, from, *domains[k])) continue;
      if (!never_meet({arc->label, own_labels, others}, other, from, *domains[k])) return false;
    }
    return true;
  };
  constexpr std::array parts{0.5, 0.05, 0.95};
  return std::any_of(parts.begin(), parts.end(), [&](double part_of_arc) {
    return std::any_of(own.begin(), own.end(), [&](const BorderArc* arc) {
      return is_centre(arc, arc->low + (arc->high - arc->low) * part_of_arc);
    });
  });
}

/// Returns true if no ray from `from` leaves the label's region into that of `other` and comes back at a point of
/// `domain`.
bool SquareTest::returns_nowhere(LabelIndex label, LabelIndex other, const Vec3d& from, const Polygon& domain) const {
  if (domain.empty()) return true;
  if (labels_.are_incident(labels_[label].site, other)) return false;
  const PolarDifference difference(labels_, label, other);
  // If a ray comes back at q, D(q, q) = 0. The slope of D(x, x) along the ray is -2 D(from, q) at q, times a positive
  // number, and it is not positive. So D(from, q) >= 0.
  double error = 0;
  for (const Vec3d& q : domain) error = std::max(error, 4 * difference.error(from, q));
  const Polygon part = clipped(domain, error, [&](const Vec3d& q) { return difference.at(from, q); });
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      if (!(difference.at(part[i], part[k]) > 4 * difference.error(part[i], part[k]))) return false;
    }
  }
  return true;
}

/// Returns true if a label's domain in a polygon may be so thin that rounding lets adjacent domains cover it.
bool SquareTest::is_thin(LabelIndex label, Polygon part) const {
  return clipped_by(std::move(part), -2 * labels_.rounding(), labels_.planes(label)).empty();
}

SquareTest::Polygon SquareTest::in_domain(LabelIndex label, Polygon part) const {
  const double margin = 2 * labels_.rounding();
  part = clipped_by(std::move(part), margin, labels_.planes(label));
  if (labels_[label].kind == SiteKind::face) {
    part = clipped(std::move(part), margin, [&](const Vec3d& q) { return labels_[label].height(q); });
  }
  return part;
}

bool SquareTest::is_closest_nowhere(LabelIndex label, std::span<const LabelIndex> all, const Polygon& part) const {
  return is_absent(label, all, part, {}, 0);
}

SquareTest::Polygon SquareTest::along_plane(LabelIndex label, const DomainPlane& plane,
                                            const GridSquare& square) const {
  const double margin = 2 * labels_.rounding();
  return clipped(in_domain(label, polygon(square)), margin, [&](const Vec3d& q) { return -plane.height(q); });
}

/// Returns true if the region of a site certainly has no common border with the region of another label in a square.
/// Two triangles at a reflex edge have no common border. Otherwise, where the domains meet, a third label must be
/// closer, or the common points must lie over a common corner. Over a corner the diagram is a cone, in which regions
/// are connected.
bool SquareTest::never_meet(const SiteInSquare& own, LabelIndex other, const Vec3d& from,
                            const Polygon& of_other) const {
  return std::all_of(own.labels.begin(), own.labels.end(), [&](LabelIndex label) {
    if (labels_.share_reflex_edge(label, other)) return true;
    const Polygon common = in_domain(label, of_other);
    if (common.empty() || returns_nowhere(own.on_border, other, from, common)) return true;
    const Allowance allowed{false, labels_.common_vertex(label, other)};
    // Where the domains meet, another label may be closer, except over a common corner.
    return is_absent(other, own.all, common, allowed, 0) || is_absent(label, own.all, common, allowed, 0);
  });
}

/// Returns true if a polygon is tiny (a few thousand times rounding), and no label without corner v is closer there
/// than the corner.
bool SquareTest::is_at_corner(const Polygon& part, std::uint32_t v, std::span<const LabelIndex> all) const {
  constexpr double small = 4096;
  if (extent(part) > small * labels_.rounding()) return false;
  const double distance = length(part[0] - labels_.place(v));
  const double nearest = distance * distance + 4 * small * labels_.rounding_of_squares(distance);
  return std::all_of(all.begin(), all.end(), [&](LabelIndex label) {
    return labels_.has_vertex(label, v) || labels_[label].squared_distance(part[0]) > nearest ||
           in_domain(label, part).empty();
  });
}

/// Returns true if no ray from `from` leaves the label's region into that of `other` and comes back in the polygon.
bool SquareTest::stays_behind(LabelIndex label, LabelIndex other, const Vec3d& from, const Polygon& square) const {
  const PlacedLabel& own = labels_[label];
  const PlacedLabel& rival = labels_[other];
  if (labels_.are_incident(own.site, other)) {
    if (own.kind != SiteKind::face || rival.kind != SiteKind::edge) return true;
    const std::span<const DomainPlane> planes = labels_.planes(other);
    return std::all_of(planes.begin(), planes.end(), [&](const DomainPlane& plane) {
      const bool is_wall = plane.beyond != outside && labels_[plane.beyond].site == own.site;
      return !is_wall || plane.height(from) < -labels_.rounding();
    });
  }
  const std::optional<Bisector> plane = labels_.bisector(label, other);
  if (plane && plane->height(from) > 2 * labels_.rounding()) return true;
  // Along a ray, the difference of squared distances is quadratic. Its Bernstein coefficients are its value at the
  // start, its polar form at both ends, and its value at the end. The first is negative. The ray comes back only if the
  // second is positive and the third negative.
  const auto polar = [&](const Vec3d& q, const Vec3d& r) { return own.polar(q, r) - rival.polar(q, r); };
  if (!(polar(from, from) < 0)) return false;
  for (std::size_t k = 0; k < square.size(); ++k) {
    Vec3d begin = square[k];
    Vec3d end = square[(k + 1) % square.size()];
    const double distance = std::sqrt(own.squared_distance(begin)) + length(end - begin);
    const double error = 4 * labels_.rounding_of_squares(distance);
    const double at_begin = polar(from, begin) + error;
    const double at_end = polar(from, end) + error;
    if (at_begin <= 0 && at_end <= 0) continue;
    const Vec3d zero = begin + (end - begin) * (at_begin / (at_begin - at_end));
    if (at_begin <= 0) begin = zero;
    if (at_end <= 0) end = zero;
    if (!is_positive(polar(begin, begin) - error, polar(begin, end) - error, polar(end, end) - error)) return false;
  }
  return true;
}

}  // namespace blum::voronoi
