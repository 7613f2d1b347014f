// Blum: finds the candidates of a tile in the hierarchies of boxes. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_GATHER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_GATHER_INL
#undef BLUM_FIELD_CPU_GATHER_INL
#else
#define BLUM_FIELD_CPU_GATHER_INL
#endif

#include <bit>

#include "field/cpu/halving-inl.hpp"
#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Calls use(offset, lower corners, upper corners) for sixteen consecutive boxes, one vector at a time. The offset is
/// that of the vector's first box.
template <class Use>
HWY_INLINE void for_each_box_vector(const BoxArrays& boxes, std::size_t first, Use use) {
  for (std::size_t offset = 0; offset < cluster_size; offset += lanes) {
    const auto load = [&](const Buffer<float>& side) { return hn::LoadU(d, side.data() + first + offset); };
    use(offset, Vec{load(boxes.lower[0]), load(boxes.lower[1]), load(boxes.lower[2])},
        Vec{load(boxes.upper[0]), load(boxes.upper[1]), load(boxes.upper[2])});
  }
}

/// Tests boxes around parts of the surface against a tile. Let p0 be a known surface point, x a point of the tile and p
/// one of the box. The box is dropped if p0 is closer to x than p for all x and p. That is, |x - p|^2 - |x - p0|^2 is
/// positive for all x and p. The minimum is separable by axis. Along an axis the difference is linear in x and convex
/// in p. So the minimum is at an end of the tile, with p as close to that end as the box allows.
struct TileTest {
  Vec low, high, low_p0, high_p0;
  V tolerance;
  Vec center;
  V radius;

  TileTest(const CenteredBox& tile, const Vec3f& surface_point) {
    const Vec3f half = tile.half + Vec3f{box_slack, box_slack, box_slack};
    low = set(tile.center - half);
    high = set(tile.center + half);
    center = set(tile.center);
    radius = set(length(half) * 1.0001F + 10 * box_slack);
    const Vec p0 = set(surface_point);
    const Vec from_low = low - p0;
    const Vec from_high = high - p0;
    low_p0 = {square(from_low.x), square(from_low.y), square(from_low.z)};
    high_p0 = {square(from_high.x), square(from_high.y), square(from_high.z)};
    const float squared = squared_length(tile.center - surface_point);
    tolerance = set(4e-6F * squared + 4e-6F * std::sqrt(squared) + 1e-11F);
  }

  static HWY_INLINE V axis(V at_low, V at_high, V low_to_p0, V high_to_p0, V lower, V upper) {
    const V from_low = hn::Sub(at_low, hn::Min(hn::Max(at_low, lower), upper));
    const V from_high = hn::Sub(at_high, hn::Min(hn::Max(at_high, lower), upper));
    return hn::Min(hn::MulSub(from_low, from_low, low_to_p0), hn::MulSub(from_high, from_high, high_to_p0));
  }

  /// Returns one bit for each of sixteen boxes, set if the box is kept.
  HWY_INLINE std::uint32_t keeps(const BoxArrays& boxes, std::size_t first) const {
    std::uint32_t result = 0;
    for_each_box_vector(boxes, first, [&](std::size_t offset, const Vec& lower, const Vec& upper) {
      const V sum = hn::Add(hn::Add(axis(low.x, high.x, low_p0.x, high_p0.x, lower.x, upper.x),
                                    axis(low.y, high.y, low_p0.y, high_p0.y, lower.y, upper.y)),
                            axis(low.z, high.z, low_p0.z, high_p0.z, lower.z, upper.z));
      const auto gap = [](V low_end, V high_end, V lower_end, V upper_end) {
        return hn::Max(hn::Max(hn::Sub(low_end, upper_end), hn::Sub(lower_end, high_end)), hn::Zero(d));
      };
      const Vec apart{gap(low.x, high.x, lower.x, upper.x), gap(low.y, high.y, lower.y, upper.y),
                      gap(low.z, high.z, lower.z, upper.z)};
      const V reach = hn::LoadU(d, boxes.reach.data() + first + offset);
      const M matters = hn::And(hn::Le(sum, tolerance), hn::Le(dot(apart, apart), hn::Mul(reach, reach)));
      result |= bits(matters) << offset;
    });
    return result;
  }
};

/// Returns one bit per cluster (group of sixteen sites), set if the cluster is kept. A cluster is dropped if no
/// direction in which its sites can be closest leads to the tile. Tile and cluster are treated as spheres. The test
/// compares the distance between the tile's centre and the cluster's cone with the sum of the radii.
template <class Test>
HWY_INLINE std::uint32_t meets_cones(const Test& tile, const BoxArrays& boxes, const ConeArrays& cones,
                                     std::size_t first) {
  std::uint32_t result = 0;
  for_each_box_vector(boxes, first, [&](std::size_t offset, const Vec& lower, const Vec& upper) {
    const auto load = [&](const Buffer<float>& values) { return hn::LoadU(d, values.data() + first + offset); };
    const V half = set(0.5F);
    const Vec size = upper - lower;
    const Vec sum = upper + lower;
    const Vec from_cluster{hn::NegMulAdd(sum.x, half, tile.center.x), hn::NegMulAdd(sum.y, half, tile.center.y),
                           hn::NegMulAdd(sum.z, half, tile.center.z)};
    const V reach = hn::MulAdd(hn::Sqrt(dot(size, size)), half, tile.radius);
    const Vec axis{load(cones.axis[0]), load(cones.axis[1]), load(cones.axis[2])};
    const V along = dot(from_cluster, axis);
    const Vec across{hn::NegMulAdd(along, axis.x, from_cluster.x), hn::NegMulAdd(along, axis.y, from_cluster.y),
                     hn::NegMulAdd(along, axis.z, from_cluster.z)};
    const V apart =
        hn::NegMulAdd(hn::Abs(along), load(cones.sine), hn::Mul(hn::Sqrt(dot(across, across)), load(cones.cosine)));
    result |= bits(hn::Le(apart, reach)) << offset;
  });
  return result;
}

HWY_INLINE std::uint32_t existing_boxes(std::size_t first, std::size_t count) {
  return count - first >= cluster_size ? 0xffffU : (1U << (count - first)) - 1;
}

/// Finds the clusters that may contain a closest site of the tile's nodes, by depth-first search in storage order.
template <class Test>
HWY_NOINLINE void find_clusters(const ClusterTree& tree, const RecordSet& set_of_kind, const Test& test,
                                std::size_t level, std::size_t first, std::vector<std::uint32_t>& out) {
  const BoxArrays& boxes = level == 0 ? set_of_kind.cluster_boxes : tree.levels[level - 1];
  std::uint32_t kept = test.keeps(boxes, first) & existing_boxes(first, boxes.count);
  if (level == 0 && kept != 0) kept &= meets_cones(test, boxes, set_of_kind.cluster_cones, first);
  while (kept != 0) {
    const std::size_t box = first + static_cast<std::size_t>(std::countr_zero(kept));
    kept &= kept - 1;
    if (level == 0) {
      out.push_back(static_cast<std::uint32_t>(box));
    } else {
      find_clusters(tree, set_of_kind, test, level - 1, box * cluster_size, out);
    }
  }
}

/// Finds the record closest to a point, among those for which may_be(site id) is true. The search visits the nearest
/// boxes first.
template <class MayBe>
struct NearestSearch {
  const SiteRecords& sites;
  const ClusterForest& forest;
  Vec3f query;
  const MayBe& may_be;
  Witness best{};

  void visit_cluster(Kind kind, std::size_t cluster) {
    const RecordSet& set_of_kind = sites.kinds[kind];
    const std::size_t end = std::min((cluster + 1) * cluster_size, set_of_kind.count);
    for (std::size_t at = cluster * cluster_size; at < end; ++at) {
      const Record& record = set_of_kind.records[at];
      Vec3f point;
      if (record.id == dead_record || !closest_on_record(kind, record, query, point)) continue;
      const float squared = squared_length(query - point);
      if (squared < best.squared_distance && may_be(record.id)) best = {point, kind, &record, squared};
    }
  }

  void visit(Kind kind, std::size_t level, std::size_t first) {
    const ClusterTree& tree = forest.trees[kind];
    const BoxArrays& boxes = level == 0 ? sites.kinds[kind].cluster_boxes : tree.levels[level - 1];
    alignas(64) std::array<float, cluster_size> squared{};
    const Vec q = set(query);
    for_each_box_vector(boxes, first, [&](std::size_t offset, const Vec& lower, const Vec& upper) {
      const auto gap = [](V at, V low, V high) { return hn::Sub(at, hn::Min(hn::Max(at, low), high)); };
      const Vec to_box{gap(q.x, lower.x, upper.x), gap(q.y, lower.y, upper.y), gap(q.z, lower.z, upper.z)};
      hn::StoreU(dot(to_box, to_box), d, squared.data() + offset);
    });
    std::array<std::uint8_t, cluster_size> order{};
    std::size_t open = 0;
    const std::size_t count = std::min(cluster_size, boxes.count - first);
    for (std::size_t k = 0; k < count; ++k) {
      if (!(squared[k] < best.squared_distance)) continue;
      std::size_t at = open++;
      for (; at > 0 && squared[order[at - 1]] > squared[k]; --at) order[at] = order[at - 1];
      order[at] = static_cast<std::uint8_t>(k);
    }
    for (std::size_t k = 0; k < open; ++k) {
      if (!(squared[order[k]] < best.squared_distance)) return;
      if (level == 0) {
        visit_cluster(kind, first + order[k]);
      } else {
        visit(kind, level - 1, (first + order[k]) * cluster_size);
      }
    }
  }

  void run() {
    for (std::size_t kind = 0; kind < kind_count; ++kind) {
      if (sites.kinds[kind].count > 0) visit(static_cast<Kind>(kind), forest.trees[kind].levels.size(), 0);
    }
  }
};

template <class MayBe>
HWY_INLINE Witness nearest_record(const FieldJob& job, const Vec3f& query, const MayBe& may_be) {
  NearestSearch<MayBe> search{*job.sites, *job.forest, query, may_be};
  search.run();
  return search.best;
}
HWY_INLINE Witness nearest_record(const FieldJob& job, const Vec3f& query) {
  return nearest_record(job, query, [](std::uint32_t) { return true; });
}

/// Records are prefetched this many clusters before their use.
constexpr std::size_t clusters_ahead = 3;

HWY_INLINE void prefetch_cluster(const Record* records) {
  for (std::size_t k = 0; k < cluster_size; ++k) hwy::Prefetch(records + k);
}

/// Finds the clusters of all kinds that may contain a closest site of the tile's nodes. Returns their number.
template <class Test>
HWY_INLINE std::size_t find_tile_clusters(const FieldJob& job, const Test& test, TileScratch::Impl& scratch) {
  std::size_t total = 0;
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    auto& clusters = scratch.clusters[kind];
    clusters.clear();
    const RecordSet& set_of_kind = job.sites->kinds[kind];
    if (set_of_kind.count == 0) continue;
    const ClusterTree& tree = job.forest->trees[kind];
    find_clusters(tree, set_of_kind, test, tree.levels.size(), 0, clusters);
    total += clusters.size();
  }
  return total;
}

/// Calls use(index of a vector's first record, mask) for each vector of records of the found clusters. The mask has the
/// records that may be closest somewhere in the tile.
template <Kind kind, class Test, class Use>
HWY_INLINE void find_records(const Test& test, const FieldJob& job, const std::vector<std::uint32_t>& clusters,
                             Use use) {
  const Record* records = job.sites->kinds[kind].records.data();
  NoClosest closest;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    // Cancellation is checked here because at the centre of a sphere no site can be dropped.
    if (job.cancel.stop_requested()) return;
    const std::size_t begin = clusters[k] * cluster_size;
    if (k + clusters_ahead < clusters.size()) prefetch_cluster(records + clusters[k + clusters_ahead] * cluster_size);
    for (std::size_t first = begin; first < begin + cluster_size; first += lanes) {
      Columns columns;
      load_columns(records + first, columns);
      const M is_live = hn::RebindMask(d, hn::Ne(hn::BitCast(di, columns.column[15]), hn::Set(di, dead_record)));
      const typename BlockOf<kind>::type block(columns, test.middle);
      const M keep = hn::And(is_live, test.keeps(block));
      if (hn::AllFalse(d, keep)) continue;
      V worst[1];
      test.run(block, keep, hn::Zero(di), worst, closest);
      const M kept = hn::And(keep, hn::Le(worst[0], hn::Zero(d)));
      if (!hn::AllFalse(d, kept)) use(first, kept);
    }
  }
}

/// Appends the records of the found clusters that may be closest somewhere in the tile. The records are sorted later.
template <Kind kind, class Test>
HWY_NOINLINE void find_records(const Test& test, const FieldJob& job, const std::vector<std::uint32_t>& clusters,
                               std::vector<detail::KeyedIndex>& out) {
  const Record* records = job.sites->kinds[kind].records.data();
  find_records<kind>(test, job, clusters, [&](std::size_t first, M found) {
    for (std::uint32_t kept = bits(found); kept != 0; kept &= kept - 1) {
      const std::size_t at = first + static_cast<std::size_t>(std::countr_zero(kept));
      out.push_back({records[at].id, static_cast<std::uint32_t>(at)});
    }
  });
}

/// Copies the records that may be closest somewhere in a tile, in ascending order of site id.
template <class Test>
HWY_INLINE void gather_records(const FieldJob& job, const Test& test, TileScratch::Impl& scratch, Candidates& out) {
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    const Record* records = job.sites->kinds[kind].records.data();
    const auto& clusters = scratch.clusters[kind];
    scratch.order.clear();
    if (kind == vertex_kind) find_records<vertex_kind>(test, job, clusters, scratch.order);
    if (kind == edge_kind) find_records<edge_kind>(test, job, clusters, scratch.order);
    if (kind == face_kind) find_records<face_kind>(test, job, clusters, scratch.order);
    if (kind == sliver_kind) {
      for (const std::uint32_t cluster : clusters) {
        for (std::size_t at = cluster * cluster_size; at < (cluster + std::size_t{1}) * cluster_size; ++at) {
          if (records[at].id != dead_record) scratch.order.push_back({records[at].id, static_cast<std::uint32_t>(at)});
        }
      }
    }
    detail::radix_sort(scratch.order, scratch.order_scratch);
    out[kind].reset(scratch.order.size());
    for (const detail::KeyedIndex& item : scratch.order) out[kind].append(records[item.index]);
    out[kind].finish();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
