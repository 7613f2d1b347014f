#include "voronoi/surface_in_cells.hpp"

#include <algorithm>
#include <array>

#include "blum/geometry/grid_predicates.hpp"

namespace blum::voronoi {

bool SurfaceInCells::pierces(std::uint32_t edge, const GridSquare& square) const {
  const Segment& ends = table_.edges()[edge];
  const detail::EdgeEnds p{mesh_.vertices[ends[0]], mesh_.vertices[ends[1]]};
  const std::size_t axis = square.axis;
  const double plane = lattice_.at(axis, square.low[axis]);
  const bool starts_above = detail::is_above(p[0][axis], plane);
  if (starts_above == detail::is_above(p[1][axis], plane)) return false;
  for (const std::size_t along : {next_axis(axis), next_axis(next_axis(axis))}) {
    // Seen against the axis that is left, the edge passes the plane above or below a coordinate.
    const std::size_t seen = 3 - axis - along;
    const auto is_beyond = [&](double coordinate) {
      if (detail::is_above(p[0][along], coordinate) == detail::is_above(p[1][along], coordinate)) {
        return detail::is_above(p[0][along], coordinate);
      }
      const bool axis_is_first = next_axis(seen) == axis;
      const int side = axis_is_first ? detail::side_of_line(p, seen, plane, coordinate)
                                     : detail::side_of_line(p, seen, coordinate, plane);
      // Where the axis is the first one seen and the edge runs up along it, a line to its left is above it.
      const bool line_is_above = (side > 0) == (axis_is_first ? !starts_above : starts_above);
      return !line_is_above;
    };
    if (!is_beyond(lattice_.at(along, square.low[along]))) return false;
    if (is_beyond(lattice_.at(along, square.low[along] + square.length))) return false;
  }
  return true;
}

bool SurfaceInCells::is_in(std::uint32_t vertex, const GridCube& cube) const {
  const Vec3d& p = mesh_.vertices[vertex];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!detail::is_above(p[axis], lattice_.at(axis, cube.low[axis]))) return false;
    if (detail::is_above(p[axis], lattice_.at(axis, cube.low[axis] + cube.length))) return false;
  }
  return true;
}

std::vector<std::uint32_t> SurfaceInCells::edges_of(std::span<const std::uint32_t> triangles) const {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t t : triangles) {
    for (const EdgeId edge : table_.triangle_edges()[t]) out.push_back(edge.value);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace blum::voronoi
