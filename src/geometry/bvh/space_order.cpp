#include "blum/geometry/space_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

constexpr std::size_t grain = 8192;
/// Ranges of at most this many points are not divided further.
constexpr std::size_t leaf_size = 8;
/// Ranges of at most this many points are divided down to leaves by one worker.
constexpr std::size_t local_size = 4096;

/// Point in float32. Rounding may put it on the wrong side of a cut, which is harmless.
struct Entry {
  std::array<float, 3> at{};
  std::uint32_t index = 0;
};

using Range = std::array<std::size_t, 2>;

/// Returns the index at which a range is divided. The size of the left part is a power of two; the right part is not
/// larger.
std::size_t cut_of(const Range& range) {
  return range[0] + std::bit_ceil(range[1] - range[0]) / 2;
}

std::size_t longest_axis(const Entry* begin, const Entry* end) {
  std::array<float, 3> lower = begin->at;
  std::array<float, 3> upper = begin->at;
  for (const Entry* entry = begin; entry != end; ++entry) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], entry->at[axis]);
      upper[axis] = std::max(upper[axis], entry->at[axis]);
    }
  }
  std::size_t best = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (upper[axis] - lower[axis] > upper[best] - lower[best]) best = axis;
  }
  return best;
}

/// Sort key of an entry: first the coordinate, which must not be negative, then the index.
struct KeyAlong {
  std::size_t axis;

  std::uint64_t operator()(const Entry& entry) const {
    return std::uint64_t{std::bit_cast<std::uint32_t>(entry.at[axis])} << 32U | entry.index;
  }
};

/// Moves entries with keys below `pivot` to the front, without branches. Returns the first of the other entries.
Entry* partition_below(Entry* begin, Entry* end, std::uint64_t pivot, const KeyAlong& key) {
  Entry* out = begin;
  for (Entry* entry = begin; entry != end; ++entry) {
    const Entry here = *entry;
    *entry = *out;
    *out = here;
    out += static_cast<std::ptrdiff_t>(key(here) < pivot);
  }
  return out;
}

/// Estimates a key slightly above or below the key at a given relative rank, from a small sample of the entries.
std::uint64_t key_beside(const Entry* begin, const Entry* end, double part, bool is_above, const KeyAlong& key) {
  constexpr std::size_t most = 64;
  std::array<std::uint64_t, most> sample{};
  const auto size = static_cast<std::size_t>(end - begin);
  const std::size_t count = std::min(most, size / 16 + 1);
  for (std::size_t k = 0; k < count; ++k) sample[k] = key(begin[(2 * k + 1) * size / (2 * count)]);
  std::sort(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(count));
  const auto samples = static_cast<double>(count);
  // About one standard deviation of the sample's rank.
  const double beside = std::sqrt(samples * part * (1 - part)) + 0.5;
  const double rank = part * samples + (is_above ? beside : -beside);
  return sample[static_cast<std::size_t>(std::clamp(rank, 0.0, samples - 1))];
}

/// Equivalent of std::nth_element. This function usually needs one and a half passes, with predictable branches.
void select(Entry* begin, Entry* nth, Entry* end, const KeyAlong& key) {
  constexpr std::ptrdiff_t few = 48;
  for (int round = 0; round < 8 && end - begin > few; ++round) {
    const double part = static_cast<double>(nth - begin) / static_cast<double>(end - begin);
    Entry* const middle = partition_below(begin, end, key_beside(begin, end, part, round % 2 == 0, key), key);
    (nth < middle ? end : begin) = middle;
  }
  std::nth_element(begin, nth, end, [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
}

void cut(std::vector<Entry>& entries, const Range& range) {
  Entry* const begin = entries.data() + range[0];
  Entry* const end = entries.data() + range[1];
  select(begin, entries.data() + cut_of(range), end, {longest_axis(begin, end)});
}

/// Divides a range down to leaves.
void cut_to_leaves(std::vector<Entry>& entries, const Range& range) {
  if (range[1] - range[0] <= leaf_size) {
    std::sort(entries.data() + range[0], entries.data() + range[1],
              [](const Entry& a, const Entry& b) { return a.index < b.index; });
    return;
  }
  cut(entries, range);
  cut_to_leaves(entries, {range[0], cut_of(range)});
  cut_to_leaves(entries, {cut_of(range), range[1]});
}

}  // namespace

std::vector<std::uint32_t> space_order(std::size_t count, const std::function<Vec3d(std::size_t)>& position,
                                       const Context& context) {
  std::vector<Box3> boxes(count == 0 ? 0 : (count - 1) / grain + 1);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    Box3 box;
    for (std::size_t i = range.begin; i < range.end; ++i) box.extend(position(i));
    boxes[range.begin / grain] = box;
  });
  Box3 bounds;
  for (const Box3& box : boxes) bounds.extend(box);
  const Vec3d size = count == 0 ? Vec3d{} : bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  std::vector<Entry> entries(count);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      // Adding 0 turns -0 into 0, as the sort key requires.
      const Vec3d offset = longest > 0 ? (position(i) - bounds.lower) / longest + Vec3d{} : Vec3d{};
      entries[i] = {{static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)},
                    static_cast<std::uint32_t>(i)};
    }
  });

  // Long ranges are divided in parallel, level by level; then each range is divided further separately.
  std::vector<Range> ranges{{0, count}};
  std::vector<Range> local;
  while (!ranges.empty()) {
    std::vector<Range> long_ranges;
    for (const Range& range : ranges) (range[1] - range[0] > local_size ? long_ranges : local).push_back(range);
    parallel_for(
        context, long_ranges.size(), 1, "",
        [&](const WorkRange& work) {
          for (std::size_t i = work.begin; i < work.end; ++i) cut(entries, long_ranges[i]);
        },
        Start::at_once);
    ranges.clear();
    for (const Range& range : long_ranges) {
      ranges.push_back({range[0], cut_of(range)});
      ranges.push_back({cut_of(range), range[1]});
    }
  }
  parallel_for(context, local.size(), 1, "", [&](const WorkRange& work) {
    for (std::size_t i = work.begin; i < work.end; ++i) cut_to_leaves(entries, local[i]);
  });
  std::vector<std::uint32_t> order(count);
  std::transform(entries.begin(), entries.end(), order.begin(), [](const Entry& entry) { return entry.index; });
  return order;
}

}  // namespace blum
