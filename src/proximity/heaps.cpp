#include "proximity/heaps.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/error.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t pairs_among(std::size_t count) {
  return count < 2 ? 0 : count * (count - 1) / 2;
}

/// How many primitives have a vertex in each place.
std::vector<std::uint32_t> primitives_at_vertices(const ObjectPair& objects) {
  const SceneObject& object = objects.a();
  std::vector<std::uint32_t> count(object.mesh().vertices.size(), 0);
  for (std::uint32_t p = 0; p < object.primitives(); ++p) {
    const std::array<std::uint32_t, 3> places = objects.places(p);
    ++count[places[0]];
    if (places[1] != places[0]) ++count[places[1]];
    if (places[2] != places[0] && places[2] != places[1]) ++count[places[2]];
  }
  return count;
}

}  // namespace

void check_neighbours(const ObjectPair& objects) {
  const std::vector<std::uint32_t> count = primitives_at_vertices(objects);
  const auto most = std::max_element(count.begin(), count.end());
  if (most == count.end() || pairs_among(*most) <= most_candidates) return;
  throw InvalidMesh(name_of(objects.first(), objects.a()) + ": " + std::to_string(*most) +
                    " primitives meet at vertex " + std::to_string(most - count.begin()) + ", which are more than " +
                    std::to_string(most_candidates) + " pairs: take duplicates away");
}

void check_equal_triangles(const ObjectPair& objects) {
  const std::vector<std::uint32_t> count = primitives_at_vertices(objects);
  // Of many equal triangles, each has many at all three corners.
  std::vector<std::array<std::uint32_t, 3>> crowded;
  for (std::uint32_t t = 0; t < objects.a().triangles(); ++t) {
    std::array<std::uint32_t, 3> places = objects.places(t);
    const bool is_crowded = std::all_of(places.begin(), places.end(),
                                        [&](std::uint32_t v) { return pairs_among(count[v]) > most_close_pairs; });
    if (!is_crowded) continue;
    std::sort(places.begin(), places.end());
    crowded.push_back(places);
  }
  std::sort(crowded.begin(), crowded.end());
  std::size_t pairs = 0;
  for (auto from = crowded.begin(); from != crowded.end();) {
    const auto to = std::upper_bound(from, crowded.end(), *from);
    pairs += pairs_among(static_cast<std::size_t>(to - from));
    from = to;
  }
  check_count(pairs);
}

}  // namespace blum::detail
