#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/io/collision_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "commands.hpp"
#include "common_options.hpp"
#include "described.hpp"
#include "files.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum proximity cloth1.ply cloth2.ply --query continuous --self -o pairs.npz
                                         all pairs of a vertex and a face, or of two edges, that meet between two frames
  blum proximity cloth1.ply cloth2.ply --query continuous --self -o pairs.csv --min-separation 1e-3
                                         all that come as close as that)";

struct Arguments {
  std::vector<std::string> scene;
  std::string query = "continuous";
  bool self = false;
  std::string output;
  std::optional<std::string> threads;
  OptionTexts<ImpactOptions> options;
  ReportOptions report;
};

/// A mesh in two frames.
struct Frames {
  TriangleMesh start;
  std::vector<Vec3d> end;
};

Frames read_frames(const fs::path& start, const fs::path& end) {
  const Unattended reading;
  Frames frames{read_mesh(start), {}};
  TriangleMesh last = read_mesh(end);
  const auto refuse = [&](const std::string& what) {
    throw FormatError("'" + end.string() + "': " + what + " '" + start.string() +
                      "': frames of one motion have the same " + "vertices and triangles, in the same order");
  };
  if (last.vertices.size() != frames.start.vertices.size()) {
    refuse("it has " + count_text(last.vertices.size()) + " vertices, not " + count_text(frames.start.vertices.size()) +
           " as");
  }
  if (last.triangles != frames.start.triangles || last.segments != frames.start.segments ||
      last.points != frames.start.points) {
    refuse("its triangles, segments or points name other vertices than those of");
  }
  frames.end = std::move(last.vertices);
  return frames;
}

void check(const Arguments& a) {
  if (a.query != "continuous") throw UsageError("--query is '" + a.query + "', but must be continuous");
  if (a.scene.size() != 2) {
    throw UsageError("--query continuous takes two files, the mesh at the start and at the end of a motion, but " +
                     plural(a.scene.size(), "is", "are") + " given");
  }
  if (!a.self) throw UsageError("one mesh has nothing to meet but itself: give --self");
  check_extension("--output", a.output, collision_extensions());
}

void run(const Arguments& a) {
  check(a);
  const fs::path start = a.scene[0];
  const fs::path end = a.scene[1];
  const fs::path output = a.output;
  const ImpactOptions options = a.options.read();
  check(options);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, {start, end});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  std::vector<PhaseTime> phases;
  const Frames frames = read_frames(start, end);
  phases.push_back({"read", watch.lap()});
  const ContinuousCollisions found = continuous_collisions(frames.start, frames.end, options, context);
  phases.insert(phases.end(), found.phases.begin(), found.phases.end());
  static_cast<void>(watch.lap());
  write_collisions(output, found, frames.start,
                   {{"content", "continuous collisions"},
                    {"blum_version", BLUM_VERSION},
                    {"start", start.filename().string()},
                    {"end", end.filename().string()},
                    {"tolerance", exact_text(options.tolerance)},
                    {"min_separation", exact_text(options.min_separation)}},
                   context);
  phases.push_back({"write", watch.lap()});
  progress.clear();

  const PhaseSummary spent = summarize(phases);
  const Json json = answer_json("proximity", {{"scene", a.scene},
                                              {"query", a.query},
                                              {"vertices", frames.start.vertices.size()},
                                              {"triangles", frames.start.triangles.size()},
                                              {"tolerance", options.tolerance},
                                              {"min_separation", options.min_separation},
                                              {"vertex_face", found.vertex_face.size()},
                                              {"edge_edge", found.edge_edge.size()},
                                              {"earliest", to_json(found.earliest())},
                                              {"box_pairs", found.box_pairs},
                                              {"exact_tests", found.exact_tests},
                                              {"seconds", spent.seconds},
                                              {"total_seconds", spent.total},
                                              {"peak_memory_bytes", peak_memory()},
                                              {"threads", thread_count(context)},
                                              {"outputs", {output.string()}}});
  TextTable table;
  table.add("scene", start.string() + " to " + end.string() + ": " +
                         plural(frames.start.vertices.size(), "vertex", "vertices") + ", " +
                         plural(frames.start.triangles.size(), "triangle", "triangles"));
  const auto first = found.earliest();
  table.add("collisions", plural(found.vertex_face.size(), "vertex and face", "of a vertex and a face") + ", " +
                              plural(found.edge_edge.size(), "of two edges", "of two edges") +
                              (first ? "; the first at time " + rounded_text(*first) : ""));
  table.add("tests", count_text(found.exact_tests) + " exact ones, of " + count_text(found.box_pairs) +
                         " pairs whose moving boxes touch");
  table.add("wrote", output.string());
  table.add("time", spent.text + ", " + bytes_text(static_cast<double>(peak_memory())) + " at most");
  report(a.report, json, table.text());
}

}  // namespace

void add_proximity_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = line.app.add_subcommand("proximity", "Collisions of a mesh that moves, exactly");
  command->add_option("SCENE", a->scene, "Frames of a mesh: " + extensions_help({FileContent::mesh}, FileAccess::read))
      ->required();
  command->add_option("--query", a->query, "continuous: what meets between two frames (default)")->type_name("QUERY");
  command->add_flag("--self", a->self, "What the mesh has to do with itself");
  command
      ->add_option(
          "-o,--output", a->output,
          "The pairs, each with its time: .npz (vertex_face, edge_edge, vertex_face_time, edge_edge_time), .csv, "
          ".json")
      ->required()
      ->type_name("FILE");
  a->options.add_to(*command);
  add_threads_option(*command, a->threads);
  add_report_options(*command, a->report);
  command->footer(examples);
  command->callback([a] { run(*a); });
}

}  // namespace blum::cli
