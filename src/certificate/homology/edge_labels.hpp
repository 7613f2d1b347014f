// Blum: the curtains that the edges of an axis cross, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/box_hierarchy.hpp"
#include "certificate/homology/complement.hpp"
#include "certificate/segments.hpp"

namespace blum::verifier {

/// A point far outside a solid. The curtain of a segment is the triangle that it forms with this point. The curtains of
/// a closed path together form a surface that the path bounds. So crossings with this surface give linking numbers.
class Apex {
 public:
  /// @param box      the box around all points that are tested.
  /// @param attempt  index in a fixed sequence of directions.
  Apex(const Box3& box, std::uint32_t attempt);

  /// Returns the projection of a point as seen from the apex, in two coordinates, and its distance along the line of
  /// sight. If a segment crosses a curtain, the box of its projected ends meets the box of the projected curtain, up to
  /// rounding.
  [[nodiscard]] Vec3d seen(const Vec3d& p) const;
  /// Returns a bound on the rounding errors of such boxes.
  [[nodiscard]] double rounding() const { return 1e-9 * size_; }

  /// Returns how often the segment from a to b crosses the curtain of the segment from u to v. The result is 1 or -1,
  /// depending on the side from which the segment comes, or 0. Returns nullopt if the segment meets the border of the
  /// curtain, or lies in its plane.
  [[nodiscard]] std::optional<int> crossing(const Vec3d& u, const Vec3d& v, const Vec3d& a, const Vec3d& b) const;

  /// Returns how often the segment from p to the apex crosses the triangle a, b, c.
  [[nodiscard]] std::optional<int> crossing_above(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) const;

 private:
  Vec3d apex_;
  Vec3d along_, across_, up_;
  double size_ = 1;
};

/// How often an edge crosses the curtain of a segment of a Complement.
struct Label {
  std::uint32_t segment = 0;
  std::int32_t times = 0;
};

/// Points of a polyline from one end of an edge to the other, both included.
using Way = std::vector<Vec3d>;

/// The curtains of all segments of a complement.
class Curtains {
 public:
  /// Both arguments must outlive this object.
  /// @throws Cancelled.
  Curtains(const Complement& complement, const Apex& apex, const Context& context);

  /// Adds to `labels` the crossings of a way with the curtains of a body's segments. Returns false if a crossing is
  /// undecided.
  [[nodiscard]] bool add(std::span<const Vec3d> way, std::uint32_t body, std::vector<Label>& labels) const;

  /// Returns a segment of a body whose curtain the line segment from a to b may touch, so that the crossing is
  /// undecided. Returns nullopt if there is none.
  [[nodiscard]] std::optional<Segment3> first_touched(const Vec3d& a, const Vec3d& b, std::uint32_t body) const;

  /// Finds the curtains that may meet a box, as indices in the tree's order.
  void near(const Box3& seen, std::vector<std::uint32_t>& places) const;
  /// Adds the crossings of the segment from a to b with the curtains `places` only. `seen` is the box of both projected
  /// ends.
  [[nodiscard]] bool add(const Vec3d& a, const Vec3d& b, const Box3& seen, std::uint32_t body,
                         std::span<const std::uint32_t> places, std::vector<Label>& labels) const;
  [[nodiscard]] const Apex& apex() const { return apex_; }

 private:
  const Complement& complement_;
  const Apex& apex_;
  BoxHierarchy tree_;
  std::vector<Box3> boxes_;  ///< in the tree's order: boxes of projected curtains
};

/// The labels of the edges of an axis.
class EdgeLabels {
 public:
  /// @param positions  positions of the vertices.
  /// @param body_of    for each vertex.
  /// @throws Cancelled.
  EdgeLabels(const Curtains& curtains, std::span<const std::array<std::uint32_t, 2>> edges,
             const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& body_of, const Context& context);

  [[nodiscard]] std::span<const Label> of(std::size_t edge) const {
    const Part& part = parts_[edge / grain];
    const std::size_t k = edge % grain;
    if (part.ends.empty()) return {};
    const std::size_t begin = k == 0 ? 0 : part.ends[k - 1];
    return std::span(part.labels).subspan(begin, part.ends[k] - begin);
  }
  /// Returns the edges with an undecided crossing, in ascending order.
  [[nodiscard]] const std::vector<std::uint32_t>& doubtful() const { return doubtful_; }

 private:
  static constexpr std::size_t grain = 64;
  /// Data of consecutive edges.
  struct Part {
    std::vector<std::uint32_t> ends;  ///< for each edge: end of its labels; empty if no edge has any
    std::vector<Label> labels;
    std::vector<std::uint32_t> doubtful;
  };
  std::vector<Part> parts_;
  std::vector<std::uint32_t> doubtful_;
};

}  // namespace blum::verifier
