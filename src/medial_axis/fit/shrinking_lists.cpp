#include "medial_axis/fit/shrinking_lists.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/surface/void_points.hpp"

namespace blum::detail {

ShrinkingLists::ShrinkingLists(AxisLists& lists, const Incidence& incidence, const Surface& surface, int reach)
    : lists_(lists),
      paths_(surface),
      voids_(surface.voids()),
      cells_({lists.vertices.size(), lists.edges, lists.triangles}),
      incidence_(incidence),
      reach_(reach),
      rank_(lists.vertices.size(), 0),
      into_(lists.vertices.size()),
      changed_(lists.vertices.size(), 0) {
  std::iota(into_.begin(), into_.end(), 0U);
  for (std::uint32_t e = 0; e < incidence_.edges().size(); ++e) {
    const std::size_t count = incidence_.triangles_of_edge()[e].size();
    const int weight = count == 2 ? 0 : count == 1 ? 1 : on_seam;
    for (const std::uint32_t v : incidence_.edges()[e]) rank_[v] += weight;
  }
  // Ends of seams and curves get a high rank, so that they stay and the seams and curves do not become shorter.
  for (int& rank : rank_) rank += rank / on_seam == 1 ? (end_of_seam - 1) * on_seam : 0;
}

std::uint32_t ShrinkingLists::now(std::uint32_t v) const {
  while (into_[v] != v) v = into_[v];
  return v;
}

bool ShrinkingLists::may_contract(std::uint32_t from, std::uint32_t to, LinkScratch& scratch) const {
  return cells_.may_contract(from, to, scratch) && stays_in_solid(from, to);
}

SolidPaths ShrinkingLists::paths_around(std::uint32_t from, const Stop& target) const {
  Box3 box;
  box.extend(target.at);
  // True if all points lie in the ball around the target, which is inside the solid: no query of the surface is needed.
  bool are_in_ball = true;
  const auto include = [&](std::uint32_t v) {
    box.extend(position(v));
    are_in_ball = are_in_ball && length(position(v) - target.at) < target.nearest.distance;
  };
  include(from);
  cells_.for_each_edge(from, [&](std::uint32_t, std::uint32_t other) { include(other); });
  cells_.for_each_triangle(from, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
    include(p);
    include(q);
  });
  SolidPaths paths = paths_;
  if (!are_in_ball) paths.prepare(box);
  return paths;
}

bool ShrinkingLists::stays_in_solid(std::uint32_t from, std::uint32_t to) const {
  const Stop source = stop_of(lists_.vertices[from]);
  const Stop target = stop_of(lists_.vertices[to]);
  const SolidPaths paths = paths_around(from, target);
  bool stays = true;
  const auto look = [&](std::uint32_t v) {
    if (!stays || v == to) return;
    const Stop other = stop_of(lists_.vertices[v]);
    stays = paths.is_straight(target, other) && paths.is_open(source, target, other);
  };
  cells_.for_each_triangle(from, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
    look(p);
    look(q);
    stays = stays && !holds_any(voids_, {source.at, position(p), position(q), target.at});
  });
  cells_.for_each_edge(from, [&](std::uint32_t, std::uint32_t other) { look(other); });
  return stays;
}

void ShrinkingLists::contract(std::uint32_t from, std::uint32_t to) {
  rank_[to] = std::max(rank_[to], rank_[from]);
  into_[from] = to;
  ++contractions_;
  for (const auto& [triangle, third] : cells_.contract(from, to)) {
    if (is_joined(to, third)) continue;
    cells_.add_edge({to, third});
    lists_.add_edge({to, third}, lists_.triangle_angles[triangle]);
  }
  changed_[from] = contractions_;
  note_change_at(to);
}

void ShrinkingLists::note_change_at(std::uint32_t v) {
  changed_[v] = contractions_;
  noted_.assign(1, v);
  std::size_t begin = 0;
  const auto note = [&](std::uint32_t w) {
    if (changed_[w] == contractions_) return;
    changed_[w] = contractions_;
    noted_.push_back(w);
  };
  for (int step = 0; step < reach_; ++step) {
    for (const std::size_t end = noted_.size(); begin < end; ++begin) {
      cells_.for_each_triangle(noted_[begin], [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
        note(p);
        note(q);
      });
      cells_.for_each_edge(noted_[begin], [&](std::uint32_t, std::uint32_t other) { note(other); });
    }
  }
}

bool ShrinkingLists::is_joined(std::uint32_t a, std::uint32_t b) const {
  bool found = false;
  cells_.for_each_triangle(a,
                           [&](std::uint32_t, std::uint32_t p, std::uint32_t q) { found = found || p == b || q == b; });
  cells_.for_each_edge(a, [&](std::uint32_t, std::uint32_t other) { found = found || other == b; });
  return found;
}

void ShrinkingLists::write() {
  keep(cells_, lists_);
}

}  // namespace blum::detail
