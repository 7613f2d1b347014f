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
  NearestPoint nearest;  ///< closest point of the surface
};

/// Point from which segments to all corners of a polygon stay in the solid.
struct Hub {
  Stop stop;
  std::size_t open = 0;  ///< number of triangles of the hub and two adjacent corners that the surface does not cross
};

/// Returns true if a closed box contains a point.
[[nodiscard]] inline bool holds(const Box3& box, const Vec3d& at) {
  return max(box.lower, at) == at && min(box.upper, at) == at;
}

/// Finds paths: chains of segments that do not leave a solid. The vertices of a path are called stops.
class SolidPaths {
 public:
  /// @param surface     surface of the solid. It must outlive this object.
  /// @param needs_more  null for full effort. Otherwise searches make little effort: they use no scattered points, and
  /// set the flag if such points might have helped. Full effort takes about ten times as long.
  explicit SolidPaths(const Surface& surface, bool* needs_more = nullptr)
      : surface_(surface), needs_more_(needs_more) {}

  /// @param within  box that contains all stops that are found, and so all paths.
  SolidPaths(const Surface& surface, const Box3& within) : surface_(surface), within_(within) {}

  /// Returns a copy that is restricted to a box.
  [[nodiscard]] SolidPaths in(const Box3& box) const {
    SolidPaths other = *this;
    other.within_ = box;
    return other;
  }
  /// Makes later queries about points in a box faster.
  void prepare(const Box3& box) {
    auto part = surface_.part_in(box);
    part_ = part ? std::make_shared<const SurfacePart>(std::move(*part)) : nullptr;
  }

  /// Returns a stop at a point if the point lies inside the solid and not on its surface; else nullopt.
  [[nodiscard]] std::optional<Stop> stop_at(const Vec3d& at, const Footprint& near) const;

  /// Returns a stop at a point if the point lies in the solid. Otherwise returns a stop inside, on the other side of
  /// the closest point of the surface. If that fails, returns the closest point of the surface itself.
  [[nodiscard]] Stop inside_near(const Vec3d& at, const Stop& near) const;

  /// Returns true if a segment between two points of the solid stays in the solid.
  [[nodiscard]] bool is_straight(const Stop& a, const Stop& b) const;

  /// Returns true if the surface does not cross a triangle. In this case, a path along one side can be deformed, in the
  /// solid, to the path along the other two sides.
  [[nodiscard]] bool is_open(const Stop& a, const Stop& b, const Stop& c) const;

  /// Returns true if a segment can be moved to another segment within the solid, each end along a straight line. The
  /// result `false` may also mean that this is undecided.
  [[nodiscard]] bool can_sweep(const std::array<Stop, 2>& from, const std::array<Stop, 2>& to) const;

  /// Removes a stop of a path if the two segments at it can be deformed, in the solid, to one segment. This is
  /// repeated. The ends of the path stay, and so do stops around obstacles.
  [[nodiscard]] std::vector<Stop> pulled_over_open(std::vector<Stop> path) const;

  /// Joins two stops by pushing: where a segment leaves the solid, a stop inside is inserted, recursively. Returns the
  /// inserted stops; an empty list if the segment stays in the solid. Returns nullopt if pushing fails.
  [[nodiscard]] std::optional<std::vector<Stop>> pushed(const Stop& a, const Stop& b) const;

  /// Returns stops for a path between two stops, such that all segments stay in the solid. Returns nullopt if no path
  /// is found.
  ///
  /// Methods are tried in this order: one segment, pushing, a path over some of the landmarks, a path along the walls
  /// next to both stops. Next is a path over the landmarks and over points on walks along thin parts. With full effort,
  /// a path over points scattered around both stops follows, with increasing density. The last method follows the
  /// border of the solid in the box that bounds the search.
  /// @param landmarks  points in the same part of the solid.
  [[nodiscard]] std::optional<std::vector<Stop>> path(const Stop& a, const Stop& b,
                                                      std::span<const Stop> landmarks) const;

  /// Returns a point from which the segments to all given corners stay in the solid. With each two adjacent corners,
  /// such a point forms a triangle. The point with the most triangles that the surface does not cross is returned.
  /// Candidates are points scattered around the corners. With little effort, the only candidates are points where
  /// planes along the walls next to the corners meet.
  /// @param least_open  least number of triangles that the surface does not cross.
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
  /// Point of the surface next to a stop, and the element that contains it.
  struct Wall {
    SurfacePoint point;
    std::uint32_t element;
  };
  [[nodiscard]] std::vector<Wall> walls_of(const Stop& stop) const;
  /// Returns true if only little effort is allowed. In this case it also sets the flag `needs_more`.
  [[nodiscard]] bool gives_up() const;
  /// Returns the part of the surface that prepare() stored, if all given stops lie in its box; else null.
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
