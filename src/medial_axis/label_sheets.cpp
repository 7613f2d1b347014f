#include "medial_axis/label_sheets.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"

namespace blum {
namespace {

constexpr std::int32_t no_sheet = -1;

/// As columns hold it.
constexpr std::int32_t number_of(MedialRole role) {
  return static_cast<std::int32_t>(role);
}

/// What is known of a vertex from its edges.
struct Around {
  std::uint32_t rims = 0, seams = 0, curves = 0;
  std::int32_t sheet = no_sheet;
  bool has_several_sheets = false;
};

MedialRole role_of(const Around& a) {
  if (a.curves == 0 && a.seams == 0) {
    if (a.sheet == no_sheet) return MedialRole::curve;                    // a vertex alone
    if (a.rims > 2 || a.has_several_sheets) return MedialRole::junction;  // sheets touch here only
    return a.rims > 0 ? MedialRole::rim : MedialRole::sheet;
  }
  if (a.seams == 2 && a.curves == 0) return a.rims == 0 ? MedialRole::seam : MedialRole::junction;
  if (a.curves <= 2 && a.seams == 0 && a.rims == 0 && a.sheet == no_sheet) return MedialRole::curve;
  return MedialRole::junction;
}

/// Two triangles that share an edge with no other.
struct Hinge {
  std::array<std::uint32_t, 2> vertices;
  std::array<std::uint32_t, 2> triangles;
};

/// From an edge to the third vertex of a triangle, at a right angle to the edge.
Vec3d leaf(const Complex& axis, const std::array<std::uint32_t, 2>& edge, std::uint32_t triangle) {
  const auto& v = axis.triangles[triangle];
  const std::uint32_t third = v[0] ^ v[1] ^ v[2] ^ edge[0] ^ edge[1];
  const Vec3d& from = axis.positions[edge[0]];
  const Vec3d along = axis.positions[edge[1]] - from;
  const Vec3d out = axis.positions[third] - from;
  const double squared = squared_length(along);
  return squared > 0 ? out - along * (dot(out, along) / squared) : out;
}

/// The cosine of the angle at a hinge: -1 where it is flat, and where a triangle has no area.
double cosine_of(const Complex& axis, const Hinge& hinge) {
  const Vec3d a = leaf(axis, hinge.vertices, hinge.triangles[0]);
  const Vec3d b = leaf(axis, hinge.vertices, hinge.triangles[1]);
  const double scale = length(a) * length(b);
  return scale > 0 ? dot(a, b) / scale : -1;
}

/// Joins the triangles of sheets. Where seams lie a step beside the crease of two sheets, first on one side of it and
/// then on the other, the two hang together at the step: so sharp hinges at seams join nothing, unless what they cut
/// off is only a few triangles.
class SheetJoiner {
 public:
  explicit SheetJoiner(const Complex& axis) : axis_(axis), sheets_(axis.triangles.size()) {}

  detail::UnionFind join(const std::vector<Hinge>& hinges) {
    std::vector<bool> is_on_seam(axis_.positions.size(), false);
    const std::span<const std::int32_t> roles = axis_.edge_columns.get<std::int32_t>(medial_columns::role);
    for (std::size_t e = 0; e < axis_.edges.size(); ++e) {
      if (roles[e] != number_of(MedialRole::seam)) continue;
      for (const std::uint32_t v : axis_.edges[e]) is_on_seam[v] = true;
    }
    std::vector<std::pair<double, Hinge>> sharp;
    for (const Hinge& hinge : hinges) {
      const bool is_at_seam = is_on_seam[hinge.vertices[0]] || is_on_seam[hinge.vertices[1]];
      const double cosine = is_at_seam ? cosine_of(axis_, hinge) : -1;
      if (cosine > sharp_cosine) {
        sharp.emplace_back(cosine, hinge);
      } else {
        sheets_.join(hinge.triangles[0], hinge.triangles[1]);
      }
    }
    join_small(sharp);
    return std::move(sheets_);
  }

 private:
  static constexpr double sharp_cosine = -0.8;  ///< 37 degrees from flat
  static constexpr std::size_t few = 8;         ///< triangles

  /// Pieces of a few triangles go to the neighbour that they are flattest with.
  void join_small(std::vector<std::pair<double, Hinge>>& sharp) {
    std::sort(sharp.begin(), sharp.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second.triangles < b.second.triangles;
    });
    std::vector<std::size_t> size(axis_.triangles.size(), 0);
    for (std::uint32_t t = 0; t < size.size(); ++t) ++size[sheets_.find(t)];
    for (const auto& [cosine, hinge] : sharp) {
      const std::uint32_t a = sheets_.find(hinge.triangles[0]);
      const std::uint32_t b = sheets_.find(hinge.triangles[1]);
      if (a == b || std::min(size[a], size[b]) >= few) continue;
      const std::size_t sum = size[a] + size[b];
      sheets_.join(a, b);
      size[sheets_.find(a)] = sum;
    }
  }

  const Complex& axis_;
  detail::UnionFind sheets_;
};

/// Adds the sides of triangles that are rims or seams to the edges; returns those that are neither.
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
    // The smallest triangle of a sheet stands for it, and so has its number before the others.
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
  number_sheets(axis, SheetJoiner(axis).join(hinges));
  find_vertex_roles(axis);
}

}  // namespace blum
