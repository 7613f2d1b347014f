// Blum: the queries of `blum proximity`. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "blum/proximity/impact.hpp"
#include "blum/proximity/scene.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/summary.hpp"

namespace blum::cli {

struct ProximityArguments {
  std::vector<std::string> scene;
  std::vector<std::string> ends;  ///< continuous only: one file for each object at the end
  std::string query;              ///< SceneQuery::name
  bool self = false;
  bool frames = false;        ///< whether files are frames of one object
  bool skip_changed = false;  ///< of frames and continuous: goes on where a frame is another mesh than the one before
  std::optional<std::string> max_distance;
  std::optional<std::string> limit;  ///< the most pairs that are written
  std::optional<std::string> weld;
  std::optional<std::string> output;
  std::optional<std::string> threads;
  OptionTexts<ImpactOptions> impact;            ///< of continuous collisions alone
  OptionTexts<SceneOptions> culling;            ///< of queries that take it
  OptionTexts<PenetrationOptions> penetration;  ///< of queries that take depth
  ReportOptions report;
};

/// What is asked of a scene, whatever the query.
struct SceneQuestion {
  std::optional<double> max_distance;
  PenetrationOptions penetration;
};

/// What a query of a scene found.
struct SceneFound {
  ProximityPairs pairs = {};
  std::vector<Penetration> parts = {};  ///< of penetration: what the pairs are of
  std::string_view kind = "closest";    ///< what the viewer calls the pairs
};

/// A query of `blum proximity`, which is a subcommand. Another query is another row of scene_queries.cpp.
struct SceneQuery {
  std::string_view name;
  std::string_view doc;                ///< for --help
  std::string_view output;             ///< help of --output
  std::string_view examples;           ///< for --help, a line each
  std::string_view max_distance = {};  ///< help of --max-distance; empty if it does not take one
  bool takes_culling = false;
  bool takes_depth = false;  ///< whether options of penetration are for it
  bool takes_frames = true;
  bool has_rows = false;  ///< whether what is printed has a row for each pair, and not for the closest one alone
  /// nullptr: objects move, and answers are no pairs.
  SceneFound (*ask)(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) = nullptr;
};

[[nodiscard]] std::span<const SceneQuery> scene_queries();

/// `continuous`: two files are a mesh at the start and the end of a motion; with --to as run_moving_scene().
void run_continuous_query(const ProximityArguments& a);

/// `continuous` with --to: each file is an object at the start of a motion, and has one at the end.
void run_moving_scene(const ProximityArguments& a);

/// A mesh at the start and the end of a motion.
struct MovingMesh {
  TriangleMesh start;
  std::vector<Vec3d> end;  ///< empty: it rests
};

/// A mesh that rests where both are one path. @throws FileError; FormatError where the files are not one mesh.
[[nodiscard]] MovingMesh read_moving_mesh(const std::filesystem::path& start, const std::filesystem::path& end,
                                          std::optional<double> weld);

/// In what two frames of one motion are not one mesh: "it has 3 vertices, not 4 as"; empty where they are one.
[[nodiscard]] std::string difference(const MeshView& start, const MeshView& end);

/// Any query but continuous: each file is an object.
void run_scene_query(const ProximityArguments& a, const SceneQuery& query);

/// Any query with --frames: the files are those of one object, one after the other.
void run_frames(const ProximityArguments& a, const SceneQuery& query);

/// What files of pairs tell of parts beside their pairs: depth_bound, direction, area, volume, deep_object.
[[nodiscard]] Columns columns_of(std::span<const Penetration> penetrations);

[[nodiscard]] Json penetration_json(const Penetration& part);

/// Names of files: the last parts of their paths, as many as it takes to tell different paths apart.
[[nodiscard]] std::vector<std::string> told_apart(const std::vector<std::string>& files);

/// The names of two objects; "name, itself" of one.
[[nodiscard]] std::string objects_text(const std::vector<std::string>& names, ObjectId first, ObjectId second);

/// A point, where coordinates that are rounding beside a size (mesh units) read 0.
[[nodiscard]] std::string point_text(const Vec3d& point, double size);

/// The most pairs that are written: --limit, or more than there can be. @throws UsageError.
[[nodiscard]] std::size_t read_limit(const ProximityArguments& a);

/// What is said behind a count of pairs where not all are written; else nothing.
[[nodiscard]] std::string limit_text(std::size_t pairs, std::size_t limit);

/// The first collisions in the order of files, of a vertex and a face, then of two edges.
[[nodiscard]] ContinuousCollisions first_of(ContinuousCollisions found, std::size_t limit);
[[nodiscard]] SceneCollisions first_of(SceneCollisions found, std::size_t limit);

/// --limit, for --json: null where it is not given.
[[nodiscard]] inline Json limit_json(const ProximityArguments& a) {
  return a.limit ? Json(read_limit(a)) : Json(nullptr);
}

/// The files that were written, for --json.
[[nodiscard]] inline Json outputs_json(const ProximityArguments& a) {
  return a.output ? Json::array({*a.output}) : Json::array();
}

}  // namespace blum::cli
