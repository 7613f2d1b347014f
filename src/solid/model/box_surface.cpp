#include "solid/model/box_surface.hpp"

#include <algorithm>

#include "blum/core/sort_unique.hpp"

namespace blum::detail {
namespace {

/// Returns the index of a value in an ascending list; the list's size if the value is absent.
std::size_t place_in(std::span<const std::uint32_t> rising, std::uint32_t value) {
  const auto at = std::lower_bound(rising.begin(), rising.end(), value);
  return at != rising.end() && *at == value ? static_cast<std::size_t>(at - rising.begin()) : rising.size();
}

}  // namespace

bool may_meet(const TriangleCorners& t, const Vec3d& low, const Vec3d& high) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (std::min({t[0][a], t[1][a], t[2][a]}) > high[a]) return false;
    if (std::max({t[0][a], t[1][a], t[2][a]}) < low[a]) return false;
  }
  return true;
}

bool may_reach(const TriangleCorners& t, const Vec3d& low, const Vec3d& high) {
  constexpr double rounding = 1e-12;  // relative to the lengths; far more than the actual rounding error
  if (!may_meet(t, low, high)) return false;
  const Vec3d centre = 0.5 * (low + high);
  const Vec3d half = max(high - centre, centre - low);
  const std::array<Vec3d, 3> corners{t[0] - centre, t[1] - centre, t[2] - centre};
  double furthest = length(half);
  for (const Vec3d& corner : corners) furthest = std::max(furthest, length(corner));
  const auto parts = [&](const Vec3d& normal) {
    const Vec3d size = max(normal, -1.0 * normal);
    const double reach = dot(size, half) + rounding * (size.x + size.y + size.z) * furthest;
    const std::array<double, 3> at{dot(normal, corners[0]), dot(normal, corners[1]), dot(normal, corners[2])};
    return std::min({at[0], at[1], at[2]}) > reach || std::max({at[0], at[1], at[2]}) < -reach;
  };
  const std::array<Vec3d, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  if (parts(cross(edges[0], edges[1]))) return false;
  for (const Vec3d& e : edges) {
    if (parts({0, e.z, -e.y}) || parts({-e.z, 0, e.x}) || parts({e.y, -e.x, 0})) return false;
  }
  return true;
}

bool crosses(const TriangleCorners& t, std::size_t axis, const Vec3d& low, const Vec3d& high) {
  if (!may_meet(t, low, high)) return false;
  const double u = low[next_axis(axis)];
  const double v = low[next_axis(next_axis(axis))];
  const int side = side_of_line({t[0], t[1]}, axis, u, v);
  if (side == 0 || side_of_line({t[1], t[2]}, axis, u, v) != side) return false;
  if (side_of_line({t[2], t[0]}, axis, u, v) != side) return false;
  return side_of_node(t, low) == -side && side_of_node(t, high) == side;
}

void sort_along(const SurfaceMesh& mesh, std::size_t axis, const Vec3d& on_line,
                std::vector<std::uint32_t>& triangles) {
  if (triangles.size() < 2) return;
  std::sort(triangles.begin(), triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
    return is_crossed_before(mesh.corners(a), mesh.corners(b), axis, on_line[next_axis(axis)],
                             on_line[next_axis(next_axis(axis))]);
  });
}

bool passes_through(const EdgeEnds& edge, std::size_t across, const Vec3d& low, const Vec3d& high) {
  const double plane = low[across];
  if (is_above(edge[0][across], plane) == is_above(edge[1][across], plane)) return false;
  const int rises = is_above(edge[1][across], plane) ? 1 : -1;
  // The edge passes if, in the plane of `across` and `a`, it meets the plane above low[a] and below high[a].
  for (const std::size_t a : {next_axis(across), next_axis(next_axis(across))}) {
    const std::size_t along = 3 - across - a;
    const auto is_line_above = [&](double coordinate) {
      const int side = next_axis(along) == across ? side_of_line(edge, along, plane, coordinate)
                                                  : -side_of_line(edge, along, coordinate, plane);
      return side * rises > 0;
    };
    if (is_line_above(low[a]) || !is_line_above(high[a])) return false;
  }
  return true;
}

bool is_in_box(const Vec3d& p, const BoxCell& box) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!is_above(p[a], box.low[a]) || is_above(p[a], box.high[a])) return false;
  }
  return true;
}

void BoxPieces::find_met(const SurfaceMesh& mesh, const BoxCell& box, std::span<const std::uint32_t> triangles,
                         std::span<const ArcPart> arcs, std::span<const std::uint32_t> passing) {
  triangles_.clear();
  vertices_.clear();
  edges_.assign(passing.begin(), passing.end());
  for (const ArcPart& arc : arcs) triangles_.push_back(arc.triangle);
  for (const std::uint32_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles()[t][k];
      if (!is_in_box(mesh.vertices()[v], box)) continue;
      triangles_.push_back(t);
      vertices_.push_back(v);
      edges_.push_back(mesh.edges_of(t)[k].value);
      edges_.push_back(mesh.edges_of(t)[(k + 2) % 3].value);
    }
  }
  sort_unique(triangles_);
  sort_unique(edges_);
  sort_unique(vertices_);
}

void BoxPieces::join(const SurfaceMesh& mesh) {
  const std::size_t first_edge = triangles_.size();
  const std::size_t first_vertex = first_edge + edges_.size();
  joined_.reset(first_vertex + vertices_.size());
  const auto join = [&](std::size_t a, std::size_t b) {
    joined_.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  };
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    for (const EdgeId edge : mesh.edges_of(triangles_[k])) {
      if (const std::size_t at = place_in(edges_, edge.value); at < edges_.size()) join(k, first_edge + at);
    }
  }
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    for (const std::uint32_t v : mesh.edges()[edges_[k]]) {
      if (const std::size_t at = place_in(vertices_, v); at < vertices_.size()) join(first_edge + k, first_vertex + at);
    }
  }
  euler_.assign(first_vertex + vertices_.size(), 0);
  for (std::uint32_t k = 0; k < euler_.size(); ++k) {
    euler_[joined_.find(k)] += k >= first_edge && k < first_vertex ? -1 : 1;
  }
}

void BoxPieces::find(const SurfaceMesh& mesh, const BoxCell& box, std::span<const std::uint32_t> triangles,
                     std::span<const ArcPart> arcs, std::span<const std::uint32_t> passing,
                     CubeComponents& components) {
  find_met(mesh, box, triangles, arcs, passing);
  join(mesh);
  is_open_.assign(euler_.size(), false);
  for (const ArcPart& arc : arcs) {
    const std::uint32_t piece = joined_.find(static_cast<std::uint32_t>(place_in(triangles_, arc.triangle)));
    is_open_[piece] = true;
    components.add_arc(piece, arc.part);
  }
  // A piece without an arc is a whole shell. It bounds a body if it contains an outermost vertex, otherwise a void.
  const std::size_t first_vertex = triangles_.size() + edges_.size();
  const auto piece_of = [&](std::size_t vertex) {
    return joined_.find(static_cast<std::uint32_t>(first_vertex + vertex));
  };
  is_outer_.assign(euler_.size(), false);
  const auto outermost = mesh.outermost();
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    if (place_in(outermost, vertices_[k]) < outermost.size()) is_outer_[piece_of(k)] = true;
  }
  holds_void_ = false;
  bodies_.clear();
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    const std::uint32_t piece = piece_of(k);
    if (is_open_[piece]) continue;
    is_open_[piece] = true;  // marks the piece as visited
    if (is_outer_[piece] && euler_[piece] == 2) {
      bodies_.push_back(vertices_[k]);
    } else {
      holds_void_ = true;
    }
  }
}

}  // namespace blum::detail
