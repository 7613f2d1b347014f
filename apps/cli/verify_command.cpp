#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "axis_solid.hpp"
#include "blum/io/medial_io.hpp"
#include "commands.hpp"
#include "common_options.hpp"
#include "files.hpp"
#include "medial_report.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "solid_input.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum verify part.stl part.vtp
  blum verify scan.nii.gz vessels.npz --label 1 --json -

Nothing of what made the axis is used. Exit status 0: certified; 3: not.)";

struct Arguments {
  std::string input;
  std::string axis;
  std::optional<std::string> threshold, weld, threads;
  std::vector<std::string> labels;
  ReportOptions report;
};

void run(const Arguments& a) {
  const fs::path path = a.input;
  const fs::path axis_path = a.axis;
  check_extension("AXIS", axis_path, {".vtp", ".ply", ".obj", ".ma", ".npz"});
  exclude(!a.labels.empty(), "--label", a.threshold.has_value(), "--threshold", "each selects the voxels");
  SolidChoice given;
  given.selections.labels = parse_labels("--label", a.labels);
  if (given.selections.labels.size() > 1) throw UsageError("--label: an axis is that of one label");
  if (a.threshold) given.selections.threshold = parse_number("--threshold", *a.threshold);
  given.weld = parse_weld(a.weld);
  const InputKind kind = input_kind(path);
  if (kind == InputKind::mesh) {
    refuse_given({{!a.labels.empty(), "--label"}, {a.threshold.has_value(), "--threshold"}}, path, "a mesh", "images");
  } else {
    refuse_given({{a.weld.has_value(), "--weld"}}, path, "an image", "meshes");
  }
  check_outputs(a.report.files(), {path, axis_path});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(parse_threads(a.threads), progress, interrupt);
  const MedialFile file = read_medial(axis_path);
  const SolidChoice solid = solid_of_axis(given, kind, file.metadata, axis_path);
  const SolidInput input = load_solid(path, solid.weld);
  const Certificate certificate = certificate_of(file, input, solid.selections.all().front(), context);
  progress.clear();
  TextTable table;
  table.add("axis", axis_path.string() + ": " + counts_text(count(file.complex), file.has_labels));
  add_certificate(table, certificate);
  Json json = {{"blum_version", BLUM_VERSION},
               {"command", "verify"},
               {"input", input.json},
               {"axis", {{"file", axis_path.string()}, {"counts", counts_json(count(file.complex), file.has_labels)}}},
               {"certificate", to_json(certificate)},
               {"warnings", solid.warnings}};
  report(a.report, json, input.text + table.text());
  if (!a.report.quiet) warn(solid.warnings);
  if (!certificate.holds()) {
    throw NotCertified(certificate.mismatches,
                       missing_options(given, kind, file.metadata, certificate.topology_holds));
  }
}

}  // namespace

void add_verify_command(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("verify", "Check a medial axis against its solid, from the files alone");
  command->add_option("INPUT", a->input, "The mesh or image whose axis it is")->required();
  command->add_option("AXIS", a->axis, "Medial axis: .vtp, .ply, .obj, .ma or .npz")->required();
  add_label_option(*command, a->labels, "Image: the voxels of value L (default: as AXIS tells)");
  add_text_option(*command, "--threshold", a->threshold, "T",
                  "Image: the voxels of value T or more (default: as AXIS tells)");
  add_weld_option(*command, a->weld);
  add_threads_option(*command, a->threads);
  add_report_options(*command, a->report, "Write the certificate as JSON; - is standard output");
  command->footer(examples);
  command->callback([a] { run(*a); });
}

}  // namespace blum::cli
