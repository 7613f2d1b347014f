#include "blum/axis/shrinking_complex.hpp"

#include <algorithm>

namespace blum::detail {

ShrinkingComplex::ShrinkingComplex(const ComplexView& complex)
    : edges_(complex.edges.begin(), complex.edges.end()),
      triangles_(complex.triangles.begin(), complex.triangles.end()),
      is_edge_gone_(edges_.size(), false),
      is_triangle_gone_(triangles_.size(), false),
      is_vertex_gone_(complex.vertex_count, false),
      first_corner_(complex.vertex_count, none),
      next_corner_(3 * triangles_.size(), none),
      first_end_(complex.vertex_count, none),
      next_end_(2 * edges_.size(), none) {
  for (std::uint32_t c = 0; c < next_corner_.size(); ++c) {
    std::uint32_t& first = first_corner_[triangles_[c / 3][c % 3]];
    next_corner_[c] = first;
    first = c;
  }
  for (std::uint32_t c = 0; c < next_end_.size(); ++c) {
    std::uint32_t& first = first_end_[edges_[c / 2][c % 2]];
    next_end_[c] = first;
    first = c;
  }
}

bool ShrinkingComplex::has_triangle_of(std::uint32_t u, std::uint32_t x, std::uint32_t y) const {
  bool found = false;
  for_each_triangle(u, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
    found = found || (p == x && q == y) || (p == y && q == x);
  });
  return found;
}

bool ShrinkingComplex::may_contract(std::uint32_t from, std::uint32_t to, LinkScratch& scratch) const {
  auto& [linked, linked_to_edge] = scratch;
  linked.clear();
  linked_to_edge.clear();
  for_each_triangle(from, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
    linked.insert(linked.end(), {p, q});
    if (p == to || q == to) linked_to_edge.push_back(p == to ? q : p);
  });
  for_each_edge(from, [&](std::uint32_t, std::uint32_t other) { linked.push_back(other); });
  std::sort(linked.begin(), linked.end());
  std::sort(linked_to_edge.begin(), linked_to_edge.end());
  const bool is_twice =
      std::adjacent_find(linked_to_edge.begin(), linked_to_edge.end()) != linked_to_edge.end();  // equal triangles
  const auto is_of_edge = [&](std::uint32_t v) {
    return std::binary_search(linked_to_edge.begin(), linked_to_edge.end(), v);
  };
  bool holds = !is_twice;
  const auto look_at = [&](std::uint32_t v) {
    if (holds && v != from && !is_of_edge(v)) holds = !std::binary_search(linked.begin(), linked.end(), v);
  };
  for_each_triangle(to, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
    look_at(p);
    look_at(q);
    if (holds && p != from && q != from && is_of_edge(p) && is_of_edge(q)) holds = !has_triangle_of(from, p, q);
  });
  for_each_edge(to, [&](std::uint32_t, std::uint32_t other) { look_at(other); });
  return holds;
}

void ShrinkingComplex::unlink_triangle(std::uint32_t t, std::uint32_t v) {
  std::uint32_t* link = &first_corner_[v];
  while (*link / 3 != t) link = &next_corner_[*link];
  *link = next_corner_[*link];
}

void ShrinkingComplex::unlink_edge(std::uint32_t e, std::uint32_t v) {
  std::uint32_t* link = &first_end_[v];
  while (*link / 2 != e) link = &next_end_[*link];
  *link = next_end_[*link];
}

std::span<const ShrinkingComplex::Gone> ShrinkingComplex::contract(std::uint32_t from, std::uint32_t to) {
  gone_.clear();
  for (std::uint32_t c = first_corner_[from]; c != none;) {
    const std::uint32_t next = next_corner_[c];
    const std::uint32_t t = c / 3;
    const std::uint32_t p = triangles_[t][(c + 1) % 3];
    const std::uint32_t q = triangles_[t][(c + 2) % 3];
    if (p == to || q == to) {
      is_triangle_gone_[t] = true;
      gone_.push_back({t, p == to ? q : p});
      unlink_triangle(t, p);
      unlink_triangle(t, q);
    } else {
      triangles_[t][c % 3] = to;
      next_corner_[c] = first_corner_[to];
      first_corner_[to] = c;
    }
    c = next;
  }
  for (std::uint32_t c = first_end_[from]; c != none;) {
    const std::uint32_t next = next_end_[c];
    const std::uint32_t other = edges_[c / 2][(c + 1) % 2];
    if (other == to) {
      is_edge_gone_[c / 2] = true;
      unlink_edge(c / 2, to);
    } else {
      edges_[c / 2][c % 2] = to;
      next_end_[c] = first_end_[to];
      first_end_[to] = c;
    }
    c = next;
  }
  first_corner_[from] = none;
  first_end_[from] = none;
  is_vertex_gone_[from] = true;
  return gone_;
}

void ShrinkingComplex::add_edge(const std::array<std::uint32_t, 2>& ends) {
  edges_.push_back(ends);
  is_edge_gone_.push_back(false);
  for (const std::uint32_t v : ends) {
    next_end_.push_back(first_end_[v]);
    first_end_[v] = static_cast<std::uint32_t>(next_end_.size() - 1);
  }
}

Complex ShrinkingComplex::rest_of(const Complex& whole) const {
  Complex out;
  std::vector<std::uint32_t> number(whole.positions.size(), none);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (is_vertex_gone_[v]) continue;
    number[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(v);
    out.positions.push_back(whole.positions[v]);
  }
  out.vertex_columns = whole.vertex_columns.pick(kept);
  const auto pick = [&](const auto& cells, std::size_t count, const std::vector<bool>& is_gone, auto& out_cells) {
    kept.clear();
    for (std::uint32_t c = 0; c < count; ++c) {
      if (is_gone[c]) continue;
      auto cell = cells[c];
      for (std::uint32_t& v : cell) v = number[v];
      out_cells.push_back(cell);
      kept.push_back(c);
    }
  };
  pick(edges_, whole.edges.size(), is_edge_gone_, out.edges);
  out.edge_columns = whole.edge_columns.pick(kept);
  pick(triangles_, whole.triangles.size(), is_triangle_gone_, out.triangles);
  out.triangle_columns = whole.triangle_columns.pick(kept);
  return out;
}

}  // namespace blum::detail
