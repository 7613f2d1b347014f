#include "io/gltf/gltf_corners.hpp"

#include <bit>
#include <cstddef>
#include <unordered_map>

namespace blum::gltf_files {
namespace {

struct Key {
  std::uint32_t vertex = 0;
  std::array<std::uint32_t, 2> place{};  ///< bits of the coordinates
  friend bool operator==(const Key&, const Key&) = default;
};

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = key.vertex;
    for (const std::uint32_t part : key.place) {
      hash = (hash ^ part) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

std::uint32_t bits_of(float coordinate) {
  return std::bit_cast<std::uint32_t>(coordinate == 0 ? 0.0F : coordinate);  // zeros are equal
}

}  // namespace

SplitVertices split_vertices(std::span<const Triangle> triangles, std::span<const TextureCorners> coordinates) {
  SplitVertices out;
  out.triangles.reserve(triangles.size());
  std::unordered_map<Key, std::uint32_t, KeyHash> known;
  known.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<float, 2>& place = coordinates[t][k];
      const Key key{triangles[t][k], {bits_of(place[0]), bits_of(place[1])}};
      const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(out.source.size()));
      if (is_new) {
        out.source.push_back(key.vertex);
        out.coordinates.push_back(place);
      }
      corners[k] = found->second;
    }
    out.triangles.push_back(corners);
  }
  return out;
}

}  // namespace blum::gltf_files
