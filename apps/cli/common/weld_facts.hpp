// Blum: what welding does to a mesh beyond joining equal vertices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "blum/geometry/triangle_mesh.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// A surface, as its triangles tell.
struct SurfaceFacts {
  std::size_t components = 0;     ///< sets of triangles connected through edges
  std::int64_t euler_number = 0;  ///< vertices - edges + triangles
  friend bool operator==(const SurfaceFacts&, const SurfaceFacts&) = default;
};
[[nodiscard]] SurfaceFacts surface_facts(const MeshView& mesh);

/// A mesh that was welded within a tolerance, beside the same mesh where only equal vertices were joined.
struct WeldFacts {
  double tolerance = 0;      ///< mesh units
  std::size_t vertices = 0;  ///< with equal ones joined
  std::size_t lost = 0;      ///< of these
  SurfaceFacts before, after;
};
/// @param exact  where equal vertices alone were joined.
[[nodiscard]] WeldFacts weld_facts(const MeshView& exact, double tolerance, const MeshView& welded);

/// In one sentence.
[[nodiscard]] std::string weld_text(const WeldFacts& facts);
[[nodiscard]] Json weld_json(const WeldFacts& facts);

}  // namespace blum::cli
