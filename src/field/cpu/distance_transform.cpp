#include "field/cpu/distance_transform.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "field/cpu/distance_transform_kernels.hpp"
#include "field/image_field.hpp"
#include "field/image_request.hpp"

namespace blum {
namespace {

using detail::ImageRequest;
using detail::TransformPlan;

TransformPlan make_plan(const GridSpec& grid, const DistanceTransformOptions& options, const Context& context) {
  TransformPlan plan;
  static_cast<ImageRequest&>(plan) = detail::make_image_request(grid, options);
  plan.x_bits = static_cast<unsigned>(std::bit_width(plan.size[0] - 1));
  plan.context = &context;
  return plan;
}

/// Working memory that is kept from one selection to the next.
struct Workspace {
  Workspace(const TransformPlan& plan, int workers)
      : squares_y(plan.size[1], plan.weight[1], plan.integer), squares_z(plan.size[2], plan.weight[2], plan.integer) {
    const std::size_t column = std::max(plan.size[1], plan.size[2]);
    scratch.reserve(static_cast<std::size_t>(workers));
    for (int worker = 0; worker < workers; ++worker) scratch.emplace_back(plan.size[0], column, plan.integer);
  }
  detail::MaskBits mask;
  detail::SquareTable squares_y, squares_z;
  std::vector<detail::PassScratch> scratch;
};

class PhaseClock {
 public:
  explicit PhaseClock(std::vector<PhaseTime>& phases) : phases_(phases) {}
  void lap(std::string phase) {
    const auto now = std::chrono::steady_clock::now();
    phases_.push_back({std::move(phase), std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

 private:
  std::vector<PhaseTime>& phases_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Largest plane (in voxels) that is one task of the x and y passes, so that it stays in cache between them. Larger
/// planes, as in 2D images, are split into several tasks.
constexpr std::size_t largest_plane_per_task = std::size_t{1} << 20U;
/// Voxels per task: enough to hide the task's overhead, and few enough to react to a cancel within milliseconds.
constexpr std::size_t task_voxels = std::size_t{1} << 16U;
/// Voxels per task of the z pass. These tasks are larger because neighbouring tiles share memory pages and DRAM rows.
constexpr std::size_t depth_task_voxels = std::size_t{1} << 18U;

/// Touches each memory page of some rows of distances, before anything is written to them. Otherwise, the z pass would
/// touch these pages first. Columns of the z pass meet a new page in every layer. So its first few tasks would map all
/// of the memory and could not react to a cancel.
void touch_distances(const TransformPlan& plan, std::size_t first_row, std::size_t last_row) {
  if (plan.site == nullptr) return;  // the x pass writes there
  constexpr std::size_t page = 4096 / sizeof(float);
  const std::size_t end = last_row * plan.size[0];
  for (std::size_t i = first_row * plan.size[0]; i < end; i += page) plan.distance[i] = 0;
}

void transform_planes(const TransformPlan& plan, Workspace& work, const Context& context) {
  const std::size_t rows = plan.size[1];
  const std::size_t plane = plan.size[0] * rows;
  const std::size_t tiles = (plan.size[0] + detail::tile_width - 1) / detail::tile_width;
  const auto columns = [&](std::size_t item, detail::PassScratch& scratch) {
    const std::size_t x = item % tiles * detail::tile_width;
    detail::transform_columns_y(plan, work.squares_y, scratch, item / tiles, x,
                                std::min(x + detail::tile_width, plan.size[0]));
  };
  if (plane <= largest_plane_per_task) {
    const std::size_t grain = std::max<std::size_t>(1, task_voxels / plane);
    parallel_for(context, plan.size[2], grain, "rows and columns", [&](const WorkRange& range) {
      detail::PassScratch& scratch = work.scratch[static_cast<std::size_t>(range.worker)];
      touch_distances(plan, range.begin * rows, range.end * rows);
      for (std::size_t z = range.begin; z < range.end; ++z) {
        detail::transform_rows(plan, scratch, z * rows, (z + 1) * rows);
        // With one row, the y pass has nothing to do: for y = 0, a packed partial site equals its x.
        if (rows == 1) continue;
        for (std::size_t tile = 0; tile < tiles; ++tile) columns(z * tiles + tile, scratch);
      }
    });
    return;
  }
  const std::size_t grain = std::max<std::size_t>(1, task_voxels / plan.size[0]);
  parallel_for(context, rows * plan.size[2], grain, "rows", [&](const WorkRange& range) {
    touch_distances(plan, range.begin, range.end);
    detail::transform_rows(plan, work.scratch[static_cast<std::size_t>(range.worker)], range.begin, range.end);
  });
  if (rows == 1) return;
  parallel_for(context, tiles * plan.size[2], 1, "columns", [&](const WorkRange& range) {
    for (std::size_t item = range.begin; item < range.end; ++item) {
      columns(item, work.scratch[static_cast<std::size_t>(range.worker)]);
    }
  });
}

void transform_depth(const TransformPlan& plan, Workspace& work, const Context& context) {
  const std::size_t tiles = (plan.size[0] + detail::tile_width - 1) / detail::tile_width;
  const std::size_t grain = std::max<std::size_t>(1, depth_task_voxels / (detail::tile_width * plan.size[2]));
  parallel_for(context, tiles * plan.size[1], grain, "depth", [&](const WorkRange& range) {
    detail::PassScratch& scratch = work.scratch[static_cast<std::size_t>(range.worker)];
    for (std::size_t item = range.begin; item < range.end; ++item) {
      const std::size_t x = item % tiles * detail::tile_width;
      detail::transform_columns_z(plan, work.squares_z, scratch, item / tiles, x,
                                  std::min(x + detail::tile_width, plan.size[0]));
    }
  });
}

Field transform(const VoxelImageView& image, const LabelSelection& selection, const DistanceTransformOptions& options,
                TransformPlan plan, Workspace& work, const Context& context) {
  Field field;
  PhaseClock clock(field.phases);
  const std::size_t selected = detail::select_voxels(image, selection, plan.size[0], context, work.mask);
  plan.selection = selection;
  detail::check_selected(selected, image, plan);
  clock.lap("select voxels");
  detail::begin_field(image, options, plan, field);
  plan.partial = plan.site != nullptr ? plan.site : reinterpret_cast<std::uint32_t*>(plan.distance);
  plan.mask = work.mask.words.data();
  plan.mask_words_per_row = work.mask.words_per_row;
  transform_planes(plan, work, context);
  clock.lap("rows and columns");
  transform_depth(plan, work, context);
  clock.lap("depth");
  return field;
}

}  // namespace

namespace cpu {

std::vector<Field> distance_transforms(const VoxelImageView& image, std::span<const LabelSelection> selections,
                                       const DistanceTransformOptions& options, const Context& context) {
  const TransformPlan plan = make_plan(image.grid, options, context);
  Workspace work(plan, thread_count(context));
  std::vector<Field> fields;
  fields.reserve(selections.size());
  for (const LabelSelection& selection : selections) {
    fields.push_back(transform(image, selection, options, plan, work, context));
  }
  return fields;
}

}  // namespace cpu
}  // namespace blum
