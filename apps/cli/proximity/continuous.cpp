#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/io/collision_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

void check(const ProximityArguments& a) {
  if (a.scene.size() != 2) {
    throw UsageError("continuous takes two files, the mesh at the start and at the end of a motion, but " +
                     plural(a.scene.size(), "is", "are") +
                     " given; for several objects, give their files at the end with --to");
  }
  if (!a.self) {
    throw UsageError("one mesh can only meet itself; add --self, or --to END... if the files are different objects");
  }
  if (a.output) check_extension("--output", *a.output, file_extensions(FileContent::collisions, FileAccess::write));
}

/// Collisions of one mesh between two frames.
struct Answer {
  MovingMesh mesh;
  ImpactOptions options;
  ContinuousCollisions found;
  std::optional<FirstContact> first;  ///< for --first only
  PhaseSummary spent;
  int threads = 0;
  std::size_t limit = 0;
};

/// Returns the collisions of a mesh in which only one pair of features meets.
ContinuousCollisions collisions_of_mesh(const FirstContact& contact) {
  SceneCollisions scene = collisions_of(contact);
  ContinuousCollisions out;
  out.vertex_face = std::move(scene.objects.front().vertex_face);
  out.edge_edge = std::move(scene.objects.front().edge_edge);
  return out;
}

void write(const ProximityArguments& a, const Answer& answer, const Context& context) {
  const ContinuousCollisions& found = answer.found;
  const FileMetadata metadata{{"content", "continuous collisions"},
                              {"blum_version", BLUM_VERSION},
                              {"start", fs::path(a.scene[0]).filename().string()},
                              {"end", fs::path(a.scene[1]).filename().string()},
                              {"tolerance", exact_text(answer.options.tolerance)},
                              {"min_separation", exact_text(answer.options.min_separation)}};
  const bool is_all = found.vertex_face.size() + found.edge_edge.size() <= answer.limit;
  const MeshMotion mesh(answer.mesh.start, answer.mesh.end);
  write_collisions(*a.output, is_all ? found : first_of(found, answer.limit), mesh, metadata, context);
}

Json json_of(const ProximityArguments& a, const Answer& answer) {
  const ContinuousCollisions& found = answer.found;
  return answer_json("proximity", {{"scene", a.scene},
                                   {"query", a.query},
                                   {"vertices", answer.mesh.start.vertices.size()},
                                   {"triangles", answer.mesh.start.triangles.size()},
                                   {"tolerance", answer.options.tolerance},
                                   {"min_separation", answer.options.min_separation},
                                   {"vertex_face", found.vertex_face.size()},
                                   {"edge_edge", found.edge_edge.size()},
                                   {"earliest", to_json(found.earliest())},
                                   {"first_contact", contact_json(answer.first)},
                                   {"box_pairs", count_json(a, found.box_pairs)},
                                   {"exact_tests", count_json(a, found.exact_tests)},
                                   {"seconds", answer.spent.seconds},
                                   {"total_seconds", answer.spent.total},
                                   {"peak_memory_bytes", peak_memory()},
                                   {"threads", answer.threads},
                                   {"warnings", to_json(start_warnings(answer.found))},
                                   {"limit", limit_json(a)},
                                   {"outputs", outputs_json(a)}});
}

TextTable table_of(const ProximityArguments& a, const Answer& answer) {
  const TriangleMesh& mesh = answer.mesh.start;
  const ContinuousCollisions& found = answer.found;
  const auto first = found.earliest();
  const std::size_t count = found.vertex_face.size() + found.edge_edge.size();
  TextTable table;
  if (a.first) {
    table.add("first contact", contact_text(answer.first, {a.scene[0]}));
  } else {
    table.add("collisions", plural(found.vertex_face.size(), "of a vertex and a face", "of a vertex and a face") +
                                ", " + plural(found.edge_edge.size(), "of two edges", "of two edges") +
                                (first ? "; the first at time " + rounded_text(*first) : "") +
                                (a.output ? limit_text(count, answer.limit) : ""));
  }
  table.add("input", a.scene[0] + " to " + a.scene[1] + ": " + plural(mesh.vertices.size(), "vertex", "vertices") +
                         ", " + plural(mesh.triangles.size(), "triangle", "triangles"));
  if (!a.first) {
    table.detail("tests", count_text(found.exact_tests) + " exact ones, of " + count_text(found.box_pairs) +
                              " pairs whose moving boxes touch");
  }
  if (a.output) table.add("wrote", *a.output);
  answer.spent.add_to(table);
  return table;
}

}  // namespace

std::string difference(const MeshView& start, const MeshView& end) {
  const auto other_count = [](std::size_t one, std::size_t other, const char* what) {
    return "it has " + count_text(other) + " " + what + ", not " + count_text(one) + " like";
  };
  if (start.vertices.size() != end.vertices.size()) {
    return other_count(start.vertices.size(), end.vertices.size(), "vertices");
  }
  if (start.triangles.size() != end.triangles.size()) {
    return other_count(start.triangles.size(), end.triangles.size(), "triangles");
  }
  const bool is_same =
      std::equal(start.triangles.begin(), start.triangles.end(), end.triangles.begin()) &&
      std::equal(start.segments.begin(), start.segments.end(), end.segments.begin(), end.segments.end()) &&
      std::equal(start.points.begin(), start.points.end(), end.points.begin(), end.points.end());
  return is_same ? "" : "its triangles, segments or points have other corners than those of";
}

MovingMesh read_moving_mesh(const fs::path& start, const fs::path& end, std::optional<double> weld) {
  const Unattended reading;
  MovingMesh mesh{read_mesh(start, {weld}), {}};
  if (end == start) return mesh;
  TriangleMesh last = read_mesh(end, {weld});
  if (const std::string what = difference(mesh.start, last); !what.empty()) {
    throw FormatError(
        "'" + end.string() + "': " + what + " '" + start.string() +
        "': frames of one motion need equal numbers of vertices, and the same triangles in the same order");
  }
  mesh.end = std::move(last.vertices);
  return mesh;
}

void run_continuous_query(const ProximityArguments& a) {
  if (!a.ends.empty()) {
    run_moving_scene(a);
    return;
  }
  check(a);
  const fs::path start = a.scene[0];
  const fs::path end = a.scene[1];
  Answer answer;
  answer.options = a.impact.read();
  check(answer.options);
  answer.limit = read_limit(a);
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  if (a.output) outputs.emplace_back(*a.output);
  check_outputs(outputs, {start, end});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  std::vector<PhaseTime> phases;
  answer.mesh = read_moving_mesh(start, end, weld);
  phases.push_back({"read", watch.lap()});
  const std::vector<Vec3d>& last = answer.mesh.end.empty() ? answer.mesh.start.vertices : answer.mesh.end;
  if (a.first) {
    answer.first = first_contact(answer.mesh.start, last, answer.options, context);
    if (answer.first) answer.found = collisions_of_mesh(*answer.first);
    phases.push_back({"first contact", watch.lap()});
  } else {
    answer.found = continuous_collisions(answer.mesh.start, last, answer.options, context);
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
