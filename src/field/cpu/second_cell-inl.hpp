// Blum: evaluates the second order in a cell of 8 x 8 x 8 nodes. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_SECOND_CELL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_SECOND_CELL_INL
#undef BLUM_FIELD_CPU_SECOND_CELL_INL
#else
#define BLUM_FIELD_CPU_SECOND_CELL_INL
#endif

#include <algorithm>

#include "field/cpu/halving-inl.hpp"
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

/// Sorts the nodes of a cell into groups.
class CellSorter {
 public:
  /// @param keys  of every site: sites of one key exclude the same ones; null: each site has its own. With keys, groups
  ///              also keep to eighths of the cell, for boxes around them that are small.
  CellSorter(SecondCell& cell, const std::uint32_t* keys) : cell_(cell), keys_(keys) {}

  void find_groups(const std::array<std::int64_t, 3>& count) {
    cell_.run_count = 0;
    cell_.group_count = 0;
    cell_.table.fill(0);
    for (std::int64_t k = 0; k < count[2]; ++k) {
      for (std::int64_t j = 0; j < count[1]; ++j) add_row(static_cast<std::size_t>(64 * k + 8 * j), count[0]);
    }
  }

  /// Writes the positions of all nodes, group after group; whole vectors, of which the next run overwrites the rest.
  void place(const std::array<std::array<float, 8>, 3>& at) {
    std::size_t place = 0;
    for (std::size_t g = 0; g < cell_.group_count; ++g) {
      SecondCell::Group& group = cell_.groups[g];
      group.begin = static_cast<std::uint16_t>(place);
      for (std::size_t r = group.first_run;; r = cell_.runs[r].next) {
        SecondCell::Run& run = cell_.runs[r];
        run.at = static_cast<std::uint16_t>(place);
        const std::size_t i = run.node % 8;
        std::memcpy(cell_.x.data() + place, at[0].data() + i, sizeof(float) * (8 - i));
        std::fill_n(cell_.y.data() + place, 8, at[1][run.node / 8 % 8]);
        std::fill_n(cell_.z.data() + place, 8, at[2][run.node / 64]);
        place += run.length;
        if (r == group.last_run) break;
      }
      group.end = static_cast<std::uint16_t>(place);
    }
  }

 private:
  void add_row(std::size_t first_node, std::int64_t count) {
    const std::uint32_t* sites = cell_.first.data() + first_node;
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= static_cast<std::size_t>(count); ++i) {
      const bool is_end = i == static_cast<std::size_t>(count) || (keys_ != nullptr && i == 4);
      if (!is_end && sites[i] == sites[begin]) continue;
      add_run(first_node + begin, i - begin, sites[begin]);
      begin = i;
    }
  }

  void add_run(std::size_t node, std::size_t length, std::uint32_t site) {
    const std::size_t r = cell_.run_count++;
    SecondCell::Run& run = cell_.runs[r];
    run = {static_cast<std::uint16_t>(node), static_cast<std::uint16_t>(length), SecondCell::no_group, 0, 0};
    if (site == dead_record) return;
    const std::size_t eighth = (node >> 2 & 1) | (node >> 5 & 1) << 1 | (node >> 8) << 2;
    const std::uint32_t key = keys_ == nullptr ? site : keys_[site];
    const std::uint32_t hash = (key + (keys_ == nullptr ? 0 : static_cast<std::uint32_t>(eighth) << 27)) * 0x9e3779b1U;
    for (std::size_t slot = hash >> 22;; slot = (slot + 1) % cell_.table.size()) {
      const std::uint16_t found = cell_.table[slot];
      if (found == 0) return add_group(r, slot, site, key, eighth);
      SecondCell::Group& group = cell_.groups[found - 1U];
      if (group.key != key || (keys_ != nullptr && group.eighth != eighth)) continue;
      run.group = static_cast<std::uint16_t>(found - 1);
      cell_.runs[group.last_run].next = static_cast<std::uint16_t>(r);
      group.last_run = static_cast<std::uint16_t>(r);
      return;
    }
  }

  void add_group(std::size_t r, std::size_t slot, std::uint32_t site, std::uint32_t key, std::size_t eighth) {
    const std::size_t g = cell_.group_count++;
    cell_.table[slot] = static_cast<std::uint16_t>(g + 1);
    cell_.runs[r].group = static_cast<std::uint16_t>(g);
    SecondCell::Group& group = cell_.groups[g];
    group.site = site;
    group.key = key;
    group.eighth = static_cast<std::uint8_t>(eighth);
    group.first_run = group.last_run = static_cast<std::uint16_t>(r);
  }

  SecondCell& cell_;
  const std::uint32_t* keys_;
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

/// Finds the box around a group's nodes, and bounds its candidates by what the nodes have.
HWY_INLINE void find_extent(const SecondCell& cell, SecondCell::Group& group) {
  Vec low = set(Vec3f{1e30F, 1e30F, 1e30F});
  Vec high = set(Vec3f{-1e30F, -1e30F, -1e30F});
  V worst = hn::Zero(d);
  for (std::size_t at = group.begin; at < group.end; at += lanes) {
    const M is_here = hn::FirstN(d, group.end - at);
    const Vec p = positions_at(cell, at);
    const auto lower = [&](V bound, V value) { return hn::Min(bound, hn::IfThenElse(is_here, value, bound)); };
    const auto upper = [&](V bound, V value) { return hn::Max(bound, hn::IfThenElse(is_here, value, bound)); };
    low = {lower(low.x, p.x), lower(low.y, p.y), lower(low.z, p.z)};
    high = {upper(high.x, p.x), upper(high.y, p.y), upper(high.z, p.z)};
    worst = upper(worst, hn::LoadU(d, cell.squared.data() + at));
  }
  const auto least = [](V v) { return hn::GetLane(hn::MinOfLanes(d, v)); };
  const auto most = [](V v) { return hn::GetLane(hn::MaxOfLanes(d, v)); };
  const Vec3f lower{least(low.x), least(low.y), least(low.z)};
  const Vec3f upper{most(high.x), most(high.y), most(high.z)};
  group.center = (lower + upper) * 0.5F;
  group.half = (upper - lower) * 0.5F + Vec3f{box_slack, box_slack, box_slack};
  const float squared = most(worst);
  group.bound = squared < no_distance ? std::sqrt(squared) * 1.00001F + length(group.half) + box_slack : 1e18F;
}

/// The squared distance of a point, `offset` from where a block was made, from each candidate's point, line or plane.
HWY_INLINE V squared_from_flat(const VertexBlock& block, const Vec& offset) {
  const Vec to_site = block.to_site + offset;
  return dot(to_site, to_site);
}
HWY_INLINE V squared_from_flat(const EdgeBlock& block, const Vec& offset) {
  return hn::Add(square(hn::Add(block.across_b, dot(block.b, offset))),
                 square(hn::Add(block.across_n, dot(block.n, offset))));
}
HWY_INLINE V squared_from_flat(const FaceBlock& block, const Vec& offset) {
  return square(hn::Add(block.height, dot(block.n, offset)));
}

/// The labels of a block of candidates: one column for vertices, two for edges, three for faces.
template <Kind kind>
struct BlockLabels {
  static constexpr std::size_t columns = kind == vertex_kind ? 1 : kind == edge_kind ? 2 : 3;
  VI label[columns];

  BlockLabels(const RecordList& list, std::size_t first, std::span<const SecondLabels::OfSite> labels) {
    alignas(64) std::array<std::array<std::uint32_t, 16>, columns> values{};
    const std::size_t end = std::min(list.count(), first + lanes);
    for (std::size_t at = first; at < end; ++at) {
      const SecondLabels::OfSite& of_site = labels[list[at].id];
      for (std::size_t c = 0; c < columns; ++c) values[c][at - first] = of_site[c];
    }
    for (std::size_t c = 0; c < columns; ++c) label[c] = hn::Load(di, values[c].data());
  }

  /// Where none is one of these three.
  HWY_INLINE M has_none_of(const SecondLabels::OfSite& others) const {
    auto has = hn::Eq(label[0], hn::Set(di, others[0]));
    for (std::size_t c = 0; c < columns; ++c) {
      for (std::size_t k = c == 0 ? 1 : 0; k < 3; ++k) has = hn::Or(has, hn::Eq(label[c], hn::Set(di, others[k])));
    }
    return hn::RebindMask(d, hn::Not(has));
  }
};

/// Lets a candidate win nodes of a group where `inside` is negative.
struct GroupOffer {
  SecondCell& cell;
  const SecondCell::Group& group;

  template <class Evaluate>
  HWY_INLINE void run(std::uint32_t candidate_id, Evaluate evaluate) const {
    const V id = set_id(candidate_id);
    for (std::size_t at = group.begin; at < group.end; at += lanes) {
      V inside;
      V squared;
      evaluate(positions_at(cell, at), inside, squared);
      const V best = hn::LoadU(d, cell.squared.data() + at);
      const V best_id = hn::BitCast(d, hn::LoadU(di, cell.id.data() + at));
      const M is_inside = hn::RebindMask(d, hn::MaskFromVec(hn::BroadcastSignBit(hn::BitCast(ds, inside))));
      // What lies past the end of the group is another's.
      const M is_here = hn::And(is_inside, hn::FirstN(d, group.end - at));
      const M wins = hn::And(is_here, is_better(squared, id, best, best_id));
      if (hn::AllFalse(d, wins)) continue;
      hn::StoreU(hn::IfThenElse(wins, squared, best), d, cell.squared.data() + at);
      hn::StoreU(hn::BitCast(di, hn::IfThenElse(wins, id, best_id)), di, cell.id.data() + at);
    }
  }

  HWY_INLINE void vertex(const Record& record, const Vec3f& middle) const {
    const Vec site = set(vec_at(record, VertexColumns::position) - middle);
    run(record.id, [&](const Vec& at, V& inside, V& squared) {
      const Vec from = at - site;
      inside = set(-1.0F);
      for (int k = 0; k < 4; ++k) {
        const Vec direction = set(vec_at(record, VertexColumns::direction + 3 * k));
        inside = hn::And(inside, hn::Sub(dot(from, direction), set(plane_slack)));
      }
      squared = dot(from, from);
    });
  }

  HWY_INLINE void edge(const Record& record, const Vec3f& middle) const {
    const Vec3f tangent = vec_at(record, EdgeColumns::tangent);
    const Vec3f binormal = vec_at(record, EdgeColumns::binormal);
    const Vec site = set(vec_at(record, EdgeColumns::midpoint) - middle);
    const Vec t = set(tangent);
    const Vec b = set(binormal);
    const Vec n = set(blum::cross(tangent, binormal));
    run(record.id, [&](const Vec& at, V& inside, V& squared) {
      const Vec from = at - site;
      const V across_b = dot(from, b);
      const V across_n = dot(from, n);
      // Beyond its ends the edge is as far as its end: the excess keeps the distance exact within the slack.
      const V excess = hn::Sub(hn::Abs(dot(from, t)), set(value_at(record, EdgeColumns::half_length)));
      const V beyond = hn::Max(excess, hn::Zero(d));
      const V second = hn::MulAdd(set(value_at(record, EdgeColumns::second_b)), across_b,
                                  hn::MulSub(set(value_at(record, EdgeColumns::second_n)), across_n, set(plane_slack)));
      const V first = hn::Sub(across_b, set(value_at(record, EdgeColumns::first_limit)));
      inside = hn::And(hn::And(hn::Sub(excess, set(plane_slack)), first), second);
      squared = hn::MulAdd(across_b, across_b, hn::MulAdd(across_n, across_n, hn::Mul(beyond, beyond)));
    });
  }

  HWY_INLINE void face(const Record& record, const Vec3f& middle) const {
    const Vec site = set(vec_at(record, FaceColumns::anchor) - middle);
    run(record.id, [&](const Vec& at, V& inside, V& squared) {
      const Vec from = at - site;
      const V minus_u = dot(from, set(vec_at(record, FaceColumns::minus_u)));
      const V minus_v = dot(from, set(vec_at(record, FaceColumns::minus_v)));
      const V minus_w = hn::Sub(hn::Sub(set(-1.0F), minus_u), minus_v);
      inside = hn::And(hn::And(minus_u, minus_v), minus_w);
      squared = square(dot(from, set(vec_at(record, FaceColumns::normal))));
    });
  }

  template <Kind kind>
  HWY_INLINE void record(const Record& record, const Vec3f& middle) const {
    if constexpr (kind == vertex_kind) vertex(record, middle);
    if constexpr (kind == edge_kind) edge(record, middle);
    if constexpr (kind == face_kind) face(record, middle);
  }
};

/// Offers the candidates of a kind to all groups of a cell.
template <Kind kind>
HWY_NOINLINE void offer_candidates(const RecordList& list, const Vec3f& middle,
                                   std::span<const SecondLabels::OfSite> labels, SecondCell& cell) {
  NoClosest closest;
  for (std::size_t first = 0; first < list.count(); first += lanes) {
    Columns columns;
    load_columns(list.data() + first, columns);
    const typename BlockOf<kind>::type block(columns, set(middle));
    const BlockLabels<kind> block_labels(list, first, labels);
    const M valid = Lanes(first, list.count()).valid;
    for (std::size_t g = 0; g < cell.group_count; ++g) {
      const SecondCell::Group& group = cell.groups[g];
      const M is_near = hn::Le(squared_from_flat(block, set(group.center)), set(group.bound * group.bound));
      M keep = hn::And(hn::And(valid, is_near), block_labels.has_none_of(group.labels));
      if (hn::AllFalse(d, keep)) continue;
      const BlockTest<1> test(middle + group.center, group.half, Dominators{{middle + group.center}, 0});
      const typename BlockOf<kind>::type here(columns, test.middle);
      V worst[1];
      test.run(here, keep, hn::Zero(di), worst, closest);
      keep = hn::And(keep, hn::Le(worst[0], hn::Zero(d)));
      const GroupOffer offer{cell, group};
      for (std::uint32_t kept = bits(keep); kept != 0; kept &= kept - 1) {
        offer.template record<kind>(list[first + static_cast<std::size_t>(std::countr_zero(kept))], middle);
      }
    }
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
    std::memcpy(cell.distance.data() + run.node, cell.squared.data() + run.at, 8 * sizeof(float));
    std::memcpy(cell.site.data() + run.node, cell.id.data() + run.at, 8 * sizeof(std::uint32_t));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
