// Blum: vectors of lanes for the tile kernel, compiled once per instruction set. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_LANES_INL
#undef BLUM_FIELD_CPU_LANES_INL
#else
#define BLUM_FIELD_CPU_LANES_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "field/cpu/site_records.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;
constexpr std::size_t lanes = hn::MaxLanes(D());
constexpr D d{};
constexpr DI di{};

struct Vec {
  V x, y, z;
};

HWY_INLINE V set(float value) {
  return hn::Set(d, value);
}
HWY_INLINE Vec set(const Vec3f& v) {
  return {set(v.x), set(v.y), set(v.z)};
}
HWY_INLINE Vec operator-(const Vec& a, const Vec& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec operator+(const Vec& a, const Vec& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V dot(const Vec& a, const Vec& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}
/// Returns the sum of |a_i b_i|: the largest change of a linear function with gradient a from the centre of a box with
/// half-size b >= 0.
HWY_INLINE V support(const Vec& a, const Vec& b) {
  return hn::MulAdd(hn::Abs(a.z), b.z, hn::MulAdd(hn::Abs(a.y), b.y, hn::Mul(hn::Abs(a.x), b.x)));
}
HWY_INLINE Vec cross(const Vec& a, const Vec& b) {
  return {hn::NegMulAdd(a.z, b.y, hn::Mul(a.y, b.z)), hn::NegMulAdd(a.x, b.z, hn::Mul(a.z, b.x)),
          hn::NegMulAdd(a.y, b.x, hn::Mul(a.x, b.y))};
}
HWY_INLINE V square(V a) {
  return hn::Mul(a, a);
}

/// Selects by the sign bit of v: `yes` in lanes where it is set, else `no`. Highway's own function compares values on
/// some targets. A comparison does not treat -0 as negative, and fails if the bits of an id are a NaN.
HWY_INLINE V if_sign_bit(V v, V yes, V no) {
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  return hn::IfNegativeThenElse(v, yes, no);
#else
  constexpr hn::RebindToSigned<D> ds;
  const auto mask = hn::MaskFromVec(hn::BroadcastSignBit(hn::BitCast(ds, v)));
  return hn::IfThenElse(hn::RebindMask(d, mask), yes, no);
#endif
}

/// Columns of `lanes` consecutive records: one vector per column, one lane per record.
struct Columns {
  V column[16];

  HWY_INLINE Vec vec(int at) const { return {column[at], column[at + 1], column[at + 2]}; }
};

#if HWY_TARGET != HWY_SCALAR
/// Loads four floats from every fourth record, starting with the first: `lanes / 4` records. record_at(k) returns the
/// floats of record k.
template <std::size_t lane_count = lanes, class RecordAt>
HWY_INLINE auto load_quarters(RecordAt record_at, std::size_t first) {
  constexpr hn::FixedTag<float, 4> d4;
  if constexpr (lane_count == 4) {
    return hn::Load(d4, record_at(first));
  } else if constexpr (lane_count == 8) {
    constexpr hn::FixedTag<float, lane_count> d8;
    return hn::Combine(d8, hn::Load(d4, record_at(first + 4)), hn::Load(d4, record_at(first)));
  } else {
    constexpr hn::FixedTag<float, lane_count / 2> d8;
    constexpr hn::FixedTag<float, lane_count> d16;
    const auto lower = hn::Combine(d8, hn::Load(d4, record_at(first + 4)), hn::Load(d4, record_at(first)));
    const auto upper = hn::Combine(d8, hn::Load(d4, record_at(first + 12)), hn::Load(d4, record_at(first + 8)));
    return hn::Combine(d16, upper, lower);
  }
}
#endif

/// Transposes `lanes` records into columns. record_at(k) returns the floats of record k.
template <class RecordAt>
HWY_INLINE void load_columns_of(RecordAt record_at, Columns& out) {
#if HWY_TARGET == HWY_SCALAR
  const float* base = record_at(0);
  for (int c = 0; c < 15; ++c) out.column[c] = set(base[c]);
  std::uint32_t id = 0;
  std::memcpy(&id, base + 15, sizeof(id));
  out.column[15] = hn::BitCast(d, hn::Set(di, id));
#else
  constexpr hn::Repartition<double, D> dd;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const auto at = [&](std::size_t k) { return record_at(k) + 4 * quarter; };
    const V r0 = load_quarters(at, 0);
    const V r1 = load_quarters(at, 1);
    const V r2 = load_quarters(at, 2);
    const V r3 = load_quarters(at, 3);
    const auto t0 = hn::BitCast(dd, hn::InterleaveLower(d, r0, r1));
    const auto t1 = hn::BitCast(dd, hn::InterleaveUpper(d, r0, r1));
    const auto t2 = hn::BitCast(dd, hn::InterleaveLower(d, r2, r3));
    const auto t3 = hn::BitCast(dd, hn::InterleaveUpper(d, r2, r3));
    out.column[4 * quarter] = hn::BitCast(d, hn::InterleaveLower(dd, t0, t2));
    out.column[4 * quarter + 1] = hn::BitCast(d, hn::InterleaveUpper(dd, t0, t2));
    out.column[4 * quarter + 2] = hn::BitCast(d, hn::InterleaveLower(dd, t1, t3));
    out.column[4 * quarter + 3] = hn::BitCast(d, hn::InterleaveUpper(dd, t1, t3));
  }
#endif
}

/// Transposes `lanes` consecutive records into columns.
HWY_INLINE void load_columns(const Record* records, Columns& out) {
  const float* base = records->column.data();
  load_columns_of([base](std::size_t k) { return base + 16 * k; }, out);
}

/// Converts a mask to an integer with one bit per lane.
HWY_INLINE std::uint32_t bits(M mask) {
  alignas(8) std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  return static_cast<std::uint32_t>(bytes[0]) | (static_cast<std::uint32_t>(bytes[1]) << 8);
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
