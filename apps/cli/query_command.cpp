#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/point_io.hpp"
#include "commands.hpp"
#include "common_options.hpp"
#include "described.hpp"
#include "files.hpp"
#include "options.hpp"
#include "point_columns.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum query part.stl points.npy -o distances.npz           signed distances, closest points, sites
  blum query part.ply scan.ply -o deviation.ply             how far each point of a scan is from the part
  blum query part.obj points.csv -o near.csv --max-distance 2 --sign none)";

struct Arguments {
  std::string mesh, points, output;
  std::optional<std::string> weld, threads;
  OptionTexts<ClosestPointOptions> options;
  ReportOptions report;
};

/// What there is to say of distances.
struct Facts {
  std::size_t found = 0;
  std::size_t inside = 0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  double mean = 0;  ///< without signs
  double root_mean_square = 0;

  explicit Facts(const std::vector<ClosestPoint>& all) {
    double sum = 0;
    double squares = 0;
    for (const ClosestPoint& one : all) {
      if (!one.site.has_value()) continue;
      ++found;
      inside += one.distance < 0 ? 1 : 0;
      smallest = std::min(smallest, one.distance);
      largest = std::max(largest, one.distance);
      sum += std::abs(one.distance);
      squares += one.distance * one.distance;
    }
    if (found == 0) return;
    mean = sum / static_cast<double>(found);
    root_mean_square = std::sqrt(squares / static_cast<double>(found));
  }

  [[nodiscard]] Json json() const {
    if (found == 0) return nullptr;
    return {{"smallest", smallest}, {"largest", largest}, {"mean_of_magnitudes", mean}, {"rms", root_mean_square}};
  }
};

void run(const Arguments& a) {
  const fs::path mesh_path = a.mesh;
  const fs::path points_path = a.points;
  const fs::path output = a.output;
  check_extension("--output", output, written_point_extensions());
  const ClosestPointOptions options = a.options.read();
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, {mesh_path, points_path});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  MeshFile file;
  std::vector<Vec3d> queries;
  {
    const Unattended reading;
    file = read_mesh_of_any_name(mesh_path, {weld});
    queries = read_points(points_path);
  }
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const ClosestPointQuery query(file.mesh, options, context);
  const std::vector<ClosestPoint> found = query.nearest(queries, context);
  phases.push_back({"query", watch.lap()});
  Complex points = points_with_distances(queries, found);
  write_points(output, points,
               {{"tool", "blum query"},
                {"source", mesh_path.filename().string()},
                {"sign_rule", std::string(to_string(query.sign_rule()))}},
               context);
  phases.push_back({"write", watch.lap()});
  progress.clear();
  const PhaseSummary spent = summarize(phases);

  const Facts facts(found);
  const std::string rule(to_string(query.sign_rule()));
  const Json json = answer_json("query", {{"mesh", mesh_path.string()},
                                          {"triangles", file.mesh.triangles.size()},
                                          {"points", queries.size()},
                                          {"found", facts.found},
                                          {"inside", facts.inside},
                                          {"sign_rule", rule},
                                          {"sign_reason", query.sign_reason()},
                                          {"distance", facts.json()},
                                          {"seconds", spent.seconds},
                                          {"total_seconds", spent.total},
                                          {"peak_memory_bytes", peak_memory()},
                                          {"threads", thread_count(context)},
                                          {"warnings", Json::array()},
                                          {"outputs", {output.string()}}});
  TextTable table;
  table.add("mesh", mesh_path.string() + ": " + plural(file.mesh.triangles.size(), "triangle", "triangles"));
  std::string counts = plural(queries.size(), "point", "points");
  if (facts.found < queries.size()) counts += ", " + count_text(facts.found) + " within the distance";
  if (query.sign_rule() != SignRule::none) counts += ", " + count_text(facts.inside) + " inside";
  table.add("points", counts);
  table.add("sign", rule + ": " + query.sign_reason());
  if (facts.found > 0) {
    table.add("distance", rounded_text(facts.smallest) + " to " + rounded_text(facts.largest) +
                              "; mean of magnitudes " + rounded_text(facts.mean) + ", rms " +
                              rounded_text(facts.root_mean_square));
  }
  table.add("wrote", output.string());
  table.add("time", spent.text);
  report(a.report, json, table.text());
}

}  // namespace

void add_query_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      line.app.add_subcommand("query", "Exact signed distances of any points from a mesh, with the closest points");
  command->add_option("MESH", a->mesh, extensions_help({FileContent::mesh}, FileAccess::read))->required();
  command->add_option("POINTS", a->points, join_words(readable_point_extensions(), "or"))->required();
  command
      ->add_option("-o,--output", a->output,
                   ".npz .ply .vtp .csv: the points with columns distance, gradient, closest, site, triangle")
      ->required()
      ->type_name("FILE");
  a->options.add_to(*command);
  add_weld_option(*command, a->weld);
  add_threads_option(*command, a->threads);
  add_report_options(*command, a->report);
  command->footer(examples);
  command->callback([a] { run(*a); });
}

}  // namespace blum::cli
