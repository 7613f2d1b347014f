// One fast winding number query per node, and the number of nodes that peers compute.
#include <cstdlib>
#include <string_view>

#include "blum/geometry/winding_number.hpp"
#include "peers/bundles.hpp"

namespace blum::bench {

double peer_nodes() {
  const char* const asked = std::getenv("BLUM_BENCH_PEER_NODES");
  if (asked == nullptr || *asked == '\0') return 2.2e6;
  return std::string_view(asked) == "all" ? 1e18 : std::max(1e4, std::atof(asked));
}

PeerField winding_queries(const MeshView& mesh, const GridSpec& grid, const Context& context) {
  PeerField result = empty_result(grid);
  std::optional<WindingNumber> winding;
  run_peer(
      result, context, [&] { winding.emplace(mesh, context); },
      [&](const Bundles& bundles, std::size_t bundle, Field& field) {
        bundles.visit(bundle, [&](std::size_t node, const Vec3d& position) {
          field.distance[node] = winding->approximate(position) > 0.5 ? -1.0F : 1.0F;
        });
      });
  return result;
}

}  // namespace blum::bench
