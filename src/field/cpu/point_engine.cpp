#include "field/cpu/point_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blum/core/huge_pages.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "field/kernels/morton.hpp"
#include "hwy/cache_control.h"

namespace blum::cpu {
namespace {

constexpr std::size_t grain = std::size_t{1} << 13;
constexpr double infinite = std::numeric_limits<double>::infinity();
/// Bound on the error of a distance in single precision, in the normalised frame.
constexpr double slack = 2e-6;

Vec3d clamped(const Vec3d& p, const Box3& box) {
  Vec3d out;
  for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = std::clamp(p[axis], box.lower[axis], box.upper[axis]);
  return out;
}

/// Queries are scattered in memory, so they are prefetched while their group is assembled.
void prefetch(const Vec3d& query) {
  hwy::Prefetch(&query.x);
  hwy::Prefetch(&query.z);  // the end of the query may be in the next cache line
}

SiteId known_site(std::uint32_t record) {
  return record == dead_record ? SiteId::none() : SiteId(record);
}

/// Returns a grid of two nodes per side. Its box is the mesh's box, widened on each side by a quarter of the longest
/// side. Most queries are expected to lie within it.
GridSpec frame_grid(const Box3& bounds) {
  const Vec3d size = bounds.size();
  const double margin = 0.25 * std::max({size.x, size.y, size.z});
  GridSpec grid;
  grid.origin = bounds.lower - Vec3d{margin, margin, margin};
  grid.spacing = size + Vec3d{2 * margin, 2 * margin, 2 * margin};
  grid.size = {2, 2, 2};
  return grid;
}

}  // namespace

PointEngine::PointEngine(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  Adjacency adjacency;
  build_adjacency(mesh, sites, context, adjacency);
  kernels::Bounds bounds;
  for (const std::uint32_t v : adjacency.named_vertices) bounds.extend(mesh.vertices[v]);
  if (adjacency.named_vertices.empty() || bounds.lower == bounds.upper) return;
  const GridSpec grid = frame_grid({bounds.lower, bounds.upper});
  box_ = {grid.origin, grid.origin + grid.spacing};
  frame_ = kernels::make_normal_frame(bounds, grid);
  if (frame_.fault != NormalFrame::Fault::none || !is_finite(box_.lower) || !is_finite(box_.upper)) return;
  placed_.build(mesh, sites, adjacency, frame_, context);
  is_usable_ = true;
}

double PointEngine::margin() const {
  return slack / frame_.scale;
}

/// Queries in the order of a Morton curve.
struct PointEngine::Ordered {
  std::vector<detail::KeyedIndex> order;  ///< the key is the Morton code of the query's cell
  MortonPoints points;
};

PointEngine::Ordered PointEngine::order(std::span<const Vec3d> queries, const Context& context) const {
  Ordered out;
  const std::size_t count = queries.size();
  Buffer<Vec3f> positions(count);
  std::vector<Box3> boxes((count + grain - 1) / grain);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    Box3 box;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      positions[i] = kernels::to_float(frame_.to_normal(clamped(queries[i], box_)));
      box.extend(kernels::to_double(positions[i]));
    }
    boxes[range.begin / grain] = box;
  });
  Box3 box;
  for (const Box3& one : boxes) box.extend(one);
  const Vec3d size = box.size();
  out.points.lower = box.lower;
  out.points.side = std::max({size.x, size.y, size.z});
  constexpr std::uint32_t cells = 1U << MortonPoints::levels;
  const double scale = out.points.side > 0 ? cells / out.points.side : 0;
  out.order = detail::large_list<detail::KeyedIndex>(count);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Vec3d at = (kernels::to_double(positions[i]) - box.lower) * scale;
      std::uint32_t code = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        code |= kernels::spread_bits(std::min(static_cast<std::uint32_t>(at[axis]), cells - 1)) << axis;
      }
      out.order[i] = {code, static_cast<std::uint32_t>(i)};
    }
  });
  std::vector<detail::KeyedIndex> scratch = detail::large_list<detail::KeyedIndex>(count);
  detail::radix_sort(out.order, scratch);
  for (Buffer<float>& coordinate : out.points.coordinate) {
    coordinate = Buffer<float>(count + MortonPoints::padding);
    std::fill_n(coordinate.data() + count, MortonPoints::padding, 0.0F);
  }
  out.points.code = detail::large_list<std::uint32_t>(count);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const Vec3f& at = positions[out.order[k].index];
      out.points.code[k] = out.order[k].key;
      for (std::size_t axis = 0; axis < 3; ++axis) out.points.coordinate[axis][k] = at[axis];
    }
  });
  return out;
}

double PointEngine::at_most(const Vec3d& query, const FoundSite& found) const {
  if (!(found.squared < far_away)) return infinite;
  const double moved = length(query - clamped(query, box_));
  const double normalised = std::sqrt(static_cast<double>(found.squared)) * (1 + 1e-6) + slack;
  return normalised / frame_.scale + moved * (1 + 1e-12);
}

void PointEngine::for_each_group(std::span<const Vec3d> queries, const Context& context,
                                 FunctionRef<void(std::span<const FoundSite>)> use) const {
  if (!is_usable_) {
    parallel_for(context, queries.size(), most_per_group, "closest points", [&](const WorkRange& range) {
      std::vector<FoundSite> group;
      for (std::size_t k = range.begin; k < range.end; ++k) {
        group.push_back({static_cast<std::uint32_t>(k), SiteId::none(), SiteId::none(), far_away});
      }
      use(group);
    });
    return;
  }
  const Ordered ordered = order(queries, context);
  const std::size_t count = queries.size();
  PointResults results{Buffer<float>(count), Buffer<std::uint32_t>(count), Buffer<std::uint32_t>(count)};
  PointJob job;
  job.field.sites = &placed_.records;
  job.field.forest = &placed_.forest;
  job.field.cancel = context.cancel;
  job.points = &ordered.points;
  job.results = &results;
  const std::vector<PointCell> cells = point_cells(ordered.points, thread_count(context));
  struct Worker {
    PointScratch scratch;
    std::vector<FoundSite> group;
  };
  std::vector<Worker> workers(static_cast<std::size_t>(thread_count(context)));
  const auto compute = [&](const WorkRange& range) {
    Worker& mine = workers[static_cast<std::size_t>(range.worker)];
    const PointCell& cell = cells[range.begin];
    compute_point_cell(job, cell, mine.scratch);
    if (context.cancel.stop_requested()) return;
    for (std::size_t begin = cell.begin; begin < cell.end; begin += most_per_group) {
      const std::size_t end = std::min(begin + most_per_group, cell.end);
      mine.group.resize(end - begin);
      for (std::size_t k = begin; k < end; ++k) {
        prefetch(queries[ordered.order[k].index]);
        mine.group[k - begin] = {ordered.order[k].index, known_site(results.site[k]), known_site(results.other[k]),
                                 results.squared[k]};
      }
      use(mine.group);
    }
  };
  parallel_for(context, cells.size(), 1, "closest points", compute, Start::at_once);
}

}  // namespace blum::cpu
