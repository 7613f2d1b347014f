#include "shapes/prism_complex.hpp"

#include <algorithm>

#include "shapes/generator_parts.hpp"

namespace blum::detail {

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
  // The order of the result is that in which faces were added.
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

}  // namespace blum::detail
