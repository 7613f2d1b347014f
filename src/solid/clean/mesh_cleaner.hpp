// Blum: takes needless vertices of a closed surface out, one by one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <queue>
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

/// A bound on the Hausdorff distance of two fans of triangles over one polygon, rounding included: one from `apex` to
/// the sides of the polygon, one from its first corner. Infinity where no bound is known, as the fans do not both lie
/// like graphs of functions over one plane, or not clearly.
///
/// @param ring    corners of the polygon in order, two or more, relative to a point near by.
/// @param closed  whether the apex lies inside of the polygon; else on its side from the last corner to the first.
/// @param enough  where a quick bound is at most this, it is good enough.
/// Method: docs/theory/solid.md. Cost: the square of the number of corners, for up to 40; else their number.
[[nodiscard]] double fan_gap(std::span<const Vec3d> ring, const Vec3d& apex, bool closed, double enough);

/// A way for a vertex to go.
struct VertexCollapse {
  double cost = 0;       ///< of two the one with the lower one is taken
  double deviation = 0;  ///< bound on how far the new triangles are from the mesh at first, and it from them
  std::uint32_t target = 0;
  std::size_t onto = 0;  ///< the target's place in the ring
};

/// A way for a flat triangle to go: turning its longest side.
struct EdgeFlip {
  EdgePair edge;
  double cost = 0;
  double deviation = 0;
  bool is_possible = false;
};

class CollapseSearch {
 public:
  /// @param deviations  of each triangle: how far it is from the mesh at first, at most, and that from it.
  CollapseSearch(const ShrinkingSurface& mesh, std::span<const double> deviations, double tolerance)
      : mesh_(mesh), deviations_(deviations), tolerance_(tolerance) {}

  /// The ways that keep the bounds within the tolerance and make no worse triangles, by rising cost, then target.
  /// Neither the link condition nor contacts are looked at. The list and the star last until the next call.
  [[nodiscard]] std::span<const VertexCollapse> find(std::uint32_t v);
  [[nodiscard]] const Star& star() const { return star_; }

  /// The same of turning the longest side of a triangle.
  [[nodiscard]] EdgeFlip find_flip(std::uint32_t t) const;

 private:
  /// What there is to know of a triangle at the vertex before it goes.
  struct Side {
    Vec3d normal;
    double height = 0;
    bool is_needle = false;
  };
  struct Shape {
    bool is_allowed = false;
    double quality = 0;  ///< 1 where all triangles are equilateral
  };

  [[nodiscard]] bool is_needle(const Vec3d& a, const Vec3d& b, const Vec3d& c) const;
  void look_at_star(std::uint32_t v);
  void choose_targets();
  [[nodiscard]] double bound(std::size_t onto, double budget);
  [[nodiscard]] double bound_along_crease(double limit) const;
  [[nodiscard]] Shape shape(std::uint32_t v, std::size_t onto) const;
  [[nodiscard]] bool folds(std::uint32_t v, std::size_t side, const Vec3d& normal) const;

  const ShrinkingSurface& mesh_;
  std::span<const double> deviations_;
  double tolerance_;
  Star star_;
  std::vector<Vec3d> around_;   ///< the ring, relative to the vertex
  std::vector<Vec3d> rotated_;  ///< the same from a target on
  std::vector<Side> sides_;
  std::vector<std::size_t> targets_;
  std::vector<VertexCollapse> found_;
  double deviation_ = 0;     ///< the largest one of the star's triangles
  double least_height_ = 0;  ///< of these
};

class MeshCleaner {
 public:
  /// @param mesh  the boundary of a solid, without crossings; its vertices must stay. @throws Cancelled.
  MeshCleaner(const MeshView& mesh, double tolerance, const Context& context);

  /// @throws Cancelled.
  void run();

  [[nodiscard]] const ShrinkingSurface& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t collapses() const { return collapses_; }
  [[nodiscard]] std::size_t flips() const { return flips_; }
  /// A bound on the Hausdorff distance between the mesh as it is and as it was given.
  [[nodiscard]] double deviation() const;

 private:
  enum class Kind : std::uint8_t { collapse, flip };
  /// What waits: a vertex that may go or a triangle whose longest side may be turned.
  struct Waiting {
    double cost = 0;  ///< at least, where it was not looked at since its surroundings changed
    Kind kind = Kind::collapse;
    std::uint32_t index = 0;
    std::uint32_t version = 0;

    [[nodiscard]] friend auto operator<=>(const Waiting&, const Waiting&) = default;
  };
  using Line = std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>>;

  void fill_line();
  void report_progress();
  void handle(const Waiting& first);
  void try_vertex(std::uint32_t v);
  void try_triangle(std::uint32_t t);
  [[nodiscard]] bool comes_later(double cost, Kind kind, std::uint32_t index) const;
  [[nodiscard]] bool passes(std::uint32_t v, const Star& star, const VertexCollapse& way);
  void collapse(std::uint32_t v, const VertexCollapse& way);
  void flip(const EdgeFlip& way);
  void refresh(std::span<const std::uint32_t> changed, std::span<const std::uint32_t> corners);
  [[nodiscard]] bool has_many_triangles(std::uint32_t v) const;
  void offer_changed(std::uint32_t v);
  bool offer_postponed();
  void offer_vertex(std::uint32_t v);
  void offer_triangle(std::uint32_t t);

  ShrinkingSurface mesh_;
  double tolerance_;
  Context context_;
  StepCheck check_;
  std::vector<double> deviations_;  ///< of each triangle: see CollapseSearch
  std::vector<double> heights_;     ///< of each triangle
  CollapseSearch search_;
  std::vector<std::uint32_t> vertex_versions_;
  std::vector<std::uint32_t> triangle_versions_;
  std::vector<std::uint32_t> changes_;  ///< of vertices with many triangles, since they were offered
  Line line_;
  SurfaceStep step_;
  std::size_t looks_ = 0;
  double shown_ = 0;
  std::size_t collapses_ = 0;
  std::size_t flips_ = 0;
};

}  // namespace blum::detail
