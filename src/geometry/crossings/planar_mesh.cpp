#include "geometry/crossings/planar_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "blum/core/vec3.hpp"

namespace blum::detail {

PlanarMesh::PlanarMesh(const ExactSpace& space, std::size_t axis, const std::array<PointId, 3>& outer)
    : space_(space), axis_(axis), points_(outer.begin(), outer.end()), triangle_at_(3, 0) {
  triangles_.push_back({{0, 1, 2}, {none, none, none}, {}});
}

void PlanarMesh::set(Index triangle, const Corners& corners) {
  triangles_[triangle] = corners;
  for (const Index corner : corners.at) triangle_at_[corner] = triangle;
}

void PlanarMesh::replace(Index triangle, Index old_neighbour, Index new_neighbour) {
  if (triangle == none) return;
  for (Index& beyond : triangles_[triangle].beyond) {
    if (beyond == old_neighbour) {
      beyond = new_neighbour;
      return;
    }
  }
}

std::size_t PlanarMesh::edge_towards(Index own, Index neighbour) const {
  const Corners& t = triangles_[own];
  return t.beyond[0] == neighbour ? 0 : t.beyond[1] == neighbour ? 1 : 2;
}

std::optional<PlanarMesh::Index> PlanarMesh::locate(Index p, std::array<int, 3>& turns) const {
  const auto look = [&](Index t) {
    std::size_t out = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      turns[k] = turn(triangles_[t].at[k], triangles_[t].at[(k + 1) % 3], p);
      if (turns[k] < 0) out = k;
    }
    return out;
  };
  Index t = last_;
  for (std::size_t steps = 0; steps < 2 * triangles_.size() && t != none; ++steps) {
    const std::size_t out = look(t);
    if (out == 3) return t;
    t = triangles_[t].beyond[out];
  }
  // Search all triangles, because a walk through neighbours may cycle if the angles are not the largest possible.
  for (t = 0; t < triangles_.size(); ++t) {
    if (look(t) == 3) return t;
  }
  return std::nullopt;
}

bool PlanarMesh::insert(PointId point) {
  const auto p = static_cast<Index>(points_.size());
  points_.push_back(point);
  triangle_at_.push_back(none);
  index_[point] = p;
  std::array<int, 3> turns{};
  const std::optional<Index> found = locate(p, turns);
  if (!found) return false;
  const auto zeros = std::count(turns.begin(), turns.end(), 0);
  if (zeros > 1) return false;
  if (zeros == 0) {
    split_triangle(*found, p);
  } else {
    split_edge(*found, turns[0] == 0 ? 0 : turns[1] == 0 ? 1 : 2, p);
  }
  last_ = triangle_at_[p];
  return true;
}

void PlanarMesh::split_triangle(Index triangle, Index p) {
  const Corners old = triangles_[triangle];
  const auto second = static_cast<Index>(triangles_.size());
  const std::array<Index, 3> names{triangle, second, second + 1};
  triangles_.resize(triangles_.size() + 2);
  for (std::size_t k = 0; k < 3; ++k) {
    set(names[k], {{old.at[k], old.at[(k + 1) % 3], p},
                   {old.beyond[k], names[(k + 1) % 3], names[(k + 2) % 3]},
                   {old.stays[k], false, false}});
    if (k > 0) replace(old.beyond[k], triangle, names[k]);
  }
}

void PlanarMesh::split_edge(Index triangle, std::size_t k, Index p) {
  const Index other = triangles_[triangle].beyond[k];
  const Corners a = triangles_[triangle];
  const std::size_t j = other == none ? 0 : edge_towards(other, triangle);
  const auto first = static_cast<Index>(triangles_.size());
  const Index second = other == none ? none : first + 1;
  triangles_.resize(triangles_.size() + (other == none ? 1 : 2));
  const std::size_t k1 = (k + 1) % 3;
  const std::size_t k2 = (k + 2) % 3;
  // Splits the edge from u to v at p. w is the corner to the left of the edge, x the corner to its right. The results
  // are u p w, p v w, v p x, p u x.
  set(triangle, {{a.at[k], p, a.at[k2]}, {second, first, a.beyond[k2]}, {a.stays[k], false, a.stays[k2]}});
  set(first, {{p, a.at[k1], a.at[k2]}, {other, a.beyond[k1], triangle}, {a.stays[k], a.stays[k1], false}});
  replace(a.beyond[k1], triangle, first);
  if (other == none) return;
  const Corners b = triangles_[other];
  const std::size_t j1 = (j + 1) % 3;
  const std::size_t j2 = (j + 2) % 3;
  set(other, {{b.at[j], p, b.at[j2]}, {first, second, b.beyond[j2]}, {b.stays[j], false, b.stays[j2]}});
  set(second, {{p, b.at[j1], b.at[j2]}, {triangle, b.beyond[j1], other}, {b.stays[j], b.stays[j1], false}});
  replace(b.beyond[j1], other, second);
}

template <class Visit>
bool PlanarMesh::around(Index corner, const Visit& visit) const {
  const auto corner_in = [&](Index t) {
    const Corners& c = triangles_[t];
    return c.at[0] == corner ? std::size_t{0} : c.at[1] == corner ? std::size_t{1} : std::size_t{2};
  };
  const Index start = triangle_at_[corner];
  Index t = start;
  do {
    const std::size_t k = corner_in(t);
    if (visit(t, k)) return true;
    t = triangles_[t].beyond[(k + 2) % 3];
  } while (t != start && t != none);
  if (t == start) return false;
  // The border is reached: go round the corner in the other direction.
  const std::size_t first = corner_in(start);
  for (t = triangles_[start].beyond[first]; t != none;) {
    const std::size_t k = corner_in(t);
    if (visit(t, k)) return true;
    t = triangles_[t].beyond[k];
  }
  return false;
}

std::optional<PlanarMesh::Edge> PlanarMesh::edge_between(Index from, Index to) const {
  Edge found;
  const bool is_there = around(from, [&](Index t, std::size_t k) {
    if (triangles_[t].at[(k + 1) % 3] == to) found = {t, k};
    if (triangles_[t].at[(k + 2) % 3] == to) found = {t, (k + 2) % 3};
    return found.triangle != none;
  });
  return is_there ? std::optional(found) : std::nullopt;
}

bool PlanarMesh::is_convex(const Edge& edge) const {
  const Corners& a = triangles_[edge.triangle];
  const Index other = a.beyond[edge.k];
  const Corners& b = triangles_[other];
  const Index u = a.at[edge.k];
  const Index v = a.at[(edge.k + 1) % 3];
  const Index w = a.at[(edge.k + 2) % 3];
  const Index x = b.at[(edge_towards(other, edge.triangle) + 2) % 3];
  return turn(w, x, v) > 0 && turn(x, w, u) > 0;
}

void PlanarMesh::flip(const Edge& edge) {
  const Index one = edge.triangle;
  const Corners a = triangles_[one];
  const std::size_t k = edge.k;
  const Index other = a.beyond[k];
  const Corners b = triangles_[other];
  const std::size_t j = edge_towards(other, one);
  const std::size_t k1 = (k + 1) % 3;
  const std::size_t k2 = (k + 2) % 3;
  const std::size_t j1 = (j + 1) % 3;
  const std::size_t j2 = (j + 2) % 3;
  // Flips the edge from u to v, between the triangles u v w and v u x, to the edge from w to x. The results are w u x,
  // x v w.
  set(one, {{a.at[k2], a.at[k], b.at[j2]}, {a.beyond[k2], b.beyond[j1], other}, {a.stays[k2], b.stays[j1], false}});
  set(other, {{b.at[j2], a.at[k1], a.at[k2]}, {b.beyond[j2], a.beyond[k1], one}, {b.stays[j2], a.stays[k1], false}});
  replace(b.beyond[j1], other, one);
  replace(a.beyond[k1], one, other);
}

std::optional<std::deque<std::array<PlanarMesh::Index, 2>>> PlanarMesh::crossed_by(Index from, Index to) const {
  std::deque<std::array<Index, 2>> out;
  Edge next;
  const bool starts = around(from, [&](Index t, std::size_t k) {
    const int right = turn(from, to, triangles_[t].at[(k + 1) % 3]);
    const int left = turn(from, to, triangles_[t].at[(k + 2) % 3]);
    if (right < 0 && left > 0) next = {t, (k + 1) % 3};
    return next.triangle != none;
  });
  if (!starts) return std::nullopt;
  for (std::size_t steps = 0; steps <= triangles_.size(); ++steps) {
    const Corners& t = triangles_[next.triangle];
    const Index other = t.beyond[next.k];
    if (t.stays[next.k] || other == none) return std::nullopt;
    out.push_back({t.at[next.k], t.at[(next.k + 1) % 3]});
    const std::size_t j = edge_towards(other, next.triangle);
    const Index tip = triangles_[other].at[(j + 2) % 3];
    if (tip == to) return out;
    const int side = turn(from, to, tip);
    if (side == 0) return std::nullopt;
    // Crossed edges are directed from the right of the segment to its left. In the triangle `other`, the crossed edge
    // has the opposite direction.
    next = {other, side > 0 ? (j + 1) % 3 : (j + 2) % 3};
  }
  return std::nullopt;
}

bool PlanarMesh::insert_segment(PointId from_point, PointId to_point) {
  const Index from = index_.at(from_point);
  const Index to = index_.at(to_point);
  const auto fix = [&]() {
    const std::optional<Edge> edge = edge_between(from, to);
    if (!edge) return false;
    triangles_[edge->triangle].stays[edge->k] = true;
    if (const Index other = triangles_[edge->triangle].beyond[edge->k]; other != none) {
      triangles_[other].stays[edge_towards(other, edge->triangle)] = true;
    }
    return true;
  };
  if (fix()) return true;
  auto crossed = crossed_by(from, to);
  if (!crossed) return false;
  std::size_t work = 100 + 20 * crossed->size() * crossed->size();
  while (!crossed->empty()) {
    if (work-- == 0) return false;
    const auto [u, v] = crossed->front();
    crossed->pop_front();
    const std::optional<Edge> edge = edge_between(u, v);
    if (!edge) return false;
    if (!is_convex(*edge)) {
      crossed->push_back({u, v});
      continue;
    }
    flip(*edge);
    const Index w = triangles_[edge->triangle].at[0];
    const Index x = triangles_[edge->triangle].at[2];
    if (w == from || w == to || x == from || x == to) continue;
    if (turn(from, to, w) * turn(from, to, x) < 0) crossed->push_back({w, x});
  }
  return fix();
}

bool PlanarMesh::wants_flip(const Edge& edge) const {
  const Corners& a = triangles_[edge.triangle];
  const Index other = a.beyond[edge.k];
  if (a.stays[edge.k] || other == none) return false;
  const Index tip = triangles_[other].at[(edge_towards(other, edge.triangle) + 2) % 3];
  const Index own = a.at[(edge.k + 2) % 3];
  const Index from = a.at[edge.k];
  const Index to = a.at[(edge.k + 1) % 3];
  constexpr Index outer = 3;
  if (tip < outer || own < outer || from < outer || to < outer) return false;
  const Vec3d& u = space_.rounded(points_[from]);
  const Vec3d& v = space_.rounded(points_[to]);
  const auto cotangent = [&](Index at) {
    const Vec3d& p = space_.rounded(points_[at]);
    return dot(u - p, v - p) / std::max(length(cross(u - p, v - p)), 1e-300);
  };
  return cotangent(own) + cotangent(tip) < -1e-9 && is_convex(edge);
}

void PlanarMesh::improve() {
  std::size_t work = 20 * triangles_.size();
  bool changes = true;
  for (int pass = 0; pass < 20 && changes; ++pass) {
    changes = false;
    for (Index t = 0; t < triangles_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (work == 0 || !wants_flip({t, k})) continue;
        flip({t, k});
        --work;
        changes = true;
      }
    }
  }
}

std::vector<std::array<PointId, 3>> PlanarMesh::triangles() const {
  std::vector<std::array<PointId, 3>> out;
  constexpr Index outer = 3;
  for (const Corners& t : triangles_) {
    if (t.at[0] < outer || t.at[1] < outer || t.at[2] < outer) continue;
    out.push_back({points_[t.at[0]], points_[t.at[1]], points_[t.at[2]]});
  }
  return out;
}

}  // namespace blum::detail
