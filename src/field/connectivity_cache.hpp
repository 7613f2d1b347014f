// Blum: detects meshes with the connectivity of the previous mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Copy of a mesh's indices, with which later meshes are compared.
class ConnectivityCache {
 public:
  [[nodiscard]] bool holds(const MeshView& mesh) const;
  void store(const MeshView& mesh);
  void clear() { has_mesh_ = false; }

 private:
  std::vector<Triangle> triangles_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> points_;
  std::size_t vertex_count_ = 0;
  bool has_mesh_ = false;
};

}  // namespace blum
