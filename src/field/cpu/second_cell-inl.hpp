// Blum: evaluates the second order in a cell of 8 x 8 x 8 nodes. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_SECOND_CELL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_SECOND_CELL_INL
#undef BLUM_FIELD_CPU_SECOND_CELL_INL
#else
#define BLUM_FIELD_CPU_SECOND_CELL_INL
#endif

#include <algorithm>

#include "hwy/cache_control.h"

#include "field/cpu/leaf-inl.hpp"
#include "field/cpu/second_kernel.hpp"
#include "field/cpu/second_scratch.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Ids are compared as signed numbers; this one loses against all.
constexpr std::uint32_t nobody = 0x7fffffff;
constexpr float no_distance = hwy::HighestValue<float>();

using DS = hn::RebindToSigned<D>;
constexpr DS ds{};

/// Where a candidate beats what a node has: it is closer, or as close with a smaller id.
HWY_INLINE M is_better(V squared, V id, V best, V best_id) {
  const M has_smaller_id = hn::RebindMask(d, hn::Lt(hn::BitCast(ds, id), hn::BitCast(ds, best_id)));
  return hn::Or(hn::Lt(squared, best), hn::And(hn::Eq(squared, best), has_smaller_id));
}

HWY_INLINE V set_id(std::uint32_t id) {
  return hn::BitCast(d, hn::Set(di, id));
}

/// Positions of `lanes` nodes of a cell.
HWY_INLINE Vec positions_at(const SecondCell& cell, std::size_t at) {
  return {hn::LoadU(d, cell.x.data() + at), hn::LoadU(d, cell.y.data() + at), hn::LoadU(d, cell.z.data() + at)};
}

/// Positions of `lanes` nodes of a leaf, from where its pattern is seen from.
HWY_INLINE Vec positions_of(const LeafPattern& pattern, std::size_t node) {
  const LeafPattern::Pass& pass = pattern.pass[node / pass_nodes];
  const std::size_t k = node % pass_nodes / lanes;
  return {pass.x[k % planar], pass.y[k % planar], pass.z[k / planar]};
}

/// Of the nodes along each axis, from the cell's middle; whole vectors may be read from each.
using CellPositions = std::array<std::array<float, 32>, 3>;

/// Sorts the nodes of a cell into groups.
class CellSorter {
 public:
  CellSorter(SecondCell& cell, std::span<const SecondLabels::OfSite> labels) : cell_(cell), labels_(labels) {}

  void find_groups() {
    cell_.run_count = 0;
    cell_.group_count = 0;
    cell_.table.fill(0);
    cell_.before_first[SecondCell::front - 1] = dead_record;
    for (std::size_t node = 0; node < SecondCell::nodes; node += 64) {
      std::uint64_t begins = 0x0001000100010001U;  // of rows
      for (std::size_t k = 0; k < 64; k += lanes) {
        const std::uint32_t* sites = cell_.first() + node + k;
        const auto differs = hn::Ne(hn::Load(di, sites), hn::LoadU(di, sites - 1));
        begins |= std::uint64_t{bits(hn::RebindMask(d, differs))} << k;
      }
      for (; begins != 0; begins &= begins - 1) {
        const auto at = static_cast<std::size_t>(std::countr_zero(begins));
        const std::uint64_t later = begins & (begins - 1);
        const std::size_t end = later == 0 ? 64 : static_cast<std::size_t>(std::countr_zero(later));
        add_run(node + at, end - at, cell_.first()[node + at]);
      }
    }
  }

  void find_labels() {
    for (std::size_t g = 0; g < cell_.group_count; ++g) cell_.groups[g].labels = labels_[cell_.groups[g].site];
  }

  /// Writes the positions of all nodes, group after group; whole vectors, of which the next run overwrites the rest.
  void place(const CellPositions& at) {
    std::size_t place = 0;
    for (std::size_t g = 0; g < cell_.group_count; ++g) {
      SecondCell::Group& group = cell_.groups[g];
      group.begin = static_cast<std::uint16_t>(place);
      for (std::size_t r = group.first_run;; r = cell_.runs[r].next) {
        SecondCell::Run& run = cell_.runs[r];
        run.at = static_cast<std::uint16_t>(place);
        put(at[0].data() + run.node % SecondCell::row, cell_.x.data() + place);
        put(at[1][run.node / SecondCell::row % SecondCell::row], cell_.y.data() + place);
        put(at[2][run.node / SecondCell::layer], cell_.z.data() + place);
        place += run.length;
        if (r == group.last_run) break;
      }
      group.end = static_cast<std::uint16_t>(place);
    }
  }

 private:
  static HWY_INLINE void put(const float* from, float* to) {
    for (std::size_t k = 0; k < SecondCell::row; k += lanes) hn::StoreU(hn::LoadU(d, from + k), d, to + k);
  }
  static HWY_INLINE void put(float value, float* to) {
    for (std::size_t k = 0; k < SecondCell::row; k += lanes) hn::StoreU(set(value), d, to + k);
  }

  void add_run(std::size_t node, std::size_t length, std::uint32_t site) {
    const std::size_t r = cell_.run_count++;
    SecondCell::Run& run = cell_.runs[r];
    run = {static_cast<std::uint16_t>(node), static_cast<std::uint16_t>(length), SecondCell::no_group, 0, 0};
    if (site == dead_record) return;
    const std::uint32_t hash = site * 0x9e3779b1U;
    for (std::size_t slot = hash >> 19;; slot = (slot + 1) % cell_.table.size()) {
      const std::uint16_t found = cell_.table[slot];
      if (found == 0) return add_group(r, slot, site);
      SecondCell::Group& group = cell_.groups[found - 1U];
      if (group.site != site) continue;
      run.group = static_cast<std::uint16_t>(found - 1);
      cell_.runs[group.last_run].next = static_cast<std::uint16_t>(r);
      group.last_run = static_cast<std::uint16_t>(r);
      return;
    }
  }

  void add_group(std::size_t r, std::size_t slot, std::uint32_t site) {
    const std::size_t g = cell_.group_count++;
    cell_.table[slot] = static_cast<std::uint16_t>(g + 1);
    cell_.runs[r].group = static_cast<std::uint16_t>(g);
    SecondCell::Group& group = cell_.groups[g];
    group.site = site;
    hwy::Prefetch(&labels_[site]);  // read by find_labels()
    group.first_run = group.last_run = static_cast<std::uint16_t>(r);
  }

  SecondCell& cell_;
  std::span<const SecondLabels::OfSite> labels_;
};

/// Offers closed segments to the nodes of a group, which have nothing yet. It writes past the end of the group: groups
/// are to be taken in their order.
/// @param middle  what positions are relative to.
HWY_NOINLINE void offer_links(std::span<const std::uint32_t> links, const SecondLinks& all, const Vec3f& middle,
                              const SecondCell::Group& group, SecondCell& cell) {
  for (std::size_t at = group.begin; at < group.end; at += lanes) {
    const Vec position = positions_at(cell, at);
    V best = set(no_distance);
    V best_id = set_id(nobody);
    for (const std::uint32_t link : links) {
      const LinkSegment& segment = all.segments[link];
      const Vec from = position - set(segment.middle - middle);
      const Vec tangent = set(segment.tangent);
      const V along = dot(from, tangent);
      const V excess = hn::Sub(hn::Abs(along), set(segment.half_length));
      const V beyond = hn::Max(excess, hn::Zero(d));
      const Vec across = {hn::NegMulAdd(along, tangent.x, from.x), hn::NegMulAdd(along, tangent.y, from.y),
                          hn::NegMulAdd(along, tangent.z, from.z)};
      const V squared = hn::MulAdd(beyond, beyond, dot(across, across));
      const V end = hn::IfThenElse(hn::Gt(along, hn::Zero(d)), set_id(segment.end), set_id(segment.start));
      const V id = hn::IfThenElse(hn::Ge(excess, hn::Zero(d)), end, set_id(segment.id));
      const M wins = is_better(squared, id, best, best_id);
      best = hn::IfThenElse(wins, squared, best);
      best_id = hn::IfThenElse(wins, id, best_id);
    }
    hn::StoreU(best, d, cell.squared.data() + at);
    hn::StoreU(hn::BitCast(di, best_id), di, cell.id.data() + at);
  }
}

/// What bounds squared distances from above at nodes x around a centre c: |x - c|^2 + 2 (x - c) . slope + limit, which
/// has the form of a squared distance from a point, as a Domination needs it. Any slope is valid with the limit that
/// goes with it; a good one follows the distances.
struct DistanceBound {
  Vec3f slope;
  float limit = 0;
  float largest = 0;  ///< squared distance, which rounding goes with
  bool is_known = false;

  /// The same around another centre, `offset` further.
  [[nodiscard]] DistanceBound around(const Vec3f& offset) const {
    DistanceBound out = *this;
    out.slope = slope + offset;
    out.limit = limit + squared_length(offset) + 2 * blum::dot(offset, slope);
    // What rounding may have taken from it.
    out.largest = std::max(largest, squared_length(out.slope));
    return out;
  }
  /// The test that drops what is further than this everywhere in the box center +- reach.
  [[nodiscard]] Domination domination(const Vec3f& center, const Vec3f& reach) const {
    Domination out(center, Dominators{{center}, 1}, reach);
    const float slack = 4e-6F * largest + 2e-6F * std::sqrt(largest) + 1e-12F;
    out.point[0] = {set(slope), set(limit + slack)};
    return out;
  }
};

/// @param count   of nodes.
/// @param node_at callable: first of `lanes` nodes -> their positions from the centre.
/// @param squared of the nodes; those below 0 do not count. Read as whole vectors.
template <class NodeAt>
HWY_INLINE DistanceBound bound_distances(std::size_t count, const NodeAt& node_at, const float* squared) {
  V worst = hn::Zero(d);
  Vec product = set(Vec3f{});
  Vec weight = set(Vec3f{1e-12F, 1e-12F, 1e-12F});
  const auto value_at = [&](std::size_t at) {
    const V value = hn::LoadU(d, squared + at);
    return hn::IfThenElse(hn::FirstN(d, count - at), value, set(-1.0F));
  };
  for (std::size_t at = 0; at < count; at += lanes) {
    const V value = value_at(at);
    worst = hn::Max(worst, value);
    const Vec x = node_at(at);
    const M counts = hn::Ge(value, hn::Zero(d));
    const auto add = [&](V& sum, V& weights, V coordinate) {
      const V used = hn::IfThenElseZero(counts, coordinate);
      sum = hn::MulAdd(used, value, sum);
      weights = hn::MulAdd(used, used, weights);
    };
    add(product.x, weight.x, x.x);
    add(product.y, weight.y, x.y);
    add(product.z, weight.z, x.z);
  }
  DistanceBound out;
  out.largest = hn::GetLane(hn::MaxOfLanes(d, worst));
  if (!(out.largest < no_distance)) return out;
  out.is_known = true;
  const auto ratio = [](V above, V below) {
    return 0.5F * hn::GetLane(hn::SumOfLanes(d, above)) / hn::GetLane(hn::SumOfLanes(d, below));
  };
  out.slope = {ratio(product.x, weight.x), ratio(product.y, weight.y), ratio(product.z, weight.z)};
  const Vec twice = set(out.slope * 2.0F);
  V limit = set(-1e18F);
  for (std::size_t at = 0; at < count; at += lanes) {
    const V value = value_at(at);
    const Vec x = node_at(at);
    const V excess = hn::Sub(value, dot(x, x + twice));
    limit = hn::Max(limit, hn::IfThenElse(hn::Ge(value, hn::Zero(d)), excess, limit));
  }
  out.limit = hn::GetLane(hn::MaxOfLanes(d, limit));
  return out;
}

/// A ball around the nodes of a group, from the cell's middle.
struct GroupBall {
  Vec3f center;
  float radius = 0;
};
HWY_INLINE GroupBall ball_of(const SecondCell& cell, const SecondCell::Group& group) {
  Vec3f low{1e30F, 1e30F, 1e30F};
  Vec3f high = low * -1.0F;
  for (std::size_t at = group.begin; at < group.end; ++at) {
    const Vec3f p{cell.x[at], cell.y[at], cell.z[at]};
    low = min(low, p);
    high = max(high, p);
  }
  return {(low + high) * 0.5F, length(high - low) * 0.50001F + box_slack};
}

/// The first sites of a leaf and its seconds so far.
struct SecondLeaf {
  alignas(64) std::array<std::uint32_t, leaf_nodes> first;  ///< dead_record where there is none
  alignas(64) std::array<float, leaf_nodes> squared;
  alignas(64) std::array<std::uint32_t, leaf_nodes> id;
  /// Labels of the first sites, found when they are asked for.
  alignas(64) std::array<std::array<std::uint32_t, leaf_nodes>, 3> labels;
  std::uint64_t has_labels = 0;  ///< a bit for each node

  /// Of `lanes` nodes.
  void find_labels(std::size_t begin, std::span<const SecondLabels::OfSite> of_site) {
    has_labels |= std::uint64_t{1} << begin;
    for (std::size_t node = begin; node < begin + lanes; ++node) {
      const bool has_first = first[node] != dead_record;
      for (std::size_t k = 0; k < 3; ++k) labels[k][node] = has_first ? of_site[first[node]][k] : dead_record;
    }
  }
};

/// Offers candidates to the nodes of a leaf. Mostly no candidate but a node's first site is as close as what the node
/// has, so that labels are looked at only where one is.
struct SecondPass : LeafEvaluation<SecondPass, false> {
  SecondLeaf& leaf;
  std::size_t first_node;
  std::span<const SecondLabels::OfSite> labels;

  SecondPass(const LeafPattern::Pass& pattern, std::size_t node, std::span<const SecondLabels::OfSite> of_site,
             SecondLeaf& of_leaf)
      : LeafEvaluation<SecondPass, false>(pattern), leaf(of_leaf), first_node(node), labels(of_site) {}

  HWY_INLINE void take(std::size_t k, V inside, V squared, V id, V /*side*/) {
    const std::size_t node = first_node + k * lanes;
    const M is_inside = hn::RebindMask(d, hn::MaskFromVec(hn::BroadcastSignBit(hn::BitCast(ds, inside))));
    const M is_close = hn::Le(squared, hn::Load(d, leaf.squared.data() + node));
    const M is_other = hn::RebindMask(d, hn::Ne(hn::BitCast(di, id), hn::Load(di, leaf.first.data() + node)));
    const M wins = hn::And(hn::And(is_inside, is_close), is_other);
    if (HWY_UNLIKELY(!hn::AllFalse(d, wins))) settle(node, wins, squared, id);
  }

  /// Lets the candidate win where it may be second, if it does.
  HWY_NOINLINE void settle(std::size_t node, M wins, V squared, V id) {
    if ((leaf.has_labels >> node & 1) == 0) leaf.find_labels(node, labels);
    const SecondLabels::OfSite own = labels[hn::GetLane(hn::BitCast(di, id))];
    for (const std::array<std::uint32_t, leaf_nodes>& of_first : leaf.labels) {
      const VI label = hn::Load(di, of_first.data() + node);
      for (const std::uint32_t one : own) wins = hn::AndNot(hn::RebindMask(d, hn::Eq(label, hn::Set(di, one))), wins);
    }
    const V best = hn::Load(d, leaf.squared.data() + node);
    const V best_id = hn::BitCast(d, hn::Load(di, leaf.id.data() + node));
    wins = hn::And(wins, is_better(squared, id, best, best_id));
    hn::Store(hn::IfThenElse(wins, squared, best), d, leaf.squared.data() + node);
    hn::Store(hn::BitCast(di, hn::IfThenElse(wins, id, best_id)), di, leaf.id.data() + node);
  }
};

HWY_NOINLINE void evaluate_second(const LeafInput& input, const LeafPattern& pattern,
                                  std::span<const SecondLabels::OfSite> labels, SecondLeaf& leaf) {
  const std::vector<Vec3f> no_sides;
  for (std::size_t index = 0; index < passes; ++index) {
    SecondPass pass(pattern.pass[index], index * pass_nodes, labels, leaf);
    for_each_candidate<vertex_kind>(input, [&](std::size_t i) { pass.vertex(input.columns[0], i, no_sides); });
    for_each_candidate<edge_kind>(input, [&](std::size_t i) { pass.edge(input.columns[1], i); });
    for_each_candidate<face_kind>(input, [&](std::size_t i) { pass.face(input.columns[2], i); });
  }
}

/// Brings what groups have back into the order of the nodes.
HWY_INLINE void unsort(SecondCell& cell) {
  for (std::size_t r = 0; r < cell.run_count; ++r) {
    const SecondCell::Run& run = cell.runs[r];
    if (run.group == SecondCell::no_group) {
      std::fill_n(cell.distance.data() + run.node, run.length, no_distance);
      std::fill_n(cell.site.data() + run.node, run.length, nobody);
      continue;
    }
    // Whole vectors, of which the next run overwrites the rest.
    std::memcpy(cell.distance.data() + run.node, cell.squared.data() + run.at, SecondCell::row * sizeof(float));
    std::memcpy(cell.site.data() + run.node, cell.id.data() + run.at, SecondCell::row * sizeof(std::uint32_t));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
