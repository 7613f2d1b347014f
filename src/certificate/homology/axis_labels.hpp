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

/// The curtains that each edge of an axis crosses, on its way inside of the solid: pushed edges run over the points
/// that they were pushed over, and edges that touch a path are led past it, inside. Vertices nearer to the surface than
/// positions are exact begin a little way along the edge to their deepest neighbour, or further inside.
class AxisLabels {
 public:
  /// Everything given must stay. @param is_wanted  whether edges of a body have labels.
  /// @throws Cancelled.
  AxisLabels(const AxisInSolid& given, const Complement& complement, const std::vector<bool>& is_wanted,
             const Context& context);

  [[nodiscard]] std::span<const Label> of(std::uint32_t edge) const {
    const auto other = replaced_.find(edge);
    return other == replaced_.end() ? edges_->of(edge) : std::span<const Label>(other->second);
  }
  /// The edges of which it cannot be told, rising: they touch the surface, and could not be led past it.
  [[nodiscard]] const std::set<std::uint32_t>& doubtful() const { return doubtful_; }
  [[nodiscard]] bool is_doubtful(std::uint32_t edge) const { return doubtful_.contains(edge); }

  /// The triangles whose borders are linked with a path, rising. Before one counts, its edges are looked at as closely
  /// as doubles allow: one that cuts a corner by less than what is allowed runs past it.
  [[nodiscard]] std::vector<std::uint32_t> triangles_across(const Context& context);

  /// Looks as closely at edges that leave the solid by no more than the tolerance: the way beside them that is inside
  /// may pass a path on the other side.
  void look_at_grazing(const Context& context);

  /// Looks as closely at edges with an end that is less deep than edges may cut corners, those of curves first: in thin
  /// parts they may run past a path that lies within that. @return  whether that makes a difference.
  bool look_at_thin_parts(const Context& context);

  /// Adds to the times that each path is linked with, for an edge passed once (or `sign` -1: backwards).
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
  /// Leads doubtful edges past what they touch.
  void lead_past_surface();
  /// An edge from end to end, by way of what it was pushed over.
  [[nodiscard]] Way way_of(std::uint32_t edge) const;
  [[nodiscard]] bool is_across(std::size_t triangle, SparseRow& row) const;
  /// An edge that was pushed may go either way round what it cut. Leads those of triangles that are across over the
  /// other two sides, where that leaves fewer across; and takes those that are not any more from the list. Each step
  /// leaves fewer, so that it ends.
  void lead_over_triangles(std::vector<std::uint32_t>& across, const Context& context);
  /// The labels of a way over two sides of a triangle, from the first end of the third one to the second.
  [[nodiscard]] std::vector<Label> over_other_sides(std::uint32_t triangle, std::size_t side) const;
  /// What is found where it is looked as closely at an edge as doubles allow.
  struct CloserLook {
    Way way{};  ///< inside, beside the edge; empty if there is none, or the edge is inside
    std::size_t looks = 0;
  };
  [[nodiscard]] CloserLook closer_look(std::uint32_t edge) const;
  /// Leads an edge over what was found; false if that makes no difference.
  bool take(std::uint32_t edge, const CloserLook& look);
  /// Looks closely at edges, by all threads; false if that makes no difference.
  bool look_closely(std::span<const std::uint32_t> edges, const Context& context);

  const AxisInSolid& given_;
  const Complement& complement_;
  const std::vector<bool>& is_wanted_;
  std::vector<double> allowed_;  ///< in each body
  std::vector<Vec3d> positions_;
  Box3 box_;
  std::unique_ptr<Apex> apex_;
  std::unique_ptr<Curtains> curtains_;
  std::unique_ptr<EdgeLabels> edges_;
  std::unordered_map<std::uint32_t, std::vector<Label>> replaced_;
  std::set<std::uint32_t> doubtful_;
  std::size_t looks_left_ = 1'000'000;  ///< for edges in thin parts: some 10 s at most
};

}  // namespace blum::verifier
