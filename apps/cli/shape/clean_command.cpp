#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/phase_timer.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/solid/clean_mesh.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"
#include "shape/cleaning.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum clean part.stl -o part.ply --tolerance 0.001              at most 0.001 mesh units from the input
  blum clean part.stl -o clean.ply --tolerance 1e-4 --json -     with a report and the reached bound
  blum voronoi clean.ply -o diagram.vtp                          faster than with part.stl)";

struct Arguments {
  std::string input;
  std::string output;
  std::string tolerance;
  std::optional<std::string> weld, threads;
  ReportOptions report;
};

void run(const Arguments& a) {
  const fs::path path = a.input;
  const fs::path output = a.output;
  check_extension("--output", output, file_extensions(FileContent::mesh, FileAccess::both));
  const double tolerance = parse_positive("--tolerance", a.tolerance);
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, {path});
  if (input_kind(path) != InputKind::mesh)
    throw FileError("'" + path.string() + "' is not a mesh; `blum clean` needs one");
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  const SolidInput input = load_solid(path, weld);
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const CleanedMesh cleaned = of_file(path, [&] { return clean_mesh(input.mesh.mesh, tolerance, context); });
  phases.push_back({"clean", watch.lap()});
  std::vector<Warning> warnings = warnings_of(input);
  warnings.insert(warnings.end(), cleaned.warnings.begin(), cleaned.warnings.end());
  write_mesh(output, cleaned.mesh);
  phases.push_back({"write", watch.lap()});
  add_rounding_warning(output, cleaned.mesh, warnings);
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  Json facts = {{"input", input.json}};
  facts.update(cleaning_json(cleaned.report, tolerance));
  Json json = answer_json("clean", facts);
  add_run_facts(json, spent, context, warnings, Json::array({output.string()}));
  TextTable table;
  add_cleaning(cleaned.report, tolerance, bounds(input.mesh.mesh).diagonal(), table);
  table.add(input.table);
  table.add("wrote", output.string());
  spent.add_to(table);
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
}

}  // namespace

void add_clean_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand(
      "clean", "Orient a closed mesh, and remove its needles and unnecessary vertices within a guaranteed tolerance");
  command.add_option("INPUT", a->input, extensions_help({FileContent::mesh}, FileAccess::read)).required();
  command.add_option("-o,--output", a->output, extensions_help({FileContent::mesh}, FileAccess::both))
      .required()
      .type_name("FILE");
  command
      .add_option("--tolerance", a->tolerance,
                  "Largest distance between mesh and result, in both directions, in mesh units; above 0")
      .required()
      .type_name("TOL");
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
