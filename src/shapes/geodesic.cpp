#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shapes/generator_parts.hpp"

namespace blum::detail {
namespace {

constexpr std::array<Triangle, 20> icosahedron_faces = {{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                         {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                         {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                         {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};

std::array<Vec3d, 12> icosahedron_corners() {
  constexpr double g = std::numbers::phi;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}}};
}

/// Order of the vertices: the 12 corners, then the inner points of the 30 edges, then the inner points of the 20 faces.
class Layout {
 public:
  explicit Layout(std::uint32_t frequency) : frequency_(frequency) {
    for (const Triangle& face : icosahedron_faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = face[k];
        const std::uint32_t b = face[(k + 1) % 3];
        if (a < b) edge_[a][b] = edge_[b][a] = edges_++;
      }
    }
  }
  [[nodiscard]] std::uint32_t vertex_count() const { return 10 * frequency_ * frequency_ + 2; }

  /// Returns the vertex of a face with weights (w0, w1, w2) for its corners. The sum of the weights is the frequency.
  [[nodiscard]] std::uint32_t vertex(std::uint32_t face, const std::array<std::uint32_t, 3>& weights) const {
    const Triangle& corners = icosahedron_faces[face];
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] == frequency_) return corners[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] != 0) continue;
      const std::size_t a = (k + 1) % 3;
      const std::size_t b = (k + 2) % 3;
      const std::uint32_t along = corners[a] < corners[b] ? weights[b] : weights[a];
      return 12 + edge_[corners[a]][corners[b]] * (frequency_ - 1) + along - 1;
    }
    const std::uint32_t inner = (frequency_ - 1) * (frequency_ - 2) / 2;
    const std::uint32_t row = weights[0] - 1;  // row r has frequency - 2 - r points
    const std::uint32_t before = row * (frequency_ - 2) - row * (row - 1) / 2;
    return 12 + 30 * (frequency_ - 1) + face * inner + (row == 0 ? 0 : before) + weights[1] - 1;
  }

 private:
  std::uint32_t frequency_;
  std::uint32_t edges_ = 0;
  std::array<std::array<std::uint32_t, 12>, 12> edge_{};
};

}  // namespace

TriangleMesh geodesic(int frequency) {
  require_at_least(frequency, 1, "frequency");
  require_triangle_count(20.0 * frequency * frequency);
  const auto n = static_cast<std::uint32_t>(frequency);
  const Layout layout(n);
  const auto corners = icosahedron_corners();
  TriangleMesh mesh;
  mesh.vertices.resize(layout.vertex_count());
  mesh.triangles.reserve(20 * std::size_t{n} * n);
  for (std::uint32_t face = 0; face < 20; ++face) {
    const Triangle& corner = icosahedron_faces[face];
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return layout.vertex(face, {i, j, n - i - j}); };
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; i + j <= n; ++j) {
        const Vec3d p = corners[corner[0]] * i + corners[corner[1]] * j + corners[corner[2]] * (n - i - j);
        mesh.vertices[at(i, j)] = p / length(p);
        if (i + j == n) continue;
        mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i, j)});
        if (i + j + 2 <= n) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  return mesh;
}

}  // namespace blum::detail
