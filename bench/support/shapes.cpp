#include "support/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"

namespace blum::bench {
namespace {

std::filesystem::path data_folder() {
  const char* const chosen = std::getenv("BLUM_DATA_DIR");
  return chosen != nullptr && *chosen != '\0' ? chosen : BLUM_DATA_DIR;
}

TriangleMesh organic(double triangles) {
  return make_organic({.frequency = static_cast<int>(std::lround(std::sqrt(triangles / 20)))});
}

TriangleMesh noisy_dense() {
  const TriangleMesh dense = make_subdivided(make_organic({.frequency = 71}), 2);
  double sum = 0;
  for (const Triangle& t : dense.triangles) sum += length(dense.vertices[t[1]] - dense.vertices[t[0]]);
  return make_noisy(dense, 0.05 * sum / static_cast<double>(dense.triangles.size()));
}

TriangleMesh make(const std::string& name, std::string& note) {
  const auto file = data_folder() / "meshes" / ((name == "bunny" ? "stanford-bunny" : name) + ".obj");
  if (name == "bunny" || name == "fandisk" || name == "rocker-arm") {
    if (std::filesystem::exists(file)) {
      note = name;
      return read_mesh(file);
    }
    note = "generated twin of the " + name;
    return name == "bunny" ? make_organic({.holes = 5}) : name == "fandisk" ? make_fan_part() : organic(20088);
  }
  if (name == "ballcube" || name == "eight") {
    const auto off = data_folder() / "meshes" / (name + ".off");
    note = std::filesystem::exists(off) ? name : "generated twin of the " + name;
    return std::filesystem::exists(off) ? read_mesh(off) : organic(name == "eight" ? 634 : 10884);
  }
  note = name;
  if (name == "noisy-1.6M") return noisy_dense();
  return organic(name == "organic" ? 69620 : std::stod(name.substr(8)));
}

}  // namespace

const reference::BruteForce& Shape::brute_force() const {
  if (!brute_force_) brute_force_ = std::make_unique<reference::BruteForce>(mesh);
  return *brute_force_;
}

const Shape& shape(const std::string& name) {
  static std::map<std::string, Shape> shapes;
  const auto found = shapes.find(name);
  if (found != shapes.end()) return found->second;
  Shape& made = shapes[name];
  made.mesh = make(name, made.note);
  made.note += ", " + std::to_string(made.mesh.triangles.size()) + " triangles";
  return made;
}

GridSpec cube_grid(const MeshView& mesh, int n) {
  const Box3 box = bounds(mesh);
  const Vec3d size = box.size();
  const double side = 1.2 * std::max({size.x, size.y, size.z});
  const double h = side / (n - 1);
  return {.origin = box.center() - Vec3d{side, side, side} * 0.5, .spacing = {h, h, h}, .size = {n, n, n}};
}

}  // namespace blum::bench
