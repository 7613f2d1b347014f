// Blum: the x pass of the distance transform of images. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_DISTANCE_TRANSFORM_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_DISTANCE_TRANSFORM_ROWS_INL
#undef BLUM_FIELD_CPU_DISTANCE_TRANSFORM_ROWS_INL
#else
#define BLUM_FIELD_CPU_DISTANCE_TRANSFORM_ROWS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "field/cpu/distance_transform_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::uint32_t no_site = 0xffffffffU;

using RowTag = hn::CappedTag<std::int32_t, 16>;

/// Returns the mask bits of one group of 16 voxels of a row.
HWY_INLINE std::uint32_t group_bits(const std::uint64_t* words, std::size_t group) {
  return static_cast<std::uint32_t>(words[group / 4] >> (16 * (group % 4))) & 0xffffU;
}

/// Positions of a missing target. The closest target in a row is the last one up to x (left) or the first one from x
/// (right). `no_left` and `no_right` mean that the row has no target on this side. In unsigned arithmetic, their
/// distance exceeds that of any voxel, because rows are shorter than 2^31.
constexpr std::uint32_t no_left = 0x80000000U;
constexpr std::uint32_t no_right = 0xffffffffU;

struct RowState {
  std::uint32_t last_selected = no_left;
  std::uint32_t last_other = no_left;
};

/// Returns the index of the highest set bit of positive integers below 2^24, read from the exponent of a float.
template <class V>
HWY_INLINE V highest_bit(V bits) {
  const RowTag d;
  const hn::RebindToFloat<RowTag> df;
  return hn::Sub(hn::ShiftRight<23>(hn::BitCast(d, hn::ConvertTo(df, bits))), hn::Set(d, 127));
}

/// Returns the closer of left and right, or the left one if both are equally far.
template <class V>
HWY_INLINE V closer(V x, V left, V right) {
  const RowTag d;
  const hn::RebindToUnsigned<RowTag> du;
  const auto to_left = hn::BitCast(du, hn::Sub(x, left));
  const auto to_right = hn::BitCast(du, hn::Sub(right, x));
  return hn::IfThenElse(hn::RebindMask(d, hn::Lt(to_right, to_left)), right, left);
}

HWY_INLINE auto as_lanes(std::uint32_t value) {
  return hn::Set(RowTag(), static_cast<std::int32_t>(value));
}

/// Writes the closest targets of `lanes` voxels. At the end of a row, `lanes` may be smaller than a vector.
template <class V>
HWY_INLINE void store_lanes(V value, std::uint32_t* out, std::size_t lanes) {
  const RowTag d;
  if (lanes >= hn::Lanes(d)) {
    hn::StoreU(value, d, reinterpret_cast<std::int32_t*>(out));
  } else {
    HWY_ALIGN std::int32_t buffer[16];
    hn::Store(value, d, buffer);
    for (std::size_t i = 0; i < lanes; ++i) out[i] = static_cast<std::uint32_t>(buffer[i]);
  }
}

/// Transforms one group of 16 voxels that starts at x0. `bits` marks the selected voxels, `valid` the voxels inside the
/// row.
template <bool kSigned>
HWY_INLINE void transform_group(std::uint32_t bits, std::uint32_t valid, std::uint32_t x0, const RowState& state,
                                std::uint32_t next_selected, std::uint32_t next_other, std::uint32_t* out,
                                std::size_t lanes) {
  const RowTag d;
  const std::size_t step = hn::Lanes(d);
  const bool all_same = bits == 0 || (kSigned && bits == valid);
  for (std::size_t lane = 0; lane < lanes; lane += step) {
    const auto x = hn::Add(as_lanes(x0 + static_cast<std::uint32_t>(lane)), hn::Iota(d, 0));
    auto left = as_lanes(kSigned && bits != 0 ? state.last_other : state.last_selected);
    auto right = as_lanes(kSigned && bits != 0 ? next_other : next_selected);
    if (!all_same) {
      HWY_ALIGN std::int32_t lane_bits[16];
      for (std::size_t i = 0; i < step; ++i) lane_bits[i] = std::int32_t{1} << (lane + i);
      const auto own = hn::Load(d, lane_bits);
      const auto below = hn::Sub(own, hn::Set(d, 1));
      auto targets = as_lanes(bits);
      if constexpr (kSigned) {
        const auto selected = hn::Ne(hn::And(targets, own), hn::Zero(d));
        targets = hn::IfThenElse(selected, as_lanes(~bits & valid), targets);
        left = hn::IfThenElse(selected, as_lanes(state.last_other), as_lanes(state.last_selected));
        right = hn::IfThenElse(selected, as_lanes(next_other), as_lanes(next_selected));
      }
      const auto up_to = hn::And(targets, hn::Or(below, own));
      const auto from = hn::AndNot(below, targets);
      const auto first = hn::And(from, hn::Neg(from));
      const auto base = as_lanes(x0);
      left = hn::IfThenElse(hn::Eq(up_to, hn::Zero(d)), left, hn::Add(base, highest_bit(up_to)));
      right = hn::IfThenElse(hn::Eq(from, hn::Zero(d)), right, hn::Add(base, highest_bit(first)));
    }
    store_lanes(closer(x, left, right), out + lane, lanes - lane);
  }
}

template <bool kSigned>
void transform_row(const TransformPlan& plan, PassScratch& scratch, const std::uint64_t* words, std::uint32_t* out) {
  constexpr std::size_t groups_between_checks = std::size_t{1} << 18U;
  const std::size_t length = plan.size[0];
  const std::size_t groups = (length + 15) / 16;
  const std::uint32_t last_valid = 0xffffU >> (16 * groups - length);
  std::uint32_t* next_selected = scratch.next_selected.data();
  std::uint32_t* next_other = scratch.next_other.data();

  std::uint32_t selected = no_right;
  std::uint32_t other = no_right;
  for (std::size_t group = groups; group-- > 0;) {
    if (group % groups_between_checks == 0 && plan.context->cancel.stop_requested()) return;
    const std::uint32_t bits = group_bits(words, group);
    const std::uint32_t rest = ~bits & (group + 1 == groups ? last_valid : 0xffffU);
    const auto x0 = static_cast<std::uint32_t>(16 * group);
    next_selected[group] = selected;
    next_other[group] = other;
    if (bits != 0) selected = x0 + static_cast<std::uint32_t>(std::countr_zero(bits));
    if (rest != 0) other = x0 + static_cast<std::uint32_t>(std::countr_zero(rest));
  }
  if (selected == no_right || (kSigned && other == no_right)) {
    std::fill(out, out + length, no_site);
    return;
  }
  RowState state;
  for (std::size_t group = 0; group < groups; ++group) {
    if (group % groups_between_checks == 0 && plan.context->cancel.stop_requested()) return;
    const std::uint32_t bits = group_bits(words, group);
    const std::uint32_t valid = group + 1 == groups ? last_valid : 0xffffU;
    const std::uint32_t rest = ~bits & valid;
    const auto x0 = static_cast<std::uint32_t>(16 * group);
    transform_group<kSigned>(bits, valid, x0, state, next_selected[group], next_other[group], out + x0,
                             std::min<std::size_t>(16, length - x0));
    if (bits != 0) state.last_selected = x0 + static_cast<std::uint32_t>(std::bit_width(bits)) - 1;
    if (rest != 0) state.last_other = x0 + static_cast<std::uint32_t>(std::bit_width(rest)) - 1;
  }
}

void rows(const TransformPlan& plan, PassScratch& scratch, std::size_t begin, std::size_t end) {
  for (std::size_t row = begin; row < end; ++row) {
    const std::uint64_t* words = plan.mask + row * plan.mask_words_per_row;
    std::uint32_t* out = plan.partial + row * plan.size[0];
    if (plan.is_signed) {
      transform_row<true>(plan, scratch, words, out);
    } else {
      transform_row<false>(plan, scratch, words, out);
    }
  }
}

}  // namespace
}  // namespace blum::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // end of the per-target include guard
