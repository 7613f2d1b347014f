// Blum: the queries of `blum proximity`. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/impact.hpp"
#include "blum/proximity/scene.hpp"
#include "common_options.hpp"
#include "described.hpp"
#include "summary.hpp"

namespace blum::cli {

struct ProximityArguments {
  std::vector<std::string> scene;
  std::vector<std::string> ends;  ///< of continuous alone: where each object is at the end
  std::string query = "separation";
  bool self = false;
  bool frames = false;  ///< whether files are frames of one object
  std::optional<std::string> within;
  std::optional<std::string> output;
  std::optional<std::string> threads;
  OptionTexts<ImpactOptions> impact;            ///< of continuous collisions alone
  OptionTexts<SceneOptions> culling;            ///< of separation, nbody and collide
  OptionTexts<PenetrationOptions> penetration;  ///< of penetration alone
  ReportOptions report;
};

/// --query continuous: two files are a mesh at the start and the end of a motion; with --to as run_moving_scene().
void run_continuous_query(const ProximityArguments& a);

/// --query continuous with --to: each file is an object at the start of a motion, and has one at the end.
void run_moving_scene(const ProximityArguments& a);

/// A mesh at the start and the end of a motion.
struct MovingMesh {
  TriangleMesh start;
  std::vector<Vec3d> end;  ///< empty: it rests
};

/// A mesh that rests where both are one path. @throws FileError; FormatError where the files are not one mesh.
[[nodiscard]] MovingMesh read_moving_mesh(const std::filesystem::path& start, const std::filesystem::path& end);

/// What is asked of options by --query continuous, whatever moves. @throws UsageError.
void check_continuous_options(const ProximityArguments& a);

/// --query separation, nbody, collide or penetration: each file is an object.
void run_scene_query(const ProximityArguments& a);

/// Any query with --frames: the files are those of one object, one after the other.
void run_frames(const ProximityArguments& a);

/// A part of what two objects of a scene have in common.
struct ScenePenetration {
  ObjectId first;
  ObjectId second;
  Penetration part;
};

/// Those of all pairs of objects, and with `is_self` of each with itself.
[[nodiscard]] std::vector<ScenePenetration> all_penetrations(const ProximityScene& scene, bool is_self,
                                                             const PenetrationOptions& options, const Context& context,
                                                             std::vector<PhaseTime>& phases);

/// A part as a pair: of the points that are told of it, with the depth as a negative distance.
[[nodiscard]] PrimitivePair pair_of(const ScenePenetration& penetration);

[[nodiscard]] Json json_of(const ScenePenetration& penetration);

}  // namespace blum::cli
