// Reads arbitrary bytes as a mesh. The reader must reject them or return a sound mesh no larger than the input.
#include "blum/io/mesh_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const blum::MeshFormat format(BLUM_FORMAT);
  return blum::fuzz::feed(data, size, [&](std::span<const std::byte> bytes) {
    using blum::fuzz::require;
    const blum::TriangleMesh mesh = blum::read_mesh(bytes, format, {}, "fuzz");
    require(mesh.vertices.size() <= size && mesh.triangles.size() <= size && mesh.segments.size() <= size);
    require(mesh.points.size() <= size && !mesh.vertices.empty());
    for (const blum::Vec3d& vertex : mesh.vertices) require(is_finite(vertex));
    for (const blum::Triangle& t : mesh.triangles) {
      for (const std::uint32_t index : t) require(index < mesh.vertices.size());
    }
    for (const blum::Segment& s : mesh.segments) require(s[0] < mesh.vertices.size() && s[1] < mesh.vertices.size());
    for (const std::uint32_t index : mesh.points) require(index < mesh.vertices.size());
  });
}
