// Reads arbitrary bytes as rows of points. The reader must reject them or return finite points, at most one per row.
#include <algorithm>

#include "blum/io/point_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    const std::vector<blum::Vec3d> points = blum::read_point_rows(bytes);
    const auto is_line_end = [](std::byte b) { return b == std::byte{'\n'} || b == std::byte{'\r'}; };
    blum::fuzz::require(points.size() <=
                        1 + static_cast<std::size_t>(std::count_if(bytes.begin(), bytes.end(), is_line_end)));
    for (const blum::Vec3d& p : points) blum::fuzz::require(is_finite(p));
  });
}
