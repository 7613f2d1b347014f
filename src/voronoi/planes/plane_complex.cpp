#include "voronoi/planes/plane_complex.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/triangle_components.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/planes/close_junctions.hpp"

namespace blum::voronoi {
namespace {

/// Parts of a diagram are joined if they are closer than this many times the distance within which faces are joined.
constexpr double join_factor = 8;

/// Returns the triangles of each component, in the order of their smallest triangles.
std::vector<std::vector<std::uint32_t>> components(const MeshView& mesh, const SiteTable& table) {
  const detail::SurfaceComponents found = detail::find_components(mesh, table, detail::tally_edges(mesh, table));
  std::vector<std::vector<std::uint32_t>> out(found.count);
  for (std::uint32_t t = 0; t < found.of_triangle.size(); ++t) out[found.of_triangle[t]].push_back(t);
  return out;
}

/// Returns true if a reflex edge bends by more than rounding can explain.
bool is_clearly_reflex(const MeshView& mesh, const PolyhedronSites& sites, double flatness) {
  const auto height = [&](std::uint32_t of, std::uint32_t above) {
    const std::array<Vec3d, 3> p = triangle_corners(mesh, above);
    const Vec3d normal = unit_normal(p[0], p[1], p[2]);
    double most = 0;
    for (const std::uint32_t v : mesh.triangles[of]) most = std::max(most, dot(normal, mesh.vertices[v] - p[0]));
    return most;
  };
  return std::any_of(sites.reflex_edges.begin(), sites.reflex_edges.end(), [&](std::uint32_t edge) {
    const auto [first, second] = sites.triangles_of[edge];
    return std::min(height(first, second), height(second, first)) > join_factor * flatness;
  });
}

/// Returns a component with its diagram, or nothing if it is not convex. If joined faces do not form a convex
/// polyhedron, the triangles are used as given.
std::optional<ConvexBody> convex_body(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                      std::span<const std::uint32_t> component, double flatness,
                                      const Context& context) {
  std::optional<ConvexFaces> faces = convex_faces(mesh, table, sites, component, flatness, context);
  if (faces) {
    std::optional<PlaneStructure> structure = plane_structure(*faces, context);
    if (structure) return ConvexBody{std::move(*faces), std::move(*structure)};
  }
  if (flatness == 0) return std::nullopt;
  return convex_body(mesh, table, sites, component, 0, context);
}

class Assembly {
 public:
  Assembly(const MeshView& mesh, const SiteTable& table, VoronoiPart part) : mesh_(mesh), table_(table), part_(part) {}

  void add(const ConvexBody& body) {
    body_ = &body;
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (const PlaneStructure::Junction& junction : body.structure.junctions) {
      vertices_.push_back(placed(junction.at, junction.height, junction.planes, true));
    }
    for (const PlaneSheet& sheet : body.structure.sheets) {
      const std::array between{static_cast<std::int32_t>(body.faces.site[sheet.first]),
                               static_cast<std::int32_t>(body.faces.site[sheet.second])};
      const double angle = degrees_between(normal(sheet.first), normal(sheet.second));
      add_polygon(sheet, {sheet.first, sheet.second}, first, between, angle);
    }
    if (part_ != VoronoiPart::all) return;
    for (const PlaneSheet& sheet : body.structure.surface) {
      add_polygon(sheet, {sheet.first}, first, {-1, static_cast<std::int32_t>(body.faces.site[sheet.first])}, 0);
    }
  }

  Complex finish() {
    Complex out;
    for (const Vertex& vertex : vertices_) out.positions.push_back(vertex.at);
    out.triangles = std::move(triangles_);
    out.vertex_columns = Columns(out.positions.size());
    out.triangle_columns = Columns(out.triangles.size());
    add_vertex_columns(out.vertex_columns);
    out.triangle_columns.add({"site_a", 1, std::move(site_a_)});
    out.triangle_columns.add({"site_b", 1, std::move(site_b_)});
    out.triangle_columns.add({std::string(medial_columns::separation_angle), 1, std::move(angle_)});
    return out;
  }

 private:
  struct Vertex {
    Vec3d at;
    double radius = 0;
    std::array<Vec3d, 2> footprints;
    std::array<SiteId, 2> sites;
    double angle = 0;
    bool is_junction = false;
  };

  [[nodiscard]] const Vec3d& normal(HalfSpaces::Index plane) const { return body_->structure.normals[plane]; }

  /// @param at  relative to the origin of the body.
  [[nodiscard]] Vertex placed(const Vec3d& at, double height, const std::vector<HalfSpaces::Index>& planes,
                              bool is_junction) const {
    Vertex out{at + body_->faces.origin, height, {}, {}, 0, is_junction};
    std::array<HalfSpaces::Index, 2> widest{planes[0], planes[0]};
    if (height > 0) {
      // The widest angle is that of the smallest cosine.
      double least = 2;
      for (std::size_t a = 0; a < planes.size(); ++a) {
        for (std::size_t b = a + 1; b < planes.size(); ++b) {
          const double cosine = dot(normal(planes[a]), normal(planes[b]));
          if (cosine >= least) continue;
          least = cosine;
          widest = {planes[a], planes[b]};
        }
      }
      if (planes.size() > 1) out.angle = degrees_between(normal(widest[0]), normal(widest[1]));
    }
    for (const std::size_t which : {0U, 1U}) {
      out.footprints[which] = out.at - normal(widest[which]) * height;
      out.sites[which] = site_at(widest[which], out.footprints[which]);
    }
    return out;
  }

  /// Returns the triangle of a plane that contains a point of it, as a site of the mesh.
  [[nodiscard]] SiteId site_at(HalfSpaces::Index plane, const Vec3d& point) const {
    std::uint32_t best = body_->faces.triangles[plane].front();
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : body_->faces.triangles[plane]) {
      const double squared = squared_length(closest_point_on_triangle(point, triangle_corners(mesh_, t)) - point);
      if (!(squared < least)) continue;
      least = squared;
      best = t;
    }
    return table_.id({SiteKind::face, best});
  }

  /// Adds the triangles of a convex polygon.
  /// @param first  index of the first junction of the body.
  void add_polygon(const PlaneSheet& sheet, const std::vector<HalfSpaces::Index>& planes, std::uint32_t first,
                   const std::array<std::int32_t, 2>& between, double angle) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t k : sheet.junctions) corners.push_back(first + k);
    const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      triangles_.push_back({a, b, c});
      site_a_.push_back(between[0]);
      site_b_.push_back(between[1]);
      angle_.push_back(static_cast<float>(angle));
    };
    if (corners.size() == 3) {
      add_triangle(corners[0], corners[1], corners[2]);
      return;
    }
    if (corners.size() == 4 && !has_straight_corner(corners)) {
      const std::size_t start = is_better_diagonal(corners) ? 1 : 0;
      add_triangle(corners[start], corners[start + 1], corners[start + 2]);
      add_triangle(corners[start], corners[start + 2], corners[(start + 3) % 4]);
      return;
    }
    Vec3d middle;
    double height = 0;
    for (const std::uint32_t k : corners) {
      middle += vertices_[k].at / static_cast<double>(corners.size());
      height += vertices_[k].radius / static_cast<double>(corners.size());
    }
    const auto centre = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(placed(middle - body_->faces.origin, height, planes, false));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      add_triangle(corners[k], corners[(k + 1) % corners.size()], centre);
    }
  }

  [[nodiscard]] double squared_between(std::uint32_t a, std::uint32_t b) const {
    return squared_length(vertices_[a].at - vertices_[b].at);
  }

  /// Returns true if the diagonal from the second corner of a quadrangle is the shorter one.
  [[nodiscard]] bool is_better_diagonal(const std::vector<std::uint32_t>& corners) const {
    return squared_between(corners[1], corners[3]) < squared_between(corners[0], corners[2]);
  }

  /// Returns true if a corner's angle is close to 180 degrees.
  [[nodiscard]] bool has_straight_corner(const std::vector<std::uint32_t>& corners) const {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3d before = vertices_[corners[k]].at - vertices_[corners[(k + corners.size() - 1) % corners.size()]].at;
      const Vec3d after = vertices_[corners[(k + 1) % corners.size()]].at - vertices_[corners[k]].at;
      constexpr double straight = 1e-6;
      if (dot(before, after) > 0 && squared_length(cross(before, after)) <=
                                        straight * straight * squared_length(before) * squared_length(after)) {
        return true;
      }
    }
    return false;
  }

  void add_vertex_columns(Columns& out) const {
    const auto fill = [&]<class T>(std::span<T> column, const auto& value) {
      for (std::size_t k = 0; k < vertices_.size(); ++k) column[k] = value(vertices_[k]);
    };
    fill(out.add<double>(std::string(medial_columns::radius)), [](const Vertex& v) { return v.radius; });
    for (const std::size_t which : {0U, 1U}) {
      const std::span<double> column = out.add<double>(std::string(medial_columns::footprints[which]), 3);
      for (std::size_t k = 0; k < vertices_.size(); ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) column[3 * k + axis] = vertices_[k].footprints[which][axis];
      }
    }
    for (const std::size_t which : {0U, 1U}) {
      fill(out.add<std::int32_t>(std::string(medial_columns::sites[which])),
           [&](const Vertex& v) { return static_cast<std::int32_t>(v.sites[which].value); });
    }
    fill(out.add<double>(std::string(medial_columns::separation_angle)), [](const Vertex& v) { return v.angle; });
    fill(out.add<std::int32_t>("junction"), [](const Vertex& v) { return v.is_junction ? 1 : 0; });
  }

  const MeshView& mesh_;
  const SiteTable& table_;
  const VoronoiPart part_;
  const ConvexBody* body_ = nullptr;
  std::vector<Vertex> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::int32_t> site_a_, site_b_;
  std::vector<float> angle_;
};

}  // namespace

std::optional<ConvexBodies> convex_bodies(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                          std::optional<double> flatness, const Context& context) {
  const double flat = flatness ? *flatness : rounding_of_coordinates(mesh);
  if (is_clearly_reflex(mesh, sites, flat)) return std::nullopt;
  ConvexBodies out;
  for (const std::vector<std::uint32_t>& component : components(mesh, table)) {
    std::optional<ConvexBody> body = convex_body(mesh, table, sites, component, flat, context);
    if (!body) return std::nullopt;
    const JoinedJunctions joined = restore_degenerate(body->structure, join_factor * flat, context);
    out.flatness = std::max(out.flatness, body->faces.flatness);
    out.joined = std::max(out.joined, joined.distance);
    out.moved = std::max(out.moved, joined.moved);
    out.bodies.push_back(std::move(*body));
  }
  return out;
}

Complex plane_complex(const MeshView& mesh, const SiteTable& table, const ConvexBodies& bodies, VoronoiPart part) {
  Assembly assembly(mesh, table, part);
  for (const ConvexBody& body : bodies.bodies) assembly.add(body);
  return assembly.finish();
}

}  // namespace blum::voronoi
