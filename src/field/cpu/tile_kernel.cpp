#include "field/cpu/tile_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/tile_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/gather-inl.hpp"
#include "field/cpu/leaf-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

/// A tile with more clusters than this is split, so that candidate lists stay in cache.
constexpr std::size_t most_clusters = 4000;
constexpr std::int64_t smallest_tile = 16;
constexpr std::int64_t leaf_size = 4;

/// Distances at a box's centre are trusted to prove that no surface meets the box only beyond this margin.
bool is_free_of_surface(float distance_at_center, const Vec3f& half) {
  return distance_at_center > length(half) * 1.0001F + box_slack;
}

void write_row(const FieldJob& job, std::size_t node, std::int64_t count, float distance, SiteId site) {
  std::fill_n(job.distance + node, count, distance);
  std::fill_n(job.site + node, count, site);
}

std::size_t node_index(const FieldJob& job, std::int64_t i, std::int64_t j, std::int64_t k) {
  return static_cast<std::size_t>((k * job.size[1] + j) * job.size[0] + i);
}

template <class Visit>
void for_each_row(const FieldJob& job, const NodeBox& box, Visit visit) {
  for (std::int64_t k = 0; k < box.count[2]; ++k) {
    for (std::int64_t j = 0; j < box.count[1]; ++j) {
      visit(j, k, node_index(job, box.first[0], box.first[1] + j, box.first[2] + k));
    }
  }
}

/// Works on one tile: owns nothing, holds what the recursion passes along.
class TileWorker {
 public:
  TileWorker(const FieldJob& job, TileScratch& scratch)
      : job_(job), scratch_(scratch.impl()), unsettled_(scratch.unsettled) {}

  void tile(const NodeBox& box, std::int64_t size) {
    const CenteredBox place = centered(job_, box);
    const Witness nearest = nearest_record(job_, place.center);
    int side = 0;
    if (settle(box, place.half, nearest, place.center, side)) return;
    const std::size_t clusters = find_tile_clusters(job_, place, nearest.point, scratch_);
    if (clusters > most_clusters && size > smallest_tile) {
      const Halving parts = halve(job_, box, size);
      for (std::size_t c = 0; c < 8; ++c) {
        if (parts.exists[c]) tile(parts.child[c], size / 2);
      }
      return;
    }
    gather_records(job_, scratch_, scratch_.gathered);
    divide(box, size, scratch_.gathered, nearest.point, side, 0);
  }

 private:
  /// Learns what the closest site at a box's centre says of the whole box: its side, if no surface meets it (then
  /// `side` is set), and whether it lies beyond the band (then it is written and true is returned).
  bool settle(const NodeBox& box, const Vec3f& half, const Witness& closest, const Vec3f& center, int& side) {
    const float distance = std::sqrt(closest.squared_distance);
    if (!is_free_of_surface(distance, half)) return false;
    if (side == 0 && job_.has_sides()) side = side_of(closest, center, job_.vertex_sides);
    const bool is_beyond_band = distance - length(half) * 1.0001F - box_slack > job_.band;
    if (!is_beyond_band || (side == 0 && job_.has_sides())) return false;
    const float value = side < 0 ? -job_.band_world : job_.band_world;
    for_each_row(job_, box, [&](std::int64_t, std::int64_t, std::size_t node) {
      write_row(job_, node, box.count[0], value, SiteId::none());
    });
    return true;
  }

  void divide(const NodeBox& box, std::int64_t size, const Candidates& candidates, const Vec3f& p0, int side,
              std::size_t level) {
    const Halving parts = halve(job_, box, size);
    const BlockTest test(parts, p0);
    auto& children = scratch_.children[level];
    for (Candidates& child : children) {
      for (std::size_t kind = 0; kind < kind_count; ++kind) child[kind].reset(candidates[kind].count());
    }
    ClosestAtCenters closest;
    halve_kind<vertex_kind>(test, candidates[vertex_kind], children, closest);
    halve_kind<edge_kind>(test, candidates[edge_kind], children, closest);
    halve_kind<face_kind>(test, candidates[face_kind], children, closest);
    for (std::size_t c = 0; c < 8; ++c) {
      if (!parts.exists[c]) continue;
      for (RecordList& list : children[c]) list.finish();
      const CenteredBox place = centered(job_, parts.child[c]);
      Witness witness = closest_candidate(candidates, closest, c, place.center);
      add_slivers(candidates[sliver_kind], place, witness, children[c][sliver_kind]);
      int child_side = side;
      Vec3f child_p0 = p0;
      if (std::isfinite(witness.squared_distance)) {
        child_p0 = witness.point;
        if (settle(parts.child[c], place.half, witness, place.center, child_side)) continue;
      }
      if (size / 2 > leaf_size) {
        divide(parts.child[c], size / 2, children[c], child_p0, child_side, level + 1);
      } else {
        leaf(parts.child[c], place, children[c], child_p0, child_side);
      }
    }
  }

  /// The closest site at a child's centre, among those that the lanes have seen.
  static Witness closest_candidate(const Candidates& candidates, const ClosestAtCenters& closest, std::size_t child,
                                   const Vec3f& center) {
    alignas(64) std::array<float, lanes> squared;
    alignas(64) std::array<std::uint32_t, lanes> index;
    hn::Store(closest.squared[child], d, squared.data());
    hn::Store(closest.index[child], di, index.data());
    std::size_t best = 0;
    for (std::size_t lane = 1; lane < lanes; ++lane) {
      if (squared[lane] < squared[best]) best = lane;
    }
    Witness witness;
    if (squared[best] >= hwy::HighestValue<float>()) return witness;
    witness.kind = static_cast<Kind>(index[best] >> 28);
    witness.record = candidates[witness.kind][index[best] & 0x0fffffffU];
    if (!closest_on_record(witness.kind, witness.record, center, witness.point)) {
      // Rounding put the centre just outside of the prism: the point over it still lies on the face's plane, within it.
      const Vec3f normal = vec_at(witness.record, FaceColumns::normal);
      witness.point = center - normal * dot(center - vec_at(witness.record, FaceColumns::anchor), normal);
    }
    witness.squared_distance = squared[best];
    return witness;
  }

  /// Slivers are rare: they are tested one by one, by their boxes.
  static void add_slivers(const RecordList& slivers, const CenteredBox& place, Witness& witness, RecordList& out) {
    for (std::size_t k = 0; k < slivers.count(); ++k) {
      const Vec3d center = to_double(place.center);
      const Vec3d point = closest_on_sliver(slivers[k], center);
      const auto squared = static_cast<float>(squared_length(center - point));
      if (squared < witness.squared_distance) witness = {to_float(point), sliver_kind, slivers[k], squared};
    }
    const float reach = std::sqrt(witness.squared_distance) * 1.0001F + 2 * length(place.half) + 4 * box_slack;
    for (std::size_t k = 0; k < slivers.count(); ++k) {
      const Vec3d center = to_double(place.center);
      if (length(center - closest_on_sliver(slivers[k], center)) <= reach) out.append(slivers[k]);
    }
    out.finish();
  }

  void leaf(const NodeBox& box, const CenteredBox& place, const Candidates& candidates, const Vec3f& p0, int side) {
    LeafInput input{candidates, place.center, place.half + Vec3f{box_slack, box_slack, box_slack}, p0, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double steps = static_cast<double>(k) - 0.5 * static_cast<double>(box.count[axis] - 1);
        input.offsets.at[axis][k] = static_cast<float>(steps * job_.spacing[axis]);
      }
    }
    LeafState state;
    const bool asks_sides = job_.has_sides() && side == 0;
    if (asks_sides) {
      evaluate_leaf<true>(job_, input, scratch_.leaf, state);
    } else {
      evaluate_leaf<false>(job_, input, scratch_.leaf, state);
    }
    for (std::size_t k = 0; k < candidates[sliver_kind].count(); ++k) {
      offer_sliver(candidates[sliver_kind][k], input, state, asks_sides);
    }
    write_leaf(box, state, side, asks_sides);
  }

  static void offer_sliver(const Record& sliver, const LeafInput& input, LeafState& state, bool asks_sides) {
    for (std::size_t node = 0; node < leaf_nodes; ++node) {
      const Vec3f q = input.center + Vec3f{input.offsets.at[0][node % 4], input.offsets.at[1][node / 4 % 4],
                                           input.offsets.at[2][node / 16]};
      const Vec3d query = to_double(q);
      const auto squared = static_cast<float>(squared_length(query - closest_on_sliver(sliver, query)));
      if (squared > state.squared[node] || (squared == state.squared[node] && sliver.id >= state.id[node])) continue;
      state.squared[node] = squared;
      state.id[node] = sliver.id;
      if (asks_sides) state.side[node] = 0;  // too flat to tell: left to the exact query
    }
  }

  void write_leaf(const NodeBox& box, LeafState& state, int side, bool asks_sides) {
    alignas(64) std::array<float, leaf_nodes> value;
    const V to_world = set(side < 0 ? -job_.to_world : job_.to_world);
    const V nowhere = set(hwy::HighestValue<float>());
    M unclear = hn::FirstN(d, 0);
    for (std::size_t node = 0; node < leaf_nodes; node += lanes) {
      const V squared = hn::Load(d, state.squared.data() + node);
      const V distance = hn::Sqrt(squared);
      V result = hn::Mul(distance, to_world);
      unclear = hn::Or(unclear, hn::Ge(squared, nowhere));
      if (asks_sides) {
        const V node_side = hn::Load(d, state.side.data() + node);
        unclear = hn::Or(unclear, hn::Lt(hn::Abs(node_side), hn::Mul(set(clear_side), distance)));
        result = hn::IfNegativeThenElse(node_side, hn::Neg(result), result);
      }
      hn::Store(result, d, value.data() + node);
    }
    if (job_.band < std::numeric_limits<float>::max()) clamp_to_band(state, value);
    for_each_row(job_, box, [&](std::int64_t j, std::int64_t k, std::size_t node) {
      const auto row = static_cast<std::size_t>(4 * j + 16 * k);
      if (box.count[0] == leaf_size) {
        std::memcpy(job_.distance + node, value.data() + row, leaf_size * sizeof(float));
        std::memcpy(static_cast<void*>(job_.site + node), state.id.data() + row, leaf_size * sizeof(SiteId));
      } else {
        std::memcpy(job_.distance + node, value.data() + row, static_cast<std::size_t>(box.count[0]) * sizeof(float));
        std::memcpy(static_cast<void*>(job_.site + node), state.id.data() + row, static_cast<std::size_t>(box.count[0]) * sizeof(SiteId));
      }
    });
    if (!hn::AllFalse(d, unclear)) report_unsettled(box, state, asks_sides);
  }

  void clamp_to_band(LeafState& state, std::array<float, leaf_nodes>& value) const {
    for (std::size_t node = 0; node < leaf_nodes; ++node) {
      if (!(std::abs(value[node]) > job_.band_world)) continue;
      value[node] = std::signbit(value[node]) ? -job_.band_world : job_.band_world;
      state.id[node] = SiteId::none().value;
    }
  }

  void report_unsettled(const NodeBox& box, const LeafState& state, bool asks_sides) {
    for_each_row(job_, box, [&](std::int64_t j, std::int64_t k, std::size_t node) {
      for (std::int64_t i = 0; i < box.count[0]; ++i) {
        const auto at = static_cast<std::size_t>(i + 4 * j + 16 * k);
        const bool is_claimed = state.squared[at] < hwy::HighestValue<float>();
        const bool is_clear = !asks_sides || !(std::abs(state.side[at]) < clear_side * std::sqrt(state.squared[at]));
        if (!is_claimed || !is_clear) unsettled_.push_back(node + static_cast<std::size_t>(i));
      }
    });
  }

  const FieldJob& job_;
  TileScratch::Impl& scratch_;
  std::vector<std::size_t>& unsettled_;
};

void compute_tile_here(const FieldJob& job, const NodeBox& tile, TileScratch& scratch) {
  TileWorker(job, scratch).tile(tile, tile_size(job.size));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blum::cpu {

HWY_EXPORT(compute_tile_here);

TileScratch::TileScratch() : impl_(std::make_unique<Impl>()) {}
TileScratch::TileScratch(TileScratch&&) noexcept = default;
TileScratch& TileScratch::operator=(TileScratch&&) noexcept = default;
TileScratch::~TileScratch() = default;

int tile_size(const std::array<std::int64_t, 3>& grid_size) {
  const double nodes =
      static_cast<double>(grid_size[0]) * static_cast<double>(grid_size[1]) * static_cast<double>(grid_size[2]);
  return nodes > 8e6 ? 64 : 32;
}

void compute_tile(const FieldJob& job, const NodeBox& tile, TileScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(compute_tile_here)(job, tile, scratch);
}

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void use_simd_target(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name == hwy::TargetName(target)) hwy::SetSupportedTargetsForTest(target);
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace blum::cpu
#endif
