// Blum: sheets, seams and junctions of a polyhedron by tracing. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "voronoi/traced/local_star.hpp"
#include "voronoi/traced/seam_tracer.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// The Voronoi diagram inside a polyhedron: junctions, the curves between them, and the sheets between the curves.
struct TracedStructure {
  using Index = TracedSites::Index;
  static constexpr std::uint32_t none = 0xffffffff;

  struct Junction {
    Vec3d at;
    double radius = 0;
    std::vector<Index> sites;     ///< ascending; empty at vertices of the polyhedron
    std::uint32_t vertex = none;  ///< of the mesh
  };
  /// A seam, or an edge of the polyhedron where sheets end.
  struct Curve {
    std::array<std::uint32_t, 2> ends{none, none};  ///< junctions
    std::vector<Vec3d> points;                      ///< from one end to the other
    std::array<Vec3d, 2> directions;                ///< of the curve at its ends, away from them: unit vectors
    TracedCurve curve;                              ///< of a seam
    RegionRing ring;                                ///< counterclockwise as seen from the second end
    bool is_edge = false;                           ///< of the polyhedron
  };
  /// One side of a sheet.
  struct Side {
    std::uint32_t curve = 0;
    bool is_forward = true;
  };
  struct Sheet {
    Index first = 0, second = 0;           ///< sites, the smaller number first
    std::vector<std::vector<Side>> loops;  ///< the boundary, the outer loop first
  };

  std::vector<Junction> junctions;
  std::vector<Curve> curves;
  std::vector<Sheet> sheets;
};

/// A structure, or the reason why there is none.
struct TracedResult {
  std::optional<TracedStructure> structure;
  std::string problem;     ///< for a report; empty if `structure` exists
  Vec3d place;             ///< of the problem
  std::uint64_t work = 0;  ///< as counted by TraceWork
};

/// How thoroughly sheets are searched for further boundaries.
enum class TraceEffort : std::uint8_t {
  usual,  ///< From the longest seams of each boundary.
  full,   ///< From all seams.
};

/// Traces the diagram of sites. Traces start from edges of the polyhedron, and from sheets that were found.
/// @param most_work  limit on the work, > 0. One trace may take an eighth of it.
/// @throws Cancelled.
[[nodiscard]] TracedResult traced_structure(const TracedSites& sites, TraceEffort effort, std::uint64_t most_work,
                                            const Context& context);

/// Returns a limit on the work of a diagram: about ten times the largest work per site that diagrams need.
[[nodiscard]] std::uint64_t usual_work(const TracedSites& sites);

/// Returns a limit on the work of all attempts to trace a diagram, so that failing traces take at most about as long as
/// cubes. The limit is 0 for scans and fine tessellations whose traces would hardly succeed below it.
/// @param triangles  of the mesh.
[[nodiscard]] std::uint64_t default_work(const TracedSites& sites, std::size_t triangles);

}  // namespace blum::voronoi
