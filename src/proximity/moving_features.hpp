// Blum: the vertices, edges and faces of a mesh that moves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/moving_box_bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// The features of a mesh between two frames. Vertices that are in one place in both are one vertex: of these, the one
/// that the mesh names with the smallest index stands for all.
class MovingFeatures {
 public:
  /// @param mesh  at the start; must stay, as `end` must.
  MovingFeatures(const MeshView& mesh, std::span<const Vec3d> end, const Context& context);

  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// Each once; of the vertices that stand for others, the smaller first.
  [[nodiscard]] const std::vector<Segment>& edges() const { return edges_; }
  [[nodiscard]] std::span<const Triangle> faces() const { return mesh_.triangles; }

  /// The vertex that stands for one.
  [[nodiscard]] std::uint32_t place(std::uint32_t vertex) const { return place_.empty() ? vertex : place_[vertex]; }

  [[nodiscard]] const Vec3d& start(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  [[nodiscard]] const Vec3d& end(std::uint32_t vertex) const { return end_[vertex]; }

  [[nodiscard]] MovingBox box(std::span<const std::uint32_t> vertices) const {
    MovingBox box;
    for (const std::uint32_t v : vertices) {
      box.start.extend(start(v));
      box.end.extend(end(v));
    }
    return box;
  }

 private:
  MeshView mesh_;
  std::span<const Vec3d> end_;
  std::vector<std::uint32_t> place_;  ///< empty where each vertex stands for itself
  std::vector<std::uint32_t> vertices_;
  std::vector<Segment> edges_;
};

}  // namespace blum
