// Blum: axes whose edges are contracted during their construction. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/axis/shrinking_complex.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/parallel.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum::detail {

/// Contraction of an edge: vertex `from` is moved to vertex `to`.
struct Contraction {
  std::uint32_t from = 0, to = 0;
};

/// Contracts edges of lists if that keeps the homotopy type and keeps edges in the solid.
class ShrinkingLists {
 public:
  /// Least rank of vertices of seams and curves. Vertices of rims that are on no seam or curve have lower ranks, of at
  /// least 1. Inner vertices of sheets have rank 0.
  static constexpr int on_seam = 1024;
  /// Vertices at which one seam or curve ends have a rank of at least this factor times `on_seam`.
  static constexpr int end_of_seam = 9;

  /// @param lists      must not be changed by others until write() is called.
  /// @param incidence  the incidence of the lists; must outlive this object.
  /// @param reach      number of edges: changed() reports contractions at most this far away from a vertex.
  ShrinkingLists(AxisLists& lists, const Incidence& incidence, const Surface& surface, int reach);

  [[nodiscard]] const ShrinkingComplex& cells() const { return cells_; }
  /// Returns the incidence of the lists before any contraction.
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  [[nodiscard]] const Vec3d& position(std::uint32_t v) const { return lists_.vertices[v].position; }
  /// Returns the separation angle at a vertex, degrees; 0 if the vertex has only one footprint.
  [[nodiscard]] double angle(std::uint32_t v) const { return lists_.vertices[v].separation_angle; }
  [[nodiscard]] double radius(std::uint32_t v) const { return lists_.vertices[v].radius; }
  [[nodiscard]] int rank(std::uint32_t v) const { return rank_[v]; }
  /// Returns the vertex to which a vertex was contracted, or the vertex itself if it was not.
  [[nodiscard]] std::uint32_t now(std::uint32_t v) const;

  /// Returns true if the edge between two vertices may be contracted to the second one. Any number of threads may call
  /// this while nothing is contracted.
  [[nodiscard]] bool may_contract(std::uint32_t from, std::uint32_t to, LinkScratch& scratch) const;
  void contract(std::uint32_t from, std::uint32_t to);

  /// Returns the number of contractions so far, plus 1.
  [[nodiscard]] std::uint32_t contractions() const { return contractions_; }
  /// Returns the value that contractions() had after the last contraction within reach of a vertex; 0 if there was
  /// none.
  [[nodiscard]] std::uint32_t changed(std::uint32_t v) const { return changed_[v]; }

  /// Writes the remaining cells to the lists.
  void write();

 private:
  /// Returns true if a move of `from` to `to` keeps edges in the solid, and triangles do not pass over the surface.
  [[nodiscard]] bool stays_in_solid(std::uint32_t from, std::uint32_t to) const;
  /// Returns an object for queries of the solid, prepared for the surroundings of the vertex `from`.
  [[nodiscard]] SolidPaths paths_around(std::uint32_t from, const Stop& target) const;
  void note_change_at(std::uint32_t v);
  [[nodiscard]] bool is_joined(std::uint32_t a, std::uint32_t b) const;

  AxisLists& lists_;
  SolidPaths paths_;
  std::span<const Vec3d> voids_;
  ShrinkingComplex cells_;
  const Incidence& incidence_;
  int reach_;
  std::vector<int> rank_;
  std::vector<std::uint32_t> into_;
  std::vector<std::uint32_t> changed_;
  std::uint32_t contractions_ = 1;
  std::vector<std::uint32_t> noted_;  ///< memory of note_change_at(), kept to avoid allocations
};

/// Step that was chosen for an edge when the edge was examined.
struct ContractionStep {
  bool is_gone = false;                 ///< true if there is no step, because the edge was contracted before
  std::array<std::uint32_t, 2> near{};  ///< two vertices: if nothing changes near them, the step stays valid
  std::optional<Contraction> contraction{};
};

/// Number of edges for which steps are chosen in parallel.
inline constexpr std::size_t edges_in_batch = 1024;

/// Reorders a list. The list is cut into `edges_in_batch` consecutive parts, and each batch of the result consists of
/// one edge of each part. So adjacent edges of the list stay in order, which improves the contractions. Adjacent edges
/// are in different batches, because steps in one batch must not change each other's surroundings.
inline std::vector<std::uint32_t> in_strands(const std::vector<std::uint32_t>& list) {
  const std::size_t batches = (list.size() + edges_in_batch - 1) / edges_in_batch;
  std::vector<std::uint32_t> out;
  out.reserve(list.size());
  for (std::size_t first = 0; first < batches; ++first) {
    for (std::size_t k = first; k < list.size(); k += batches) out.push_back(list[k]);
  }
  return out;
}

/// Makes the steps of `count` edges in their order, as if each step were chosen right before it is made. The steps of
/// `edges_in_batch` edges at a time are chosen in parallel. If the surroundings of an edge change before its step is
/// made, the step is chosen again.
/// @param lists    the lists that the steps change.
/// @param step_of  callable: (k, worker) -> ContractionStep, the step of edge k. Called from many threads; worker is
/// below thread_count().
/// @param make     callable: (k, step) -> void, makes the step of edge k.
/// @throws Cancelled.
template <class StepOf, class Make>
void take_in_batches(const Context& context, std::size_t count, const ShrinkingLists& lists, const StepOf& step_of,
                     const Make& make) {
  constexpr std::size_t grain = 32;
  const std::size_t batch = thread_count(context) > 1 ? edges_in_batch : 1;
  std::vector<ContractionStep> steps(std::min(batch, count));
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t size = std::min(batch, count - first);
    const std::uint32_t before = lists.contractions();
    parallel_for(context, size, grain, {}, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) steps[k] = step_of(first + k, range.worker);
    });
    for (std::size_t k = 0; k < size; ++k) {
      const auto is_changed = [&](std::uint32_t v) { return lists.changed(v) > before; };
      if (!steps[k].is_gone && std::any_of(steps[k].near.begin(), steps[k].near.end(), is_changed)) {
        steps[k] = step_of(first + k, 0);
      }
      make(first + k, steps[k]);
    }
  }
}

}  // namespace blum::detail
