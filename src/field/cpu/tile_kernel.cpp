#include "field/cpu/tile_kernel.hpp"

#include "hwy/cache_control.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/tile_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/gather-inl.hpp"
#include "field/cpu/leaf-inl.hpp"
#include "field/cpu/witness-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

/// A tile with more clusters than this is split, so that lists of candidates stay in cache.
constexpr std::size_t most_clusters = 8000;
constexpr std::int64_t smallest_tile = 16;
constexpr std::int64_t leaf_size = 4;
constexpr std::size_t fewest_worth_culling = 12;         // candidates in a leaf
constexpr std::size_t fewest_worth_culling_in_box = 64;  // candidates in a box of 8^3 nodes
constexpr std::array<std::size_t, 3> leaf_columns{LeafVertex::count, LeafEdge::count, LeafFace::count};

/// Returns true if it is certain that no surface meets a box. The distance at the box's centre must exceed the box's
/// radius by a margin.
bool is_free_of_surface(float distance_at_center, const Vec3f& half) {
  return distance_at_center > length(half) * 1.0001F + box_slack;
}

/// Computes one tile. TileWorker owns no results; it holds data that the recursion passes along.
class TileWorker {
 public:
  TileWorker(const FieldJob& job, TileScratch& scratch)
      : job_(job),
        scratch_(scratch.impl()),
        unsettled_(scratch.unsettled),
        needs_settling_(job.has_sides() || job.band < std::numeric_limits<float>::infinity()) {
    for (std::size_t c = 0; c < 8; ++c) {
      Vec3d first;
      for (std::size_t axis = 0; axis < 3; ++axis)
        first[axis] = job.spacing[axis] * (((c >> axis) & 1) != 0 ? 0.5 : -3.5);
      full_patterns_[c] = LeafPattern(first, job.spacing);
    }
  }

  void tile(const NodeBox& box, std::int64_t size) {
    if (job_.cancel.stop_requested()) return;
    const CenteredBox place = centered(job_, box);
    const Witness nearest = nearest_record(job_, place.center);
    int side = 0;
    if (needs_settling_ && settle(box, place.half, nearest, place.center, side)) return;
    const std::size_t clusters = find_tile_clusters(job_, TileTest(place, nearest.point), scratch_);
    if (clusters > most_clusters && size > smallest_tile) {
      const Halving parts = halve(job_, box, size);
      for (std::size_t c = 0; c < 8; ++c) {
        if (parts.exists[c]) tile(parts.child[c], size / 2);
      }
      return;
    }
    const BlockTest<1> test(place, Dominators{{nearest.point}, 1});
    gather_records(job_, test, scratch_, scratch_.gathered);
    divide(box, size, scratch_.gathered, Dominators{{nearest.point}, 1}, side, 0);
  }

 private:
  /// Uses the closest site of a box's centre to decide the whole box if possible. If no surface meets the box, sets
  /// `side` for all of its nodes. If the box also lies beyond the band, writes its nodes and returns true.
  bool settle(const NodeBox& box, const Vec3f& half, const Witness& closest, const Vec3f& center, int& side) {
    const float distance = std::sqrt(closest.squared_distance);
    if (!is_free_of_surface(distance, half)) return false;
    if (side == 0 && job_.has_sides()) side = side_of(closest, center, job_.vertex_sides);
    const bool is_beyond_band = distance - length(half) * 1.0001F - box_slack > job_.band;
    if (!is_beyond_band || (side == 0 && job_.has_sides())) return false;
    fill(box, side < 0 ? -job_.band_distance() : job_.band_distance());
    return true;
  }

  /// Gives all nodes of a box beyond the band this distance and no site.
  void fill(const NodeBox& box, float distance) {
    if (is_buffered_) {
      for_each_row(box, [&](std::size_t at, std::size_t) {
        std::fill_n(scratch_.output.distance.data() + at, box.count[0], distance);
        std::fill_n(scratch_.output.site.data() + at, box.count[0], SiteId::none().value);
      });
      return;
    }
    for_each_row(box, [&](std::size_t, std::size_t node) {
      std::fill_n(job_.request.distance + node, box.count[0], distance);
      if (job_.request.site != nullptr) std::fill_n(job_.request.site + node, box.count[0], SiteId::none().value);
    });
  }

  /// Writes the buffered box to the field. Rows that are whole, aligned cache lines are written past the caches.
  void flush(const NodeBox& box) {
    constexpr std::size_t line = 64;
    const bool is_streamed = job_.is_streamed && box.count[0] == BoxOutput::side;
    const auto count = static_cast<std::size_t>(box.count[0]);
    for_each_row(box, [&](std::size_t at, std::size_t node) {
      const bool is_line = is_streamed && node * sizeof(float) % line == 0;
      put_row(d, scratch_.output.distance.data() + at, job_.request.distance + node, count, is_line);
      if (job_.request.site == nullptr) return;
      put_row(di, scratch_.output.site.data() + at, job_.request.site + node, count, is_line);
    });
  }

  template <class Tag, class T>
  static void put_row(Tag tag, const T* from, T* to, std::size_t count, bool is_line) {
    if (is_line) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(BoxOutput::side); k += lanes) {
        hn::Stream(hn::Load(tag, from + k), tag, to + k);
      }
    } else {
      std::memcpy(to, from, count * sizeof(T));
    }
  }

  /// Calls visit(index in the output buffer, index in the grid) for the first node of each row of a box.
  template <class Visit>
  void for_each_row(const NodeBox& box, Visit visit) const {
    for (std::int64_t k = 0; k < box.count[2]; ++k) {
      for (std::int64_t j = 0; j < box.count[1]; ++j) {
        const std::int64_t x = box.first[0];
        const std::int64_t y = box.first[1] + j;
        const std::int64_t z = box.first[2] + k;
        const std::int64_t mask = BoxOutput::side - 1;
        visit(static_cast<std::size_t>((((z & mask) * BoxOutput::side) + (y & mask)) * BoxOutput::side + (x & mask)),
              static_cast<std::size_t>((z * job_.request.grid.size[1] + y) * job_.request.grid.size[0] + x));
      }
    }
  }

  /// Returns the index in its leaf of the node with this index in the output buffer. The node must be the first of its
  /// row in the leaf.
  static std::size_t leaf_row(std::size_t place) { return place / 16 % 4 * 4 + place / 256 % 4 * 16; }

  /// State of a child box before its candidates are listed.
  struct Child {
    CenteredBox place;
    Vec3f p0;
    int side = 0;
    bool is_open = false;  ///< the child exists and is not settled yet
  };

  using Children = std::array<Child, 8>;

  /// Finds the positions of the children and a surface point near each. Settles those that the point decides.
  Children meet_children(const Halving& parts, const Candidates& candidates, const ClosestAtCenters& closest,
                         const Vec3f& parent_p0, int side) {
    Children children;
    for (std::size_t c = 0; c < 8; ++c) {
      Child& child = children[c];
      child.p0 = parent_p0;
      if (!parts.exists[c]) continue;
      child.place = centered(job_, parts.child[c]);
      child.side = side;
      child.is_open = true;
      Witness witness = closest_candidate(candidates, closest, c, child.place.center);
      offer_slivers(candidates[sliver_kind], child.place.center, witness);
      if (!(witness.squared_distance < hwy::HighestValue<float>())) continue;
      child.p0 = witness.point;
      if (needs_settling_) {
        child.is_open = !settle(parts.child[c], child.place.half, witness, child.place.center, child.side);
      }
    }
    return children;
  }

  /// Returns the surface points of a child and of its three neighbours in the same box.
  static Dominators dominators_of(const Children& children, std::size_t c) {
    return {{children[c].p0, children[c ^ 1].p0, children[c ^ 2].p0, children[c ^ 4].p0}, Dominators::most};
  }

  void divide(const NodeBox& box, std::int64_t size, const Candidates& candidates, const Dominators& dominators,
              int side, std::size_t level) {
    if (size == 2 * leaf_size) {
      divide_into_leaves(box, candidates, dominators, side);
      return;
    }
    if (job_.cancel.stop_requested()) return;
    const Halving parts = halve(job_, box, size);
    const BlockTest<8> test(parts, dominators);
    TileScratch::Impl::Level& here = scratch_.levels[level];
    ClosestAtCenters closest;
    halve_kinds(test, candidates, here.bits, closest, [](std::size_t) { return [](auto&&...) {}; });
    is_buffered_ = size == BoxOutput::side;
    const Children children = meet_children(parts, candidates, closest, dominators.point[0], side);
    for (std::size_t c = 0; c < 8; ++c) {
      const Child& child = children[c];
      if (!child.is_open) continue;
      for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
        list_child(candidates[kind], here.bits[kind], c, here.child[kind]);
      }
      list_slivers(candidates[sliver_kind], child.place, child.p0, here.child[sliver_kind]);
      divide(parts.child[c], size / 2, here.child, dominators_of(children, c), child.side, level + 1);
    }
    if (is_buffered_) flush(box);
    is_buffered_ = false;
  }

  void divide_into_leaves(const NodeBox& box, const Candidates& candidates, const Dominators& dominators, int side) {
    const Halving parts = halve(job_, box, 2 * leaf_size);
    const BlockTest<8> test(parts, dominators);
    TileScratch::Impl::Level& here = scratch_.levels.back();
    // With few candidates, it is cheaper to evaluate all of them than to find a surface point that excludes some.
    const std::size_t count =
        candidates[vertex_kind].count() + candidates[edge_kind].count() + candidates[face_kind].count();
    const bool is_worth_culling =
        needs_settling_ || count > fewest_worth_culling_in_box || candidates[sliver_kind].count() > 0;
    for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
      scratch_.leaf[kind].reset(leaf_columns[kind], candidates[kind].count());
    }
    Children children;
    if (is_worth_culling) {
      ClosestAtCenters closest;
      prepare_leaves(test, candidates, closest);
      children = meet_children(parts, candidates, closest, dominators.point[0], side);
    } else {
      NoClosest closest;
      prepare_leaves(test, candidates, closest);
      for (std::size_t c = 0; c < 8; ++c) children[c].is_open = parts.exists[c];
    }
    const bool is_full = is_cube(box, 2 * leaf_size);
    for (std::size_t c = 0; c < 8; ++c) {
      const Child& child = children[c];
      if (!child.is_open) continue;
      const LeafInput input{scratch_.leaf, here.bits, c};
      if (is_worth_culling) dominate_leaf(input, parts, child, dominators_of(children, c));
      list_slivers(candidates[sliver_kind], child.place, child.p0, here.child[sliver_kind]);
      if (is_full) {
        leaf(parts.child[c], input, here.child[sliver_kind], child.side, full_patterns_[c]);
      } else {
        leaf(parts.child[c], input, here.child[sliver_kind], child.side, pattern_of(parts.child[c], parts.middle));
      }
    }
  }

  /// Tests the candidates of a box of 8^3 nodes against its leaves, and prepares them for the leaves.
  template <class Closest>
  void prepare_leaves(const BlockTest<8>& test, const Candidates& candidates, Closest& closest) {
    halve_kinds(test, candidates, scratch_.levels.back().bits, closest,
                [&](std::size_t kind) { return LeafStore{scratch_.leaf[kind]}; });
  }

  static bool is_cube(const NodeBox& box, std::int64_t side) {
    return box.count[0] == side && box.count[1] == side && box.count[2] == side;
  }

  [[nodiscard]] LeafPattern pattern_of(const NodeBox& leaf_box, const Vec3f& middle) const {
    Vec3d first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] =
          job_.first_node[axis] + static_cast<double>(leaf_box.first[axis]) * job_.spacing[axis] - middle[axis];
    }
    return {first, job_.spacing};
  }

  /// Drops the candidates of a leaf that are further away than one of its dominators everywhere. Does nothing if there
  /// are too few candidates for the test to pay.
  void dominate_leaf(const LeafInput& input, const Halving& parts, const Child& child,
                     const Dominators& dominators) const {
    if (candidate_count(input) < fewest_worth_culling) return;
    const Vec3f half = child.place.half + Vec3f{box_slack, box_slack, box_slack};
    const LeafDomination domination{Domination(child.place.center, dominators, half),
                                    set(child.place.center - parts.middle)};
    dominate<vertex_kind>(input, domination);
    dominate<edge_kind>(input, domination);
    dominate<face_kind>(input, domination);
  }

  void leaf(const NodeBox& box, const LeafInput& input, const RecordList& slivers, int side,
            const LeafPattern& pattern) {
    LeafState state;
    const bool asks_sides = job_.has_sides() && side == 0;
    if (asks_sides) {
      evaluate_leaf<true>(job_, input, pattern, state);
    } else {
      evaluate_leaf<false>(job_, input, pattern, state);
    }
    for (std::size_t k = 0; k < slivers.count(); ++k) offer_sliver(slivers[k], box, state, asks_sides);
    write_leaf(box, state, side, asks_sides);
  }

  void offer_sliver(const Record& sliver, const NodeBox& box, LeafState& state, bool asks_sides) const {
    for (std::size_t node = 0; node < leaf_nodes; ++node) {
      const std::array<std::size_t, 3> at{node % 4, node / 4 % 4, node / 16};
      Vec3d query;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        query[axis] = job_.first_node[axis] +
                      job_.spacing[axis] * static_cast<double>(box.first[axis] + static_cast<std::int64_t>(at[axis]));
      }
      const auto squared = static_cast<float>(squared_length(query - closest_on_sliver(sliver, query)));
      if (squared > state.squared[node] || (squared == state.squared[node] && sliver.id >= state.id[node])) continue;
      state.squared[node] = squared;
      state.id[node] = sliver.id;
      // A sliver is too flat to decide the side: the node is left to the exact query.
      if (asks_sides) state.side[node] = 0;
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
        unclear = hn::Or(unclear,
                         hn::Lt(hn::Abs(node_side), hn::Max(hn::Mul(set(clear_side), distance), set(smallest_side))));
        result = if_sign_bit(node_side, hn::Neg(result), result);
      }
      hn::Store(result, d, value.data() + node);
    }
    if (job_.band < std::numeric_limits<float>::max()) clamp_to_band(state, value);
    const float* values = value.data();
    const std::uint32_t* ids = state.id.data();
    for_each_row(box, [&](std::size_t place, std::size_t) {
      const std::size_t row = leaf_row(place);
      // Whole rows of four nodes are copied, even if the grid ends within the row. The buffer has room, and flush()
      // skips nodes beyond the grid.
      std::memcpy(scratch_.output.distance.data() + place, values + row, leaf_size * sizeof(float));
      std::memcpy(scratch_.output.site.data() + place, ids + row, leaf_size * sizeof(std::uint32_t));
    });
    if (!hn::AllFalse(d, unclear)) report_unsettled(box, state, asks_sides);
  }

  void clamp_to_band(LeafState& state, std::array<float, leaf_nodes>& value) const {
    for (std::size_t node = 0; node < leaf_nodes; ++node) {
      if (!(std::abs(value[node]) > job_.band_distance())) continue;
      value[node] = std::signbit(value[node]) ? -job_.band_distance() : job_.band_distance();
      state.id[node] = SiteId::none().value;
    }
  }

  void report_unsettled(const NodeBox& box, const LeafState& state, bool asks_sides) {
    for_each_row(box, [&](std::size_t place, std::size_t node) {
      const std::size_t row = leaf_row(place);
      for (std::size_t i = 0; i < static_cast<std::size_t>(box.count[0]); ++i) {
        const std::size_t at = row + i;
        const bool is_claimed = state.squared[at] < hwy::HighestValue<float>();
        const bool is_clear = !asks_sides || !(std::abs(state.side[at]) <
                                               std::max(clear_side * std::sqrt(state.squared[at]), smallest_side));
        if (!is_claimed || !is_clear) unsettled_.push_back(node + i);
      }
    });
  }

  const FieldJob& job_;
  TileScratch::Impl& scratch_;
  std::vector<std::size_t>& unsettled_;
  bool needs_settling_;
  bool is_buffered_ = false;  ///< true if results are written to the output buffer of a box of 16^3 nodes
  std::array<LeafPattern, 8> full_patterns_;
};

void compute_tile_here(const FieldJob& job, const NodeBox& tile, TileScratch& scratch) {
  TileWorker(job, scratch).tile(tile, tile_size(job.request.grid.size));
  hwy::FlushStream();
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
