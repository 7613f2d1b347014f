#include "blum/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"

namespace blum {
namespace {

constexpr double coordinate_limit = 1e150;

bool is_usable(const Vec3d& p) {
  return std::abs(p.x) <= coordinate_limit && std::abs(p.y) <= coordinate_limit && std::abs(p.z) <= coordinate_limit;
}

[[noreturn]] void throw_unusable(const MeshView& mesh, std::uint32_t vertex, const char* what, std::size_t index) {
  const std::string where = std::string(what) + " " + std::to_string(index) + " uses vertex " + std::to_string(vertex);
  if (vertex >= mesh.vertices.size()) {
    throw InvalidMesh(where + ", but there are only " + std::to_string(mesh.vertices.size()) + " vertices");
  }
  if (!is_finite(mesh.vertices[vertex])) throw InvalidMesh(where + ", which has a coordinate that is not finite");
  throw InvalidMesh(where + ", which lies further than 1e150 from the origin");
}

/// Calls visit(vertex, kind of element, index of element) for every use of a vertex by an element, in order.
template <class Visit>
void for_each_named(const MeshView& mesh, Visit visit) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) visit(v, "triangle", t);
  }
  for (std::size_t s = 0; s < mesh.segments.size(); ++s) {
    for (const std::uint32_t v : mesh.segments[s]) visit(v, "segment", s);
  }
  for (std::size_t p = 0; p < mesh.points.size(); ++p) visit(mesh.points[p], "point", p);
}

}  // namespace

TriangleMesh copy_of(const MeshView& mesh) {
  return {{mesh.vertices.begin(), mesh.vertices.end()},
          {mesh.triangles.begin(), mesh.triangles.end()},
          {mesh.segments.begin(), mesh.segments.end()},
          {mesh.points.begin(), mesh.points.end()}};
}

std::vector<Triangle> reversed_triangles(std::span<const Triangle> triangles) {
  std::vector<Triangle> turned(triangles.begin(), triangles.end());
  for (Triangle& t : turned) std::swap(t[0], t[1]);
  return turned;
}

Box3 bounds(const MeshView& mesh) {
  Box3 box;
  for_each_named_vertex(mesh, [&](std::uint32_t v) { box.extend(mesh.vertices[v]); });
  return box;
}

void validate(const MeshView& mesh) {
  if (mesh.triangles.empty() && mesh.segments.empty() && mesh.points.empty()) {
    throw InvalidMesh("the mesh has no triangle, segment or point");
  }
  if (mesh.vertices.size() > max_id_count || mesh.triangles.size() > max_id_count ||
      mesh.segments.size() > max_id_count) {
    throw InvalidMesh("the mesh has more than 2^31 - 1 vertices, triangles or segments");
  }
  // Vertices are used several times each. The first loop only searches for errors. Only if an error exists, the element
  // that uses the vertex matters.
  std::uint32_t largest = 0;
  for_each_named_vertex(mesh, [&](std::uint32_t v) { largest = std::max(largest, v); });
  if (largest < mesh.vertices.size() && std::all_of(mesh.vertices.begin(), mesh.vertices.end(), is_usable)) return;
  for_each_named(mesh, [&](std::uint32_t v, const char* what, std::size_t index) {
    if (v >= mesh.vertices.size() || !is_usable(mesh.vertices[v])) throw_unusable(mesh, v, what, index);
  });
}

}  // namespace blum
