#include "field/cpu/reach.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/reach.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

/// Bound, with margin, on the rounding error of w . (y - p) in float32.
constexpr float rounding = 6e-7F;
/// Factor that covers the error of the approximate reciprocal (relative error below 1e-3 on every target).
constexpr float safety = 1.002F;

/// Returns the next offset along the Morton curve at which vertices are tried. Offsets start small, and their gaps
/// grow.
std::size_t next_offset(std::size_t offset) {
  return offset + 1 + offset / 6;
}

HWY_INLINE Vec load(const SixteenVectors& v, std::size_t first) {
  return {hn::LoadU(d, v[0].data() + first), hn::LoadU(d, v[1].data() + first), hn::LoadU(d, v[2].data() + first)};
}

struct Reaches {
  V first, second;
};

/// For `lanes` sites, starting with site `lane`: the bound on the reach that one surface point gives.
struct LaneSites {
  Vec corner[3];
  Vec direction[2];
  V base[2];  // min over corners p of - w . p; equal for all corners up to rounding

  LaneSites(const ReachInput& input, std::size_t lane) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] = load(input.corner[k], lane);
    for (std::size_t k = 0; k < 2; ++k) {
      direction[k] = load(input.direction[k], lane);
      base[k] = hn::Min(hn::Min(hn::Neg(dot(direction[k], corner[0])), hn::Neg(dot(direction[k], corner[1]))),
                        hn::Neg(dot(direction[k], corner[2])));
    }
  }

  HWY_INLINE Reaches reach(const Vec& y, bool both) const {
    const auto squared_to = [&](const Vec& p) {
      const Vec gap = y - p;
      return dot(gap, gap);
    };
    const V squared = hn::Max(hn::Max(squared_to(corner[0]), squared_to(corner[1])), squared_to(corner[2]));
    V along_first = hn::Add(dot(direction[0], y), base[0]);
    V along_second = hn::Add(dot(direction[1], y), base[1]);
    if (both) along_first = along_second = hn::Min(along_first, along_second);
    return {bound(squared, along_first), bound(squared, along_second)};
  }

  static HWY_INLINE V bound(V squared, V along) {
    const V margin = hn::Sub(along, set(rounding));
    const V distance = hn::Mul(hn::Mul(squared, set(0.5F * safety)), hn::ApproximateReciprocal(margin));
    return hn::IfThenElse(hn::Gt(margin, hn::Zero(d)), distance, set(far_away));
  }
};

void find_reaches_here(const ReachInput& input, const SurfacePoints& points, std::size_t rank, bool both,
                       SixteenFloats& first, SixteenFloats& second) {
  const std::size_t count = points.count();
  for (std::size_t lane = 0; lane < cluster_size; lane += lanes) {
    const LaneSites sites(input, lane);
    Reaches best{set(far_away), set(far_away)};
    const auto look_at = [&](std::size_t at) {
      const Vec y{set(points.coordinate[0][at]), set(points.coordinate[1][at]), set(points.coordinate[2][at])};
      const Reaches reach = sites.reach(y, both);
      best.first = hn::Min(best.first, reach.first);
      best.second = hn::Min(best.second, reach.second);
    };
    for (std::size_t offset = 0; offset < count; offset = next_offset(offset)) {
      if (rank + offset < count) look_at(rank + offset);
      if (offset <= rank) look_at(rank - offset);
    }
    const V slack = set(10 * plane_slack);
    hn::StoreU(hn::Add(best.first, slack), d, first.data() + lane);
    hn::StoreU(hn::Add(best.second, slack), d, second.data() + lane);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blum::cpu {

HWY_EXPORT(find_reaches_here);

void find_reaches(const ReachInput& input, const SurfacePoints& points, std::size_t rank, bool both,
                  SixteenFloats& first, SixteenFloats& second) {
  HWY_DYNAMIC_DISPATCH(find_reaches_here)(input, points, rank, both, first, second);
}

}  // namespace blum::cpu
#endif
