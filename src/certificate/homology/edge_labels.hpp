// Blum: which curtains the edges of an axis cross, for the verifier. SPDX-License-Identifier: Apache-2.0
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

/// A point far outside of a solid. From it every segment hangs a curtain: the triangle that it makes with the point.
/// The curtains of a closed path are a surface that the path bounds, so that crossings with it count linking.
class Apex {
 public:
  /// @param box  of all that is looked at.  @param attempt  which of a fixed sequence of directions.
  Apex(const Box3& box, std::uint32_t attempt);

  /// Where a point is seen, and how far away: boxes of these around the ends of two segments must meet for one to cross
  /// the curtain of the other one, but for rounding.
  [[nodiscard]] Vec3d seen(const Vec3d& p) const;
  /// How far boxes may be off by rounding.
  [[nodiscard]] double rounding() const { return 1e-9 * size_; }

  /// How often the way from a to b crosses the curtain of the segment from u to v: 1 or -1 by the side that it comes
  /// from, or 0; nullopt where it meets the border of the curtain, or runs in its plane.
  [[nodiscard]] std::optional<int> crossing(const Vec3d& u, const Vec3d& v, const Vec3d& a, const Vec3d& b) const;

  /// The same for the way from a point to the apex, and the triangle a, b, c.
  [[nodiscard]] std::optional<int> crossing_above(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) const;

 private:
  Vec3d apex_;
  Vec3d along_, across_, up_;
  double size_ = 1;
};

/// How often something crosses the curtain of a segment of a Complement.
struct Label {
  std::uint32_t segment = 0;
  std::int32_t times = 0;
};

/// Way points from one end of an edge to the other one, both included.
using Way = std::vector<Vec3d>;

/// The curtains of all segments of a complement.
class Curtains {
 public:
  /// Both must stay. @throws Cancelled.
  Curtains(const Complement& complement, const Apex& apex, const Context& context);

  /// Adds the crossings of a way with the curtains of a body's segments; false where one cannot be told.
  [[nodiscard]] bool add(std::span<const Vec3d> way, std::uint32_t body, std::vector<Label>& labels) const;

  /// A segment of a body of which it cannot be told whether the way from a to b crosses its curtain.
  [[nodiscard]] std::optional<Segment3> first_touched(const Vec3d& a, const Vec3d& b, std::uint32_t body) const;

  /// Places in the tree of what a box may cross.
  void near(const Box3& seen, std::vector<std::uint32_t>& places) const;
  /// The same as add() for one segment between points that are seen in a box, and these curtains only.
  [[nodiscard]] bool add(const Vec3d& a, const Vec3d& b, const Box3& seen, std::uint32_t body,
                         std::span<const std::uint32_t> places, std::vector<Label>& labels) const;
  [[nodiscard]] const Apex& apex() const { return apex_; }

 private:
  const Complement& complement_;
  const Apex& apex_;
  BoxHierarchy tree_;
  std::vector<Box3> boxes_;  ///< in the tree's order: from the apex to the segment, as seen
};

/// The labels of the edges of an axis.
class EdgeLabels {
 public:
  /// @param positions  of the vertices.  @param body_of  of each vertex.  @throws Cancelled.
  EdgeLabels(const Curtains& curtains, std::span<const std::array<std::uint32_t, 2>> edges,
             const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& body_of, const Context& context);

  [[nodiscard]] std::span<const Label> of(std::size_t edge) const {
    const Part& part = parts_[edge / grain];
    const std::size_t k = edge % grain;
    if (part.ends.empty()) return {};
    const std::size_t begin = k == 0 ? 0 : part.ends[k - 1];
    return std::span(part.labels).subspan(begin, part.ends[k] - begin);
  }
  /// Edges of which a crossing cannot be told, rising.
  [[nodiscard]] const std::vector<std::uint32_t>& doubtful() const { return doubtful_; }

 private:
  static constexpr std::size_t grain = 64;
  /// Some edges beside each other.
  struct Part {
    std::vector<std::uint32_t> ends;  ///< of the labels of each edge; empty where there are none
    std::vector<Label> labels;
    std::vector<std::uint32_t> doubtful;
  };
  std::vector<Part> parts_;
  std::vector<std::uint32_t> doubtful_;
};

}  // namespace blum::verifier
