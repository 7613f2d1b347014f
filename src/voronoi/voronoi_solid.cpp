#include "voronoi/voronoi_solid.hpp"

#include <algorithm>
#include <array>

namespace blum::voronoi {

FaceLoops::FaceLoops(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites) {
  const auto edge_of = [&](std::uint32_t t, std::uint32_t k) { return table.triangle_edges()[t][k].value; };
  const auto is_border = [&](std::uint32_t t, std::uint32_t k) { return sites.turn[edge_of(t, k)] != EdgeTurn::flat; };
  // Finds the side that follows side k of triangle t on the face's border. It is searched around the corner at the end
  // of side k.
  const auto next = [&](std::uint32_t t, std::uint32_t k) {
    k = (k + 1) % 3;
    while (!is_border(t, k)) {
      const std::uint32_t edge = edge_of(t, k);
      const auto [first, second] = sites.triangles_of[edge];
      t = first == t ? second : first;
      k = 0;
      while (edge_of(t, k) != edge) ++k;
      k = (k + 1) % 3;
    }
    return std::array<std::uint32_t, 2>{t, k};
  };
  std::vector<std::vector<std::vector<std::uint32_t>>> loops(sites.face_count);
  std::vector<std::array<bool, 3>> is_done(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (is_done[t][k] || !is_border(t, k)) continue;
      std::vector<std::uint32_t>& loop = loops[sites.face_of[t]].emplace_back();
      for (std::array<std::uint32_t, 2> at{t, k}; !is_done[at[0]][at[1]]; at = next(at[0], at[1])) {
        is_done[at[0]][at[1]] = true;
        loop.push_back(mesh.triangles[at[0]][at[1]]);
      }
    }
  }
  for (std::vector<std::vector<std::uint32_t>>& of_face : loops) {
    first_.push_back(static_cast<std::uint32_t>(loops_.size()));
    for (std::vector<std::uint32_t>& loop : of_face) loops_.push_back(std::move(loop));
  }
  first_.push_back(static_cast<std::uint32_t>(loops_.size()));
}

}  // namespace blum::voronoi
