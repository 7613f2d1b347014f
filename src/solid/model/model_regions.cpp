#include "solid/model/model_regions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/core/parts.hpp"
#include "blum/core/union_find.hpp"
#include "solid/model/box_surface.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {
namespace {

/// Returns the given cubes and all cubes that touch them, in ascending order.
std::vector<Cell> spread(const CellLattice& lattice, std::span<const Cell> cubes) {
  std::vector<Cell> out;
  for (const Cell cube : cubes) {
    const auto at = lattice.place(node_of(cube));
    for (std::int64_t n = 0; n < 27; ++n) {
      const std::array<std::int64_t, 3> other{at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
      bool is_cube = true;
      for (std::size_t a = 0; a < 3; ++a) is_cube = is_cube && other[a] >= 0 && other[a] + 1 < lattice.size()[a];
      if (is_cube) out.push_back(cell_at(lattice.node(other[0], other[1], other[2]), 7));
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::optional<std::uint32_t> index_of(std::span<const Cell> sorted, Cell cell) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), cell);
  if (at == sorted.end() || *at != cell) return std::nullopt;
  return static_cast<std::uint32_t>(at - sorted.begin());
}

/// A range of cubes along each axis, with both ends included.
struct CubeRange {
  std::array<std::int64_t, 3> low{};
  std::array<std::int64_t, 3> high{};

  [[nodiscard]] std::int64_t count() const {
    return (high[0] - low[0] + 1) * (high[1] - low[1] + 1) * (high[2] - low[2] + 1);
  }
  [[nodiscard]] bool contains(const std::array<std::int64_t, 3>& cube) const {
    bool holds = true;
    for (std::size_t a = 0; a < 3; ++a) holds = holds && cube[a] >= low[a] && cube[a] <= high[a];
    return holds;
  }
};

/// Returns the closed cubes that the bounding box of a triangle meets.
CubeRange cubes_around(const SurfaceMesh& mesh, const GridPlanes& planes, std::uint32_t triangle) {
  CubeRange range;
  for (std::size_t k = 0; k < 3; ++k) {
    const Place at = planes.cube(mesh.vertices()[mesh.triangles()[triangle][k]]);
    for (std::size_t a = 0; a < 3; ++a) {
      range.low[a] = k == 0 ? at[a] : std::min<std::int64_t>(range.low[a], at[a]);
      range.high[a] = k == 0 ? at[a] : std::max<std::int64_t>(range.high[a], at[a]);
    }
  }
  // A point in a plane also belongs to the closed cube below the plane.
  for (std::int64_t& low : range.low) low = std::max<std::int64_t>(low - 1, 0);
  return range;
}

/// Returns for each of the given cubes the triangles that meet it, and perhaps others.
std::vector<std::vector<std::uint32_t>> triangles_near(const SurfaceMesh& mesh, const CutGrid& grid,
                                                       std::span<const Cell> cubes, const Context& context) {
  std::vector<std::vector<std::uint32_t>> out(cubes.size());
  const CellLattice& lattice = grid.lattice();
  std::vector<std::array<std::int64_t, 3>> places;
  for (const Cell cube : cubes) places.push_back(lattice.place(node_of(cube)));
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    if (t % 65536 == 0) throw_if_cancelled(context);
    const CubeRange range = cubes_around(mesh, grid.planes(), t);
    if (range.count() > static_cast<std::int64_t>(cubes.size())) {
      for (std::size_t c = 0; c < cubes.size(); ++c) {
        if (range.contains(places[c])) out[c].push_back(t);
      }
      continue;
    }
    for (std::int64_t k = range.low[2]; k <= range.high[2]; ++k) {
      for (std::int64_t j = range.low[1]; j <= range.high[1]; ++j) {
        for (std::int64_t i = range.low[0]; i <= range.high[0]; ++i) {
          if (const auto c = index_of(cubes, cell_at(lattice.node(i, j, k), 7))) out[*c].push_back(t);
        }
      }
    }
  }
  constexpr std::size_t grain = 64;
  parallel_for(context, cubes.size(), grain, {}, [&](const WorkRange& range) {
    for (std::size_t c = range.begin; c < range.end; ++c) {
      const std::size_t first = node_of(cubes[c]);
      const Vec3d low = grid.planes().node(lattice.place(first));
      const Vec3d high = grid.planes().node(lattice.place(first + lattice.node(1, 1, 1)));
      std::erase_if(out[c], [&](std::uint32_t t) { return !may_reach(mesh.corners(t), low, high); });
    }
  });
  return out;
}

/// Returns the cubes that meet boxes; a cube may occur more than once.
std::vector<Cell> cubes_in(const CutGrid& grid, std::span<const Box3> boxes) {
  std::vector<Cell> cubes;
  for (const Box3& box : boxes) {
    const Place low = grid.planes().cube(box.lower);
    const Place high = grid.planes().cube(box.upper);
    for (std::int64_t k = low[2]; k <= high[2]; ++k) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t i = low[0]; i <= high[0]; ++i) cubes.push_back(cell_at(grid.lattice().node(i, j, k), 7));
      }
    }
  }
  return cubes;
}

}  // namespace

std::vector<RefinedRegion> refine_regions(const SurfaceMesh& mesh, const CutGrid& grid, int most_splits,
                                          std::span<const Box3> finer, const Context& context) {
  std::vector<Cell> split = cubes_in(grid, finer);
  split.insert(split.end(), grid.failing_cubes().begin(), grid.failing_cubes().end());
  if (split.empty()) return {};
  const CellLattice& lattice = grid.lattice();
  const std::vector<Cell> cubes = spread(lattice, split);
  std::vector<std::vector<std::uint32_t>> triangles = triangles_near(mesh, grid, cubes, context);
  UnionFind joined(cubes.size());
  for (std::uint32_t c = 0; c < cubes.size(); ++c) {
    for (const Cell other : spread(lattice, std::span(cubes).subspan(c, 1))) {
      if (const auto at = index_of(cubes, other)) joined.join(c, *at);
    }
  }
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::size_t> group_of(cubes.size(), 0);
  for (std::uint32_t c = 0; c < cubes.size(); ++c) {
    const std::uint32_t first = joined.find(c);
    if (first == c) {
      group_of[c] = groups.size();
      groups.emplace_back();
    }
    groups[group_of[first]].push_back(c);
  }
  std::vector<std::optional<RefinedRegion>> found(groups.size());
  std::vector<std::size_t> sizes;
  for (const auto& group : groups) sizes.push_back(group.size());
  for_each_part(context, sizes, "splits", [&](std::size_t g, const Context& context_of_part) {
    std::vector<Cell> own;
    std::vector<std::vector<std::uint32_t>> near;
    for (const std::uint32_t c : groups[g]) {
      own.push_back(cubes[c]);
      near.push_back(std::move(triangles[c]));
    }
    found[g].emplace(mesh, grid, own, std::move(near), most_splits, finer, context_of_part);
  });
  throw_if_cancelled(context);
  std::vector<RefinedRegion> regions;
  for (auto& region : found) {
    if (region) regions.push_back(std::move(*region));
  }
  return regions;
}

std::vector<ModelFailure> failures_of(std::span<const RefinedRegion> regions, int exponent) {
  std::vector<ModelFailure> failures;
  for (const RefinedRegion& region : regions) {
    for (const StuckBox& stuck : region.stuck()) {
      failures.push_back(
          {scaled(stuck.box.low, -exponent), scaled(stuck.box.high, -exponent), stuck.obstacle, stuck.cuts_left});
    }
  }
  return failures;
}

}  // namespace blum::detail
