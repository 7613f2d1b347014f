// Reads arbitrary bytes as a path. The reader must reject them or return waypoints with equally many poses. Numbers
// that are not poses must be rejected when the path is made.
#include "blum/io/path_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    const blum::PathFile file = blum::read_path(bytes, blum::PathFormat(BLUM_FORMAT));
    blum::fuzz::require(!file.poses.empty());
    for (const auto& waypoint : file.poses) blum::fuzz::require(waypoint.size() == file.poses.front().size());
    try {
      const blum::MotionPath path = file.path({{}});
      blum::fuzz::require(path.poses.size() == file.poses.size());
    } catch (const blum::InvalidOption&) {  // Numbers are not poses.
    }
  });
}
