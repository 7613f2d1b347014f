#include "field/second_order.hpp"

#include <cmath>
#include <limits>

#include "blum/core/parallel.hpp"
#include "field/second_search.hpp"

namespace blum {

void settle_second(const std::vector<std::size_t>& nodes, const MeshView& mesh, const SiteTable& sites,
                   const SecondRequest& request, const Context& context) {
  if (nodes.empty()) return;
  const SecondSearch search(mesh, sites, *request.labels, context);
  const double limit = request.has_band() ? request.band : std::numeric_limits<double>::infinity();
  const GridSpec& grid = request.grid;
  parallel_for(context, nodes.size(), 64, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto node = static_cast<std::int64_t>(nodes[k]);
      const SiteId first(request.site[nodes[k]]);
      SecondSite second;
      if (first.has_value()) {
        const Vec3d query = grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1],
                                          node / (grid.size[0] * grid.size[1]));
        second = search.find(query, first, std::abs(static_cast<double>(request.distance[nodes[k]])), limit);
      }
      request.distance2[nodes[k]] = static_cast<float>(second.site.has_value() ? second.distance : limit);
      request.site2[nodes[k]] = second.site.value;
    }
  });
}

}  // namespace blum
