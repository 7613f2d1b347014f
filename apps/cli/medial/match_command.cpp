#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/axis/match_sheets.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/medial_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum match grid.vtp exact.vtp                       sheets that both axes have, and those that only one has
  blum match grid.vtp exact.vtp --of-patches          the same for sheets of pairs of patches
  blum match before.vtp after.vtp --json sheets.json  all numbers of all sheets)";

struct Arguments {
  std::string a, b;
  std::optional<std::string> threads;
  OptionTexts<SheetMatchOptions> options;
  ReportOptions report;
};

MedialFile read_sheets(const fs::path& path) {
  const Unattended reading;
  MedialFile file = read_axis(path);
  if (!file.has_labels && !file.complex.triangles.empty()) {
    throw InvalidOption("'" + path.string() + "': " + missing_medial_column("triangles", medial_columns::sheet));
  }
  return file;
}

std::string sides_text(const MatchedSheet& sheet) {
  if (!sheet.sides) return "";
  const std::string part = sheet.sides_share < 1 - 1e-9 ? " (" + percent(sheet.sides_share) + ")" : "";
  return "; patches " + std::to_string((*sheet.sides)[0]) + " and " + std::to_string((*sheet.sides)[1]) + part;
}

std::string distance_text(const MatchedSheet& sheet) {
  return sheet.largest_distance ? ", at most " + rounded_text(*sheet.largest_distance) + " away" : "";
}

/// Describes a sheet without a partner.
std::string lone_text(const MatchedSheet& sheet) {
  constexpr std::size_t most_listed = 3;
  std::string text = "no partner: area " + rounded_text(sheet.area);
  for (std::size_t k = 0; k < std::min(most_listed, sheet.overlaps.size()); ++k) {
    text += ", " + percent(sheet.overlaps[k].share) + " on sheet " + std::to_string(sheet.overlaps[k].sheet);
  }
  if (sheet.overlaps.empty()) text += ", on no sheet";
  return text + distance_text(sheet) + sides_text(sheet);
}

std::string pair_text(const MatchedSheet& first, const MatchedSheet& second) {
  std::string text = "sheet " + std::to_string(second.sheet) + ": areas " + rounded_text(first.area) + " and " +
                     rounded_text(second.area) + ", shared " + percent(first.on_partner / first.area) + " and " +
                     percent(second.on_partner / second.area) + distance_text(first) + sides_text(first);
  if (first.sides && second.sides && first.sides != second.sides) text += ", but" + sides_text(second).substr(1);
  return text;
}

void add_row(TextTable& table, bool is_large, const std::string& label, const std::string& text) {
  if (is_large) {
    table.add(label, text);
  } else {
    table.detail(label, text);
  }
}

/// Adds a row for each large sheet. Rows of other sheets are details.
void add_sheets(TextTable& table, const SheetMatches& found, const std::vector<std::string>& names) {
  for (const MatchedSheet& sheet : found.first.sheets) {
    const std::string label = "sheet " + std::to_string(sheet.sheet);
    if (!sheet.partner) {
      add_row(table, sheet.large, label, lone_text(sheet) + " of " + names[0]);
      continue;
    }
    const auto at = std::lower_bound(found.second.sheets.begin(), found.second.sheets.end(), *sheet.partner,
                                     [](const MatchedSheet& a, std::uint32_t number) { return a.sheet < number; });
    add_row(table, sheet.large || at->large, label, pair_text(sheet, *at));
  }
  for (const MatchedSheet& sheet : found.second.sheets) {
    if (sheet.partner) continue;
    add_row(table, sheet.large, "only " + names[1], "sheet " + std::to_string(sheet.sheet) + ": " + lone_text(sheet));
  }
}

std::string of_text(std::size_t part, std::size_t all) {
  return count_text(part) + " of " + count_text(all);
}

TextTable table_of(const SheetMatches& found, const std::vector<std::string>& names) {
  TextTable table;
  table.add("large", of_text(found.first.large_matched, found.first.large) + " sheets of " + names[0] + " and " +
                         of_text(found.second.large_matched, found.second.large) + " of " + names[1] +
                         " have a partner");
  table.add("all", of_text(found.first.matched, found.first.sheets.size()) + " sheets of " + names[0] + " and " +
                       of_text(found.second.matched, found.second.sheets.size()) + " of " + names[1]);
  table.add("area", percent(found.first.matched_share) + " of " + names[0] + " and " +
                        percent(found.second.matched_share) + " of " + names[1] + " lie on partners (tolerance " +
                        rounded_text(found.tolerance) + ")");
  if (found.compared_sides > 0) {
    table.add("sides", of_text(found.same_sides, found.compared_sides) + " pairs have the same patches on their sides");
  }
  add_sheets(table, found, names);
  return table;
}

void run(const Arguments& a) {
  const std::array<fs::path, 2> paths{a.a, a.b};
  const SheetMatchOptions options = a.options.read();
  const int threads = parse_threads(a.threads);
  check_outputs(a.report.files(), {paths[0], paths[1]});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  const MedialFile first = read_sheets(paths[0]);
  const MedialFile second = read_sheets(paths[1]);
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const SheetMatches found = match_sheets(first.complex, second.complex, options, context);
  phases.push_back({"match", watch.lap()});
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  Json json = answer_json("match", {{"a", paths[0].string()}, {"b", paths[1].string()}});
  json.update(to_json(found));
  add_run_facts(json, spent, context, {}, Json::array());
  TextTable table = table_of(found, distinct_names({paths[0].string(), paths[1].string()}));
  spent.add_to(table);
  report(a.report, json, table);
}

}  // namespace

void add_match_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand("match", "Sheets that two medial axes of a solid have in common");
  const std::string help = "Medial axis with sheets: " + extension_list(FileContent::complex, FileAccess::both);
  command.add_option("A", a->a, help).required();
  command.add_option("B", a->b, help).required();
  a->options.add_to(command);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
