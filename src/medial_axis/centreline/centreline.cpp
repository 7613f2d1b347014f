#include "blum/medial_axis/centreline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/centreline/curve_geometry.hpp"
#include "medial_axis/centreline/curve_graph.hpp"
#include "medial_axis/centreline/label_crop.hpp"
#include "medial_axis/centreline/prune_spurs.hpp"
#include "medial_axis/centreline/sections.hpp"
#include "medial_axis/centreline/thin_to_curves.hpp"

namespace blum {
namespace centrelines {
namespace {

constexpr std::int64_t small_box = std::int64_t{1} << 18U;  // voxels: labels in such boxes share the threads

std::string counted(std::int64_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string betti_sentence(const BettiNumbers& betti) {
  return counted(betti[0], "component") + ", " + counted(betti[1], "tunnel") + " and " + counted(betti[2], "void");
}

void judge_homotopy(Centreline& out) {
  out.homotopy_kept = out.label_betti == out.graph_betti;
  if (out.homotopy_kept) {
    out.homotopy = "kept: " + betti_sentence(out.label_betti);
    return;
  }
  out.homotopy = "the voxels have " + betti_sentence(out.label_betti) + ", the curves " +
                 betti_sentence(out.graph_betti) +
                 (out.label_betti[2] > 0 ? ": curves hold no voids, so that these were filled" : "");
}

/// Adds voxels of which at least five of the six beside them are there: pits one voxel wide, as noise makes them.
VoxelSet without_pits(const VoxelSet& voxels, const Context& context) {
  VoxelSet out = voxels;
  const auto& size = voxels.size();
  parallel_for(context, static_cast<std::size_t>(size[2]), 4, "", [&](const WorkRange& range) {
    for (std::size_t layer = range.begin; layer < range.end; ++layer) {
      const auto k = static_cast<std::int64_t>(layer);
      if (k == 0 || k + 1 == size[2]) continue;
      for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
        const auto own = voxels.row(j, k);
        const std::array<std::span<const std::uint64_t>, 4> beside{voxels.row(j - 1, k), voxels.row(j + 1, k),
                                                                   voxels.row(j, k - 1), voxels.row(j, k + 1)};
        const auto to = out.row(j, k);
        for (std::size_t w = 0; w < own.size(); ++w) {
          const std::uint64_t left = own[w] << 1U | (w > 0 ? own[w - 1] >> 63U : 0);
          const std::uint64_t right = own[w] >> 1U | (w + 1 < own.size() ? own[w + 1] << 63U : 0);
          const std::uint64_t a = beside[0][w];
          const std::uint64_t b = beside[1][w];
          const std::uint64_t c = beside[2][w];
          const std::uint64_t d = beside[3][w];
          // Of three and three bits: two or more on both sides, and on one of them three or one besides.
          const std::uint64_t two_here = (left & right) | (left & a) | (right & a);
          const std::uint64_t two_there = (b & c) | (b & d) | (c & d);
          to[w] |= two_here & two_there & ((left ^ right ^ a) | (b ^ c ^ d));
        }
      }
    }
  });
  return out;
}

constexpr float most_shift = 1.0F / 4096;  // of a voxel: below the steps of distances up to a thousand voxels

/// Makes equal depths differ, by less than most_shift of a voxel, and those of other voxels zero. In the order of their
/// indices equally deep voxels would go from one end of a tube to the other, and the tube with them: a bar of two by
/// two voxels has no deeper ones.
void separate(Buffer<float>& depth, const VoxelSet& voxels, const Vec3d& spacing, const Context& context) {
  const auto& size = voxels.size();
  const float scale = most_shift * static_cast<float>(std::min({spacing.x, spacing.y, spacing.z})) / 65536.0F;
  parallel_for(context, static_cast<std::size_t>(size[2]), 4, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      std::size_t at = k * static_cast<std::size_t>(size[0] * size[1]);
      for (std::int64_t j = 0; j < size[1]; ++j) {
        const auto row = voxels.row(j, static_cast<std::int64_t>(k));
        for (std::int64_t i = 0; i < size[0]; ++i, ++at) {
          const bool is_in = (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U) != 0;
          // Murmur's finalizer: bits that tell nothing of the place.
          std::uint32_t bits = static_cast<std::uint32_t>(at) * 0x85ebca6bU;
          bits = (bits ^ bits >> 13U) * 0xc2b2ae35U;
          bits ^= bits >> 16U;
          depth[at] = is_in ? depth[at] + scale * static_cast<float>(bits & 65535U) : 0;
        }
      }
    }
  });
}

/// The distance of each voxel to the closest one that is not there.
Buffer<float> depth_of(const VoxelSet& voxels, const Vec3d& spacing, const Context& context) {
  const auto& size = voxels.size();
  Buffer<std::uint8_t> is_in(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  parallel_for(context, static_cast<std::size_t>(size[2]), 4, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      std::size_t at = k * static_cast<std::size_t>(size[0] * size[1]);
      for (std::int64_t j = 0; j < size[1]; ++j) {
        const auto row = voxels.row(j, static_cast<std::int64_t>(k));
        for (std::int64_t i = 0; i < size[0]; ++i, ++at) {
          is_in[at] = static_cast<std::uint8_t>(row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U);
        }
      }
    }
  });
  VoxelImageView image;
  image.grid.size = size;
  image.grid.spacing = spacing;
  image.values = std::span<const std::uint8_t>(is_in.span());
  DistanceTransformOptions options;
  options.selection = LabelSelection::of_label(0);
  options.is_signed = false;
  return std::move(distance_transform(image, options, context).distance);
}

/// The phases of all labels; a label's own where several run at once are not told.
struct Times {
  std::vector<PhaseTime> phases;
  PhaseTimer timer{phases};
};

Centreline centreline_of(VoxelSet voxels, const Vec3d& spacing, double spur, const Context& context, Times& times) {
  Centreline out;
  out.voxels = voxels.count();
  out.label_betti = betti_numbers(voxels, context);
  if (out.label_betti[2] > 0) fill_voids(voxels, context);
  times.timer.lap("topology");
  Buffer<float> depth = depth_of(without_pits(voxels, context), spacing, context);
  separate(depth, voxels, spacing, context);
  times.timer.lap("distance");
  const VoxelSet thin = thin_to_curves(voxels, depth.span(), spacing, context);
  times.timer.lap("thinning");
  CurveGraph graph = curve_graph(thin, spacing, context);
  const ChainMeasure measure{depth.span(), voxels.size(), spacing};
  prune_spurs(graph, measure, spur, context);
  out.graph_betti = betti_numbers(graph);
  times.timer.lap("graph");
  place_curves(graph, measure, LabelShare(depth.span(), voxels.size(), spacing), out, context);
  times.timer.lap("curves");
  judge_homotopy(out);
  return out;
}

/// From the box of a label to the world.
void move_to_world(const GridSpec& grid, const LabelBox& box, Centreline& line) {
  const Vec3d shift{static_cast<double>(box.low[0] - margin) * grid.spacing.x,
                    static_cast<double>(box.low[1] - margin) * grid.spacing.y,
                    static_cast<double>(box.low[2] - margin) * grid.spacing.z};
  const auto move = [&](Vec3d& point) { point = grid.origin + grid.direction * (point + shift); };
  for (CentrelineNode& node : line.nodes) move(node.position);
  for (CentrelineBranch& branch : line.branches) std::for_each(branch.points.begin(), branch.points.end(), move);
}

struct Task {
  LabelBox box;
  LabelSelection selection;
  std::optional<std::int64_t> label = {};
};

std::int64_t volume(const LabelBox& box) {
  std::int64_t product = 1;
  for (std::size_t a = 0; a < 3; ++a) product *= box.high[a] - box.low[a] + 1;
  return product;
}

Centreline run(const VoxelImageView& image, const Task& task, double spur, const Context& context, Times& times) {
  Centreline out;
  if (task.box.voxels == 0) {
    judge_homotopy(out);
  } else {
    out = centreline_of(crop(image, task.selection, task.box, context), image.grid.spacing, spur, context, times);
    move_to_world(image.grid, task.box, out);
  }
  out.label = task.label;
  return out;
}

Centrelines run_all(const VoxelImageView& image, const std::vector<Task>& tasks, const CentrelineOptions& options,
                    const Context& context) {
  if (!(options.spur >= 0 && options.spur <= 100)) throw InvalidOption("spur must be 0 to 100");
  Centrelines out;
  out.labels.resize(tasks.size());
  Times times;
  Context alone = context;
  alone.threads = 1;
  alone.progress = {};
  std::vector<std::size_t> small;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    if (tasks.size() > 1 && volume(tasks[t].box) <= small_box) {
      small.push_back(t);
    } else {
      out.labels[t] = run(image, tasks[t], options.spur, context, times);
    }
  }
  parallel_for(context, small.size(), 1, "small labels", [&](const WorkRange& range) {
    for (std::size_t s = range.begin; s < range.end; ++s) {
      Times own;
      out.labels[small[s]] = run(image, tasks[small[s]], options.spur, alone, own);
    }
  });
  if (!small.empty()) times.timer.lap("small labels");
  out.phases = std::move(times.phases);
  return out;
}

}  // namespace
}  // namespace centrelines

Centrelines centreline(const VoxelImageView& image, const CentrelineOptions& options, const Context& context) {
  using namespace centrelines;
  validate(image);
  std::vector<Task> tasks;
  const LabelSelection& selection = options.selection;
  if (selection.rule == LabelSelection::Rule::nonzero) {
    for (const LabelBox& box : label_boxes(image, context)) {
      tasks.push_back({box, LabelSelection::of_label(box.label), box.label});
    }
  } else {
    const bool is_label = selection.rule == LabelSelection::Rule::label;
    tasks.push_back({selection_box(image, selection, context), selection,
                     is_label ? std::optional(selection.label) : std::nullopt});
  }
  return run_all(image, tasks, options, context);
}

Centrelines centreline(const VoxelImageView& image, std::span<const std::int64_t> labels,
                       const CentrelineOptions& options, const Context& context) {
  using namespace centrelines;
  validate(image);
  std::vector<Task> tasks;
  if (labels.size() == 1) {
    const LabelSelection selection = LabelSelection::of_label(labels[0]);
    tasks.push_back({selection_box(image, selection, context), selection, labels[0]});
  } else {
    std::map<std::int64_t, LabelBox> boxes;
    for (const LabelBox& box : label_boxes(image, context)) boxes[box.label] = box;
    for (const std::int64_t label : labels) {
      tasks.push_back({boxes[label], LabelSelection::of_label(label), label});
    }
  }
  return run_all(image, tasks, options, context);
}

}  // namespace blum
