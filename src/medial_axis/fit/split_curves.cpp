#include "medial_axis/fit/split_curves.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum {
namespace {

constexpr std::size_t edges_per_range = 16;
constexpr int most_halvings = 5;
/// Edges of this length, in voxels, that are this far from the middle are split.
constexpr double least_length = 1;
constexpr double least_bend = 0.02;
/// The middle of an edge is not next to its ends, which would make for shorter and shorter ones.
constexpr double least_share = 0.2;

/// Where an edge is to be split.
std::optional<AxisVertex> split_of(const AxisVertex& a, const AxisVertex& b, const SolidPaths& paths, double voxel,
                                   const std::function<std::optional<AxisVertex>(const Vec3d&)>& middle) {
  const Vec3d way = b.position - a.position;
  const double size = length(way);
  if (size < least_length * voxel) return std::nullopt;
  std::optional<AxisVertex> found = middle(0.5 * (a.position + b.position));
  if (!found) return std::nullopt;
  const Vec3d from_a = found->position - a.position;
  const double along = dot(from_a, way) / (size * size);
  const bool bends = length(cross(from_a, way)) >= least_bend * voxel * size;
  if (!bends || along < least_share || along > 1 - least_share) return std::nullopt;
  const Stop first = stop_of(a);
  const Stop last = stop_of(b);
  const Stop over = stop_of(*found);
  const bool stays =
      paths.is_straight(first, over) && paths.is_straight(over, last) && paths.is_open(first, over, last);
  return stays ? found : std::nullopt;
}

}  // namespace

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

}  // namespace blum
