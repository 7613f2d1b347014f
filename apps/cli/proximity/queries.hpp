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
#include "blum/proximity/first_contact.hpp"
#include "blum/proximity/impact.hpp"
#include "blum/proximity/scene.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/summary.hpp"

namespace blum::cli {

struct ProximityArguments {
  std::vector<std::string> scene;
  std::vector<std::string> ends;  ///< for `continuous` only: for each object, its file at the end of the motion
  std::string query;              ///< name of the query, see SceneQuery::name
  bool self = false;
  bool frames = false;        ///< true if the files are frames of one object
  bool first = false;         ///< for `continuous` only: true to find the first contact alone
  bool skip_changed = false;  ///< for frames and `continuous`: true to skip steps between different meshes
  std::optional<std::string> max_distance;
  std::optional<std::string> limit;  ///< largest number of pairs that are written
  std::optional<std::string> weld;
  std::optional<std::string> output;
  std::optional<std::string> threads;
  OptionTexts<ImpactOptions> impact;            ///< for `continuous` only
  OptionTexts<SceneOptions> culling;            ///< for queries with takes_culling set
  OptionTexts<PenetrationOptions> penetration;  ///< for queries with takes_depth set
  ReportOptions report;
};

/// Parameters of a query of a scene, for all queries.
struct SceneQuestion {
  std::optional<double> max_distance;
  PenetrationOptions penetration;
};

/// Result of a query of a scene.
struct SceneFound {
  ProximityPairs pairs = {};
  std::vector<Penetration> parts = {};  ///< for the query of penetrations: one entry for each pair
  std::string_view kind = "closest";    ///< name for the pairs in the viewer
  std::optional<bool> meets = {};       ///< the answer of a query without pairs
};

/// Query: a subcommand of `blum proximity`. To add a query, add a row in scene_queries.cpp.
struct SceneQuery {
  std::string_view name;
  std::string_view doc;                ///< description for --help
  std::string_view output = {};        ///< help text of --output
  std::string_view method;             ///< method of ProximityScene in C++ and Python, for --help
  std::string_view examples;           ///< for --help, one per line
  std::string_view max_distance = {};  ///< help text of --max-distance; empty if the query does not take it
  bool takes_culling = false;
  bool takes_depth = false;  ///< true if the query takes the options of penetration
  bool takes_frames = true;
  bool has_rows = false;  ///< True if the summary has a row for each pair.
  bool has_pairs = true;  ///< False if the answer is yes or no.
  /// True if objects move during the query. Its results are then not pairs at rest.
  bool moves = false;
  /// Runs the query. nullptr if `method` is one of pair_queries(), or if objects move.
  SceneFound (*ask)(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) = nullptr;
};

/// Runs a query whose objects do not move. @throws as the method of ProximityScene.
[[nodiscard]] SceneFound ask(const SceneQuery& query, const ProximityScene& scene, const SceneQuestion& asked,
                             const Context& context);

[[nodiscard]] std::span<const SceneQuery> scene_queries();

/// Runs `continuous` for two files: one mesh at the start and at the end of its motion. If --to is given, calls
/// run_moving_scene().
void run_continuous_query(const ProximityArguments& a);

/// Runs `continuous` with --to. Each object has two files: at the start and at the end of its motion.
void run_moving_scene(const ProximityArguments& a);

/// Mesh at the start and at the end of a motion.
struct MovingMesh {
  TriangleMesh start;
  std::vector<Vec3d> end;  ///< vertices at the end; empty if the mesh rests
};

/// Reads a moving mesh. It rests if both paths are equal. @throws FileError; FormatError if difference() returns a
/// text.
[[nodiscard]] MovingMesh read_moving_mesh(const std::filesystem::path& start, const std::filesystem::path& end,
                                          std::optional<double> weld);

/// If two frames are different meshes, describes the difference: "it has 3 vertices, not 4 like". Returns an empty text
/// if only coordinates differ.
[[nodiscard]] std::string difference(const MeshView& start, const MeshView& end);

/// Runs any query except `continuous`. Each file is one object.
void run_scene_query(const ProximityArguments& a, const SceneQuery& query);

/// Adds the subcommand `translation`, which takes two solids.
void add_translation_query(const Command& parent);

/// Runs any query with --frames. The files are the frames of one object, in the given order.
void run_frames(const ProximityArguments& a, const SceneQuery& query);

/// Returns the columns for penetrations in files of pairs: depth_bound, direction, area, volume, deep_object.
[[nodiscard]] Columns columns_of(std::span<const Penetration> penetrations);

[[nodiscard]] Json penetration_json(const Penetration& part);

/// Returns the names of two objects as text. If both are the same object, it is "name, itself".
[[nodiscard]] std::string objects_text(const std::vector<std::string>& names, ObjectId first, ObjectId second);

/// Returns a first contact as text: "at time 0.25: vertex 3 of a.ply, face 7 of b.ply", or "none".
/// @param names  of the objects.
[[nodiscard]] std::string contact_text(const std::optional<FirstContact>& contact,
                                       const std::vector<std::string>& names);

/// Returns a first contact for --json; null if nothing meets, or if --first is not given.
[[nodiscard]] Json contact_json(const std::optional<FirstContact>& contact);

/// Largest number of rows in a summary for pairs, parts or steps.
inline constexpr std::size_t most_rows = 6;

/// Checks that there is something to query. @throws UsageError if there is only one object and --self is not given.
void check_objects(const ProximityArguments& a);

/// Returns the largest number of pairs to write: --limit, or a number that no count exceeds. @throws UsageError.
[[nodiscard]] std::size_t read_limit(const ProximityArguments& a);

/// If not all pairs are written, returns the text that follows their number; otherwise an empty text.
[[nodiscard]] std::string limit_text(std::size_t pairs, std::size_t limit);

/// Returns the first `limit` collisions in the order of files: first those of a vertex and a face, then those of two
/// edges.
[[nodiscard]] ContinuousCollisions first_of(ContinuousCollisions found, std::size_t limit);
[[nodiscard]] SceneCollisions first_of(SceneCollisions found, std::size_t limit);

/// Returns the value of --limit for --json; null if the option is not given.
[[nodiscard]] inline Json limit_json(const ProximityArguments& a) {
  return a.limit ? Json(read_limit(a)) : Json(nullptr);
}

/// Returns a number of tests for --json; null with --first, which does not count them.
[[nodiscard]] inline Json count_json(const ProximityArguments& a, std::size_t count) {
  return a.first ? Json(nullptr) : Json(count);
}

/// Returns the paths of the written files for --json.
[[nodiscard]] inline Json outputs_json(const ProximityArguments& a) {
  return a.output ? Json::array({*a.output}) : Json::array();
}

}  // namespace blum::cli
