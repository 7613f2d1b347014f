#include "blum/field/distance_transform.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "field/cpu/distance_transform_kernels.hpp"
#include "field/cpu/distance_transform_mask.hpp"

namespace blum {
namespace {

using detail::TransformPlan;

/// Spacings as whole multiples of a common unit.
struct CommonUnit {
  std::uint64_t multiple[3] = {1, 1, 1};
  double unit = 1;
};

/// Any three doubles whose exponents do not differ too much have a common unit: a power of two times the greatest
/// common divisor of their mantissas. False where the multiples would not fit.
bool find_common_unit(const double (&spacing)[3], int used, CommonUnit& common) {
  int lowest_exponent = std::numeric_limits<int>::max();
  int exponents[3] = {};
  std::uint64_t mantissas[3] = {};
  for (int axis = 0; axis < used; ++axis) {
    mantissas[axis] = static_cast<std::uint64_t>(std::ldexp(std::frexp(spacing[axis], &exponents[axis]), 53));
    const int zeros = std::countr_zero(mantissas[axis]);
    mantissas[axis] >>= static_cast<unsigned>(zeros);
    exponents[axis] += zeros - 53;
    lowest_exponent = std::min(lowest_exponent, exponents[axis]);
  }
  std::uint64_t divisor = 0;
  for (int axis = 0; axis < used; ++axis) {
    const int shift = exponents[axis] - lowest_exponent;
    if (shift > std::countl_zero(mantissas[axis])) return false;
    common.multiple[axis] = mantissas[axis] << static_cast<unsigned>(shift);
    divisor = std::gcd(divisor, common.multiple[axis]);
  }
  for (int axis = 0; axis < used; ++axis) common.multiple[axis] /= divisor;
  common.unit = std::ldexp(static_cast<double>(divisor), lowest_exponent);
  return true;
}

/// Largest squared distance in the image, in units of the plan.
double largest_square(const TransformPlan& plan) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto extent = static_cast<double>(plan.size[axis] - 1);
    sum += plan.weight[axis] * extent * extent;
  }
  return sum;
}

bool is_power_of_two(double value) {
  int exponent = 0;
  return std::frexp(value, &exponent) == 0.5;
}

/// Chooses whole-number arithmetic where the spacings allow it.
void choose_arithmetic(TransformPlan& plan, const double (&spacing)[3], int used) {
  constexpr double integer_limit = 1 << 30;
  constexpr double float_limit = 1 << 24;
  CommonUnit common;
  if (find_common_unit(spacing, used, common)) {
    // A unit that is a power of two keeps the scaled root correctly rounded, so whole numbers stay undivided.
    const double whole = std::round(common.unit);
    const bool undivided = whole == common.unit && whole > 1 && whole < 1024 && !is_power_of_two(whole);
    for (const double factor : {undivided ? whole : 1.0, 1.0}) {
      for (int axis = 0; axis < used; ++axis) {
        const double multiple = factor * static_cast<double>(common.multiple[axis]);
        plan.weight[axis] = multiple * multiple;
      }
      plan.unit = common.unit / factor;
      const double largest = largest_square(plan);
      plan.integer = largest < integer_limit;
      plan.exact_in_float =
          largest < float_limit && is_power_of_two(plan.unit) && plan.unit > 1e-30 && plan.unit < 1e30;
      if (plan.integer) return;
    }
  }
  plan.integer = false;
  plan.exact_in_float = false;
  plan.unit = 1;
  // Divided by the largest spacing, so that squares neither overflow nor vanish.
  const double scale = *std::max_element(spacing, spacing + used);
  for (int axis = 0; axis < used; ++axis) plan.weight[axis] = (spacing[axis] / scale) * (spacing[axis] / scale);
  plan.unit = scale;
}

/// Beyond this, float32 would hold infinities, or nothing but zeros.
void check_extent(const GridSpec& grid) {
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] == 1) continue;
    longest = std::max(longest, grid.spacing[axis] * static_cast<double>(grid.size[axis]));
  }
  if (longest == 0) return;  // a single voxel
  if (longest >= 1e-36 && longest < 1e37) return;
  throw InvalidImage("the image spans " + exact_text(longest) +
                     " units, but 32-bit distances hold 1e-36 to 1e37: give its spacing in other units");
}

TransformPlan make_plan(const GridSpec& grid, const DistanceTransformOptions& options, const Context& context) {
  TransformPlan plan;
  double spacing[3] = {1, 1, 1};
  int used = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] == 1) continue;
    plan.size[used] = static_cast<std::size_t>(grid.size[axis]);
    spacing[used] = grid.spacing[axis];
    ++used;
  }
  check_extent(grid);
  choose_arithmetic(plan, spacing, std::max(used, 1));
  plan.is_signed = options.is_signed;
  plan.x_bits = static_cast<unsigned>(std::bit_width(plan.size[0] - 1));
  if (options.band) {
    const double band = *options.band;
    if (!(band > 0)) throw InvalidOption("the band must be a positive width, not " + exact_text(band));
    plan.has_band = band < static_cast<double>(std::numeric_limits<float>::max());
    if (plan.has_band) {
      plan.band = static_cast<float>(band);  // as distances are rounded, so that one equal to it stays within
    }
  }
  plan.context = &context;
  return plan;
}

/// Working memory that lasts over several selections.
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

/// Small planes stay in cache between the x and the y pass; large ones (2D images) are cut into more tasks.
constexpr std::size_t largest_plane_per_task = std::size_t{1} << 20U;
/// Voxels of a task: enough to hide its overhead, few enough to stop within milliseconds.
constexpr std::size_t task_voxels = std::size_t{1} << 16U;
/// In the z pass neighbouring tiles share pages and the memory's rows, so that tasks are larger.
constexpr std::size_t depth_task_voxels = std::size_t{1} << 18U;

/// Writes to each page of some rows of distances, which nothing has written yet. The depth pass would: but a column of
/// it crosses a page in every layer, so the first few tasks would wait for all of the memory, deaf to cancel.
void touch_distances(const TransformPlan& plan, std::size_t first_row, std::size_t last_row) {
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
        if (rows == 1) continue;  // nothing to do along y: a partial site of y = 0 is its x
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

std::string describe(const LabelSelection& selection) {
  switch (selection.rule) {
    case LabelSelection::Rule::nonzero:
      return "is not zero";
    case LabelSelection::Rule::label:
      return "equals label " + std::to_string(selection.label);
    case LabelSelection::Rule::threshold:
      return "reaches the threshold " + exact_text(selection.threshold);
  }
  return "is selected";
}

Field transform(const VoxelImageView& image, const LabelSelection& selection, const DistanceTransformOptions& options,
                TransformPlan plan, Workspace& work, const Context& context) {
  Field field;
  PhaseClock clock(field.phases);
  const std::size_t selected = detail::select_voxels(image, selection, plan.size[0], context, work.mask);
  if (selected == 0) {
    throw InvalidImage("no voxel of the image " + describe(selection) + ", so there is nothing to measure to");
  }
  if (options.is_signed && selected == plan.voxel_count()) {
    throw InvalidImage("every voxel of the image " + describe(selection) +
                       ", so a signed field has nothing to measure to; ask for an unsigned one or another selection");
  }
  clock.lap("select voxels");
  field.grid = image.grid;
  field.distance = Buffer<float>(plan.voxel_count());
  field.site = Buffer<SiteId>(plan.voxel_count());
  field.site_ids = SiteIds::voxels;
  field.band = options.band;
  field.sign_rule = options.is_signed ? SignRule::label : SignRule::none;
  field.sign_reason = options.is_signed ? "a voxel is inside where its value " + describe(selection)
                                        : "an unsigned field was asked for";
  plan.mask = work.mask.words.data();
  plan.mask_words_per_row = work.mask.words_per_row;
  plan.distance = field.distance.data();
  // SiteId holds nothing but its 32-bit value, and between passes the array holds partial sites.
  static_assert(sizeof(SiteId) == sizeof(std::uint32_t));
  plan.site = &field.site.data()->value;
  transform_planes(plan, work, context);
  clock.lap("rows and columns");
  transform_depth(plan, work, context);
  clock.lap("depth");
  return field;
}

}  // namespace

VoxelSet selected_voxels(const VoxelImageView& image, const LabelSelection& selection, const Context& context) {
  validate(image);
  detail::MaskBits mask;
  const auto& size = image.grid.size;
  static_cast<void>(detail::select_voxels(image, selection, static_cast<std::size_t>(size[0]), context, mask));
  VoxelSet voxels(size);
  std::size_t first = 0;
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j, first += mask.words_per_row) {
      const auto row = mask.words.span().subspan(first, mask.words_per_row);
      std::copy(row.begin(), row.end(), voxels.row(j, k).begin());
    }
  }
  return voxels;
}

std::vector<Field> distance_transforms(const VoxelImageView& image, std::span<const LabelSelection> selections,
                                       const DistanceTransformOptions& options, const Context& context) {
  validate(image);
  if (context.device.kind == DeviceKind::cuda) {
    throw InvalidOption("distance transforms of images are computed on the CPU only: ask for the device cpu or auto");
  }
  const TransformPlan plan = make_plan(image.grid, options, context);
  Workspace work(plan, thread_count(context));
  std::vector<Field> fields;
  fields.reserve(selections.size());
  for (const LabelSelection& selection : selections) {
    fields.push_back(transform(image, selection, options, plan, work, context));
  }
  return fields;
}

Field distance_transform(const VoxelImageView& image, const DistanceTransformOptions& options, const Context& context) {
  return std::move(distance_transforms(image, {&options.selection, 1}, options, context).front());
}

}  // namespace blum
