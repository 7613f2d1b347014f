#include "field/cpu/placed_sites.hpp"

#include "blum/core/parallel.hpp"

namespace blum::cpu {

void PlacedSites::build(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        const NormalFrame& frame, const Context& context) {
  positions.resize(mesh.vertices.size());
  const auto& named = adjacency.named_vertices;
  parallel_for(context, named.size(), 1 << 14, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      positions[named[k]] = frame.to_normal(mesh.vertices[named[k]]);
    }
  });
  order_sites(mesh, sites, adjacency, positions, context, order);
  build_site_records(mesh, sites, adjacency, positions, order, context, records);
  build_cluster_forest(records, context, forest);
}

}  // namespace blum::cpu
