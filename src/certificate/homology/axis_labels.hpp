// Blum: linking of an axis's edges with paths around its solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include "certificate/homology/complement.hpp"
#include "certificate/homology/edge_labels.hpp"
#include "certificate/homology/elimination.hpp"
#include "certificate/homology/homology_check.hpp"

namespace blum::verifier {

/// The curtains that each edge of an axis crosses on its way inside the solid. Pushed edges run over the points through
/// which they were pushed in. Edges that touch a path are led past it, inside. A vertex closer to the surface than a
/// share of the tolerance is moved. It moves a little along the edge to its deepest neighbour, or further inside.
class AxisLabels {
 public:
  /// All arguments must outlive this object.
  /// @param is_wanted  true for bodies whose edges need labels.
  /// @throws Cancelled.
  AxisLabels(const AxisInSolid& given, const Complement& complement, const std::vector<bool>& is_wanted,
             const Context& context);

  [[nodiscard]] std::span<const Label> of(std::uint32_t edge) const {
    const auto other = replaced_.find(edge);
    return other == replaced_.end() ? edges_->of(edge) : std::span<const Label>(other->second);
  }
  /// Returns the undecided edges, in rising order. They touch the surface, and could not be led past it.
  [[nodiscard]] const std::set<std::uint32_t>& doubtful() const { return doubtful_; }
  [[nodiscard]] bool is_doubtful(std::uint32_t edge) const { return doubtful_.contains(edge); }

  /// Returns the triangles whose borders are linked with a path, in rising order. Before one counts, its edges are
  /// tested as closely as doubles allow. An edge that cuts a corner by less than the tolerance is then led around it.
  [[nodiscard]] std::vector<std::uint32_t> triangles_across(const Context& context);

  /// Tests edges that leave the solid by at most the tolerance in the same way. Inside the solid, the way beside such
  /// an edge may pass a path on the other side.
  void look_at_grazing(const Context& context);

  /// Tests edges with an end less deep than the tolerance of edges in the same way, those of curves first. In thin
  /// parts they may run past a path within that tolerance.
  /// @return  true if that makes a difference.
  bool look_at_thin_parts(const Context& context);

  /// Adds how often an edge is linked with each path. It is passed once, or backwards if `sign` is -1.
  void add(std::uint32_t edge, int sign, SparseRow& row) const {
    for (const Label& label : of(edge)) {
      for (const Complement::Use& use : complement_.paths_along(label.segment)) {
        row.emplace_back(use.path, std::int64_t{sign} * label.times * use.times);
      }
    }
  }

 private:
  void slide_from_surface();
  void take_pushed();
  /// Leads doubtful edges past the segments that they touch.
  void lead_past_surface();
  /// Returns the way of an edge from end to end, over the points through which it was pushed.
  [[nodiscard]] Way way_of(std::uint32_t edge) const;
  [[nodiscard]] bool is_across(std::size_t triangle, SparseRow& row) const;
  /// Leads edges of triangles that are across over the other two sides, if fewer triangles are across then. A pushed
  /// edge may pass either side of what it cut. Triangles that are no longer across are removed from the list. Each step
  /// leaves fewer, so it ends.
  void lead_over_triangles(std::vector<std::uint32_t>& across, const Context& context);
  /// Returns the labels of a way over two sides of a triangle, from the first end of the third side to the second.
  [[nodiscard]] std::vector<Label> over_other_sides(std::uint32_t triangle, std::size_t side) const;
  /// Result of testing an edge as closely as doubles allow.
  struct CloserLook {
    Way way{};  ///< inside, beside the edge; empty if none exists, or the edge is inside
    std::size_t looks = 0;
  };
  [[nodiscard]] CloserLook closer_look(std::uint32_t edge) const;
  /// Leads an edge over what was found. Returns false if that makes no difference.
  bool take(std::uint32_t edge, const CloserLook& look);
  /// Tests edges closely, on all threads. Returns false if that makes no difference.
  bool look_closely(std::span<const std::uint32_t> edges, const Context& context);

  const AxisInSolid& given_;
  const Complement& complement_;
  const std::vector<bool>& is_wanted_;
  std::vector<double> allowed_;  ///< tolerance of positions in each body
  std::vector<Vec3d> positions_;
  Box3 box_;
  std::unique_ptr<Apex> apex_;
  std::unique_ptr<Curtains> curtains_;
  std::unique_ptr<EdgeLabels> edges_;
  std::unordered_map<std::uint32_t, std::vector<Label>> replaced_;
  std::set<std::uint32_t> doubtful_;
  std::size_t looks_left_ = 1'000'000;  ///< for edges in thin parts: at most about 10 s
};

}  // namespace blum::verifier
