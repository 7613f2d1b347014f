// Blum: which labels are closest along a line, by the order of events. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::voronoi {

/// The sites that are closest along a segment, one after the other, and where they change.
struct SegmentLabels {
  std::vector<std::uint32_t> sites;  ///< numbers of SiteLabels::site_of(); neighbours differ
  /// Between sites k and k + 1: two points of the segment that the only change lies between, coordinates along it.
  std::vector<std::array<double, 2>> changes;
};

/// Finds them exactly, by halving.
///
/// Of a part of the segment, labels are ruled out that lie outside of one plane of their domain there, or that are
/// further than a label whose distance is attained all over it, as three signs of the polar form tell. A part is done
/// when the labels left are of one site; or of two labels of two sites, one at each end, of which the squared distances
/// change their order once: their difference is quadratic, and so changes its sign once where it does between the ends;
/// of a triangle and its own edge, or an edge and its end, it is a square, and the plane between their domains, which a
/// segment crosses once, parts them. What is left is halved.
///
/// @param among  labels that hold all that are closest anywhere on the segment.
/// @param from, to  differ along `axis` alone, in rising order; the segment lies in the solid.
/// @return  nullopt where two sites tie at an end or all over a part of it, and where changes are closer than doubles
///          can part.
[[nodiscard]] std::optional<SegmentLabels> labels_along(const SiteLabels& labels, std::span<const Label> among,
                                                        const Vec3d& from, const Vec3d& to, std::size_t axis);

/// A place on an axis-parallel line at which the closest site changes.
struct LineEvent {
  double at = 0;                ///< coordinate along the axis, mesh units, rounded
  double error = 0;             ///< how far that may be off
  LabelIndex before = outside;  ///< closest below it
  LabelIndex after = outside;   ///< closest above it
  double width = 0;             ///< of thin regions between both, from `at` on
  LabelIndex thin = outside;    ///< the first vertex that has one
  bool has_several = false;     ///< whether others do, too

  /// Where the region above begins.
  [[nodiscard]] double upper() const { return at + width; }

  /// The triangle that the line crosses here, where it enters or leaves the solid.
  [[nodiscard]] std::optional<LabelIndex> crossed() const {
    if (before == outside) return after;
    return after == outside ? std::optional(before) : std::nullopt;
  }
};

/// A part of an axis-parallel line in the solid.
struct LinePart {
  Vec3d origin;  ///< any point of the line, mesh units
  std::size_t axis = 0;
  double low = 0, high = 0;    ///< coordinates of the ends along the axis
  LabelIndex first = outside;  ///< closest at the lower end
  LabelIndex last = outside;   ///< closest at the upper end, where it is known
};

/// How often the order of events was found, and where doubles did not tell it.
struct LineCounts {
  std::size_t parts = 0;      ///< parts of lines
  std::size_t exact = 0;      ///< where doubles did not tell, and exact signs did
  std::size_t undecided = 0;  ///< where these did not, either
};

/// Whether a point of a line lies behind the place at which one label takes over from another, exactly: where no other
/// place at which they do is near.
[[nodiscard]] bool is_behind_change(const SiteLabels& exact, const LabelGeometry& labels, LabelIndex before,
                                    LabelIndex after, const Vec3d& q);

/// Finds what is closest along lines.
///
/// Along a line squared distances are quadratic functions and domains are intervals, so what is closest is a lower
/// envelope: from one end on, the label that is closest stays so until the first place at which another one gets as
/// close (a root of a quadratic function) or its domain ends. Labels that share a footprint (a face and an edge of it,
/// an edge and its end) change at planes of domains alone. Roots come with bounds on their rounding; where these do not
/// tell the order of two of them, labels_along() finds it by exact signs.
class LineLabels {
 public:
  LineLabels(const SiteLabels& exact, const LabelGeometry& labels) : exact_(exact), labels_(labels) {}

  /// Appends the events of a part, in rising order. Between labels of one site there are none.
  /// @param among  labels that hold all that are closest anywhere on it.
  /// @return  whether all of it is certain.
  bool add_events(const LinePart& part, std::span<const LabelIndex> among, std::vector<LineEvent>& events) const;

  [[nodiscard]] LineCounts counts() const { return {parts_.load(), exact_parts_.load(), undecided_.load()}; }

 private:
  bool add_exact_events(const LinePart& part, std::span<const LabelIndex> among, std::vector<LineEvent>& events) const;

  const SiteLabels& exact_;
  const LabelGeometry& labels_;
  mutable std::atomic<std::size_t> parts_{0};
  mutable std::atomic<std::size_t> exact_parts_{0};
  mutable std::atomic<std::size_t> undecided_{0};
};

}  // namespace blum::voronoi
