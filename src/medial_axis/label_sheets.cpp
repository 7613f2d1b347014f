#include "medial_axis/label_sheets.hpp"

#include <algorithm>

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

}  // namespace

void label_sheets(MedialComplex& complex) {
  const std::vector<Side> sides = sorted_sides(complex.triangles);
  detail::UnionFind sheets(complex.triangles.size());
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first;
    float largest = 0;
    while (end < sides.size() && sides[end].vertices == sides[first].vertices) {
      largest = std::max(largest, complex.triangles[sides[end].triangle].separation_angle);
      ++end;
    }
    if (end - first == 2) {
      sheets.join(sides[first].triangle, sides[first + 1].triangle);
    } else {
      complex.edges.push_back({sides[first].vertices, largest, end - first == 1 ? MedialRole::rim : MedialRole::seam});
    }
    first = end;
  }
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
