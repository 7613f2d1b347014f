// Blum: evaluates the second order in a cell of 16 x 16 x 16 nodes. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_SECOND_CELL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_SECOND_CELL_INL
#undef BLUM_FIELD_CPU_SECOND_CELL_INL
#else
#define BLUM_FIELD_CPU_SECOND_CELL_INL
#endif

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "hwy/cache_control.h"

#include "field/cpu/leaf-inl.hpp"
#include "field/cpu/second_kernel.hpp"
#include "field/cpu/second_scratch.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Id without a site. Ids are compared as signed numbers, so every other id wins.
constexpr std::uint32_t nobody = 0x7fffffff;
constexpr float no_distance = hwy::HighestValue<float>();

using DS = hn::RebindToSigned<D>;
constexpr DS ds{};

/// Returns the lanes in which a candidate beats the node's best one: it is closer, or equally close with a smaller id.
HWY_INLINE M is_better(V squared, V id, V best, V best_id) {
  const M has_smaller_id = hn::RebindMask(d, hn::Lt(hn::BitCast(ds, id), hn::BitCast(ds, best_id)));
  return hn::Or(hn::Lt(squared, best), hn::And(hn::Eq(squared, best), has_smaller_id));
}

HWY_INLINE V set_id(std::uint32_t id) {
  return hn::BitCast(d, hn::Set(di, id));
}

/// Returns the positions of `lanes` nodes of a leaf, starting with `node`, relative to the origin of the pattern.
HWY_INLINE Vec positions_of(const LeafPattern& pattern, std::size_t node) {
  const LeafPattern::Pass& pass = pattern.pass[node / pass_nodes];
  const std::size_t k = node % pass_nodes / lanes;
  return {pass.x[k % planar], pass.y[k % planar], pass.z[k / planar]};
}

/// Positions of the nodes of a cell, relative to the cell's centre.
struct CellPositions {
  alignas(64) std::array<std::array<float, SecondCell::row>, 3> axis;
  /// x and y of the 16 nodes of one layer of a leaf, for each of the four leaves along the axis.
  alignas(64) std::array<std::array<float, 16>, 4> x, y;

  void find_layers() {
    for (std::size_t leaf = 0; leaf < 4; ++leaf) {
      for (std::size_t node = 0; node < 16; ++node) {
        x[leaf][node] = axis[0][4 * leaf + node % 4];
        y[leaf][node] = axis[1][4 * leaf + node / 4];
      }
    }
  }

  /// Returns the positions of `lanes` consecutive nodes, starting with `node`.
  [[nodiscard]] HWY_INLINE Vec following(std::size_t node) const {
    const std::size_t leaf = node / leaf_nodes;
    return {hn::Load(d, x[leaf % 4].data() + node % 16), hn::Load(d, y[leaf / 4 % 4].data() + node % 16),
            set(axis[2][leaf / 16 * 4 + node / 16 % 4])};
  }

  /// Returns the positions of arbitrary nodes.
  [[nodiscard]] HWY_INLINE Vec of(VI nodes) const {
    const auto coordinate = [&](int in_leaf, int of_leaf) {
      const VI low = hn::And(hn::ShiftRightSame(nodes, in_leaf), hn::Set(di, 3));
      return hn::Or(low, hn::And(hn::ShiftRightSame(nodes, of_leaf), hn::Set(di, 12)));
    };
    return {look_up(axis[0], coordinate(0, 4)), look_up(axis[1], coordinate(2, 6)), look_up(axis[2], coordinate(4, 8))};
  }

 private:
  static HWY_INLINE V look_up(const std::array<float, SecondCell::row>& table, VI index) {
    if constexpr (lanes == 16) {
      return hn::TableLookupLanes(hn::Load(d, table.data()), hn::IndicesFromVec(d, index));
    } else if constexpr (lanes == 8) {
      const auto at = hn::IndicesFromVec(d, hn::And(index, hn::Set(di, 7)));
      const M is_high = hn::RebindMask(d, hn::Ne(hn::And(index, hn::Set(di, 8)), hn::Zero(di)));
      return hn::IfThenElse(is_high, hn::TableLookupLanes(hn::Load(d, table.data() + 8), at),
                            hn::TableLookupLanes(hn::Load(d, table.data()), at));
    } else {
      alignas(64) std::array<std::uint32_t, lanes> at;
      alignas(64) std::array<float, lanes> value;
      hn::Store(index, di, at.data());
      for (std::size_t lane = 0; lane < lanes; ++lane) value[lane] = table[at[lane]];
      return hn::Load(d, value.data());
    }
  }
};

/// Sorts the nodes of a cell into groups with the same first site.
class CellSorter {
 public:
  CellSorter(SecondCell& cell, std::span<const SecondLabels::OfSite> labels) : cell_(cell), labels_(labels) {}

  void find_groups() {
    cell_.item_count = 0;
    cell_.group_count = 0;
    cell_.table.fill(0);
    for (std::size_t leaf = 0; leaf < SecondCell::leaves; ++leaf) {
      const std::uint32_t* sites = cell_.first.data() + leaf * leaf_nodes;
      std::uint64_t left = ~nodes_of(sites, dead_record);
      while (left != 0) {
        const std::uint32_t site = sites[std::countr_zero(left)];
        const std::uint64_t nodes = nodes_of(sites, site);
        left &= ~nodes;
        add_item(leaf, nodes, site);
      }
    }
  }

  void find_labels() {
    for (std::size_t g = 0; g < cell_.group_count; ++g) cell_.groups[g].labels = labels_[cell_.groups[g].site];
  }

  /// Lists the nodes of all groups, group after group.
  void order() {
    std::size_t place = 0;
    for (std::size_t g = 0; g < cell_.group_count; ++g) {
      SecondCell::Group& group = cell_.groups[g];
      group.begin = static_cast<std::uint16_t>(place);
      for (std::size_t i = group.first_item;; i = cell_.items[i].next) {
        const SecondCell::Item& item = cell_.items[i];
        const std::uint32_t first = static_cast<std::uint32_t>(item.leaf * leaf_nodes);
        // Nodes are written four at a time, so that the number of iterations is easier to predict. The next item
        // overwrites unused entries.
        std::uint64_t nodes = item.nodes;
        for (std::size_t at = place; nodes != 0; at += 4) {
          for (std::size_t k = 0; k < 4; ++k, nodes &= nodes - 1) {
            cell_.order[at + k] = first + static_cast<std::uint32_t>(std::countr_zero(nodes));
          }
        }
        place += static_cast<std::size_t>(std::popcount(item.nodes));
        if (i == group.last_item) break;
      }
      group.end = static_cast<std::uint16_t>(place);
    }
    std::fill_n(cell_.order.data() + place, SecondCell::padding, SecondCell::nodes);
  }

 private:
  /// Returns one bit per node of a leaf, set if `site` is the node's first (closest) site.
  static HWY_INLINE std::uint64_t nodes_of(const std::uint32_t* sites, std::uint32_t site) {
    const VI wanted = hn::Set(di, site);
    std::uint64_t found = 0;
    for (std::size_t k = 0; k < leaf_nodes; k += lanes) {
      found |= std::uint64_t{bits(hn::RebindMask(d, hn::Eq(hn::Load(di, sites + k), wanted)))} << k;
    }
    return found;
  }

  void add_item(std::size_t leaf, std::uint64_t nodes, std::uint32_t site) {
    const std::size_t i = cell_.item_count++;
    cell_.items[i] = {nodes, static_cast<std::uint16_t>(leaf), 0};
    const std::uint32_t hash = site * 0x9e3779b1U;
    for (std::size_t slot = hash >> 19;; slot = (slot + 1) % cell_.table.size()) {
      const std::uint16_t found = cell_.table[slot];
      if (found == 0) return add_group(i, slot, site);
      SecondCell::Group& group = cell_.groups[found - 1U];
      if (group.site != site) continue;
      cell_.items[group.last_item].next = static_cast<std::uint16_t>(i);
      group.last_item = static_cast<std::uint16_t>(i);
      return;
    }
  }

  void add_group(std::size_t i, std::size_t slot, std::uint32_t site) {
    const std::size_t g = cell_.group_count++;
    cell_.table[slot] = static_cast<std::uint16_t>(g + 1);
    SecondCell::Group& group = cell_.groups[g];
    group.site = site;
    hwy::Prefetch(&labels_[site]);  // find_labels() reads it
    group.first_item = group.last_item = static_cast<std::uint16_t>(i);
  }

  SecondCell& cell_;
  std::span<const SecondLabels::OfSite> labels_;
};

/// Several vectors of nodes, starting at index `at` of the cell's order, and the closest of the segments offered to
/// each node. Segments include their ends.
template <std::size_t vectors>
struct LinkOffers {
  Vec position[vectors];
  V best[vectors];
  V best_id[vectors];

  LinkOffers(const CellPositions& positions, const SecondCell& cell, std::size_t at) {
    for (std::size_t k = 0; k < vectors; ++k) {
      position[k] = positions.of(hn::LoadU(di, cell.order.data() + at + k * lanes));
      best[k] = set(no_distance);
      best_id[k] = set_id(nobody);
    }
  }

  /// @param middle  point relative to which the positions are given.
  HWY_INLINE void offer(const LinkSegment& segment, const Vec3f& middle) {
    const Vec center = set(segment.middle - middle);
    const Vec tangent = set(segment.tangent);
    const V half_length = set(segment.half_length);
    for (std::size_t k = 0; k < vectors; ++k) {
      const Vec from = position[k] - center;
      const V along = dot(from, tangent);
      const V excess = hn::Sub(hn::Abs(along), half_length);
      const V beyond = hn::Max(excess, hn::Zero(d));
      const Vec across = {hn::NegMulAdd(along, tangent.x, from.x), hn::NegMulAdd(along, tangent.y, from.y),
                          hn::NegMulAdd(along, tangent.z, from.z)};
      const V squared = hn::MulAdd(beyond, beyond, dot(across, across));
      const V end = hn::IfThenElse(hn::Gt(along, hn::Zero(d)), set_id(segment.end), set_id(segment.start));
      const V id = hn::IfThenElse(hn::Ge(excess, hn::Zero(d)), end, set_id(segment.id));
      const M wins = is_better(squared, id, best[k], best_id[k]);
      best[k] = hn::IfThenElse(wins, squared, best[k]);
      best_id[k] = hn::IfThenElse(wins, id, best_id[k]);
    }
  }

  /// Writes the results to the nodes listed in the cell's order.
  HWY_INLINE void store(std::size_t at, SecondCell& cell) const {
    alignas(64) std::array<float, vectors * lanes> squared;
    alignas(64) std::array<std::uint32_t, vectors * lanes> id;
    for (std::size_t k = 0; k < vectors; ++k) {
      hn::Store(best[k], d, squared.data() + k * lanes);
      hn::Store(hn::BitCast(di, best_id[k]), di, id.data() + k * lanes);
    }
    for (std::size_t k = 0; k < vectors * lanes; ++k) {
      const std::size_t node = cell.order[at + k];
      cell.squared[node] = squared[k];
      cell.id[node] = id[k];
    }
  }
};

template <std::size_t vectors>
HWY_INLINE void offer_links_at(std::span<const std::uint32_t> links, const SecondLinks& all, const Vec3f& middle,
                               const CellPositions& positions, std::size_t at, SecondCell& cell) {
  LinkOffers<vectors> offers(positions, cell, at);
  for (const std::uint32_t link : links) offers.offer(all.segments[link], middle);
  offers.store(at, cell);
}

/// Gives the nodes of a group the closest of some segments (ends included). Whole vectors are written, so nodes after
/// the group are overwritten, too. Groups must therefore be processed in order.
HWY_NOINLINE void offer_links(std::span<const std::uint32_t> links, const SecondLinks& all, const Vec3f& middle,
                              const CellPositions& positions, const SecondCell::Group& group, SecondCell& cell) {
  for (std::size_t at = group.begin; at < group.end;) {
    if (group.end - at > lanes) {
      offer_links_at<2>(links, all, middle, positions, at, cell);
      at += 2 * lanes;
    } else {
      offer_links_at<1>(links, all, middle, positions, at, cell);
      at += lanes;
    }
  }
}

/// Upper bound on the squared distances of nodes x around a centre c: |x - c|^2 + 2 (x - c) . slope + limit. The bound
/// has the form of a squared distance from a point, as Domination requires. For each slope there is a valid limit. The
/// bound is tight if the slope approximates the gradient of the distances.
struct DistanceBound {
  Vec3f slope;
  float limit = 0;
  float largest = 0;  ///< largest squared distance; rounding is proportional to it
  bool is_known = false;

  /// Returns the same bound around the centre c + offset.
  [[nodiscard]] DistanceBound around(const Vec3f& offset) const {
    DistanceBound out = *this;
    out.slope = slope + offset;
    out.limit = limit + squared_length(offset) + 2 * blum::dot(offset, slope);
    // Rounding is proportional to the larger of the two values.
    out.largest = std::max(largest, squared_length(out.slope));
    return out;
  }
  /// Returns the test that drops sites whose distance exceeds this bound everywhere in the box center +- reach.
  [[nodiscard]] Domination domination(const Vec3f& center, const Vec3f& reach) const {
    Domination out(center, Dominators{{center}, 1}, reach);
    const float slack = 4e-6F * largest + 2e-6F * std::sqrt(largest) + 1e-12F;
    out.point[0] = {set(slope), set(limit + slack)};
    return out;
  }
};

/// Returns an upper bound on the squared distances of nodes.
/// @param count    number of nodes.
/// @param node_at  callable: index of the first of `lanes` nodes -> their positions relative to the centre.
/// @param squared  one per node, readable as whole vectors; nodes with negative values are ignored.
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

/// Ball around the nodes of a group, relative to the cell's centre.
struct GroupBall {
  Vec3f center;
  float radius = 0;
};
inline GroupBall ball_of(const SecondCell& cell, const SecondCell::Group& group, const CellPositions& positions) {
  Vec3f low{1e30F, 1e30F, 1e30F};
  Vec3f high = low * -1.0F;
  for (std::size_t at = group.begin; at < group.end; ++at) {
    const std::size_t node = cell.order[at];
    const std::size_t leaf = node / leaf_nodes;
    const Vec3f p{positions.axis[0][leaf % 4 * 4 + node % 4], positions.axis[1][leaf / 4 % 4 * 4 + node / 4 % 4],
                  positions.axis[2][leaf / 16 * 4 + node / 16 % 4]};
    low = min(low, p);
    high = max(high, p);
  }
  return {(low + high) * 0.5F, length(high - low) * 0.50001F + box_slack};
}

/// First sites of a leaf, and its second sites found so far. The sites are stored in the cell.
struct SecondLeaf {
  /// Labels of the first sites, filled when needed.
  alignas(64) std::array<std::array<std::uint32_t, leaf_nodes>, 3> labels;
  const std::uint32_t* first;  ///< per node: first site, or dead_record
  float* squared;              ///< per node: below 0 without a first site, so that no candidate wins
  std::uint32_t* id;
  std::uint64_t has_labels = 0;  ///< one bit per vector of nodes with labels: the bit of the vector's first node

  SecondLeaf(SecondCell& cell, std::size_t leaf)
      : first(cell.first.data() + leaf * leaf_nodes),
        squared(cell.squared.data() + leaf * leaf_nodes),
        id(cell.id.data() + leaf * leaf_nodes) {}

  /// Sets the labels of `lanes` nodes, starting with node `begin`.
  void find_labels(std::size_t begin, std::span<const SecondLabels::OfSite> of_site) {
    has_labels |= std::uint64_t{1} << begin;
    for (std::size_t node = begin; node < begin + lanes; ++node) {
      const bool has_first = first[node] != dead_record;
      for (std::size_t k = 0; k < 3; ++k) labels[k][node] = has_first ? of_site[first[node]][k] : dead_record;
    }
  }
};

/// Evaluates candidates at the nodes of a leaf. If a candidate is at least as close as some node's best one, its
/// distances are kept and examined later. Such candidates are rare, except at nodes whose first site is the candidate.
struct SecondPass : LeafEvaluation<SecondPass, false> {
  const SecondLeaf& leaf;
  std::size_t first_node;
  V* offered = nullptr;  ///< Receives the squared distances; infinite outside of the candidate's domain.
  M is_close{};          ///< Lanes in which the candidate is close enough, in any of the vectors.

  SecondPass(const LeafPattern::Pass& pattern, std::size_t node, const SecondLeaf& of_leaf)
      : LeafEvaluation<SecondPass, false>(pattern), leaf(of_leaf), first_node(node) {}

  HWY_INLINE void take(std::size_t k, V inside, V squared, V id, V /*side*/) {
    const std::size_t node = first_node + k * lanes;
    const V offer = if_sign_bit(inside, squared, set(std::numeric_limits<float>::infinity()));
    offered[k] = offer;
    const M is_other = hn::RebindMask(d, hn::Ne(hn::BitCast(di, id), hn::Load(di, leaf.first + node)));
    const M wins = hn::And(is_other, hn::Le(offer, hn::Load(d, leaf.squared + node)));
    is_close = k == 0 ? wins : hn::Or(is_close, wins);
  }
};

/// Makes a candidate the second site of the nodes at which it may be second and is better than the best one so far.
/// @param offered  the candidate's squared distances at the nodes of a pass, as SecondPass writes them.
HWY_INLINE void settle_second(const V* offered, std::size_t first_node, std::uint32_t candidate,
                              std::span<const SecondLabels::OfSite> labels, SecondLeaf& leaf) {
  const SecondLabels::OfSite own = labels[candidate];
  const V id = set_id(candidate);
  for (std::size_t k = 0; k < pass_vectors; ++k) {
    const std::size_t node = first_node + k * lanes;
    const V squared = offered[k];
    const V best = hn::Load(d, leaf.squared + node);
    const V best_id = hn::BitCast(d, hn::Load(di, leaf.id + node));
    const M is_other = hn::RebindMask(d, hn::Ne(hn::BitCast(di, id), hn::Load(di, leaf.first + node)));
    M wins = hn::And(is_other, is_better(squared, id, best, best_id));
    if (hn::AllFalse(d, wins)) continue;
    if ((leaf.has_labels >> node & 1) == 0) leaf.find_labels(node, labels);
    for (std::size_t k_own = 0; k_own < 3; ++k_own) {
      if (k_own > 0 && own[k_own] == own[0]) continue;
      const VI one = hn::Set(di, own[k_own]);
      for (const std::array<std::uint32_t, leaf_nodes>& of_first : leaf.labels) {
        wins = hn::AndNot(hn::RebindMask(d, hn::Eq(hn::Load(di, of_first.data() + node), one)), wins);
      }
    }
    hn::Store(hn::IfThenElse(wins, squared, best), d, leaf.squared + node);
    hn::Store(hn::BitCast(di, hn::IfThenElse(wins, id, best_id)), di, leaf.id + node);
  }
}

/// Candidates of a pass that may win at some node, examined later. The outcome for each candidate is hard to predict
/// and known late. So a branch for each would cost more than its evaluation.
struct SecondOffers {
  static constexpr std::size_t most = 24;

  V squared[most][pass_vectors];  ///< as SecondPass writes them
  std::array<std::uint32_t, most> candidate;
  std::size_t count = 0;

  HWY_INLINE V* next() { return squared[count]; }
  /// Keeps the values written to next() if any lane is close.
  HWY_INLINE void add(const float* id, M is_close) {
    std::memcpy(&candidate[count], id, sizeof(std::uint32_t));
    count += static_cast<std::size_t>(!hn::AllFalse(d, is_close));
  }
  [[nodiscard]] bool is_full() const { return count == most; }

  HWY_NOINLINE void settle(std::size_t first_node, std::span<const SecondLabels::OfSite> labels, SecondLeaf& leaf) {
    for (std::size_t k = 0; k < count; ++k) settle_second(squared[k], first_node, candidate[k], labels, leaf);
    count = 0;
  }
};

HWY_NOINLINE void evaluate_second(const LeafInput& input, const LeafPattern& pattern,
                                  std::span<const SecondLabels::OfSite> labels, SecondLeaf& leaf) {
  const std::vector<Vec3f> no_sides;
  SecondOffers offers;
  for (std::size_t index = 0; index < passes; ++index) {
    const std::size_t node = index * pass_nodes;
    SecondPass pass(pattern.pass[index], node, leaf);
    const auto keep = [&](const float* id) {
      offers.add(id, pass.is_close);
      if (HWY_UNLIKELY(offers.is_full())) offers.settle(node, labels, leaf);
    };
    const auto& columns = input.columns;
    for_each_candidate<vertex_kind>(input, [&](std::size_t i) {
      pass.offered = offers.next();
      pass.vertex(columns[0], i, no_sides);
      keep(columns[0].column(LeafVertex::id) + i);
    });
    for_each_candidate<edge_kind>(input, [&](std::size_t i) {
      pass.offered = offers.next();
      pass.edge(columns[1], i);
      keep(columns[1].column(LeafEdge::id) + i);
    });
    for_each_candidate<face_kind>(input, [&](std::size_t i) {
      pass.offered = offers.next();
      pass.face(columns[2], i);
      keep(columns[2].column(LeafFace::id) + i);
    });
    offers.settle(node, labels, leaf);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
