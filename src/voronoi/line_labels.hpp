// Blum: the closest labels along a line, from the order of events. SPDX-License-Identifier: Apache-2.0
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

/// The closest sites along a segment, in order, and intervals that contain the changes between them.
struct SegmentLabels {
  std::vector<std::uint32_t> sites;  ///< numbers as in SiteLabels::site_of(); neighbours in the list differ
  /// Entry k: coordinates of two points. Between them, the closest site changes exactly once, from site k to the next
  /// one.
  std::vector<std::array<double, 2>> changes;
};

/// Finds the closest sites along a segment exactly, by halving.
///
/// A label is excluded from a part of the segment if that part lies outside one plane of the label's domain. It is also
/// excluded if it is further everywhere than another label that contains the feet of all points of the part. Three
/// signs of polar forms decide that. A part is done if all remaining labels belong to one site. It is also done if only
/// two labels of different sites remain, and the order of their squared distances differs at the ends. The difference
/// of squared distances is quadratic, so it then changes its sign exactly once. For a triangle and its own edge, or an
/// edge and its own end, the difference is a square, without a change of sign. In that case the plane between both
/// domains decides, and a segment crosses the plane once. A part that is not done is halved.
///
/// @param among  labels that include all that are closest to a point of the segment.
/// @param from, to  differ only along `axis`, with the smaller coordinate first. The segment lies in the solid.
/// @return  nullopt if two sites are equally close at an end or along a whole part, or if doubles cannot separate two
///          changes.
[[nodiscard]] std::optional<SegmentLabels> labels_along(const SiteLabels& labels, std::span<const Label> among,
                                                        const Vec3d& from, const Vec3d& to, std::size_t axis);

/// A point of an axis-parallel line at which the closest site changes.
struct LineEvent {
  double at = 0;                ///< coordinate along the axis, mesh units, rounded
  double error = 0;             ///< bound on the error of `at`
  LabelIndex before = outside;  ///< closest label below the point
  LabelIndex after = outside;   ///< closest label above the point
  double width = 0;             ///< width of the thin regions in between; they start at `at`
  LabelIndex thin = outside;    ///< the first thin vertex with a region in between
  bool has_several = false;     ///< true if several thin vertices have a region in between

  /// Returns the coordinate at which the region of `after` begins.
  [[nodiscard]] double upper() const { return at + width; }

  /// Returns the triangle that the line crosses at the point; nullopt unless the line enters or leaves the solid there.
  [[nodiscard]] std::optional<LabelIndex> crossed() const {
    if (before == outside) return after;
    return after == outside ? std::optional(before) : std::nullopt;
  }
};

/// A segment of an axis-parallel line. It lies in the solid.
struct LinePart {
  Vec3d origin;  ///< any point of the line, in mesh units
  std::size_t axis = 0;
  double low = 0, high = 0;    ///< coordinates of the ends along the axis
  LabelIndex first = outside;  ///< closest label at the lower end
  LabelIndex last = outside;   ///< closest label at the upper end; `outside` if unknown
};

/// Counts of the parts of lines that add_events() searched.
struct LineCounts {
  std::size_t parts = 0;      ///< number of all parts
  std::size_t exact = 0;      ///< number of parts that only exact signs decided
  std::size_t undecided = 0;  ///< number of parts that neither doubles nor exact signs decided
};

/// Returns true if a point of a line lies beyond the point at which label `after` becomes closer than label `before`.
/// The test is exact. It requires that this change happens only once nearby.
[[nodiscard]] bool is_behind_change(const SiteLabels& exact, const LabelGeometry& labels, LabelIndex before,
                                    LabelIndex after, const Vec3d& q);

/// Finds the closest labels along axis-parallel lines.
///
/// Along a line, squared distances are quadratic functions and domains are intervals. So the closest labels form a
/// lower envelope, which is followed from the lower end. A label stays closest until its domain ends, or until another
/// label becomes as close, at a root of a quadratic function. Between a face and its own edge, or an edge and its own
/// end, changes occur only at planes of domains. Roots have bounds on their rounding errors. If the bounds leave the
/// order of two roots open, labels_along() finds the order by exact signs.
class LineLabels {
 public:
  LineLabels(const SiteLabels& exact, const LabelGeometry& labels) : exact_(exact), labels_(labels) {}

  /// Appends the events of a part, in ascending order. A change between two labels of the same site is not an event.
  /// @param among  labels that include all that are closest to a point of the part.
  /// @return  true if all events are certain.
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
