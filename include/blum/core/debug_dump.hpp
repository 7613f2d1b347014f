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
/// It is for debugging only. Any layer can call it; the library itself never does. `tools/check_includes.py` rejects
/// this header everywhere but in tests, so that no call stays behind. Use write_complex() to keep a complex with its
/// columns.
///
/// Points that no edge and no triangle names are drawn as points. Broken shapes are accepted. A point that is not
/// finite is put at the origin and not drawn. Edges and triangles that name such a point, or one that does not exist,
/// are left out.
///
/// @param path  path of the file, which is replaced. Threads that write at the same time need different paths.
/// @throws FileError if it cannot be written.
void debug_dump(const std::string& path, std::span<const Vec3d> points,
                std::span<const std::array<std::uint32_t, 2>> edges = {},
                std::span<const std::array<std::uint32_t, 3>> triangles = {});

/// Writes the triangles and segments of a TriangleMesh or a MeshView likewise.
template <class Mesh>
  requires requires(const Mesh& mesh) {
    mesh.vertices;
    mesh.segments;
    mesh.triangles;
  }
void debug_dump(const std::string& path, const Mesh& mesh) {
  debug_dump(path, mesh.vertices, mesh.segments, mesh.triangles);
}

/// Writes a Complex likewise, without its columns.
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
