#include "voronoi/traced/planar_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

/// Returns the normal of a triangle. Its length is twice the area.
Vec3d normal_of(const MeshView& mesh, std::span<const Vec3d> vertices, std::uint32_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
}

/// Joins triangles, and keeps the plane of the largest triangle of each set.
class Joiner {
 public:
  Joiner(const MeshView& mesh, std::span<const Vec3d> vertices, double flatness)
      : mesh_(mesh), vertices_(vertices), flatness_(flatness), sets_(mesh.triangles.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3d normal = normal_of(mesh, vertices, t);
      planes_.push_back({unit(normal), vertices[mesh.triangles[t][0]], length(normal)});
      members_.push_back({t});
    }
  }

  /// Joins the sets of two triangles if the corners of both lie near the plane of the larger triangle.
  void join(std::uint32_t first, std::uint32_t second, bool is_exact) {
    std::uint32_t large = sets_.find(first), small = sets_.find(second);
    if (large == small) return;
    if (planes_[large].area < planes_[small].area) std::swap(large, small);
    if (!is_exact && !is_near(planes_[large], members_[small])) return;
    const Plane plane = planes_[large];
    std::vector<std::uint32_t> all = std::move(members_[large]);
    all.insert(all.end(), members_[small].begin(), members_[small].end());
    members_[small].clear();
    sets_.join(large, small);
    const std::uint32_t root = sets_.find(large);
    planes_[root] = plane;
    members_[root] = std::move(all);
  }

  [[nodiscard]] std::uint32_t set_of(std::uint32_t t) { return sets_.find(t); }

 private:
  struct Plane {
    Vec3d normal;
    Vec3d point;
    double area = 0;  ///< twice the area of the triangle
  };

  [[nodiscard]] bool is_near(const Plane& plane, const std::vector<std::uint32_t>& triangles) const {
    return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
      const auto& corners = mesh_.triangles[t];
      return dot(plane.normal, normal_of(mesh_, vertices_, t)) > 0 &&
             std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
               return std::abs(dot(plane.normal, vertices_[v] - plane.point)) <= 2 * flatness_;
             });
    });
  }

  const MeshView& mesh_;
  std::span<const Vec3d> vertices_;
  const double flatness_;
  detail::UnionFind sets_;
  std::vector<Plane> planes_;                        ///< of the smallest triangle of each set
  std::vector<std::vector<std::uint32_t>> members_;  ///< of the smallest triangle of each set
};

/// The system of equations: each corner of a face lies in its plane.
class Flattener {
 public:
  Flattener(const MeshView& mesh, std::span<const std::uint32_t> face_of, std::vector<Vec3d>& vertices)
      : vertices_(vertices) {
    std::vector<std::vector<std::uint32_t>> corners(mesh.triangles.size());
    std::vector<Vec3d> normals(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      std::vector<std::uint32_t>& own = corners[face_of[t]];
      own.insert(own.end(), triangle.begin(), triangle.end());
      normals[face_of[t]] += normal_of(mesh, vertices, t);
    }
    for (std::uint32_t t = 0; t < corners.size(); ++t) {
      detail::sort_unique(corners[t]);
      if (corners[t].size() > 3) add_face(corners[t], unit(normals[t]));
    }
  }

  double solve() {
    constexpr int most_steps = 8;
    double worst = residual();
    for (int k = 0; k < most_steps && worst > 0; ++k) {
      const std::vector<Vec3d> before = vertices_;
      const std::vector<Face> faces_before = faces_;
      step();
      const double now = residual();
      if (!(now < worst)) {
        vertices_ = before;
        faces_ = faces_before;
        return worst;
      }
      if (!(now < 0.5 * worst)) return now;
      worst = now;
    }
    return worst;
  }

 private:
  struct Face {
    Vec3d normal;
    Vec3d middle;
    double height = 0;          ///< of the plane above the middle
    std::array<Vec3d, 2> axes;  ///< across the normal, as long as the inverse of the face's radius
    std::uint32_t first = 0;    ///< equations
    std::uint32_t count = 0;
  };

  void add_face(const std::vector<std::uint32_t>& corners, const Vec3d& normal) {
    Face face;
    face.normal = normal;
    for (const std::uint32_t v : corners) face.middle += vertices_[v];
    face.middle = face.middle / static_cast<double>(corners.size());
    double radius = 0;
    for (const std::uint32_t v : corners) radius = std::max(radius, length(vertices_[v] - face.middle));
    const std::array<Vec3d, 2> axes = axes_across(normal);
    face.axes = {axes[0] / radius, axes[1] / radius};
    face.first = static_cast<std::uint32_t>(corner_.size());
    face.count = static_cast<std::uint32_t>(corners.size());
    corner_.insert(corner_.end(), corners.begin(), corners.end());
    faces_.push_back(face);
  }

  [[nodiscard]] double height(const Face& face, std::uint32_t v) const {
    return dot(face.normal, vertices_[v] - face.middle) - face.height;
  }

  /// Returns how fast the height of a vertex changes with the turns and the height of the plane.
  [[nodiscard]] Vec3d rates(const Face& face, std::uint32_t v) const {
    const Vec3d away = vertices_[v] - face.middle;
    return {dot(face.axes[0], away), dot(face.axes[1], away), -1};
  }

  [[nodiscard]] double residual() const {
    double worst = 0;
    for (const Face& face : faces_) {
      for (std::uint32_t e = face.first; e < face.first + face.count; ++e) {
        worst = std::max(worst, std::abs(height(face, corner_[e])));
      }
    }
    return worst;
  }

  /// A change of all vertices and planes.
  struct Change {
    std::vector<Vec3d> vertices;
    std::vector<Vec3d> planes;  ///< turns about both axes, and the height
  };

  /// Returns the change that is the transposed system times y.
  void transposed(const std::vector<double>& y, Change& out) const {
    std::fill(out.vertices.begin(), out.vertices.end(), Vec3d{});
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Face& face = faces_[f];
      Vec3d plane;
      for (std::uint32_t e = face.first; e < face.first + face.count; ++e) {
        out.vertices[corner_[e]] += face.normal * y[e];
        plane += rates(face, corner_[e]) * y[e];
      }
      out.planes[f] = plane;
    }
  }

  void times(const Change& change, std::vector<double>& out) const {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Face& face = faces_[f];
      for (std::uint32_t e = face.first; e < face.first + face.count; ++e) {
        out[e] = dot(face.normal, change.vertices[corner_[e]]) + dot(rates(face, corner_[e]), change.planes[f]);
      }
    }
  }

  /// Makes the shortest change that solves the linear system.
  void step() {
    const std::size_t count = corner_.size();
    std::vector<double> y(count), rest(count), way(count), image(count);
    for (const Face& face : faces_) {
      for (std::uint32_t e = face.first; e < face.first + face.count; ++e) rest[e] = -height(face, corner_[e]);
    }
    way = rest;
    Change change{std::vector<Vec3d>(vertices_.size()), std::vector<Vec3d>(faces_.size())};
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
      return sum;
    };
    double now = product(rest, rest);
    const double enough = 1e-10 * now;
    constexpr int most_iterations = 2000;
    for (int k = 0; k < most_iterations && now > enough; ++k) {
      transposed(way, change);
      times(change, image);
      const double share = now / product(way, image);
      if (!std::isfinite(share)) break;
      for (std::size_t e = 0; e < count; ++e) {
        y[e] += share * way[e];
        rest[e] -= share * image[e];
      }
      const double next = product(rest, rest);
      for (std::size_t e = 0; e < count; ++e) way[e] = rest[e] + way[e] * (next / now);
      now = next;
    }
    transposed(y, change);
    for (std::size_t v = 0; v < vertices_.size(); ++v) vertices_[v] += change.vertices[v];
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      Face& face = faces_[f];
      const Vec3d& turn = change.planes[f];
      face.normal = unit(face.normal + face.axes[0] * turn.x + face.axes[1] * turn.y);
      face.height += turn.z;
    }
  }

  std::vector<Vec3d>& vertices_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> corner_;  ///< of each equation
};

}  // namespace

std::vector<std::uint32_t> join_flat_triangles(const MeshView& mesh, std::span<const Vec3d> vertices,
                                               const SiteTable& table, const PolyhedronSites& sites, double flatness) {
  Joiner joiner(mesh, vertices, flatness);
  const auto edge_count = static_cast<std::uint32_t>(table.edge_count());
  for (std::uint32_t e = 0; e < edge_count; ++e) {
    if (sites.turn[e] == EdgeTurn::flat) joiner.join(sites.triangles_of[e][0], sites.triangles_of[e][1], true);
  }
  if (flatness > 0) {
    for (std::uint32_t e = 0; e < edge_count; ++e)
      joiner.join(sites.triangles_of[e][0], sites.triangles_of[e][1], false);
  }
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) out.push_back(joiner.set_of(t));
  return out;
}

double flatten_faces(const MeshView& mesh, std::span<const std::uint32_t> face_of, std::vector<Vec3d>& vertices) {
  return Flattener(mesh, face_of, vertices).solve();
}

}  // namespace blum::voronoi
