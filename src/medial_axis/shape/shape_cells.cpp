#include "medial_axis/shape/shape_cells.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/parallel.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/shape/witnesses.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum::detail {
namespace {

/// Numbers of searches that may still be made while polygons are filled.
struct FillBudget {
  int detours = 60;  ///< searches for a path that replaces an edge
  int fans = 8;      ///< searches for a point from which segments to all corners stay in the solid
};

/// Fills polygons of a few corners with triangles whose edges stay in a solid. A *place* is the index of a vertex.
class PolygonFiller {
 public:
  using Places = std::vector<std::uint32_t>;

  /// @param stop_of  returns the stop of a place.
  /// @param add      adds a vertex and returns its place; an empty function if no vertices may be added.
  /// @param budget   numbers of allowed searches, which are counted down. It must outlive this object.
  PolygonFiller(const SolidPaths& paths, std::function<Stop(std::uint32_t)> stop_of,
                std::function<std::uint32_t(const Stop&)> add, FillBudget& budget)
      : paths_(paths), stop_of_(std::move(stop_of)), add_(std::move(add)), budget_(budget) {}

  /// Fills a polygon by cutting off ears: triangles of three consecutive corners. Ears that the surface does not cross
  /// are preferred to those whose edges just stay in the solid. Among equally good ears, the one with the shortest new
  /// edge comes first. If there are none, it cuts off an ear along a path of new vertices.
  /// @param sides  groups of places that other polygons also have. No new edge joins two places of a group, because
  /// another polygon that has both may also join them.
  /// @return  true if all edges stay in the solid. The triangles are added in any case.
  bool fill(Places polygon, const std::vector<Places>& sides);

  /// Returns true if the surface crosses none of the triangles. The result `false` may also mean that this is
  /// undecided.
  [[nodiscard]] bool is_all_open() const { return is_all_open_; }

  /// Returns the triangles of all polygons, three places for each triangle.
  [[nodiscard]] const Places& triangles() const { return triangles_; }

 private:
  struct Ear;
  struct Detour;
  [[nodiscard]] std::vector<Ear> ears_of(const Places& polygon, const std::vector<Places>& sides) const;
  [[nodiscard]] bool is_joined(const Ear& ear) const;
  [[nodiscard]] bool is_open(const Ear& ear) const;
  bool fan_out(const Places& polygon, std::size_t least_open);
  [[nodiscard]] std::optional<Detour> detour(const Places& polygon, std::span<const Ear> ears);

  const SolidPaths& paths_;
  std::function<Stop(std::uint32_t)> stop_of_;
  std::function<std::uint32_t(const Stop&)> add_;
  Places triangles_;
  FillBudget& budget_;
  bool is_all_open_ = true;
};

bool has(const PolygonFiller::Places& places, std::uint32_t place) {
  return std::find(places.begin(), places.end(), place) != places.end();
}

/// Corner of a polygon and its two neighbours.
struct PolygonFiller::Ear {
  double squared_length = 0;  ///< squared length of the edge between the neighbours
  std::size_t corner = 0;     ///< index in the polygon
  std::uint32_t before = 0, place = 0, after = 0;
};

/// A corner, and new places on a path between its two neighbours.
struct PolygonFiller::Detour {
  Ear over;
  Places places;
};

std::vector<PolygonFiller::Ear> PolygonFiller::ears_of(const Places& polygon, const std::vector<Places>& sides) const {
  const std::size_t size = polygon.size();
  std::vector<Ear> ears;
  for (std::size_t k = 0; k < size; ++k) {
    Ear ear{0, k, polygon[k == 0 ? size - 1 : k - 1], polygon[k], polygon[k + 1 == size ? 0 : k + 1]};
    const auto has_both = [&](const Places& side) { return has(side, ear.before) && has(side, ear.after); };
    if (std::any_of(sides.begin(), sides.end(), has_both)) continue;
    ear.squared_length = squared_length(stop_of_(ear.after).at - stop_of_(ear.before).at);
    ears.push_back(ear);
  }
  std::sort(ears.begin(), ears.end(), [](const Ear& a, const Ear& b) {
    return a.squared_length != b.squared_length ? a.squared_length < b.squared_length : a.corner < b.corner;
  });
  return ears;
}

bool PolygonFiller::is_joined(const Ear& ear) const {
  return paths_.is_straight(stop_of_(ear.before), stop_of_(ear.after));
}

bool PolygonFiller::is_open(const Ear& ear) const {
  return is_joined(ear) && paths_.is_open(stop_of_(ear.before), stop_of_(ear.place), stop_of_(ear.after));
}

/// Returns a corner to cut off, and new places on a path between its neighbours. The shortest ears are tried first.
/// Paths over a corner of the polygon, or through the ball around one, are left out, because almost the same polygon
/// would remain.
std::optional<PolygonFiller::Detour> PolygonFiller::detour(const Places& polygon, std::span<const Ear> ears) {
  for (const Ear& ear : ears) {
    if (!add_ || budget_.detours-- <= 0) return std::nullopt;
    const auto path = paths_.path(stop_of_(ear.before), stop_of_(ear.after), {});
    const auto is_corner = [&](const Stop& stop) {
      return std::any_of(polygon.begin(), polygon.end(), [&](std::uint32_t place) {
        return length(stop_of_(place).at - stop.at) < stop.nearest.distance;
      });
    };
    if (!path || path->empty() || std::any_of(path->begin(), path->end(), is_corner)) continue;
    Detour found{ear, {}};
    for (const Stop& stop : *path) found.places.push_back(add_(stop));
    return found;
  }
  return std::nullopt;
}

/// Adds triangles around a new vertex from which segments to all corners of a polygon stay in the solid. Triangles that
/// the surface crosses are filled in the same way. @return  true if a point for the vertex was found.
/// @param least_open  least number of triangles that the surface does not cross.
bool PolygonFiller::fan_out(const Places& polygon, std::size_t least_open) {
  if (!add_ || budget_.fans-- <= 0) return false;
  std::vector<Stop> corners;
  for (const std::uint32_t place : polygon) corners.push_back(stop_of_(place));
  const std::optional<Hub> middle = paths_.seeing_all(corners, least_open);
  if (!middle) return false;
  const std::uint32_t hub = add_(middle->stop);
  for (std::size_t k = 0; k < polygon.size(); ++k) fill({hub, polygon[k], polygon[(k + 1) % polygon.size()]}, {});
  return true;
}

bool PolygonFiller::fill(Places polygon, const std::vector<Places>& sides) {
  bool stays = true;
  while (polygon.size() > 3) {
    const std::vector<Ear> ears = ears_of(polygon, sides);
    auto ear = std::find_if(ears.begin(), ears.end(), [&](const Ear& e) { return is_open(e); });
    if (ear == ears.end() && fan_out(polygon, polygon.size() - 1)) return stays;
    if (ear == ears.end()) is_all_open_ = false;
    if (ear == ears.end()) ear = std::find_if(ears.begin(), ears.end(), [&](const Ear& e) { return is_joined(e); });
    if (ear == ears.end() && !ears.empty()) {
      if (const auto found = detour(polygon, ears)) {
        const auto& [over, path] = *found;
        Places cut_off{over.before, over.place, over.after};
        cut_off.insert(cut_off.end(), path.rbegin(), path.rend());
        // The path is a border of both the part cut off and the rest of the polygon.
        std::vector<Places> sides_there = sides;
        Places& shared = sides_there.emplace_back(path);
        shared.push_back(over.before);
        shared.push_back(over.after);
        stays = fill(std::move(cut_off), sides_there) && stays;
        const auto at = polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(over.corner));
        polygon.insert(at, path.begin(), path.end());
        continue;
      }
      if (fan_out(polygon, 0)) return stays;
      ear = ears.begin();
      stays = false;
    }
    if (ear == ears.end()) {  // no two corners may be joined: add a vertex in the middle
      if (!add_) return false;
      Vec3d sum;
      for (const std::uint32_t place : polygon) sum += stop_of_(place).at;
      const std::uint32_t middle =
          add_(paths_.inside_near(sum / static_cast<double>(polygon.size()), stop_of_(polygon[0])));
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        triangles_.insert(triangles_.end(), {middle, polygon[k], polygon[(k + 1) % polygon.size()]});
      }
      return false;
    }
    triangles_.insert(triangles_.end(), {ear->before, ear->place, ear->after});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear->corner));
  }
  if (!paths_.is_open(stop_of_(polygon[0]), stop_of_(polygon[1]), stop_of_(polygon[2]))) {
    if (fan_out(polygon, 2)) return stays;
    is_all_open_ = false;
  }
  triangles_.insert(triangles_.end(), polygon.begin(), polygon.end());
  return stays;
}

/// Vertices of a piece that are extra cells or adjacent to extra cells. Near these, the solid may have holes narrower
/// than a voxel, and a vertex may lie on the far side of such a hole.
class NearExtra {
 public:
  NearExtra(const AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const Context& context);

  /// @param place  a vertex place (see AxisCorners). Places after these belong to vertices of shapes, and count as
  /// near.
  [[nodiscard]] bool is_near(std::uint32_t place) const { return place >= is_near_.size() || is_near_[place] != 0; }
  /// Returns a known point of the component that a near vertex represents, if there is one.
  [[nodiscard]] const std::optional<Stop>& home(std::uint32_t place) const { return homes_[place]; }
  /// Returns true if an edge has the same two ends as an earlier edge. Files identify edges by their ends, so one of
  /// the two must be split.
  [[nodiscard]] bool has_twin(std::uint32_t edge) const;

 private:
  void find_twins(const AxisPiece& piece, const AxisCorners& corners);

  std::vector<std::uint32_t> twins_;   ///< edges with the same ends as an earlier one, ascending
  std::vector<std::uint8_t> is_near_;  ///< for each vertex place
  std::vector<std::optional<Stop>> homes_;
};

bool is_special(const CellStructure& structure, Cell cell) {
  return structure.is_extra(cell) || structure.extra()->is_mixed(cell);
}

NearExtra::NearExtra(const AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses,
                     const Context& context)
    : is_near_(corners.vertex_cells().size(), 0), homes_(corners.vertex_cells().size()) {
  constexpr std::size_t vertices_per_range = 512;
  const CellStructure& structure = piece.structure;
  if (structure.extra() == nullptr) return;
  find_twins(piece, corners);
  const auto cells = corners.vertex_cells();
  parallel_for(context, cells.size(), vertices_per_range, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      bool is_near = is_special(structure, cells[v]);
      structure.for_each_coface(cells[v], [&](Cell edge) { is_near = is_near || is_special(structure, edge); });
      is_near_[v] = is_near ? 1 : 0;
      if (is_near) homes_[v] = witnesses.home_of(cells[v]);
    }
  });
}

bool NearExtra::has_twin(std::uint32_t edge) const {
  return std::binary_search(twins_.begin(), twins_.end(), edge);
}

void NearExtra::find_twins(const AxisPiece& piece, const AxisCorners& corners) {
  std::vector<std::array<std::uint32_t, 3>> edges;
  for (std::uint32_t c = 0; c < piece.cells.size(); ++c) {
    if (piece.cells[c].dimension != 1) continue;
    const auto ends = corners.of_cells()[c];
    const auto cells = corners.vertex_cells();
    if (!is_special(piece.structure, cells[ends[0]]) || !is_special(piece.structure, cells[ends[1]])) continue;
    edges.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), c});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1]) twins_.push_back(edges[e][2]);
  }
  std::sort(twins_.begin(), twins_.end());
}

constexpr std::size_t cells_per_range = 512;

/// Shape of a cell with more vertices or other triangles than its corners alone determine. Items are places of
/// vertices. Item `Shaper::first_own` + k is vertex k of `own`.
struct Shape {
  std::vector<std::uint32_t> items;
  std::vector<AxisVertex> own;
  bool leaves = false;      ///< true if a part of the shape leaves the solid
  bool needs_more = false;  ///< true if full effort may find a better shape
};

AxisVertex vertex_at(const Stop& stop) {
  return vertex_of_one_wall(stop.at, stop.nearest);
}

class Shaper {
 public:
  static constexpr std::uint32_t first_own = 0xf0000000U;

  /// @param needs_more  null for full effort, else little effort; see SolidPaths.
  Shaper(const AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const NearExtra& near,
         bool* needs_more)
      : piece_(piece),
        corners_(corners),
        governors_(witnesses.governors()),
        witnesses_(witnesses),
        near_(near),
        needs_more_(needs_more),
        paths_(governors_.surface(), needs_more) {}

  /// Returns the chain of segments of an edge that would leave the solid or that has a twin. Returns nullopt if one
  /// segment suffices.
  [[nodiscard]] std::optional<Shape> bent(std::uint32_t c) {
    const auto ends = corners_.of_cells()[c];
    const Stop a = stop_at(ends[0]);
    const Stop b = stop_at(ends[1]);
    const bool has_twin = near_.has_twin(c);
    std::optional<std::vector<Stop>> between;
    if (near_.is_near(ends[0]) || near_.is_near(ends[1])) {
      prepare(ends, piece_.vertices);
      between = through_component(c, has_twin);
    }
    if (between && between->empty() && !has_twin) return std::nullopt;
    if (!between && !has_twin) {
      if (paths_.is_straight(a, b) && !has_given_up()) return std::nullopt;
      between = paths_.pushed(a, b);
    }
    if (!between) between = through_middle(c, a, b);
    if (has_twin && (!between || between->empty())) between = {middle_of(a, b)};
    Shape shape;
    shape.leaves = !between || has_given_up();
    if (!between) between.emplace();
    shape.items.push_back(ends[0]);
    add_own(shape, *between);
    shape.items.push_back(ends[1]);
    return shape;
  }

  /// Returns the triangles of a polygon. Returns nullopt if the triangles of its corners alone suffice; see
  /// triangles_of().
  /// @param outline  its border, in cyclic order.
  [[nodiscard]] std::optional<Shape> filled(std::uint32_t c, const std::vector<std::uint32_t>& outline,
                                            std::span<const AxisVertex> vertices) {
    if (touches_extra(c)) {
      prepare(outline, vertices);
      return fan(c, outline, vertices);
    }
    const auto stop = [&](std::uint32_t v) { return stop_of(vertices[v]); };
    const bool is_near_extra =
        std::any_of(outline.begin(), outline.end(), [&](std::uint32_t v) { return near_.is_near(v); });
    if (outline.size() == 4) {
      const auto halves = triangles_of(outline, vertices);
      const auto& [p, q, r] = halves[0];
      const auto is_open = [&](const auto& t) { return paths_.is_open(stop(t[0]), stop(t[1]), stop(t[2])); };
      if (paths_.is_straight(stop(p), stop(r)) && (!is_near_extra || (is_open(halves[0]) && is_open(halves[1])))) {
        return std::nullopt;
      }
    }
    // If an edge is bent, this is not tried: the polygon on the other side might cut off the same corners of the edge.
    if (outline.size() == corners_.of_cells()[c].size()) {
      FillBudget budget;
      PolygonFiller filler(paths_, stop, {}, budget);
      if (filler.fill(outline, {}) && (filler.is_all_open() || !is_near_extra)) return Shape{filler.triangles(), {}};
    }
    return fan(c, outline, vertices);
  }

 private:
  /// Returns true if full effort might have found a path.
  [[nodiscard]] bool has_given_up() const { return needs_more_ != nullptr && *needs_more_; }

  /// Prepares for queries about the components of vertices and the space between them.
  void prepare(std::span<const std::uint32_t> places, std::span<const AxisVertex> vertices) {
    Box3 box;
    for (const std::uint32_t place : places) {
      box.extend(vertices[place].position);
      const auto cells = corners_.vertex_cells();
      if (place < cells.size()) box.extend(box_of_vertex(governors_, piece_.structure, cells[place]));
    }
    paths_.prepare(box);
  }

  /// Returns true if a polygon is an extra cell or has a corner that is one. Other polygons may then have the same
  /// corners.
  [[nodiscard]] bool touches_extra(std::uint32_t c) const {
    if (piece_.structure.is_extra(piece_.cells[c].cell)) return true;
    const auto corners = corners_.of_cells()[c];
    return std::any_of(corners.begin(), corners.end(),
                       [&](std::uint32_t v) { return piece_.structure.is_extra(corners_.vertex_cells()[v]); });
  }

  [[nodiscard]] Stop middle_of(const Stop& a, const Stop& b) const {
    return paths_.inside_near(0.5 * (a.at + b.at), a);
  }

  [[nodiscard]] Stop stop_at(std::uint32_t place) const { return stop_of(piece_.vertices[place]); }

  static void append(const std::vector<std::uint32_t>& triangles, std::vector<std::uint32_t>& items) {
    items.insert(items.end(), triangles.begin(), triangles.end());
  }

  static void add_own(Shape& shape, std::span<const Stop> stops) {
    for (const Stop& stop : stops) {
      shape.items.push_back(first_own + static_cast<std::uint32_t>(shape.own.size()));
      shape.own.push_back(vertex_at(stop));
    }
  }

  /// Returns a path between the two ends of an edge that passes through a point of the component that the edge
  /// represents.
  [[nodiscard]] std::optional<std::vector<Stop>> through_middle(std::uint32_t c, const Stop& a, const Stop& b) const {
    const std::optional<Stop> middle = home_of(piece_.cells[c].cell);
    if (!middle) return std::nullopt;
    const auto ends = corners_.of_cells()[c];
    std::optional<std::vector<Stop>> path = paths_.path(a, *middle, landmarks(ends[0]));
    const std::optional<std::vector<Stop>> rest = paths_.path(*middle, b, landmarks(ends[1]));
    if (!path || !rest) return std::nullopt;
    path->push_back(*middle);
    path->insert(path->end(), rest->begin(), rest->end());
    return path;
  }
  /// Returns the stops between the ends of an edge; no stops if the edge can be straight. Within the solid, this path
  /// can be deformed to the path through the components of both ends and of the edge. Returns nullopt if no path was
  /// found.
  /// @param stops_there  true if the stop in the component of the edge must stay.
  [[nodiscard]] std::optional<std::vector<Stop>> through_component(std::uint32_t c, bool stops_there) const {
    const std::optional<Stop> middle = home_of(piece_.cells[c].cell);
    if (!middle) return std::nullopt;
    const auto ends = corners_.of_cells()[c];
    auto path = from_component(*middle, ends[0]);
    const auto rest = from_component(*middle, ends[1]);
    if (!path || !rest) return std::nullopt;
    std::reverse(path->begin(), path->end());
    const std::size_t at_middle = path->size() - 1;
    path->insert(path->end(), rest->begin() + 1, rest->end());
    if (!stops_there || at_middle == 0 || at_middle + 1 == path->size())
      path = paths_.pulled_over_open(std::move(*path));
    if (path->size() < 2) return std::vector<Stop>{};
    return std::vector<Stop>(path->begin() + 1, path->end() - 1);
  }

  /// Returns a path from a point of the component of an edge or polygon to one of its vertices, both included. The path
  /// passes through a point of the vertex's component. Stops that can be left out are then removed.
  [[nodiscard]] std::optional<std::vector<Stop>> from_component(const Stop& start, std::uint32_t vertex) const {
    const Stop end = stop_at(vertex);
    std::vector<Stop> way{start};
    if (const std::optional<Stop>& home = near_.is_near(vertex) ? near_.home(vertex) : std::nullopt) {
      if (!add_way(way, *home, vertex)) return std::nullopt;
    }
    if (!add_way(way, end, vertex)) return std::nullopt;
    return paths_.pulled_over_open(std::move(way));
  }

  /// Extends a path to the stop `to`, which is added. @return  true if a path was found.
  [[nodiscard]] bool add_way(std::vector<Stop>& way, const Stop& to, std::uint32_t vertex) const {
    if (way.back().at == to.at) return true;
    if (!paths_.is_straight(way.back(), to)) {
      const Box3 box = box_of_vertex(governors_, piece_.structure, corners_.vertex_cells()[vertex]);
      const bool is_in_box = holds(box, way.back().at) && holds(box, to.at);
      const SolidPaths there = is_in_box ? paths_.in(box) : paths_;
      const std::optional<std::vector<Stop>> between = there.path(way.back(), to, landmarks(vertex));
      if (!between) return false;
      way.insert(way.end(), between->begin(), between->end());
    }
    way.push_back(to);
    return true;
  }

  [[nodiscard]] std::vector<Stop> landmarks(std::uint32_t vertex) const {
    return witnesses_.landmarks_of(corners_.vertex_cells()[vertex]);
  }

  /// Returns a known point of the component that a cell represents.
  [[nodiscard]] std::optional<Stop> home_of(Cell cell) const { return witnesses_.home_of(cell); }

  /// Returns triangles around a vertex in the middle of a polygon. The best of several candidates becomes that vertex.
  [[nodiscard]] Shape fan(std::uint32_t c, const std::vector<std::uint32_t>& outline,
                          std::span<const AxisVertex> vertices) const {
    std::vector<Stop> corners;
    Vec3d sum;
    bool leaves = false;
    for (const std::uint32_t v : outline) {
      corners.push_back(stop_of(vertices[v]));
      sum += corners.back().at;
    }
    std::vector<Stop> middles;
    if (const auto home = home_of(piece_.cells[c].cell)) {
      if (const auto chains = chains_from(*home, c, outline, corners))
        return wheel(c, outline, corners, *home, *chains);
      leaves = has_given_up();
      middles.push_back(*home);
    }
    const Vec3d mean = sum / static_cast<double>(outline.size());
    if (const auto at = paths_.stop_at(mean, {corners[0].nearest.point, corners[0].nearest.element, 7})) {
      middles.push_back(*at);
    }
    std::size_t best = 0;
    std::size_t most = 0;
    const auto is_good = [&] { return most == corners.size(); };
    const auto look_from = [&](std::size_t m) {
      const auto straight = static_cast<std::size_t>(std::count_if(
          corners.begin(), corners.end(), [&](const Stop& corner) { return paths_.is_straight(middles[m], corner); }));
      if (straight > most) {
        most = straight;
        best = m;
      }
    };
    for (std::size_t m = 0; m < middles.size() && !is_good(); ++m) look_from(m);
    if (!is_good()) {
      const std::size_t first = middles.size();
      const std::vector<Stop> others = around(c);
      middles.insert(middles.end(), others.begin(), others.end());
      constexpr std::size_t most_tries = 8;
      for (std::size_t m = first; m < std::min(middles.size(), first + most_tries) && !is_good(); ++m) look_from(m);
    }
    if (middles.empty()) middles.push_back(paths_.inside_near(mean, corners[0]));
    const Chains chains = any_chains(c, middles[best], corners, leaves);
    Shape shape = wheel(c, outline, corners, middles[best], chains);
    shape.leaves = shape.leaves || leaves;
    return shape;
  }

  /// Stops between a middle and items of an outline: pairs of an index in the outline and the stops.
  using Chains = std::vector<std::pair<std::size_t, std::vector<Stop>>>;

  /// Returns chains from a point of the component of a polygon to its corners, and to other vertices of its outline if
  /// possible. They pass through the components of the corners. Returns nullopt if a chain to a corner was not found.
  /// @param stops  the stops at the vertices of the outline.
  [[nodiscard]] std::optional<Chains> chains_from(const Stop& home, std::uint32_t c,
                                                  const std::vector<std::uint32_t>& outline,
                                                  std::span<const Stop> stops) const {
    const auto corners = corners_.of_cells()[c];
    const auto is_corner = [&](std::uint32_t place) {
      return std::find(corners.begin(), corners.end(), place) != corners.end();
    };
    const std::size_t size = outline.size();
    Chains chains;
    for (std::size_t k = 0; k < size; ++k) {
      std::optional<std::vector<Stop>> way;
      if (is_corner(outline[k])) {
        way = from_component(home, outline[k]);
        if (!way) return std::nullopt;
      } else {
        std::size_t before = k;
        std::size_t after = k;
        while (!is_corner(outline[before])) before = before == 0 ? size - 1 : before - 1;
        while (!is_corner(outline[after])) after = after + 1 == size ? 0 : after + 1;
        for (const std::size_t end : {before, after}) {
          if (!way) way = within_component(home, stops[k], outline[end]);
        }
        if (!way) continue;
      }
      const auto last = way->size() > 1 ? way->end() - 1 : way->end();
      chains.emplace_back(k, std::vector<Stop>(way->begin() + 1, last));
    }
    return chains;
  }

  /// Returns a path between two points of the component of a vertex, inside the box of that component.
  [[nodiscard]] std::optional<std::vector<Stop>> within_component(const Stop& from, const Stop& to,
                                                                  std::uint32_t vertex) const {
    const Box3 box = box_of_vertex(governors_, piece_.structure, corners_.vertex_cells()[vertex]);
    if (!holds(box, from.at) || !holds(box, to.at)) return std::nullopt;
    std::vector<Stop> way{from};
    if (!add_way(way, to, vertex)) return std::nullopt;
    return paths_.pulled_over_open(std::move(way));
  }

  /// Returns chains from a middle to those vertices of an outline that it can be joined to. The space between the
  /// chains is not tested.
  /// @param leaves  set to true if a chain leaves the solid.
  [[nodiscard]] Chains any_chains(std::uint32_t c, const Stop& middle, std::span<const Stop> corners,
                                  bool& leaves) const {
    Chains chains;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (auto between = paths_.pushed(middle, corners[k])) chains.emplace_back(k, std::move(*between));
    }
    if (chains.size() < 2) {
      const std::vector<Stop> landmarks = around(c);
      chains.clear();
      for (std::size_t k = 0; k < corners.size(); ++k) {
        auto between = paths_.path(middle, corners[k], landmarks);
        leaves = leaves || !between;
        chains.emplace_back(k, between ? std::move(*between) : std::vector<Stop>{});
      }
    }
    return chains;
  }

  /// Returns triangles around a middle. They fill the sectors between the chains from the middle to the outline.
  [[nodiscard]] Shape wheel(std::uint32_t c, const std::vector<std::uint32_t>& outline, std::span<const Stop> corners,
                            const Stop& middle, const Chains& chains) const {
    Shape shape;
    shape.own.push_back(vertex_at(middle));
    std::vector<std::vector<std::uint32_t>> spokes;
    for (const auto& [corner, between] : chains) {
      std::vector<std::uint32_t>& spoke = spokes.emplace_back(1, first_own);
      for (const Stop& stop : between) {
        spoke.push_back(first_own + static_cast<std::uint32_t>(shape.own.size()));
        shape.own.push_back(vertex_at(stop));
      }
    }
    const auto stop = [&](std::uint32_t v) {
      if (v >= first_own) return stop_of(shape.own[v - first_own]);
      return corners[static_cast<std::size_t>(std::find(outline.begin(), outline.end(), v) - outline.begin())];
    };
    const auto add = [&](const Stop& at) {
      shape.own.push_back(vertex_at(at));
      return first_own + static_cast<std::uint32_t>(shape.own.size() - 1);
    };
    FillBudget budget;
    FillBudget second_budget{24, 4};
    // A sector lies between two spokes and the part of the outline from one to the next. Other sectors and polygons
    // have the same sides.
    for (std::size_t n = 0; n < spokes.size(); ++n) {
      const std::size_t next = (n + 1) % spokes.size();
      std::vector<std::uint32_t> border;
      for (std::size_t k = chains[n].first;; k = (k + 1) % outline.size()) {
        border.push_back(outline[k]);
        if (k == chains[next].first) break;
      }
      std::vector<std::uint32_t> sector = spokes[n];
      sector.insert(sector.end(), border.begin(), border.end());
      sector.insert(sector.end(), spokes[next].rbegin(), spokes[next].rend() - 1);
      std::vector<std::vector<std::uint32_t>> sides{spokes[n], spokes[next], border};
      sides[0].push_back(border.front());
      sides[1].push_back(border.back());
      // Outside this box, triangles may be on the other side of a void. Such triangles are the second choice.
      const SolidPaths there = paths_.in(box_around(c, outline, chains[n].first, chains[next].first));
      const std::size_t own = shape.own.size();
      PolygonFiller filler(there, stop, add, budget);
      const bool stays = filler.fill(sector, sides);
      if (stays && filler.is_all_open()) {
        append(filler.triangles(), shape.items);
        continue;
      }
      const std::vector<AxisVertex> first(shape.own.begin() + static_cast<std::ptrdiff_t>(own), shape.own.end());
      shape.own.resize(own);
      PolygonFiller anywhere(paths_, stop, add, second_budget);
      if (anywhere.fill(sector, sides) && (anywhere.is_all_open() || !stays)) {
        append(anywhere.triangles(), shape.items);
        continue;
      }
      shape.own.resize(own);
      shape.own.insert(shape.own.end(), first.begin(), first.end());
      append(filler.triangles(), shape.items);
      shape.leaves = shape.leaves || !stays;
    }
    return shape;
  }

  /// Returns a box around the boxes of the corners in a part of a polygon's outline. If the part begins or ends inside
  /// a bent edge, both ends of that edge are included.
  [[nodiscard]] Box3 box_around(std::uint32_t c, const std::vector<std::uint32_t>& outline, std::size_t first,
                                std::size_t last) const {
    const auto corners = corners_.of_cells()[c];
    const auto is_corner = [&](std::size_t k) {
      return std::find(corners.begin(), corners.end(), outline[k]) != corners.end();
    };
    const std::size_t size = outline.size();
    while (!is_corner(first)) first = first == 0 ? size - 1 : first - 1;
    while (!is_corner(last)) last = (last + 1) % size;
    Box3 box;
    for (std::size_t k = first;; k = (k + 1) % size) {
      if (is_corner(k)) {
        box.extend(box_of_vertex(governors_, piece_.structure, corners_.vertex_cells()[outline[k]]));
        box.extend(piece_.vertices[outline[k]].position);
      }
      if (k == last) return box;
    }
  }

  /// Returns the landmarks (known points of the components) of all corners of a polygon.
  [[nodiscard]] std::vector<Stop> around(std::uint32_t c) const {
    std::vector<Stop> all;
    for (const std::uint32_t corner : corners_.of_cells()[c]) {
      const std::vector<Stop> own = landmarks(corner);
      all.insert(all.end(), own.begin(), own.end());
    }
    return all;
  }

  const AxisPiece& piece_;
  const AxisCorners& corners_;
  const GovernorField& governors_;
  const Witnesses& witnesses_;
  const NearExtra& near_;
  bool* needs_more_;
  SolidPaths paths_;
};

/// Shapes of those cells that their corners alone do not determine, as pairs of a cell's index and its shape.
using Shapes = std::vector<std::pair<std::uint32_t, Shape>>;

/// Makes the shapes of all cells of one dimension.
/// @param make  makes the shape of an edge or polygon. If the second argument is null, it makes full effort, otherwise
/// little effort.
class ShapeMaker {
 public:
  using Make = std::function<std::optional<Shape>(std::uint32_t, bool*)>;

  ShapeMaker(const AxisPiece& piece, const Context& context) : piece_(piece), context_(context) {}

  /// Returns the shapes, ascending by cell. If little effort is not enough, full effort follows. It does not if more
  /// than 16 shapes leave the solid, because the model will then be refined.
  [[nodiscard]] Shapes of(int dimension, const Make& make) const {
    constexpr std::ptrdiff_t most_leaving = 16;
    Shapes shapes = quick(dimension, make);
    const auto leaves = [](const auto& entry) { return entry.second.leaves; };
    std::vector<std::size_t> poor;
    if (std::count_if(shapes.begin(), shapes.end(), leaves) <= most_leaving) {
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        if (shapes[k].second.needs_more) poor.push_back(k);
      }
    }
    parallel_for(context_, poor.size(), 1, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        auto& [cell, shape] = shapes[poor[k]];
        shape = make(cell, nullptr).value_or(Shape{});
      }
    });
    std::erase_if(shapes, [](const auto& entry) { return entry.second.items.empty(); });
    return shapes;
  }

 private:
  [[nodiscard]] Shapes quick(int dimension, const Make& make) const {
    std::vector<Shapes> found(piece_.cells.size() / cells_per_range + 1);
    const char* phase = dimension == 1 ? "edges" : "triangles";
    parallel_for(context_, piece_.cells.size(), cells_per_range, phase, [&](const WorkRange& range) {
      for (std::size_t c = range.begin; c < range.end; ++c) {
        if (piece_.cells[c].dimension != dimension) continue;
        bool needs_more = false;
        std::optional<Shape> shape = make(static_cast<std::uint32_t>(c), &needs_more);
        if (!shape && needs_more) shape.emplace();
        if (!shape) continue;
        shape->needs_more = needs_more;
        found[range.begin / cells_per_range].emplace_back(static_cast<std::uint32_t>(c), std::move(*shape));
      }
    });
    Shapes all;
    for (Shapes& part : found) {
      for (auto& entry : part) all.push_back(std::move(entry));
    }
    return all;
  }

  const AxisPiece& piece_;
  const Context& context_;
};

/// Adds the own vertices of shapes to the vertices of the piece.
void take_vertices(AxisPiece& piece, Shapes& shapes) {
  for (auto& [cell, shape] : shapes) {
    const auto first = static_cast<std::uint32_t>(piece.vertices.size());
    for (std::uint32_t& item : shape.items) {
      if (item >= Shaper::first_own) item = first + (item - Shaper::first_own);
    }
    piece.vertices.insert(piece.vertices.end(), shape.own.begin(), shape.own.end());
  }
}

/// Outlines of polygons: the chain of each bent edge, and the ends of each straight edge.
class Outlines {
 public:
  Outlines(const AxisCorners& corners, const Shapes& bent) : corners_(corners), bent_(bent) {}

  [[nodiscard]] const Shape* bent(std::uint32_t edge) const {
    const auto at = std::lower_bound(bent_.begin(), bent_.end(), edge,
                                     [](const auto& entry, std::uint32_t value) { return entry.first < value; });
    return at != bent_.end() && at->first == edge ? &at->second : nullptr;
  }
  /// Returns the border of a polygon, in cyclic order.
  [[nodiscard]] std::vector<std::uint32_t> of(std::uint32_t polygon) const {
    const auto corners = corners_.of_cells()[polygon];
    std::vector<std::uint32_t> outline;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Shape* shape = bent(corners_.sides()[polygon][k]);
      if (shape == nullptr) {
        outline.push_back(corners[k]);
      } else if (shape->items.front() == corners[k]) {
        outline.insert(outline.end(), shape->items.begin(), shape->items.end() - 1);
      } else {
        outline.insert(outline.end(), shape->items.rbegin(), shape->items.rend() - 1);
      }
    }
    return outline;
  }

 private:
  const AxisCorners& corners_;
  const Shapes& bent_;
};

/// Returns the box of each vertex of the cells whose shapes leave the solid, each once. The boxes are slightly shrunk,
/// so that they do not overlap adjacent boxes.
std::vector<Box3> boxes_where_left(const AxisPiece& piece, const AxisCorners& corners, const GovernorField& governors,
                                   const std::array<const Shapes*, 2>& shapes) {
  constexpr double less = 0.05;
  std::vector<std::uint32_t> vertices;
  for (const Shapes* some : shapes) {
    for (const auto& [cell, shape] : *some) {
      if (!shape.leaves) continue;
      const auto own = corners.of_cells()[cell];
      vertices.insert(vertices.end(), own.begin(), own.end());
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Box3> boxes;
  for (const std::uint32_t v : vertices) {
    const Box3 box = box_of_vertex(governors, piece.structure, corners.vertex_cells()[v]);
    boxes.push_back({box.lower + box.size() * less, box.upper - box.size() * less});
  }
  return boxes;
}

}  // namespace

void shape_cells(AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const Context& context) {
  const GovernorField& governors = witnesses.governors();
  Shapes bent;
  Shapes filled;
  const Outlines outlines(corners, bent);
  if (governors.solid().extra != nullptr) {
    const NearExtra near(piece, corners, witnesses, context);
    const ShapeMaker maker(piece, context);
    const auto shaper = [&](bool* needs_more) { return Shaper(piece, corners, witnesses, near, needs_more); };
    bent = maker.of(1, [&](std::uint32_t c, bool* needs_more) { return shaper(needs_more).bent(c); });
    take_vertices(piece, bent);
    filled = maker.of(2, [&](std::uint32_t c, bool* needs_more) {
      return shaper(needs_more).filled(c, outlines.of(c), piece.vertices);
    });
    take_vertices(piece, filled);
  }
  piece.leaving = boxes_where_left(piece, corners, governors, {&bent, &filled});
  std::vector<std::size_t> first{0};
  std::vector<std::uint32_t> items;
  auto next = filled.begin();
  for (std::uint32_t c = 0; c < piece.cells.size(); ++c) {
    const Shape* shape = piece.cells[c].dimension == 1 ? outlines.bent(c) : nullptr;
    if (next != filled.end() && next->first == c) shape = &(next++)->second;
    const auto own = corners.of_cells()[c];
    if (shape != nullptr) {
      items.insert(items.end(), shape->items.begin(), shape->items.end());
    } else if (piece.cells[c].dimension == 2) {
      for (const auto& t : triangles_of(own, piece.vertices)) items.insert(items.end(), t.begin(), t.end());
    } else {
      items.insert(items.end(), own.begin(), own.end());
    }
    first.push_back(items.size());
  }
  piece.shapes = IndexRows(std::move(first), std::move(items));
  piece.sides = corners.sides();
}

}  // namespace blum::detail
