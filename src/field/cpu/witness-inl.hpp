// Blum: surface points next to the children of a box. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_WITNESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_WITNESS_INL
#undef BLUM_FIELD_CPU_WITNESS_INL
#else
#define BLUM_FIELD_CPU_WITNESS_INL
#endif

#include <bit>

#include "field/cpu/halving-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Returns the closest of the sites found for a child's centre, one per lane.
/// @param record_of  callable: kind, index of a candidate -> its record.
template <class RecordOf>
HWY_INLINE Witness closest_candidate(const RecordOf& record_of, const ClosestAtCenters& closest, std::size_t child,
                                     const Vec3f& center) {
  alignas(64) std::array<std::uint32_t, lanes> index;
  const float squared = hn::GetLane(hn::MinOfLanes(d, closest.squared[child]));
  hn::Store(closest.index[child], di, index.data());
  const auto best = static_cast<std::size_t>(std::countr_zero(bits(hn::Eq(closest.squared[child], set(squared)))));
  Witness witness;
  if (squared >= hwy::HighestValue<float>()) return witness;
  witness.kind = static_cast<Kind>(index[best] >> kind_shift);
  witness.record = &record_of(witness.kind, index[best] & ((1U << kind_shift) - 1));
  if (!closest_on_record(witness.kind, *witness.record, center, witness.point)) {
    // The centre lies just outside of the prism, because of rounding. Its projection still lies on the face, within
    // rounding.
    const Vec3f normal = vec_at(*witness.record, FaceColumns::normal);
    witness.point = center - normal * dot(center - vec_at(*witness.record, FaceColumns::anchor), normal);
  }
  witness.squared_distance = squared;
  return witness;
}

HWY_INLINE Witness closest_candidate(const Candidates& candidates, const ClosestAtCenters& closest, std::size_t child,
                                     const Vec3f& center) {
  const auto record_of = [&](Kind kind, std::uint32_t index) -> const Record& { return candidates[kind][index]; };
  return closest_candidate(record_of, closest, child, center);
}

/// Offers slivers (faces too flat for float32) one by one, because they are rare.
HWY_INLINE void offer_slivers(const RecordList& slivers, const Vec3f& center, Witness& witness) {
  for (std::size_t k = 0; k < slivers.count(); ++k) {
    const Vec3d query = to_double(center);
    const Vec3d point = closest_on_sliver(slivers[k], query);
    const auto squared = static_cast<float>(squared_length(query - point));
    if (squared < witness.squared_distance) witness = {to_float(point), sliver_kind, &slivers[k], squared};
  }
}

/// Lists the slivers that may be closest somewhere in a box.
/// @param p0  any point of the surface; it bounds the distance of closer sites.
HWY_INLINE void list_slivers(const RecordList& slivers, const CenteredBox& box, const Vec3f& p0, RecordList& out) {
  out.reset(slivers.count());
  const Vec3d center = to_double(box.center);
  const double reach = length(p0 - box.center) * 1.0001 + 2 * length(box.half) + 4 * box_slack;
  for (std::size_t k = 0; k < slivers.count(); ++k) {
    if (length(center - closest_on_sliver(slivers[k], center)) <= reach) out.append(slivers[k]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
