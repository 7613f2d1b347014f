// Blum: the junctions and seams of a diagram, found by tracing. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "voronoi/traced/seam_rays.hpp"
#include "voronoi/traced/seam_tracer.hpp"
#include "voronoi/traced/trace_problem.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"

namespace blum::voronoi {

/// Finds the junctions and seams. Each seam is followed to its ends, and all seams that leave a junction are followed.
/// So a connected set of seams is complete if one of its points is known. Walks along walls find such points.
///
/// Seams and walks are traced in parallel, in groups that do not depend on the number of threads.
class SeamGraph {
 public:
  /// @param most_work  limit on the work, > 0.
  SeamGraph(const TracedSites& sites, std::uint64_t most_work, const Context& context);

  /// Walks from the middle of each edge of the polyhedron along the walls that end there, and follows the junctions and
  /// seams that it finds.
  /// @throws TraceProblem, Cancelled.
  void start_at_edges();
  /// A wall beside a curve.
  struct Side {
    std::uint32_t curve = 0;
    std::uint32_t germ = 0;
  };
  /// Walks from the middles of seams across the adjacent walls, and follows the junctions and seams that it finds.
  /// @throws TraceProblem, Cancelled.
  void cross(std::span<const Side> sides);

  [[nodiscard]] const TracedStructure& structure() const { return out_; }
  [[nodiscard]] std::uint64_t work() const { return work_.done; }
  [[nodiscard]] TracedStructure take() { return std::move(out_); }

 private:
  using Index = TracedSites::Index;
  using Junction = TracedStructure::Junction;
  using Curve = TracedStructure::Curve;

  struct Ray {
    LeavingSeam seam;
    std::uint32_t curve = TracedStructure::none;
  };
  /// A ray of a junction.
  using RayId = std::pair<std::uint32_t, std::uint32_t>;
  /// A walk along a wall, in a plane.
  struct Walk {
    std::array<Index, 2> sites;
    Vec3d start;
    Vec3d towards;
    Vec3d normal;  ///< of the plane through the start
  };
  struct Traced {
    Trace trace;
    std::vector<LeavingSeam> seams;  ///< at the end, if it is an event
    std::uint64_t work = 0;
  };

  void add_vertices();
  void add_edges();
  void walk(std::span<const Walk> walks);
  [[nodiscard]] std::optional<Walk> across(const Side& side) const;
  [[nodiscard]] Traced trace_walk(const Walk& walk) const;
  [[nodiscard]] Traced trace_seam(const Vec3d& at, const LeavingSeam& seam, const std::vector<Index>& left) const;
  /// Returns the counter of one trace.
  [[nodiscard]] TraceWork work_of_trace() const;
  /// Adds the work of a trace. @throws TraceProblem if there is too much.
  void count(const Traced& traced);
  void reach(const Vec3d& at, const std::vector<Index>& found);
  void follow(const Vec3d& at, const std::vector<LeavingSeam>& seams);
  void add_closed(const Vec3d& at, const LeavingSeam& seam, const Trace& trace);
  [[nodiscard]] bool is_known(const Vec3d& at, const std::vector<Index>& found) const;
  [[nodiscard]] std::uint32_t find_junction(const Vec3d& at, const std::vector<Index>& found) const;
  std::uint32_t junction_at(const Vec3d& at, const std::vector<Index>& found, std::vector<LeavingSeam> seams);
  void finish_rays();
  void add_traced(const RayId& from, Traced traced);
  void take_ray(std::uint32_t junction, Curve& curve, std::uint32_t number);
  void add_curve(Curve curve);
  [[nodiscard]] Vec3d direction_from(const Curve& curve, const Vec3d& end, const Vec3d& next) const;
  void set_directions(Curve& curve, const Vec3d& first) const;

  const TracedSites& sites_;
  const Context& context_;
  TraceWork work_;
  const SeamTracer tracer_;
  TracedStructure out_;
  std::multimap<double, std::uint32_t> junctions_by_x_;                ///< those inside the solid
  std::map<std::vector<Index>, std::vector<std::uint32_t>> seams_of_;  ///< curves by their sites
  std::vector<std::vector<Ray>> rays_;                                 ///< of each junction
  std::deque<RayId> waiting_;
};

/// Returns the first point of a curve that is clearly apart from one of its ends.
[[nodiscard]] const Vec3d& point_next_to(const TracedStructure::Curve& curve, std::uint32_t end, double tolerance);

}  // namespace blum::voronoi
