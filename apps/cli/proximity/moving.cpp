#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/io/collision_io.hpp"
#include "blum/proximity/scene.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

void check(const ProximityArguments& a) {
  if (a.ends.size() != a.scene.size()) {
    throw UsageError(
        "--to has " + plural(a.ends.size(), "file", "files") + ", but " +
        plural(a.scene.size(), "object is", "objects are") +
        " given; give one file for each object, in the same order, and for an object at rest repeat its first file");
  }
  check_objects(a);
  if (a.output) check_extension("--output", *a.output, file_extensions(FileContent::collisions, FileAccess::write));
}

/// Objects of a scene, and their collisions.
struct Answer {
  std::vector<MovingMesh> meshes;
  ImpactOptions options;
  SceneCollisions found;
  std::optional<FirstContact> first;  ///< for --first only
  std::vector<std::string> names;     ///< one per object
  PhaseSummary spent;
  int threads = 0;
  std::size_t limit = 0;

  [[nodiscard]] std::size_t moving() const {
    return static_cast<std::size_t>(
        std::count_if(meshes.begin(), meshes.end(), [](const MovingMesh& mesh) { return !mesh.end.empty(); }));
  }
};

std::vector<MovingMesh> read_objects(const ProximityArguments& a) {
  std::vector<MovingMesh> meshes;
  meshes.reserve(a.scene.size());
  const std::optional<double> weld = parse_weld(a.weld);
  for (std::size_t k = 0; k < a.scene.size(); ++k) meshes.push_back(read_moving_mesh(a.scene[k], a.ends[k], weld));
  return meshes;
}

ProximityScene scene_of(const std::vector<MovingMesh>& meshes, const ProximityArguments& a, const Context& context) {
  ProximityScene scene;
  ObjectOptions options;
  options.self = a.self;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    options.name = a.scene[k];
    scene.add(meshes[k].start, options, context);
  }
  return scene;
}

std::vector<ObjectMotion> motions_of(const std::vector<MovingMesh>& meshes) {
  std::vector<ObjectMotion> motions;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    if (meshes[k].end.empty()) continue;
    ObjectMotion& motion = motions.emplace_back();
    motion.object = ObjectId(static_cast<std::uint32_t>(k));
    motion.vertices = meshes[k].end;
  }
  return motions;
}

/// For two objects: the numbers of colliding pairs of their features, and the time of the first collision.
struct PairSummary {
  std::size_t vertex_face = 0;
  std::size_t edge_edge = 0;
  std::optional<double> earliest;

  [[nodiscard]] std::size_t count() const { return vertex_face + edge_edge; }
};

PairSummary summary_of(const ObjectCollisions& pair) {
  return {pair.vertex_face.size() + pair.face_vertex.size(), pair.edge_edge.size(), pair.earliest()};
}

/// Adds up the collisions of all pairs of objects.
PairSummary summary_of(const SceneCollisions& found) {
  PairSummary out{0, 0, found.earliest()};
  for (const ObjectCollisions& pair : found.objects) {
    out.vertex_face += pair.vertex_face.size() + pair.face_vertex.size();
    out.edge_edge += pair.edge_edge.size();
  }
  return out;
}

FileMetadata metadata_of(const ProximityArguments& a, const Answer& answer) {
  FileMetadata out{{"content", "continuous collisions"},
                   {"blum_version", BLUM_VERSION},
                   {"self", a.self ? "true" : "false"},
                   {"tolerance", exact_text(answer.options.tolerance)},
                   {"min_separation", exact_text(answer.options.min_separation)}};
  const std::vector<std::string> ends = distinct_names(a.ends);
  for (std::size_t k = 0; k < a.scene.size(); ++k) {
    out.emplace_back("object_" + std::to_string(k), answer.names[k]);
    out.emplace_back("end_" + std::to_string(k), ends[k]);
  }
  return out;
}

Json objects_json(const ProximityArguments& a, const Answer& answer) {
  Json json = Json::array();
  for (std::size_t k = 0; k < a.scene.size(); ++k) {
    const MovingMesh& mesh = answer.meshes[k];
    json.push_back({{"file", a.scene[k]},
                    {"end", a.ends[k]},
                    {"moves", !mesh.end.empty()},
                    {"vertices", mesh.start.vertices.size()},
                    {"triangles", mesh.start.triangles.size()},
                    {"segments", mesh.start.segments.size()},
                    {"points", mesh.start.points.size()}});
  }
  return json;
}

Json pairs_json(const SceneCollisions& found) {
  Json json = Json::array();
  for (const ObjectCollisions& pair : found.objects) {
    const PairSummary summary = summary_of(pair);
    json.push_back({{"object", {pair.first.value, pair.second.value}},
                    {"vertex_face", summary.vertex_face},
                    {"edge_edge", summary.edge_edge},
                    {"earliest", to_json(summary.earliest)}});
  }
  return json;
}

Json json_of(const ProximityArguments& a, const Answer& answer) {
  const PairSummary all = summary_of(answer.found);
  return answer_json("proximity", {{"query", a.query},
                                   {"objects", objects_json(a, answer)},
                                   {"self", a.self},
                                   {"tolerance", answer.options.tolerance},
                                   {"min_separation", answer.options.min_separation},
                                   {"vertex_face", all.vertex_face},
                                   {"edge_edge", all.edge_edge},
                                   {"earliest", to_json(all.earliest)},
                                   {"pairs", pairs_json(answer.found)},
                                   {"first_contact", contact_json(answer.first)},
                                   {"box_pairs", count_json(a, answer.found.box_pairs)},
                                   {"exact_tests", count_json(a, answer.found.exact_tests)},
                                   {"seconds", answer.spent.seconds},
                                   {"total_seconds", answer.spent.total},
                                   {"peak_memory_bytes", peak_memory()},
                                   {"threads", answer.threads},
                                   {"warnings", to_json(start_warnings(answer.found))},
                                   {"limit", limit_json(a)},
                                   {"outputs", outputs_json(a)}});
}

std::string collisions_text(const PairSummary& pair) {
  return plural(pair.vertex_face, "of a vertex and a face", "of a vertex and a face") + ", " +
         plural(pair.edge_edge, "of two edges", "of two edges") +
         (pair.earliest ? "; the first at time " + rounded_text(*pair.earliest) : "");
}

TextTable table_of(const ProximityArguments& a, const Answer& answer) {
  std::size_t triangles = 0;
  for (const MovingMesh& mesh : answer.meshes) triangles += mesh.start.triangles.size();
  const auto& pairs = answer.found.objects;
  TextTable table;
  const PairSummary all = summary_of(answer.found);
  if (a.first) {
    table.add("first contact", contact_text(answer.first, answer.names));
  } else {
    table.add("collisions", collisions_text(all) + (a.output ? limit_text(all.count(), answer.limit) : ""));
  }
  for (std::size_t k = 0; !a.first && k < std::min(pairs.size(), most_rows); ++k) {
    table.add(objects_text(answer.names, pairs[k].first, pairs[k].second), collisions_text(summary_of(pairs[k])));
  }
  if (pairs.size() > most_rows) {
    table.add("...", plural(pairs.size() - most_rows, "pair", "pairs") + " of objects more: --json FILE lists all");
  }
  table.add("input", plural(answer.meshes.size(), "object", "objects") + ", of which " +
                         plural(answer.moving(), "moves", "move") + "; " + plural(triangles, "triangle", "triangles"));
  if (!a.first) {
    table.detail("tests", count_text(answer.found.exact_tests) + " exact ones, of " +
                              count_text(answer.found.box_pairs) + " pairs whose moving boxes touch");
  }
  if (a.output) table.add("wrote", *a.output);
  answer.spent.add_to(table);
  return table;
}

void write(const ProximityArguments& a, const Answer& answer, const Context& context) {
  std::vector<MeshMotion> objects;
  for (const MovingMesh& mesh : answer.meshes) objects.emplace_back(mesh.start, mesh.end);
  const bool is_all = summary_of(answer.found).count() <= answer.limit;
  write_collisions(*a.output, is_all ? answer.found : first_of(answer.found, answer.limit), objects,
                   metadata_of(a, answer), context);
}

}  // namespace

void run_moving_scene(const ProximityArguments& a) {
  check(a);
  Answer answer;
  answer.options = a.impact.read();
  check(answer.options);
  answer.limit = read_limit(a);
  answer.names = distinct_names(a.scene);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  if (a.output) outputs.emplace_back(*a.output);
  std::vector<fs::path> inputs(a.scene.begin(), a.scene.end());
  inputs.insert(inputs.end(), a.ends.begin(), a.ends.end());
  check_outputs(outputs, inputs);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  answer.meshes = read_objects(a);
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const ProximityScene scene = scene_of(answer.meshes, a, context);
  phases.push_back({"build", watch.lap()});
  if (a.first) {
    answer.first = scene.first_contact(motions_of(answer.meshes), answer.options, context);
    if (answer.first) answer.found = collisions_of(*answer.first);
    phases.push_back({"first contact", watch.lap()});
  } else {
    answer.found = scene.continuous(motions_of(answer.meshes), answer.options, context);
  }
  phases.insert(phases.end(), answer.found.phases.begin(), answer.found.phases.end());
  static_cast<void>(watch.lap());
  if (a.output) {
    write(a, answer, context);
    phases.push_back({"write", watch.lap()});
  }
  progress.clear();
  answer.spent = summarize(phases);
  answer.threads = thread_count(context);
  report(a.report, json_of(a, answer), table_of(a, answer));
  if (!a.report.quiet) warn(start_warnings(answer.found));
}

}  // namespace blum::cli
