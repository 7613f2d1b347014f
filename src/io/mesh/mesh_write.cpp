#include "io/mesh/mesh_write.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {

void cannot_hold(const std::filesystem::path& path, std::string_view format, std::string_view what) {
  throw FileError("cannot write '" + path.string() + "': " + std::string(format) + " holds no " + std::string(what) +
                  "; write OBJ instead");
}

void refuse_points(const std::filesystem::path& path, std::string_view format, const MeshView& mesh) {
  if (mesh.points.empty()) return;
  if (!mesh.triangles.empty() || !mesh.segments.empty()) cannot_hold(path, format, "points beside other parts");
  std::vector<bool> named(mesh.vertices.size(), false);
  for (const std::uint32_t point : mesh.points) named[point] = true;
  if (std::find(named.begin(), named.end(), false) != named.end()) {
    cannot_hold(path, format, "vertices that are not part of a point cloud");
  }
}

}  // namespace blum
