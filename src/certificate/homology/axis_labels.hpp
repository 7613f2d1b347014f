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

/// For each edge of an axis: the curtains that it crosses on a path inside the solid. The path of a pushed edge leads
/// through the points to which it was pushed. An edge that touches a path is led past the path, inside the solid. A
/// vertex that is closer to the surface than a fraction of the tolerance is moved: a little towards its deepest
/// neighbour, or further inside.
class AxisLabels {
 public:
  /// All arguments must outlive this object.
  /// @param is_wanted  for each body: true if its edges need labels.
  /// @throws Cancelled.
  AxisLabels(const AxisInSolid& given, const Complement& complement, const std::vector<bool>& is_wanted,
             const Context& context);

  [[nodiscard]] std::span<const Label> of(std::uint32_t edge) const {
    const auto other = replaced_.find(edge);
    return other == replaced_.end() ? edges_->of(edge) : std::span<const Label>(other->second);
  }
  /// Returns the undecided edges, in ascending order. They touch the surface, and no way past it was found.
  [[nodiscard]] const std::set<std::uint32_t>& doubtful() const { return doubtful_; }
  [[nodiscard]] bool is_doubtful(std::uint32_t edge) const { return doubtful_.contains(edge); }

  /// Returns the triangles whose borders are linked with a path, in ascending order. Before a triangle is listed, its
  /// edges are tested as closely as doubles allow. If an edge cuts off a corner of the solid by less than the
  /// tolerance, its way is led around the corner.
  [[nodiscard]] std::vector<std::uint32_t> triangles_across(const Context& context);

  /// Tests edges that leave the solid by at most the tolerance as closely as doubles allow. Inside the solid, the way
  /// beside such an edge may pass a path on the other side.
  void look_at_grazing(const Context& context);

  /// Tests edges with an end less deep than the tolerance of edges as closely as doubles allow, edges of curves first.
  /// In thin parts, such edges may pass a path within that tolerance.
  /// @return  true if any label changed.
  bool look_at_thin_parts(const Context& context);

  /// Adds to `row` how often an edge is linked with each path. The edge is traversed once; backwards if `sign` is -1.
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
  /// Returns the way of an edge from its first end to its second, through the points to which it was pushed.
  [[nodiscard]] Way way_of(std::uint32_t edge) const;
  [[nodiscard]] bool is_across(std::size_t triangle, SparseRow& row) const;
  /// Treats triangles that are across, which means linked with a path. An edge of such a triangle is led over the
  /// triangle's other two sides, if fewer triangles are across then. A pushed edge may pass on either side of what it
  /// cut. Triangles that are no longer across are removed from the list. Each step reduces their number, so this ends.
  void lead_over_triangles(std::vector<std::uint32_t>& across, const Context& context);
  /// Returns the labels of a way over two sides of a triangle, from the first end of the third side to its second end.
  [[nodiscard]] std::vector<Label> over_other_sides(std::uint32_t triangle, std::size_t side) const;
  /// Result of testing an edge as closely as doubles allow.
  struct CloserLook {
    Way way{};  ///< a way inside; empty if none was found or the edge is inside
    std::size_t looks = 0;
  };
  [[nodiscard]] CloserLook closer_look(std::uint32_t edge) const;
  /// Returns a way between the same ends, pushed into the body; empty if none was found.
  [[nodiscard]] CloserLook closer_look(const Way& way, std::uint32_t body) const;
  /// If an end of an edge lies on the surface, returns ways from there that follow the edge, or the triangle beside it.
  /// The end may have slid to another side of a corner. Then the straight way may leave the body along much of its
  /// length, or pass the corner on the wrong side.
  [[nodiscard]] std::vector<Way> ways_beside(std::uint32_t edge) const;
  /// Uses the way that was found for an edge. Returns false if nothing changes.
  bool take(std::uint32_t edge, const CloserLook& look);
  /// Tests edges as closely as doubles allow, on all threads. Returns false if nothing changes.
  bool look_closely(std::span<const std::uint32_t> edges, const Context& context);

  const AxisInSolid& given_;
  const Complement& complement_;
  const std::vector<bool>& is_wanted_;
  std::vector<double> allowed_;  ///< tolerance of positions for each body
  std::vector<Vec3d> positions_;
  Box3 box_;
  std::unique_ptr<Apex> apex_;
  std::unique_ptr<Curtains> curtains_;
  std::unique_ptr<EdgeLabels> edges_;
  std::unordered_map<std::uint32_t, std::vector<Label>> replaced_;
  std::set<std::uint32_t> doubtful_;
  std::size_t looks_left_ = 1'000'000;  ///< number of points that may still be examined: about 10 s
};

}  // namespace blum::verifier
