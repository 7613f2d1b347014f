#include "field/cpu/engine.hpp"

#include <algorithm>

#include "blum/core/parallel.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "field/cpu/second_kernel.hpp"

namespace blum::cpu {
namespace {

/// Fields above 16 MB are not expected to stay in the caches.
constexpr std::size_t fewest_streamed_nodes = std::size_t{1} << 21;

/// Unit vertex pseudonormals in the grid's axes.
std::vector<Vec3f> vertex_sides(const MeshView& mesh, const SiteTable& sites, const NormalFrame& frame,
                                const Context& context) {
  const Pseudonormals normals(mesh, sites, context);
  std::vector<Vec3f> sides(mesh.vertices.size());
  parallel_for(context, sides.size(), 1 << 14, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      const Vec3d normal = frame.direction.transposed_times(normals.normal(SiteId(static_cast<std::uint32_t>(v))));
      const double size = length(normal);
      if (size > 0) {
        sides[v] = {static_cast<float>(normal.x / size), static_cast<float>(normal.y / size),
                    static_cast<float>(normal.z / size)};
      }
    }
  });
  return sides;
}

/// Cuts a grid into tiles of at most `size` nodes a side.
struct Tiling {
  std::array<std::int64_t, 3> grid;
  std::int64_t size;
  std::array<std::int64_t, 3> tiles{};

  Tiling(const std::array<std::int64_t, 3>& grid_size, std::int64_t tile) : grid(grid_size), size(tile) {
    for (std::size_t axis = 0; axis < 3; ++axis) tiles[axis] = (grid[axis] + size - 1) / size;
  }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(tiles[0] * tiles[1] * tiles[2]); }
  [[nodiscard]] NodeBox box(std::size_t index) const {
    const auto i = static_cast<std::int64_t>(index);
    const std::array<std::int64_t, 3> at{i % tiles[0], i / tiles[0] % tiles[1], i / (tiles[0] * tiles[1])};
    NodeBox out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.first[axis] = at[axis] * size;
      out.count[axis] = std::min(size, grid[axis] - out.first[axis]);
    }
    return out;
  }
};

}  // namespace

void Engine::set_mesh(const MeshView& mesh, const Context& context) {
  mesh_ = mesh;
  if (connectivity_.holds(mesh)) return;
  connectivity_.clear();
  sites_ = SiteTable(mesh, context);
  build_adjacency(mesh, sites_, context, adjacency_);
  connectivity_.store(mesh);
}

void Engine::build_records(const FieldRequest& request, const Context& context) {
  frame_ = make_normal_frame(mesh_, adjacency_.named_vertices, request.grid);
  placed_.build(mesh_, sites_, adjacency_, frame_, context);
}

FieldJob Engine::make_job(const GridSpec& grid, const Context& context) const {
  FieldJob job;
  job.request.grid = grid;
  job.first_node = frame_.first_node;
  job.spacing = frame_.spacing;
  job.to_world = static_cast<float>(1 / frame_.scale);
  job.is_streamed = grid.node_count() > fewest_streamed_nodes;
  job.cancel = context.cancel;
  return job;
}

FieldResult Engine::compute(const FieldRequest& request, const Context& context, std::vector<PhaseTime>& phases) {
  PhaseTimer timer(phases);
  build_records(request, context);
  FieldJob job = make_job(request.grid, context);
  job.request = request;
  job.sites = &placed_.records;
  job.forest = &placed_.forest;
  if (request.has_band()) job.band = static_cast<float>(request.band * frame_.scale);
  const bool by_normals = request.sign == sign::Method::pseudonormals;
  if (by_normals) job.vertex_sides = vertex_sides(mesh_, sites_, frame_, context);
  timer.lap("sites and hierarchy");

  const Tiling tiling(request.grid.size, tile_size(request.grid.size));
  scratch_.resize(static_cast<std::size_t>(thread_count(context)));
  for (TileScratch& scratch : scratch_) scratch.unsettled.clear();
  parallel_for(context, tiling.count(), 1, "field", [&](const WorkRange& range) {
    for (std::size_t tile = range.begin; tile < range.end; ++tile) {
      compute_tile(job, tiling.box(tile), scratch_[static_cast<std::size_t>(range.worker)]);
    }
  });
  FieldResult result;
  result.is_signed = by_normals;
  std::vector<std::size_t>& unsettled = result.unsettled;
  for (const TileScratch& scratch : scratch_) {
    unsettled.insert(unsettled.end(), scratch.unsettled.begin(), scratch.unsettled.end());
  }
  std::sort(unsettled.begin(), unsettled.end());
  timer.lap("field");
  return result;
}

std::vector<std::size_t> Engine::compute_second(const SecondRequest& request, const Context& context) {
  second_.build({mesh_, sites_, adjacency_, placed_.positions, placed_.order, placed_.records}, *request.labels,
                context);
  SecondJob job = second_.job();
  job.field = make_job(request.grid, context);
  job.field.sites = &second_.records();
  job.field.forest = &second_.forest();
  job.request = request;
  const Tiling tiling(request.grid.size, tile_size(request.grid.size));
  std::vector<SecondScratch> scratch(static_cast<std::size_t>(thread_count(context)));
  parallel_for(context, tiling.count(), 1, "second order", [&](const WorkRange& range) {
    for (std::size_t tile = range.begin; tile < range.end; ++tile) {
      compute_second_tile(job, tiling.box(tile), scratch[static_cast<std::size_t>(range.worker)]);
    }
  });
  std::vector<std::size_t> unsettled;
  for (const SecondScratch& one : scratch) {
    unsettled.insert(unsettled.end(), one.unsettled.begin(), one.unsettled.end());
  }
  std::sort(unsettled.begin(), unsettled.end());
  return unsettled;
}

}  // namespace blum::cpu
