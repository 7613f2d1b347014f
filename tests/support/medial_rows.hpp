// Blum: medial axes as rows, for tests that build or compare them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/complex/medial_columns.hpp"

namespace blum::test {

inline constexpr float always = std::numeric_limits<float>::infinity();

struct VertexRow {
  Vec3d position;
  double radius = 0;
  std::array<Vec3d, 2> footprints;
  std::array<SiteId, 2> sites;
  double separation_angle = 0;
  MedialRole role = MedialRole::sheet;
  float until = always;
  friend bool operator==(const VertexRow&, const VertexRow&) = default;
};

struct EdgeRow {
  std::array<std::uint32_t, 2> vertices;
  float separation_angle = 0;
  MedialRole role = MedialRole::curve;
  float from = 0;
  float until = always;
  friend bool operator==(const EdgeRow&, const EdgeRow&) = default;
};

struct TriangleRow {
  std::array<std::uint32_t, 3> vertices;
  float separation_angle = 0;
  std::uint32_t sheet = 0;
  float until = always;
  friend bool operator==(const TriangleRow&, const TriangleRow&) = default;
};

/// A medial axis as rows. It converts implicitly to a complex with all columns.
struct AxisRows {
  std::vector<VertexRow> vertices;
  std::vector<EdgeRow> edges;
  std::vector<TriangleRow> triangles;
  std::uint32_t sheet_count = 0;  ///< sheets of the complex
  bool has_levels = false;        ///< true if the columns `from` and `until` exist

  AxisRows() = default;
  AxisRows(const Complex& given) {  // NOLINT(google-explicit-constructor): tests read better so
    const CompleteAxis all(given);
    const Complex& complex = all.get();
    const MedialView view(complex);
    for (std::size_t v = 0; v < view.positions.size(); ++v) {
      vertices.push_back({view.positions[v],
                          view.radius[v],
                          {view.footprint(v, 0), view.footprint(v, 1)},
                          {view.site(v, 0), view.site(v, 1)},
                          view.separation_angle[v],
                          view.role(v)});
    }
    for (std::size_t e = 0; e < view.edges.size(); ++e) {
      edges.push_back({view.edges[e], view.edge_angle[e], view.edge_role(e)});
    }
    for (std::size_t t = 0; t < view.triangles.size(); ++t) {
      triangles.push_back({view.triangles[t], view.triangle_angle[t], static_cast<std::uint32_t>(view.sheet[t])});
    }
    sheet_count = static_cast<std::uint32_t>(blum::sheet_count(complex));
    has_levels = complex.vertex_columns.find(medial_columns::until) != nullptr;
    if (has_levels) take_levels(MedialLevels(complex));
  }

  operator Complex() const {  // NOLINT(google-explicit-constructor): tests read better so
    Complex complex;
    for (const VertexRow& v : vertices) complex.positions.push_back(v.position);
    for (const EdgeRow& e : edges) complex.edges.push_back(e.vertices);
    for (const TriangleRow& t : triangles) complex.triangles.push_back(t.vertices);
    add_missing_medial_columns(complex);
    set<double>(complex.vertex_columns, "radius", vertices, [](const VertexRow& v) { return v.radius; });
    set<double>(complex.vertex_columns, "separation_angle", vertices,
                [](const VertexRow& v) { return v.separation_angle; });
    set<std::int32_t>(complex.vertex_columns, "role", vertices, [](const VertexRow& v) { return v.role; });
    for (std::size_t k = 0; k < 2; ++k) {
      set<std::int32_t>(complex.vertex_columns, medial_columns::sites[k], vertices,
                        [&](const VertexRow& v) { return v.sites[k].to_file(); });
      const auto feet = complex.vertex_columns.edit<double>(medial_columns::footprints[k], 3);
      for (std::size_t v = 0; v < vertices.size(); ++v) {
        for (std::size_t c = 0; c < 3; ++c) feet[3 * v + c] = vertices[v].footprints[k][c];
      }
    }
    set<float>(complex.edge_columns, "separation_angle", edges, [](const EdgeRow& e) { return e.separation_angle; });
    set<std::int32_t>(complex.edge_columns, "role", edges, [](const EdgeRow& e) { return e.role; });
    set<float>(complex.triangle_columns, "separation_angle", triangles,
               [](const TriangleRow& t) { return t.separation_angle; });
    set<std::int32_t>(complex.triangle_columns, "sheet", triangles, [](const TriangleRow& t) { return t.sheet; });
    if (has_levels) add_levels(complex);
    return complex;
  }

 private:
  template <class T, class Row, class Get>
  static void set(Columns& columns, std::string_view name, const std::vector<Row>& all, const Get& get) {
    if (columns.find(name) == nullptr) columns.add<T>(std::string(name));
    const auto numbers = columns.edit<T>(name);
    for (std::size_t row = 0; row < all.size(); ++row) numbers[row] = static_cast<T>(get(all[row]));
  }

  void add_levels(Complex& complex) const {
    set<float>(complex.vertex_columns, "until", vertices, [](const VertexRow& v) { return v.until; });
    set<float>(complex.edge_columns, "from", edges, [](const EdgeRow& e) { return e.from; });
    set<float>(complex.edge_columns, "until", edges, [](const EdgeRow& e) { return e.until; });
    set<float>(complex.triangle_columns, "until", triangles, [](const TriangleRow& t) { return t.until; });
  }

  void take_levels(const MedialLevels& levels) {
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v].until = levels.vertex_until[v];
    for (std::size_t e = 0; e < edges.size(); ++e) edges[e].from = levels.edge_from[e];
    for (std::size_t e = 0; e < edges.size(); ++e) edges[e].until = levels.edge_until[e];
    for (std::size_t t = 0; t < triangles.size(); ++t) triangles[t].until = levels.triangle_until[t];
  }
};

}  // namespace blum::test
