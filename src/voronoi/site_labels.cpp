#include "voronoi/site_labels.hpp"

#include <algorithm>
#include <span>

#include "voronoi/bounded_number.hpp"
#include "voronoi/exact/dyadic.hpp"

namespace blum::voronoi {
namespace {

/// A vector of numbers of any kind.
template <class Number>
struct Vector {
  Number x, y, z;

  explicit Vector(const Vec3d& v) : x(Number(v.x)), y(Number(v.y)), z(Number(v.z)) {}
  Vector(Number first, Number second, Number third) : x(std::move(first)), y(std::move(second)), z(std::move(third)) {}
};

template <class Number>
Vector<Number> between(const Vec3d& from, const Vec3d& to) {
  const Vector<Number> a(from);
  const Vector<Number> b(to);
  return {b.x - a.x, b.y - a.y, b.z - a.z};
}
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The square of a distance as a ratio.
template <class Number>
struct Ratio {
  Number numerator, denominator;
};

template <class Number>
Ratio<Number> squared_distance(const MeshView& mesh, const SiteTable& table, const Label& label, const Vec3d& q) {
  if (label.kind == SiteKind::face) {
    const auto [a, b, c] = triangle_corners(mesh, label.index);
    const Vector<Number> normal = cross(between<Number>(a, b), between<Number>(a, c));
    const Number height = dot(normal, between<Number>(a, q));
    return {height * height, dot(normal, normal)};
  }
  if (label.kind == SiteKind::edge) {
    const auto [a, b] = table.edges()[label.index];
    const Vector<Number> along = between<Number>(mesh.vertices[a], mesh.vertices[b]);
    const Vector<Number> across = cross(along, between<Number>(mesh.vertices[a], q));
    return {dot(across, across), dot(along, along)};
  }
  const Vector<Number> from = between<Number>(mesh.vertices[label.index], q);
  return {dot(from, from), Number(1.0)};
}

/// Where an entry of a rising list is.
std::uint32_t rank_in(const std::vector<std::uint32_t>& list, std::uint32_t entry) {
  return static_cast<std::uint32_t>(std::lower_bound(list.begin(), list.end(), entry) - list.begin());
}

}  // namespace

SiteLabels::SiteLabels(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites)
    : mesh_(mesh), table_(table), sites_(sites) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) all_.push_back({SiteKind::face, t});
  for (const std::uint32_t edge : sites.reflex_edges) all_.push_back({SiteKind::edge, edge});
  for (const std::uint32_t v : sites.reflex_vertices) all_.push_back({SiteKind::vertex, v});
  const auto& reflex = sites.reflex_vertices;
  const auto for_each_use = [&](auto use) {
    for (std::uint32_t edge = 0; edge < table.edges().size(); ++edge) {
      for (const std::uint32_t v : table.edges()[edge]) {
        if (std::binary_search(reflex.begin(), reflex.end(), v)) use(rank_in(reflex, v), edge);
      }
    }
  };
  first_.assign(reflex.size() + 1, 0);
  for_each_use([&](std::uint32_t k, std::uint32_t) { ++first_[k + 1]; });
  for (std::size_t k = 0; k < reflex.size(); ++k) first_[k + 1] += first_[k];
  edges_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for_each_use([&](std::uint32_t k, std::uint32_t edge) { edges_[next[k]++] = edge; });
}

std::uint32_t SiteLabels::site_of(const Label& label) const {
  if (label.kind == SiteKind::face) return sites_.face_of[label.index];
  const auto faces = static_cast<std::uint32_t>(sites_.face_count);
  if (label.kind == SiteKind::edge) return faces + rank_in(sites_.reflex_edges, label.index);
  const auto edges = static_cast<std::uint32_t>(sites_.reflex_edges.size());
  return faces + edges + rank_in(sites_.reflex_vertices, label.index);
}

std::size_t SiteLabels::site_count() const {
  return sites_.face_count + sites_.reflex_edges.size() + sites_.reflex_vertices.size();
}

/// @param expression  callable: a number to tell the kind by -> the number whose sign is asked for.
template <class Expression>
int SiteLabels::sign_of(const Expression& expression) const {
  asked_.fetch_add(1, std::memory_order_relaxed);
  const int sign = expression(BoundedNumber()).sign();
  if (sign != BoundedNumber::unknown) return sign;
  exact_.fetch_add(1, std::memory_order_relaxed);
  return expression(Dyadic()).sign();
}

int SiteLabels::side_of_triangle(std::uint32_t triangle, std::size_t k, const Vec3d& q) const {
  const std::array<Vec3d, 3> p = triangle_corners(mesh_, triangle);
  return sign_of([&]<class Number>(const Number&) {
    const Vector<Number> normal = cross(between<Number>(p[0], p[1]), between<Number>(p[0], p[2]));
    const Vector<Number> inwards = cross(normal, between<Number>(p[k], p[(k + 1) % 3]));
    return dot(inwards, between<Number>(p[k], q));
  });
}

int SiteLabels::side_of_end(std::uint32_t edge, std::size_t end, const Vec3d& q) const {
  const Vec3d& from = mesh_.vertices[table_.edges()[edge][end]];
  const Vec3d& to = mesh_.vertices[table_.edges()[edge][1 - end]];
  return sign_of([&]<class Number>(const Number&) { return dot(between<Number>(from, to), between<Number>(from, q)); });
}

bool SiteLabels::is_in_edge_domain(std::uint32_t edge, const Vec3d& q) const {
  if (side_of_end(edge, 0, q) < 0 || side_of_end(edge, 1, q) < 0) return false;
  for (const std::uint32_t t : sites_.triangles_of[edge]) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (table_.triangle_edges()[t][k].value == edge && side_of_triangle(t, k, q) > 0) return false;
    }
  }
  return true;
}

bool SiteLabels::is_in_domain(const Label& label, const Vec3d& q) const {
  if (label.kind == SiteKind::edge) return is_in_edge_domain(label.index, q);
  if (label.kind == SiteKind::face) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (side_of_triangle(label.index, k, q) < 0) return false;
    }
    return true;
  }
  const std::uint32_t k = rank_in(sites_.reflex_vertices, label.index);
  for (const std::uint32_t edge : std::span(edges_).subspan(first_[k], first_[k + 1] - first_[k])) {
    if (side_of_end(edge, table_.edges()[edge][0] == label.index ? 0 : 1, q) > 0) return false;
  }
  return true;
}

int SiteLabels::compare_distances(const Label& a, const Label& b, const Vec3d& q) const {
  return sign_of([&]<class Number>(const Number&) {
    const Ratio<Number> of_a = squared_distance<Number>(mesh_, table_, a, q);
    const Ratio<Number> of_b = squared_distance<Number>(mesh_, table_, b, q);
    return of_a.numerator * of_b.denominator - of_b.numerator * of_a.denominator;
  });
}

std::vector<Label> SiteLabels::closest_labels(const Vec3d& q) const {
  std::vector<Label> out;
  for (const Label& label : all_) {
    if (!is_in_domain(label, q)) continue;
    const int comparison = out.empty() ? -1 : compare_distances(label, out[0], q);
    if (comparison > 0) continue;
    if (comparison < 0) out.clear();
    out.push_back(label);
  }
  return out;
}

SignCounts SiteLabels::counts() const {
  return {asked_.load(), exact_.load()};
}

}  // namespace blum::voronoi
