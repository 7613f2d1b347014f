// Blum: culls a box's candidates for its eight halves. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_HALVING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_HALVING_INL
#undef BLUM_FIELD_CPU_HALVING_INL
#else
#define BLUM_FIELD_CPU_HALVING_INL
#endif

#include <bit>

#include "field/cpu/lanes-inl.hpp"
#include "field/cpu/node_boxes.hpp"
#include "field/cpu/record_geometry.hpp"
#include "field/cpu/tile_scratch.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Drops what a known surface point p0 beats everywhere in the box center +- reach. With pi the projection of the
/// centre on a site's flat, |x - p0|^2 < distance(x, flat)^2 for all x of the box when |c - pi|^2 > |c - p0|^2 + 2
/// reach . |p0 - pi| + (largest squared offset along the flat).
struct Dominator {
  Vec center_to_p0;  // c - p0
  Vec reach;
  V limit;          // |c - p0|^2 and rounding
  V squared_reach;  // |reach|^2

  Dominator(const Vec3f& center, const Vec3f& p0, const Vec3f& box_reach)
      : center_to_p0(set(center - p0)), reach(set(box_reach)) {
    const float squared = squared_length(center - p0);
    limit = set(squared + 4e-6F * squared + 2e-6F * std::sqrt(squared) + 1e-12F);
    squared_reach = set(squared_length(box_reach));
  }

  /// @param to_flat  c - pi, per lane.
  HWY_INLINE M keeps(const Vec& to_flat, V squared_distance, V along_flat) const {
    const V spread = support(center_to_p0 - to_flat, reach);
    return hn::Le(squared_distance, hn::Add(hn::MulAdd(spread, set(2.0F), limit), along_flat));
  }
};

/// Values of an affine function at the eight children's centres.
struct ChildOffsets {
  Vec offset;

  HWY_INLINE void values(V base, const Vec& gradient, V out[8]) const {
    const V x = hn::Mul(gradient.x, offset.x);
    const V y = hn::Mul(gradient.y, offset.y);
    const V z = hn::Mul(gradient.z, offset.z);
    const V low = hn::Sub(base, x);
    const V high = hn::Add(base, x);
    const V xy[4] = {hn::Sub(low, y), hn::Sub(high, y), hn::Add(low, y), hn::Add(high, y)};
    for (int c = 0; c < 4; ++c) {
      out[c] = hn::Sub(xy[c], z);
      out[c + 4] = hn::Add(xy[c], z);
    }
  }
};

/// For each child, the closest site at its centre that has been seen so far.
struct ClosestAtCenters {
  V squared[8];
  VI index[8];

  ClosestAtCenters() {
    for (int c = 0; c < 8; ++c) {
      squared[c] = set(hwy::HighestValue<float>());
      index[c] = hn::Zero(di);
    }
  }
  HWY_INLINE void offer(int child, V candidate, M valid, VI candidate_index) {
    const M closer = hn::And(valid, hn::Lt(candidate, squared[child]));
    squared[child] = hn::IfThenElse(closer, candidate, squared[child]);
    index[child] = hn::IfThenElse(hn::RebindMask(di, closer), candidate_index, index[child]);
  }
};

/// One block of candidates against the eight children: fills worst[c], positive where the site's domain misses the
/// child, and offers distances at the children's centres.
struct BlockTest {
  const Halving& halving;
  Dominator dominator;
  ChildOffsets offsets;
  Vec middle;
  Vec half;

  BlockTest(const Halving& h, const Vec3f& p0)
      : halving(h),
        dominator(h.middle, p0, h.reach()),
        offsets{set(h.offset)},
        middle(set(h.middle)),
        half(set(h.half)) {}

  /// Adds the test |value - center| <= limit, or value <= limit, of an affine function at every child.
  HWY_INLINE void bound(V base, const Vec& gradient, V limit, V worst[8]) const {
    V value[8];
    offsets.values(hn::Sub(base, limit), gradient, value);
    for (int c = 0; c < 8; ++c) worst[c] = hn::Max(worst[c], value[c]);
  }

  HWY_INLINE M vertex(const Columns& columns, M valid, VI index, V worst[8], ClosestAtCenters& closest) const {
    const Vec to_site = middle - columns.vec(VertexColumns::position);
    const M keep = hn::And(valid, dominator.keeps(to_site, dot(to_site, to_site), hn::Zero(d)));
    for (int c = 0; c < 8; ++c) worst[c] = set(-1.0F);
    for (int plane = 0; plane < 4; ++plane) {
      const Vec e = columns.vec(VertexColumns::direction + 3 * plane);
      bound(dot(to_site, e), e, hn::Add(support(e, half), set(plane_slack)), worst);
    }
    const V x[2] = {square(hn::Sub(to_site.x, offsets.offset.x)), square(hn::Add(to_site.x, offsets.offset.x))};
    const V y[2] = {square(hn::Sub(to_site.y, offsets.offset.y)), square(hn::Add(to_site.y, offsets.offset.y))};
    const V z[2] = {square(hn::Sub(to_site.z, offsets.offset.z)), square(hn::Add(to_site.z, offsets.offset.z))};
    for (int c = 0; c < 8; ++c) {
      closest.offer(c, hn::Add(hn::Add(x[c & 1], y[(c >> 1) & 1]), z[c >> 2]), keep, index);
    }
    return keep;
  }

  HWY_INLINE M edge(const Columns& columns, M valid, VI index, V worst[8], ClosestAtCenters& closest) const {
    const Vec to_site = middle - columns.vec(EdgeColumns::midpoint);
    const Vec t = columns.vec(EdgeColumns::tangent);
    const Vec b = columns.vec(EdgeColumns::binormal);
    const Vec n = cross(t, b);
    const V half_length = columns.column[EdgeColumns::half_length];
    const V along = dot(to_site, t);
    const V across_b = dot(to_site, b);
    const V across_n = dot(to_site, n);
    const Vec to_flat = {hn::MulAdd(across_b, b.x, hn::Mul(across_n, n.x)),
                         hn::MulAdd(across_b, b.y, hn::Mul(across_n, n.y)),
                         hn::MulAdd(across_b, b.z, hn::Mul(across_n, n.z))};
    const V squared = hn::MulAdd(across_b, across_b, square(across_n));
    const M keep = hn::And(valid, dominator.keeps(to_flat, squared, square(support(t, dominator.reach))));

    // Ends: | along | <= half length + support.
    V at_center[8];
    offsets.values(along, t, at_center);
    const V longest = hn::Add(support(t, half), half_length);
    V excess[8];
    for (int c = 0; c < 8; ++c) {
      const V distance_along = hn::Abs(at_center[c]);
      worst[c] = hn::Sub(distance_along, longest);
      excess[c] = hn::Max(hn::Sub(distance_along, half_length), hn::Zero(d));
    }
    // Sides: the planes of both faces, and the sum of both, which cuts the corner that the box test leaves.
    const V limit = columns.column[EdgeColumns::first_limit];
    const V second_b = columns.column[EdgeColumns::second_b];
    const V second_n = columns.column[EdgeColumns::second_n];
    const Vec second = {hn::MulAdd(second_b, b.x, hn::Mul(second_n, n.x)),
                        hn::MulAdd(second_b, b.y, hn::Mul(second_n, n.y)),
                        hn::MulAdd(second_b, b.z, hn::Mul(second_n, n.z))};
    const V across_second = hn::MulAdd(second_b, across_b, hn::Mul(second_n, across_n));
    const Vec sum = b + second;
    const V slack = set(2 * plane_slack);
    bound(across_b, b, hn::Add(support(b, half), limit), worst);
    bound(across_second, second, hn::Add(support(second, half), slack), worst);
    bound(hn::Add(across_b, across_second), sum, hn::Add(support(sum, half), hn::Add(limit, slack)), worst);

    V value_b[8];
    V value_n[8];
    offsets.values(across_b, b, value_b);
    offsets.values(across_n, n, value_n);
    for (int c = 0; c < 8; ++c) {
      const V sum_of_squares =
          hn::MulAdd(value_b[c], value_b[c], hn::MulAdd(value_n[c], value_n[c], square(excess[c])));
      closest.offer(c, sum_of_squares, keep, index);
    }
    return keep;
  }

  HWY_INLINE M face(const Columns& columns, M valid, VI index, V worst[8], ClosestAtCenters& closest) const {
    const Vec to_site = middle - columns.vec(FaceColumns::anchor);
    const Vec n = columns.vec(FaceColumns::normal);
    const Vec gradient_u = columns.vec(FaceColumns::minus_u);
    const Vec gradient_v = columns.vec(FaceColumns::minus_v);
    const Vec gradient_w = gradient_u + gradient_v;
    const V height = dot(to_site, n);
    const Vec to_flat = {hn::Mul(height, n.x), hn::Mul(height, n.y), hn::Mul(height, n.z)};
    const M keep = hn::And(valid, dominator.keeps(to_flat, square(height), dominator.squared_reach));

    // Each barycentric coordinate in [0, 1] up to the box's extent: |coordinate - 1/2| - extent <= 1/2.
    const V minus_u = dot(to_site, gradient_u);
    const V minus_v = dot(to_site, gradient_v);
    const V one_half = set(0.5F);
    V outside[8];
    V value[8];
    const auto coordinate = [&](V centered_value, const Vec& gradient, bool is_first) {
      const V extent = support(gradient, half);
      offsets.values(centered_value, gradient, value);
      for (int c = 0; c < 8; ++c) {
        const V off_center = hn::Sub(hn::Abs(value[c]), one_half);
        outside[c] = is_first ? off_center : hn::Max(outside[c], off_center);
        const V test = hn::Sub(off_center, extent);
        worst[c] = is_first ? test : hn::Max(worst[c], test);
      }
    };
    coordinate(hn::Add(minus_u, one_half), gradient_u, true);
    coordinate(hn::Add(minus_v, one_half), gradient_v, false);
    coordinate(hn::Add(hn::Add(minus_u, minus_v), one_half), gradient_w, false);

    offsets.values(height, n, value);
    for (int c = 0; c < 8; ++c) {
      closest.offer(c, square(value[c]), hn::And(keep, hn::Le(outside[c], hn::Zero(d))), index);
    }
    return keep;
  }
};

/// Copies the records of set lanes to the end of a list.
HWY_INLINE void append_lanes(const Record* block, std::uint32_t lane_bits, RecordList& list) {
  while (lane_bits != 0) {
    list.append(block[std::countr_zero(lane_bits)]);
    lane_bits &= lane_bits - 1;
  }
}

template <Kind kind>
HWY_NOINLINE void halve_kind(const BlockTest& test, const RecordList& parent, std::array<Candidates, 8>& children,
                             ClosestAtCenters& closest) {
  const auto count = static_cast<std::uint32_t>(parent.count());
  const VI iota = hn::Iota(di, 0);
  for (std::uint32_t first = 0; first < count; first += lanes) {
    const Record* block = parent.data() + first;
    Columns columns;
    load_columns(block, columns);
    const VI index = hn::Add(hn::Set(di, first), iota);
    const M valid = hn::RebindMask(d, hn::Lt(index, hn::Set(di, count)));
    const VI tagged = hn::Or(index, hn::Set(di, static_cast<std::uint32_t>(kind) << 28));
    V worst[8];
    M keep;
    if constexpr (kind == vertex_kind) {
      keep = test.vertex(columns, valid, tagged, worst, closest);
    } else if constexpr (kind == edge_kind) {
      keep = test.edge(columns, valid, tagged, worst, closest);
    } else {
      keep = test.face(columns, valid, tagged, worst, closest);
    }
    const std::uint32_t kept = bits(keep);
    if (kept == 0) continue;
    for (int c = 0; c < 8; ++c) {
      if (!test.halving.exists[static_cast<std::size_t>(c)]) continue;
      const std::uint32_t meets = kept & bits(hn::Le(worst[c], hn::Zero(d)));
      append_lanes(block, meets, children[static_cast<std::size_t>(c)][kind]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
