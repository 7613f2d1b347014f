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

/// A point far outside of a solid. The curtain of a segment is the triangle of the segment and this point. The curtains
/// of a closed path form a surface that the path bounds, so crossings with it count linking.
class Apex {
 public:
  /// @param box      of all that is tested.
  /// @param attempt  index in a fixed sequence of directions.
  Apex(const Box3& box, std::uint32_t attempt);

  /// Returns where a point is seen, and how far away. If a segment crosses the curtain of another one, the boxes of
  /// their ends, as seen, meet up to rounding.
  [[nodiscard]] Vec3d seen(const Vec3d& p) const;
  /// Returns how far boxes may be off by rounding.
  [[nodiscard]] double rounding() const { return 1e-9 * size_; }

  /// Returns how often the way from a to b crosses the curtain of the segment from u to v. It is 1 or -1 by the side
  /// that the way comes from, or 0. Returns nullopt if the way meets the border of the curtain, or runs in its plane.
  [[nodiscard]] std::optional<int> crossing(const Vec3d& u, const Vec3d& v, const Vec3d& a, const Vec3d& b) const;

  /// Returns the same for the way from a point to the apex, and the triangle a, b, c.
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

/// Points from one end of an edge to the other one, both included.
using Way = std::vector<Vec3d>;

/// The curtains of all segments of a complement.
class Curtains {
 public:
  /// Both arguments must outlive this object.
  /// @throws Cancelled.
  Curtains(const Complement& complement, const Apex& apex, const Context& context);

  /// Adds the crossings of a way with the curtains of a body's segments. Returns false if one is undecided.
  [[nodiscard]] bool add(std::span<const Vec3d> way, std::uint32_t body, std::vector<Label>& labels) const;

  /// Returns a segment of a body for which it is undecided if the way from a to b crosses its curtain; nullopt if none
  /// exists.
  [[nodiscard]] std::optional<Segment3> first_touched(const Vec3d& a, const Vec3d& b, std::uint32_t body) const;

  /// Finds the places in the tree of the curtains that a box may cross.
  void near(const Box3& seen, std::vector<std::uint32_t>& places) const;
  /// Adds as the other add() does, for one segment between points that are seen in a box, and these curtains only.
  [[nodiscard]] bool add(const Vec3d& a, const Vec3d& b, const Box3& seen, std::uint32_t body,
                         std::span<const std::uint32_t> places, std::vector<Label>& labels) const;
  [[nodiscard]] const Apex& apex() const { return apex_; }

 private:
  const Complement& complement_;
  const Apex& apex_;
  BoxHierarchy tree_;
  std::vector<Box3> boxes_;  ///< in the tree's order; from the apex to the segment, as seen
};

/// The labels of the edges of an axis.
class EdgeLabels {
 public:
  /// @param positions  of the vertices.
  /// @param body_of    of each vertex.
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
  /// Returns the edges with an undecided crossing, in rising order.
  [[nodiscard]] const std::vector<std::uint32_t>& doubtful() const { return doubtful_; }

 private:
  static constexpr std::size_t grain = 64;
  /// Some consecutive edges.
  struct Part {
    std::vector<std::uint32_t> ends;  ///< ends of each edge's labels; empty if there are none
    std::vector<Label> labels;
    std::vector<std::uint32_t> doubtful;
  };
  std::vector<Part> parts_;
  std::vector<std::uint32_t> doubtful_;
};

}  // namespace blum::verifier
