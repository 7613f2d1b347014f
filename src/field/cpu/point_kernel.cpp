#include "field/cpu/point_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/point_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/gather-inl.hpp"
#include "field/cpu/point_cells.hpp"
#include "field/cpu/witness-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

/// A cell with more clusters than this is divided before its records are found, if it can be divided.
constexpr std::size_t most_clusters = 8000;
/// If there are more clusters, or more candidates, per point than this, each point is left to a separate search.
constexpr std::size_t clusters_per_point = 64;
constexpr std::size_t candidates_per_point = 256;
/// A group of points with at most this many candidates is not divided further, and all candidates are evaluated.
constexpr std::size_t few_candidates = 32;
/// Two distances are equal within rounding if they differ by at most this, in the normalised frame.
constexpr float tie = 2e-6F;

/// Points of a pass, in the normalised frame.
template <std::size_t count>
struct PointNodes {
  Vec at[count];

  PointNodes(const MortonPoints& points, std::size_t begin) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto load = [&](std::size_t axis) {
        return hn::LoadU(d, points.coordinate[axis].data() + begin + k * lanes);
      };
      at[k] = {load(0), load(1), load(2)};
    }
  }
};

HWY_INLINE Vec broadcast(const Record& record, int column) {
  return set(vec_at(record, column));
}
HWY_INLINE V broadcast_value(const Record& record, int column) {
  return set(value_at(record, column));
}

/// The three closest of at most PointPass::most candidates, for each point of a pass. A key is a squared distance whose
/// last bits are replaced by the number of the candidate. So comparing two keys compares the distances, and one
/// instruction keeps both.
template <std::size_t count>
struct PointPass {
  static constexpr std::size_t most = 256;
  static constexpr std::uint32_t no_key = 0xffffffff;

  const PointNodes<count>& nodes;
  VI number_bits;
  VI first[count], second[count], third[count];

  /// @param candidates  number of candidates; fewer leave more bits for the distances.
  PointPass(const PointNodes<count>& of_pass, std::size_t candidates)
      : nodes(of_pass), number_bits(hn::Set(di, static_cast<std::uint32_t>(std::bit_ceil(candidates) - 1))) {
    for (std::size_t k = 0; k < count; ++k) first[k] = second[k] = third[k] = hn::Set(di, no_key);
  }

  /// Offers a candidate to the points at which `inside` is negative.
  HWY_INLINE void offer(std::size_t k, V inside, V squared, VI number) {
    constexpr hn::RebindToSigned<D> ds;
    const VI outside = hn::Not(hn::BitCast(di, hn::BroadcastSignBit(hn::BitCast(ds, inside))));
    const VI key = hn::Or(hn::Or(hn::AndNot(number_bits, hn::BitCast(di, squared)), number), outside);
    third[k] = hn::Min(third[k], hn::Max(second[k], key));
    second[k] = hn::Min(second[k], hn::Max(first[k], key));
    first[k] = hn::Min(first[k], key);
  }

  HWY_INLINE void vertex(const Record& record, VI number) {
    const Vec position = broadcast(record, VertexColumns::position);
    Vec plane[4];
    for (int j = 0; j < 4; ++j) plane[j] = broadcast(record, VertexColumns::direction + 3 * j);
    const V slack = set(-plane_slack);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec from = nodes.at[k] - position;
      V inside = dot_plus(from, plane[0], slack);
      for (int j = 1; j < 4; ++j) inside = hn::And(inside, dot_plus(from, plane[j], slack));
      offer(k, inside, dot(from, from), number);
    }
  }

  HWY_INLINE void edge(const Record& record, VI number) {
    const Vec midpoint = broadcast(record, EdgeColumns::midpoint);
    const Vec t = broadcast(record, EdgeColumns::tangent);
    const Vec b = broadcast(record, EdgeColumns::binormal);
    const Vec n = cross(t, b);
    const V half_length = broadcast_value(record, EdgeColumns::half_length);
    const V second_b = broadcast_value(record, EdgeColumns::second_b);
    const V second_n = broadcast_value(record, EdgeColumns::second_n);
    const V first_limit = broadcast_value(record, EdgeColumns::first_limit);
    const V slack = set(plane_slack);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec from = nodes.at[k] - midpoint;
      const V across_b = dot(from, b);
      const V across_n = dot(from, n);
      // Beyond an end, the distance from the edge is that from the end. The term `beyond` keeps the distance exact also
      // within the slack beyond the ends.
      const V excess = hn::Sub(hn::Abs(dot(from, t)), half_length);
      const V beyond = hn::Max(excess, hn::Zero(d));
      const V squared = hn::MulAdd(across_b, across_b, hn::MulAdd(across_n, across_n, hn::Mul(beyond, beyond)));
      const V past_second = hn::MulAdd(second_b, across_b, hn::MulSub(second_n, across_n, slack));
      offer(k, hn::And(hn::And(hn::Sub(excess, slack), hn::Sub(across_b, first_limit)), past_second), squared, number);
    }
  }

  HWY_INLINE void face(const Record& record, VI number) {
    const Vec anchor = broadcast(record, FaceColumns::anchor);
    const Vec normal = broadcast(record, FaceColumns::normal);
    const Vec gradient_u = broadcast(record, FaceColumns::minus_u);
    const Vec gradient_v = broadcast(record, FaceColumns::minus_v);
    const V minus_one = set(-1.0F);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec from = nodes.at[k] - anchor;
      const V minus_u = dot(from, gradient_u);
      const V minus_v = dot(from, gradient_v);
      const V minus_w = hn::Sub(hn::Sub(minus_one, minus_u), minus_v);
      offer(k, hn::And(hn::And(minus_u, minus_v), minus_w), square(dot(from, normal)), number);
    }
  }

 private:
  /// Returns a . b + rest.
  static HWY_INLINE V dot_plus(const Vec& a, const Vec& b, V rest) {
    return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::MulAdd(a.x, b.x, rest)));
  }
};

/// The closest candidate, the second-closest candidate, and the distance of the third-closest one, for a vector of
/// points. Squared distances are those of keys, which are rounded down.
struct ClosestThree {
  V squared, second, third;
  VI site, second_site;

  ClosestThree()
      : squared(set(hwy::HighestValue<float>())),
        second(squared),
        third(squared),
        site(hn::Set(di, dead_record)),
        second_site(site) {}

  HWY_INLINE void take(V candidate, VI candidate_site) {
    const M is_first = hn::Lt(candidate, squared);
    const M is_second = hn::Lt(candidate, second);
    const auto select = [](M mask, VI yes, VI no) { return hn::IfThenElse(hn::RebindMask(di, mask), yes, no); };
    third = hn::Min(third, hn::Max(candidate, second));
    second_site = select(is_first, site, select(is_second, candidate_site, second_site));
    second = hn::Min(second, hn::Max(candidate, squared));
    site = select(is_first, candidate_site, site);
    squared = hn::Min(candidate, squared);
  }
};

/// Computes one cell. PointWorker owns no results; it holds data that the recursion passes along.
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
    find_candidates(BlockTest<1>(place, dominators));
    divide(cell, mine_.found, dominators, 0);
  }

 private:
  static bool can_divide(const PointCell& cell) { return cell.level < morton_levels && cell.size() > points_per_leaf; }

  [[nodiscard]] const Record* records(std::size_t kind) const { return job_.field.sites->kinds[kind].records.data(); }

  /// Lists the records of the found clusters that may be closest somewhere in the cell.
  void find_candidates(const BlockTest<1>& test) {
    list_records<vertex_kind>(test);
    list_records<edge_kind>(test);
    list_records<face_kind>(test);
    mine_.found.slivers.reset(scratch_.clusters[sliver_kind].size() * cluster_size);
    for (const std::uint32_t cluster : scratch_.clusters[sliver_kind]) {
      for (std::size_t at = cluster * cluster_size; at < (cluster + std::size_t{1}) * cluster_size; ++at) {
        const Record& sliver = records(sliver_kind)[at];
        if (sliver.id != dead_record) mine_.found.slivers.append(sliver);
      }
    }
  }
  template <Kind kind>
  void list_records(const BlockTest<1>& test) {
    RecordIndices& out = mine_.found.of_kind[kind];
    out.reset(scratch_.clusters[kind].size() * cluster_size);
    find_records<kind>(test, job_.field, scratch_.clusters[kind], [&](std::size_t first, M kept) {
      append(hn::Add(hn::Set(di, static_cast<std::uint32_t>(first)), hn::Iota(di, 0)), kept, out);
    });
    out.finish();
  }

  static HWY_INLINE void append(VI index, M kept, RecordIndices& out) {
    hn::StoreU(hn::Compress(index, hn::RebindMask(di, kept)), di, out.end());
    out.grow(hn::CountTrue(d, kept));
  }

  /// Sets an upper bound on the distance of each point, from a given surface point. Leaves the sites unknown.
  void give_up(const PointCell& cell, const Vec3f& surface_point) {
    const Vec p0 = set(surface_point);
    const VI nobody = hn::Set(di, dead_record);
    for (std::size_t at = cell.begin; at < cell.end; at += lanes) {
      const PointNodes<1> node(points_, at);
      const Vec from = node.at[0] - p0;
      put(at, cell.end, dot(from, from), nobody, nobody);
    }
  }

  void put(std::size_t at, std::size_t end, V squared, VI site, VI other) const {
    PointResults& out = *job_.results;
    put(at, end, d, squared, out.squared);
    put(at, end, di, site, out.site);
    put(at, end, di, other, out.other);
  }
  template <class Tag, class Vector, class T>
  static void put(std::size_t at, std::size_t end, Tag tag, Vector values, Buffer<T>& out) {
    if (end - at >= lanes) return hn::StoreU(values, tag, out.data() + at);
    // The values past the end belong to other points, so only some are copied.
    alignas(64) std::array<T, lanes> here;
    hn::Store(values, tag, here.data());
    std::copy_n(here.data(), end - at, out.data() + at);
  }

  void divide(const PointCell& cell, const PointCandidates& candidates, const Dominators& dominators,
              std::size_t depth) {
    if (job_.field.cancel.stop_requested()) return;
    if (candidates.count() > cell.size() * candidates_per_point) return give_up(cell, dominators.point[0]);
    const Halving parts = halves_of(cell);
    const BlockTest<8> test(parts, dominators);
    const std::array<PointCell, 8> cells = children_of(points_.order, cell);
    std::array<PointCandidates, 8>& children = mine_.levels[depth].child;
    ClosestAtCenters closest;
    Split split(cells, children);
    halve<vertex_kind>(test, candidates, split, closest);
    halve<edge_kind>(test, candidates, split, closest);
    halve<face_kind>(test, candidates, split, closest);
    std::array<Vec3f, 8> p0;
    for (std::size_t c = 0; c < 8; ++c) {
      const auto record_of = [&](Kind kind, std::uint32_t index) -> const Record& { return records(kind)[index]; };
      Witness witness = closest_candidate(record_of, closest, c, cells[c].center);
      offer_slivers(candidates.slivers, cells[c].center, witness);
      const bool is_found = witness.squared_distance < hwy::HighestValue<float>();
      p0[c] = is_found ? witness.point : dominators.point[0];
    }
    for (std::size_t c = 0; c < 8; ++c) {
      if (cells[c].size() == 0) continue;
      const CenteredBox place{cells[c].center, parts.half};
      const Dominators of_child{{p0[c], p0[c ^ 1], p0[c ^ 2], p0[c ^ 4]}, Dominators::most};
      list_slivers(candidates.slivers, place, p0[c], children[c].slivers);
      if (!can_divide(cells[c]) || children[c].listed() <= few_candidates) {
        leaf(cells[c], children[c], of_child);
      } else {
        divide(cells[c], children[c], of_child, depth + 1);
      }
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

  /// The children of a cell that have points, and the lists of their candidates.
  struct Split {
    std::array<PointCandidates, 8>& children;
    std::array<std::size_t, 8> with_points{};
    std::size_t count = 0;

    Split(const std::array<PointCell, 8>& cells, std::array<PointCandidates, 8>& lists) : children(lists) {
      for (std::size_t c = 0; c < 8; ++c) {
        if (cells[c].size() > 0) with_points[count++] = c;
      }
    }
  };

  /// Lists the candidates of one kind for each child, and offers them as closest sites at the children's centres.
  template <Kind kind>
  HWY_INLINE void halve(const BlockTest<8>& test, const PointCandidates& candidates, Split& split,
                        ClosestAtCenters& closest) const {
    const RecordIndices& parent = candidates.of_kind[kind];
    const Record* const all = records(kind);
    for (std::size_t k = 0; k < split.count; ++k) {
      split.children[split.with_points[k]].of_kind[kind].reset(parent.count());
    }
    for (std::size_t first = 0; first < parent.count(); first += lanes) {
      const std::uint32_t* const indices = parent.data() + first;
      Columns columns;
      load_columns_of([&](std::size_t k) { return all[indices[k]].column.data(); }, columns);
      const typename BlockOf<kind>::type block(columns, test.middle);
      const M keep = hn::And(hn::FirstN(d, parent.count() - first), test.keeps(block));
      if (hn::AllFalse(d, keep)) continue;
      const VI index = hn::LoadU(di, indices);
      V worst[8];
      test.run(block, keep, hn::Or(index, hn::Set(di, static_cast<std::uint32_t>(kind) << kind_shift)), worst, closest);
      for (std::size_t k = 0; k < split.count; ++k) {
        const std::size_t c = split.with_points[k];
        append(index, hn::And(keep, hn::Le(worst[c], hn::Zero(d))), split.children[c].of_kind[kind]);
      }
    }
    for (std::size_t k = 0; k < split.count; ++k) split.children[split.with_points[k]].of_kind[kind].finish();
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

  /// Removes the candidates that are nowhere closest in a box.
  template <Kind kind>
  void keep_some(const BlockTest<1>& test, RecordIndices& list) const {
    const Record* const all = records(kind);
    const std::size_t count = list.count();
    list.restart();
    NoClosest closest;
    for (std::size_t first = 0; first < count; first += lanes) {
      const std::uint32_t* const indices = list.data() + first;
      Columns columns;
      load_columns_of([&](std::size_t k) { return all[indices[k]].column.data(); }, columns);
      const typename BlockOf<kind>::type block(columns, test.middle);
      const M keep = hn::And(hn::FirstN(d, count - first), test.keeps(block));
      if (hn::AllFalse(d, keep)) continue;
      V worst[1];
      test.run(block, keep, hn::Zero(di), worst, closest);
      append(hn::LoadU(di, indices), hn::And(keep, hn::Le(worst[0], hn::Zero(d))), list);
    }
    list.finish();
  }

  void leaf(const PointCell& cell, PointCandidates& candidates, const Dominators& dominators) {
    if (candidates.listed() > cell.size() * candidates_per_point) return give_up(cell, dominators.point[0]);
    if (candidates.listed() > few_candidates) {
      const BlockTest<1> test(box_around(cell), dominators);
      keep_some<vertex_kind>(test, candidates.of_kind[vertex_kind]);
      keep_some<edge_kind>(test, candidates.of_kind[edge_kind]);
      keep_some<face_kind>(test, candidates.of_kind[face_kind]);
    }
    list_sites(candidates);
    constexpr std::size_t most = 4 * lanes;
    for (std::size_t begin = cell.begin; begin < cell.end; begin += most) {
      const std::size_t end = std::min(begin + most, cell.end);
      switch ((end - begin - 1) / lanes) {
        case 0:
          evaluate<1>(begin, end, candidates);
          break;
        case 1:
          evaluate<2>(begin, end, candidates);
          break;
        case 2:
          evaluate<3>(begin, end, candidates);
          break;
        default:
          evaluate<4>(begin, end, candidates);
      }
    }
    for (std::size_t k = 0; k < candidates.slivers.count(); ++k) offer_sliver(candidates.slivers[k], cell);
  }

  /// Lists the sites of candidates in the order in which they are evaluated.
  void list_sites(const PointCandidates& candidates) {
    std::vector<std::uint32_t>& sites = mine_.sites;
    sites.clear();
    for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
      const RecordIndices& list = candidates.of_kind[kind];
      for (std::size_t i = 0; i < list.count(); ++i) sites.push_back(records(kind)[list.data()[i]].id);
    }
  }

  template <std::size_t vectors>
  HWY_NOINLINE void evaluate(std::size_t begin, std::size_t end, const PointCandidates& candidates) {
    using Pass = PointPass<vectors>;
    const PointNodes<vectors> nodes(points_, begin);
    ClosestThree found[vectors];
    const std::size_t count = mine_.sites.size();
    const std::size_t numbers = std::min(count, Pass::most);
    for (std::size_t first = 0; first < count; first += Pass::most) {
      Pass pass(nodes, numbers);
      std::size_t past = 0;  // candidates of earlier kinds
      const auto for_each = [&](Kind kind, auto use) {
        const RecordIndices& list = candidates.of_kind[kind];
        const std::size_t from = std::max(past, first);
        const std::size_t to = std::min(past + list.count(), first + Pass::most);
        for (std::size_t i = from; i < to; ++i) {
          use(records(kind)[list.data()[i - past]], hn::Set(di, static_cast<std::uint32_t>(i - first)));
        }
        past += list.count();
      };
      for_each(vertex_kind, [&](const Record& record, VI number) { pass.vertex(record, number); });
      for_each(edge_kind, [&](const Record& record, VI number) { pass.edge(record, number); });
      for_each(face_kind, [&](const Record& record, VI number) { pass.face(record, number); });
      for (std::size_t k = 0; k < vectors; ++k) {
        take(pass.first[k], pass.number_bits, first, found[k]);
        take(pass.second[k], pass.number_bits, first, found[k]);
        take(pass.third[k], pass.number_bits, first, found[k]);
      }
    }
    // Keys have room for some bits of the squared distance, so it may be greater by this factor.
    const V above = set(1 + static_cast<float>(std::bit_ceil(numbers)) * 1.2e-7F);
    for (std::size_t k = 0; k < vectors; ++k) put(begin + k * lanes, end, found[k], above);
  }

  /// Adds the candidate of each key.
  /// @param first  index in `sites` of the candidate with number 0.
  HWY_INLINE void take(VI key, VI number_bits, std::size_t first, ClosestThree& found) const {
    constexpr hn::RebindToSigned<D> ds;
    const M is_known = hn::RebindMask(d, hn::Ne(key, hn::Set(di, 0xffffffff)));
    const VI number = hn::IfThenElseZero(hn::RebindMask(di, is_known), hn::And(key, number_bits));
    const VI site = hn::GatherIndex(di, mine_.sites.data() + first, hn::BitCast(ds, number));
    const V squared = hn::BitCast(d, hn::AndNot(number_bits, key));
    found.take(hn::IfThenElse(is_known, squared, set(hwy::HighestValue<float>())), site);
  }

  /// Writes results.
  /// @param above  largest factor by which squared distances exceed those of `found`.
  HWY_INLINE void put(std::size_t at, std::size_t end, const ClosestThree& found, V above) const {
    const VI nobody = hn::Set(di, dead_record);
    const V squared = hn::Min(hn::Mul(found.squared, above), set(hwy::HighestValue<float>()));
    // Distances x <= y cannot be distinguished if y^2 <= (x + tie)^2.
    const V reach = square(hn::Add(hn::Sqrt(squared), set(tie)));
    const M has_other = hn::Le(found.second, reach);
    const M has_third = hn::Le(found.third, reach);
    const auto select = [](M mask, VI yes, VI no) { return hn::IfThenElse(hn::RebindMask(di, mask), yes, no); };
    put(at, end, squared, select(has_third, nobody, found.site), select(has_other, found.second_site, nobody));
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
