#include "blum/axis/label_sheets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"

namespace blum::detail {
namespace {

/// Two triangles at an edge that no third triangle has.
struct Hinge {
  std::array<std::uint32_t, 2> vertices;
  std::array<std::uint32_t, 2> triangles;
};

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
/// Cosine of 37 degrees.
constexpr double sharp = 0.8;
/// Groups of joined triangles are small if they have fewer triangles than this.
constexpr std::size_t few = 8;
/// Largest number of triangles whose normals are averaged, and largest number of triangles that the search for them
/// visits.
constexpr std::size_t most_samples = 12;
constexpr std::size_t most_looked_at = 96;

Vec3d normal_of(const Complex& axis, std::uint32_t triangle) {
  const auto& [a, b, c] = axis.triangles[triangle];
  const Vec3d& at = axis.positions[a];
  return cross(axis.positions[b] - at, axis.positions[c] - at);
}

/// Returns the vector from an edge to the third vertex of a triangle, at a right angle to the edge.
Vec3d leaf(const Complex& axis, const std::array<std::uint32_t, 2>& edge, std::uint32_t triangle) {
  const auto& v = axis.triangles[triangle];
  const std::uint32_t third = v[0] ^ v[1] ^ v[2] ^ edge[0] ^ edge[1];
  const Vec3d& from = axis.positions[edge[0]];
  const Vec3d along = axis.positions[edge[1]] - from;
  const Vec3d out = axis.positions[third] - from;
  const double squared = squared_length(along);
  return squared > 0 ? out - along * (dot(out, along) / squared) : out;
}

/// Returns the cosine of the angle between the two triangles of a hinge. The cosine is -1 if the triangles lie in a
/// plane, or if one of them has no area.
double cosine_of(const Complex& axis, const Hinge& hinge) {
  const Vec3d a = leaf(axis, hinge.vertices, hinge.triangles[0]);
  const Vec3d b = leaf(axis, hinge.vertices, hinge.triangles[1]);
  const double scale = length(a) * length(b);
  return scale > 0 ? dot(a, b) / scale : -1;
}

class SheetJoiner {
 public:
  SheetJoiner(const Complex& axis, const std::vector<Hinge>& hinges)
      : axis_(axis),
        hinges_(hinges),
        pieces_(axis.triangles.size()),
        size_(axis.triangles.size(), 1),
        inner_size_(axis.triangles.size(), 0),
        is_inner_(axis.triangles.size(), true),
        hinge_at_(axis.triangles.size(), {none, none, none}) {
    find_seams();
    for (std::uint32_t h = 0; h < hinges_.size(); ++h) {
      for (const std::uint32_t t : hinges_[h].triangles) *std::find(hinge_at_[t].begin(), hinge_at_[t].end(), none) = h;
    }
  }

  detail::UnionFind join() {
    std::vector<std::pair<double, std::uint32_t>> beside_seams;
    for (std::uint32_t h = 0; h < hinges_.size(); ++h) {
      if (is_on_seam_[hinges_[h].vertices[0]] || is_on_seam_[hinges_[h].vertices[1]]) {
        beside_seams.emplace_back(cosine_of(axis_, hinges_[h]), h);
      } else {
        join(hinges_[h]);
      }
    }
    // The flattest hinges come first. So each small group joins the sheet that continues it most smoothly.
    std::sort(beside_seams.begin(), beside_seams.end(), [&](const auto& a, const auto& b) {
      return std::tie(a.first, hinges_[a.second].triangles) < std::tie(b.first, hinges_[b.second].triangles);
    });
    for (const auto& [cosine, h] : beside_seams) {
      if (belongs_together(cosine, hinges_[h])) join(hinges_[h]);
    }
    return std::move(pieces_);
  }

 private:
  void find_seams() {
    is_on_seam_.assign(axis_.positions.size(), false);
    const std::span<const std::int32_t> roles = axis_.edge_columns.get<std::int32_t>(medial_columns::role);
    for (std::size_t e = 0; e < axis_.edges.size(); ++e) {
      if (roles[e] != static_cast<std::int32_t>(MedialRole::seam)) continue;
      for (const std::uint32_t v : axis_.edges[e]) is_on_seam_[v] = true;
    }
    for (std::size_t t = 0; t < is_inner_.size(); ++t) {
      for (const std::uint32_t v : axis_.triangles[t]) is_inner_[t] = is_inner_[t] && !is_on_seam_[v];
      inner_size_[t] = is_inner_[t] ? 1 : 0;
    }
  }

  void join(const Hinge& hinge) {
    const std::uint32_t a = pieces_.find(hinge.triangles[0]);
    const std::uint32_t b = pieces_.find(hinge.triangles[1]);
    if (!pieces_.join(a, b)) return;
    const std::uint32_t both = pieces_.find(a);
    size_[both] = size_[a] + size_[b];
    inner_size_[both] = inner_size_[a] + inner_size_[b];
  }

  [[nodiscard]] bool belongs_together(double cosine, const Hinge& hinge) {
    const std::uint32_t a = pieces_.find(hinge.triangles[0]);
    const std::uint32_t b = pieces_.find(hinge.triangles[1]);
    if (a == b) return false;
    if (std::min(size_[a], size_[b]) < few) return true;
    if (cosine > -sharp) return false;
    // Groups that lie only along seams are as crooked as the seams, so their normals are not reliable.
    if (std::min(inner_size_[a], inner_size_[b]) < few) return true;
    const Vec3d p = normal_near(hinge.triangles[0]);
    const Vec3d q = normal_near(hinge.triangles[1]);
    return std::abs(dot(p, q)) >= sharp * length(p) * length(q);
  }

  /// Returns the mean normal (not a unit vector) of triangles near the given one, in its group and away from seams.
  [[nodiscard]] Vec3d normal_near(std::uint32_t triangle) {
    const std::uint32_t piece = pieces_.find(triangle);
    std::vector<std::uint32_t> line{triangle};
    std::unordered_set<std::uint32_t> known{triangle};
    std::size_t count = 0;
    Vec3d sum;
    for (std::size_t k = 0; k < line.size() && k < most_looked_at && count < most_samples; ++k) {
      if (is_inner_[line[k]]) {
        const Vec3d normal = normal_of(axis_, line[k]);
        sum += dot(sum, normal) < 0 ? -1.0 * normal : normal;
        ++count;
      }
      for (const std::uint32_t h : hinge_at_[line[k]]) {
        if (h == none) continue;
        for (const std::uint32_t next : hinges_[h].triangles) {
          if (pieces_.find(next) == piece && known.insert(next).second) line.push_back(next);
        }
      }
    }
    return sum;
  }

  const Complex& axis_;
  const std::vector<Hinge>& hinges_;
  detail::UnionFind pieces_;
  std::vector<std::size_t> size_, inner_size_;  ///< for each group: all triangles; those away from seams
  std::vector<bool> is_on_seam_, is_inner_;
  std::vector<std::array<std::uint32_t, 3>> hinge_at_;  ///< for each triangle: indices of its hinges, or none
};

/// Joins triangles at hinges into sheets, except where two sheets meet beside a seam. A seam of the complex may zigzag
/// around the true crease of two sheets. In such a zigzag, hinges connect the two sheets at the steps. So a hinge that
/// touches a seam is not joined if the axis bends by 37 degrees or more. The bend is measured at the hinge itself, and
/// between the mean normals of both groups away from the seam. A group of fewer than 8 triangles always joins the
/// neighbour at its flattest hinge.
/// @param axis  its edges have roles.
detail::UnionFind join_sheets(const Complex& axis, const std::vector<Hinge>& hinges) {
  return SheetJoiner(axis, hinges).join();
}

constexpr std::int32_t no_sheet = -1;

/// Returns the number that columns contain for a role.
constexpr std::int32_t number_of(MedialRole role) {
  return static_cast<std::int32_t>(role);
}

/// Counts of the edges at a vertex, and the sheets at it.
struct Around {
  std::uint32_t rims = 0, seams = 0, curves = 0;
  std::int32_t sheet = no_sheet;
  bool has_several_sheets = false;
};

MedialRole role_of(const Around& a) {
  if (a.curves == 0 && a.seams == 0) {
    if (a.sheet == no_sheet) return MedialRole::curve;                    // a vertex without edges
    if (a.rims > 2 || a.has_several_sheets) return MedialRole::junction;  // sheets only touch here
    return a.rims > 0 ? MedialRole::rim : MedialRole::sheet;
  }
  if (a.seams == 2 && a.curves == 0) return a.rims == 0 ? MedialRole::seam : MedialRole::junction;
  if (a.curves <= 2 && a.seams == 0 && a.rims == 0 && a.sheet == no_sheet) return MedialRole::curve;
  return MedialRole::junction;
}

/// Adds the sides of triangles that are rims or seams to the edges of the axis. Returns all other sides as hinges.
std::vector<Hinge> add_rims_and_seams(Complex& axis, const Incidence& incidence) {
  const std::span<const float> angles = axis.triangle_columns.get<float>(medial_columns::separation_angle);
  std::vector<Hinge> hinges;
  std::vector<float> new_angles;
  std::vector<std::int32_t> new_roles;
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const std::span<const std::uint32_t> triangles = incidence.triangles_of_edge()[e];
    if (triangles.empty()) continue;
    if (triangles.size() == 2) {
      hinges.push_back({incidence.edges()[e], {triangles[0], triangles[1]}});
      continue;
    }
    float largest = 0;
    for (const std::uint32_t t : triangles) largest = std::max(largest, angles[t]);
    axis.edges.push_back(incidence.edges()[e]);
    new_angles.push_back(largest);
    new_roles.push_back(number_of(triangles.size() == 1 ? MedialRole::rim : MedialRole::seam));
  }
  axis.edge_columns.resize(axis.edges.size());
  const auto first = static_cast<std::ptrdiff_t>(axis.edges.size() - new_angles.size());
  const std::span<float> edge_angles = axis.edge_columns.edit<float>(medial_columns::separation_angle);
  std::copy(new_angles.begin(), new_angles.end(), edge_angles.begin() + first);
  const std::span<std::int32_t> edge_roles = axis.edge_columns.edit<std::int32_t>(medial_columns::role);
  std::copy(new_roles.begin(), new_roles.end(), edge_roles.begin() + first);
  return hinges;
}

void number_sheets(Complex& axis, detail::UnionFind sheets) {
  const std::span<std::int32_t> sheet_of = axis.triangle_columns.edit<std::int32_t>(medial_columns::sheet);
  std::int32_t count = 0;
  for (std::uint32_t t = 0; t < sheet_of.size(); ++t) {
    // find() returns the sheet's triangle of lowest index, so the sheet already has its number when its other triangles
    // follow.
    const std::uint32_t first = sheets.find(t);
    sheet_of[t] = first == t ? count++ : sheet_of[first];
  }
}

void find_vertex_roles(Complex& axis) {
  std::vector<Around> around(axis.positions.size());
  const std::span<const std::int32_t> edge_roles = axis.edge_columns.get<std::int32_t>(medial_columns::role);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    for (const std::uint32_t v : axis.edges[e]) {
      ++(edge_roles[e] == number_of(MedialRole::rim)    ? around[v].rims
         : edge_roles[e] == number_of(MedialRole::seam) ? around[v].seams
                                                        : around[v].curves);
    }
  }
  const std::span<const std::int32_t> sheets = axis.triangle_columns.get<std::int32_t>(medial_columns::sheet);
  for (std::size_t t = 0; t < axis.triangles.size(); ++t) {
    for (const std::uint32_t v : axis.triangles[t]) {
      if (around[v].sheet != no_sheet && around[v].sheet != sheets[t]) around[v].has_several_sheets = true;
      around[v].sheet = sheets[t];
    }
  }
  const std::span<std::int32_t> roles = axis.vertex_columns.edit<std::int32_t>(medial_columns::role);
  for (std::size_t v = 0; v < around.size(); ++v) roles[v] = number_of(role_of(around[v]));
}

}  // namespace

void label_sheets(Complex& axis, const Incidence& incidence) {
  const std::vector<Hinge> hinges = add_rims_and_seams(axis, incidence);
  number_sheets(axis, join_sheets(axis, hinges));
  find_vertex_roles(axis);
}

}  // namespace blum::detail
