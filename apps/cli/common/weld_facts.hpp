// Blum: effects of welding a mesh within a tolerance. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "blum/geometry/triangle_mesh.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Counts of a surface of triangles.
struct SurfaceFacts {
  std::size_t components = 0;     ///< sets of triangles connected through edges
  std::int64_t euler_number = 0;  ///< vertices - edges + triangles
  friend bool operator==(const SurfaceFacts&, const SurfaceFacts&) = default;
};
[[nodiscard]] SurfaceFacts surface_facts(const MeshView& mesh);

/// Effects of a weld tolerance. The mesh welded within the tolerance is compared with the same mesh in which only
/// vertices at equal positions are welded.
struct WeldFacts {
  double tolerance = 0;      ///< mesh units
  std::size_t vertices = 0;  ///< number of vertices after welding equal positions
  std::size_t lost = 0;      ///< number of further vertices that the tolerance removed
  SurfaceFacts before, after;
};
/// @param exact  the mesh in which only vertices at equal positions are welded.
[[nodiscard]] WeldFacts weld_facts(const MeshView& exact, double tolerance, const MeshView& welded);

/// Returns the facts as one sentence.
[[nodiscard]] std::string weld_text(const WeldFacts& facts);
[[nodiscard]] Json weld_json(const WeldFacts& facts);

}  // namespace blum::cli
