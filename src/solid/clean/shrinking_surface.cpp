#include "solid/clean/shrinking_surface.hpp"

#include <algorithm>
#include <cmath>

namespace blum::detail {
namespace {

/// Returns which corner (0, 1, 2) of a triangle is the given vertex.
std::size_t place_of(const Triangle& triangle, std::uint32_t v) {
  return triangle[0] == v ? 0 : triangle[1] == v ? 1 : 2;
}

}  // namespace

ShrinkingSurface::ShrinkingSurface(const MeshView& mesh)
    : points_(mesh.vertices),
      triangles_(mesh.triangles.begin(), mesh.triangles.end()),
      at_(mesh.vertices.size()),
      left_(mesh.triangles.size()) {
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (const std::uint32_t v : triangles_[t]) at_[v].push_back(t);
  }
}

void ShrinkingSurface::find_star(std::uint32_t v, Star& out) const {
  const std::vector<std::uint32_t>& around = at_[v];
  out.ring.clear();
  out.triangles = around;
  const auto next_of = [&](std::uint32_t t, std::size_t step) {
    return triangles_[t][(place_of(triangles_[t], v) + step) % 3];
  };
  if (out.triangles.empty()) return;
  std::sort(out.triangles.begin(), out.triangles.end(),
            [&](std::uint32_t a, std::uint32_t b) { return next_of(a, 1) < next_of(b, 1); });
  std::vector<std::uint32_t> ordered;
  ordered.reserve(around.size());
  std::uint32_t corner = next_of(out.triangles.front(), 1);
  for (std::size_t k = 0; k < around.size(); ++k) {
    const auto at = std::lower_bound(out.triangles.begin(), out.triangles.end(), corner,
                                     [&](std::uint32_t t, std::uint32_t wanted) { return next_of(t, 1) < wanted; });
    out.ring.push_back(corner);
    ordered.push_back(*at);
    corner = next_of(*at, 2);
  }
  out.triangles.swap(ordered);
}

bool ShrinkingSurface::has_edge(std::uint32_t a, std::uint32_t b) const {
  const std::vector<std::uint32_t>& around = at_[a].size() < at_[b].size() ? at_[a] : at_[b];
  const std::uint32_t wanted = at_[a].size() < at_[b].size() ? b : a;
  return std::any_of(around.begin(), around.end(), [&](std::uint32_t t) {
    const Triangle& triangle = triangles_[t];
    return triangle[0] == wanted || triangle[1] == wanted || triangle[2] == wanted;
  });
}

EdgePair ShrinkingSurface::opposite_edge(std::uint32_t t, std::uint32_t corner) const {
  const std::size_t k = place_of(triangles_[t], corner);
  EdgePair out;
  out.left = t;
  out.apex_left = corner;
  out.a = triangles_[t][(k + 1) % 3];
  out.b = triangles_[t][(k + 2) % 3];
  // Finds the triangle that contains b and a in this order, among the triangles at the end with fewer of them.
  const bool at_a = at_[out.a].size() <= at_[out.b].size();
  for (const std::uint32_t other : at_[at_a ? out.a : out.b]) {
    const Triangle& triangle = triangles_[other];
    const std::size_t place = place_of(triangle, out.b);
    if (triangle[place] != out.b || triangle[(place + 1) % 3] != out.a) continue;
    out.right = other;
    out.apex_right = triangle[(place + 2) % 3];
    break;
  }
  return out;
}

bool ShrinkingSurface::may_collapse(const Star& star, std::size_t onto) const {
  const std::size_t count = star.ring.size();
  const std::uint32_t w = star.ring[onto];
  // Only the two corners next to w in the ring may already be neighbours of w.
  for (std::size_t step = 2; step + 1 < count; ++step) {
    if (has_edge(star.ring[(onto + step) % count], w)) return false;
  }
  if (count > 3) return true;
  // If w has only 3 triangles, the surface is a tetrahedron.
  return at_[w].size() > 3;
}

void ShrinkingSurface::take_out(std::uint32_t v, std::uint32_t triangle) {
  std::vector<std::uint32_t>& around = at_[v];
  around.erase(std::find(around.begin(), around.end(), triangle));
}

void ShrinkingSurface::collapse(std::uint32_t v, const Star& star, std::size_t onto) {
  const std::size_t count = star.ring.size();
  const std::uint32_t w = star.ring[onto];
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t t = star.triangles[k];
    if (k == onto || (k + 1) % count == onto) {
      take_out(w, t);
      take_out(star.ring[k == onto ? (k + 1) % count : k], t);
      triangles_[t] = {w, w, w};
      --left_;
    } else {
      triangles_[t][place_of(triangles_[t], v)] = w;
      at_[w].push_back(t);
    }
  }
  at_[v].clear();
}

void ShrinkingSurface::flip(const EdgePair& edge) {
  take_out(edge.b, edge.left);
  take_out(edge.a, edge.right);
  at_[edge.apex_right].push_back(edge.left);
  at_[edge.apex_left].push_back(edge.right);
  triangles_[edge.left] = {edge.apex_left, edge.a, edge.apex_right};
  triangles_[edge.right] = {edge.apex_right, edge.b, edge.apex_left};
}

double longest_side(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return std::sqrt(std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)}));
}

double least_height(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double longest = longest_side(a, b, c);
  return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

}  // namespace blum::detail
