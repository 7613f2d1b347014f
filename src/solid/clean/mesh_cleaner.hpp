// Blum: takes needless vertices of a closed surface out, one by one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "solid/clean/collapse_search.hpp"
#include "solid/clean/shrinking_surface.hpp"
#include "solid/clean/step_check.hpp"

namespace blum::detail {

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
