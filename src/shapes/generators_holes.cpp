#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"
#include "shapes/generator_parts.hpp"

namespace blum::detail {
namespace {

/// A solid that consists of boxes and triangular prisms. If two of these parts touch, they must have an equal face.
/// Such common faces are removed, and the other faces are the boundary. Corners with equal coordinates are one vertex.
class PrismComplex {
 public:
  /// Adds an axis-aligned box.
  void add_box(const Vec3d& lower, const Vec3d& upper);
  /// Adds the prism between two triangles. Both triangles are counter-clockwise if seen from the side of `top`.
  void add_prism(const std::array<Vec3d, 3>& base, const std::array<Vec3d, 3>& top);
  /// Returns the closed boundary, facing outwards. Cost: O(n log n).
  [[nodiscard]] TriangleMesh boundary() const;

 private:
  struct Face {
    std::array<std::uint32_t, 4> key{};      ///< corners, sorted by index
    std::array<std::uint32_t, 4> corners{};  ///< corners in cyclic order; a triangle lists its last corner twice
  };
  std::uint32_t vertex(const Vec3d& p);
  void add_face(const std::array<std::uint32_t, 4>& corners);

  std::vector<Vec3d> vertices_;
  std::map<std::array<double, 3>, std::uint32_t> ids_;
  std::vector<Face> faces_;
};

std::uint32_t PrismComplex::vertex(const Vec3d& p) {
  const auto [place, is_new] = ids_.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(vertices_.size()));
  if (is_new) vertices_.push_back(p);
  return place->second;
}

void PrismComplex::add_face(const std::array<std::uint32_t, 4>& corners) {
  Face face{corners, corners};
  std::sort(face.key.begin(), face.key.end());
  faces_.push_back(face);
}

void PrismComplex::add_box(const Vec3d& lower, const Vec3d& upper) {
  std::array<std::uint32_t, 8> corner{};
  for (std::size_t c = 0; c < 8; ++c) {
    corner[c] = vertex({c & 1 ? upper.x : lower.x, c & 2 ? upper.y : lower.y, c & 4 ? upper.z : lower.z});
  }
  constexpr std::array<std::array<std::size_t, 4>, 6> quads = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& q : quads) add_face({corner[q[0]], corner[q[1]], corner[q[2]], corner[q[3]]});
}

void PrismComplex::add_prism(const std::array<Vec3d, 3>& base, const std::array<Vec3d, 3>& top) {
  std::array<std::uint32_t, 3> b{};
  std::array<std::uint32_t, 3> t{};
  for (std::size_t k = 0; k < 3; ++k) b[k] = vertex(base[k]);
  for (std::size_t k = 0; k < 3; ++k) t[k] = vertex(top[k]);
  add_face({b[0], b[2], b[1], b[1]});
  add_face({t[0], t[1], t[2], t[2]});
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    add_face({b[k], b[next], t[next], t[k]});
  }
}

TriangleMesh PrismComplex::boundary() const {
  // The result keeps the order in which faces were added.
  std::vector<std::uint32_t> order(faces_.size());
  for (std::uint32_t f = 0; f < order.size(); ++f) order[f] = f;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return faces_[a].key != faces_[b].key ? faces_[a].key < faces_[b].key : a < b;
  });
  std::vector<bool> is_shared(faces_.size(), false);
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    if (faces_[order[k]].key == faces_[order[k + 1]].key) is_shared[order[k]] = is_shared[order[k + 1]] = true;
  }
  TriangleMesh mesh;
  std::vector<std::uint32_t> names(vertices_.size(), 0xffffffff);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (is_shared[f]) continue;
    std::array<std::uint32_t, 4> quad = faces_[f].corners;
    for (std::uint32_t& v : quad) {
      if (names[v] == 0xffffffff) {
        names[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(vertices_[v]);
      }
      v = names[v];
    }
    mesh.triangles.push_back({quad[0], quad[1], quad[2]});
    if (quad[2] != quad[3]) mesh.triangles.push_back({quad[0], quad[2], quad[3]});
  }
  return mesh;
}

/// Returns the triangles of a rectangle with a round hole. Triangles are counter-clockwise. Indices 0 to 3 are the
/// corners of the rectangle, counter-clockwise from the upper right. Indices 4 to 3 + `sides` are the points of the
/// hole, counter-clockwise from the one to the right of its centre. `sides` is a multiple of 4. Each side of the
/// rectangle is an edge of exactly one triangle.
std::vector<Triangle> triangulate_holed_rectangle(std::uint32_t sides) {
  std::vector<Triangle> triangles;
  const std::uint32_t quarter = sides / 4;
  for (std::uint32_t corner = 0; corner < 4; ++corner) {
    const std::uint32_t first = corner * quarter;
    triangles.push_back({(corner + 3) % 4, corner, 4 + first});
    for (std::uint32_t k = first; k < first + quarter; ++k) {
      triangles.push_back({corner, 4 + (k + 1) % sides, 4 + k});
    }
  }
  return triangles;
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

using detail::PrismComplex;
using detail::require;
using detail::require_at_least;
using detail::require_positive;
using detail::require_triangle_count;

void require_hole_segments(int segments) {
  require(segments >= 4 && segments % 4 == 0, "hole_segments", "a multiple of 4, at least 4", segments);
}

/// An interval of a coordinate.
struct Span {
  double lower = 0;
  double upper = 0;
  [[nodiscard]] double center() const { return 0.5 * (lower + upper); }
  [[nodiscard]] double size() const { return upper - lower; }
};

/// Adds a box with a round hole along its third axis, w. place(u, v, w) maps a point into space without mirroring.
template <class Place>
void add_holed_box(PrismComplex& solid, const Span& u, const Span& v, const Span& w, double radius, int sides,
                   Place place) {
  std::vector<Point2> points = {{u.upper, v.upper}, {u.lower, v.upper}, {u.lower, v.lower}, {u.upper, v.lower}};
  const auto hole = detail::circle(u.center(), v.center(), radius, sides);
  points.insert(points.end(), hole.begin(), hole.end());
  for (const Triangle& t : detail::triangulate_holed_rectangle(static_cast<std::uint32_t>(sides))) {
    std::array<Vec3d, 3> base;
    std::array<Vec3d, 3> top;
    for (std::size_t k = 0; k < 3; ++k) {
      base[k] = place(points[t[k]][0], points[t[k]][1], w.lower);
      top[k] = place(points[t[k]][0], points[t[k]][1], w.upper);
    }
    solid.add_prism(base, top);
  }
}

/// Builds a bracket slice by slice along y.
class BracketBuilder {
 public:
  explicit BracketBuilder(const BracketOptions& options)
      : options_(options),
        rib_width_(options.ribs ? 0.6 * options.thickness : 0),
        rib_x_(options.thickness + 0.4 * (options.length - options.thickness)),
        rib_z_(options.thickness + 0.4 * (options.height - options.thickness)) {}

  [[nodiscard]] double bay_width() const {
    const int bays = std::max(1, options_.holes);
    return (options_.width - (bays + 1) * rib_width_) / bays;
  }
  /// Returns the upper limit of hole radii: smaller holes leave material on all sides.
  [[nodiscard]] double room_for_holes() const {
    return 0.5 * std::min({bay_width(), options_.length - rib_x_, options_.height - rib_z_});
  }

  [[nodiscard]] TriangleMesh build() {
    const int bays = std::max(1, options_.holes);
    // Each border is computed once, so that neighbouring slices share it exactly.
    std::vector<double> borders = {0};
    for (int bay = 0; bay < bays; ++bay) {
      if (options_.ribs) borders.push_back(bay * (bay_width() + rib_width_) + rib_width_);
      borders.push_back((bay + 1) * (bay_width() + rib_width_));
    }
    if (options_.ribs) borders.push_back(options_.width);
    for (std::size_t s = 0; s + 1 < borders.size(); ++s) {
      const bool is_rib = options_.ribs && s % 2 == 0;
      add_slice({borders[s], borders[s + 1]}, is_rib);
    }
    return solid_.boundary();
  }

 private:
  void add_slice(const Span& y, bool is_rib) {
    const double t = options_.thickness;
    const bool has_hole = !is_rib && options_.holes > 0;
    solid_.add_box({0, y.lower, 0}, {t, y.upper, t});
    solid_.add_box({t, y.lower, 0}, {rib_x_, y.upper, t});
    solid_.add_box({0, y.lower, t}, {t, y.upper, rib_z_});
    if (has_hole) {
      const Span thick{0, t};
      add_holed_box(solid_, {rib_x_, options_.length}, y, thick, options_.hole_radius, options_.hole_segments,
                    [](double u, double v, double w) { return Vec3d{u, v, w}; });
      add_holed_box(solid_, y, {rib_z_, options_.height}, thick, options_.hole_radius, options_.hole_segments,
                    [](double u, double v, double w) { return Vec3d{w, u, v}; });
    } else {
      solid_.add_box({rib_x_, y.lower, 0}, {options_.length, y.upper, t});
      solid_.add_box({0, y.lower, rib_z_}, {t, y.upper, options_.height});
    }
    if (is_rib) {
      const auto corners = [&](double at) {
        return std::array<Vec3d, 3>{Vec3d{t, at, t}, Vec3d{t, at, rib_z_}, Vec3d{rib_x_, at, t}};
      };
      solid_.add_prism(corners(y.lower), corners(y.upper));
    }
  }

  const BracketOptions& options_;
  double rib_width_, rib_x_, rib_z_;
  PrismComplex solid_;
};

/// Numbering of the vertices in one layer of a plate: first lattice corners, then points of holes. The lower and the
/// upper side are one layer each.
struct PlateLayout {
  std::uint32_t cells_x, cells_y, sides;

  [[nodiscard]] std::uint32_t corner_count() const { return (cells_x + 1) * (cells_y + 1); }
  [[nodiscard]] std::uint32_t layer_size(bool holes) const {
    return corner_count() + (holes ? cells_x * cells_y * sides : 0);
  }
  [[nodiscard]] std::uint32_t corner(std::uint32_t i, std::uint32_t j) const { return j * (cells_x + 1) + i; }
  [[nodiscard]] std::uint32_t hole_point(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return corner_count() + (j * cells_x + i) * sides + k;
  }
};

}  // namespace

TriangleMesh make_plate(const PlateOptions& options) {
  require_at_least(options.holes_x, 0, "holes_x");
  require_at_least(options.holes_y, 0, "holes_y");
  require_positive(options.pitch, "pitch");
  require_positive(options.thickness, "thickness");
  require_positive(options.hole_radius, "hole_radius");
  require(options.hole_radius < 0.5 * options.pitch, "hole_radius", "below pitch / 2, or holes meet",
          options.hole_radius);
  require_hole_segments(options.hole_segments);
  const bool has_holes = options.holes_x > 0 && options.holes_y > 0;
  require_triangle_count(4.0 * (static_cast<double>(options.holes_x) * options.holes_y + 1.0) *
                         (options.hole_segments + 4.0));
  const PlateLayout layout{static_cast<std::uint32_t>(has_holes ? options.holes_x : 1),
                           static_cast<std::uint32_t>(has_holes ? options.holes_y : 1),
                           static_cast<std::uint32_t>(options.hole_segments)};
  const std::uint32_t above = layout.layer_size(has_holes);
  TriangleMesh mesh;
  for (const double z : {-0.5 * options.thickness, 0.5 * options.thickness}) {
    for (std::uint32_t j = 0; j <= layout.cells_y; ++j) {
      for (std::uint32_t i = 0; i <= layout.cells_x; ++i) {
        mesh.vertices.push_back(
            {options.pitch * (i - 0.5 * layout.cells_x), options.pitch * (j - 0.5 * layout.cells_y), z});
      }
    }
    for (std::uint32_t hole = 0; has_holes && hole < layout.cells_x * layout.cells_y; ++hole) {
      const double x = options.pitch * (hole % layout.cells_x + 0.5 - 0.5 * layout.cells_x);
      const double y = options.pitch * (hole / layout.cells_x + 0.5 - 0.5 * layout.cells_y);
      for (const auto& p : detail::circle(x, y, options.hole_radius, options.hole_segments)) {
        mesh.vertices.push_back({p[0], p[1], z});
      }
    }
  }
  const auto add_both = [&](const Triangle& t) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + above, t[1] + above, t[2] + above});
  };
  const auto add_wall = [&](std::uint32_t a, std::uint32_t b) { detail::add_quad(mesh, a, b, b + above, a + above); };
  const std::vector<Triangle> patch = detail::triangulate_holed_rectangle(layout.sides);
  for (std::uint32_t j = 0; j < layout.cells_y; ++j) {
    for (std::uint32_t i = 0; i < layout.cells_x; ++i) {
      const std::array<std::uint32_t, 4> corners{layout.corner(i + 1, j + 1), layout.corner(i, j + 1),
                                                 layout.corner(i, j), layout.corner(i + 1, j)};
      if (!has_holes) {
        add_both({corners[0], corners[1], corners[2]});
        add_both({corners[0], corners[2], corners[3]});
        continue;
      }
      const auto global = [&](std::uint32_t v) { return v < 4 ? corners[v] : layout.hole_point(i, j, v - 4); };
      for (const Triangle& t : patch) add_both({global(t[0]), global(t[1]), global(t[2])});
      for (std::uint32_t k = 0; k < layout.sides; ++k) {
        add_wall(layout.hole_point(i, j, (k + 1) % layout.sides), layout.hole_point(i, j, k));
      }
    }
  }
  for (std::uint32_t i = 0; i < layout.cells_x; ++i) {
    add_wall(layout.corner(i, 0), layout.corner(i + 1, 0));
    add_wall(layout.corner(i + 1, layout.cells_y), layout.corner(i, layout.cells_y));
  }
  for (std::uint32_t j = 0; j < layout.cells_y; ++j) {
    add_wall(layout.corner(layout.cells_x, j), layout.corner(layout.cells_x, j + 1));
    add_wall(layout.corner(0, j + 1), layout.corner(0, j));
  }
  return mesh;
}

TriangleMesh make_bracket(const BracketOptions& options) {
  require_positive(options.length, "length");
  require_positive(options.height, "height");
  require_positive(options.width, "width");
  require_positive(options.thickness, "thickness");
  require(2 * options.thickness < std::min(options.length, options.height), "thickness",
          "below half of length and height", options.thickness);
  require(options.holes >= 0 && options.holes <= 10000, "holes", "0 to 10000", options.holes);
  require_positive(options.hole_radius, "hole_radius");
  require_hole_segments(options.hole_segments);
  require_triangle_count(8.0 * (options.holes + 1.0) * (options.hole_segments + 16.0));
  BracketBuilder builder(options);
  require(builder.bay_width() > 0, "width", "large enough for the ribs", options.width);
  if (options.holes > 0) {
    require(options.hole_radius < builder.room_for_holes(), "hole_radius",
            ("below " + std::to_string(builder.room_for_holes()) + ", or holes meet ribs or rims").c_str(),
            options.hole_radius);
  }
  return builder.build();
}

}  // namespace blum
