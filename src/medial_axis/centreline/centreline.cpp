#include "blum/medial_axis/centreline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/plural.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/grid/voxel_test.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/centreline/curve_geometry.hpp"
#include "medial_axis/centreline/curve_graph.hpp"
#include "medial_axis/centreline/prune_spurs.hpp"
#include "medial_axis/centreline/sections.hpp"
#include "medial_axis/centreline/thin_to_curves.hpp"

namespace blum::centrelines {
namespace {

using Place = std::array<std::int64_t, 3>;

/// Number of the image's voxels with one value, and the box around these voxels.
struct LabelBox {
  std::int64_t label = 0;
  std::uint64_t voxels = 0;
  Place low{};   ///< lower corner
  Place high{};  ///< upper corner; voxel `high` belongs to the box
};

/// Number of layers of voxels around the box of a label that crop() adds on each side.
inline constexpr std::int64_t margin = 2;

constexpr double exact_integer_limit = 9007199254740992.0;  // 2^53

template <class T>
bool is_label(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::trunc(value) == value && std::abs(static_cast<double>(value)) <= exact_integer_limit;
  } else {
    return std::in_range<std::int64_t>(value);
  }
}

/// Adds the voxels i to end - 1 of row (j, k) to a box.
void extend(LabelBox& box, std::int64_t i, std::int64_t end, std::int64_t j, std::int64_t k) {
  const Place low{i, j, k};
  const Place high{end - 1, j, k};
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = box.voxels == 0 ? low[a] : std::min(box.low[a], low[a]);
    box.high[a] = box.voxels == 0 ? high[a] : std::max(box.high[a], high[a]);
  }
  box.voxels += static_cast<std::uint64_t>(end - i);
}

void join(LabelBox& box, const LabelBox& other) {
  if (other.voxels == 0) return;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = box.voxels == 0 ? other.low[a] : std::min(box.low[a], other.low[a]);
    box.high[a] = box.voxels == 0 ? other.high[a] : std::max(box.high[a], other.high[a]);
  }
  box.voxels += other.voxels;
}

/// Calls visit(value, begin, end, j) for each run of equal values in a row j of layer k.
template <class T, class Visit>
void for_each_run(std::span<const T> values, const Place& size, std::int64_t k, const Visit& visit) {
  for (std::int64_t j = 0; j < size[1]; ++j) {
    const T* row = values.data() + static_cast<std::size_t>((k * size[1] + j) * size[0]);
    for (std::int64_t i = 0; i < size[0];) {
      const std::int64_t begin = i;
      const T value = row[i];
      ++i;  // also for NaN, which is not equal to itself
      while (i < size[0] && row[i] == value) ++i;
      visit(value, begin, i, j);
    }
  }
}

template <class T>
std::vector<LabelBox> boxes(std::span<const T> values, const Place& size, const Context& context) {
  std::map<std::int64_t, LabelBox> all;
  std::mutex guard;
  bool are_labels = true;
  T other{};
  parallel_for(context, static_cast<std::size_t>(size[2]), 4, "labels", [&](const WorkRange& range) {
    std::unordered_map<std::int64_t, LabelBox> found;
    bool are = true;
    T wrong{};
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto layer = static_cast<std::int64_t>(k);
      for_each_run(values, size, layer, [&](T value, std::int64_t begin, std::int64_t end, std::int64_t j) {
        if (!detail::Nonzero<T>{}(value)) return;
        if (is_label(value)) return extend(found[static_cast<std::int64_t>(value)], begin, end, j, layer);
        wrong = are ? value : wrong;
        are = false;
      });
    }
    const std::lock_guard lock(guard);
    for (const auto& [label, box] : found) join(all[label], box);
    if (!are) other = are_labels ? wrong : std::min(other, wrong);
    are_labels = are_labels && are;
  });
  if (!are_labels) {
    throw InvalidImage("the image has values that are not whole numbers, for example " +
                       exact_text(static_cast<double>(other)) + ", which cannot be labels: give a threshold");
  }
  std::vector<LabelBox> out;
  for (auto& [label, box] : all) {
    box.label = label;
    out.push_back(box);
  }
  return out;
}

/// Returns the boxes of all values of the image except 0, ascending by value.
/// @throws InvalidImage if a value is not a whole number; Cancelled.
std::vector<LabelBox> label_boxes(const VoxelImageView& image, const Context& context) {
  return std::visit([&](const auto& values) { return boxes(values, image.grid.size, context); }, image.values);
}

/// Returns the box of the selected voxels; an empty box if no voxel is selected.
LabelBox selection_box(const VoxelImageView& image, const LabelSelection& selection, const Context& context) {
  const Place& size = image.grid.size;
  std::vector<LabelBox> layers(static_cast<std::size_t>(size[2]));
  std::visit(
      [&]<class T>(const std::span<const T>& values) {
        std::visit(
            [&](const auto& test) {
              parallel_for(context, layers.size(), 4, "labels", [&](const WorkRange& range) {
                for (std::size_t k = range.begin; k < range.end; ++k) {
                  const auto layer = static_cast<std::int64_t>(k);
                  for_each_run(values, size, layer, [&](T value, std::int64_t begin, std::int64_t end, std::int64_t j) {
                    if (test(value)) extend(layers[k], begin, end, j, layer);
                  });
                }
              });
            },
            detail::make_voxel_test<T>(selection));
      },
      image.values);
  LabelBox box;
  for (const LabelBox& layer : layers) join(box, layer);
  return box;
}

/// Returns the selected voxels within a box. The set has two more layers of voxels on each side of the box, which are
/// not selected.
/// @throws Cancelled.
VoxelSet crop(const VoxelImageView& image, const LabelSelection& selection, const LabelBox& box,
              const Context& context) {
  Place size{};
  for (std::size_t a = 0; a < 3; ++a) size[a] = box.high[a] - box.low[a] + 1 + 2 * margin;
  VoxelSet out(size);
  std::visit(
      [&]<class T>(const std::span<const T>& values) {
        std::visit(
            [&](const auto& test) {
              const auto layers = static_cast<std::size_t>(box.high[2] - box.low[2] + 1);
              parallel_for(context, layers, 2, "", [&](const WorkRange& range) {
                for (std::size_t layer = range.begin; layer < range.end; ++layer) {
                  const std::int64_t k = box.low[2] + static_cast<std::int64_t>(layer);
                  for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j) {
                    const T* row = values.data() + image.grid.index(0, j, k);
                    const auto words = out.row(j - box.low[1] + margin, k - box.low[2] + margin);
                    for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) {
                      const std::int64_t at = i - box.low[0] + margin;
                      words[static_cast<std::size_t>(at / 64)] |= static_cast<std::uint64_t>(test(row[i])) << (at % 64);
                    }
                  }
                }
              });
            },
            detail::make_voxel_test<T>(selection));
      },
      image.values);
  return out;
}

}  // namespace
}  // namespace blum::centrelines

namespace blum {
namespace {

constexpr std::size_t most_warnings = 5;

Warning warning_of(const Centreline& line) {
  const std::string label = line.label ? std::to_string(*line.label) : "";
  if (line.voxels > 0) {
    return {WarningCode::other_topology, (line.label ? "label " + label + ": " : "") + line.homotopy};
  }
  return {WarningCode::nothing_found,
          line.label ? "no voxel has the label " + label : "no voxel reaches the threshold"};
}

}  // namespace
namespace centrelines {
namespace {

// Number of voxels. Labels in boxes up to this size are computed in parallel, each on one thread.
constexpr std::int64_t small_box = std::int64_t{1} << 18U;

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
                 (out.label_betti[2] > 0 ? ": curves have no voids, so these were filled" : "");
}

/// Adds each voxel that shares faces with at least five voxels of the set. A pit of one voxel is usually noise.
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
          // At least five of six bits are set: at least two of each group of three, and all three of one group.
          const std::uint64_t two_here = (left & right) | (left & a) | (right & a);
          const std::uint64_t two_there = (b & c) | (b & d) | (c & d);
          to[w] |= two_here & two_there & ((left ^ right ^ a) | (b ^ c ^ d));
        }
      }
    }
  });
  return out;
}

constexpr float most_shift = 1.0F / 4096;  // voxels: less than the difference of any two distances below 1000 voxels

/// Makes equal depths of the set's voxels differ, by less than most_shift, and sets the depths of other voxels to zero.
/// Without this change, equally deep voxels would be removed in the order of their indices, from one end of a tube to
/// the other. A bar of two by two voxels would vanish, because all its voxels are equally deep.
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
          // Murmur's finalizer turns the index into pseudo-random bits.
          std::uint32_t bits = static_cast<std::uint32_t>(at) * 0x85ebca6bU;
          bits = (bits ^ bits >> 13U) * 0xc2b2ae35U;
          bits ^= bits >> 16U;
          depth[at] = is_in ? depth[at] + scale * static_cast<float>(bits & 65535U) : 0;
        }
      }
    }
  });
}

/// Returns the distance of each voxel of the box to the closest voxel outside of the set.
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
  options.sites = false;
  return std::move(distance_transform(image, options, context).distance);
}

/// Times of the phases, summed over labels. The phases of labels that are computed in parallel are not recorded.
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

/// Converts the positions of a centreline from the coordinates of a label's box to world coordinates.
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
  out.warnings = centreline_warnings(out, image.grid);
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

std::vector<Warning> centreline_warnings(const Centrelines& lines, const GridSpec& grid) {
  std::vector<Warning> out;
  if (std::count(grid.size.begin(), grid.size.end(), 1) > 0) {
    out.emplace_back(WarningCode::single_layer,
                     "the image has a single layer, treated as a plate one voxel thick: lengths and radii are not "
                     "those of a planar picture");
  }
  std::size_t unnamed = 0;
  for (const Centreline& line : lines.labels) {
    if (line.voxels > 0 && line.homotopy_kept) continue;
    if (out.size() < most_warnings) {
      out.push_back(warning_of(line));
    } else {
      ++unnamed;
    }
  }
  if (unnamed > 0) {
    out.emplace_back(WarningCode::other_topology,
                     plural(unnamed, "more label has", "more labels have") +
                         " no voxels, or another topology than their curves: see `homotopy` of each label");
  }
  if (lines.labels.empty()) out.emplace_back(WarningCode::nothing_found, "no voxel is selected");
  return out;
}

}  // namespace blum
