#include "field/cpu/vertex_fans.hpp"

#include <algorithm>
#include <bit>

#include "field/kernels/vertex_cone.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/vertex_fans.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Vec unit(const Vec& v) {
  const V scale = hn::Div(set(1.0F), hn::Sqrt(dot(v, v)));
  return {hn::Mul(v.x, scale), hn::Mul(v.y, scale), hn::Mul(v.z, scale)};
}

/// Processes `lanes` of the sixteen vertices, starting with vertex `lane`.
class FanLanes {
 public:
  FanLanes(const VertexFans& fans, std::size_t lane, VertexFanCones& out)
      : lane_(lane), out_(out), counts_(hn::Load(di, fans.count.data() + lane)) {
    for (std::size_t k = lane; k < lane + lanes; ++k) end_ = std::max<std::size_t>(end_, fans.count[k]);
    for (std::size_t k = 0; k < end_; ++k) {
      const SixteenVectors& along = fans.along[k];
      e_[k] = unit({hn::Load(d, along[0].data() + lane), hn::Load(d, along[1].data() + lane),
                    hn::Load(d, along[2].data() + lane)});
      store(e_[k], out.direction[k], lane);
    }
  }

  void find() {
    VI facets = hn::Zero(di);
    M uncertain = hn::FirstN(d, 0);
    for (std::size_t j = 1; j < end_; ++j) {
      const M exists = hn::RebindMask(d, hn::Gt(counts_, hn::Set(di, static_cast<std::uint32_t>(j))));
      for (std::size_t i = 0; i < j; ++i) {
        const Vec w = cross(e_[i], e_[j]);
        const M parallel = hn::And(exists, hn::Lt(dot(w, w), set(kernels::VertexCone::parallel)));
        uncertain = hn::Or(uncertain, parallel);
        const M asked = hn::AndNot(parallel, exists);
        const Extremes at = extremes(w);
        const M is_above = hn::And(asked, hn::Le(at.largest, set(kernels::VertexCone::tolerance)));
        const M is_below = hn::And(asked, hn::Ge(at.smallest, set(-kernels::VertexCone::tolerance)));
        const M is_extreme = hn::Or(is_above, is_below);
        if (hn::AllFalse(d, is_extreme)) continue;
        facets = hn::Or(facets, hn::IfThenElseZero(hn::RebindMask(di, is_extreme), hn::Set(di, (1U << i) | (1U << j))));
        keep_rays(w, bits(is_above), bits(is_below));
      }
    }
    hn::Store(facets, di, out_.facets.data() + lane_);
    out_.is_uncertain |= bits(uncertain) << lane_;
  }

 private:
  struct Extremes {
    V smallest, largest;
  };

  HWY_INLINE Extremes extremes(const Vec& w) const {
    Extremes out{dot(w, e_[0]), dot(w, e_[0])};
    for (std::size_t k = 1; k < end_; ++k) {
      const V side = dot(w, e_[k]);
      out.smallest = hn::Min(out.smallest, side);
      out.largest = hn::Max(out.largest, side);
    }
    return out;
  }

  HWY_INLINE void keep_rays(const Vec& w, std::uint32_t above, std::uint32_t below) {
    alignas(64) SixteenVectors ray;
    store(unit(w), ray, 0);
    for (std::uint32_t rest = above | below; rest != 0; rest &= rest - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(rest));
      const Vec3f found{ray[0][k], ray[1][k], ray[2][k]};
      if (((above >> k) & 1U) != 0) keep_ray(lane_ + k, found);
      if (((below >> k) & 1U) != 0) keep_ray(lane_ + k, -found);
    }
  }
  void keep_ray(std::size_t k, const Vec3f& ray) {
    const std::uint32_t at = out_.ray_count[k]++;
    if (at < VertexFanCones::most_rays) out_.rays[k][at] = ray;
  }

  static HWY_INLINE void store(const Vec& v, SixteenVectors& out, std::size_t lane) {
    hn::Store(v.x, d, out[0].data() + lane);
    hn::Store(v.y, d, out[1].data() + lane);
    hn::Store(v.z, d, out[2].data() + lane);
  }

  std::size_t lane_;
  VertexFanCones& out_;
  VI counts_;
  std::size_t end_ = 1;  ///< largest number of directions in any of the lanes
  Vec e_[VertexFans::most];
};

void find_fan_cones_here(const VertexFans& fans, VertexFanCones& out) {
  out.is_uncertain = 0;
  out.ray_count = {};
  for (std::size_t lane = 0; lane < cluster_size; lane += lanes) FanLanes(fans, lane, out).find();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blum::cpu {

HWY_EXPORT(find_fan_cones_here);

void find_fan_cones(const VertexFans& fans, VertexFanCones& out) {
  HWY_DYNAMIC_DISPATCH(find_fan_cones_here)(fans, out);
}

}  // namespace blum::cpu
#endif
