#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/io/centreline_io.hpp"
#include "blum/io/file_content.hpp"
#include "blum/medial_axis/centreline.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/input_facts.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum centreline vessels.nii.gz -o vessels.json           one graph per label: nodes, branches, radii
  blum centreline ct.nrrd -o airways.vtp --threshold 300   one graph, as polylines for ParaView
  blum centreline cells.nrrd -o cells.csv --label 2,7-9    one row per branch, for four labels)";

constexpr std::uint64_t most_labels = 1000000;

struct Arguments {
  std::string image;
  std::string output;
  std::vector<std::string> labels;
  std::optional<std::string> threshold, threads;
  OptionTexts<CentrelineOptions> options;
  ReportOptions report;
};

/// Labels that the command line requests.
struct Labels {
  std::vector<std::int64_t> all;
  std::set<std::int64_t> of_ranges;  ///< labels from ranges like `7-9`; absent ones are skipped
};

/// Adds a label, or all labels of a range: `7-9` adds three. @throws UsageError.
void add_labels(std::string_view text, std::set<std::int64_t>& known, Labels& labels) {
  const std::size_t dash = text.find('-', 1);
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const bool is_range = dash != std::string_view::npos;
  if (is_range && dash + 1 == text.size()) {
    throw UsageError("--label " + std::string(text) + ": a range needs a first and a last label, for example 7-9");
  }
  const std::int64_t first = parse_integer("--label", text.substr(0, dash), least, most);
  const std::int64_t last = is_range ? parse_integer("--label", text.substr(dash + 1), least, most) : first;
  if (last < first) throw UsageError("--label " + std::string(text) + ": the range ends before it begins");
  if (static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first) >= most_labels) {
    throw UsageError("--label " + std::string(text) + " contains more than a million labels");
  }
  for (std::int64_t label = first;; ++label) {
    if (!known.insert(label).second) throw UsageError("--label contains " + std::to_string(label) + " twice");
    labels.all.push_back(label);
    if (is_range) labels.of_ranges.insert(label);
    if (label == last) break;
  }
}

/// Returns the requested labels; unset for `all`. @throws UsageError.
std::optional<Labels> labels_of(const std::vector<std::string>& texts) {
  if (texts.empty() || (texts.size() == 1 && texts[0] == "all")) return std::nullopt;
  Labels labels;
  std::set<std::int64_t> known;
  for (const std::string& text : texts) {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      add_labels(std::string_view(text).substr(begin, end - begin), known, labels);
      begin = end + 1;
    }
  }
  return labels;
}

Centrelines lines_of(const VoxelImage& image, const std::optional<Labels>& labels, const CentrelineOptions& options,
                     const Context& context) {
  if (!labels) return centreline(image, options, context);
  Centrelines lines = centreline(image, labels->all, options, context);
  std::erase_if(lines.labels,
                [&](const Centreline& line) { return line.voxels == 0 && labels->of_ranges.contains(*line.label); });
  lines.warnings = centreline_warnings(lines, image.grid);
  return lines;
}

double length_of(const Centreline& line) {
  double length = 0;
  for (const CentrelineBranch& branch : line.branches) length += branch.length;
  return length;
}

/// Returns the properties of a label's centreline, without its points.
Json brief_json(const Centreline& line) {
  return {{"label", to_json(line.label)},
          {"voxels", line.voxels},
          {"nodes", line.nodes.size()},
          {"branches", line.branches.size()},
          {"length", length_of(line)},
          {"label_betti", to_json(line.label_betti)},
          {"graph_betti", to_json(line.graph_betti)},
          {"homotopy_kept", line.homotopy_kept},
          {"homotopy", line.homotopy}};
}

void add_lines(TextTable& table, const Centrelines& lines) {
  constexpr std::size_t most_shown = 6;
  std::size_t branches = 0;
  for (const Centreline& line : lines.labels) branches += line.branches.size();
  for (std::size_t l = 0; l < std::min(lines.labels.size(), most_shown); ++l) {
    const Centreline& line = lines.labels[l];
    table.add(line.label ? "label " + std::to_string(*line.label) : "selected",
              plural(line.branches.size(), "branch", "branches") + ", " + plural(line.nodes.size(), "node", "nodes") +
                  ", total length " + rounded_text(length_of(line)) + " in the image's units; topology " +
                  (line.homotopy_kept ? "kept" : "changed"));
  }
  if (lines.labels.size() > most_shown) {
    table.add("in all", count_text(lines.labels.size()) + " labels, " + plural(branches, "branch", "branches"));
  }
}

void run(const Arguments& a) {
  const fs::path input = a.image;
  const fs::path output = a.output;
  check_extension("--output", output, file_extensions(FileContent::centreline, FileAccess::write));
  const auto labels = labels_of(a.labels);
  LabelSelection::exclude_both(!a.labels.empty(), a.threshold.has_value(), "--");
  CentrelineOptions options = a.options.read();
  if (a.threshold) options.selection = LabelSelection::at_least(parse_number("--threshold", *a.threshold));
  const int threads = parse_threads(a.threads);
  if (input_kind(input) != InputKind::image) {
    throw FileError("'" + input.string() + "' is not a voxel image; `blum centreline` needs one");
  }
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, {input});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  std::vector<PhaseTime> phases;
  ImageFile file;
  {
    const Unattended reading;
    file = read_image_of_any_name(input);
  }
  if (!a.threshold) round_labels(file, labels ? labels->all : std::vector<std::int64_t>{}, context);
  const VoxelImage& image = file.image;
  std::vector<Warning> warnings = std::move(file.warnings);
  phases.push_back({"read", watch.lap()});
  const Centrelines lines = lines_of(image, labels, options, context);
  phases.insert(phases.end(), lines.phases.begin(), lines.phases.end());
  warnings.insert(warnings.end(), lines.warnings.begin(), lines.warnings.end());
  static_cast<void>(watch.lap());
  const Json head = answer_json(
      "centreline", {{"source", input.filename().string()},
                     {"space", image.space},
                     {"grid", to_json(image.grid)},
                     {"threshold", to_json(a.threshold ? std::optional(options.selection.threshold) : std::nullopt)},
                     {"spur", options.spur}});
  write_centrelines(output, lines, {BLUM_VERSION, head.dump(1)}, context);
  phases.push_back({"write", watch.lap()});
  progress.clear();

  const PhaseSummary spent = summarize(phases);
  Json briefs = Json::array();
  for (const Centreline& line : lines.labels) briefs.push_back(brief_json(line));
  Json json = answer_json(
      "centreline",
      {{"image", input.string()}, {"grid", to_json(image.grid)}, {"spur", options.spur}, {"labels", briefs}});
  add_run_facts(json, spent, context, warnings, Json::array({output.string()}));
  TextTable table;
  add_lines(table, lines);
  table.add("image", input.string() + ": " + size_text(image.grid) + " voxels");
  table.add("wrote", output.string());
  spent.add_to(table);
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
}

}  // namespace

void add_centreline_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand("centreline", "Centrelines of the labels of an image, with radii");
  command.add_option("IMAGE", a->image, extensions_help({FileContent::image}, FileAccess::read)).required();
  command
      .add_option("-o,--output", a->output,
                  ".json: nodes and branches with their points; .csv: one row per branch; .swc: trees; .vtp, .ply, "
                  ".npz: polylines with radii")
      .required()
      .type_name("FILE");
  add_label_option(command, a->labels,
                   "Select the voxels of value L; several values (1,3-5 or repeated) give one graph each (default: all "
                   "values except 0)");
  add_text_option(command, "--threshold", a->threshold, "T", "Select the voxels of value T or more, as one graph");
  a->options.add_to(command);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
