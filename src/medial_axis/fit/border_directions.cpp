#include "medial_axis/fit/border_directions.hpp"

#include <cmath>

namespace blum::detail {

Vec3d BorderDirections::of_rim(std::uint32_t v) const {
  constexpr int reach = 4;
  Vec3d sum;
  for (const std::uint32_t first : incidence_.edges_of_vertex()[v]) {
    if (incidence_.triangles_of_edge()[first].size() != 1) continue;
    std::uint32_t e = first;
    std::uint32_t from = v;
    for (int n = 0; n < reach; ++n) {
      sum += outwards_of(e) / (1 + n);
      const std::uint32_t next = other_end(incidence_.edges()[e], from);
      if (!kinds_[next].is_rim()) break;
      const std::uint32_t at = e;
      for (const std::uint32_t other : incidence_.edges_of_vertex()[next]) {
        if (other != at && incidence_.triangles_of_edge()[other].size() == 1) e = other;
      }
      from = next;
    }
  }
  const double size = length(sum);
  return size > 0 ? sum / size : Vec3d{};
}

Vec3d BorderDirections::towards_surface(std::uint32_t v) const {
  const AxisVertex& vertex = lists_.vertices[v];
  const Vec3d way = vertex.footprints[0] + vertex.footprints[1] - 2 * vertex.position;
  const double size = length(way);
  constexpr double least = 0.1;  // relative to the radius: a separation angle of 174 degrees
  return size > least * vertex.radius ? way / size : Vec3d{};
}

Vec3d BorderDirections::outwards_of(std::uint32_t e) const {
  const auto& side = incidence_.edges()[e];
  const std::uint32_t third = third_corner(lists_.triangles[incidence_.triangles_of_edge()[e][0]], side);
  const Vec3d& at = lists_.vertices[side[0]].position;
  const Vec3d along = lists_.vertices[side[1]].position - at;
  const Vec3d in = lists_.vertices[third].position - at;
  const double squared = squared_length(along);
  if (!(squared > 0)) return {};
  const Vec3d out = along * (dot(in, along) / squared) - in;
  const double size = length(out);
  return size > 0 ? out * (std::sqrt(squared) / size) : Vec3d{};
}

Vec3d BorderDirections::of_end(std::uint32_t v, std::size_t triangles) const {
  const auto next_of = [&](std::uint32_t at, std::uint32_t before) {
    for (const std::uint32_t e : incidence_.edges_of_vertex()[at]) {
      const std::size_t count = incidence_.triangles_of_edge()[e].size();
      if (triangles == 0 ? count > 0 : count < triangles) continue;
      const std::uint32_t other = other_end(incidence_.edges()[e], at);
      if (other != before) return other;
    }
    return at;
  };
  const std::uint32_t first = next_of(v, v);
  const std::uint32_t second = kinds_[first].is_seam() || kinds_[first].is_curve() ? next_of(first, v) : first;
  const Vec3d way = lists_.vertices[v].position - lists_.vertices[second].position;
  const double size = length(way);
  return size > 0 ? way / size : Vec3d{};
}

bool BorderDirections::comes_back(std::uint32_t v) const {
  constexpr double same_way = 0.95;  // cosine
  const std::uint32_t own = incidence_.edges_of_vertex()[v][0];
  const std::uint32_t at = other_end(incidence_.edges()[own], v);
  const Vec3d way = lists_.vertices[v].position - lists_.vertices[at].position;
  for (const std::uint32_t e : incidence_.edges_of_vertex()[at]) {
    if (e == own || !incidence_.triangles_of_edge()[e].empty()) continue;
    const Vec3d other = lists_.vertices[other_end(incidence_.edges()[e], at)].position - lists_.vertices[at].position;
    const bool is_longer =
        squared_length(other) > squared_length(way) || (squared_length(other) == squared_length(way) && e < own);
    if (is_longer && dot(way, other) >= same_way * length(way) * length(other)) return true;
  }
  return false;
}

}  // namespace blum::detail
