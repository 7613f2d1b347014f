#include "field/cpu/second_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/second_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come before the headers that are compiled once per target.
#include "field/cpu/gather-inl.hpp"
#include "field/cpu/second_cell-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {
namespace {

using OfSite = SecondLabels::OfSite;

/// A tile with more clusters than this is split, so that candidate lists stay in cache.
constexpr std::size_t most_clusters = 8000;
constexpr std::int64_t smallest_tile = 16;
/// Links of a site beyond this are first cut down to those that are near.
constexpr std::size_t many_links = 32;

/// Surface points that bound how far the second site is: of two that are apart, one may be second wherever anything is
/// first, so that a second site is no further than the further of the two. One alone where it may be second at all
/// nodes at hand; none where nothing is known.
struct Bounds {
  std::array<Vec3f, 2> point{};
  std::array<OfSite, 2> labels{};
  std::size_t count = 0;
};

struct BoundedTileTest {
  TileTest first, second;
  std::size_t count;
  Vec center;
  V radius;

  BoundedTileTest(const CenteredBox& tile, const Bounds& bounds)
      : first(tile, bounds.point[0]),
        second(tile, bounds.point[1]),
        count(bounds.count),
        center(first.center),
        radius(first.radius) {}

  HWY_INLINE std::uint32_t keeps(const BoxArrays& boxes, std::size_t at) const {
    if (count == 0) return 0xffff;
    return count == 1 ? first.keeps(boxes, at) : first.keeps(boxes, at) | second.keeps(boxes, at);
  }
};

template <int boxes>
struct BoundedTest : BlockTest<boxes> {
  Domination other;
  std::size_t count;

  BoundedTest(const CenteredBox& box, const Bounds& bounds)
      : BlockTest<boxes>(box, Dominators{{bounds.point[0]}, 1}),
        other(box.center, Dominators{{bounds.point[1]}, 1}, box.half + Vec3f{box_slack, box_slack, box_slack}),
        count(bounds.count) {}
  BoundedTest(const Halving& h, const Bounds& bounds)
      : BlockTest<boxes>(h, Dominators{{bounds.point[0]}, 1}),
        other(h.middle, Dominators{{bounds.point[1]}, 1}, h.reach()),
        count(bounds.count) {}

  template <class Block>
  HWY_INLINE M keeps(const Block& block) const {
    if (count == 0) return hn::FirstN(d, lanes);
    const M keep = block.keeps(this->domination);
    return count == 1 ? keep : hn::Or(keep, block.keeps(other));
  }
};

/// Works on one tile: owns nothing, holds what the recursion passes along.
class SecondWorker {
 public:
  SecondWorker(const SecondJob& job, SecondScratch& scratch)
      : job_(job),
        field_(job.field),
        mine_(scratch.impl()),
        scratch_(mine_.tile.impl()),
        cell_(mine_.cell),
        unsettled_(scratch.unsettled) {}

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
    divide(box, size, scratch_.gathered, bounds, 0);
  }

 private:
  // --- what is known of a box's first sites

  /// Calls visit(first node of a row) for the rows of a box until it returns false; whether none did.
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

  /// The labels that all first sites of a box have; null where they differ, or there are none.
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

  /// Gives a box of nodes beyond the band no second site.
  void fill(const NodeBox& box) const {
    (void)all_rows(box, [&](std::size_t row) {
      std::fill_n(job_.request.distance2 + row, box.count[0], limit());
      std::fill_n(job_.request.site2 + row, box.count[0], dead_record);
      return true;
    });
  }

  /// What nodes without a second site get.
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

  /// Bounds for a child of a box, of the sites that the lanes have found closest to its centre; else the parent's.
  [[nodiscard]] Bounds bounds_of_child(const Candidates& candidates, const ClosestAtCenters& closest, std::size_t child,
                                       const Vec3f& center, const Bounds& parent) const {
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
        const auto kind = static_cast<Kind>(index[lane] >> 28);
        const Record& record = candidates[kind][index[lane] & 0x0fffffffU];
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
    // The parent's further point does where it is apart from the child's nearest.
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

  void divide(const NodeBox& box, std::int64_t size, const Candidates& candidates, const Bounds& bounds,
              std::size_t level) {
    if (size == SecondCell::side) return cell(box, candidates, bounds);
    if (field_.cancel.stop_requested()) return;
    const Halving parts = halve(field_, box, size);
    TileScratch::Impl::Level& here = scratch_.levels[level];
    ClosestAtCenters closest;
    halve_kinds(BoundedTest<8>(parts, bounds), candidates, here.bits, closest,
                [](std::size_t) { return [](auto&&...) {}; });
    for (std::size_t c = 0; c < 8; ++c) {
      if (!parts.exists[c]) continue;
      for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
        list_child(candidates[kind], here.bits[kind], c, here.child[kind]);
      }
      const CenteredBox place = centered(field_, parts.child[c]);
      // Cells find their bounds in links.
      const bool needs_bounds = size > 2 * SecondCell::side || job_.links == nullptr;
      const Bounds of_child =
          needs_bounds ? bounds_of_child(candidates, closest, c, place.center, bounds) : bounds;
      list_slivers(candidates[sliver_kind], place, of_child, here.child[sliver_kind]);
      divide(parts.child[c], size / 2, here.child, of_child, level + 1);
    }
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

  void cell(const NodeBox& box, const Candidates& candidates, const Bounds& bounds) {
    read_firsts(box);
    CellSorter sorter(cell_, job_.keys.empty() ? nullptr : job_.keys.data());
    sorter.find_groups(box.count);
    const Vec3f middle = centered(field_, box).center;
    sorter.place(positions(box, middle));
    if (job_.links == nullptr) {
      cell_.squared.fill(no_distance);
      cell_.id.fill(nobody);
    }
    for (std::size_t g = 0; g < cell_.group_count; ++g) {
      SecondCell::Group& group = cell_.groups[g];
      group.labels = job_.labels[group.site];
      if (job_.links != nullptr) {
        find_links(group.labels);
        if (mine_.links.size() > many_links) keep_near_links(middle, group);
        offer_links(mine_.links, *job_.links, middle, group, cell_);
      }
      find_extent(cell_, group);
      bound_by_points(bounds, middle, group);
    }
    offer_candidates<vertex_kind>(candidates[vertex_kind], middle, job_.labels, cell_);
    offer_candidates<edge_kind>(candidates[edge_kind], middle, job_.labels, cell_);
    offer_candidates<face_kind>(candidates[face_kind], middle, job_.labels, cell_);
    for (std::size_t k = 0; k < candidates[sliver_kind].count(); ++k) offer_sliver(candidates[sliver_kind][k], middle);
    unsort(cell_);
    write(box);
  }

  void read_firsts(const NodeBox& box) {
    // Rows that are cut off have nodes only as far as anyone looks.
    std::size_t row = 0;
    (void)all_rows(box, [&](std::size_t node) {
      std::copy_n(job_.request.site + node, box.count[0], cell_.first.data() + first_of_row(box, row++));
      return true;
    });
  }

  /// Of the rows of a box, in the cell.
  static std::size_t first_of_row(const NodeBox& box, std::size_t row) {
    const auto rows = static_cast<std::size_t>(box.count[1]);
    return 8 * (row % rows) + 64 * (row / rows);
  }

  /// Of the nodes along each axis, from the cell's middle.
  [[nodiscard]] std::array<std::array<float, 8>, 3> positions(const NodeBox& box, const Vec3f& middle) const {
    std::array<std::array<float, 8>, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 8; ++k) {
        const double index = static_cast<double>(box.first[axis] + static_cast<std::int64_t>(k));
        out[axis][k] = static_cast<float>(field_.first_node[axis] + index * field_.spacing[axis] - middle[axis]);
      }
    }
    return out;
  }

  /// Where a point may be second at all nodes of a group, no second site is further.
  static void bound_by_points(const Bounds& bounds, const Vec3f& middle, SecondCell::Group& group) {
    const float radius = length(group.half) + box_slack;
    for (std::size_t k = 0; k < bounds.count; ++k) {
      if (share_label(bounds.labels[k], group.labels)) continue;
      const float distance = length(middle + group.center - bounds.point[k]);
      group.bound = std::min(group.bound, distance * 1.00001F + 2 * radius);
    }
  }

  /// The links of a site's vertices that do not touch it.
  HWY_NOINLINE void find_links(const OfSite& vertices) {
    mine_.links.clear();
    const auto is_own = [&](std::uint32_t v) { return v == vertices[0] || v == vertices[1] || v == vertices[2]; };
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0 && (vertices[k] == vertices[0] || (k == 2 && vertices[2] == vertices[1]))) continue;
      for (const SecondLinks::Entry& link : job_.links->of(vertices[k])) {
        if (!is_own(link.start) && !is_own(link.end)) mine_.links.push_back(link.segment);
      }
    }
  }

  /// Of many links, those that any node of a group may be closest to.
  void keep_near_links(const Vec3f& middle, SecondCell::Group& group) {
    find_extent(cell_, group);  // what its nodes have does not matter yet
    const Vec3f center = middle + group.center;
    const float radius = length(group.half) + box_slack;
    mine_.link_distances.resize(mine_.links.size());
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < mine_.links.size(); ++k) {
      const LinkSegment& segment = job_.links->segments[mine_.links[k]];
      const Vec3f from = center - segment.middle;
      const float along = std::clamp(dot(from, segment.tangent), -segment.half_length, segment.half_length);
      mine_.link_distances[k] = length(from - segment.tangent * along);
      nearest = std::min(nearest, mine_.link_distances[k]);
    }
    const float furthest_of_use = (nearest + 2 * radius) * 1.00001F;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < mine_.links.size(); ++k) {
      if (mine_.link_distances[k] <= furthest_of_use) mine_.links[kept++] = mine_.links[k];
    }
    mine_.links.resize(kept);
  }

  void offer_sliver(const Record& sliver, const Vec3f& middle) {
    for (std::size_t g = 0; g < cell_.group_count; ++g) {
      const SecondCell::Group& group = cell_.groups[g];
      if (share_label(group.labels, job_.labels[sliver.id])) continue;
      const Vec3d center = to_double(middle + group.center);
      if (length(center - closest_on_sliver(sliver, center)) > group.bound) continue;
      for (std::size_t at = group.begin; at < group.end; ++at) {
        const Vec3d query = to_double(middle) + to_double(Vec3f{cell_.x[at], cell_.y[at], cell_.z[at]});
        const auto squared = static_cast<float>(squared_length(query - closest_on_sliver(sliver, query)));
        if (squared > cell_.squared[at] || (squared == cell_.squared[at] && sliver.id >= cell_.id[at])) continue;
        cell_.squared[at] = squared;
        cell_.id[at] = sliver.id;
      }
    }
  }

  HWY_NOINLINE void write(const NodeBox& box) {
    const V none = set(limit());
    M open = hn::FirstN(d, 0);
    for (std::size_t node = 0; node < static_cast<std::size_t>(64 * box.count[2]); node += lanes) {
      const V squared = hn::Load(d, cell_.distance.data() + node);
      const V value = hn::Mul(hn::Sqrt(squared), set(field_.to_world));
      const M has_none = hn::Ge(squared, set(no_distance));
      const M is_beyond = hn::Or(has_none, hn::Gt(value, none));
      open = hn::Or(open, has_none);
      hn::Store(hn::IfThenElse(is_beyond, none, value), d, cell_.distance.data() + node);
      const VI id = hn::Load(di, cell_.site.data() + node);
      hn::Store(hn::IfThenElse(hn::RebindMask(di, is_beyond), hn::Set(di, dead_record), id), di,
                cell_.site.data() + node);
    }
    std::size_t row = 0;
    (void)all_rows(box, [&](std::size_t node) {
      const std::size_t from = first_of_row(box, row++);
      std::copy_n(cell_.distance.data() + from, box.count[0], job_.request.distance2 + node);
      std::copy_n(cell_.site.data() + from, box.count[0], job_.request.site2 + node);
      return true;
    });
    if (!hn::AllFalse(d, open)) report_open(box);
  }

  /// Nodes that nothing has claimed, although there is something that may be second.
  void report_open(const NodeBox& box) {
    for (std::size_t r = 0; r < cell_.run_count; ++r) {
      const SecondCell::Run& run = cell_.runs[r];
      if (run.group == SecondCell::no_group) continue;
      if (!job_.request.labels->has_second(cell_.groups[run.group].labels)) continue;
      for (std::size_t k = 0; k < run.length; ++k) {
        if (cell_.squared[run.at + k] < no_distance) continue;
        const std::size_t node = run.node + k;
        const std::array<std::size_t, 3> in_cell{node % 8, node / 8 % 8, node / 64};
        std::int64_t index = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
          index = index * field_.request.grid.size[axis] + box.first[axis] + static_cast<std::int64_t>(in_cell[axis]);
        }
        unsettled_.push_back(static_cast<std::size_t>(index));
      }
    }
  }

  const SecondJob& job_;
  const FieldJob& field_;
  SecondScratch::Impl& mine_;
  TileScratch::Impl& scratch_;
  SecondCell& cell_;
  std::vector<std::size_t>& unsettled_;
  const OfSite* only_ = nullptr;  ///< labels of all first sites of the tile at hand, where the rule is by objects
};

void compute_second_tile_here(const SecondJob& job, const NodeBox& tile, SecondScratch& scratch) {
  SecondWorker(job, scratch).tile(tile, tile_size(job.field.request.grid.size));
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
