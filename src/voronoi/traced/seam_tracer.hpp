// Blum: tracing of curves on which several sites are closest. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/traced/clear_way.hpp"
#include "voronoi/traced/trace_work.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// A surface that contains a curve: a plane, or the points equally far from two sites.
struct TracedSurface {
  using Index = TracedSites::Index;
  static constexpr Index none = 0xffffffff;

  Index first = none;  ///< `none` for a plane
  Index second = none;
  Vec3d normal;  ///< of a plane: a unit vector
  Vec3d point;   ///< of a plane

  static TracedSurface between(Index first, Index second) { return {first, second, {}, {}}; }
  static TracedSurface plane(const Vec3d& normal, const Vec3d& point) { return {none, none, normal, point}; }
  [[nodiscard]] bool is_plane() const { return first == none; }
};

/// A curve in two surfaces. All points of a piece of the curve have the same closest sites.
struct TracedCurve {
  std::array<TracedSurface, 2> surfaces;
  std::vector<TracedSites::Index> sites;  ///< ascending
};

/// Where and why a trace ended.
enum class TraceEnd : std::uint8_t {
  event,   ///< Other sites are as close, or the domain of a site ends.
  vertex,  ///< At a vertex of the polyhedron.
  border,  ///< At an edge of the polyhedron.
  closed,  ///< At its start.
  failed   ///< Numerically.
};

/// A traced piece of a curve.
struct Trace {
  std::vector<Vec3d> points;  ///< from start to end
  TraceEnd end = TraceEnd::failed;
  std::uint32_t vertex = 0;               ///< of the mesh, if the trace ended there
  std::vector<TracedSites::Index> sites;  ///< if it ended at an event: all closest sites there
};

/// Where a trace leaves a junction. The start of the trace may lie a little further.
struct Departure {
  Vec3d at;
  /// The closest sites there. Where curves touch, the place is not precise, so these sites may be equally close a
  /// little further on.
  std::vector<TracedSites::Index> sites;
};

/// Follows curves from point to point. A step is as long as the distances of other sites allow: along the curve, no
/// distance changes faster than the path length.
class SeamTracer {
 public:
  /// @param work  counts the work. If the work is exhausted, traces fail, and nothing is found.
  SeamTracer(const TracedSites& sites, TraceWork& work) : sites_(sites), work_(work) {}

  /// @param start   a point of the curve.
  /// @param towards direction at the start; need not be a tangent.
  /// @param from    the junction that the curve leaves; otherwise the start.
  [[nodiscard]] Trace trace(const TracedCurve& curve, const Vec3d& start, const Vec3d& towards,
                            const Departure& from) const;
  /// Returns the point of a curve in a plane, near a first guess.
  [[nodiscard]] std::optional<Vec3d> point_in_plane(const TracedCurve& curve, const Vec3d& guess,
                                                    const Vec3d& normal) const;
  /// Returns the direction of a curve at one of its points, a unit vector or 0.
  [[nodiscard]] Vec3d tangent(const TracedCurve& curve, const Vec3d& x) const;
  /// Returns a curve on which sites are equally close, or nothing if they do not determine one. With fewer than three
  /// footprints, the curve lies in sides of domains.
  /// @param towards  approximate direction of the curve at `at`, a unit vector.
  [[nodiscard]] std::optional<TracedCurve> curve_of(const std::vector<TracedSites::Index>& found, const Vec3d& at,
                                                    const Vec3d& towards) const;

  /// Returns the points in which seams meet a plane near a point, among given sites.
  /// @param reach  largest distance of the points.
  [[nodiscard]] std::vector<Vec3d> seam_points(const std::vector<TracedSites::Index>& near, const Vec3d& at,
                                               const Vec3d& normal, double reach) const;

  /// Returns the closest sites of a point.
  /// @param site  probably one of them.
  [[nodiscard]] TracedSites::Closest closest(const Vec3d& x, double tolerance, TracedSites::Index site) const;

  /// Returns the points equally far from two sites, near one of them. For edges from one vertex, and for parallel
  /// edges, this is a plane.
  [[nodiscard]] TracedSurface between(TracedSites::Index first, TracedSites::Index second, const Vec3d& at) const;

 private:
  struct Room;
  struct Event;
  struct Run;
  /// Returns true if faces, or many sites, meet in a point, all inside their domains. Their distances are linear, or
  /// nearly so, and no seam of some of them passes near.
  [[nodiscard]] bool is_meeting(const std::vector<TracedSites::Index>& near, const Vec3d& at) const;
  [[nodiscard]] std::vector<Room> rooms(const TracedCurve& curve, const Vec3d& x, const Vec3d& along, double radius,
                                        double most) const;
  /// Returns a lower bound on how much further a site is than the radius.
  /// @param beyond  sites_.outside(site, x)
  [[nodiscard]] double gap_to(TracedSites::Index site, const Vec3d& x, double beyond, double radius) const;
  /// Returns the way before which an edge stays further than those of the curve's edges that meet it at a vertex.
  /// @param way_to_zero  (value, slope): the way before which a linear function stays above 0.
  template <class WayToZero>
  [[nodiscard]] double way_past_edges(const TracedCurve& curve, TracedSites::Index site, const Vec3d& x,
                                      const WayToZero& way_to_zero) const;
  [[nodiscard]] std::vector<Room> rooms_of_line(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                double radius, double most) const;
  [[nodiscard]] std::vector<Room> rooms_of_bend(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                double radius, double most) const;
  [[nodiscard]] std::optional<Vec3d> solve(const std::array<TracedSurface, 3>& surfaces, Vec3d x, double reach) const;
  /// Returns true if a site and the sites of a curve have one distance from a point, which lies in their domains.
  [[nodiscard]] bool may_meet(const TracedCurve& curve, TracedSites::Index site, const Vec3d& at) const;
  /// Returns true if a point in the end of an edge's domain is closer to another edge from the same vertex. The
  /// distances differ by the square of the path length, which may be below the tolerance.
  [[nodiscard]] bool is_closer_to_an_edge(const DomainSide& end, const std::vector<TracedSites::Index>& edges,
                                          const Vec3d& at) const;
  [[nodiscard]] std::optional<Event> event_with(const TracedCurve& curve, TracedSites::Index site, const Vec3d& x,
                                                const Vec3d& along, double radius) const;
  /// Returns the length of a first step: the size of the curve's smallest site.
  [[nodiscard]] double first_step(const TracedCurve& curve) const;
  /// Returns the point near x where a curve touches the region of a site, if it does so within the tolerance.
  [[nodiscard]] std::optional<Vec3d> touching_point(const TracedCurve& curve, TracedSites::Index site, const Vec3d& x,
                                                    double radius) const;
  /// Returns the point near x where all sites meet that are nearly as close, if they meet within the tolerance. It is
  /// more precise than x if curves touch there.
  [[nodiscard]] std::optional<Vec3d> meeting_point(const TracedCurve& curve, const Vec3d& x, double radius) const;
  /// Sets the end of a trace that reached the surface: at a vertex if one is close.
  void end_at_border(Trace& trace) const;
  /// Returns points of a curve along its tangent; nothing if the curve bends much.
  [[nodiscard]] std::optional<CurveSamples> samples_of(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                       double length) const;
  /// Returns true if no other site is as close at points of the curve between two of its points.
  /// @param at_end  the closest sites of `to`: shortly before it, they may be as close within the tolerance.
  [[nodiscard]] bool is_clear(const TracedCurve& curve, const Vec3d& from, const Vec3d& to,
                              const std::vector<TracedSites::Index>& at_end) const;
  [[nodiscard]] std::optional<std::uint32_t> vertex_ahead(const TracedCurve& curve, const Vec3d& x, const Vec3d& along,
                                                          double radius, const std::vector<Room>& near) const;
  /// Returns true if both surfaces of a curve are planes.
  [[nodiscard]] bool is_straight(const TracedCurve& curve) const;
  /// Returns the normal of a plane that contains a curve, if there is one.
  [[nodiscard]] std::optional<Vec3d> plane_of(const TracedCurve& curve) const;
  [[nodiscard]] double value(const TracedSurface& surface, const Vec3d& x) const;
  [[nodiscard]] Vec3d slope(const TracedSurface& surface, const Vec3d& x) const;

  const TracedSites& sites_;
  TraceWork& work_;
};

}  // namespace blum::voronoi
