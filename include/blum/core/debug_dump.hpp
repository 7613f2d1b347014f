// Blum: shapes as small files to look at while debugging. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "blum/core/vec3.hpp"

namespace blum {

/// Writes points, and edges and triangles between them, as a .vtp file for ParaView, PyVista and read_complex().
///
/// This function is for debugging only. Code in any layer may call debug_dump() temporarily. `tools/check_includes.py`
/// rejects this header everywhere except in tests, so that no call remains in the library. Use write_complex() to keep
/// a complex with its columns.
///
/// Points without an edge or a triangle are drawn as points. Invalid shapes are accepted. A point that is not finite is
/// written as the origin, and not drawn. An edge or triangle is left out if one of its points is not finite, or if an
/// index is out of range.
///
/// @param path  path of the file, which is replaced. Threads that write at the same time need different paths.
/// @throws FileError if the file cannot be written.
void debug_dump(const std::string& path, std::span<const Vec3d> points,
                std::span<const std::array<std::uint32_t, 2>> edges = {},
                std::span<const std::array<std::uint32_t, 3>> triangles = {});

/// Writes the vertices, segments and triangles of a TriangleMesh or a MeshView as a .vtp file, as the function above
/// does.
template <class Mesh>
  requires requires(const Mesh& mesh) {
    mesh.vertices;
    mesh.segments;
    mesh.triangles;
  }
void debug_dump(const std::string& path, const Mesh& mesh) {
  debug_dump(path, mesh.vertices, mesh.segments, mesh.triangles);
}

/// Writes a Complex without its columns as a .vtp file, as the function above does.
template <class Shape>
  requires requires(const Shape& complex) {
    complex.positions;
    complex.edges;
    complex.triangles;
  }
void debug_dump(const std::string& path, const Shape& complex) {
  debug_dump(path, complex.positions, complex.edges, complex.triangles);
}

}  // namespace blum
