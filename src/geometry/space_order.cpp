#include "geometry/space_order.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

constexpr unsigned bits_per_axis = 21;
constexpr std::size_t grain = 8192;

struct Keyed {
  std::uint64_t key = 0;
  std::uint32_t index = 0;
};

/// Spreads the low 21 bits of v to every third bit.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffu;
  v = (v | v << 16) & 0x1f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  return (v | v << 2) & 0x1249249249249249u;
}

/// Skilling's transformation of cell coordinates to the transposed Hilbert index, here interleaved.
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t bit = 1u << (bits_per_axis - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& coordinate : x) {
      // Where the bit is set, invert the lower bits of x[0]; else exchange the lower bits of x[0] and x[i].
      const std::uint32_t is_set = 0u - static_cast<std::uint32_t>((coordinate & bit) != 0);
      const std::uint32_t exchanged = (x[0] ^ coordinate) & below & ~is_set;
      x[0] ^= (below & is_set) | exchanged;
      coordinate ^= exchanged;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t parity = 0;
  for (std::uint32_t bit = 1u << (bits_per_axis - 1); bit > 1; bit >>= 1) {
    parity ^= (bit - 1) & (0u - static_cast<std::uint32_t>((x[2] & bit) != 0));
  }
  return spread(x[0] ^ parity) << 2 | spread(x[1] ^ parity) << 1 | spread(x[2] ^ parity);
}

/// Stable sort by key: six passes of eleven bits; passes in which all keys agree are skipped.
void radix_sort(std::vector<Keyed>& items) {
  constexpr unsigned digit = 11;
  constexpr std::size_t buckets = std::size_t{1} << digit;
  constexpr unsigned passes = 6;
  std::vector<std::array<std::uint32_t, buckets>> counts(passes);
  for (const Keyed& item : items) {
    for (unsigned pass = 0; pass < passes; ++pass) ++counts[pass][(item.key >> (pass * digit)) & (buckets - 1)];
  }
  std::vector<Keyed> scratch(items.size());
  for (unsigned pass = 0; pass < passes; ++pass) {
    std::uint32_t start = 0;
    bool all_agree = false;
    for (std::uint32_t& count : counts[pass]) {
      all_agree = all_agree || count == items.size();
      start += std::exchange(count, start);
    }
    if (all_agree) continue;
    for (const Keyed& item : items) scratch[counts[pass][(item.key >> (pass * digit)) & (buckets - 1)]++] = item;
    items.swap(scratch);
  }
}

}  // namespace

std::vector<std::uint32_t> space_order(std::size_t count, const std::function<Vec3d(std::size_t)>& position,
                                       const Context& context) {
  const std::size_t range_count = count == 0 ? 0 : (count - 1) / grain + 1;
  std::vector<Box3> boxes(range_count);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    Box3 box;
    for (std::size_t i = range.begin; i < range.end; ++i) box.extend(position(i));
    boxes[range.begin / grain] = box;
  });
  Box3 bounds;
  for (const Box3& box : boxes) bounds.extend(box);

  // One scale for all axes, so that cells are cubes.
  constexpr double cells = static_cast<double>(1u << bits_per_axis);
  const Vec3d size = count == 0 ? Vec3d{} : bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  const auto cell = [&](double offset) {
    const double scaled = longest > 0 ? offset / longest * cells : 0.0;
    return static_cast<std::uint32_t>(std::clamp(scaled, 0.0, cells - 1));
  };
  std::vector<Keyed> keyed(count);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Vec3d offset = position(i) - bounds.lower;
      keyed[i] = {hilbert_key({cell(offset.x), cell(offset.y), cell(offset.z)}), static_cast<std::uint32_t>(i)};
    }
  });
  radix_sort(keyed);
  std::vector<std::uint32_t> order(count);
  std::transform(keyed.begin(), keyed.end(), order.begin(), [](const Keyed& item) { return item.index; });
  return order;
}

}  // namespace blum
