// Blum: the meshes and grids of the benchmarks. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "blum/field/reference.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::bench {

struct Shape {
  TriangleMesh mesh;
  std::string note;  ///< its source and number of triangles
  /// Brute force over the mesh, for spot checks. Built at the first call.
  const reference::BruteForce& brute_force() const;

 private:
  mutable std::unique_ptr<reference::BruteForce> brute_force_;
};

/// A shape by name, read or generated at the first call and kept:
///
/// - `bunny`, `fandisk`, `rocker-arm`: real shapes if the data folder (BLUM_DATA_DIR) has them, else generated ones.
/// - `ballcube`, `eight`: likewise. They are closed, with 10,884 and 634 triangles, and of about unit size.
/// - `organic`: closed, 69,620 triangles. `organic-N`: closed, about N triangles.
/// - `noisy-1.6M`: a closed organic shape, subdivided twice. Each vertex is moved by up to 5 % of an edge.
const Shape& shape(const std::string& name);

/// The grid for comparisons of fields: a centred cube with side 1.2 times the longest extent, n^3 nodes.
GridSpec cube_grid(const MeshView& mesh, int n);

}  // namespace blum::bench
