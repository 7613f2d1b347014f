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

/// The closest sites along a segment, in order, and the places where they change.
struct SegmentLabels {
  std::vector<std::uint32_t> sites;  ///< numbers of SiteLabels::site_of(); neighbours differ
  /// Entry k: coordinates along the segment of two points between which sites k and k + 1 change, and no others.
  std::vector<std::array<double, 2>> changes;
};

/// Finds the closest sites along a segment exactly, by halving.
///
/// A label is excluded from a part of the segment if that part lies outside of one plane of the label's domain. It is
/// also excluded if it is further than a label whose distance is attained all over the part. Three signs of the polar
/// form decide this.
/// A part is done if the remaining labels belong to one site. It is also done if two labels of two sites remain, one at
/// each end, and the order of their squared distances changes once. Their difference is quadratic, so it changes its
/// sign once if it does so between the ends. For a triangle and its own edge, or an edge and its end, the difference is
/// a square. The plane between their domains separates these, and a segment crosses it once.
/// All other parts are halved.
///
/// @param among  labels that contain all that are closest anywhere on the segment.
/// @param from, to  differ along `axis` alone, in rising order; the segment lies in the solid.
/// @return  nullopt if two sites tie at an end or all over a part, or if changes are closer than doubles can separate.
[[nodiscard]] std::optional<SegmentLabels> labels_along(const SiteLabels& labels, std::span<const Label> among,
                                                        const Vec3d& from, const Vec3d& to, std::size_t axis);

/// A place on an axis-parallel line at which the closest site changes.
struct LineEvent {
  double at = 0;                ///< coordinate along the axis, mesh units, rounded
  double error = 0;             ///< largest error of `at`
  LabelIndex before = outside;  ///< closest below it
  LabelIndex after = outside;   ///< closest above it
  double width = 0;             ///< of the thin regions in between, from `at` on
  LabelIndex thin = outside;    ///< the first vertex that has one
  bool has_several = false;     ///< true if more vertices have one

  /// Returns the coordinate at which the region above begins.
  [[nodiscard]] double upper() const { return at + width; }

  /// Returns the triangle that the line crosses here, if it enters or leaves the solid.
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
  LabelIndex last = outside;   ///< closest at the upper end, if known
};

/// Counts of parts of lines whose order of events was searched.
struct LineCounts {
  std::size_t parts = 0;      ///< all
  std::size_t exact = 0;      ///< decided by exact signs, not by doubles
  std::size_t undecided = 0;  ///< decided by neither
};

/// Returns true if a point of a line lies behind the place at which label `after` takes over from `before`. Exact. No
/// other place at which it does so may be near.
[[nodiscard]] bool is_behind_change(const SiteLabels& exact, const LabelGeometry& labels, LabelIndex before,
                                    LabelIndex after, const Vec3d& q);

/// Finds the closest labels along lines.
///
/// Along a line, squared distances are quadratic functions and domains are intervals, so the closest labels form a
/// lower envelope. From one end on, a label stays closest until another one gets as close (a root of a quadratic
/// function), or until its domain ends. Labels that share a footprint (a face and its edge, an edge and its end) change
/// only at planes of domains. Roots have bounds on their rounding. If these leave the order of two roots open,
/// labels_along() finds it by exact signs.
class LineLabels {
 public:
  LineLabels(const SiteLabels& exact, const LabelGeometry& labels) : exact_(exact), labels_(labels) {}

  /// Appends the events of a part, in rising order. No events lie between labels of one site.
  /// @param among  labels that contain all that are closest anywhere on it.
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
