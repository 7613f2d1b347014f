#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/point_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "points/point_columns.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum query part.stl points.npy -o distances.npz           signed distances, closest points, sites
  blum query part.ply scan.ply -o deviation.ply             deviation of each point of a scan from the part
  blum query part.obj points.csv -o near.csv --max-distance 2 --sign none
  blum query part.stl a.ply b.ply c.ply -o deviation.vtp    writes deviation-a.vtp, deviation-b.vtp, deviation-c.vtp)";

struct Arguments {
  std::string mesh, output;
  std::vector<std::string> points;
  std::optional<std::string> weld, threads;
  OptionTexts<ClosestPointOptions> options;
  ReportOptions report;
};

/// Statistics of distances.
struct Facts {
  std::size_t points = 0;
  std::size_t found = 0;
  std::size_t inside = 0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  double sum = 0;  ///< sum of the distances' magnitudes
  double squares = 0;

  void add(const std::vector<ClosestPoint>& all) {
    points += all.size();
    for (const ClosestPoint& one : all) {
      if (!one.site.has_value()) continue;
      ++found;
      inside += one.distance < 0 ? 1 : 0;
      smallest = std::min(smallest, one.distance);
      largest = std::max(largest, one.distance);
      sum += std::abs(one.distance);
      squares += one.distance * one.distance;
    }
  }
  void add(const Facts& other) {
    points += other.points;
    found += other.found;
    inside += other.inside;
    smallest = std::min(smallest, other.smallest);
    largest = std::max(largest, other.largest);
    sum += other.sum;
    squares += other.squares;
  }

  [[nodiscard]] double mean() const { return sum / static_cast<double>(found); }
  [[nodiscard]] double rms() const { return std::sqrt(squares / static_cast<double>(found)); }

  [[nodiscard]] Json json() const {
    if (found == 0) return nullptr;
    return {{"smallest", smallest}, {"largest", largest}, {"mean_of_magnitudes", mean()}, {"rms", rms()}};
  }
  [[nodiscard]] std::string counts_text(SignRule rule) const {
    std::string text = plural(points, "point", "points");
    if (found < points) text += ", " + count_text(found) + " within --max-distance";
    if (rule != SignRule::none) text += ", " + count_text(inside) + " inside";
    return text;
  }
  [[nodiscard]] std::string distances_text(SignRule rule) const {
    return rounded_text(smallest) + " to " + rounded_text(largest) +
           (rule == SignRule::none ? "" : ", negative inside") + "; mean absolute distance " + rounded_text(mean()) +
           ", rms " + rounded_text(rms());
  }
};

/// File of points, with the path of its output and its statistics.
struct PointFile {
  fs::path points, output;
  Facts facts;
};

/// Returns the files of points with their outputs. For one file the output is OUT, for several OUT-NAME.
std::vector<PointFile> files_of(const Arguments& a) {
  const fs::path output = a.output;
  check_extension("--output", output, file_extensions(FileContent::points, FileAccess::write));
  std::vector<PointFile> files;
  for (const std::string& name : a.points) {
    PointFile& file = files.emplace_back();
    file.points = name;
    file.output = output;
    if (a.points.size() == 1) continue;
    file.output.replace_filename(output.stem());
    file.output += "-";
    file.output += file.points.stem();
    file.output += output.extension();
    // All files are checked first. If an error came later, the outputs of earlier files would already exist.
    if (!fs::exists(file.points)) {
      throw FileError("cannot read '" + name + "': there is no such file" +
                      (name == "-" ? "; for standard input, give the name /dev/stdin" : ""));
    }
  }
  std::vector<fs::path> outputs = a.report.files();
  std::vector<fs::path> inputs{a.mesh};
  for (const PointFile& file : files) {
    outputs.push_back(file.output);
    inputs.push_back(file.points);
  }
  check_outputs(outputs, inputs);
  return files;
}

/// Returns the context for one of several files. The progress bar covers all files.
Context context_of(const Context& context, std::size_t file, std::size_t count) {
  Context out = context;
  if (count == 1 || !context.progress) return out;
  out.progress = [&context, file, count](double fraction, std::string_view phase) {
    context.progress((static_cast<double>(file) + fraction) / static_cast<double>(count), phase);
  };
  return out;
}

/// Seconds of each phase, summed over all files.
struct Spent {
  double read = 0;
  double query = 0;
  double write = 0;

  [[nodiscard]] std::vector<PhaseTime> phases() const { return {{"read", read}, {"query", query}, {"write", write}}; }
};

void answer(PointFile& file, const ClosestPointQuery& query, const Arguments& a, const Context& context, Spent& spent) {
  Stopwatch watch;
  std::vector<Vec3d> queries;
  {
    const Unattended reading;
    queries = read_points(file.points);
  }
  spent.read += watch.lap();
  const std::vector<ClosestPoint> found = query.nearest(queries, context);
  spent.query += watch.lap();
  Complex points = points_with_distances(queries, found, query.gradients(queries, found, context));
  write_points(file.output, points,
               {{"tool", "blum query"},
                {"source", fs::path(a.mesh).filename().string()},
                {"sign_rule", std::string(to_string(query.sign_rule()))}},
               context);
  spent.write += watch.lap();
  file.facts.add(found);
}

Json json_of(const PointFile& file) {
  return {{"file", file.points.string()}, {"output", file.output.string()}, {"points", file.facts.points},
          {"found", file.facts.found},    {"inside", file.facts.inside},    {"distance", file.facts.json()}};
}

TextTable table_of(const Arguments& a, const MeshFile& mesh, const ClosestPointQuery& query,
                   const std::vector<PointFile>& files, const Facts& all, const PhaseSummary& spent) {
  TextTable table;
  table.add("points", all.counts_text(query.sign_rule()));
  if (all.found > 0) table.add("distance", all.distances_text(query.sign_rule()));
  table.add("sign", sign_text(query.sign_rule(), query.sign_reason()));
  table.add("mesh", a.mesh + ": " + plural(mesh.mesh.triangles.size(), "triangle", "triangles"));
  for (const PointFile& file : files) {
    std::string text = file.output.string();
    if (files.size() > 1) {
      text += ": " + file.facts.counts_text(query.sign_rule());
      if (file.facts.found > 0) text += ", " + file.facts.distances_text(query.sign_rule());
    }
    table.add("wrote", text);
  }
  spent.add_to(table);
  return table;
}

void run(const Arguments& a) {
  std::vector<PointFile> files = files_of(a);
  const ClosestPointOptions options = a.options.read();
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Spent spent;
  Stopwatch watch;
  MeshFile mesh;
  {
    const Unattended reading;
    mesh = read_mesh_of_any_name(a.mesh, {weld});
  }
  spent.read += watch.lap();
  const ClosestPointQuery query(mesh.mesh, options, context);
  const std::vector<Warning>& warnings = query.warnings();
  spent.query += watch.lap();
  Facts all;
  Json of_files = Json::array();
  Json outputs = Json::array();
  for (std::size_t k = 0; k < files.size(); ++k) {
    answer(files[k], query, a, context_of(context, k, files.size()), spent);
    all.add(files[k].facts);
    of_files.push_back(json_of(files[k]));
    outputs.push_back(files[k].output.string());
  }
  progress.clear();
  const PhaseSummary times = summarize(spent.phases());
  Json json = answer_json("query", {{"mesh", a.mesh},
                                    {"triangles", mesh.mesh.triangles.size()},
                                    {"points", all.points},
                                    {"found", all.found},
                                    {"inside", all.inside},
                                    {"sign_rule", std::string(to_string(query.sign_rule()))},
                                    {"sign_reason", query.sign_reason()},
                                    {"distance", all.json()},
                                    {"files", of_files}});
  add_run_facts(json, times, context, warnings, outputs);
  report(a.report, json, table_of(a, mesh, query, files, all, times));
  if (!a.report.quiet) warn(warnings);
}

}  // namespace

void add_query_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("query", "Exact signed distances from points to a mesh, with the closest points");
  command.add_option("MESH", a->mesh, extensions_help({FileContent::mesh}, FileAccess::read)).required();
  command
      .add_option("POINTS", a->points,
                  join_words(file_extensions(FileContent::points, FileAccess::read), "or") +
                      "; each of several files has an output of its own")
      .required();
  command
      .add_option("-o,--output", a->output,
                  extension_list(FileContent::points, FileAccess::write) +
                      ": points with columns distance, gradient, closest, site, triangle. For several POINTS files, "
                      "the outputs are OUT-NAME, with the NAME of each file. Give -o only once; for a second format, "
                      "run the command again")
      .required()
      .type_name("FILE");
  a->options.add_to(command);
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
