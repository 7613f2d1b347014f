#include "medial_axis/fit/trim.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/axis/sheet_decimator.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/gather.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum::detail {
namespace {

/// Greatest moves of sheets, as fractions of the tolerance. Sheets are decimated with the first limit, then with the
/// second.
constexpr std::array levels{1.0 / 256, 1.0 / 16};
/// Vertices stay if they are at most this number of edges away from a vertex that fitting may move. Edges up to
/// `no_step` voxels long are not counted.
constexpr int rings = 3;
constexpr double no_step = 0.3;
/// Apart from borders, fitting may move vertices where a sheet bends by more than 18 degrees. It may move vertices
/// whose angle is less than theta plus `nearly_theta` degrees. It may also move vertices with a radius below
/// `least_radius` voxels, unless their angle is at least `parallel` degrees.
constexpr double least_cosine = 0.95;
constexpr double nearly_theta = 10;
constexpr double least_radius = 0.05;
constexpr double parallel = 170;

class InsideThinner {
 public:
  InsideThinner(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context)
      : lists_(lists), incidence_(incidence), target_(target), context_(context) {}

  double run() {
    SheetDecimator decimator(input(), target_.tolerance, context_);
    decimator.run(levels);
    lists_.triangle_angles.assign(decimator.triangle_angle().begin(), decimator.triangle_angle().end());
    keep(decimator.cells(), lists_);
    return decimator.moved();
  }

 private:
  [[nodiscard]] DecimatorInput input() const {
    DecimatorInput input{
        .triangles = lists_.triangles, .triangle_angle = lists_.triangle_angles, .borders = lists_.edges};
    input.points.reserve(lists_.vertices.size());
    for (const AxisVertex& vertex : lists_.vertices) input.points.push_back({vertex.position, vertex.radius});
    for (std::size_t e = 0; e < incidence_.edges().size(); ++e) {
      const std::size_t triangles = incidence_.triangles_of_edge()[e].size();
      // The edges of curves are already in `borders`.
      if (triangles != 0 && triangles != 2) input.borders.push_back(incidence_.edges()[e]);
    }
    input.border_kind.assign(input.borders.size(), 0);
    input.stays = next_to(movable());
    return input;
  }

  /// Returns 1 for each vertex that fitting may move, else 0.
  [[nodiscard]] std::vector<std::uint8_t> movable() const {
    constexpr std::size_t grain = 1024;
    const std::vector<Kind> kinds = kinds_of(incidence_, lists_.vertices.size());
    std::vector<std::uint8_t> out(kinds.size(), 0);
    parallel_for(context_, out.size(), grain, "borders", [&](const WorkRange& range) {
      for (std::size_t v = range.begin; v < range.end; ++v) {
        const AxisVertex& vertex = lists_.vertices[v];
        const double angle = vertex.separation_angle;
        const bool is_inside = kinds[v].rims + kinds[v].seams + kinds[v].curves == 0 && kinds[v].inner > 0;
        const bool is_shown = angle > target_.theta + nearly_theta &&
                              (vertex.radius >= least_radius * target_.voxel || angle >= parallel);
        const auto flatness = [&] {
          return least_cosine_at(lists_, incidence_, static_cast<std::uint32_t>(v), vertex.position);
        };
        // Between walls this close to each other, vertices hardly move, even if the walls bend.
        const bool is_thin = vertex.radius < least_radius * target_.voxel;
        out[v] = is_inside && is_shown && (is_thin || flatness() >= least_cosine) ? 0 : 1;
      }
    });
    return out;
  }
  /// Adds to the chosen vertices all vertices that are at most `rings` edges away. Short edges are followed first and
  /// are not counted, so that each vertex is reached by the least number of edges.
  [[nodiscard]] std::vector<std::uint8_t> next_to(std::vector<std::uint8_t> chosen) const {
    const double shortest = no_step * target_.voxel;
    std::vector<std::uint8_t> steps(chosen.size(), rings + 1);
    std::deque<std::pair<std::uint32_t, std::uint8_t>> next;
    const auto reach = [&](std::uint32_t v, std::uint8_t step, bool is_first) {
      if (step >= steps[v]) return;
      steps[v] = step;
      if (is_first) {
        next.emplace_front(v, step);
      } else {
        next.emplace_back(v, step);
      }
    };
    for (std::uint32_t v = 0; v < chosen.size(); ++v) {
      if (chosen[v] != 0) reach(v, 0, false);
    }
    while (!next.empty()) {
      const auto [v, step] = next.front();
      next.pop_front();
      if (step > steps[v]) continue;
      chosen[v] = 1;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
        const std::uint32_t other = other_end(incidence_.edges()[e], v);
        const Vec3d way = lists_.vertices[other].position - lists_.vertices[v].position;
        const bool is_short = squared_length(way) <= shortest * shortest;
        reach(other, static_cast<std::uint8_t>(step + (is_short ? 0 : 1)), is_short);
      }
    }
    return chosen;
  }

  AxisLists& lists_;
  const Incidence& incidence_;
  const FitTarget& target_;
  const Context& context_;
};

class CrumbTaker {
 public:
  CrumbTaker(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context)
      : lists_(lists),
        incidence_(incidence),
        limits_(limits),
        context_(context),
        has_triangle_(lists.triangles.size(), true),
        has_edge_(incidence.edges().size(), true),
        is_listed_(incidence.edges().size(), false),
        has_vertex_(lists.vertices.size(), true) {
    for (const std::uint32_t e : incidence.edge_of_listed()) is_listed_[e] = true;
  }

  bool run() {
    find_small_sheets();
    if (small_.empty()) return false;
    bool is_changed = false;
    const std::vector<bool> lies_on_others = which_lie_on_others();
    for (std::size_t s = 0; s < small_.size(); ++s)
      is_changed = (lies_on_others[s] && collapse(small_[s])) || is_changed;
    if (is_changed) keep(has_vertex_, has_triangle_, lists_);
    return is_changed;
  }

 private:
  using Sheet = std::vector<std::uint32_t>;  ///< triangles of a sheet

  [[nodiscard]] const Vec3d& position(std::uint32_t v) const { return lists_.vertices[v].position; }
  [[nodiscard]] double area(std::uint32_t t) const {
    const auto& [a, b, c] = lists_.triangles[t];
    return 0.5 * length(cross(position(b) - position(a), position(c) - position(a)));
  }

  void find_small_sheets() {
    const std::size_t count = lists_.triangles.size();
    detail::UnionFind sheets = sheets_of(incidence_);
    std::vector<double> size(count, 0);
    for (std::uint32_t t = 0; t < count; ++t) size[sheets.find(t)] += area(t);
    constexpr std::uint32_t none = 0xffffffffU;
    std::vector<std::uint32_t> number(count, none);
    is_small_.assign(count, false);
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t first = sheets.find(t);
      if (size[first] > limits_.area) continue;
      if (number[first] == none) {
        number[first] = static_cast<std::uint32_t>(small_.size());
        small_.emplace_back();
      }
      small_[number[first]].push_back(t);
      is_small_[t] = true;
    }
  }

  /// Calls visit(triangle) for the triangles of larger sheets within four edges of a small sheet.
  template <class Visit>
  void for_each_around(const Sheet& sheet, const Visit& visit) const {
    constexpr int rings = 4;
    std::vector<std::uint32_t> vertices, next;
    for (const std::uint32_t t : sheet) {
      vertices.insert(vertices.end(), lists_.triangles[t].begin(), lists_.triangles[t].end());
    }
    for (int ring = 0; ring < rings; ++ring) {
      next.clear();
      for (const std::uint32_t v : vertices) {
        for (const std::uint32_t other : incidence_.triangles_of_vertex()[v]) {
          next.insert(next.end(), lists_.triangles[other].begin(), lists_.triangles[other].end());
          if (!is_small_[other]) visit(other);
        }
      }
      detail::sort_unique(next);
      std::swap(vertices, next);
    }
  }

  /// Returns true for each small sheet that lies on nearby triangles of larger sheets to which it is attached. The
  /// corners and centroids of its triangles are tested.
  [[nodiscard]] std::vector<bool> which_lie_on_others() const {
    TriangleMesh around;
    std::vector<bool> is_around(lists_.triangles.size(), false);
    std::vector<Vec3d> points;
    std::vector<std::size_t> first{0};  // index of the first point of each sheet
    for (const Sheet& sheet : small_) {
      for (const std::uint32_t t : sheet) {
        const auto& [a, b, c] = lists_.triangles[t];
        points.insert(points.end(),
                      {(position(a) + position(b) + position(c)) / 3, position(a), position(b), position(c)});
      }
      for_each_around(sheet, [&](std::uint32_t other) {
        if (is_around[other]) return;
        is_around[other] = true;
        const auto at = static_cast<std::uint32_t>(around.vertices.size());
        for (const std::uint32_t corner : lists_.triangles[other]) around.vertices.push_back(position(corner));
        around.triangles.push_back({at, at + 1, at + 2});
      });
      first.push_back(points.size());
    }
    std::vector<bool> lies_on_others(small_.size(), false);
    if (around.triangles.empty()) return lies_on_others;
    const std::vector<ClosestPoint> closest = closest_points(around, points, {.sign = SignMode::none}, context_);
    for (std::size_t s = 0; s < small_.size(); ++s) {
      lies_on_others[s] = std::all_of(closest.begin() + static_cast<std::ptrdiff_t>(first[s]),
                                      closest.begin() + static_cast<std::ptrdiff_t>(first[s + 1]),
                                      [&](const ClosestPoint& p) { return p.distance <= limits_.beside; });
    }
    return lies_on_others;
  }

  [[nodiscard]] std::size_t triangles_at(std::uint32_t e) const {
    const auto at = incidence_.triangles_of_edge()[e];
    return static_cast<std::size_t>(
        std::count_if(at.begin(), at.end(), [&](std::uint32_t t) { return has_triangle_[t]; }));
  }
  /// Returns the only edge at a vertex, if it belongs to no triangle and is not an edge of the lists; else nullopt.
  [[nodiscard]] std::optional<std::uint32_t> whisker_at(std::uint32_t v) const {
    std::optional<std::uint32_t> only;
    for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
      if (!has_edge_[e]) continue;
      if (only || triangles_at(e) > 0 || is_listed_[e]) return std::nullopt;
      only = e;
    }
    return only;
  }

  /// Collapses a sheet with its free sides and corners. If a triangle would be left, or a side that belongs to no other
  /// cell, it changes nothing.
  bool collapse(const Sheet& sheet) {
    std::vector<std::uint32_t> edges, vertices;  // removed so far
    for (std::size_t left = sheet.size(), before = 0; left != before && left > 0;) {
      before = left;
      for (const std::uint32_t t : sheet) {
        if (!has_triangle_[t]) continue;
        const auto& sides = incidence_.sides()[t];
        const auto* free = std::find_if(sides.begin(), sides.end(),
                                        [&](std::uint32_t e) { return !is_listed_[e] && triangles_at(e) == 1; });
        if (free == sides.end()) continue;
        has_triangle_[t] = false;
        has_edge_[*free] = false;
        edges.push_back(*free);
        --left;
        for (const std::uint32_t v : lists_.triangles[t]) {
          const std::optional<std::uint32_t> whisker = has_vertex_[v] ? whisker_at(v) : std::nullopt;
          if (!whisker) continue;
          has_vertex_[v] = has_edge_[*whisker] = false;
          vertices.push_back(v);
          edges.push_back(*whisker);
        }
      }
    }
    const bool is_gone = std::all_of(sheet.begin(), sheet.end(), [&](std::uint32_t t) {
      const auto& sides = incidence_.sides()[t];
      return !has_triangle_[t] && std::all_of(sides.begin(), sides.end(), [&](std::uint32_t e) {
        return !has_edge_[e] || is_listed_[e] || triangles_at(e) > 0;
      });
    });
    if (is_gone) return true;
    for (const std::uint32_t t : sheet) has_triangle_[t] = true;
    for (const std::uint32_t e : edges) has_edge_[e] = true;
    for (const std::uint32_t v : vertices) has_vertex_[v] = true;
    return false;
  }

  AxisLists& lists_;
  const Incidence& incidence_;
  CrumbLimits limits_;
  const Context& context_;
  std::vector<bool> has_triangle_, has_edge_, is_listed_, has_vertex_;
  std::vector<bool> is_small_;  ///< for each triangle: true if it belongs to a small sheet
  std::vector<Sheet> small_;
};

class Trimmer {
 public:
  Trimmer(AxisLists& lists, const Incidence& incidence, const std::vector<double>& angles, const TrimLimits& limits,
          const Context& context)
      : lists_(lists),
        angles_(angles),
        limits_(limits),
        context_(context),
        incidence_(incidence),
        triangles_left_(incidence_.edges().size()),
        edges_left_(lists.vertices.size()),
        has_triangle_(lists.triangles.size(), true),
        has_edge_(incidence_.edges().size(), true),
        has_vertex_(lists.vertices.size(), true),
        is_on_sheet_(lists.vertices.size(), false) {
    for (std::uint32_t e = 0; e < has_edge_.size(); ++e) {
      triangles_left_[e] = static_cast<std::uint32_t>(incidence_.triangles_of_edge()[e].size());
    }
    for (std::uint32_t v = 0; v < has_vertex_.size(); ++v) {
      edges_left_[v] = static_cast<std::uint32_t>(incidence_.edges_of_vertex()[v].size());
    }
  }

  bool run() {
    find_what_is_on_sheets();
    for (std::uint32_t e = 0; e < has_edge_.size(); ++e) look_at_edge(e);
    for (std::uint32_t v = 0; v < has_vertex_.size(); ++v) look_at_vertex(v);
    while (!queue_.empty()) {
      const auto [angle, dimension, cell] = queue_.top();
      queue_.pop();
      if (dimension == 2) {
        take_triangle_from(cell);
      } else {
        take_edge_from(cell);
      }
    }
    if (stays_as_it_is()) return false;
    write();
    return true;
  }

 private:
  [[nodiscard]] double angle(std::uint32_t v) const { return angles_[v]; }

  /// Returns the largest angle of a triangle's vertices. If no vertex has two footprints, it returns the angle of the
  /// triangle.
  [[nodiscard]] double angle_of_triangle(std::uint32_t t) const {
    double largest = 0;
    for (const std::uint32_t v : lists_.triangles[t]) largest = std::max(largest, angle(v));
    // If no vertex has two footprints, the triangle's own angle is more reliable.
    return largest > 0 ? largest : lists_.triangle_angles[t];
  }
  [[nodiscard]] double angle_of_edge(std::uint32_t e) const {
    return std::max(angle(incidence_.edges()[e][0]), angle(incidence_.edges()[e][1]));
  }

  // ---- Cells that lie on others ----

  [[nodiscard]] const Vec3d& position(std::uint32_t v) const { return lists_.vertices[v].position; }
  [[nodiscard]] double length_of(std::uint32_t e) const {
    return length(position(incidence_.edges()[e][0]) - position(incidence_.edges()[e][1]));
  }
  /// Returns true if a triangle is so flat that it practically lies on any two of its sides, except for the longest.
  [[nodiscard]] bool is_flat(std::uint32_t t) const {
    double longest = 0;
    for (const std::uint32_t e : incidence_.sides()[t]) longest = std::max(longest, length_of(e));
    const auto& corners = lists_.triangles[t];
    const auto& [a, b, c] = corners;
    const bool is_round = std::all_of(corners.begin(), corners.end(),
                                      [&](std::uint32_t v) { return angle(v) > lists_.vertices[v].separation_angle; });
    const double thin = is_round ? limits_.thin_if_round : limits_.thin;
    return length(cross(position(b) - position(a), position(c) - position(a))) <= thin * longest;
  }
  /// Returns true if a triangle is flat and `side` is its longest side, so that it practically lies on the other two.
  [[nodiscard]] bool is_covered(std::uint32_t t, std::uint32_t side) const {
    const auto& sides = incidence_.sides()[t];
    const double longest = length_of(side);
    return std::none_of(sides.begin(), sides.end(), [&](std::uint32_t e) { return length_of(e) > longest; }) &&
           is_flat(t);
  }

  /// Returns true if the end of a curve lies on a sheet, or if its last edge is short and sticks out of a rim. If the
  /// edge sticks out of a rim, the rim is later moved outwards instead.
  [[nodiscard]] bool is_whisker(std::uint32_t end, std::uint32_t own) const {
    if (is_on_sheet_[end]) return true;
    const std::uint32_t foot = other_end(incidence_.edges()[own], end);
    const auto at = incidence_.edges_of_vertex()[foot];
    // A strip of flat triangles is a curve itself, which may go on from this edge.
    const auto around = incidence_.triangles_of_vertex()[foot];
    const bool is_strip = lists_.vertices[foot].radius <= limits_.whiskers &&
                          std::all_of(around.begin(), around.end(), [&](std::uint32_t t) { return is_flat(t); });
    const bool is_at_rim =
        !is_strip && std::any_of(at.begin(), at.end(), [&](std::uint32_t e) { return triangles_left_[e] == 1; });
    return is_at_rim && length_of(own) <= limits_.whiskers;
  }
  /// Finds vertices that belong to no triangle but are within `limits_.beside` of one.
  void find_what_is_on_sheets() {
    std::vector<std::pair<double, std::uint32_t>> alone;  // x coordinate and index
    for (std::uint32_t v = 0; v < has_vertex_.size(); ++v) {
      if (incidence_.triangles_of_vertex()[v].empty()) alone.emplace_back(position(v).x, v);
    }
    if (alone.empty()) return;
    std::sort(alone.begin(), alone.end());
    const TriangleMesh near = triangles_near(alone);
    if (near.triangles.empty()) return;
    std::vector<Vec3d> places;
    for (const auto& [x, v] : alone) places.push_back(position(v));
    const std::vector<ClosestPoint> closest = closest_points(near, places, {.sign = SignMode::none}, context_);
    for (std::size_t k = 0; k < alone.size(); ++k)
      is_on_sheet_[alone[k].second] = closest[k].distance <= limits_.beside;
  }
  /// Returns the triangles whose boxes are within `limits_.beside` of any vertex of `alone`, which is sorted by x.
  [[nodiscard]] TriangleMesh triangles_near(const std::vector<std::pair<double, std::uint32_t>>& alone) const {
    constexpr std::size_t grain = 4096;
    const Vec3d reach{limits_.beside, limits_.beside, limits_.beside};
    const auto found =
        detail::gather<std::uint32_t>(context_, lists_.triangles.size(), grain, {}, [&](std::size_t t, auto& list) {
          const auto& [a, b, c] = lists_.triangles[t];
          const Box3 box{min(min(position(a), position(b)), position(c)) - reach,
                         max(max(position(a), position(b)), position(c)) + reach};
          auto at = std::lower_bound(alone.begin(), alone.end(), std::pair(box.lower.x, 0U));
          while (at != alone.end() && at->first <= box.upper.x && !holds(box, position(at->second))) ++at;
          if (at != alone.end() && at->first <= box.upper.x) list.push_back(static_cast<std::uint32_t>(t));
        });
    TriangleMesh near;
    for (const std::uint32_t t : found) {
      const auto first = static_cast<std::uint32_t>(near.vertices.size());
      for (const std::uint32_t v : lists_.triangles[t]) near.vertices.push_back(position(v));
      near.triangles.push_back({first, first + 1, first + 2});
    }
    return near;
  }

  [[nodiscard]] std::uint32_t triangle_left_at(std::uint32_t e) const {
    const auto at = incidence_.triangles_of_edge()[e];
    return *std::find_if(at.begin(), at.end(), [&](std::uint32_t t) { return has_triangle_[t]; });
  }
  [[nodiscard]] std::uint32_t edge_left_at(std::uint32_t v) const {
    const auto at = incidence_.edges_of_vertex()[v];
    return *std::find_if(at.begin(), at.end(), [&](std::uint32_t e) { return has_edge_[e]; });
  }

  /// Queues an edge of exactly one triangle if the triangle's angle is at most theta, or if the triangle lies on its
  /// other sides.
  void look_at_edge(std::uint32_t e) {
    if (!has_edge_[e] || triangles_left_[e] != 1) return;
    const std::uint32_t t = triangle_left_at(e);
    const double largest = is_covered(t, e) ? 0 : angle_of_triangle(t);
    if (largest <= limits_.theta) queue_.emplace(largest, 2, e);
  }
  void look_at_vertex(std::uint32_t v) {
    if (!has_vertex_[v] || edges_left_[v] != 1) return;
    const std::uint32_t e = edge_left_at(v);
    if (triangles_left_[e] > 0) return;
    const double largest = is_whisker(v, e) ? 0 : angle_of_edge(e);
    if (largest <= limits_.theta) queue_.emplace(largest, 1, v);
  }

  void take_triangle_from(std::uint32_t e) {
    if (!has_edge_[e] || triangles_left_[e] != 1) return;
    const std::uint32_t t = triangle_left_at(e);
    has_triangle_[t] = false;
    for (const std::uint32_t side : incidence_.sides()[t]) --triangles_left_[side];
    take_edge(e);
    for (const std::uint32_t side : incidence_.sides()[t]) look_at_edge(side);
    for (const std::uint32_t v : lists_.triangles[t]) look_at_vertex(v);
  }
  void take_edge_from(std::uint32_t v) {
    if (!has_vertex_[v] || edges_left_[v] != 1) return;
    const std::uint32_t e = edge_left_at(v);
    if (triangles_left_[e] > 0) return;
    has_vertex_[v] = false;
    take_edge(e);
    for (const std::uint32_t end : incidence_.edges()[e]) look_at_vertex(end);
  }
  void take_edge(std::uint32_t e) {
    has_taken_ = true;
    has_edge_[e] = false;
    for (const std::uint32_t v : incidence_.edges()[e]) --edges_left_[v];
  }

  /// Returns true if nothing was removed and the edges of the lists are those that write() would write: curves only,
  /// ascending, the smaller end first.
  [[nodiscard]] bool stays_as_it_is() const {
    const auto& listed = incidence_.edge_of_listed();
    for (std::size_t n = 0; n < listed.size(); ++n) {
      const bool is_rising = n == 0 || listed[n - 1] < listed[n];
      const bool is_same = lists_.edges[n] == incidence_.edges()[listed[n]];
      if (!is_rising || !is_same || triangles_left_[listed[n]] > 0) return false;
    }
    return !has_taken_;
  }

  /// Writes the remaining cells to the lists. Vertices and triangles keep their order; edges have the order of the
  /// incidence.
  void write() {
    std::vector<float> angle_of_edge(has_edge_.size(), 0);
    for (std::size_t n = 0; n < lists_.edges.size(); ++n) {
      angle_of_edge[incidence_.edge_of_listed()[n]] = lists_.edge_angles[n];
    }
    for (std::uint32_t t = 0; t < has_triangle_.size(); ++t) {
      for (const std::uint32_t side : incidence_.sides()[t]) {
        angle_of_edge[side] = std::max(angle_of_edge[side], lists_.triangle_angles[t]);
      }
    }
    lists_.edges.clear();
    lists_.edge_angles.clear();
    for (std::uint32_t e = 0; e < has_edge_.size(); ++e) {
      if (has_edge_[e] && triangles_left_[e] == 0) lists_.add_edge(incidence_.edges()[e], angle_of_edge[e]);
    }
    keep(has_vertex_, has_triangle_, lists_);
  }

  AxisLists& lists_;
  const std::vector<double>& angles_;
  TrimLimits limits_;
  const Context& context_;
  const Incidence& incidence_;
  std::vector<std::uint32_t> triangles_left_, edges_left_;
  std::vector<bool> has_triangle_, has_edge_, has_vertex_, is_on_sheet_;
  bool has_taken_ = false;  ///< true if anything was removed
  using Entry = std::tuple<double, int, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

double thin_insides(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context) {
  return InsideThinner(lists, incidence, target, context).run();
}

bool take_crumbs(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context) {
  return CrumbTaker(lists, incidence, limits, context).run();
}

bool trim(AxisLists& lists, const Incidence& incidence, const std::vector<double>& angles, const TrimLimits& limits,
          const Context& context) {
  return Trimmer(lists, incidence, angles, limits, context).run();
}

}  // namespace blum::detail
