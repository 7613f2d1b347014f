// Blum: search for paths that are proven free of contact. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/planning/certified_path.hpp"

namespace blum {

/// Planner of OMPL that searches.
enum class PathPlanner : std::uint8_t {
  rrt_connect,  ///< Two trees, from the start and from the goal. Fast for most problems.
  rrt,          ///< One tree, from the start.
  prm,          ///< A roadmap.
  lbkpiece,     ///< Two trees that prefer rarely visited places.
  rrt_star      ///< One tree. It uses all of the time to shorten the path.
};

template <>
struct Description<PathPlanner> {
  static constexpr std::string_view name = "PathPlanner";
  static constexpr std::array values{NamedValue{PathPlanner::rrt_connect, "rrt_connect"},
                                     NamedValue{PathPlanner::rrt, "rrt"}, NamedValue{PathPlanner::prm, "prm"},
                                     NamedValue{PathPlanner::lbkpiece, "lbkpiece"},
                                     NamedValue{PathPlanner::rrt_star, "rrt_star"}};
};

struct PlanOptions {
  double clearance = 0;  ///< Distance that the surfaces must keep, >= 0, mesh units.
  /// Motions that come closer than the clearance plus this distance may be refused, > 0, mesh units. If not given, it
  /// is 1e-4 of the size of the smallest body.
  std::optional<double> delta = {};
  double time = 10;                                ///< Time of the search, > 0, seconds.
  std::uint32_t seed = 1;                          ///< Seed of the random numbers.
  PathPlanner planner = PathPlanner::rrt_connect;  ///< Planner that searches.
  bool allow_inside = false;  ///< True: the bodies may start inside the solid of a closed obstacle, as in a room.
};

template <>
struct Description<PlanOptions> {
  static constexpr std::string_view name = "PlanOptions";
  static constexpr std::string_view doc = "Clearance, time and planner of a search for a path";
  static constexpr std::tuple members{
      Member{"clearance", &PlanOptions::clearance, "mesh units", "distance that the surfaces must keep",
             Range::at_least(0)},
      Member{"delta", &PlanOptions::delta, "mesh units",
             "motions that come closer than the clearance plus this distance may be refused; default: 1e-4 of the size "
             "of the smallest body",
             Range::positive()},
      Member{"time", &PlanOptions::time, "seconds", "time of the search", Range::positive()},
      Member{"seed", &PlanOptions::seed, "", "seed of the random numbers"},
      Member{"planner", &PlanOptions::planner, "", "planner of OMPL that searches"},
      Member{"allow_inside", &PlanOptions::allow_inside, "",
             "true: the bodies may start inside the solid of a closed obstacle, as in a room"},
  };
};

/// Bodies that must move from their start to their goal among obstacles that rest.
struct PlanProblem {
  std::vector<MeshView> bodies;
  std::vector<MeshView> obstacles;
  std::vector<RigidTransform> start, goal;  ///< One pose for each body.
  /// Box in which the centres of the bodies may be. If not given, it contains the obstacles, the starts and the goals,
  /// with space for the largest body on each side.
  std::optional<Box3> bounds = {};
};

struct PlannedPath {
  bool is_found = false;
  MotionPath path;                 ///< If found: the path. Otherwise empty.
  CertifiedPath proof;             ///< If found: the proof of the whole path.
  std::vector<std::size_t> order;  ///< Several bodies: the order in which they moved to their goals.
  std::size_t states = 0;          ///< States in the trees or roadmaps of all searches.
  double seconds = 0;              ///< Time of the search.
};

/// Returns true if this build contains OMPL, which plan_path() needs.
[[nodiscard]] bool has_path_planner();

/// Searches for a path of rigid bodies. OMPL searches, and each motion that it uses is certified. So the path that is
/// found is proven, and no motion jumps over an obstacle. If no path is found in time, none need exist, but this is not
/// proven.
///
/// Several bodies move one after the other. The order is found by trying all bodies that have not reached their goals.
///
/// The first search of a process gives equal paths for equal seeds, if it ends before its time. Later searches may
/// differ, because all searches share the random numbers of OMPL. Searches of the planner rrt_star may always differ.
/// @throws InvalidOption if a body is too close to another object at its start or goal, or is inside the solid of a
/// closed obstacle. The message contains the position. It is also thrown for options out of range, and without OMPL.
/// @throws InvalidMesh; Cancelled. Progress is the share of the time that has passed.
[[nodiscard]] PlannedPath plan_path(const PlanProblem& problem, const PlanOptions& options = {},
                                    const Context& context = {});

}  // namespace blum
