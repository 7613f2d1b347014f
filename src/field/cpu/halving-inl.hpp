// Blum: culls a box's candidate sites for its eight children. SPDX-License-Identifier: Apache-2.0
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

/// Surface points near a box, used to drop sites that are further away. The first point is the closest to the box's
/// centre; the other points come from neighbouring boxes.
struct Dominators {
  static constexpr std::size_t most = 4;
  std::array<Vec3f, most> point{};
  std::size_t count = 1;
};

/// Drops sites that are further than a known surface point p0 everywhere in the box center +- reach. Let pi be the
/// projection of the centre c on a site's flat (its line or plane). Then |x - p0|^2 < distance(x, flat)^2 for all x of
/// the box if |c - pi|^2 > |c - p0|^2 + 2 reach . |p0 - pi| + (largest squared offset along the flat).
struct Domination {
  struct Point {
    Vec center_to_p0;  // c - p0
    V limit;           // |c - p0|^2, plus room for rounding
  };
  Point point[Dominators::most];
  std::size_t count;
  Vec reach;
  V squared_reach;  // |reach|^2

  Domination(const Vec3f& center, const Dominators& dominators, const Vec3f& box_reach)
      : count(dominators.count), reach(set(box_reach)), squared_reach(set(squared_length(box_reach))) {
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3f to_p0 = center - dominators.point[k];
      const float squared = squared_length(to_p0);
      point[k] = {set(to_p0), set(squared + 4e-6F * squared + 2e-6F * std::sqrt(squared) + 1e-12F)};
    }
  }

  /// Returns the lanes with sites that no surface point beats everywhere in the box ("beats": is closer).
  /// @param to_flat  c - pi, per lane.
  HWY_INLINE M keeps(const Vec& to_flat, V squared_distance, V along_flat) const {
    const V rest = hn::Sub(squared_distance, along_flat);
    const auto kept_by = [&](const Point& p) {
      return hn::Le(rest, hn::MulAdd(support(p.center_to_p0 - to_flat, reach), set(2.0F), p.limit));
    };
    M keep = kept_by(point[0]);
    for (std::size_t k = 1; k < count; ++k) keep = hn::And(keep, kept_by(point[k]));
    return keep;
  }
};

/// Values of an affine function at the centres of eight children, or of the box itself (boxes = 1).
template <int boxes>
struct ChildOffsets {
  Vec offset;

  HWY_INLINE void values(V base, [[maybe_unused]] const Vec& gradient, V out[boxes]) const {
    if constexpr (boxes == 1) {
      out[0] = base;
    } else {
      eight_values(base, gradient, out);
    }
  }

 private:
  HWY_INLINE void eight_values(V base, const Vec& gradient, V out[8]) const {
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

/// Indices of candidates contain their kind in the bits from this one on.
constexpr std::uint32_t kind_shift = 30;

/// For each child of a box: the closest site to its centre found so far.
struct ClosestAtCenters {
  static constexpr bool is_asked = true;
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

/// Replaces ClosestAtCenters if closest sites are not needed.
struct NoClosest {
  static constexpr bool is_asked = false;
  HWY_INLINE void offer(int, V, M, VI) {}
};

/// One vector of vertex records relative to a point m, with the data that the tests and the leaves need.
struct VertexBlock {
  Vec to_site;       // m - p
  Vec direction[4];  // of the domain's planes

  VertexBlock(const Columns& columns, const Vec& m) : to_site(m - columns.vec(VertexColumns::position)) {
    for (int k = 0; k < 4; ++k) direction[k] = columns.vec(VertexColumns::direction + 3 * k);
  }
  HWY_INLINE M keeps(const Domination& domination) const {
    return domination.keeps(to_site, dot(to_site, to_site), hn::Zero(d));
  }
};

/// One vector of edge records relative to a point m.
struct EdgeBlock {
  Vec t, b, n;
  V along, across_b, across_n;  // components of m - midpoint
  V half_length, second_b, second_n, first_limit, side, reach;

  EdgeBlock(const Columns& columns, const Vec& m)
      : t(columns.vec(EdgeColumns::tangent)),
        b(columns.vec(EdgeColumns::binormal)),
        n(cross(t, b)),
        half_length(columns.column[EdgeColumns::half_length]),
        second_b(columns.column[EdgeColumns::second_b]),
        second_n(columns.column[EdgeColumns::second_n]),
        first_limit(columns.column[EdgeColumns::first_limit]),
        side(columns.column[EdgeColumns::side]),
        reach(columns.column[EdgeColumns::reach]) {
    const Vec to_site = m - columns.vec(EdgeColumns::midpoint);
    along = dot(to_site, t);
    across_b = dot(to_site, b);
    across_n = dot(to_site, n);
  }
  HWY_INLINE M keeps(const Domination& domination) const { return keeps(domination, across_b, across_n); }
  HWY_INLINE M keeps(const Domination& domination, V at_b, V at_n) const {
    const Vec to_flat = {hn::MulAdd(at_b, b.x, hn::Mul(at_n, n.x)), hn::MulAdd(at_b, b.y, hn::Mul(at_n, n.y)),
                         hn::MulAdd(at_b, b.z, hn::Mul(at_n, n.z))};
    const V squared = hn::MulAdd(at_b, at_b, square(at_n));
    return domination.keeps(to_flat, squared, square(support(t, domination.reach)));
  }
};

/// One vector of face records relative to a point m.
struct FaceBlock {
  Vec n, gradient_u, gradient_v;
  V height, minus_u, minus_v;  // evaluated at m
  V reach_above, reach_below;

  FaceBlock(const Columns& columns, const Vec& m)
      : n(columns.vec(FaceColumns::normal)),
        gradient_u(columns.vec(FaceColumns::minus_u)),
        gradient_v(columns.vec(FaceColumns::minus_v)),
        reach_above(columns.column[FaceColumns::reach_above]),
        reach_below(columns.column[FaceColumns::reach_below]) {
    const Vec to_site = m - columns.vec(FaceColumns::anchor);
    height = dot(to_site, n);
    minus_u = dot(to_site, gradient_u);
    minus_v = dot(to_site, gradient_v);
  }
  HWY_INLINE M keeps(const Domination& domination) const {
    const Vec to_flat = {hn::Mul(height, n.x), hn::Mul(height, n.y), hn::Mul(height, n.z)};
    return domination.keeps(to_flat, square(height), domination.squared_reach);
  }
};

/// Tests vectors of candidates against a box's eight children, or against the box itself (boxes = 1). Sets worst[c] to
/// a positive value if the site's domain does not meet child c. Offers each site as the closest one at the children's
/// centres.
template <int boxes>
struct BlockTest {
  Domination domination;
  ChildOffsets<boxes> offsets;
  Vec middle;
  Vec half;

  BlockTest(const Vec3f& center, const Vec3f& box_half, const Dominators& dominators)
      : domination(center, dominators, box_half), offsets{set(Vec3f{})}, middle(set(center)), half(set(box_half)) {}
  BlockTest(const Halving& h, const Dominators& dominators)
      : domination(h.middle, dominators, h.reach()), offsets{set(h.offset)}, middle(set(h.middle)), half(set(h.half)) {}
  BlockTest(const CenteredBox& box, const Dominators& dominators)
      : BlockTest(box.center, box.half + Vec3f{box_slack, box_slack, box_slack}, dominators) {}

  /// Returns the lanes with sites that no dominator beats everywhere in the box.
  template <class Block>
  HWY_INLINE M keeps(const Block& block) const {
    return block.keeps(domination);
  }

  /// Adds the condition value <= limit, for an affine function, to the test of every child.
  HWY_INLINE void bound(V base, const Vec& gradient, V limit, V worst[boxes]) const {
    V value[boxes];
    offsets.values(hn::Sub(base, limit), gradient, value);
    for (int c = 0; c < boxes; ++c) worst[c] = hn::Max(worst[c], value[c]);
  }

  template <class Closest>
  HWY_INLINE void run(const VertexBlock& block, [[maybe_unused]] M keep, [[maybe_unused]] VI index, V worst[boxes],
                      [[maybe_unused]] Closest& closest) const {
    for (int c = 0; c < boxes; ++c) worst[c] = set(-1.0F);
    for (const Vec& e : block.direction) {
      bound(dot(block.to_site, e), e, hn::Add(support(e, half), set(plane_slack)), worst);
    }
    if constexpr (Closest::is_asked) {
      const auto squares = [](V at, V offset, V out[2]) {
        out[0] = square(hn::Sub(at, offset));
        out[1] = square(hn::Add(at, offset));
      };
      V x[2];
      V y[2];
      V z[2];
      squares(block.to_site.x, offsets.offset.x, x);
      squares(block.to_site.y, offsets.offset.y, y);
      squares(block.to_site.z, offsets.offset.z, z);
      for (int c = 0; c < boxes; ++c) {
        closest.offer(c, hn::Add(hn::Add(x[c & 1], y[(c >> 1) & 1]), z[c >> 2]), keep, index);
      }
    }
  }

  template <class Closest>
  HWY_INLINE void run(const EdgeBlock& block, [[maybe_unused]] M keep, [[maybe_unused]] VI index, V worst[boxes],
                      [[maybe_unused]] Closest& closest) const {
    // Ends: | along | <= half length + support.
    V at_center[boxes];
    offsets.values(block.along, block.t, at_center);
    const V longest = hn::Add(support(block.t, half), block.half_length);
    V excess[boxes];
    for (int c = 0; c < boxes; ++c) {
      const V distance_along = hn::Abs(at_center[c]);
      worst[c] = hn::Sub(distance_along, longest);
      excess[c] = hn::Max(hn::Sub(distance_along, block.half_length), hn::Zero(d));
    }
    // Sides: the planes towards both faces, and the sum of both. The sum cuts off the corner that the box test leaves.
    const Vec second = {hn::MulAdd(block.second_b, block.b.x, hn::Mul(block.second_n, block.n.x)),
                        hn::MulAdd(block.second_b, block.b.y, hn::Mul(block.second_n, block.n.y)),
                        hn::MulAdd(block.second_b, block.b.z, hn::Mul(block.second_n, block.n.z))};
    const V across_second = hn::MulAdd(block.second_b, block.across_b, hn::Mul(block.second_n, block.across_n));
    const Vec sum = block.b + second;
    const V slack = set(2 * plane_slack);
    bound(block.across_b, block.b, hn::Add(support(block.b, half), block.first_limit), worst);
    bound(across_second, second, hn::Add(support(second, half), slack), worst);
    // The middle of the wedge is opposite to the sum's direction. A point that is further than the reach along the sum
    // lies outside of the domain.
    const V sum_support = hn::Add(support(sum, half), slack);
    const V forward = hn::Add(sum_support, block.first_limit);
    const V backward = hn::MulAdd(block.reach, hn::Sqrt(dot(sum, sum)), sum_support);
    V value[boxes];
    offsets.values(hn::Add(block.across_b, across_second), sum, value);
    for (int c = 0; c < boxes; ++c) {
      const V outside = hn::Max(hn::Sub(value[c], forward), hn::Neg(hn::Add(value[c], backward)));
      worst[c] = hn::Max(worst[c], outside);
    }
    if constexpr (Closest::is_asked) {
      V value_b[boxes];
      V value_n[boxes];
      offsets.values(block.across_b, block.b, value_b);
      offsets.values(block.across_n, block.n, value_n);
      for (int c = 0; c < boxes; ++c) {
        const V squared = hn::MulAdd(value_b[c], value_b[c], hn::MulAdd(value_n[c], value_n[c], square(excess[c])));
        closest.offer(c, squared, keep, index);
      }
    }
  }

  template <class Closest>
  HWY_INLINE void run(const FaceBlock& block, [[maybe_unused]] M keep, [[maybe_unused]] VI index, V worst[boxes],
                      [[maybe_unused]] Closest& closest) const {
    // Each barycentric coordinate must lie in [0, 1] up to the box's extent: |coordinate - 1/2| - extent <= 1/2.
    const V one_half = set(0.5F);
    V outside[boxes];
    V value[boxes];
    const auto coordinate = [&](V centered_value, const Vec& gradient, bool is_first) {
      const V extent = support(gradient, half);
      offsets.values(centered_value, gradient, value);
      for (int c = 0; c < boxes; ++c) {
        const V off_center = hn::Sub(hn::Abs(value[c]), one_half);
        outside[c] = is_first ? off_center : hn::Max(outside[c], off_center);
        const V test = hn::Sub(off_center, extent);
        worst[c] = is_first ? test : hn::Max(worst[c], test);
      }
    };
    coordinate(hn::Add(block.minus_u, one_half), block.gradient_u, true);
    coordinate(hn::Add(block.minus_v, one_half), block.gradient_v, false);
    coordinate(hn::Add(hn::Add(block.minus_u, block.minus_v), one_half), block.gradient_u + block.gradient_v, false);
    offsets.values(block.height, block.n, value);
    const V extent = support(block.n, half);
    const V above = hn::Add(extent, block.reach_above);
    const V below = hn::Add(extent, block.reach_below);
    for (int c = 0; c < boxes; ++c) {
      const V outside_reach = hn::Max(hn::Sub(value[c], above), hn::Neg(hn::Add(value[c], below)));
      worst[c] = hn::Max(worst[c], outside_reach);
    }
    if constexpr (Closest::is_asked) {
      for (int c = 0; c < boxes; ++c) {
        closest.offer(c, square(value[c]), hn::And(keep, hn::Le(outside[c], hn::Zero(d))), index);
      }
    }
  }
};

template <Kind kind>
struct BlockOf;
template <>
struct BlockOf<vertex_kind> {
  using type = VertexBlock;
};
template <>
struct BlockOf<edge_kind> {
  using type = EdgeBlock;
};
template <>
struct BlockOf<face_kind> {
  using type = FaceBlock;
};

/// Lane indices of one vector of candidates, and a mask of the lanes that contain one.
struct Lanes {
  VI index;
  M valid;

  Lanes(std::size_t first, std::size_t count)
      : index(hn::Add(hn::Set(di, static_cast<std::uint32_t>(first)), hn::Iota(di, 0))),
        valid(hn::RebindMask(d, hn::Lt(index, hn::Set(di, static_cast<std::uint32_t>(count))))) {}
};

HWY_INLINE void load_block(const RecordList& list, std::size_t b, Columns& out) {
  load_columns(list.data() + b * lanes, out);
}

/// Tests all candidates of one kind against the eight children, and offers them as closest sites at the children's
/// centres. Passes each vector with a remaining candidate to `store`, for the leaves to read.
/// @param parent  list of records, or another type that has count() and load_block(it, number, columns).
template <Kind kind, class Test, class List, class Closest, class Store>
HWY_INLINE void halve_kind(const Test& test, const List& parent, ChildBits& out, Closest& closest, Store store) {
  const std::size_t count = parent.count();
  out.reset((count + lanes - 1) / lanes);
  for (std::size_t b = 0; b < out.blocks(); ++b) {
    Columns columns;
    load_block(parent, b, columns);
    const typename BlockOf<kind>::type block(columns, test.middle);
    const Lanes here(b * lanes, count);
    const M keep = hn::And(here.valid, test.keeps(block));
    const std::uint32_t kept = bits(keep);
    if (kept == 0) {
      for (std::size_t c = 0; c < 8; ++c) out.child(c)[b] = 0;
      continue;
    }
    V worst[8];
    test.run(block, keep, hn::Or(here.index, hn::Set(di, static_cast<std::uint32_t>(kind) << kind_shift)), worst,
             closest);
    for (std::size_t c = 0; c < 8; ++c) {
      out.child(c)[b] = static_cast<std::uint16_t>(kept & bits(hn::Le(worst[c], hn::Zero(d))));
    }
    store(b, block, columns.column[15]);
  }
}

/// Runs halve_kind for vertices, edges and faces. `store_of(kind)` returns the store for one kind.
template <class Test, class Lists, class Closest, class StoreOf>
HWY_INLINE void halve_kinds(const Test& test, const Lists& parent, std::array<ChildBits, kind_count>& out,
                            Closest& closest, StoreOf store_of) {
  halve_kind<vertex_kind>(test, parent[vertex_kind], out[vertex_kind], closest, store_of(vertex_kind));
  halve_kind<edge_kind>(test, parent[edge_kind], out[edge_kind], closest, store_of(edge_kind));
  halve_kind<face_kind>(test, parent[face_kind], out[face_kind], closest, store_of(face_kind));
}

/// Copies the candidates whose bit is set for a child to `out`.
HWY_INLINE void list_child(const RecordList& parent, const ChildBits& child_bits, std::size_t child, RecordList& out) {
  const std::uint16_t* words = child_bits.child(child);
  std::size_t total = 0;
  for (std::size_t b = 0; b < child_bits.blocks(); ++b) total += static_cast<std::size_t>(std::popcount(words[b]));
  out.reset(total);
  for (std::size_t b = 0; b < child_bits.blocks(); ++b) out.append(parent.data() + b * lanes, words[b]);
  out.finish();
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
