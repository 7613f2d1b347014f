// Blum: paths that stay in a solid. SPDX-License-Identifier: Apache-2.0
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

/// A point in a solid.
struct Stop {
  Vec3d at;
  NearestPoint nearest;  ///< of the surface
};

/// A point that sees the corners of a polygon.
struct Hub {
  Stop stop;
  std::size_t open = 0;  ///< triangles with two corners next to each other that none of the surface comes through
};

/// Whether a box, its sides included, holds a point.
[[nodiscard]] inline bool holds(const Box3& box, const Vec3d& at) {
  return max(box.lower, at) == at && min(box.upper, at) == at;
}

/// Finds chains of segments that do not leave a solid.
class SolidPaths {
 public:
  /// @param surface     that bounds the solid. It must stay.
  /// @param needs_more  null: with full effort. Else with little, that is, without points strewn around, which take
  ///                    about ten times as long; and it is set where these might have helped.
  explicit SolidPaths(const Surface& surface, bool* needs_more = nullptr)
      : surface_(surface), needs_more_(needs_more) {}

  /// @param within  where all stops must lie that are found: so do the paths between them.
  SolidPaths(const Surface& surface, const Box3& within) : surface_(surface), within_(within) {}

  /// The same, but with such a box.
  [[nodiscard]] SolidPaths in(const Box3& box) const {
    SolidPaths other = *this;
    other.within_ = box;
    return other;
  }
  /// Prepares for many questions about points in a box.
  void prepare(const Box3& box) {
    auto part = surface_.part_in(box);
    part_ = part ? std::make_shared<const SurfacePart>(std::move(*part)) : nullptr;
  }

  /// A point, if it lies in the solid and not on its surface.
  [[nodiscard]] std::optional<Stop> stop_at(const Vec3d& at, const Footprint& near) const;

  /// A point in the solid, or one near it that is: through the surface next to it, or on this where nothing else helps.
  [[nodiscard]] Stop inside_near(const Vec3d& at, const Stop& near) const;

  /// Whether a segment stays in the solid, its ends being in it.
  [[nodiscard]] bool is_straight(const Stop& a, const Stop& b) const;

  /// Whether the sides of a triangle can be pulled over it: no part of the surface comes through it.
  [[nodiscard]] bool is_open(const Stop& a, const Stop& b, const Stop& c) const;

  /// Whether a segment in the solid can be moved to where another one is without leaving it, ends along straight lines:
  /// `false` also where that is not easy to see.
  [[nodiscard]] bool can_sweep(const std::array<Stop, 2>& from, const std::array<Stop, 2>& to) const;

  /// A path without those stops that the segments next to them can be pulled over: ends stay, and what the path runs
  /// around.
  [[nodiscard]] std::vector<Stop> pulled_over_open(std::vector<Stop> path) const;

  /// The stops between two on the way that pushing finds, if it finds any; none where the segment stays in the solid.
  [[nodiscard]] std::optional<std::vector<Stop>> pushed(const Stop& a, const Stop& b) const;

  /// The stops between two such that segments from one to the next stay in the solid; nullopt where none were found.
  /// Tried in turn: none; those of pushing; some of the landmarks; along the walls next to the two; landmarks and what
  /// is met when walking along thin parts; with full effort, points strewn around the two, finer and finer, and along
  /// the border of what the solid has in the box that bounds the search.
  /// @param landmarks  points in the same part of the solid.
  [[nodiscard]] std::optional<std::vector<Stop>> path(const Stop& a, const Stop& b,
                                                      std::span<const Stop> landmarks) const;

  /// A point that segments in the solid join to all of some others, of those found among points strewn around these the
  /// one with the most triangles from each to the next that none of the surface comes through. With little effort,
  /// where the walls next to them meet only.
  /// @param least_open  how many there must be of these triangles.
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
  /// A point of the surface that a stop sees.
  struct Wall {
    SurfacePoint point;
    std::uint32_t element;
  };
  [[nodiscard]] std::vector<Wall> walls_of(const Stop& stop) const;
  /// Whether little effort is to be made; it is told that more might have helped.
  [[nodiscard]] bool gives_up() const;
  /// What was prepared, if all of some stops lie there.
  [[nodiscard]] const SurfacePart* part_at(std::initializer_list<const Stop*> stops) const;
  void walk(const Stop& from, const Stop& towards, std::vector<Stop>& landmarks) const;
  /// What a search may do: no step is longer than `longest`, and so many segments are looked at.
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
