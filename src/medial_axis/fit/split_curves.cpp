#include "medial_axis/fit/split_curves.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum::detail {
namespace {

/// Cosine of 18 degrees. Two edges with a larger angle between them are not merged, however short they are.
constexpr double same_way = 0.95;

class CurveMerger {
 public:
  CurveMerger(AxisLists& lists, const Surface& surface, double beside, const Context& context)
      : lists_(lists), paths_(surface), beside_(beside), context_(context), curves_at_(lists.vertices.size()) {
    for (std::uint32_t e = 0; e < lists.edges.size(); ++e) {
      for (const std::uint32_t v : lists.edges[e]) curves_at_[v].push_back(e);
    }
  }

  /// @return  true if an end of any edge was moved to another vertex.
  bool run() {
    bool is_changed = false;
    std::vector<std::uint32_t> open;
    for (std::uint32_t v = 0; v < curves_at_.size(); ++v) {
      if (curves_at_[v].size() > 1) open.push_back(v);
    }
    if (!open.empty()) find_sides();
    while (!open.empty()) {
      throw_if_cancelled(context_);
      const std::uint32_t v = open.back();
      const std::optional<Pair> pair = pair_at(v);
      if (!pair) {
        open.pop_back();
        continue;
      }
      const std::uint32_t end = other_end(lists_.edges[pair->shorter], v);
      slide(pair->longer, v, end);
      open.push_back(end);
      is_changed = true;
    }
    return is_changed;
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;
  struct Pair {
    std::uint32_t shorter = 0, longer = 0;  ///< indices into lists_.edges
  };

  void find_sides() {
    for (const auto& t : lists_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        if (!curves_at_[a].empty() && !curves_at_[b].empty()) sides_.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    std::sort(sides_.begin(), sides_.end());
  }

  [[nodiscard]] const Vec3d& position(std::uint32_t v) const { return lists_.vertices[v].position; }
  [[nodiscard]] std::optional<Pair> pair_at(std::uint32_t v) const {
    for (const std::uint32_t shorter : curves_at_[v]) {
      for (const std::uint32_t longer : curves_at_[v]) {
        if (may_slide(v, shorter, longer)) return Pair{shorter, longer};
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] bool may_slide(std::uint32_t v, std::uint32_t shorter, std::uint32_t longer) const {
    if (shorter == longer) return false;
    const std::uint32_t u = other_end(lists_.edges[shorter], v);
    const std::uint32_t w = other_end(lists_.edges[longer], v);
    const Vec3d way = position(u) - position(v);
    const Vec3d other = position(w) - position(v);
    const double own_length = length(way);
    const double size = length(other);
    const double along = dot(way, other);
    // The edge whose end moves must become shorter, so that the loop in run() ends.
    if (u == w || !(own_length > 0) || along < same_way * own_length * size || along > size * size) return false;
    if (length(way - other * (along / (size * size))) > beside_ || !(length(other - way) < size)) return false;
    return !is_joined(u, w) && stays_in_solid(v, u, w);
  }

  [[nodiscard]] bool is_joined(std::uint32_t a, std::uint32_t b) const {
    const auto is_to_b = [&](std::uint32_t e) { return other_end(lists_.edges[e], a) == b; };
    if (std::any_of(curves_at_[a].begin(), curves_at_[a].end(), is_to_b)) return true;
    return std::binary_search(sides_.begin(), sides_.end(), Edge{std::min(a, b), std::max(a, b)});
  }
  [[nodiscard]] bool stays_in_solid(std::uint32_t v, std::uint32_t u, std::uint32_t w) const {
    const Stop start = stop_of(lists_.vertices[v]);
    const Stop over = stop_of(lists_.vertices[u]);
    const Stop end = stop_of(lists_.vertices[w]);
    return paths_.is_straight(over, end) && paths_.is_open(start, over, end);
  }

  void slide(std::uint32_t e, std::uint32_t from, std::uint32_t to) {
    auto& at = curves_at_[from];
    at.erase(std::find(at.begin(), at.end(), e));
    curves_at_[to].push_back(e);
    for (std::uint32_t& v : lists_.edges[e]) v = v == from ? to : v;
  }

  AxisLists& lists_;
  SolidPaths paths_;
  double beside_;
  const Context& context_;
  /// For each vertex: its edges of curves, as indices into lists_.edges.
  std::vector<std::vector<std::uint32_t>> curves_at_;
  std::vector<Edge> sides_;  ///< Sides of triangles with both ends on curves, sorted.
};

constexpr std::size_t edges_per_range = 16;
constexpr int most_halvings = 5;
/// An edge is split if it is at least `least_length` voxels long and at least `least_bend` voxels away from the part's
/// middle. In thin parts, these are multiples of the radius.
constexpr double least_length = 1;
constexpr double least_bend = 0.02;
/// The vertex that splits an edge must be at least this share of the edge's length away from both ends, along the edge.
/// Otherwise splitting would not end.
constexpr double least_share = 0.2;

/// Returns the vertex at which an edge is to be split, or nullopt if it is not.
std::optional<AxisVertex> split_of(const AxisVertex& a, const AxisVertex& b, const SolidPaths& paths, double voxel,
                                   const std::function<std::optional<AxisVertex>(const Vec3d&)>& middle) {
  const Vec3d way = b.position - a.position;
  const double size = length(way);
  const double unit = std::min(voxel, std::max(a.radius, b.radius));
  if (size < least_length * unit) return std::nullopt;
  std::optional<AxisVertex> found = middle(0.5 * (a.position + b.position));
  if (!found) return std::nullopt;
  const Vec3d from_a = found->position - a.position;
  const double along = dot(from_a, way) / (size * size);
  const bool bends = length(cross(from_a, way)) >= least_bend * unit * size;
  if (!bends || along < least_share || along > 1 - least_share) return std::nullopt;
  const Stop first = stop_of(a);
  const Stop last = stop_of(b);
  const Stop over = stop_of(*found);
  const bool stays =
      paths.is_straight(first, over) && paths.is_straight(over, last) && paths.is_open(first, over, last);
  return stays ? found : std::nullopt;
}

}  // namespace

bool merge_curves(AxisLists& lists, const Surface& surface, double beside, const Context& context) {
  return CurveMerger(lists, surface, beside, context).run();
}

bool split_curves(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                  const std::function<std::optional<AxisVertex>(const Vec3d&)>& middle, const Context& context) {
  const SolidPaths paths(surface);
  const std::size_t vertices = lists.vertices.size();
  std::vector<std::uint32_t> curves;
  for (std::uint32_t e = 0; e < lists.edges.size(); ++e) {
    if (incidence.triangles_of_edge()[incidence.edge_of_listed()[e]].empty()) curves.push_back(e);
  }
  for (int n = 0; n < most_halvings && !curves.empty(); ++n) {
    std::vector<std::optional<AxisVertex>> found(curves.size());
    parallel_for(context, found.size(), edges_per_range, "curves", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const auto& [a, b] = lists.edges[curves[k]];
        found[k] = split_of(lists.vertices[a], lists.vertices[b], paths, voxel, middle);
      }
    });
    std::vector<std::uint32_t> halves;
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (!found[k]) continue;
      const std::uint32_t e = curves[k];
      const auto at = static_cast<std::uint32_t>(lists.vertices.size());
      lists.vertices.push_back(*found[k]);
      halves.push_back(e);
      halves.push_back(static_cast<std::uint32_t>(lists.edges.size()));
      lists.add_edge({at, lists.edges[e][1]}, lists.edge_angles[e]);
      lists.edges[e][1] = at;
    }
    curves = std::move(halves);
  }
  return lists.vertices.size() > vertices;
}

}  // namespace blum::detail
