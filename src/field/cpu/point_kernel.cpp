#include "field/cpu/point_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/point_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/gather-inl.hpp"
#include "field/cpu/leaf-inl.hpp"
#include "field/cpu/point_cells.hpp"
#include "field/cpu/witness-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

/// A cell with more clusters than this is divided before its records are gathered, if it can be divided.
constexpr std::size_t most_clusters = 8000;
/// If there are more clusters, or more candidates, per point than this, each point is left to a search of its own.
constexpr std::size_t clusters_per_point = 64;
constexpr std::size_t candidates_per_point = 256;
/// Points with at most this many candidates are not divided further.
constexpr std::size_t few_candidates = 32;
/// Two distances are equal within rounding if they differ by at most this, in the normalised frame.
constexpr float tie = 2e-6F;
constexpr std::array<std::size_t, 3> leaf_columns{LeafVertex::count, LeafEdge::count, LeafFace::count};

HWY_INLINE V nobody() {
  return hn::BitCast(d, hn::Set(di, dead_record));
}

/// Points of a pass, relative to a given centre.
template <std::size_t count>
struct PointNodes {
  static constexpr std::size_t vectors = count;
  Vec at[count];

  PointNodes(const MortonPoints& points, std::size_t begin, const Vec3f& middle) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto load = [&](std::size_t axis) {
        return hn::LoadU(d, points.coordinate[axis].data() + begin + k * lanes);
      };
      at[k] = Vec{load(0), load(1), load(2)} - set(middle);
    }
  }
  HWY_INLINE void affine(V base, V gx, V gy, V gz, V out[count]) const {
    for (std::size_t k = 0; k < count; ++k) {
      out[k] = hn::MulAdd(gz, at[k].z, hn::MulAdd(gy, at[k].y, hn::MulAdd(gx, at[k].x, base)));
    }
  }
  HWY_INLINE void squared_lengths(const Vec& offset, V out[count]) const {
    for (std::size_t k = 0; k < count; ++k) {
      const Vec from = at[k] + offset;
      out[k] = dot(from, from);
    }
  }
};

/// For each point of a pass: the closest candidate, the second-closest candidate, and the distance of the third-closest
/// one.
template <std::size_t count>
struct PointPass : LeafEvaluation<PointPass<count>, false, PointNodes<count>> {
  V squared[count];
  V id[count];
  V second[count];  ///< squared distance
  V second_id[count];
  V third[count];  ///< squared distance

  explicit PointPass(const PointNodes<count>& nodes)
      : LeafEvaluation<PointPass<count>, false, PointNodes<count>>(nodes) {
    for (std::size_t k = 0; k < count; ++k) {
      squared[k] = second[k] = third[k] = set(hwy::HighestValue<float>());
      id[k] = second_id[k] = nobody();
    }
  }

  HWY_INLINE void take(std::size_t k, V inside, V candidate, V candidate_id, V /*side*/) {
    const V offer = if_sign_bit(inside, candidate, set(hwy::HighestValue<float>()));
    const V over_first = hn::Sub(offer, squared[k]);
    const V over_second = hn::Sub(offer, second[k]);
    third[k] = hn::Min(third[k], hn::Max(offer, second[k]));
    second_id[k] = if_sign_bit(over_first, id[k], if_sign_bit(over_second, candidate_id, second_id[k]));
    second[k] = hn::Min(second[k], hn::Max(offer, squared[k]));
    id[k] = if_sign_bit(over_first, candidate_id, id[k]);
    squared[k] = hn::Min(offer, squared[k]);
  }
};

/// Computes one cell. It owns no results; it holds data that the recursion passes along.
class PointWorker {
 public:
  PointWorker(const PointJob& job, PointScratch& scratch)
      : job_(job), points_(*job.points), mine_(scratch.impl()), scratch_(mine_.tile.impl()) {}

  /// Finds the closest sites of the points of a cell.
  /// @param cell  must not be of the last level.
  void cell(const PointCell& cell) {
    if (job_.field.cancel.stop_requested()) return;
    const CenteredBox place{cell.center, Vec3f{cell.half, cell.half, cell.half}};
    const Witness nearest = nearest_record(job_.field, place.center);
    const std::size_t clusters = find_tile_clusters(job_.field, TileTest(place, nearest.point), scratch_);
    if (clusters > cell.size() * clusters_per_point) return give_up(cell, nearest.point);
    if (clusters > most_clusters && cell.size() > points_per_leaf && has_divisible_children(cell)) {
      for (const PointCell& child : children_of(points_.order, cell)) {
        if (child.size() > 0) this->cell(child);
      }
      return;
    }
    const Dominators dominators{{nearest.point}, 1};
    gather_records(job_.field, BlockTest<1>(place, dominators), scratch_, scratch_.gathered);
    divide(cell, scratch_.gathered, dominators, 0);
  }

 private:
  static bool can_divide(const PointCell& cell) { return cell.level < morton_levels && cell.size() > points_per_leaf; }

  static std::size_t count_of(const Candidates& candidates) {
    return candidates[vertex_kind].count() + candidates[edge_kind].count() + candidates[face_kind].count() +
           candidates[sliver_kind].count();
  }

  /// Sets an upper bound on the distance of each point, from a given surface point. Leaves the sites unknown.
  void give_up(const PointCell& cell, const Vec3f& surface_point) {
    const Vec p0 = set(surface_point);
    for (std::size_t at = cell.begin; at < cell.end; at += lanes) {
      const PointNodes<1> node(points_, at, {});
      const Vec from = node.at[0] - p0;
      put(at, cell.end, dot(from, from), nobody(), nobody());
    }
  }

  void put(std::size_t at, std::size_t end, V squared, V site, V other) const {
    PointResults& out = *job_.results;
    put(at, end, d, squared, out.squared);
    put(at, end, di, hn::BitCast(di, site), out.site);
    put(at, end, di, hn::BitCast(di, other), out.other);
  }
  template <class Tag, class Vector, class T>
  static void put(std::size_t at, std::size_t end, Tag tag, Vector values, Buffer<T>& out) {
    if (end - at >= lanes) return hn::StoreU(values, tag, out.data() + at);
    // The values past the end belong to other threads, so only `count` of them are copied.
    alignas(64) std::array<T, lanes> here;
    hn::Store(values, tag, here.data());
    std::copy_n(here.data(), end - at, out.data() + at);
  }

  void divide(const PointCell& cell, const Candidates& candidates, const Dominators& dominators, std::size_t depth) {
    if (job_.field.cancel.stop_requested()) return;
    if (count_of(candidates) > cell.size() * candidates_per_point) return give_up(cell, dominators.point[0]);
    const Halving parts = halves_of(cell);
    const BlockTest<8> test(parts, dominators);
    PointScratch::Impl::Level& here = mine_.levels[depth];
    const std::array<PointCell, 8> cells = children_of(points_.order, cell);
    for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
      here.leaf[kind].reset(leaf_columns[kind], candidates[kind].count());
    }
    ClosestAtCenters closest;
    halve_kinds(test, candidates, here.bits, closest, [&](std::size_t kind) { return LeafStore{here.leaf[kind]}; });
    std::array<Vec3f, 8> p0;
    for (std::size_t c = 0; c < 8; ++c) {
      Witness witness = closest_candidate(candidates, closest, c, cells[c].center);
      offer_slivers(candidates[sliver_kind], cells[c].center, witness);
      const bool is_found = witness.squared_distance < hwy::HighestValue<float>();
      p0[c] = is_found ? witness.point : dominators.point[0];
    }
    for (std::size_t c = 0; c < 8; ++c) {
      if (cells[c].size() == 0) continue;
      const Dominators of_child{{p0[c], p0[c ^ 1], p0[c ^ 2], p0[c ^ 4]}, Dominators::most};
      const CenteredBox place{cells[c].center, parts.half};
      list_slivers(candidates[sliver_kind], place, p0[c], here.child[sliver_kind]);
      const LeafInput input{here.leaf, here.bits, c};
      if (is_leaf(cells[c], input)) {
        leaf(cells[c], input, here.child[sliver_kind], of_child, parts.middle);
        continue;
      }
      for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
        list_child(candidates[kind], here.bits[kind], c, here.child[kind]);
      }
      divide(cells[c], here.child, of_child, depth + 1);
    }
  }

  static Halving halves_of(const PointCell& cell) {
    Halving out;
    const float quarter = cell.half / 2;
    out.middle = cell.center;
    out.offset = {quarter, quarter, quarter};
    out.half = out.offset + Vec3f{box_slack, box_slack, box_slack};
    return out;
  }

  static bool is_leaf(const PointCell& cell, const LeafInput& input) {
    return !can_divide(cell) || candidate_count(input) <= few_candidates;
  }

  /// Returns the box around the points of a cell, not widened.
  [[nodiscard]] CenteredBox box_around(const PointCell& cell) const {
    Vec3f low;
    Vec3f high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* at = points_.coordinate[axis].data();
      V lowest = set(at[cell.begin]);
      V highest = lowest;
      for (std::size_t k = cell.begin; k < cell.end; k += lanes) {
        const V value = hn::IfThenElse(hn::FirstN(d, cell.end - k), hn::LoadU(d, at + k), lowest);
        lowest = hn::Min(lowest, value);
        highest = hn::Max(highest, value);
      }
      low[axis] = hn::GetLane(hn::MinOfLanes(d, lowest));
      high[axis] = hn::GetLane(hn::MaxOfLanes(d, highest));
    }
    return {(low + high) * 0.5F, (high - low) * 0.5F};
  }

  void leaf(const PointCell& cell, const LeafInput& input, const RecordList& slivers, const Dominators& dominators,
            const Vec3f& middle) {
    const std::size_t count = candidate_count(input);
    if (count > cell.size() * candidates_per_point) return give_up(cell, dominators.point[0]);
    if (count > few_candidates) {
      const CenteredBox box = box_around(cell);
      const Vec3f half = box.half + Vec3f{box_slack, box_slack, box_slack};
      const LeafDomination domination{Domination(box.center, dominators, half), set(box.center - middle)};
      dominate<vertex_kind>(input, domination);
      dominate<edge_kind>(input, domination);
      dominate<face_kind>(input, domination);
    }
    constexpr std::size_t most = 4 * lanes;
    for (std::size_t begin = cell.begin; begin < cell.end; begin += most) {
      const std::size_t end = std::min(begin + most, cell.end);
      switch ((end - begin - 1) / lanes) {
        case 0:
          evaluate<1>(begin, end, input, middle);
          break;
        case 1:
          evaluate<2>(begin, end, input, middle);
          break;
        case 2:
          evaluate<3>(begin, end, input, middle);
          break;
        default:
          evaluate<4>(begin, end, input, middle);
      }
    }
    for (std::size_t k = 0; k < slivers.count(); ++k) offer_sliver(slivers[k], cell);
  }

  template <std::size_t vectors>
  HWY_NOINLINE void evaluate(std::size_t begin, std::size_t end, const LeafInput& input, const Vec3f& middle) {
    PointPass<vectors> pass(PointNodes<vectors>(points_, begin, middle));
    for_each_candidate<vertex_kind>(input, [&](std::size_t i) { pass.vertex(input.columns[0], i, no_sides_); });
    for_each_candidate<edge_kind>(input, [&](std::size_t i) { pass.edge(input.columns[1], i); });
    for_each_candidate<face_kind>(input, [&](std::size_t i) { pass.face(input.columns[2], i); });
    for (std::size_t k = 0; k < vectors; ++k) {
      // Distances x <= y cannot be distinguished if y^2 <= (x + tie)^2.
      const V reach = square(hn::Add(hn::Sqrt(pass.squared[k]), set(tie)));
      const M has_other = hn::Le(pass.second[k], reach);
      const M has_third = hn::Le(pass.third[k], reach);
      put(begin + k * lanes, end, pass.squared[k], hn::IfThenElse(has_third, nobody(), pass.id[k]),
          hn::IfThenElse(has_other, pass.second_id[k], nobody()));
    }
  }

  void offer_sliver(const Record& sliver, const PointCell& cell) {
    for (std::size_t k = cell.begin; k < cell.end; ++k) {
      const Vec3d query{points_.coordinate[0][k], points_.coordinate[1][k], points_.coordinate[2][k]};
      const auto squared = static_cast<float>(squared_length(query - closest_on_sliver(sliver, query)));
      float& best = job_.results->squared[k];
      // A sliver also represents its border. If another site is equally close within rounding, the point is left to a
      // search in double precision.
      if (squared <= best + 2 * tie * std::sqrt(best) + tie * tie) job_.results->site[k] = dead_record;
      best = std::min(best, squared);
    }
  }

  const PointJob& job_;
  const MortonPoints& points_;
  PointScratch::Impl& mine_;
  TileScratch::Impl& scratch_;
  std::vector<Vec3f> no_sides_;
};

void compute_point_cell_here(const PointJob& job, const PointCell& cell, PointScratch& scratch) {
  PointWorker(job, scratch).cell(cell);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blum::cpu {

HWY_EXPORT(compute_point_cell_here);

PointScratch::PointScratch() : impl_(std::make_unique<Impl>()) {}
PointScratch::PointScratch(PointScratch&&) noexcept = default;
PointScratch& PointScratch::operator=(PointScratch&&) noexcept = default;
PointScratch::~PointScratch() = default;

void compute_point_cell(const PointJob& job, const PointCell& cell, PointScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(compute_point_cell_here)(job, cell, scratch);
}

}  // namespace blum::cpu
#endif
