#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/proximity_io.hpp"
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
  check_objects(a);
  if (a.output) check_extension("--output", *a.output, file_extensions(FileContent::pairs, FileAccess::write));
}

/// Objects of a scene, the query and its results.
struct Answer {
  std::vector<TriangleMesh> meshes;
  SceneQuestion asked;
  ProximityPairs found;
  std::vector<Penetration> parts;  ///< for penetrations: one for each pair of `found`
  std::string_view kind;           ///< name of the kind of pairs
  std::optional<bool> meets;       ///< for the query without pairs
  std::vector<std::string> names;  ///< names of the objects
  PhaseSummary spent;
  int threads = 0;
  std::size_t limit = 0;

  [[nodiscard]] std::vector<MeshView> views() const { return {meshes.begin(), meshes.end()}; }
  /// Returns the closest pair. If several are equally close, it is the first one. Returns nullptr if there are no
  /// pairs.
  [[nodiscard]] const PrimitivePair* closest() const {
    const auto& pairs = found.pairs;
    const auto first = std::min_element(pairs.begin(), pairs.end(), [](const PrimitivePair& p, const PrimitivePair& q) {
      return p.between.distance < q.between.distance;
    });
    return first == pairs.end() ? nullptr : &*first;
  }
  [[nodiscard]] std::optional<double> min_distance() const {
    const PrimitivePair* const pair = closest();
    return pair == nullptr ? std::nullopt : std::optional(pair->between.distance);
  }
};

std::vector<TriangleMesh> read_objects(const std::vector<std::string>& files, std::optional<double> weld) {
  const Unattended reading;
  std::vector<TriangleMesh> meshes;
  meshes.reserve(files.size());
  for (const std::string& file : files) meshes.push_back(read_mesh(file, {weld}));
  return meshes;
}

ProximityScene scene_of(const std::vector<TriangleMesh>& meshes, const ProximityArguments& a,
                        const SceneOptions& culling, const Context& context) {
  ProximityScene scene(culling);
  ObjectOptions options;
  options.self = a.self;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    options.name = a.scene[k];
    scene.add(meshes[k], options, context);
  }
  return scene;
}

FileMetadata metadata_of(const ProximityArguments& a, const Answer& answer) {
  FileMetadata out{{"content", "pairs of primitives"}, {"blum_version", BLUM_VERSION}, {"query", a.query}};
  if (answer.asked.max_distance) out.emplace_back("max_distance", exact_text(*answer.asked.max_distance));
  out.emplace_back("self", a.self ? "true" : "false");
  for (std::size_t k = 0; k < a.scene.size(); ++k) {
    out.emplace_back("object_" + std::to_string(k), answer.names[k]);
  }
  return out;
}

Json objects_json(const ProximityArguments& a, const Answer& answer) {
  Json json = Json::array();
  for (std::size_t k = 0; k < a.scene.size(); ++k) {
    const TriangleMesh& mesh = answer.meshes[k];
    json.push_back({{"file", a.scene[k]},
                    {"vertices", mesh.vertices.size()},
                    {"triangles", mesh.triangles.size()},
                    {"segments", mesh.segments.size()},
                    {"points", mesh.points.size()}});
  }
  return json;
}

Json closest_json(const Answer& answer) {
  const PrimitivePair* pair = answer.closest();
  if (pair == nullptr) return nullptr;
  return {{"distance", pair->between.distance},
          {"object", {pair->first_object.value, pair->second_object.value}},
          {"primitive", {pair->first, pair->second}},
          {"point", {to_json(pair->between.first_point), to_json(pair->between.second_point)}}};
}

/// Returns the answer of a query without pairs.
Json yes_or_no_json(const ProximityArguments& a, const Answer& answer) {
  return answer_json("proximity", {{"query", a.query},
                                   {"objects", objects_json(a, answer)},
                                   {"self", a.self},
                                   {"meets", *answer.meets},
                                   {"seconds", answer.spent.seconds},
                                   {"total_seconds", answer.spent.total},
                                   {"peak_memory_bytes", peak_memory()},
                                   {"threads", answer.threads},
                                   {"outputs", outputs_json(a)}});
}

Json json_of(const ProximityArguments& a, const Answer& answer) {
  if (answer.meets) return yes_or_no_json(a, answer);
  Json parts = Json::array();
  for (const Penetration& part : answer.parts) parts.push_back(penetration_json(part));
  return answer_json("proximity", {{"query", a.query},
                                   {"objects", objects_json(a, answer)},
                                   {"self", a.self},
                                   {"max_distance", to_json(answer.asked.max_distance)},
                                   {"object_pairs", answer.found.report.object_pairs},
                                   {"pairs", answer.found.pairs.size()},
                                   {"min_distance", to_json(answer.min_distance())},
                                   {"closest", closest_json(answer)},
                                   {"penetrations", parts},
                                   {"culling", to_json(answer.found.report.culling)},
                                   {"cells", answer.found.report.cells},
                                   {"left_over", answer.found.report.left_over},
                                   {"candidates", answer.found.report.candidates},
                                   {"exact_tests", answer.found.report.exact_tests},
                                   {"seconds", answer.spent.seconds},
                                   {"total_seconds", answer.spent.total},
                                   {"peak_memory_bytes", peak_memory()},
                                   {"threads", answer.threads},
                                   {"limit", limit_json(a)},
                                   {"outputs", outputs_json(a)}});
}

/// Returns the largest magnitude of all coordinates, mesh units.
double largest(const std::vector<TriangleMesh>& meshes) {
  double out = 0;
  for (const TriangleMesh& mesh : meshes) {
    for (const Vec3d& p : mesh.vertices) out = std::max({out, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return out;
}

std::string distance_text(const PrimitivePair& pair, double size) {
  const TriangleDistance& between = pair.between;
  if (between.distance < 0) {
    return rounded_text(between.distance) + ": they overlap, from " + point_text(between.first_point, size) + " to " +
           point_text(between.second_point, size);
  }
  if (between.distance == 0) return "distance 0: they touch or overlap near " + point_text(between.first_point, size);
  return "distance " + rounded_text(between.distance) + ", from " + point_text(between.first_point, size) + " to " +
         point_text(between.second_point, size);
}

std::string penetration_text(const Penetration& part, const std::vector<std::string>& names, double size) {
  // Error of the direction: it is the difference of two rounded points, divided by their distance.
  const double blur = std::clamp(size / part.depth, 1.0, 1e6);
  const std::string& first = names[part.first_object.value];
  const std::string& second = names[part.second_object.value];
  const std::string depth = rounded_text(part.depth);
  const std::string bound = rounded_text(part.depth_bound);
  const std::string deep_point = point_text(part.deep_point, size);
  const bool is_self = part.first_object == part.second_object;
  const std::string moved = is_self ? "its surface at " + deep_point : first;
  const std::string result = is_self              ? "this point onto another part of the surface"
                             : part.is_first_deep ? "its point " + deep_point + " onto the surface of " + second
                                                  : "its surface to the point " + deep_point + " of " + second;
  return "depth " + (depth == bound ? depth : "between " + depth + " and " + bound) + "; moving " + moved + " by " +
         depth + " along " + point_text(part.direction, blur) + " brings " + result + "; volume of the common region " +
         rounded_text(part.volume);
}

std::string object_text(const Answer& answer, const PrimitivePair& pair) {
  return objects_text(answer.names, pair.first_object, pair.second_object);
}

/// Adds a row for each region that two objects have in common.
void add_penetrations(const Answer& answer, TextTable& table) {
  const double size = largest(answer.meshes);
  for (std::size_t k = 0; k < std::min(answer.parts.size(), most_rows); ++k) {
    table.add(object_text(answer, answer.found.pairs[k]), penetration_text(answer.parts[k], answer.names, size));
  }
  if (answer.parts.size() > most_rows) {
    table.add("...", plural(answer.parts.size() - most_rows, "region", "regions") + " more: --json FILE lists all");
  }
}

/// Adds a row for each pair of objects.
void add_separations(const Answer& answer, TextTable& table) {
  const double size = largest(answer.meshes);
  const auto& pairs = answer.found.pairs;
  for (std::size_t k = 0; k < std::min(pairs.size(), most_rows); ++k) {
    table.add(object_text(answer, pairs[k]), distance_text(pairs[k], size));
  }
  if (pairs.size() > most_rows) {
    table.add("...", plural(pairs.size() - most_rows, "pair", "pairs") + " more: -o PAIRS lists all");
  }
}

std::string scene_text(const Answer& answer) {
  std::size_t triangles = 0;
  std::size_t others = 0;
  for (const TriangleMesh& mesh : answer.meshes) {
    triangles += mesh.triangles.size();
    others += mesh.segments.size() + mesh.points.size();
  }
  return plural(answer.meshes.size(), "object", "objects") + ", " + plural(triangles, "triangle", "triangles") +
         (others > 0 ? ", " + plural(others, "segment or point", "segments and points") : "");
}

std::string found_text(const Answer& answer, bool has_rows) {
  if (answer.meets) return *answer.meets ? "yes: primitives meet" : "no: no two primitives meet";
  if (answer.kind == "penetration") {
    return answer.parts.empty() ? "none: no two solids overlap"
                                : plural(answer.parts.size(), "common region", "common regions");
  }
  const bool meet = answer.kind == "collision";
  const char* const one = meet ? "pair of primitives that meets" : has_rows ? "pair of objects" : "pair of primitives";
  const char* const many = meet       ? "pairs of primitives that meet"
                           : has_rows ? "pairs of objects"
                                      : "pairs of primitives";
  const auto meets = [](const PrimitivePair& pair) { return pair.between.distance <= 0; };
  const auto meeting =
      static_cast<std::size_t>(std::count_if(answer.found.pairs.begin(), answer.found.pairs.end(), meets));
  return plural(answer.found.pairs.size(), one, many) +
         (answer.asked.max_distance && !meet ? " within " + rounded_text(*answer.asked.max_distance) : "") +
         (has_rows ? "; " + plural(meeting, "pair meets", "pairs meet") : "");
}

TextTable table_of(const ProximityArguments& a, const SceneQuery& query, const Answer& answer) {
  TextTable table;
  table.add("found",
            found_text(answer, query.has_rows) + (a.output ? limit_text(answer.found.pairs.size(), answer.limit) : ""));
  if (answer.kind == "penetration") {
    add_penetrations(answer, table);
  } else if (query.has_rows) {
    add_separations(answer, table);
  } else if (const PrimitivePair* closest = answer.closest(); closest != nullptr) {
    table.add("closest", object_text(answer, *closest) + ": " + distance_text(*closest, largest(answer.meshes)));
  }
  table.add("input", scene_text(answer));
  if (answer.kind != "penetration" && !answer.meets)
    table.detail("tests", count_text(answer.found.report.exact_tests) + " exact ones, of " +
                              count_text(answer.found.report.candidates) + " candidates in " +
                              plural(answer.found.report.object_pairs, "pair of objects", "pairs of objects"));
  if (a.output) table.add("wrote", *a.output);
  answer.spent.add_to(table);
  return table;
}

void write(const ProximityArguments& a, const Answer& answer, const Context& context) {
  const std::span<const PrimitivePair> pairs = answer.found.pairs;
  const std::size_t count = std::min(pairs.size(), answer.limit);
  const std::span<const Penetration> parts = answer.parts;
  const Columns more = answer.kind == "penetration" ? columns_of(parts.first(count)) : Columns();
  write_proximity_pairs(*a.output, pairs.first(count), answer.views(), metadata_of(a, answer), more, context);
}

}  // namespace

void run_scene_query(const ProximityArguments& a, const SceneQuery& query) {
  check(a);
  Answer answer;
  const SceneOptions culling = a.culling.read();
  check(culling);
  answer.asked.penetration = a.penetration.read();
  check(answer.asked.penetration);
  if (a.max_distance) answer.asked.max_distance = parse_non_negative("--max-distance", *a.max_distance);
  answer.limit = read_limit(a);
  answer.names = distinct_names(a.scene);
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  if (a.output) outputs.emplace_back(*a.output);
  check_outputs(outputs, {a.scene.begin(), a.scene.end()});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  answer.meshes = read_objects(a.scene, weld);
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const ProximityScene scene = scene_of(answer.meshes, a, culling, context);
  phases.push_back({"build", watch.lap()});
  SceneFound found = ask(query, scene, answer.asked, context);
  answer.found = std::move(found.pairs);
  answer.parts = std::move(found.parts);
  answer.kind = found.kind;
  answer.meets = found.meets;
  phases.insert(phases.end(), answer.found.report.phases.begin(), answer.found.report.phases.end());
  static_cast<void>(watch.lap());
  if (a.output) {
    write(a, answer, context);
    phases.push_back({"write", watch.lap()});
  }
  progress.clear();
  answer.spent = summarize(phases);
  answer.threads = thread_count(context);
  report(a.report, json_of(a, answer), table_of(a, query, answer));
}

}  // namespace blum::cli
