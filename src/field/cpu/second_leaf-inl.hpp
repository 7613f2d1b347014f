// Blum: evaluates the second order in a leaf of 4 x 4 x 4 nodes. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_SECOND_LEAF_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_SECOND_LEAF_INL
#undef BLUM_FIELD_CPU_SECOND_LEAF_INL
#else
#define BLUM_FIELD_CPU_SECOND_LEAF_INL
#endif

#include <algorithm>

#include "field/cpu/leaf-inl.hpp"
#include "field/cpu/second_kernel.hpp"
#include "field/cpu/second_scratch.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Ids are compared as signed numbers; this one loses against all.
constexpr std::uint32_t nobody = 0x7fffffff;
/// First sites that a leaf is worked on for at a time: a bit each in a word.
constexpr std::size_t most_firsts = 32;

using DS = hn::RebindToSigned<D>;
constexpr DS ds{};

/// The first sites of a leaf, and the best seconds so far.
struct SecondLeaf {
  alignas(64) std::array<std::uint32_t, leaf_nodes> first;    ///< site ids; dead_record where there is none
  alignas(64) std::array<std::uint32_t, leaf_nodes> bit;      ///< which of `firsts` it is, of those at hand; else 0
  alignas(64) std::array<float, leaf_nodes> squared;
  alignas(64) std::array<std::uint32_t, leaf_nodes> id;
  std::array<std::uint32_t, leaf_nodes> firsts;  ///< different ones, in the order of the nodes
  std::array<std::uint64_t, leaf_nodes> nodes;   ///< those of each
  std::size_t count = 0;

  void find_firsts() {
    count = 0;
    std::size_t at = 0;
    for (std::size_t node = 0; node < leaf_nodes; ++node) {
      const std::uint32_t site = first[node];
      if (site == dead_record) continue;
      if (count == 0 || firsts[at] != site) {
        at = static_cast<std::size_t>(std::find(firsts.begin(), firsts.begin() + count, site) - firsts.begin());
        if (at == count) {
          firsts[count] = site;
          nodes[count++] = 0;
        }
      }
      nodes[at] |= std::uint64_t{1} << node;
    }
  }

  void set_bits(std::size_t begin, std::size_t end) {
    bit.fill(0);
    for (std::size_t k = begin; k < end; ++k) {
      for (std::uint64_t left = nodes[k]; left != 0; left &= left - 1) {
        bit[static_cast<std::size_t>(std::countr_zero(left))] = 1U << (k - begin);
      }
    }
  }
};

/// Where a candidate beats what a node has: it is closer, or as close with a smaller id.
HWY_INLINE M is_better(V squared, V id, V best, V best_id) {
  const M has_smaller_id = hn::RebindMask(d, hn::Lt(hn::BitCast(ds, id), hn::BitCast(ds, best_id)));
  return hn::Or(hn::Lt(squared, best), hn::And(hn::Eq(squared, best), has_smaller_id));
}

/// The running seconds of one pass. Candidates come with a word of the first sites beside which they may be second.
struct SecondPass : LeafEvaluation<SecondPass, false> {
  V squared[pass_vectors];
  V id[pass_vectors];
  VI bit[pass_vectors];
  VI allowed;

  SecondPass(const LeafPattern::Pass& pattern, const SecondLeaf& leaf, std::size_t index)
      : LeafEvaluation<SecondPass, false>(pattern), allowed(hn::Zero(di)) {
    for (std::size_t k = 0; k < pass_vectors; ++k) {
      const std::size_t node = index * pass_nodes + k * lanes;
      squared[k] = hn::Load(d, leaf.squared.data() + node);
      id[k] = hn::BitCast(d, hn::Load(di, leaf.id.data() + node));
      bit[k] = hn::Load(di, leaf.bit.data() + node);
    }
  }

  HWY_INLINE void take(std::size_t k, V inside, V candidate, V candidate_id, V /*side*/) {
    const M is_inside = hn::RebindMask(d, hn::MaskFromVec(hn::BroadcastSignBit(hn::BitCast(ds, inside))));
    const M may_be = hn::RebindMask(d, hn::Ne(hn::And(bit[k], allowed), hn::Zero(di)));
    const M wins = hn::And(hn::And(is_inside, may_be), is_better(candidate, candidate_id, squared[k], id[k]));
    squared[k] = hn::IfThenElse(wins, candidate, squared[k]);
    id[k] = hn::IfThenElse(wins, candidate_id, id[k]);
  }

  void finish(SecondLeaf& leaf, std::size_t index) const {
    for (std::size_t k = 0; k < pass_vectors; ++k) {
      const std::size_t node = index * pass_nodes + k * lanes;
      hn::Store(squared[k], d, leaf.squared.data() + node);
      hn::Store(hn::BitCast(di, id[k]), di, leaf.id.data() + node);
    }
  }
};

/// Positions of `lanes` nodes.
HWY_INLINE Vec positions_of(const LeafPattern& pattern, std::size_t vector) {
  const LeafPattern::Pass& pass = pattern.pass[vector / pass_vectors];
  const std::size_t k = vector % pass_vectors;
  return {pass.x[k % planar], pass.y[k % planar], pass.z[k / planar]};
}

/// Offers closed segments to the nodes of one first site.
/// @param middle  what positions are relative to.
HWY_INLINE void offer_links(std::span<const std::uint32_t> links, const SecondLinks& all, const Vec3f& middle,
                            const LeafPattern& pattern, std::uint64_t nodes, std::uint32_t bit, SecondLeaf& leaf) {
  constexpr std::uint64_t all_lanes = lanes == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << lanes) - 1;
  for (std::size_t vector = 0; vector < leaf_nodes / lanes; ++vector) {
    if (((nodes >> (vector * lanes)) & all_lanes) == 0) continue;
    const Vec at = positions_of(pattern, vector);
    const std::size_t node = vector * lanes;
    const M is_here = hn::RebindMask(d, hn::Eq(hn::Load(di, leaf.bit.data() + node), hn::Set(di, bit)));
    V best = hn::Load(d, leaf.squared.data() + node);
    V best_id = hn::BitCast(d, hn::Load(di, leaf.id.data() + node));
    for (const std::uint32_t link : links) {
      const LinkSegment& segment = all.segments[link];
      const Vec from = at - set(segment.middle - middle);
      const Vec tangent = set(segment.tangent);
      const V along = dot(from, tangent);
      const V excess = hn::Sub(hn::Abs(along), set(segment.half_length));
      const V beyond = hn::Max(excess, hn::Zero(d));
      const Vec across = {hn::NegMulAdd(along, tangent.x, from.x), hn::NegMulAdd(along, tangent.y, from.y),
                          hn::NegMulAdd(along, tangent.z, from.z)};
      const V squared = hn::MulAdd(beyond, beyond, dot(across, across));
      const auto as_floats = [](std::uint32_t value) { return hn::BitCast(d, hn::Set(di, value)); };
      const V end = hn::IfThenElse(hn::Gt(along, hn::Zero(d)), as_floats(segment.end), as_floats(segment.start));
      const V id = hn::IfThenElse(hn::Ge(excess, hn::Zero(d)), end, as_floats(segment.id));
      const M wins = is_better(squared, id, best, best_id);
      best = hn::IfThenElse(wins, squared, best);
      best_id = hn::IfThenElse(wins, id, best_id);
    }
    best = hn::IfThenElse(is_here, best, hn::Load(d, leaf.squared.data() + node));
    best_id = hn::IfThenElse(is_here, best_id, hn::BitCast(d, hn::Load(di, leaf.id.data() + node)));
    hn::Store(best, d, leaf.squared.data() + node);
    hn::Store(hn::BitCast(di, best_id), di, leaf.id.data() + node);
  }
}

/// The squared distance of the leaf's centre, `offset` from what the columns were written for, from each candidate's
/// point, line or plane.
template <Kind kind>
HWY_INLINE V squared_from_flat(const LeafColumns& in, std::size_t b, const Vec& offset) {
  const auto at = [&](int column) { return hn::Load(d, in.column(static_cast<std::size_t>(column)) + b * lanes); };
  const auto affine = [&](int column) {
    return hn::Add(at(column), dot(Vec{at(column + 1), at(column + 2), at(column + 3)}, offset));
  };
  if constexpr (kind == vertex_kind) {
    const Vec to_site = Vec{at(LeafVertex::to_site), at(LeafVertex::to_site + 1), at(LeafVertex::to_site + 2)} + offset;
    return dot(to_site, to_site);
  } else if constexpr (kind == edge_kind) {
    return hn::Add(square(affine(LeafEdge::across_b)), square(affine(LeafEdge::across_n)));
  } else {
    return square(affine(LeafFace::height));
  }
}

/// Where none of a candidate's labels is one of the three.
template <std::size_t columns>
HWY_INLINE M has_none_of(const LeafWords& labels, std::size_t b, const SecondLabels::OfSite& firsts) {
  M has = hn::RebindMask(d, hn::Eq(hn::Load(di, labels.column(0) + b * lanes), hn::Set(di, firsts[0])));
  for (std::size_t c = 0; c < columns; ++c) {
    const VI label = hn::Load(di, labels.column(c) + b * lanes);
    for (std::size_t k = c == 0 ? 1 : 0; k < 3; ++k) {
      has = hn::Or(has, hn::RebindMask(d, hn::Eq(label, hn::Set(di, firsts[k]))));
    }
  }
  return hn::Not(has);
}

/// Drops candidates that are further than `bound` from the leaf's centre, and those that may be second beside none of
/// the first sites; writes down beside which the others may be.
template <Kind kind>
HWY_INLINE void choose_candidates(const LeafInput& input, const Vec& offset, float bound, const LeafWords& labels,
                                  std::span<const SecondLabels::OfSite> firsts, LeafWords& allowed) {
  constexpr std::size_t columns = kind == vertex_kind ? 1 : kind == edge_kind ? 2 : 3;
  std::uint16_t* words = input.bits[kind].child(input.child);
  const V limit = set(bound * bound);
  for (std::size_t b = 0; b < input.bits[kind].blocks(); ++b) {
    if (words[b] == 0) continue;
    const M is_near = hn::Le(squared_from_flat<kind>(input.columns[kind], b, offset), limit);
    words[b] = static_cast<std::uint16_t>(words[b] & bits(is_near));
    if (words[b] == 0) continue;
    VI beside = hn::Zero(di);
    for (std::size_t k = 0; k < firsts.size(); ++k) {
      const auto may_be = hn::RebindMask(di, has_none_of<columns>(labels, b, firsts[k]));
      beside = hn::Or(beside, hn::IfThenElseZero(may_be, hn::Set(di, 1U << k)));
    }
    hn::Store(beside, di, allowed.column(0) + b * lanes);
    words[b] = static_cast<std::uint16_t>(words[b] & bits(hn::RebindMask(d, hn::Ne(beside, hn::Zero(di)))));
  }
}

HWY_NOINLINE void evaluate_second(const LeafInput& input, const std::array<LeafWords, 3>& allowed,
                                  const LeafPattern& pattern, SecondLeaf& leaf) {
  const std::vector<Vec3f> no_sides;
  for (std::size_t index = 0; index < passes; ++index) {
    SecondPass pass(pattern.pass[index], leaf, index);
    const auto allow = [&](Kind kind, std::size_t i) { pass.allowed = hn::Set(di, allowed[kind].column(0)[i]); };
    for_each_candidate<vertex_kind>(input, [&](std::size_t i) {
      allow(vertex_kind, i);
      pass.vertex(input.columns[0], i, no_sides);
    });
    for_each_candidate<edge_kind>(input, [&](std::size_t i) {
      allow(edge_kind, i);
      pass.edge(input.columns[1], i);
    });
    for_each_candidate<face_kind>(input, [&](std::size_t i) {
      allow(face_kind, i);
      pass.face(input.columns[2], i);
    });
    pass.finish(leaf, index);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
