#include "medial_axis/label_sheets.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "blum/core/union_find.hpp"

namespace blum {
namespace {

/// One side of a triangle.
struct Side {
  std::array<std::uint32_t, 2> vertices;  ///< smaller first
  std::uint32_t triangle;
};

std::vector<Side> sorted_sides(const std::vector<MedialTriangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& v = triangles[t].vertices;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k];
      const std::uint32_t b = v[k == 2 ? 0 : k + 1];
      sides.push_back({{std::min(a, b), std::max(a, b)}, t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.triangle < b.triangle;
  });
  return sides;
}

constexpr std::uint32_t no_sheet = 0xffffffffU;

/// What is known of a vertex from its edges.
struct Around {
  std::uint32_t rims = 0, seams = 0, curves = 0;
  std::uint32_t sheet = no_sheet;
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
Vec3d leaf(const MedialComplex& complex, const std::array<std::uint32_t, 2>& edge, std::uint32_t triangle) {
  const auto& v = complex.triangles[triangle].vertices;
  const std::uint32_t third = v[0] ^ v[1] ^ v[2] ^ edge[0] ^ edge[1];
  const Vec3d& from = complex.vertices[edge[0]].position;
  const Vec3d along = complex.vertices[edge[1]].position - from;
  const Vec3d out = complex.vertices[third].position - from;
  const double squared = squared_length(along);
  return squared > 0 ? out - along * (dot(out, along) / squared) : out;
}

/// The cosine of the angle at a hinge: -1 where it is flat, and where a triangle has no area.
double cosine_of(const MedialComplex& complex, const Hinge& hinge) {
  const Vec3d a = leaf(complex, hinge.vertices, hinge.triangles[0]);
  const Vec3d b = leaf(complex, hinge.vertices, hinge.triangles[1]);
  const double scale = length(a) * length(b);
  return scale > 0 ? dot(a, b) / scale : -1;
}

/// Joins the triangles of sheets. Where seams lie a step beside the crease of two sheets, first on one side of it and
/// then on the other, the two hang together at the step: so sharp hinges at seams join nothing, unless what they cut
/// off is only a few triangles.
class SheetJoiner {
 public:
  explicit SheetJoiner(const MedialComplex& complex) : complex_(complex), sheets_(complex.triangles.size()) {}

  detail::UnionFind join(const std::vector<Hinge>& hinges) {
    std::vector<bool> is_on_seam(complex_.vertices.size(), false);
    for (const MedialEdge& edge : complex_.edges) {
      if (edge.role != MedialRole::seam) continue;
      for (const std::uint32_t v : edge.vertices) is_on_seam[v] = true;
    }
    std::vector<std::pair<double, Hinge>> sharp;
    for (const Hinge& hinge : hinges) {
      const bool is_at_seam = is_on_seam[hinge.vertices[0]] || is_on_seam[hinge.vertices[1]];
      const double cosine = is_at_seam ? cosine_of(complex_, hinge) : -1;
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
    std::vector<std::size_t> size(complex_.triangles.size(), 0);
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

  const MedialComplex& complex_;
  detail::UnionFind sheets_;
};

}  // namespace

void label_sheets(MedialComplex& complex) {
  const std::vector<Side> sides = sorted_sides(complex.triangles);
  std::vector<Hinge> hinges;
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first;
    float largest = 0;
    while (end < sides.size() && sides[end].vertices == sides[first].vertices) {
      largest = std::max(largest, complex.triangles[sides[end].triangle].separation_angle);
      ++end;
    }
    if (end - first == 2) {
      hinges.push_back({sides[first].vertices, {sides[first].triangle, sides[first + 1].triangle}});
    } else {
      complex.edges.push_back({sides[first].vertices, largest, end - first == 1 ? MedialRole::rim : MedialRole::seam});
    }
    first = end;
  }
  detail::UnionFind sheets = SheetJoiner(complex).join(hinges);
  std::vector<std::uint32_t> number(complex.triangles.size(), 0);
  complex.sheet_count = 0;
  for (std::uint32_t t = 0; t < complex.triangles.size(); ++t) {
    if (sheets.find(t) == t) number[t] = complex.sheet_count++;
    complex.triangles[t].sheet = number[sheets.find(t)];
  }
  std::vector<Around> around(complex.vertices.size());
  for (const MedialEdge& edge : complex.edges) {
    for (const std::uint32_t v : edge.vertices) {
      ++(edge.role == MedialRole::rim    ? around[v].rims
         : edge.role == MedialRole::seam ? around[v].seams
                                         : around[v].curves);
    }
  }
  for (const MedialTriangle& t : complex.triangles) {
    for (const std::uint32_t v : t.vertices) {
      if (around[v].sheet != no_sheet && around[v].sheet != t.sheet) around[v].has_several_sheets = true;
      around[v].sheet = t.sheet;
    }
  }
  for (std::size_t v = 0; v < around.size(); ++v) complex.vertices[v].role = role_of(around[v]);
}

MedialCounts count(const MedialComplex& complex) {
  MedialCounts counts;
  counts.vertices = complex.vertices.size();
  counts.triangles = complex.triangles.size();
  counts.sheets = complex.sheet_count;
  for (const MedialEdge& edge : complex.edges) {
    ++(edge.role == MedialRole::rim    ? counts.rim_edges
       : edge.role == MedialRole::seam ? counts.seam_edges
                                       : counts.curve_edges);
  }
  for (const MedialVertex& vertex : complex.vertices) counts.junctions += vertex.role == MedialRole::junction ? 1 : 0;
  return counts;
}

std::string_view to_string(MedialRole role) {
  switch (role) {
    case MedialRole::sheet:
      return "sheet";
    case MedialRole::rim:
      return "rim";
    case MedialRole::seam:
      return "seam";
    case MedialRole::curve:
      return "curve";
    case MedialRole::junction:
      return "junction";
  }
  return "unknown";
}

}  // namespace blum
