// Blum: removes needless vertices of a closed surface, one by one. SPDX-License-Identifier: Apache-2.0
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

/// Binary tree over boxes, in an order that keeps neighbours together. replace() changes a box and updates the boxes
/// above it. Cost of a change or of a query with a small box: the logarithm of the number of boxes.
class TriangleBoxes {
 public:
  /// @param boxes  an empty box stands for an element that does not exist, and cannot be replaced later.
  /// @throws Cancelled.
  TriangleBoxes(std::span<const Box3> boxes, const Context& context);

  void replace(std::uint32_t index, const Box3& box);

  /// Calls visit(index) for each box of the tree that touches the given box, until visit() returns false.
  /// @return  true if visit() never returned false.
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

  std::size_t leaves_ = 1;   ///< a power of two; node k has the children 2 k and 2 k + 1; leaves come last
  std::vector<Box3> nodes_;  ///< entry 0 is unused
  std::vector<std::uint32_t> at_leaf_;
  std::vector<std::uint32_t> leaf_of_;
};

/// An edge at the border of the changed triangles. The inner triangle at the edge gets another apex; the outer triangle
/// stays the same.
struct BorderEdge {
  std::uint32_t a = 0, b = 0;
  std::uint32_t old_apex = 0, new_apex = 0;
  std::uint32_t outer_apex = 0;
};

/// A change of a surface: removed triangles, new triangles, and tetrahedra that contain the volume between them.
struct SurfaceStep {
  std::vector<std::uint32_t> old_triangles;
  std::vector<Triangle> new_triangles;
  std::vector<std::array<std::uint32_t, 4>> swept;
  std::vector<BorderEdge> border;
};

class StepCheck {
 public:
  /// @param mesh  must outlive this object. Its changes must be reported to update().
  /// @throws Cancelled.
  StepCheck(const ShrinkingSurface& mesh, const Context& context);

  /// Returns true if the solid keeps its topology in a step. The test is exact. New triangles must have areas. New
  /// triangles must not cross or touch each other or the remaining triangles, except at common corners and edges. No
  /// other shell and no neighbouring triangle may lie between old and new triangles.
  [[nodiscard]] bool passes(const SurfaceStep& step);

  /// Updates the tree after the given triangles of the mesh changed or were removed.
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
  std::vector<std::uint32_t> shell_of_;  ///< for each vertex; empty if only one shell exists
  std::vector<std::uint32_t> mark_;      ///< for each triangle: `current_` if the current step removes it
  std::uint32_t current_ = 0;
};

/// Returns an upper bound on the Hausdorff distance of two fans of triangles over the same polygon, including rounding.
/// One fan joins `apex` to the sides of the polygon, the other fan joins the first corner to these sides. Returns
/// infinity if it is not certain that both fans are graphs of functions over the same plane. Method:
/// docs/theory/solid.md. Cost: quadratic in the number of corners if it is at most 40; otherwise linear.
///
/// @param ring    two or more corners of the polygon in order, relative to a nearby point.
/// @param closed  true if the apex lies inside the polygon. Otherwise it lies on the side from the last corner to the
///                first.
/// @param enough  the quick bound is returned if it is at most this.
[[nodiscard]] double fan_gap(std::span<const Vec3d> ring, const Vec3d& apex, bool closed, double enough);

/// Step that removes a vertex by moving it onto a neighbour.
struct VertexCollapse {
  double cost = 0;       ///< collapses of lower cost are tried first
  double deviation = 0;  ///< bound on the distances between the new triangles and the input mesh, in both directions
  std::uint32_t target = 0;
  std::size_t onto = 0;  ///< the target's index in the ring
};

/// Step that removes a flat triangle by a flip of its longest side.
struct EdgeFlip {
  EdgePair edge;
  double cost = 0;
  double deviation = 0;
  bool is_possible = false;
};

class CollapseSearch {
 public:
  /// @param deviations  for each triangle: bound on the distances between it and the input mesh, in both directions.
  CollapseSearch(const ShrinkingSurface& mesh, std::span<const double> deviations, double tolerance)
      : mesh_(mesh), deviations_(deviations), tolerance_(tolerance) {}

  /// Returns the collapses of a vertex that keep the deviation within the tolerance and the shapes acceptable.
  /// Collapses are in ascending order of cost, then target. Checks neither the link condition nor contacts of
  /// triangles. The list and star() are valid until the next call.
  [[nodiscard]] std::span<const VertexCollapse> find(std::uint32_t v);
  [[nodiscard]] const Star& star() const { return star_; }

  /// Returns the flip of a triangle's longest side. The flip is possible under the conditions of find().
  [[nodiscard]] EdgeFlip find_flip(std::uint32_t t) const;

 private:
  /// Data of a triangle at the vertex before the collapse.
  struct Side {
    Vec3d normal;
    double height = 0;
    bool is_needle = false;
  };
  struct Shape {
    bool is_allowed = false;
    double quality = 0;  ///< quality of the worst new triangle; 1 for an equilateral triangle
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
  std::vector<Vec3d> rotated_;  ///< the ring, starting at a target
  std::vector<Side> sides_;
  std::vector<std::size_t> targets_;
  std::vector<VertexCollapse> found_;
  double deviation_ = 0;     ///< largest deviation of the star's triangles
  double least_height_ = 0;  ///< smallest height of the star's triangles
};

class MeshCleaner {
 public:
  /// @param mesh  the boundary of a solid, without crossings. Its vertices must stay valid and unchanged.
  /// @throws Cancelled.
  MeshCleaner(const MeshView& mesh, double tolerance, const Context& context);

  /// Performs all possible collapses and flips.
  /// @throws Cancelled.
  void run();

  [[nodiscard]] const ShrinkingSurface& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t collapses() const { return collapses_; }
  [[nodiscard]] std::size_t flips() const { return flips_; }
  /// Returns an upper bound on the Hausdorff distance between the current mesh and the given mesh.
  [[nodiscard]] double deviation() const;

 private:
  enum class Kind : std::uint8_t { collapse, flip };
  /// A queued step: a vertex that may be removed, or a triangle whose longest side may be flipped.
  struct Waiting {
    double cost = 0;  ///< lower bound if the step was not evaluated since its surroundings changed
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
  std::vector<double> deviations_;  ///< for each triangle; see CollapseSearch
  std::vector<double> heights_;     ///< for each triangle
  CollapseSearch search_;
  std::vector<std::uint32_t> vertex_versions_;
  std::vector<std::uint32_t> triangle_versions_;
  std::vector<std::uint32_t> changes_;  ///< of vertices with many triangles, since they were queued
  Line line_;
  SurfaceStep step_;
  std::size_t looks_ = 0;
  double shown_ = 0;
  std::size_t collapses_ = 0;
  std::size_t flips_ = 0;
};

}  // namespace blum::detail
