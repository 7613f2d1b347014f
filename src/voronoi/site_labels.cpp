#include "voronoi/site_labels.hpp"

#include <algorithm>
#include <span>

#include "exact/dyadic.hpp"
#include "voronoi/bounded_number.hpp"

namespace blum::voronoi {

using detail::Dyadic;
namespace {

/// A vector whose coordinates have any type of number.
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

/// A squared distance, or its polar form, as a ratio. Only the numerator depends on the points.
template <class Number>
struct Ratio {
  Number numerator, denominator;
};

template <class Number>
Ratio<Number> squared_distance(const MeshView& mesh, const SiteTable& table, const Label& label, const Vec3d& q,
                               const Vec3d& r) {
  if (label.kind == SiteKind::face) {
    const auto [a, b, c] = triangle_corners(mesh, label.index);
    const Vector<Number> normal = cross(between<Number>(a, b), between<Number>(a, c));
    return {dot(normal, between<Number>(a, q)) * dot(normal, between<Number>(a, r)), dot(normal, normal)};
  }
  if (label.kind == SiteKind::edge) {
    const Vec3d& a = mesh.vertices[table.edges()[label.index][0]];
    const Vector<Number> along = between<Number>(a, mesh.vertices[table.edges()[label.index][1]]);
    return {dot(cross(along, between<Number>(a, q)), cross(along, between<Number>(a, r))), dot(along, along)};
  }
  const Vec3d& v = mesh.vertices[label.index];
  return {dot(between<Number>(v, q), between<Number>(v, r)), Number(1.0)};
}

/// Returns the index of an entry in an ascending list.
std::uint32_t rank_in(const std::vector<std::uint32_t>& list, std::uint32_t entry) {
  return static_cast<std::uint32_t>(std::lower_bound(list.begin(), list.end(), entry) - list.begin());
}

}  // namespace

SiteLabels::SiteLabels(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites)
    : mesh_(mesh), table_(table), sites_(sites), edges_(edges_of_vertices(table)) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) all_.push_back({SiteKind::face, t});
  for (const std::uint32_t edge : sites.reflex_edges) all_.push_back({SiteKind::edge, edge});
  for (const std::uint32_t v : sites.reflex_vertices) all_.push_back({SiteKind::vertex, v});
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

/// @param expression  a callable. It gets a number, which selects the type, and returns the number whose sign is
///                    needed.
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

template <class Visit>
bool SiteLabels::all_sides(const Label& label, const Vec3d& q, Visit visit) const {
  if (label.kind == SiteKind::face) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!visit(side_of_triangle(label.index, k, q))) return false;
    }
    return true;
  }
  if (label.kind == SiteKind::edge) {
    for (const std::size_t end : {0U, 1U}) {
      if (!visit(side_of_end(label.index, end, q))) return false;
    }
    for (const std::uint32_t t : sites_.triangles_of[label.index]) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (table_.triangle_edges()[t][k].value == label.index && !visit(-side_of_triangle(t, k, q))) return false;
      }
    }
    return true;
  }
  for (const std::uint32_t edge : edges_[label.index]) {
    if (!visit(-side_of_end(edge, table_.edges()[edge][0] == label.index ? 0 : 1, q))) return false;
  }
  return true;
}

bool SiteLabels::is_in_domain(const Label& label, const Vec3d& q) const {
  return all_sides(label, q, [](int side) { return side >= 0; });
}

bool SiteLabels::is_apart(const Label& label, const Vec3d& q, const Vec3d& r) const {
  std::vector<bool> is_outside;
  (void)all_sides(label, q, [&](int side) {
    is_outside.push_back(side < 0);
    return true;
  });
  std::size_t plane = 0;
  return !all_sides(label, r, [&](int side) {
    const bool was_outside = is_outside[plane++];
    return side >= 0 || !was_outside;
  });
}

bool SiteLabels::is_attained(const Label& label, const Vec3d& q, const Vec3d& r) const {
  if (label.kind == SiteKind::vertex) return true;
  if (label.kind == SiteKind::face) return is_in_domain(label, q) && is_in_domain(label, r);
  for (const Vec3d* at : {&q, &r}) {
    for (const std::size_t end : {0U, 1U}) {
      if (side_of_end(label.index, end, *at) < 0) return false;
    }
  }
  return true;
}

bool SiteLabels::is_attained(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const {
  if (a.kind != SiteKind::face || b.kind != SiteKind::face || a == b || site_of(a) != site_of(b)) return false;
  // The segment from q to r must not leave either triangle's prism through a side other than the common one.
  const std::array<std::array<EdgeId, 3>, 2> edges{table_.triangle_edges()[a.index], table_.triangle_edges()[b.index]};
  bool have_common = false;
  for (const std::size_t which : {0U, 1U}) {
    const std::uint32_t triangle = which == 0 ? a.index : b.index;
    const std::array<EdgeId, 3>& others = edges[1 - which];
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::find(others.begin(), others.end(), edges[which][k]) != others.end()) {
        have_common = true;
      } else if (side_of_triangle(triangle, k, q) < 0 || side_of_triangle(triangle, k, r) < 0) {
        return false;
      }
    }
  }
  return have_common;
}

int SiteLabels::compare_distances(const Label& a, const Label& b, const Vec3d& q) const {
  return compare_polar(a, b, q, q);
}

int SiteLabels::compare_polar(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const {
  return sign_of([&]<class Number>(const Number&) {
    const Ratio<Number> of_a = squared_distance<Number>(mesh_, table_, a, q, r);
    const Ratio<Number> of_b = squared_distance<Number>(mesh_, table_, b, q, r);
    return of_a.numerator * of_b.denominator - of_b.numerator * of_a.denominator;
  });
}

std::vector<Label> SiteLabels::closest_labels(const Vec3d& q) const {
  return closest_labels(all_, q);
}

std::vector<Label> SiteLabels::closest_labels(std::span<const Label> among, const Vec3d& q) const {
  std::vector<Label> out;
  for (const Label& label : among) {
    if (!is_in_domain(label, q)) continue;
    const int comparison = out.empty() ? -1 : compare_distances(label, out[0], q);
    if (comparison > 0) continue;
    if (comparison < 0) out.clear();
    out.push_back(label);
  }
  return out;
}

bool SiteLabels::are_incident(const Label& a, const Label& b) const {
  const Label& more = a.kind > b.kind ? a : b;  // SiteKind is ordered by dimension, vertices first
  const Label& less = a.kind > b.kind ? b : a;
  if (more.kind == SiteKind::face && less.kind == SiteKind::edge) {
    const auto& edges = table_.triangle_edges()[more.index];
    return std::any_of(edges.begin(), edges.end(), [&](const EdgeId& edge) { return edge.value == less.index; });
  }
  if (more.kind == SiteKind::edge && less.kind == SiteKind::vertex) {
    const Segment& ends = table_.edges()[more.index];
    return ends[0] == less.index || ends[1] == less.index;
  }
  return false;
}

SignCounts SiteLabels::counts() const {
  return {asked_.load(), exact_.load()};
}

}  // namespace blum::voronoi
