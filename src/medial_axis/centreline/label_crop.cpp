#include "medial_axis/centreline/label_crop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <span>
#include <type_traits>
#include <unordered_map>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_test.hpp"

namespace blum::centrelines {
namespace {

constexpr double exact_integer_limit = 9007199254740992.0;  // 2^53

template <class T>
bool is_label(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::trunc(value) == value && std::abs(static_cast<double>(value)) <= exact_integer_limit;
  } else {
    return std::in_range<std::int64_t>(value);
  }
}

/// Adds the voxels [i, end) of a row.
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

/// Calls visit(value, begin, end, j, k) for the runs of equal values of one layer.
template <class T, class Visit>
void for_each_run(std::span<const T> values, const Place& size, std::int64_t k, const Visit& visit) {
  for (std::int64_t j = 0; j < size[1]; ++j) {
    const T* row = values.data() + static_cast<std::size_t>((k * size[1] + j) * size[0]);
    for (std::int64_t i = 0; i < size[0];) {
      const std::int64_t begin = i;
      const T value = row[i];
      ++i;  // also past what equals nothing: NaN
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
    throw InvalidImage("the image has values that are no whole numbers, such as " +
                       exact_text(static_cast<double>(other)) + ", so that they cannot be labels: give a threshold");
  }
  std::vector<LabelBox> out;
  for (auto& [label, box] : all) {
    box.label = label;
    out.push_back(box);
  }
  return out;
}

}  // namespace

std::vector<LabelBox> label_boxes(const VoxelImageView& image, const Context& context) {
  return std::visit([&](const auto& values) { return boxes(values, image.grid.size, context); }, image.values);
}

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

}  // namespace blum::centrelines
