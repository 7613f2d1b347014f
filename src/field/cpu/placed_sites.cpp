#include "field/cpu/placed_sites.hpp"

#include "blum/core/parallel.hpp"

namespace blum::cpu {

NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named, const GridSpec& grid) {
  const bool is_axis_aligned = grid.direction == Mat3{};
  kernels::Bounds box;
  for (const std::uint32_t v : named) {
    box.extend(is_axis_aligned ? mesh.vertices[v] : grid.direction.transposed_times(mesh.vertices[v]));
  }
  const NormalFrame frame = kernels::make_normal_frame(box, grid);
  kernels::throw_if_faulty(frame);
  return frame;
}

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
