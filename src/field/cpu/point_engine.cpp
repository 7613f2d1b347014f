#include "field/cpu/point_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "field/kernels/morton.hpp"
#include "hwy/cache_control.h"

namespace blum::cpu {
namespace {

constexpr std::size_t grain = std::size_t{1} << 13;
/// Queries are scattered in memory, so they are prefetched this many queries before their use.
constexpr std::size_t ahead = 40;
constexpr std::size_t most_records = std::size_t{1} << 30;
constexpr double infinite = std::numeric_limits<double>::infinity();
/// Bound on the error of a distance in single precision, in the normalised frame.
constexpr double slack = 2e-6;

/// Numbers below 1024 with spread bits. A table takes half the time of kernels::spread_bits().
constexpr auto spread_numbers = [] {
  std::array<std::uint32_t, std::size_t{1} << morton_levels> out{};
  for (std::uint32_t x = 0; x < out.size(); ++x) out[x] = kernels::spread_bits(x);
  return out;
}();

Vec3d clamped(const Vec3d& p, const Box3& box) {
  Vec3d out;
  for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = std::clamp(p[axis], box.lower[axis], box.upper[axis]);
  return out;
}

void prefetch(const Vec3d& query) {
  hwy::Prefetch(&query.x);
  hwy::Prefetch(&query.z);  // the end of the query may be in the next cache line
}

/// Returns a grid of two nodes per side. The grid's box is the mesh's box, widened on each side by a quarter of the
/// longest side. Most queries are expected to lie within it.
GridSpec frame_grid(const Box3& bounds) {
  const Vec3d size = bounds.size();
  const double margin = 0.25 * std::max({size.x, size.y, size.z});
  GridSpec grid;
  grid.origin = bounds.lower - Vec3d{margin, margin, margin};
  grid.spacing = size + Vec3d{2 * margin, 2 * margin, 2 * margin};
  grid.size = {2, 2, 2};
  return grid;
}

/// Returns the box around points.
Box3 box_of(std::span<const Vec3d> points, const Context& context) {
  std::vector<Box3> boxes((points.size() + grain - 1) / grain);
  parallel_for(context, points.size(), grain, "", [&](const WorkRange& range) {
    Box3 box;
    for (std::size_t i = range.begin; i < range.end; ++i) box.extend(points[i]);
    boxes[range.begin / grain] = box;
  });
  Box3 box;
  for (const Box3& one : boxes) box.extend(one);
  return box;
}

/// Sorts queries into buckets by the first bits of their Morton codes, with all threads. The order does not depend on
/// the number of threads: queries of a bucket keep their order.
class Spread {
 public:
  explicit Spread(std::size_t count)
      : level_(count < few    ? 2
               : count < many ? 3
                              : 4),
        shift_(3 * (morton_levels - level_)),
        per_part_(std::max(grain, (count + most_parts - 1) / most_parts)),
        starts_(((count + per_part_ - 1) / per_part_) << (3 * level_), 0) {}

  /// @param code_of  callable: query -> Morton code.
  template <class CodeOf>
  Buffer<detail::KeyedIndex> sort(const CodeOf& code_of, std::span<const Vec3d> queries, const Context& context) {
    Buffer<std::uint32_t> codes(queries.size());
    parallel_for(context, queries.size(), per_part_, "", [&](const WorkRange& range) {
      std::uint32_t* counts = part(range.begin / per_part_);
      for (std::size_t i = range.begin; i < range.end; ++i) ++counts[(codes[i] = code_of(queries[i])) >> shift_];
    });
    sum();
    Buffer<detail::KeyedIndex> order(queries.size());
    parallel_for(context, queries.size(), per_part_, "", [&](const WorkRange& range) {
      std::uint32_t* next = part(range.begin / per_part_);
      for (std::size_t i = range.begin; i < range.end; ++i) {
        order[next[codes[i] >> shift_]++] = {codes[i], static_cast<std::uint32_t>(i)};
      }
    });
    return order;
  }

  /// Sorts each bucket of more than `most` queries by all bits. Must follow sort().
  void sort_large_buckets(Buffer<detail::KeyedIndex>& order, std::size_t most, const Context& context) {
    std::vector<std::span<detail::KeyedIndex>> large;
    const std::uint32_t* ends = part((order.size() - 1) / per_part_);
    std::uint32_t begin = 0;
    for (std::size_t bucket = 0; bucket < buckets(); begin = ends[bucket++]) {
      if (ends[bucket] - begin > most) large.push_back(order.span().subspan(begin, ends[bucket] - begin));
    }
    parallel_for(context, large.size(), 1, "", [&](const WorkRange& range) {
      std::vector<detail::KeyedIndex> sorted(large[range.begin].begin(), large[range.begin].end());
      detail::radix_sort(sorted);
      std::copy(sorted.begin(), sorted.end(), large[range.begin].begin());
    });
  }

 private:
  /// More buckets would not fit in the caches, if there are too few queries to fill them.
  static constexpr std::size_t few = std::size_t{1} << 13;
  static constexpr std::size_t many = std::size_t{1} << 16;
  static constexpr std::size_t most_parts = 32;

  [[nodiscard]] std::size_t buckets() const { return std::size_t{1} << (3 * level_); }
  /// Returns, for each bucket, the place of the next query of a part. Before sum(), it is the number of queries.
  [[nodiscard]] std::uint32_t* part(std::size_t index) { return starts_.data() + index * buckets(); }

  void sum() {
    std::uint32_t start = 0;
    for (std::size_t bucket = 0; bucket < buckets(); ++bucket) {
      for (std::size_t at = bucket; at < starts_.size(); at += buckets()) start += std::exchange(starts_[at], start);
    }
  }

  unsigned level_;
  unsigned shift_;
  std::size_t per_part_;
  std::vector<std::uint32_t> starts_;
};

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
  // The kernels use some bits of an index for the kind of the site.
  is_usable_ = mesh.vertices.size() <= most_records && sites.edge_count() <= most_records;
}

double PointEngine::margin() const {
  return slack / frame_.scale;
}

/// Returns the position of a query in the normalised frame, whose axes are those of the mesh. Queries outside of the
/// box are moved to its border.
inline Vec3f PointEngine::position(const Vec3d& query) const {
  return kernels::to_float((clamped(query, box_) - frame_.center) * frame_.scale);
}

/// Queries grouped by cells of the Morton curve. Within cells they are in order only as far as PointCells need it.
struct PointEngine::Ordered {
  Buffer<detail::KeyedIndex> order;  ///< the key is the Morton code of the query's cell
  std::vector<PointCell> cells;
};

PointEngine::Ordered PointEngine::order(std::span<const Vec3d> queries, const Context& context) const {
  const Box3 box = box_of(queries, context);
  const Vec3d lower = kernels::to_double(position(box.lower));
  const Vec3d size = kernels::to_double(position(box.upper)) - lower;
  const double side = std::max({size.x, size.y, size.z});
  constexpr std::uint32_t cells = 1U << morton_levels;
  constexpr double last = cells - 1;
  const double scale = side > 0 ? cells / side : 0;
  const auto code_of = [&](const Vec3d& query) {
    const Vec3d at = (kernels::to_double(position(query)) - lower) * scale;
    std::uint32_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto cell = static_cast<std::int32_t>(std::min(std::max(at[axis], 0.0), last));
      code |= spread_numbers[static_cast<std::size_t>(cell)] << axis;
    }
    return code;
  };
  Ordered out;
  Spread spread(queries.size());
  out.order = spread.sort(code_of, queries, context);
  const std::size_t most = most_per_cell(queries.size(), thread_count(context));
  spread.sort_large_buckets(out.order, most, context);
  const double half = side / 2;
  const Vec3d center = lower + Vec3d{half, half, half};
  const PointCell root{0, queries.size(), 0, kernels::to_float(center), static_cast<float>(half)};
  out.cells = point_cells(out.order.span(), root, most);
  return out;
}

/// Data of the cell that a thread computes. All of it fits in the L2 cache.
struct PointEngine::Worker {
  PointScratch scratch;
  std::vector<detail::KeyedIndex> order, order_scratch;
  std::vector<Vec3d> queries;  ///< in the order of the points
  MortonPoints points;
  PointResults results;

  void make_room(std::size_t count) {
    if (results.squared.size() >= count) return;
    const std::size_t room = count + count / 2;
    for (Buffer<float>& coordinate : points.coordinate) coordinate = Buffer<float>(room + MortonPoints::padding);
    results = {Buffer<float>(room), Buffer<std::uint32_t>(room), Buffer<std::uint32_t>(room)};
    queries.resize(room);
  }
};

/// Sorts the points of a cell, and loads their coordinates.
void PointEngine::load(std::span<const Vec3d> queries, MortonOrder order, Worker& worker) const {
  worker.order.assign(order.begin(), order.end());
  const auto is_before = [](const detail::KeyedIndex& a, const detail::KeyedIndex& b) { return a.key < b.key; };
  if (!std::is_sorted(order.begin(), order.end(), is_before)) detail::radix_sort(worker.order, worker.order_scratch);
  const std::size_t count = order.size();
  worker.make_room(count);
  worker.points.order = worker.order;
  for (std::size_t k = 0; k < count; ++k) {
    if (k + ahead < count) prefetch(queries[worker.order[k + ahead].index]);
    const Vec3d& query = worker.queries[k] = queries[worker.order[k].index];
    const Vec3f at = position(query);
    for (std::size_t axis = 0; axis < 3; ++axis) worker.points.coordinate[axis][k] = at[axis];
  }
  for (Buffer<float>& coordinate : worker.points.coordinate) {
    std::fill_n(coordinate.data() + count, MortonPoints::padding, 0.0F);
  }
}

double PointEngine::at_most(const Vec3d& query, const FoundSite& found) const {
  if (!(found.squared < far_away)) return infinite;
  const double moved = length(query - clamped(query, box_));
  const double normalised = std::sqrt(static_cast<double>(found.squared)) * (1 + 1e-6) + slack;
  return normalised / frame_.scale + moved * (1 + 1e-12);
}

void PointEngine::for_each_group(std::span<const Vec3d> queries, const Context& context,
                                 FunctionRef<void(const FoundGroup&)> use) const {
  if (!is_usable_) {
    parallel_for(context, queries.size(), most_per_group, "closest points", [&](const WorkRange& range) {
      std::array<detail::KeyedIndex, most_per_group> order;
      std::array<std::uint32_t, most_per_group> site;
      std::array<float, most_per_group> squared;
      const std::size_t count = range.end - range.begin;
      for (std::size_t k = 0; k < count; ++k) order[k] = {0, static_cast<std::uint32_t>(range.begin + k)};
      site.fill(dead_record);
      squared.fill(far_away);
      use({queries.subspan(range.begin, count), order, site, site, squared});
    });
    return;
  }
  const Ordered ordered = order(queries, context);
  PointJob job;
  job.field.sites = &placed_.records;
  job.field.forest = &placed_.forest;
  job.field.cancel = context.cancel;
  std::vector<Worker> workers(static_cast<std::size_t>(thread_count(context)));
  const auto compute = [&](const WorkRange& range) {
    Worker& mine = workers[static_cast<std::size_t>(range.worker)];
    const PointCell& cell = ordered.cells[range.begin];
    load(queries, {ordered.order.data() + cell.begin, cell.size()}, mine);
    PointJob own = job;
    own.points = &mine.points;
    own.results = &mine.results;
    compute_point_cell(own, {0, cell.size(), cell.level, cell.center, cell.half}, mine.scratch);
    if (context.cancel.stop_requested()) return;
    for (std::size_t begin = 0; begin < cell.size(); begin += most_per_group) {
      const std::size_t count = std::min(most_per_group, cell.size() - begin);
      use({std::span(mine.queries).subspan(begin, count), std::span(mine.order).subspan(begin, count),
           mine.results.site.span().subspan(begin, count), mine.results.other.span().subspan(begin, count),
           mine.results.squared.span().subspan(begin, count)});
    }
  };
  parallel_for(context, ordered.cells.size(), 1, "closest points", compute, Start::at_once);
}

}  // namespace blum::cpu
