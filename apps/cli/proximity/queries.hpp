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
  std::vector<std::string> ends;  ///< only for continuous: one file for each object at the end
  std::string query;              ///< SceneQuery::name
  bool self = false;
  bool frames = false;        ///< true if the files are frames of one object
  bool skip_changed = false;  ///< for frames and continuous: skips steps between different meshes
  std::optional<std::string> max_distance;
  std::optional<std::string> limit;  ///< largest number of pairs to write
  std::optional<std::string> weld;
  std::optional<std::string> output;
  std::optional<std::string> threads;
  OptionTexts<ImpactOptions> impact;            ///< only for continuous collisions
  OptionTexts<SceneOptions> culling;            ///< for queries with takes_culling
  OptionTexts<PenetrationOptions> penetration;  ///< for queries with takes_depth
  ReportOptions report;
};

/// Parameters of any query of a scene.
struct SceneQuestion {
  std::optional<double> max_distance;
  PenetrationOptions penetration;
};

/// Result of a query of a scene.
struct SceneFound {
  ProximityPairs pairs = {};
  std::vector<Penetration> parts = {};  ///< for penetration: one part for each pair
  std::string_view kind = "closest";    ///< name of the pairs in the viewer
};

/// A query, which is a subcommand of `blum proximity`. A row of scene_queries.cpp adds a query.
struct SceneQuery {
  std::string_view name;
  std::string_view doc;                ///< for --help
  std::string_view output;             ///< help of --output
  std::string_view method;             ///< of ProximityScene, in C++ and Python; for --help
  std::string_view examples;           ///< for --help, one per line
  std::string_view max_distance = {};  ///< help of --max-distance; empty if it does not take one
  bool takes_culling = false;
  bool takes_depth = false;  ///< true if it takes the options of penetration
  bool takes_frames = true;
  bool has_rows = false;  ///< true if the summary has a row for each pair
  /// Runs the query. nullptr for continuous, whose objects move and whose results are not pairs.
  SceneFound (*ask)(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) = nullptr;
};

[[nodiscard]] std::span<const SceneQuery> scene_queries();

/// Runs `continuous` for two files: a mesh at the start and at the end of a motion. With --to, calls
/// run_moving_scene().
void run_continuous_query(const ProximityArguments& a);

/// Runs `continuous` with --to: each object has a file at the start and one at the end of a motion.
void run_moving_scene(const ProximityArguments& a);

/// A mesh at the start and the end of a motion.
struct MovingMesh {
  TriangleMesh start;
  std::vector<Vec3d> end;  ///< empty if it rests
};

/// Reads a moving mesh. It rests if both paths are equal. @throws FileError; FormatError if difference() is not empty.
[[nodiscard]] MovingMesh read_moving_mesh(const std::filesystem::path& start, const std::filesystem::path& end,
                                          std::optional<double> weld);

/// Describes how two frames are different meshes: "it has 3 vertices, not 4 like". Empty if only coordinates differ.
[[nodiscard]] std::string difference(const MeshView& start, const MeshView& end);

/// Runs any query except continuous. Each file is an object.
void run_scene_query(const ProximityArguments& a, const SceneQuery& query);

/// Runs any query with --frames. The files are frames of one object, in their order.
void run_frames(const ProximityArguments& a, const SceneQuery& query);

/// Returns the columns that files of pairs have for parts: depth_bound, direction, area, volume, deep_object.
[[nodiscard]] Columns columns_of(std::span<const Penetration> penetrations);

[[nodiscard]] Json penetration_json(const Penetration& part);

/// Returns the names of two objects; "name, itself" if they are the same.
[[nodiscard]] std::string objects_text(const std::vector<std::string>& names, ObjectId first, ObjectId second);

/// Returns a point as text. Coordinates below rounding errors at a size (mesh units) are printed as 0.
[[nodiscard]] std::string point_text(const Vec3d& point, double size);

/// Largest number of rows for pairs, parts or steps in a summary.
inline constexpr std::size_t most_rows = 6;

/// Requires something that objects can meet. @throws UsageError for one object without --self.
void check_objects(const ProximityArguments& a);

/// Returns the largest number of pairs to write: --limit, or a number above any count. @throws UsageError.
[[nodiscard]] std::size_t read_limit(const ProximityArguments& a);

/// Returns the text after a count of pairs if not all are written; else nothing.
[[nodiscard]] std::string limit_text(std::size_t pairs, std::size_t limit);

/// Returns the first collisions in the order of files: of a vertex and a face, then of two edges.
[[nodiscard]] ContinuousCollisions first_of(ContinuousCollisions found, std::size_t limit);
[[nodiscard]] SceneCollisions first_of(SceneCollisions found, std::size_t limit);

/// Returns --limit for --json; null if it is not given.
[[nodiscard]] inline Json limit_json(const ProximityArguments& a) {
  return a.limit ? Json(read_limit(a)) : Json(nullptr);
}

/// Returns the written files for --json.
[[nodiscard]] inline Json outputs_json(const ProximityArguments& a) {
  return a.output ? Json::array({*a.output}) : Json::array();
}

}  // namespace blum::cli
