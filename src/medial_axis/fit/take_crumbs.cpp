#include "medial_axis/fit/take_crumbs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "medial_axis/fit/kind.hpp"

namespace blum {
namespace {

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
  using Sheet = std::vector<std::uint32_t>;  ///< its triangles

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

  /// Calls visit(triangle) for the triangles of larger sheets a few edges around a small one.
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

  /// Of each small sheet, whether the middles of its triangles and its corners lie on triangles of larger sheets that
  /// it is attached to, near by.
  [[nodiscard]] std::vector<bool> which_lie_on_others() const {
    TriangleMesh around;
    std::vector<bool> is_around(lists_.triangles.size(), false);
    std::vector<Vec3d> points;
    std::vector<std::size_t> first{0};  // of the points of each sheet
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
  /// The edge that alone ends at a vertex, on no triangle.
  [[nodiscard]] std::optional<std::uint32_t> whisker_at(std::uint32_t v) const {
    std::optional<std::uint32_t> only;
    for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
      if (!has_edge_[e]) continue;
      if (only || triangles_at(e) > 0 || is_listed_[e]) return std::nullopt;
      only = e;
    }
    return only;
  }

  /// Collapses a sheet with its free sides and corners; not at all where that leaves anything that nothing else has.
  bool collapse(const Sheet& sheet) {
    std::vector<std::uint32_t> edges, vertices;  // gone
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
  std::vector<bool> is_small_;  ///< triangles
  std::vector<Sheet> small_;
};

}  // namespace

bool take_crumbs(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context) {
  return CrumbTaker(lists, incidence, limits, context).run();
}

}  // namespace blum
