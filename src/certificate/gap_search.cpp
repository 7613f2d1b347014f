#include "certificate/gap_search.hpp"

#include <algorithm>
#include <array>
#include <unordered_set>

#include "blum/core/random.hpp"

namespace blum::verifier {

std::optional<bool> GapSearch::crosses(const Vec3d& a, const Vec3d& b, std::uint32_t body, double reach) const {
  const auto met = meetings(a, b, body);
  if (!met) return std::nullopt;
  const double nothing = 1e-13 * solid_.diagonal();
  bool is_told = true;
  for (std::size_t k = 0; k + 1 < met->size(); ++k) {
    const Meeting& from = (*met)[k];
    const Meeting& to = (*met)[k + 1];
    if (from.triangle == to.triangle || solid_.depth(0.5 * (from.at + to.at), body) > 0) continue;
    const std::optional<bool> joined = are_joined(from, to, reach);
    if (joined == true) continue;
    if (joined == false && length(to.at - from.at) > nothing) return true;
    is_told = false;
  }
  return is_told ? std::optional(false) : std::nullopt;
}

std::optional<std::vector<GapSearch::Meeting>> GapSearch::meetings(const Vec3d& a, const Vec3d& b,
                                                                   std::uint32_t body) const {
  constexpr std::uint32_t most_attempts = 8;
  const double nothing = 1e-13 * solid_.diagonal();
  const double whole = length(b - a);
  std::vector<Meeting> met;
  const auto add_end = [&](const Vec3d& p) {
    if (solid_.depth(p, body) <= nothing) met.push_back({p, search_.nearest(p, body).triangle});
  };
  add_end(a);
  if (!(whole > nothing)) return met;
  Random random(0x9a9U);
  std::vector<Crossing> crossings;
  bool is_certain = search_.crossings(line_between(a, b), crossings, whole);
  // What runs through edges of the mesh cannot be told: others next to it can.
  double aside = 0;
  for (std::uint32_t k = 0; k < most_attempts && !is_certain; ++k) {
    const Vec3d from = a + random.in_ball() * aside;
    const Vec3d to = b + random.in_ball() * aside;
    is_certain = search_.exact_crossings(from, to, body, crossings);
    aside = std::max(4 * aside, nothing);
  }
  if (!is_certain) return std::nullopt;
  std::erase_if(crossings, [&](const Crossing& one) {
    return body_of_[one.triangle] != body || one.at < -nothing || one.at > whole + nothing;
  });
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) { return p.at < q.at; });
  for (const Crossing& one : crossings) {
    met.push_back({a + (b - a) * std::clamp(one.at / whole, 0.0, 1.0), one.triangle});
  }
  add_end(b);
  return met;
}

std::optional<bool> GapSearch::are_joined(const Meeting& from, const Meeting& to, double reach) const {
  constexpr std::size_t most_triangles = 20'000;
  const Segment3 between{from.at, to.at};
  std::unordered_set<std::uint32_t> seen{from.triangle};
  std::vector<std::uint32_t> line{from.triangle};
  while (!line.empty()) {
    const std::uint32_t t = line.back();
    line.pop_back();
    if (t == to.triangle) return true;
    if (seen.size() > most_triangles) return std::nullopt;
    const std::array<Vec3d, 3> corners = corners_of(mesh_, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = beside_[3 * t + k];
      if (seen.contains(other)) continue;
      const Segment3 side{corners[k], corners[(k + 1) % 3]};
      if (squared_distance(between, side) > reach * reach) continue;
      seen.insert(other);
      line.push_back(other);
    }
  }
  return false;
}

}  // namespace blum::verifier
