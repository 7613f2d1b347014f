// Blum: paths within a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Point in a solid.
struct Stop {
  Vec3d at;
  NearestPoint nearest;  ///< of the surface
};

/// Point from which segments to all corners of a polygon stay in the solid.
struct Hub {
  Stop stop;
  std::size_t open = 0;  ///< triangles with two adjacent corners that the surface does not cross
};

/// Returns true if a closed box contains a point.
[[nodiscard]] inline bool holds(const Box3& box, const Vec3d& at) {
  return max(box.lower, at) == at && min(box.upper, at) == at;
}

/// Finds chains of segments that do not leave a solid.
class SolidPaths {
 public:
  /// @param surface     of the solid. It must outlive this object.
  /// @param needs_more  null for full effort. Otherwise searches try no scattered points, which take about ten times as
  /// long, and set the flag if such points might have helped.
  explicit SolidPaths(const Surface& surface, bool* needs_more = nullptr)
      : surface_(surface), needs_more_(needs_more) {}

  /// @param within  box in which all stops that are found lie, and so the paths between them.
  SolidPaths(const Surface& surface, const Box3& within) : surface_(surface), within_(within) {}

  /// Returns a copy that is restricted to a box.
  [[nodiscard]] SolidPaths in(const Box3& box) const {
    SolidPaths other = *this;
    other.within_ = box;
    return other;
  }
  /// Prepares for many queries about points in a box.
  void prepare(const Box3& box) {
    auto part = surface_.part_in(box);
    part_ = part ? std::make_shared<const SurfacePart>(std::move(*part)) : nullptr;
  }

  /// Returns a stop at a point if the point lies in the solid and not on its surface.
  [[nodiscard]] std::optional<Stop> stop_at(const Vec3d& at, const Footprint& near) const;

  /// Returns a stop at a point if the point lies in the solid. Otherwise pushes the point in through the surface next
  /// to it. If that fails, returns its closest point on the surface.
  [[nodiscard]] Stop inside_near(const Vec3d& at, const Stop& near) const;

  /// Returns true if a segment between two points of the solid stays in the solid.
  [[nodiscard]] bool is_straight(const Stop& a, const Stop& b) const;

  /// Returns true if the surface does not cross a triangle. Its sides can then be pulled over it.
  [[nodiscard]] bool is_open(const Stop& a, const Stop& b, const Stop& c) const;

  /// Returns true if a segment can be moved to another one within the solid, its ends along straight lines. `false` may
  /// also mean that this is hard to decide.
  [[nodiscard]] bool can_sweep(const std::array<Stop, 2>& from, const std::array<Stop, 2>& to) const;

  /// Removes the stops of a path that the segments next to them can be pulled over. The ends stay, and so do stops
  /// around obstacles.
  [[nodiscard]] std::vector<Stop> pulled_over_open(std::vector<Stop> path) const;

  /// Returns the stops between two that pushing finds; none if the segment stays in the solid. Returns nullopt if
  /// pushing fails.
  [[nodiscard]] std::optional<std::vector<Stop>> pushed(const Stop& a, const Stop& b) const;

  /// Returns stops between two stops such that segments from one to the next stay in the solid, or nullopt if none are
  /// found.
  ///
  /// First it tries no stops, then pushing, then some of the landmarks, then the walls next to the two stops. Next it
  /// tries landmarks together with points that it meets when it walks along thin parts. With full effort it then
  /// scatters points around the two, finer and finer. At last it follows the border of the solid in the box that bounds
  /// the search.
  /// @param landmarks  points in the same part of the solid.
  [[nodiscard]] std::optional<std::vector<Stop>> path(const Stop& a, const Stop& b,
                                                      std::span<const Stop> landmarks) const;

  /// Returns a point from which the segments to all given corners stay in the solid. It has the most triangles with two
  /// adjacent corners that the surface does not cross. Candidates are points scattered around the corners. With little
  /// effort, only points where the walls next to the corners meet are tried.
  /// @param least_open  least number of these triangles.
  [[nodiscard]] std::optional<Hub> seeing_all(std::span<const Stop> corners, std::size_t least_open) const;

 private:
  [[nodiscard]] bool push_in(const Stop& a, const Stop& b, int depth, int& moves, std::vector<Stop>& between) const;
  [[nodiscard]] std::optional<Stop> outermost_pushed_in(const Stop& a, const Stop& b) const;
  [[nodiscard]] std::optional<Stop> detour(const Stop& a, const Stop& b) const;
  [[nodiscard]] std::optional<Stop> at_mouth(const Stop& thin, const Stop& other) const;
  [[nodiscard]] std::optional<Stop> at_crease(const Stop& a, const Stop& b) const;
  [[nodiscard]] std::optional<Stop> pushed_in(const Vec3d& outside, const Stop& near) const;
  [[nodiscard]] Stop centred(const Stop& stop) const;
  [[nodiscard]] Stop centred(const Stop& stop, double reach) const;
  [[nodiscard]] std::optional<std::vector<Stop>> pushed_or_along_walls(const Stop& a, const Stop& b) const;
  [[nodiscard]] std::optional<std::vector<Stop>> along_walls(const Stop& a, const Stop& b) const;
  [[nodiscard]] std::optional<std::vector<Stop>> inside_of(std::span<const SurfacePoint> way, const Stop& a,
                                                           const Stop& b) const;
  [[nodiscard]] std::optional<std::vector<Stop>> pushed_beside(std::span<const SurfacePoint> way, const Stop& a,
                                                               const Stop& b) const;
  /// Point of the surface that a stop sees.
  struct Wall {
    SurfacePoint point;
    std::uint32_t element;
  };
  [[nodiscard]] std::vector<Wall> walls_of(const Stop& stop) const;
  /// Returns true if little effort is to be made. In this case it also sets the flag that more might have helped.
  [[nodiscard]] bool gives_up() const;
  /// Returns the prepared part of the surface if all given stops lie in its box, else null.
  [[nodiscard]] const SurfacePart* part_at(std::initializer_list<const Stop*> stops) const;
  void walk(const Stop& from, const Stop& towards, std::vector<Stop>& landmarks) const;
  /// Limits of a search: no step is longer than `longest`, and at most `looks` segments are tested.
  struct SearchLimits {
    double longest = 0;
    int looks = 0;
  };
  [[nodiscard]] std::optional<std::vector<Stop>> shortest(const Stop& a, const Stop& b, std::span<const Stop> landmarks,
                                                          const SearchLimits& limits) const;
  [[nodiscard]] std::optional<std::vector<Stop>> over_strewn(const Stop& a, const Stop& b,
                                                             std::span<const Stop> landmarks) const;
  [[nodiscard]] std::optional<std::vector<Stop>> over_border(const Stop& a, const Stop& b) const;
  [[nodiscard]] std::vector<Stop> where_walls_meet(std::span<const Stop> stops, const Box3& box) const;
  void add_creases(double longest, std::vector<Stop>& stops) const;
  [[nodiscard]] std::vector<Stop> strewn(const Vec3d& middle, double side, int parts) const;
  [[nodiscard]] std::vector<Stop> pulled_tight(const Stop& a, const Stop& b, const std::vector<Stop>& between) const;

  const Surface& surface_;
  std::optional<Box3> within_;
  bool* needs_more_ = nullptr;
  std::shared_ptr<const SurfacePart> part_ = nullptr;
};

}  // namespace blum::detail
