#include "blum/voronoi/failing_cells.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"

namespace blum {

void add_failing_cells(Complex& complex, std::span<const FailingVoronoiCell> failing) {
  constexpr std::size_t corners = 8;
  if (!complex.edges.empty()) throw InvalidOption("failing cells: the complex has edges already");
  const std::size_t first = complex.positions.size();
  if (failing.size() > (max_id_count - first) / corners) {
    throw InvalidOption("failing cells: their corners are more vertices than a complex may have");
  }
  std::vector<std::int32_t> obstacles;
  for (const FailingVoronoiCell& cell : failing) {
    const auto base = static_cast<std::uint32_t>(complex.positions.size());
    for (std::uint32_t k = 0; k < corners; ++k) {
      Vec3d corner = cell.low;
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        if ((k >> axis & 1U) != 0) {
          corner[axis] = cell.high[axis];
        } else {
          complex.edges.push_back({base + k, base + (k | 1U << axis)});
          obstacles.push_back(static_cast<std::int32_t>(cell.obstacle));
        }
      }
      complex.positions.push_back(corner);
    }
  }
  complex.vertex_columns.resize(complex.positions.size());
  for (const char* name : {"site_0", "site_1"}) {
    if (complex.vertex_columns.find(name) == nullptr) continue;
    const auto sites = complex.vertex_columns.edit<std::int32_t>(name);
    for (std::size_t k = first; k < sites.size(); ++k) sites[k] = -1;
  }
  complex.edge_columns = Columns(complex.edges.size());
  complex.edge_columns.add({"obstacle", 1, std::move(obstacles)});
}

}  // namespace blum
