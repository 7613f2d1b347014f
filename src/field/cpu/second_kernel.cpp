#include "field/cpu/second_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/second_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/second_bounds-inl.hpp"
#include "field/cpu/second_cell-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

/// A tile with more clusters than this is split, so that lists of candidates stay in cache.
constexpr std::size_t most_clusters = 8000;
constexpr std::int64_t smallest_tile = 16;
constexpr std::int64_t leaf_size = 4;
/// If a site has more links than this, only those near the nodes are evaluated.
constexpr std::size_t many_links = 32;
constexpr std::array<std::size_t, 3> leaf_columns{LeafVertex::count, LeafEdge::count, LeafFace::count};

/// Computes one tile. SecondWorker owns no results; it holds data that the recursion passes along.
class SecondWorker {
 public:
  SecondWorker(const SecondJob& job, SecondScratch& scratch)
      : job_(job),
        field_(job.field),
        mine_(scratch.impl()),
        scratch_(mine_.tile.impl()),
        cell_(mine_.cell),
        unsettled_(scratch.unsettled) {
    for (std::size_t c = 0; c < 8; ++c) {
      Vec3d first;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = field_.spacing[axis] * (((c >> axis) & 1) != 0 ? 0.5 : -3.5);
      }
      full_patterns_[c] = LeafPattern(first, field_.spacing);
    }
  }

  void tile(const NodeBox& box, std::int64_t size) {
    if (field_.cancel.stop_requested()) return;
    if (job_.request.has_band() && is_without_first(box)) return fill(box);
    only_ = job_.links == nullptr ? only_labels(box) : nullptr;
    const CenteredBox place = centered(field_, box);
    const Bounds bounds = bounds_of(place.center);
    if (only_ != nullptr && bounds.count == 0 && !job_.request.labels->has_second(*only_)) return fill(box);
    const std::size_t clusters = find_tile_clusters(field_, BoundedTileTest(place, bounds), scratch_);
    if (clusters > most_clusters && size > smallest_tile) {
      const Halving parts = halve(field_, box, size);
      for (std::size_t c = 0; c < 8; ++c) {
        if (parts.exists[c]) tile(parts.child[c], size / 2);
      }
      return;
    }
    gather_records(field_, BoundedTest<1>(place, bounds), scratch_, scratch_.gathered);
    if (only_ != nullptr) {
      for (RecordList& list : scratch_.gathered) keep_others(list);
    }
    for (std::size_t kind = 0; kind < sliver_kind; ++kind) mine_.all.places[kind].reset_to_all(scratch_.gathered[kind]);
    std::swap(mine_.all.slivers, scratch_.gathered[sliver_kind]);
    divide(box, size, mine_.all, bounds, 0);
  }

 private:
  // --- first sites of a box

  /// Calls visit(index of a row's first node) for the rows of a box, until a call returns false. Returns true if none
  /// did.
  template <class Visit>
  bool all_rows(const NodeBox& box, Visit visit) const {
    const auto& size = field_.request.grid.size;
    for (std::int64_t k = 0; k < box.count[2]; ++k) {
      for (std::int64_t j = 0; j < box.count[1]; ++j) {
        const std::int64_t row = ((box.first[2] + k) * size[1] + box.first[1] + j) * size[0] + box.first[0];
        if (!visit(static_cast<std::size_t>(row))) return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool is_without_first(const NodeBox& box) const {
    return all_rows(box, [&](std::size_t row) {
      const std::uint32_t* sites = job_.request.site + row;
      return std::all_of(sites, sites + box.count[0], [](std::uint32_t site) { return site == dead_record; });
    });
  }

  /// Returns the labels that all first sites of a box share. Returns null if they differ, or if no node has a first
  /// site.
  [[nodiscard]] const OfSite* only_labels(const NodeBox& box) const {
    const OfSite* only = nullptr;
    const bool is_only = all_rows(box, [&](std::size_t row) {
      for (std::int64_t i = 0; i < box.count[0]; ++i) {
        const std::uint32_t site = job_.request.site[row + static_cast<std::size_t>(i)];
        if (site == dead_record) continue;
        if (only == nullptr) only = &job_.labels[site];
        if (*only != job_.labels[site]) return false;
      }
      return true;
    });
    return is_only ? only : nullptr;
  }

  void keep_others(RecordList& list) const {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < list.count(); ++k) {
      if (!share_label(job_.labels[list[k].id], *only_)) list.move(k, kept++);
    }
    list.shorten(kept);
  }

  /// Gives all nodes of a box the limit as their second distance, and no second site.
  void fill(const NodeBox& box) const {
    (void)all_rows(box, [&](std::size_t row) {
      std::fill_n(job_.request.distance2 + row, box.count[0], limit());
      std::fill_n(job_.request.site2 + row, box.count[0], dead_record);
      return true;
    });
  }

  /// Returns the second distance of nodes that have no second site.
  [[nodiscard]] float limit() const {
    return job_.request.has_band() ? static_cast<float>(job_.request.band) : std::numeric_limits<float>::infinity();
  }

  // --- bounds

  [[nodiscard]] Bounds bounds_of(const Vec3f& center) const {
    Bounds out;
    const auto add = [&](const auto& may_be) {
      const Witness found = nearest_record(field_, center, may_be);
      if (found.record == nullptr) return false;
      out.point[out.count] = found.point;
      out.labels[out.count++] = job_.labels[found.record->id];
      return true;
    };
    if (only_ != nullptr) {
      (void)add([&](std::uint32_t site) { return !share_label(job_.labels[site], *only_); });
      return out;
    }
    if (!add([](std::uint32_t) { return true; })) return out;
    const OfSite first = out.labels[0];
    if (!add([&](std::uint32_t site) { return job_.are_apart(first, job_.labels[site]); })) out.count = 0;
    return out;
  }

  /// Returns bounds for a child of a box. The bounds come from the sites closest to the child's centre, one per lane,
  /// that the tests found. If these sites do not suffice, the function returns the parent's bounds.
  [[nodiscard]] Bounds bounds_of_child(const SecondCandidates& candidates, const ClosestAtCenters& closest,
                                       std::size_t child, const Vec3f& center, const Bounds& parent) const {
    alignas(64) std::array<float, lanes> squared;
    alignas(64) std::array<std::uint32_t, lanes> index;
    hn::Store(closest.squared[child], d, squared.data());
    hn::Store(closest.index[child], di, index.data());
    Bounds out;
    const auto take_nearest = [&](const auto& may_be) {
      while (true) {
        const std::size_t lane =
            static_cast<std::size_t>(std::min_element(squared.begin(), squared.end()) - squared.begin());
        if (!(squared[lane] < hwy::HighestValue<float>())) return false;
        squared[lane] = hwy::HighestValue<float>();
        const auto kind = static_cast<Kind>(index[lane] >> kind_shift);
        const Record& record = candidates[kind][index[lane] & ((1U << kind_shift) - 1)];
        Vec3f point;
        if (!may_be(job_.labels[record.id]) || !closest_on_record(kind, record, center, point)) continue;
        out.point[out.count] = point;
        out.labels[out.count++] = job_.labels[record.id];
        return true;
      }
    };
    if (!take_nearest([](const OfSite&) { return true; })) return parent;
    if (only_ != nullptr) return out;
    if (take_nearest([&](const OfSite& labels) { return job_.are_apart(out.labels[0], labels); })) return out;
    // One of the parent's points serves as the further one if its site is apart from that of the child's closest point.
    for (std::size_t k = 0; k < parent.count; ++k) {
      if (!job_.are_apart(out.labels[0], parent.labels[k])) continue;
      out.point[1] = parent.point[k];
      out.labels[1] = parent.labels[k];
      out.count = 2;
      return out;
    }
    return parent;
  }

  // --- recursion

  void divide(const NodeBox& box, std::int64_t size, const SecondCandidates& candidates, const Bounds& bounds,
              std::size_t level) {
    if (size == 2 * leaf_size) return divide_into_leaves(box, candidates, bounds);
    if (field_.cancel.stop_requested()) return;
    const Halving parts = halve(field_, box, size);
    const bool is_cell = size == SecondCell::side;
    const bool has_cells = size == 2 * SecondCell::side;
    if (has_cells) prefetch_firsts(parts.child[0]);
    if (is_cell) begin_cell(box, parts.middle);
    std::array<ChildBits, kind_count>& child_bits = scratch_.levels[level].bits;
    SecondCandidates& of_child = mine_.levels[level];
    ClosestAtCenters closest;
    halve_kinds(test_of(parts, bounds, is_cell), candidates, child_bits, closest,
                [](std::size_t) { return [](auto&&...) {}; });
    for (std::size_t c = 0; c < 8; ++c) {
      if (!parts.exists[c]) continue;
      if (has_cells && c + 1 < 8 && parts.exists[c + 1]) prefetch_firsts(parts.child[c + 1]);
      for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
        list_child(candidates[kind], child_bits[kind], c, of_child.places[kind]);
      }
      const CenteredBox place = centered(field_, parts.child[c]);
      // In a cell, the links have already given better bounds.
      const bool needs_bounds = !is_cell || job_.links == nullptr;
      const Bounds child_bounds = needs_bounds ? bounds_of_child(candidates, closest, c, place.center, bounds) : bounds;
      list_slivers(candidates.slivers, place, child_bounds, of_child.slivers);
      divide(parts.child[c], size / 2, of_child, child_bounds, level + 1);
    }
    if (is_cell) write(box);
  }

  [[nodiscard]] BoundedTest<8> test_of(const Halving& parts, const Bounds& bounds, bool is_in_cell) const {
    BoundedTest<8> test(parts, bounds);
    if (is_in_cell && cell_bound_.is_known) {
      test.bound_by(cell_bound_.around(parts.middle - cell_middle_).domination(parts.middle, parts.reach()));
    }
    return test;
  }

  static void list_slivers(const RecordList& from, const CenteredBox& place, const Bounds& bounds, RecordList& to) {
    to.reset(from.count());
    if (from.count() == 0) return;
    double reach = bounds.count == 0 ? std::numeric_limits<double>::infinity() : 0.0;
    for (std::size_t k = 0; k < bounds.count; ++k) {
      reach = std::max(reach, static_cast<double>(length(bounds.point[k] - place.center)));
    }
    reach = reach * 1.0001 + 2 * length(place.half) + 4 * box_slack;
    const Vec3d center = to_double(place.center);
    for (std::size_t k = 0; k < from.count(); ++k) {
      if (length(center - closest_on_sliver(from[k], center)) <= reach) to.append(from[k]);
    }
  }

  // --- cells

  /// Reads the first sites of a cell, and evaluates the links at all of its nodes.
  void begin_cell(const NodeBox& box, const Vec3f& middle) {
    cell_box_ = box;
    cell_middle_ = middle;
    cell_bound_ = {};
    read_firsts(box);
    for (std::size_t node = 0; node < SecondCell::nodes; node += lanes) {
      const auto is_dead = hn::RebindMask(d, hn::Eq(hn::Load(di, cell_.first.data() + node), hn::Set(di, dead_record)));
      hn::Store(hn::IfThenElse(is_dead, set(-1.0F), set(no_distance)), d, cell_.squared.data() + node);
      hn::Store(hn::Set(di, nobody), di, cell_.id.data() + node);
    }
    if (job_.links != nullptr) cell_bound_ = offer_all_links(box, middle);
  }

  void divide_into_leaves(const NodeBox& box, const SecondCandidates& candidates, const Bounds& bounds) {
    const Halving parts = halve(field_, box, 2 * leaf_size);
    TileScratch::Impl::Level& here = scratch_.levels.back();
    for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
      scratch_.leaf[kind].reset(leaf_columns[kind], candidates[kind].count());
    }
    NoClosest closest;
    halve_kinds(test_of(parts, bounds, true), candidates, here.bits, closest,
                [&](std::size_t kind) { return LeafStore{scratch_.leaf[kind]}; });
    const bool is_full = is_cube(box, 2 * leaf_size);
    for (std::size_t c = 0; c < 8; ++c) {
      if (!parts.exists[c]) continue;
      const LeafInput input{scratch_.leaf, here.bits, c};
      const LeafPattern& pattern = is_full ? full_patterns_[c] : (pattern_ = pattern_of(parts.child[c], parts.middle));
      leaf(parts.child[c], input, candidates.slivers, pattern, parts.middle);
    }
  }

  static bool is_cube(const NodeBox& box, std::int64_t side) {
    return box.count[0] == side && box.count[1] == side && box.count[2] == side;
  }

  /// Evaluates the links for all groups of a cell.
  /// @return  upper bound on the distances, around the cell's centre.
  DistanceBound offer_all_links(const NodeBox& box, const Vec3f& middle) {
    CellSorter sorter(cell_, job_.labels);
    sorter.find_groups();
    sorter.find_labels();
    sorter.order();
    const CellPositions places = positions(box, middle);
    for (std::size_t g = 0; g < cell_.group_count; ++g) {
      const SecondCell::Group& group = cell_.groups[g];
      prefetch_links(g);
      std::span<const std::uint32_t> links = find_links(group.labels);
      if (links.size() > many_links) links = near_links(links, middle, ball_of(cell_, group, places));
      offer_links(links, *job_.links, middle, places, group, cell_);
    }
    return bound_distances(
        SecondCell::nodes, [&](std::size_t node) { return places.following(node); }, cell_.squared.data());
  }

  /// Prefetches the first sites of the next cell, because its rows are scattered in memory.
  void prefetch_firsts(const NodeBox& box) const {
    (void)all_rows(box, [&](std::size_t node) {
      hwy::Prefetch(job_.request.site + node);
      return true;
    });
  }

  void read_firsts(const NodeBox& box) {
    if (!is_cube(box, SecondCell::side)) cell_.first.fill(dead_record);
    for_each_row(box, [&](std::size_t at, std::size_t node) {
      for_each_part(box, [&](std::size_t i, std::size_t part, std::size_t bytes) {
        std::memcpy(cell_.first.data() + at + part, job_.request.site + node + i, bytes);
      });
    });
  }

  /// Calls visit(index in the cell, index in the grid) for the first node of each row of a cell.
  template <class Visit>
  void for_each_row(const NodeBox& box, Visit visit) const {
    const auto rows = static_cast<std::size_t>(box.count[1]);
    std::size_t row = 0;
    (void)all_rows(box, [&](std::size_t node) {
      const std::size_t j = row % rows;
      const std::size_t k = row++ / rows;
      visit(j % 4 * 4 + j / 4 * (4 * leaf_nodes) + k % 4 * 16 + k / 4 * (16 * leaf_nodes), node);
      return true;
    });
  }

  /// Calls visit(offset in the row, offset in the cell, bytes) for the parts of a row, one per leaf. Both offsets are
  /// relative to the row's first node.
  template <class Visit>
  static HWY_INLINE void for_each_part(const NodeBox& box, Visit visit) {
    if (box.count[0] == SecondCell::side) {
      for (std::size_t part = 0; part < 4; ++part) visit(4 * part, part * leaf_nodes, 4 * sizeof(float));
      return;
    }
    const auto count = static_cast<std::size_t>(box.count[0]);
    for (std::size_t i = 0; i < count; i += 4) {
      visit(i, i / 4 * leaf_nodes, std::min<std::size_t>(4, count - i) * sizeof(float));
    }
  }

  [[nodiscard]] CellPositions positions(const NodeBox& box, const Vec3f& middle) const {
    CellPositions out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < SecondCell::row; ++k) {
        const double index = static_cast<double>(box.first[axis] + static_cast<std::int64_t>(k));
        out.axis[axis][k] = static_cast<float>(field_.first_node[axis] + index * field_.spacing[axis] - middle[axis]);
      }
    }
    out.find_layers();
    return out;
  }

  // --- leaves

  [[nodiscard]] LeafPattern pattern_of(const NodeBox& box, const Vec3f& middle) const {
    Vec3d first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] =
          field_.first_node[axis] + static_cast<double>(box.first[axis]) * field_.spacing[axis] - middle[axis];
    }
    return {first, field_.spacing};
  }

  void leaf(const NodeBox& box, const LeafInput& input, const RecordList& slivers, const LeafPattern& pattern,
            const Vec3f& middle) {
    std::size_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      index = 4 * index + static_cast<std::size_t>(box.first[axis] - cell_box_.first[axis]) / 4;
    }
    SecondLeaf state(cell_, index);
    const CenteredBox place = centered(field_, box);
    const Vec offset = set(place.center - middle);
    const DistanceBound known =
        bound_distances(leaf_nodes, [&](std::size_t at) { return positions_of(pattern, at) - offset; }, state.squared);
    if (known.is_known) {
      const Vec3f half = place.half + Vec3f{box_slack, box_slack, box_slack};
      const LeafDomination domination{known.domination(place.center, half), offset};
      dominate<vertex_kind>(input, domination);
      dominate<edge_kind>(input, domination);
      dominate<face_kind>(input, domination);
    }
    evaluate_second(input, pattern, job_.labels, state);
    const float bound = slivers.count() == 0 ? 0 : furthest(state) + length(place.half) * 1.0001F + 4 * box_slack;
    for (std::size_t k = 0; k < slivers.count(); ++k) {
      const Vec3d center = to_double(place.center);
      if (length(center - closest_on_sliver(slivers[k], center)) <= bound) offer_sliver(slivers[k], box, state);
    }
  }

  /// Returns the largest second distance of the nodes so far; a huge value if some node has no second site yet.
  static float furthest(const SecondLeaf& state) {
    V worst = hn::Zero(d);
    for (std::size_t node = 0; node < leaf_nodes; node += lanes) {
      worst = hn::Max(worst, hn::Load(d, state.squared + node));
    }
    const float squared = hn::GetLane(hn::MaxOfLanes(d, worst));
    return squared < no_distance ? std::sqrt(squared) * 1.00001F : 1e18F;
  }

  void offer_sliver(const Record& sliver, const NodeBox& box, SecondLeaf& state) const {
    for (std::size_t node = 0; node < leaf_nodes; ++node) {
      if (state.first[node] == dead_record) continue;
      if (share_label(job_.labels[state.first[node]], job_.labels[sliver.id])) continue;
      const std::array<std::size_t, 3> at{node % 4, node / 4 % 4, node / 16};
      Vec3d query;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        query[axis] = field_.first_node[axis] +
                      field_.spacing[axis] * static_cast<double>(box.first[axis] + static_cast<std::int64_t>(at[axis]));
      }
      const auto squared = static_cast<float>(squared_length(query - closest_on_sliver(sliver, query)));
      if (squared > state.squared[node] || (squared == state.squared[node] && sliver.id >= state.id[node])) continue;
      state.squared[node] = squared;
      state.id[node] = sliver.id;
    }
  }

  /// Prefetches the links of later groups, because they are scattered in memory.
  void prefetch_links(std::size_t g) const {
    if (g + 8 < cell_.group_count) {
      for (const std::uint32_t v : cell_.groups[g + 8].labels) hwy::Prefetch(&job_.links->first[v]);
    }
    if (g + 4 < cell_.group_count) {
      for (const std::uint32_t v : cell_.groups[g + 4].labels) {
        const std::span<const SecondLinks::Entry> entries = job_.links->of(v);
        if (entries.empty()) continue;
        hwy::Prefetch(entries.data());
        hwy::Prefetch(entries.data() + entries.size() - 1);
      }
    }
    if (g + 2 < cell_.group_count) {
      for (const std::uint32_t v : cell_.groups[g + 2].labels) {
        for (const SecondLinks::Entry& entry : job_.links->of(v)) hwy::Prefetch(&job_.links->segments[entry.segment]);
      }
    }
  }

  /// Returns those links of a site's vertices that do not touch the site.
  std::span<const std::uint32_t> find_links(const OfSite& vertices) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0 && (vertices[k] == vertices[0] || (k == 2 && vertices[2] == vertices[1]))) continue;
      const std::span<const SecondLinks::Entry> entries = job_.links->of(vertices[k]);
      if (mine_.links.size() < count + entries.size()) mine_.links.resize(2 * (count + entries.size()));
      std::uint32_t* out = mine_.links.data();
      for (const SecondLinks::Entry& link : entries) {
        out[count] = link.segment;
        unsigned is_own = 0;  // computed without branches, which would be unpredictable
        for (const std::uint32_t v : vertices) {
          is_own |= static_cast<unsigned>(link.start == v) | static_cast<unsigned>(link.end == v);
        }
        count += 1 - is_own;
      }
    }
    return {mine_.links.data(), count};
  }

  /// Returns those links that may be closest to some node of a group. Overwrites the worker's list of links.
  std::span<const std::uint32_t> near_links(std::span<const std::uint32_t> links, const Vec3f& middle,
                                            const GroupBall& ball) {
    const Vec3f center = middle + ball.center;
    mine_.link_distances.resize(links.size());
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < links.size(); ++k) {
      const LinkSegment& segment = job_.links->segments[links[k]];
      const Vec3f from = center - segment.middle;
      const float along = std::clamp(dot(from, segment.tangent), -segment.half_length, segment.half_length);
      mine_.link_distances[k] = length(from - segment.tangent * along);
      nearest = std::min(nearest, mine_.link_distances[k]);
    }
    const float furthest_of_use = (nearest + 2 * ball.radius) * 1.00001F;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < links.size(); ++k) {
      mine_.links[kept] = links[k];
      kept += mine_.link_distances[k] <= furthest_of_use ? 1U : 0U;
    }
    return {mine_.links.data(), kept};
  }

  HWY_NOINLINE void write(const NodeBox& box) {
    const V none = set(limit());
    M open = hn::FirstN(d, 0);
    for (std::size_t node = 0; node < SecondCell::nodes; node += lanes) {
      const V squared = hn::Load(d, cell_.squared.data() + node);
      const V value = hn::Mul(hn::Sqrt(hn::Abs(squared)), set(field_.to_world));
      const M has_none = hn::Ge(squared, set(no_distance));
      const M has_no_first = hn::Lt(squared, hn::Zero(d));
      const M is_beyond = hn::Or(hn::Or(has_none, has_no_first), hn::Gt(value, none));
      open = hn::Or(open, has_none);
      hn::Store(hn::IfThenElse(is_beyond, none, value), d, cell_.squared.data() + node);
      const VI id = hn::Load(di, cell_.id.data() + node);
      // Nodes without a second site keep the id `nobody`, which report_open() searches for.
      const auto is_settled = hn::RebindMask(di, hn::AndNot(has_none, is_beyond));
      hn::Store(hn::IfThenElse(is_settled, hn::Set(di, dead_record), id), di, cell_.id.data() + node);
    }
    const bool has_open = !hn::AllFalse(d, open);
    const bool is_streamed = field_.is_streamed && box.count[0] == SecondCell::side;
    for_each_row(box, [&](std::size_t at, std::size_t node) {
      if (has_open) report_open(box, at, node);
      const bool is_line = is_streamed && node % SecondCell::row == 0;
      put_row(box, cell_.squared.data() + at, job_.request.distance2 + node, is_line);
      put_row(box, cell_.id.data() + at, job_.request.site2 + node, is_line);
    });
  }

  /// Writes a row of a cell to the field. If the row is a whole cache line, it is written past the caches.
  template <class T>
  static HWY_INLINE void put_row(const NodeBox& box, const T* from, T* to, bool is_line) {
    if (!is_line) {
      for_each_part(
          box, [&](std::size_t i, std::size_t part, std::size_t bytes) { std::memcpy(to + i, from + part, bytes); });
      return;
    }
    constexpr hn::CappedTag<T, 4> quarter;
    for (std::size_t i = 0; i < SecondCell::row; i += hn::MaxLanes(quarter)) {
      hn::Stream(hn::Load(quarter, from + i / 4 * leaf_nodes + i % 4), quarter, to + i);
    }
  }

  /// Adds to `unsettled` the nodes for which no second site was found, although some site may be second.
  void report_open(const NodeBox& box, std::size_t at, std::size_t node) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(box.count[0]); ++i) {
      const std::size_t place = at + i / 4 * leaf_nodes + i % 4;
      const std::uint32_t first = cell_.first[place];
      if (first == dead_record || cell_.id[place] != nobody) continue;
      if (job_.request.labels->has_second(job_.labels[first])) unsettled_.push_back(node + i);
      cell_.id[place] = dead_record;
    }
  }

  const SecondJob& job_;
  const FieldJob& field_;
  SecondScratch::Impl& mine_;
  TileScratch::Impl& scratch_;
  SecondCell& cell_;
  std::vector<std::size_t>& unsettled_;
  std::array<LeafPattern, 8> full_patterns_;
  LeafPattern pattern_;  ///< of the current leaf, if the grid's border cuts it
  NodeBox cell_box_;     ///< the current cell
  Vec3f cell_middle_;
  DistanceBound cell_bound_;  ///< around cell_middle_
  /// Labels shared by all first sites of the current tile; used only if the rule is by objects.
  const OfSite* only_ = nullptr;
};

void compute_second_tile_here(const SecondJob& job, const NodeBox& tile, SecondScratch& scratch) {
  SecondWorker(job, scratch).tile(tile, tile_size(job.field.request.grid.size));
  hwy::FlushStream();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blum::cpu {

HWY_EXPORT(compute_second_tile_here);

SecondScratch::SecondScratch() : impl_(std::make_unique<Impl>()) {}
SecondScratch::SecondScratch(SecondScratch&&) noexcept = default;
SecondScratch& SecondScratch::operator=(SecondScratch&&) noexcept = default;
SecondScratch::~SecondScratch() = default;

bool SecondJob::are_apart(const SecondLabels::OfSite& a, const SecondLabels::OfSite& b) const {
  if (share_label(a, b)) return false;
  for (const std::uint32_t label : a) {
    const auto first = others.begin() + first_other[label];
    const auto last = others.begin() + first_other[label + 1];
    for (const std::uint32_t other : b) {
      if (std::binary_search(first, last, other)) return false;
    }
  }
  return true;
}

void compute_second_tile(const SecondJob& job, const NodeBox& tile, SecondScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(compute_second_tile_here)(job, tile, scratch);
}

}  // namespace blum::cpu
#endif
