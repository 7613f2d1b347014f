#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/io/collision_io.hpp"
#include "blum/proximity/impact.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum ccd unit-tests/vertex-face/data_0_0.csv        compare results with the last column of the file
  blum ccd */*/*.csv --json -                         many files in one summary
  blum ccd queries.csv --kind edge-edge               for a file whose name and folder do not contain the kind

A file has eight rows for each query: the four points at the start, then at the end. A row has
x, y and z as integer numerators and denominators, then the correct answer, 0 or 1.)";

enum class Kind : std::uint8_t { vertex_face, edge_edge };

struct Arguments {
  std::vector<std::string> files;
  std::optional<std::string> kind;
  OptionTexts<ImpactOptions> options;
  ReportOptions report;
};

/// Returns the given kind of queries, or the kind that the name of the file or its folder contains. @throws UsageError.
Kind kind_of(const fs::path& path, const std::optional<std::string>& given) {
  const auto named = [](const std::string& name) -> std::optional<Kind> {
    const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
    if (has("vertex-face") || has("vertex_face") || name.ends_with("vf")) return Kind::vertex_face;
    if (has("edge-edge") || has("edge_edge") || name.ends_with("ee")) return Kind::edge_edge;
    return std::nullopt;
  };
  if (given) {
    if (*given == "vertex-face") return Kind::vertex_face;
    if (*given == "edge-edge") return Kind::edge_edge;
    throw UsageError("--kind is '" + *given + "', but must be vertex-face or edge-edge");
  }
  if (const auto kind = named(path.stem().string())) return *kind;
  if (const auto kind = named(fs::absolute(path).parent_path().filename().string())) return *kind;
  throw UsageError("'" + path.string() +
                   "': neither its name nor that of its folder contains vertex-face or edge-edge; " + "give --kind");
}

struct Counts {
  std::size_t queries = 0;
  std::size_t colliding = 0;  ///< number of queries with a collision
  std::size_t without_truth = 0;
  std::size_t false_negatives = 0;
  std::size_t false_positives = 0;
  std::vector<double> microseconds;  ///< one per query
};

void ask(const ImpactQueries& queries, Kind kind, const ImpactOptions& options, Counts& counts) {
  using Clock = std::chrono::steady_clock;
  for (std::size_t k = 0; k < queries.points.size(); ++k) {
    const Clock::time_point start = Clock::now();
    const std::optional<double> time = kind == Kind::vertex_face ? vertex_face_impact(queries.points[k], options)
                                                                 : edge_edge_impact(queries.points[k], options);
    counts.microseconds.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    ++counts.queries;
    counts.colliding += time ? 1 : 0;
    if (!queries.truth[k]) {
      ++counts.without_truth;
    } else if (*queries.truth[k] && !time) {
      ++counts.false_negatives;
    } else if (!*queries.truth[k] && time) {
      ++counts.false_positives;
    }
  }
}

double quantile(const std::vector<double>& sorted, double part) {
  return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

void run(const Arguments& a) {
  const ImpactOptions options = a.options.read();
  check(options);
  std::vector<Kind> kinds;
  std::vector<fs::path> inputs(a.files.begin(), a.files.end());
  for (const fs::path& path : inputs) kinds.push_back(kind_of(path, a.kind));
  check_outputs(a.report.files(), inputs);
  Counts counts;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    ask(read_impact_queries(inputs[k]), kinds[k], options, counts);
  }
  if (counts.queries == 0) throw FormatError("the given files contain no queries");
  std::sort(counts.microseconds.begin(), counts.microseconds.end());
  double sum = 0;
  for (const double one : counts.microseconds) sum += one;
  const double mean = sum / static_cast<double>(counts.queries);
  const double median = quantile(counts.microseconds, 0.5);
  const double p99 = quantile(counts.microseconds, 0.99);
  const Json json = answer_json("ccd", {{"files", a.files},
                                        {"queries", counts.queries},
                                        {"colliding", counts.colliding},
                                        {"without_truth", counts.without_truth},
                                        {"false_negatives", counts.false_negatives},
                                        {"false_positives", counts.false_positives},
                                        {"tolerance", options.tolerance},
                                        {"mean_us", mean},
                                        {"median_us", median},
                                        {"p99_us", p99}});
  TextTable table;
  table.add("queries", count_text(counts.queries) + " in " + plural(inputs.size(), "file", "files") + ", " +
                           count_text(counts.colliding) + " of them collide");
  table.add("truth", plural(counts.false_negatives, "false negative", "false negatives") + ", " +
                         plural(counts.false_positives, "false positive", "false positives") +
                         (counts.without_truth > 0 ? "; " + count_text(counts.without_truth) + " without a known answer"
                                                   : std::string()));
  table.add("time", rounded_text(mean) + " microseconds per query (mean), " + rounded_text(median) + " (median), " +
                        rounded_text(p99) + " (99th percentile)");
  report(a.report, json, table);
}

}  // namespace

void add_ccd_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("ccd", "Compare collisions of single pairs of moving features with known answers");
  command.add_option("QUERIES", a->files, "Files of queries (.csv)").required();
  add_text_option(command, "--kind", a->kind, "KIND",
                  "Kind of the queries: vertex-face or edge-edge (default: from the name of the file or its folder)");
  a->options.add_to(command);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
