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
/// For debugging only: it can be called from any layer, and the library itself never does. `tools/check_includes.py`
/// refuses this header everywhere but in tests, so that no call stays behind. To keep a complex with its columns, use
/// write_complex().
///
/// Points that no edge and no triangle names are drawn as points. It takes shapes that are broken: a point that is not
/// finite is put at the origin and not drawn, and what names it, or a point that is not there, is left out.
///
/// @param path  of the file, which is replaced. Threads that write at once need a name each.
/// @throws FileError where it cannot be written.
void debug_dump(const std::string& path, std::span<const Vec3d> points,
                std::span<const std::array<std::uint32_t, 2>> edges = {},
                std::span<const std::array<std::uint32_t, 3>> triangles = {});

/// The same of a TriangleMesh or a MeshView: its triangles and segments.
template <class Mesh>
  requires requires(const Mesh& mesh) {
    mesh.vertices;
    mesh.segments;
    mesh.triangles;
  }
void debug_dump(const std::string& path, const Mesh& mesh) {
  debug_dump(path, mesh.vertices, mesh.segments, mesh.triangles);
}

/// The same of a Complex, without its columns.
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
