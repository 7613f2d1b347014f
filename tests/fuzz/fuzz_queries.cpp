// Reads arbitrary bytes as queries of continuous collisions. The reader must reject them or return finite points, for
// which the queries succeed.
#include <algorithm>
#include <cmath>

#include "blum/io/collision_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    const blum::ImpactQueries queries = blum::read_impact_queries(bytes);
    blum::fuzz::require(queries.points.size() == queries.truth.size());
    constexpr std::size_t most_asked = 4;
    for (std::size_t k = 0; k < std::min(queries.points.size(), most_asked); ++k) {
      // These calls throw if coordinates are not finite.
      const auto time = blum::vertex_face_impact(queries.points[k]);
      blum::fuzz::require(!time || (*time >= 0 && *time <= 1));
      static_cast<void>(blum::edge_edge_impact(queries.points[k]));
    }
  });
}
