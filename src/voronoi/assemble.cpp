#include "voronoi/assemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/orient3d.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

/// The footprints of a point. Labels are treated as equally close if their distances differ by at most 1e-9 of the
/// mesh's size. Among their closest points, the two at the largest separation angle are the footprints. If only one
/// closest point exists, it is stored twice.
struct WallPoint {
  double radius = 0;                ///< exact distance from the closest label
  std::array<Vec3d, 2> footprints;  ///< relative to the centre of the labels
  std::array<LabelIndex, 2> labels{};
  double separation_angle = 0;  ///< separation angle of the footprints, degrees
};

/// Returns the angle in degrees between the directions from `at` to two other points.
double separation_angle(const Vec3d& at, const Vec3d& first, const Vec3d& second) {
  return degrees_between(first - at, second - at);
}

/// @param among  labels that include all that may be closest.
/// @param q  relative to the centre of the labels.
/// Cost: linear in the number of labels, quadratic in the number of closest labels.
WallPoint wall_point(const LabelGeometry& geometry, std::span<const LabelIndex> among, const Vec3d& q) {
  struct Near {
    LabelIndex label = outside;
    Vec3d point;
    double distance = 0;
  };
  std::vector<Near> all;
  double least = std::numeric_limits<double>::infinity();
  for (const LabelIndex label : among) {
    const double reach = least + 1e-9 * geometry.size();
    if (geometry[label].squared_distance(q) > reach * reach) continue;  // a lower bound of the true squared distance
    const Vec3d point = geometry.closest_point(label, q);
    all.push_back({label, point, length(point - q)});
    least = std::min(least, all.back().distance);
  }
  const double most = least + 1e-9 * geometry.size();
  std::erase_if(all, [&](const Near& near) { return near.distance > most; });
  std::sort(all.begin(), all.end(), [](const Near& a, const Near& b) { return a.distance < b.distance; });
  WallPoint out;
  if (all.empty()) return out;
  out.radius = least;
  out.footprints = {all[0].point, all[0].point};
  out.labels = {all[0].label, all[0].label};
  if (least <= 1e-9 * geometry.size()) return out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const double angle = separation_angle(q, all[i].point, all[k].point);
      if (angle <= out.separation_angle) continue;
      out.separation_angle = angle;
      out.footprints = {all[i].point, all[k].point};
      out.labels = {all[i].label, all[k].label};
    }
  }
  return out;
}

/// Box in which a vertex must stay. It has no extent along an axis if both coordinates are equal.
struct PlacedBox {
  Vec3d low, high;
};

using Matrix = std::array<std::array<double, 3>, 3>;

/// Solves a x = b by Gaussian elimination, for a symmetric positive definite matrix a. `inline` matters here and below:
/// without it, g++ does not inline these functions in settle(), and computing a complex takes 3 % longer.
inline Vec3d solve(Matrix a, Vec3d b) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = k + 1; i < 3; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < 3; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 3; k-- > 0;) {
    for (std::size_t j = k + 1; j < 3; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

struct Distance {
  double value = 0;
  Vec3d slope;
};

inline Distance distance_from(const PlacedLabel& label, const Vec3d& q) {
  if (label.kind == SiteKind::face) return {label.height(q), label.direction};
  const Vec3d away = q - label.foot(q);
  const double value = length(away);
  return {value, value > 0 ? away / value : Vec3d{}};
}

/// Returns a point in the box, near `start`, that is equally far from all labels; with `on_surface`, a point that lies
/// on all labels. Uses Gauss-Newton steps of least length. Returns nullopt if they find no such point.
/// @param labels      one label for each site: at least two, or at least one with `on_surface`.
/// @param on_surface  true if the distance from the labels must be 0.
/// @param start, box  relative to the centre of the labels.
std::optional<Vec3d> settle(const LabelGeometry& geometry, std::span<const LabelIndex> labels, bool on_surface,
                            const Vec3d& start, const PlacedBox& box) {
  const double reach = length(box.high - box.low);
  const double enough = 1e-12 * geometry.size();
  Vec3d q = start;
  std::vector<Distance> distances(labels.size());
  constexpr int most_steps = 24;
  for (int step = 0; step < most_steps; ++step) {
    double mean = 0;
    Vec3d mean_slope;
    for (std::size_t k = 0; k < labels.size(); ++k) {
      distances[k] = distance_from(geometry[labels[k]], q);
      mean += distances[k].value / static_cast<double>(labels.size());
      mean_slope += distances[k].slope / static_cast<double>(labels.size());
    }
    if (on_surface) {
      mean = 0;
      mean_slope = {};
    }
    Matrix normal{};
    Vec3d right;
    double largest = 0;
    for (const Distance& distance : distances) {
      Vec3d row = distance.slope - mean_slope;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.low[axis] == box.high[axis]) row[axis] = 0;
      }
      const double residual = distance.value - mean;
      largest = std::max(largest, std::abs(residual));
      right -= row * residual;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) normal[i][j] += row[i] * row[j];
      }
    }
    if (largest <= enough) {
      // If q is outside the box, the iteration continues from the box's closest point. This alternation finds a point
      // that satisfies both conditions if such a point exists.
      const Vec3d inside = max(box.low, min(box.high, q));
      if (inside == q) return q;
      q = inside;
      continue;
    }
    // A small multiple of the identity is added. It keeps steps short in directions that the equations do not
    // determine.
    const double trace = normal[0][0] + normal[1][1] + normal[2][2];
    for (std::size_t i = 0; i < 3; ++i) normal[i][i] += 1e-10 * trace + 1e-300;
    const Vec3d move = solve(normal, right);
    if (!is_finite(move) || length(move) > 2 * reach) return std::nullopt;
    q += move;
    if (length(q - start) > 2 * reach) return std::nullopt;
  }
  return std::nullopt;
}

bool are_apart(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low_a, high_a] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [low_b, high_b] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

/// Returns true if a segment meets a triangle and does not lie in the triangle's plane. Uses exact signs.
bool crosses(const std::array<Vec3d, 2>& segment, const std::array<Vec3d, 3>& triangle) {
  const auto& [p, q] = segment;
  const auto& [a, b, c] = triangle;
  const int from = detail::orient3d(a, b, c, p);
  const int to = detail::orient3d(a, b, c, q);
  if (from * to > 0 || (from == 0 && to == 0)) return false;
  const std::array sides{detail::orient3d(p, q, a, b), detail::orient3d(p, q, b, c), detail::orient3d(p, q, c, a)};
  const auto [least, most] = std::minmax({sides[0], sides[1], sides[2]});
  return least >= 0 || most <= 0;
}

/// Returns true if a side of one triangle crosses the other triangle.
bool cross_each_other(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  if (are_apart(a, b)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (crosses({a[k], a[(k + 1) % 3]}, b) || crosses({b[k], b[(k + 1) % 3]}, a)) return true;
  }
  return false;
}

constexpr std::size_t grain = 64;
constexpr std::uint32_t no_vertex = UINT32_MAX;

/// A vertex of the complex. It has its final position after settle_one() and move_to_rim().
struct Place {
  Vec3d start;  ///< position, relative to the centre of the labels
  std::uint32_t parts = 0;
  PlacedBox box;
  CellId cube = no_cell;            ///< the cube that contains the vertex
  Vec3d on_wall;                    ///< a point where a wall of its component crosses a grid edge
  Vec3d rim;                        ///< sum of the points on convex edges of the mesh where its walls end
  std::uint32_t rims = 0;           ///< number of these points
  bool is_over_corner = false;      ///< true if `rim` is a corner of the mesh, and the walls form a cone about it
  std::vector<LabelIndex> labels;   ///< one label for each site
  std::vector<LabelIndex> surface;  ///< triangles of the surface in its component
};

class Assembly {
 public:
  Assembly(const CellTree& tree, std::span<const CellId> leaves, const CubeTest& test, const VoronoiSolid& solid,
           const Context& context)
      : tree_(tree), leaves_(leaves), test_(test), solid_(solid), labels_(solid.labels), context_(context) {}

  Assembled assembled() {
    make_triangles();
    std::vector<FailingCube> lost;
    for (std::size_t k = 0; k < cubes_.size(); ++k) {
      if (cubes_[k].obstacle != VoronoiObstacle::none) lost.push_back({leaves_[k], cubes_[k].obstacle});
    }
    return {finish(), largest_diagonal_, std::move(lost)};
  }

  /// Returns the cubes with triangles that cross the surface. Walls lie in the solid, but their straight triangles may
  /// cut corners. Smaller cubes may avoid this.
  std::vector<CellId> crossing_cubes() {
    make_triangles();
    const std::vector<std::uint8_t> is_crossing = crossing_triangles();
    std::vector<CellId> out;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (is_crossing[t] != 0) out.push_back(cube_of_triangle_[t]);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

 private:
  void make_triangles() {
    analyse_cubes();
    place_events();
    for (std::size_t k = 0; k < cubes_.size(); ++k) add_cube(k);
    settle_all();
    find_angles();
  }

  void analyse_cubes() {
    cubes_.resize(leaves_.size());
    parallel_for(context_, cubes_.size(), grain, "components", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const GridCube& cube = tree_.cubes[leaves_[k]];
        if (cube.state == CubeState::passed) cubes_[k] = test_.run(cube);
      }
    });
  }

  void place_events() {
    at_event_.resize(tree_.events.size());
    edge_of_event_.resize(tree_.events.size(), no_cell);
    for (CellId id = 0; id < tree_.edges.size(); ++id) {
      const GridEdge& edge = tree_.edges[id];
      if (edge.children != no_cell) continue;
      const Vec3d low = tree_.lattice.at(edge.low);
      for (std::uint32_t k = edge.first_event; k < edge.last_event; ++k) {
        at_event_[k] = low;
        at_event_[k][edge.axis] = tree_.events[k].at;
        edge_of_event_[k] = id;
        at_event_[k] -= labels_.centre();
      }
    }
    vertex_of_event_.assign(tree_.events.size(), no_vertex);
    vertex_of_square_.assign(tree_.squares.size(), no_vertex);
  }

  void add_label(std::vector<LabelIndex>& list, LabelIndex label) const {
    const bool is_known = std::any_of(list.begin(), list.end(),
                                      [&](LabelIndex known) { return labels_[known].site == labels_[label].site; });
    if (!is_known) list.push_back(label);
  }

  void add_labels(Place& place, const LineEvent& event) const {
    // If the event has a thin region, `at` lies between the label before it and the thin vertex.
    for (const LabelIndex label : {event.before, event.thin != outside ? event.thin : event.after}) {
      if (label != outside) add_label(place.labels, label);
    }
    if (const std::optional<LabelIndex> triangle = event.crossed()) add_label(place.surface, *triangle);
  }

  std::uint32_t vertex_of_event(std::uint32_t event, CellId cube) {
    std::uint32_t& vertex = vertex_of_event_[event];
    if (vertex != no_vertex) return vertex;
    vertex = static_cast<std::uint32_t>(places_.size());
    Place place;
    place.start = place.on_wall = at_event_[event];
    place.parts = 1;
    place.box = {place.start, place.start};
    place.cube = cube;
    add_labels(place, tree_.events[event]);
    places_.push_back(std::move(place));
    return vertex;
  }

  [[nodiscard]] PlacedBox box_of(const Node& low, const Node& high) const {
    return {tree_.lattice.at(low) - labels_.centre(), tree_.lattice.at(high) - labels_.centre()};
  }

  /// Returns the index of the first vertex of a square; its components have consecutive vertices.
  std::uint32_t vertex_of_square(const CubeCells::Square& cells, CellId cube) {
    std::uint32_t& first = vertex_of_square_[cells.square];
    if (first != no_vertex) return first;
    first = static_cast<std::uint32_t>(places_.size());
    const GridSquare& square = tree_.squares[cells.square];
    Place place;
    place.box = box_of(square.low, square.high());
    place.cube = cube;
    places_.insert(places_.end(), cells.component.size(), place);
    for (std::size_t k = 0; k < cells.events.size(); ++k) {
      if (cells.component_of_event[k] == outside) continue;
      Place& of_component = places_[first + cells.component_of_event[k]];
      const LineEvent& event = tree_.events[cells.events[k]];
      of_component.start += at_event_[cells.events[k]];
      const bool is_first_on_surface = event.crossed() && of_component.surface.empty();
      if (of_component.parts == 0 || is_first_on_surface) of_component.on_wall = at_event_[cells.events[k]];
      ++of_component.parts;
      add_labels(of_component, event);
    }
    for (std::uint32_t k = 0; k < cells.component.size(); ++k) {
      places_[first + k].start *= 1.0 / places_[first + k].parts;
    }
    add_rims(cells, square, first);
    return first;
  }

  /// Adds the ends of walls on convex edges. The wall between the two faces of such an edge ends where the edge pierces
  /// the square. The end belongs to a component that has an event between both faces. If no component has an event
  /// between both faces, the end belongs to the first component that both faces touch.
  void add_rims(const CubeCells::Square& cells, const GridSquare& square, std::uint32_t first) {
    for (const std::uint32_t edge : cells.convex_edges) {
      const auto [t, u] = solid_.sites.triangles_of[edge];
      std::vector<std::uint8_t> touched(cells.component.size(), 0);  // bits 0, 1: faces; bit 2: event between them
      for (std::size_t k = 0; k < cells.events.size(); ++k) {
        if (cells.component_of_event[k] == outside) continue;
        const LineEvent& event = tree_.events[cells.events[k]];
        unsigned faces = 0;
        for (const LabelIndex label : {event.before, event.after}) {
          if (labels_.site_of(label) == labels_[t].site) faces |= 1U;
          if (labels_.site_of(label) == labels_[u].site) faces |= 2U;
        }
        touched[cells.component_of_event[k]] |= static_cast<std::uint8_t>(faces == 3 ? 7U : faces);
      }
      const auto best = std::max_element(touched.begin(), touched.end());
      if (best == touched.end() || *best < 3) continue;
      Place& place = places_[first + static_cast<std::uint32_t>(best - touched.begin())];
      place.rim += piercing(edge, square);
      ++place.rims;
    }
  }

  /// Returns the point where an edge of the mesh pierces a square, relative to the centre of the labels.
  [[nodiscard]] Vec3d piercing(std::uint32_t edge, const GridSquare& square) const {
    const Segment& ends = solid_.table.edges()[edge];
    const Vec3d p = solid_.mesh.vertices[ends[0]] - labels_.centre();
    const Vec3d q = solid_.mesh.vertices[ends[1]] - labels_.centre();
    const std::size_t axis = square.axis;
    const double plane = tree_.lattice.at(axis, square.low[axis]) - labels_.centre()[axis];
    const double part = (plane - p[axis]) / (q[axis] - p[axis]);
    return p + (q - p) * std::clamp(part, 0.0, 1.0);
  }

  /// Returns true if the site of each label of a vertex has a given corner of the mesh.
  [[nodiscard]] bool are_at(const Vec3d& corner, const Place& place) const {
    const std::vector<LabelIndex>& near = tree_.cubes[place.cube].governors;
    return std::all_of(place.labels.begin(), place.labels.end(), [&](LabelIndex label) {
      return std::any_of(near.begin(), near.end(), [&](LabelIndex other) {
        return labels_[other].site == labels_[label].site && labels_.has_corner(other, corner);
      });
    });
  }

  void add_cube(std::size_t number) {
    const CubeCells& cells = cubes_[number];
    if (cells.component_count == 0) return;
    const CellId id = leaves_[number];
    const GridCube& cube = tree_.cubes[id];
    largest_diagonal_ = std::max(largest_diagonal_, std::numbers::sqrt3 * tree_.lattice.unit * cube.length);
    const auto first = static_cast<std::uint32_t>(places_.size());
    Place place;
    place.box = box_of(cube.low, cube.high());
    place.cube = id;
    places_.insert(places_.end(), cells.component_count, place);
    for (const CubeCells::Square& square : cells.squares) {
      if (square.component.empty()) continue;
      const std::uint32_t first_of_square = vertex_of_square(square, id);
      for (std::uint32_t k = 0; k < square.component.size(); ++k) {
        Place& of_component = places_[first + square.component[k]];
        const Place& part = places_[first_of_square + k];
        of_component.start += part.start;
        const bool is_first_on_surface = !part.surface.empty() && of_component.surface.empty();
        if (of_component.parts == 0 || is_first_on_surface) of_component.on_wall = part.on_wall;
        ++of_component.parts;
        of_component.rim += part.rim;
        of_component.rims += part.rims;
        for (const LabelIndex label : part.labels) add_label(of_component.labels, label);
        for (const LabelIndex label : part.surface) add_label(of_component.surface, label);
      }
      for (std::size_t k = 0; k < square.events.size(); ++k) {
        const std::uint32_t component = square.component_of_event[k];
        if (component == outside) continue;
        std::array<std::uint32_t, 3> corners{vertex_of_event(square.events[k], id), first_of_square + component,
                                             first + square.component[component]};
        if (!faces_larger_site(square.events[k], tree_.squares[square.square], cube)) std::swap(corners[1], corners[2]);
        triangles_.push_back(corners);
        const LineEvent& event = tree_.events[square.events[k]];
        walls_.push_back({event.before, event.after});
        cube_of_triangle_.push_back(id);
      }
    }
    for (std::uint32_t k = 0; k < cells.component_count; ++k) {
      Place& of_component = places_[first + k];
      of_component.start *= 1.0 / of_component.parts;
      // If a component consists of one wall, its rim is the mean of the wall's ends. Near a corner of the mesh, walls
      // form a cone about the corner. Then the corner is the rim.
      if (of_component.rims > 0 && cells.vertices.size() == 1 &&
          are_at(solid_.mesh.vertices[cells.vertices[0]] - labels_.centre(), of_component)) {
        of_component.rim = solid_.mesh.vertices[cells.vertices[0]] - labels_.centre();
        of_component.rims = 1;
        of_component.is_over_corner = true;
      } else if (of_component.labels.size() > 2) {
        of_component.rims = 0;
      }
    }
  }

  [[nodiscard]] std::vector<std::uint8_t> crossing_triangles() const {
    std::vector<std::uint8_t> is_crossing(triangles_.size(), 0);
    parallel_for(context_, triangles_.size(), grain, {}, [&](const WorkRange& range) {
      for (std::size_t t = range.begin; t < range.end; ++t) {
        constexpr float least = 1;  // degrees: walls with a smaller separation angle are ignored
        if (triangle_angle_[t] < least) continue;
        const auto& [a, b, c] = triangles_[t];
        const std::array corners{places_[a].start + labels_.centre(), places_[b].start + labels_.centre(),
                                 places_[c].start + labels_.centre()};
        const std::vector<std::uint32_t>& near = tree_.cubes[cube_of_triangle_[t]].triangles;
        is_crossing[t] = std::any_of(near.begin(), near.end(), [&](std::uint32_t u) {
          return cross_each_other(corners, triangle_corners(solid_.mesh, u));
        });
      }
    });
    return is_crossing;
  }

  /// Returns true if a triangle's corners run counterclockwise as seen from the region of the larger site. The corners
  /// lie on a grid edge, in a square at that edge, and in a cube at that square. The result depends only on the
  /// positions of these cells. So the triangles around a region form a consistently oriented closed surface.
  [[nodiscard]] bool faces_larger_site(std::uint32_t event, const GridSquare& square, const GridCube& cube) const {
    const GridEdge& edge = tree_.edges[edge_of_event_[event]];
    const std::size_t across = 3 - edge.axis - square.axis;  // axis from the edge into the square
    bool is_along = next_axis(across) == square.axis;  // true if across, the square's, the edge's axis are right-handed
    if (edge.low[across] != square.low[across]) is_along = !is_along;
    if (square.low[square.axis] != cube.low[square.axis]) is_along = !is_along;
    const LineEvent& at = tree_.events[event];
    const std::uint32_t before = labels_.site_of(at.before);
    const std::uint32_t after = labels_.site_of(at.after);
    const bool is_after_larger = before == outside || (after != outside && after > before);
    return is_along == is_after_larger;
  }

  /// Computes the separation angle at the middle of each triangle: between its feet on the planes, lines or points of
  /// the wall's two sites. The angle is set to 0 for triangles of the surface, and if it is below `least`, the limit of
  /// rounding.
  void find_angles() {
    constexpr double least = 1e-6;  // degrees
    triangle_angle_.assign(triangles_.size(), 0);
    parallel_for(context_, triangles_.size(), grain, {}, [&](const WorkRange& range) {
      for (std::size_t t = range.begin; t < range.end; ++t) {
        const auto& [first, second] = walls_[t];
        if (first == outside || second == outside) continue;
        const auto& [a, b, c] = triangles_[t];
        const Vec3d middle = (places_[a].start + places_[b].start + places_[c].start) * (1.0 / 3);
        const double angle = separation_angle(middle, labels_[first].foot(middle), labels_[second].foot(middle));
        if (angle >= least) triangle_angle_[t] = static_cast<float>(angle);
      }
    });
  }

  void settle_all() {
    points_.resize(places_.size());
    parallel_for(context_, places_.size(), grain, "vertices", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        settle_one(places_[k], points_[k]);
        if (places_[k].rims > 0) move_to_rim(places_[k], points_[k]);
        const bool is_on_surface = !places_[k].surface.empty() && points_[k].radius <= near();
        if (is_on_surface) points_[k].radius = 0;  // removes rounding errors
      }
    });
  }

  /// A possible position of a vertex, with its footprints.
  struct Settled {
    Vec3d at;
    WallPoint point;
  };

  /// Returns a position where the given labels are equally close, or that lies on all of them. Returns nullopt if the
  /// position is not on a wall.
  [[nodiscard]] std::optional<Settled> settled(const Place& place, std::span<const LabelIndex> which) const {
    const auto at = settle(labels_, which, !place.surface.empty(), place.start, place.box);
    if (!at) return std::nullopt;
    Settled out{*at, seen_from(place, *at)};
    return is_on_wall(place, out.at, out.point) ? std::optional(out) : std::nullopt;
  }

  /// Returns the position with the largest separation angle on a wall between two labels. The largest angle is chosen
  /// so that narrow sheets are not missed.
  [[nodiscard]] std::optional<Settled> settled_between_two(const Place& place) const {
    constexpr std::size_t most = 10;  // largest number of labels to try
    const std::size_t count = std::min(most, place.labels.size());
    std::optional<Settled> best;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 1; k < count; ++k) {
        const auto found = settled(place, std::array{place.labels[i], place.labels[k]});
        if (found && (!best || found->point.separation_angle > best->point.separation_angle)) best = found;
      }
    }
    return best;
  }

  /// Returns a position on a seam, where three labels are equally close. Among several, the one with the largest number
  /// of closest sites is chosen.
  [[nodiscard]] std::optional<Settled> settled_on_seam(const Place& place) const {
    constexpr std::size_t most = 10;
    const std::size_t count = std::min(most, place.labels.size());
    std::optional<Settled> best;
    std::size_t best_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        for (std::size_t k = j + 1; k < count; ++k) {
          const auto found = settled(place, std::array{place.labels[i], place.labels[j], place.labels[k]});
          if (!found) continue;
          const std::size_t closest = sites_at(place, *found);
          if (closest <= best_count) continue;
          best = found;
          best_count = closest;
        }
      }
    }
    return best_count > 2 ? best : std::nullopt;
  }

  /// Returns the number of sites of a vertex that are closest to the given position.
  [[nodiscard]] std::size_t sites_at(const Place& place, const Settled& found) const {
    return static_cast<std::size_t>(std::count_if(place.labels.begin(), place.labels.end(), [&](LabelIndex label) {
      return length(labels_.closest_point(label, found.at) - found.at) <= found.point.radius + near();
    }));
  }

  /// Moves a vertex to the surface if its component contains a part of the surface. Otherwise moves it to a position
  /// where all its labels are equally close, or two of them. If no such position is found nearby, moves it to a point
  /// where one of its walls crosses a grid edge.
  void settle_one(Place& place, WallPoint& out) const {
    const bool is_point = place.box.low == place.box.high;
    std::optional<Settled> found;
    if (!is_point && place.surface.empty()) {
      found = settled(place, place.labels);
      // Sheets that meet at a corner of the mesh also meet on seams that start there. A vertex on only one of the
      // sheets would not lie on the others.
      if (!found && place.is_over_corner) found = settled_on_seam(place);
      if (!found) found = settled_between_two(place);
    } else if (!is_point) {
      found = settled(place, place.surface);
      for (std::size_t k = 0; k < place.surface.size() && !found; ++k) {
        found = settled(place, std::array{place.surface[k]});
      }
    }
    if (!found) found = {place.on_wall, seen_from(place, place.on_wall)};
    place.start = found->at;
    out = found->point;
  }

  /// Moves a vertex close to the point where its wall ends on the surface, unless the new position is not on a wall.
  void move_to_rim(Place& place, WallPoint& out) const {
    constexpr double left = 0.02;  // fraction of the distance that remains, so that edges do not touch the surface
    const Vec3d rim = place.rim * (1.0 / place.rims);
    const Vec3d at = rim + (place.start - rim) * left;
    const WallPoint found = seen_from(place, at);
    if (!is_on_wall(place, at, found)) return;
    place.start = at;
    out = found;
  }

  /// Returns the footprints of a vertex at a given position.
  [[nodiscard]] WallPoint seen_from(const Place& place, const Vec3d& at) const {
    return wall_point(labels_, tree_.cubes[place.cube].governors, at);
  }

  /// Returns the tolerance for points on walls and on the surface, in mesh units.
  [[nodiscard]] double near() const { return 1e-9 * labels_.size(); }

  /// Returns true if a point is equally far from two labels and inside the solid. For a vertex of the surface, returns
  /// true if the point lies on the surface.
  [[nodiscard]] bool is_on_wall(const Place& place, const Vec3d& at, const WallPoint& found) const {
    if (!place.surface.empty()) return found.radius <= near();
    return found.separation_angle > 0 && is_seen_from_inside(place, at, found, 0) &&
           is_seen_from_inside(place, at, found, 1);
  }

  /// Returns true if a point inside the solid can have footprint `which`. Only feet of perpendiculars in faces, and
  /// points of reflex edges and vertices, are footprints of points inside.
  [[nodiscard]] bool is_seen_from_inside(const Place& place, const Vec3d& at, const WallPoint& found,
                                         std::size_t which) const {
    if (is_in_domain(found.labels[which], at, found.radius)) return true;
    const std::vector<LabelIndex>& governors = tree_.cubes[place.cube].governors;
    return std::any_of(governors.begin(), governors.end(), [&](LabelIndex other) {
      return length(labels_.closest_point(other, at) - found.footprints[which]) <= near() &&
             is_in_domain(other, at, found.radius);
    });
  }

  [[nodiscard]] bool is_in_domain(LabelIndex label, const Vec3d& at, double distance) const {
    if (labels_[label].kind == SiteKind::face) return labels_[label].height(at) > distance - near();
    const std::span<const DomainPlane> planes = labels_.planes(label);
    return std::all_of(planes.begin(), planes.end(),
                       [&](const DomainPlane& plane) { return plane.height(at) > -near(); });
  }

  Complex finish() {
    Complex out;
    out.positions.reserve(places_.size());
    for (const Place& place : places_) out.positions.push_back(place.start + labels_.centre());
    out.triangles = std::move(triangles_);
    out.vertex_columns = Columns(out.positions.size());
    out.triangle_columns = Columns(out.triangles.size());
    add_vertex_columns(out.vertex_columns);
    add_triangle_columns(out.triangle_columns);
    return out;
  }

  void add_triangle_columns(Columns& out) {
    std::vector<std::int32_t> site_a, site_b;
    for (const auto& [first, second] : walls_) {
      // The cast turns the outside into -1.
      const auto [low, high] = std::minmax(
          {static_cast<std::int32_t>(labels_.site_of(first)), static_cast<std::int32_t>(labels_.site_of(second))});
      site_a.push_back(low);
      site_b.push_back(high);
    }
    out.add({"site_a", 1, std::move(site_a)});
    out.add({"site_b", 1, std::move(site_b)});
    out.add({std::string(medial_columns::separation_angle), 1, std::move(triangle_angle_)});
  }

  void add_vertex_columns(Columns& out) const {
    const std::span<double> radius = out.add<double>(std::string(medial_columns::radius));
    for (std::size_t k = 0; k < points_.size(); ++k) radius[k] = points_[k].radius;
    for (const std::size_t which : {0U, 1U}) {
      const std::span<double> footprint = out.add<double>(std::string(medial_columns::footprints[which]), 3);
      for (std::size_t k = 0; k < points_.size(); ++k) {
        const Vec3d at = points_[k].footprints[which] + labels_.centre();
        for (std::size_t axis = 0; axis < 3; ++axis) footprint[3 * k + axis] = at[axis];
      }
    }
    for (const std::size_t which : {0U, 1U}) {
      const std::span<std::int32_t> site = out.add<std::int32_t>(std::string(medial_columns::sites[which]));
      for (std::size_t k = 0; k < points_.size(); ++k) {
        const Label& label = solid_.exact.all()[points_[k].labels[which]];
        site[k] = static_cast<std::int32_t>(solid_.table.id({label.kind, label.index}).value);
      }
    }
    const std::span<double> angle = out.add<double>(std::string(medial_columns::separation_angle));
    for (std::size_t k = 0; k < points_.size(); ++k) angle[k] = points_[k].separation_angle;
  }

  const CellTree& tree_;
  const std::span<const CellId> leaves_;
  const CubeTest& test_;
  const VoronoiSolid& solid_;
  const LabelGeometry& labels_;
  const Context& context_;
  std::vector<CubeCells> cubes_;
  std::vector<Vec3d> at_event_;
  std::vector<CellId> edge_of_event_;
  std::vector<std::uint32_t> vertex_of_event_, vertex_of_square_;
  std::vector<Place> places_;
  std::vector<WallPoint> points_;  ///< for each of places_
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::array<LabelIndex, 2>> walls_;  ///< for each of triangles_: labels on both sides
  std::vector<CellId> cube_of_triangle_;
  std::vector<float> triangle_angle_;
  double largest_diagonal_ = 0;
};

}  // namespace

Assembled assemble(const CellTree& tree, std::span<const CellId> leaves, const CubeTest& test,
                   const VoronoiSolid& solid, const Context& context) {
  return Assembly(tree, leaves, test, solid, context).assembled();
}

std::vector<CellId> crossing_cubes(const CellTree& tree, std::span<const CellId> leaves, const CubeTest& test,
                                   const VoronoiSolid& solid, const Context& context) {
  return Assembly(tree, leaves, test, solid, context).crossing_cubes();
}

}  // namespace blum::voronoi
