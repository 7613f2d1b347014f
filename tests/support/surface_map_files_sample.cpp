// Writes a surface map for other programs: map.npz, map.png, map.glb, map.ply, map.vtp in a folder.
//   surface_map_files_sample DIR
#include <exception>
#include <filesystem>
#include <iostream>

#include "blum/io/formats.hpp"
#include "blum/io/surface_map_io.hpp"
#include "surface_map_sample.hpp"

int main(int argc, char** argv) {
  using namespace blum;
  if (argc != 2) {
    std::cerr << "usage: surface_map_files_sample DIR\n";
    return 2;
  }
  try {
    const test::BoxMap box(3);
    for (const std::string& end : file_extensions(FileContent::surface_map, FileAccess::write)) {
      write_surface_map(std::filesystem::path(argv[1]) / ("map" + end), box.mesh, box.map, {{"source", "a box"}},
                        {.units = "mm"});
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
