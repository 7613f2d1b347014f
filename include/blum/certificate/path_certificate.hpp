// Blum: checks of stated paths of rigid bodies. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Path of rigid bodies, as a file states it. Between waypoints, the centre of each body moves along a straight line.
/// The body turns about it at a constant speed, the shorter way round.
struct StatedPath {
  /// Pose: x, y, z of the translation, then w, x, y, z of a quaternion.
  using Pose = std::array<double, 7>;
  /// Part of the motion from waypoint `edge` to the next one, with a stated clearance.
  struct Interval {
    std::uint32_t edge = 0;
    double from = 0, to = 1;  ///< times, 0 to 1
    double clearance = 0;     ///< mesh units
  };
  std::vector<Vec3d> centres;            ///< For each body: its centre, in its coordinates.
  std::vector<std::vector<Pose>> poses;  ///< For each waypoint: the pose of each body.
  double clearance = 0;                  ///< Stated clearance of the whole path, mesh units.
  std::vector<Interval> intervals;       ///< Stated proof. If empty, the check finds its own.
};

/// Result of the check of a path.
struct PathCertificate {
  bool holds = false;     ///< True if the path is proven to keep its clearance, and all stated intervals theirs.
  double clearance = 0;   ///< The clearance that was checked, mesh units.
  std::size_t edges = 0;  ///< Number of motions between waypoints.
  std::size_t tests = 0;  ///< Number of times at which distances were compared.
  std::vector<std::string> mismatches;  ///< The reasons, if the path is not certified.
};

template <>
struct Description<PathCertificate> {
  static constexpr std::string_view name = "PathCertificate";
  static constexpr std::string_view doc = "Result of the check of a path";
  static constexpr std::tuple members{
      Member{"holds", &PathCertificate::holds, "", "true if the path is proven to keep its clearance"},
      Member{"clearance", &PathCertificate::clearance, "mesh units", "the clearance that was checked"},
      Member{"edges", &PathCertificate::edges, "", "number of motions between waypoints"},
      Member{"tests", &PathCertificate::tests, "", "number of times at which distances were compared"},
      Member{"mismatches", &PathCertificate::mismatches, "", "the reasons, if the path is not certified"},
  };
};

/// Checks a path with code of its own: it shares no distances, hierarchies or motions with the planning layer.
///
/// Each stated interval must have its clearance, and the intervals of each motion must cover its time. Their clearances
/// must be at least that of the path. Clearances are checked up to 1e-12 of the largest coordinate, but at most a
/// millionth of the clearance. Contact is excluded without this allowance. If motions have no stated intervals, the
/// check subdivides them itself.
/// @param bodies, obstacles  must pass validate(mesh). Coordinates are of magnitude at most 1e70.
/// @throws InvalidMesh; InvalidOption if there is no body, or one body and no obstacle; Cancelled. Progress counts
/// motions.
[[nodiscard]] PathCertificate verify_path(std::span<const MeshView> bodies, std::span<const MeshView> obstacles,
                                          const StatedPath& path, const Context& context = {});

}  // namespace blum
