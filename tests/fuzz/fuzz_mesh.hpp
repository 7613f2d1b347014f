// Blum: what the fuzz targets of the mesh readers share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum::fuzz {

/// Reads bytes as a mesh: either Blum refuses them with an error of its own, or the result is a sound mesh whose size
/// is in proportion to the input's.
inline void read_any_mesh(const std::uint8_t* data, std::size_t size, MeshFormat format) {
  MeshFile file;
  try {
    file = read_mesh_file(std::as_bytes(std::span(data, size)), format, {}, "fuzz");
  } catch (const FormatError&) {
    return;
  }
  const TriangleMesh& mesh = file.mesh;
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  require(mesh.vertices.size() <= size && mesh.triangles.size() <= size && mesh.segments.size() <= size);
  require(mesh.points.size() <= size && !mesh.vertices.empty());
  for (const Vec3d& vertex : mesh.vertices) require(is_finite(vertex));
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t index : t) require(index < mesh.vertices.size());
  }
  for (const Segment& s : mesh.segments) require(s[0] < mesh.vertices.size() && s[1] < mesh.vertices.size());
  for (const std::uint32_t index : mesh.points) require(index < mesh.vertices.size());
}

}  // namespace blum::fuzz
