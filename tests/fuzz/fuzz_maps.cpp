// Reads arbitrary bytes as a surface map. The reader must reject them or return a map that fits its mesh and atlas.
#include "blum/io/surface_map_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    using blum::fuzz::require;
    const blum::SurfaceMapFile file = blum::read_surface_map(bytes, "fuzz");
    const blum::SurfaceMap& map = file.map;
    const blum::SurfaceAtlas& atlas = *map.atlas;
    blum::validate(file.mesh);
    require(atlas.size() == std::size_t{atlas.width} * atlas.height && atlas.size() > 0);
    require(map.distance.size() == atlas.size() && map.vector.size() == atlas.size());
    require(map.site.size() == atlas.size() && atlas.corners.size() == file.mesh.triangles.size());
    require(map.faces.size() == file.mesh.triangles.size() && map.vertex_distance.size() == file.mesh.vertices.size());
    require(map.error.empty() || map.error.size() == file.mesh.triangles.size());
    for (const blum::TriangleId triangle : atlas.triangle) {
      require(!triangle.has_value() || triangle.value < file.mesh.triangles.size());
    }
    // The map can be coloured, and its texels have points.
    if (atlas.size() < 100'000) {
      static_cast<void>(blum::color_texture(map, blum::color_scale_of(map)));
      static_cast<void>(blum::surface_texels(file.mesh, atlas));
    }
  });
}
