#include "field/cpu/site_records.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "blum/core/parallel.hpp"
#include "field/cpu/record_build.hpp"

namespace blum::cpu {
namespace {

constexpr std::size_t clusters_per_range = 64;
constexpr Record dead{.column = {}, .id = dead_record};

void store_box(BoxArrays& boxes, std::size_t index, const Box3& box, float reach) {
  constexpr float rounding = 2e-7F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    boxes.lower[axis][index] = box.is_empty() ? far_away : static_cast<float>(box.lower[axis]) - rounding;
    boxes.upper[axis][index] = box.is_empty() ? far_away : static_cast<float>(box.upper[axis]) + rounding;
  }
  boxes.reach[index] = reach;
}

void store_cone(ConeArrays& cones, std::size_t index, const DirectionCone::Result& cone) {
  for (std::size_t axis = 0; axis < 3; ++axis) cones.axis[axis][index] = cone.axis[axis];
  cones.cosine[index] = cone.cosine;
  cones.sine[index] = cone.sine;
}

/// Writes the reaches of a cluster's sites into their records. Returns the largest reach.
template <Kind kind>
float store_reaches(const ClusterBuild& cluster, const SurfacePoints& points, std::size_t rank,
                    std::span<Record> records) {
  if constexpr (kind != edge_kind && kind != face_kind) return far_away;
  SixteenFloats first;
  SixteenFloats second;
  find_reaches(cluster.reach, points, rank, kind == edge_kind, first, second);
  float largest = 0;
  for (std::size_t lane = 0; lane < records.size(); ++lane) {
    Record& record = records[lane];
    if (record.id == dead_record) continue;
    if constexpr (kind == edge_kind) {
      record.column[EdgeColumns::reach] = first[lane];
    } else {
      record.column[FaceColumns::reach_above] = first[lane];
      record.column[FaceColumns::reach_below] = second[lane];
    }
    largest = std::max({largest, first[lane], kind == edge_kind ? 0.0F : second[lane]});
  }
  return largest;
}

constexpr std::string_view phase_of(Kind kind) {
  return kind == face_kind ? "faces" : kind == edge_kind ? "edges" : kind == vertex_kind ? "vertices" : "";
}

/// Builds all records of a kind.
/// @param prefetch_sites  callable: up to sixteen sites to be built later, and how soon (Ahead).
/// @param build    callable: up to sixteen sites, their records, their ClusterBuild.
/// @param rank_of  callable: site index -> an index on the Morton curve near it.
template <Kind kind, class Prefetch, class Build, class RankOf>
void build_set(std::span<const std::uint32_t> order, const SurfacePoints& points, const Context& context,
               RecordSet& set, Prefetch prefetch_sites, Build build, RankOf rank_of) {
  set.count = order.size();
  const std::size_t clusters = (order.size() + cluster_size - 1) / cluster_size;
  if (set.records.size() < clusters * cluster_size) set.records = Buffer<Record>(clusters * cluster_size);
  set.cluster_boxes.resize(clusters);
  set.cluster_cones.resize(clusters);
  const auto sites_of = [&](std::size_t cluster) {
    const std::size_t first = std::min(cluster * cluster_size, order.size());
    return order.subspan(first, std::min(cluster_size, order.size() - first));
  };
  parallel_for(context, clusters, clusters_per_range, phase_of(kind), [&](const WorkRange& range) {
    for (std::size_t index = range.begin; index < range.end; ++index) {
      prefetch_sites(sites_of(index + 8), Ahead::far);
      prefetch_sites(sites_of(index + 4), Ahead::near);
      ClusterBuild cluster{};
      const std::size_t first = index * cluster_size;
      const std::span<Record> records{set.records.data() + first, cluster_size};
      std::fill(records.begin(), records.end(), dead);
      const std::span<const std::uint32_t> sites = sites_of(index);
      build(sites, records, cluster);
      const float reach = store_reaches<kind>(cluster, points, rank_of(sites[sites.size() / 2]), records);
      store_box(set.cluster_boxes, index, cluster.box, reach);
      store_cone(set.cluster_cones, index, cluster.directions.finish());
    }
  });
}

/// Returns the vertex positions, sorted along the Morton curve.
SurfacePoints surface_points(std::span<const Vec3d> positions, const SiteOrder& order, const Context& context) {
  SurfacePoints points;
  for (auto& coordinate : points.coordinate) coordinate.resize(order.vertices.size());
  parallel_for(context, order.vertices.size(), clusters_per_range * cluster_size, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const Vec3d& p = positions[order.vertices[k]];
      for (std::size_t axis = 0; axis < 3; ++axis) points.coordinate[axis][k] = static_cast<float>(p[axis]);
    }
  });
  return points;
}

/// Computes the bounding box of each sixteen consecutive boxes. Empty boxes are ignored, unless all sixteen are empty.
void bound_children(const BoxArrays& children, const Context& context, BoxArrays& parents) {
  const std::size_t count = (children.count + cluster_size - 1) / cluster_size;
  parents.resize(count);
  parallel_for(context, count, 256, "", [&](const WorkRange& range) {
    for (std::size_t parent = range.begin; parent < range.end; ++parent) {
      const std::size_t first = parent * cluster_size;
      const std::size_t last = std::min(first + cluster_size, children.count);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float lower = far_away;
        float upper = -far_away;
        for (std::size_t child = first; child < last; ++child) {
          lower = std::min(lower, children.lower[axis][child]);
          if (children.lower[axis][child] < far_away) upper = std::max(upper, children.upper[axis][child]);
        }
        parents.lower[axis][parent] = lower;
        parents.upper[axis][parent] = std::max(lower, upper);
      }
      parents.reach[parent] = *std::max_element(children.reach.begin() + static_cast<std::ptrdiff_t>(first),
                                                children.reach.begin() + static_cast<std::ptrdiff_t>(last));
    }
  });
}

}  // namespace

void BoxArrays::resize(std::size_t new_count) {
  // Boxes are read as whole vectors, so the array is padded with empty boxes.
  const std::size_t padded = (new_count + cluster_size - 1) / cluster_size * cluster_size;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (auto* side : {&lower[axis], &upper[axis]}) {
      if (side->size() < padded) *side = Buffer<float>(padded);
      std::fill(side->begin() + static_cast<std::ptrdiff_t>(new_count),
                side->begin() + static_cast<std::ptrdiff_t>(padded), far_away);
    }
  }
  if (reach.size() < padded) reach = Buffer<float>(padded);
  std::fill(reach.begin() + static_cast<std::ptrdiff_t>(new_count), reach.begin() + static_cast<std::ptrdiff_t>(padded),
            0.0F);
  count = new_count;
}

void ConeArrays::resize(std::size_t count) {
  const std::size_t padded = (count + cluster_size - 1) / cluster_size * cluster_size;
  for (Buffer<float>* values : {&axis[0], &axis[1], &axis[2], &cosine, &sine}) {
    if (values->size() < padded) *values = Buffer<float>(padded, 0.0F);
  }
}

void build_site_records(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        std::span<const Vec3d> positions, const SiteOrder& order, const Context& context,
                        SiteRecords& out) {
  const RecordInput input{mesh, sites, adjacency, positions};
  FaceFacts facts;
  facts.normals.resize(mesh.triangles.size());
  facts.is_sliver.resize(mesh.triangles.size());
  const SurfacePoints points = surface_points(positions, order, context);
  const auto build = [&]<Kind kind>(std::span<const std::uint32_t> sites_in_order, auto prefetch_sites,
                                    auto build_cluster, auto rank_of) {
    build_set<kind>(sites_in_order, points, context, out.kinds[kind], prefetch_sites, build_cluster, rank_of);
  };
  const auto no_rank = [](std::uint32_t) { return std::size_t{0}; };
  build.operator()<face_kind>(
      order.faces, [&](auto some, Ahead ahead) { prefetch_faces(input, some, ahead); },
      [&](auto some, auto records, auto& cluster) { build_faces(input, facts, some, records, cluster); },
      [&](std::uint32_t t) -> std::size_t { return order.rank[mesh.triangles[t][0]]; });
  build.operator()<edge_kind>(
      order.edges, [&](auto some, Ahead ahead) { prefetch_edges(input, facts, some, ahead); },
      [&](auto some, auto records, auto& cluster) { build_edges(input, facts, some, records, cluster); },
      [&](std::uint32_t e) -> std::size_t { return order.rank[sites.edges()[e][0]]; });
  build.operator()<vertex_kind>(
      order.vertices, [&](auto some, Ahead ahead) { prefetch_vertices(input, some, ahead); },
      [&](auto some, auto records, auto& cluster) { build_vertices(input, some, records, cluster); }, no_rank);
  std::vector<std::uint32_t> slivers;
  std::copy_if(order.faces.begin(), order.faces.end(), std::back_inserter(slivers),
               [&](std::uint32_t t) { return facts.is_sliver[t] != 0; });
  build.operator()<sliver_kind>(
      slivers, [&](auto some, Ahead ahead) { prefetch_faces(input, some, ahead); },
      [&](auto some, auto records, auto& cluster) { build_slivers(input, some, records, cluster); }, no_rank);
}

void build_cluster_forest(const SiteRecords& sites, const Context& context, ClusterForest& out) {
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    ClusterTree& tree = out.trees[kind];
    const BoxArrays* children = &sites.kinds[kind].cluster_boxes;
    std::size_t depth = 0;
    do {
      if (tree.levels.size() == depth) tree.levels.emplace_back();
      // `children` must be set again, because emplace_back may have moved the level.
      if (depth > 0) children = &tree.levels[depth - 1];
      bound_children(*children, context, tree.levels[depth]);
      children = &tree.levels[depth];
      ++depth;
    } while (children->count > cluster_size);
    tree.levels.resize(depth);
  }
}

}  // namespace blum::cpu
