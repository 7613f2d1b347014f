// Blum: axes whose edges are contracted while they are put together. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "blum/axis/shrinking_complex.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum {

/// Contracts edges of lists where that keeps the homotopy type and edges in the solid.
class ShrinkingLists {
 public:
  /// Vertices of seams and curves rank from here on, those of rims from 1 to there.
  static constexpr int on_seam = 1024;
  /// Those where one seam or curve ends rank from this many times that on.
  static constexpr int end_of_seam = 9;

  /// @param lists      is to be left as it is until write().
  /// @param incidence  of the lists; outlives this.
  /// @param reach      changed() tells of contractions this many edges away.
  ShrinkingLists(AxisLists& lists, const Incidence& incidence, const Surface& surface, int reach);

  [[nodiscard]] const ShrinkingComplex& cells() const { return cells_; }
  /// Of the lists at first.
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  [[nodiscard]] const Vec3d& position(std::uint32_t v) const { return lists_.vertices[v].position; }
  /// The separation angle at a vertex, 0 where that knows of one wall only.
  [[nodiscard]] double angle(std::uint32_t v) const { return lists_.vertices[v].separation_angle; }
  [[nodiscard]] double radius(std::uint32_t v) const { return lists_.vertices[v].radius; }
  [[nodiscard]] int rank(std::uint32_t v) const { return rank_[v]; }
  /// The vertex that another one was contracted to, or itself.
  [[nodiscard]] std::uint32_t now(std::uint32_t v) const;

  /// Whether the edge between two vertices may be contracted to the second one. Any number of threads may look while
  /// nothing is contracted.
  [[nodiscard]] bool may_contract(std::uint32_t from, std::uint32_t to, LinkScratch& scratch) const;
  void contract(std::uint32_t from, std::uint32_t to);

  /// 1, and one more for each contraction.
  [[nodiscard]] std::uint32_t contractions() const { return contractions_; }
  /// contractions() after the last one within reach of a vertex; 0 for none.
  [[nodiscard]] std::uint32_t changed(std::uint32_t v) const { return changed_[v]; }

  /// Puts what is left into the lists.
  void write();

 private:
  /// Whether edges stay in the solid, and nothing of the surface is passed over.
  [[nodiscard]] bool stays_in_solid(std::uint32_t from, std::uint32_t to) const;
  /// Prepared for questions about what is around a vertex that goes.
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
  std::vector<std::uint32_t> noted_;  ///< of note_change_at(), kept so that no new memory is needed each time
};

}  // namespace blum
