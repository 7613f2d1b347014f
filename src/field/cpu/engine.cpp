#include "field/cpu/engine.hpp"

#include <algorithm>
#include <array>

#include "blum/core/parallel.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "field/cpu/second_kernel.hpp"

namespace blum::cpu {
namespace {

constexpr std::size_t grain = 1 << 14;

void copy_floats(const Buffer<float>& from, Buffer<float>& to) {
  if (to.size() < from.size()) to = Buffer<float>(from.size());
  std::copy(from.begin(), from.end(), to.begin());
}

void copy_set(const RecordSet& from, const Context& context, RecordSet& to) {
  if (to.records.size() < from.records.size()) to.records = Buffer<Record>(from.records.size());
  const std::size_t records = (from.count + cluster_size - 1) / cluster_size * cluster_size;
  parallel_for(context, records, grain, "", [&](const WorkRange& range) {
    std::copy_n(from.records.data() + range.begin, range.end - range.begin, to.records.data() + range.begin);
  });
  to.count = from.count;
  to.cluster_boxes.count = from.cluster_boxes.count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    copy_floats(from.cluster_boxes.lower[axis], to.cluster_boxes.lower[axis]);
    copy_floats(from.cluster_boxes.upper[axis], to.cluster_boxes.upper[axis]);
    copy_floats(from.cluster_cones.axis[axis], to.cluster_cones.axis[axis]);
  }
  copy_floats(from.cluster_boxes.reach, to.cluster_boxes.reach);
  copy_floats(from.cluster_cones.cosine, to.cluster_cones.cosine);
  copy_floats(from.cluster_cones.sine, to.cluster_cones.sine);
}

/// Removes the reaches of sites (limits beyond which some surface point is closer). In the second order, the closer
/// surface point may be excluded.
void remove_reaches(SiteRecords& sites, const Context& context) {
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    RecordSet& set = sites.kinds[kind];
    std::fill(set.cluster_boxes.reach.begin(), set.cluster_boxes.reach.end(), far_away);
    if (kind != edge_kind && kind != face_kind) continue;
    parallel_for(context, set.count, grain, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        Record& record = set.records[k];
        if (kind == edge_kind) {
          record.column[EdgeColumns::reach] = far_away;
        } else {
          record.column[FaceColumns::reach_above] = record.column[FaceColumns::reach_below] = far_away;
        }
      }
    });
  }
}

/// A tile of a coarse grid may take long if there are many sites.
Start start_for(const SiteTable& sites) {
  return sites.size() > 5000 ? Start::at_once : Start::measured;
}

/// Returns true if an edge joins vertices of different labels.
bool has_mixed_edges(const SiteTable& sites, const SecondLabels& labels) {
  return std::any_of(sites.edges().begin(), sites.edges().end(),
                     [&](const Segment& edge) { return labels.of_vertex(edge[0]) != labels.of_vertex(edge[1]); });
}

/// For each site, returns only the neighbours and faces that have no labels other than those of the site. They bound
/// the site's domain for any first site.
Adjacency without_other_labels(const FirstSites& first, const SecondLabels& labels) {
  Adjacency out;
  const Adjacency& all = first.adjacency;
  out.named_vertices = all.named_vertices;
  out.first_neighbour.assign(1, 0);
  for (std::uint32_t v = 0; v + 1 < all.first_neighbour.size(); ++v) {
    for (std::size_t k = all.first_neighbour[v]; k < all.first_neighbour[v + 1]; ++k) {
      const std::uint32_t neighbour = all.neighbours[k];
      if (labels.of_vertex(neighbour) == labels.of_vertex(v)) out.neighbours.push_back(neighbour);
    }
    out.first_neighbour.push_back(static_cast<std::uint32_t>(out.neighbours.size()));
  }
  out.edge_faces.assign(all.edge_faces.size(), {no_index, no_index});
  for (std::size_t e = 0; e < all.edge_faces.size(); ++e) {
    const Segment& ends = first.sites.edges()[e];
    std::size_t count = 0;
    for (const std::uint32_t t : all.edge_faces[e]) {
      if (t == no_index) continue;
      const Triangle& corners = first.mesh.triangles[t];
      const bool has_others = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
        return labels.of_vertex(v) != labels.of_vertex(ends[0]) && labels.of_vertex(v) != labels.of_vertex(ends[1]);
      });
      if (!has_others) out.edge_faces[e][count++] = t;
    }
  }
  return out;
}

/// Fields with more nodes (over 16 MB) are written past the caches, because they are not expected to fit there.
constexpr std::size_t fewest_streamed_nodes = std::size_t{1} << 21;

/// Returns the unit vertex pseudonormals, in the coordinate axes of the grid.
std::vector<Vec3f> vertex_sides(const MeshView& mesh, const SiteTable& sites, const NormalFrame& frame,
                                const Context& context) {
  const Pseudonormals normals(mesh, sites, context);
  std::vector<Vec3f> sides(mesh.vertices.size());
  parallel_for(context, sides.size(), 1 << 14, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      const Vec3d normal = frame.direction.transposed_times(normals.normal(SiteId(static_cast<std::uint32_t>(v))));
      const double size = length(normal);
      if (size > 0) {
        sides[v] = {static_cast<float>(normal.x / size), static_cast<float>(normal.y / size),
                    static_cast<float>(normal.z / size)};
      }
    }
  });
  return sides;
}

/// Divides a grid into tiles of at most `size` nodes per side.
struct Tiling {
  std::array<std::int64_t, 3> grid;
  std::int64_t size;
  std::array<std::int64_t, 3> tiles{};

  Tiling(const std::array<std::int64_t, 3>& grid_size, std::int64_t tile) : grid(grid_size), size(tile) {
    for (std::size_t axis = 0; axis < 3; ++axis) tiles[axis] = (grid[axis] + size - 1) / size;
  }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(tiles[0] * tiles[1] * tiles[2]); }
  [[nodiscard]] NodeBox box(std::size_t index) const {
    const auto i = static_cast<std::int64_t>(index);
    const std::array<std::int64_t, 3> at{i % tiles[0], i / tiles[0] % tiles[1], i / (tiles[0] * tiles[1])};
    NodeBox out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.first[axis] = at[axis] * size;
      out.count[axis] = std::min(size, grid[axis] - out.first[axis]);
    }
    return out;
  }
};

}  // namespace

void SecondSites::find_others(const FirstSites& first, const SecondLabels& labels) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (const Segment& edge : first.sites.edges()) {
    const std::uint32_t a = labels.of_vertex(edge[0]);
    const std::uint32_t b = labels.of_vertex(edge[1]);
    if (a == b) continue;
    pairs.push_back({a, b});
    pairs.push_back({b, a});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first_other_.assign(first.mesh.vertices.size() + 1, 0);
  others_.clear();
  for (const auto& pair : pairs) {
    ++first_other_[pair[0] + 1];
    others_.push_back(pair[1]);
  }
  for (std::size_t label = 0; label + 1 < first_other_.size(); ++label) first_other_[label + 1] += first_other_[label];
}

void SecondSites::build(const FirstSites& first, const SecondLabels& labels, const Context& context) {
  has_links_ = labels.is_by_vertex();
  if (!has_links_ && has_mixed_edges(first.sites, labels)) {
    const Adjacency own = without_other_labels(first, labels);
    build_site_records(first.mesh, first.sites, own, first.positions, first.order, context, records_);
  } else {
    for (std::size_t kind = 0; kind < kind_count; ++kind) {
      copy_set(first.records.kinds[kind], context, records_.kinds[kind]);
    }
  }
  remove_reaches(records_, context);
  build_cluster_forest(records_, context, forest_);

  labels_.resize(first.sites.size());
  parallel_for(context, labels_.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      labels_[k] = labels.of_site(first.sites, SiteId(static_cast<std::uint32_t>(k)));
    }
  });
  if (has_links_) {
    first_other_ = first.adjacency.first_neighbour;
    others_ = first.adjacency.neighbours;
    build_link_entries(first.mesh, first.sites, first.adjacency, context, links_);
    build_link_segments(first.mesh, first.sites, first.positions, context, links_);
  } else {
    find_others(first, labels);
  }
}

SecondJob SecondSites::job() const {
  SecondJob out;
  out.labels = labels_;
  out.links = has_links_ ? &links_ : nullptr;
  out.first_other = first_other_;
  out.others = others_;
  return out;
}

void Engine::set_mesh(const MeshView& mesh, const Context& context) {
  mesh_ = mesh;
  if (connectivity_.holds(mesh)) return;
  connectivity_.clear();
  sites_ = SiteTable(mesh, context);
  build_adjacency(mesh, sites_, context, adjacency_);
  connectivity_.store(mesh);
}

void Engine::build_records(const FieldRequest& request, const Context& context) {
  frame_ = make_normal_frame(mesh_, adjacency_.named_vertices, request.grid);
  placed_.build(mesh_, sites_, adjacency_, frame_, context);
}

FieldJob Engine::make_job(const GridSpec& grid, const Context& context) const {
  FieldJob job;
  job.request.grid = grid;
  job.first_node = frame_.first_node;
  job.spacing = frame_.spacing;
  job.to_world = static_cast<float>(1 / frame_.scale);
  job.is_streamed = grid.node_count() > fewest_streamed_nodes;
  job.cancel = context.cancel;
  return job;
}

FieldResult Engine::compute(const FieldRequest& request, const Context& context, std::vector<PhaseTime>& phases) {
  PhaseTimer timer(phases);
  build_records(request, context);
  FieldJob job = make_job(request.grid, context);
  job.request = request;
  job.sites = &placed_.records;
  job.forest = &placed_.forest;
  if (request.has_band()) job.band = static_cast<float>(request.band * frame_.scale);
  const bool by_normals = request.sign == sign::Method::pseudonormals;
  if (by_normals) job.vertex_sides = vertex_sides(mesh_, sites_, frame_, context);
  timer.lap("sites and hierarchy");

  const Tiling tiling(request.grid.size, tile_size(request.grid.size));
  scratch_.resize(static_cast<std::size_t>(thread_count(context)));
  for (TileScratch& scratch : scratch_) scratch.unsettled.clear();
  const auto compute_tiles = [&](const WorkRange& range) {
    for (std::size_t tile = range.begin; tile < range.end; ++tile) {
      compute_tile(job, tiling.box(tile), scratch_[static_cast<std::size_t>(range.worker)]);
    }
  };
  parallel_for(context, tiling.count(), 1, "field", compute_tiles, start_for(sites_));
  FieldResult result;
  result.is_signed = by_normals;
  std::vector<std::size_t>& unsettled = result.unsettled;
  for (const TileScratch& scratch : scratch_) {
    unsettled.insert(unsettled.end(), scratch.unsettled.begin(), scratch.unsettled.end());
  }
  std::sort(unsettled.begin(), unsettled.end());
  timer.lap("field");
  return result;
}

std::vector<std::size_t> Engine::compute_second(const SecondRequest& request, const Context& context) {
  second_.build({mesh_, sites_, adjacency_, placed_.positions, placed_.order, placed_.records}, *request.labels,
                context);
  SecondJob job = second_.job();
  job.field = make_job(request.grid, context);
  job.field.sites = &second_.records();
  job.field.forest = &second_.forest();
  job.request = request;
  const Tiling tiling(request.grid.size, tile_size(request.grid.size));
  std::vector<SecondScratch> scratch(static_cast<std::size_t>(thread_count(context)));
  const auto compute_tiles = [&](const WorkRange& range) {
    for (std::size_t tile = range.begin; tile < range.end; ++tile) {
      compute_second_tile(job, tiling.box(tile), scratch[static_cast<std::size_t>(range.worker)]);
    }
  };
  parallel_for(context, tiling.count(), 1, "second order", compute_tiles, start_for(sites_));
  std::vector<std::size_t> unsettled;
  for (const SecondScratch& one : scratch) {
    unsettled.insert(unsettled.end(), one.unsettled.begin(), one.unsettled.end());
  }
  std::sort(unsettled.begin(), unsettled.end());
  return unsettled;
}

}  // namespace blum::cpu
