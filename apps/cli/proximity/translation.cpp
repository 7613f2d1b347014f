#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/phase_timer.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/proximity/least_translation.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum proximity translation a.ply b.ply            how far a must move to leave b
  blum proximity translation a.ply b.ply --json -

In C++ and Python: least_translation(), ProximityScene.least_translation())";

struct Arguments {
  std::string a, b;
  std::optional<std::string> weld, threads;
  OptionTexts<TranslationOptions> options;
  ReportOptions report;
};

std::string length_text(const LeastTranslation& found) {
  if (!(found.upper > 0)) return "0: the solids are apart or touch";
  const bool is_exact = rounded_text(found.lower) == rounded_text(found.upper);
  if (is_exact) return rounded_text(found.upper) + " (interval " + rounded_text(found.upper - found.lower) + " wide)";
  return "between " + rounded_text(found.lower) + " and " + rounded_text(found.upper);
}

void run(const Arguments& a) {
  const std::array<fs::path, 2> paths{a.a, a.b};
  const TranslationOptions options = a.options.read();
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  check_outputs(a.report.files(), {paths[0], paths[1]});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  std::array<TriangleMesh, 2> meshes;
  {
    const Unattended reading;
    for (std::size_t k = 0; k < 2; ++k) meshes[k] = read_mesh(paths[k], {weld});
  }
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  ProximityScene scene;
  const ObjectId first = scene.add(meshes[0], {.name = paths[0].string()}, context);
  const ObjectId second = scene.add(meshes[1], {.name = paths[1].string()}, context);
  const LeastTranslation found = scene.least_translation(first, second, options, context);
  phases.push_back({"translation", watch.lap()});
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  Json json = answer_json("proximity translation", {{"a", paths[0].string()}, {"b", paths[1].string()}});
  const Json facts = to_json(found);
  for (const char* const name : {"lower", "upper", "translation", "are_convex"}) json[name] = facts[name];
  add_run_facts(json, spent, context, {}, Json::array());
  TextTable table;
  const std::vector<std::string> names = distinct_names({paths[0].string(), paths[1].string()});
  table.add("least translation", length_text(found));
  if (found.upper > 0) {
    const Vec3d& t = found.translation;
    table.add("of " + names[0],
              "(" + rounded_text(t.x) + ", " + rounded_text(t.y) + ", " + rounded_text(t.z) + ") leaves " + names[1]);
    if (!found.are_convex) table.add("", "the solids are not both convex, so the length may lie between the bounds");
  }
  spent.add_to(table);
  report(a.report, json, table);
}

}  // namespace

void add_translation_query(const Command& parent) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      parent.add_subcommand("translation", "Least translation of a solid that separates it from another one");
  const std::string files = extensions_help({FileContent::mesh}, FileAccess::read);
  command.add_option("A", a->a, "Solid that moves: " + files).required();
  command.add_option("B", a->b, "Solid that rests: " + files).required();
  add_weld_option(command, a->weld);
  a->options.add_to(command);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
