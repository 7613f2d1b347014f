// Blum: whether new triangles of a surface keep clear of all others, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "solid/clean/shrinking_surface.hpp"

namespace blum::detail {

/// A binary tree over boxes in an order that keeps neighbours together. Boxes may be replaced: those above follow.
/// Cost of a change and of a question about a small place: the logarithm of their number.
class TriangleBoxes {
 public:
  /// @param boxes  an empty one for what is not there, and will not be. @throws Cancelled.
  TriangleBoxes(std::span<const Box3> boxes, const Context& context);

  void replace(std::uint32_t index, const Box3& box);

  /// Calls visit(index) for the boxes that touch a box, until it returns false. @return whether it never did.
  template <class Visit>
  bool for_each_touching(const Box3& box, const Visit& visit) const {
    std::size_t stack[most_depth];
    std::size_t size = 0;
    stack[size++] = 1;
    while (size > 0) {
      const std::size_t node = stack[--size];
      if (!touch(nodes_[node], box)) continue;
      if (node >= leaves_) {
        if (!visit(at_leaf_[node - leaves_])) return false;
        continue;
      }
      stack[size++] = 2 * node + 1;
      stack[size++] = 2 * node;
    }
    return true;
  }

 private:
  static constexpr std::size_t most_depth = 64;

  static bool touch(const Box3& a, const Box3& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
  }

  std::size_t leaves_ = 1;   ///< a power of two; node k has the children 2 k and 2 k + 1, leaves come last
  std::vector<Box3> nodes_;  ///< the first one is not used
  std::vector<std::uint32_t> at_leaf_;
  std::vector<std::uint32_t> leaf_of_;
};

/// An edge at the border of what changes: a triangle there gets another apex, and that on the other side stays.
struct BorderEdge {
  std::uint32_t a = 0, b = 0;
  std::uint32_t old_apex = 0, new_apex = 0;
  std::uint32_t outer_apex = 0;
};

/// A change of a surface: triangles that go, those that come, and tetrahedra between both: the volume that the surface
/// sweeps is in these.
struct SurfaceStep {
  std::vector<std::uint32_t> old_triangles;
  std::vector<Triangle> new_triangles;
  std::vector<std::array<std::uint32_t, 4>> swept;
  std::vector<BorderEdge> border;
};

class StepCheck {
 public:
  /// @param mesh  must stay, and say what changes. @throws Cancelled.
  StepCheck(const ShrinkingSurface& mesh, const Context& context);

  /// Whether the new triangles have areas, neither cross nor touch each other or those that stay, beside the corners
  /// and edges that they share, and neither another shell nor what is next to them lies between old and new ones, so
  /// that inside and outside stay what they are. Exact.
  [[nodiscard]] bool passes(const SurfaceStep& step);

  /// Triangles of the mesh have changed, or gone.
  void update(std::span<const std::uint32_t> triangles);

 private:
  [[nodiscard]] Box3 box_of(std::uint32_t t) const;
  [[nodiscard]] bool is_clear(const Triangle& triangle) const;
  [[nodiscard]] bool turns_over_a_neighbour(const BorderEdge& edge) const;
  [[nodiscard]] bool jumps_over_a_shell(const SurfaceStep& step) const;

  const ShrinkingSurface& mesh_;
  Context context_;
  TriangleBoxes boxes_;
  std::size_t triangles_at_build_;
  std::vector<std::uint32_t> shell_of_;  ///< of each vertex; empty where there is but one
  std::vector<std::uint32_t> mark_;      ///< of triangles that go
  std::uint32_t current_ = 0;
};

}  // namespace blum::detail
