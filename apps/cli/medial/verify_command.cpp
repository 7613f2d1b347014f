#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "blum/field/smooth_surface.hpp"
#include "blum/io/medial_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"
#include "medial/axis_solid.hpp"
#include "medial/medial_report.hpp"
#include "planning/path_check.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum verify part.stl part.vtp
  blum verify part.stl part-theta20.vtp part-theta60.vtp     all axes of one run
  blum verify scan.nii.gz vessels.npz --json -
  blum verify path.json                                      a path, with the meshes that it names
  blum verify path.csv robot.ply walls.ply --clearance 0.01  a path of another program

The checking code is independent of the construction, except for shared parts that
docs/decisions/0007-certificate.md lists. Exit status: 0 everything is certified, 3 something is not.
Several axes give a JSON array.)";

struct Arguments {
  std::string input;
  std::vector<std::string> axes;
  std::optional<std::string> threshold, weld, clearance, threads;
  std::vector<std::string> labels;
  bool smooth = false;
  ReportOptions report;
};

SolidSelection solid_of_options(const Arguments& a, InputKind kind) {
  const SolidSelection given = parse_solid(a.labels, a.threshold, a.weld);
  if (kind == InputKind::mesh) {
    refuse_given({{!a.labels.empty(), "--label"}, {a.threshold.has_value(), "--threshold"}, {a.smooth, "--smooth"}},
                 a.input, "a mesh", "images");
  } else {
    refuse_given({{a.weld.has_value(), "--weld"}}, a.input, "an image", "meshes");
  }
  return given;
}

/// For an axis that is not certified, returns a message if its file names another solid as source. This alone proves
/// nothing, because files may be renamed.
std::vector<std::string> other_source(const fs::path& input, const MedialMetadata& metadata) {
  const fs::path source = fs::path(metadata.source).filename();
  if (source.empty() || source == input.filename()) return {};
  return {"the file of the axis states that the solid is '" + source.string() + "'"};
}

/// Certifies one axis after the other.
class Verifier {
 public:
  Verifier(fs::path path, InputKind kind, SolidSelection given, bool smooth, const Context& context)
      : path_(std::move(path)), kind_(kind), given_(given), smooth_(smooth), context_(context) {}

  void verify(const fs::path& axis) {
    MedialFile file = [&] {
      const Unattended reading;
      return read_axis(axis);
    }();
    if (smooth_ && !file.metadata.smooth) file.metadata.smooth = SmoothSurfaceOptions{}.iterations;
    auto [selection, warnings] = solid_of_axis(given_, kind_, file.metadata, axis);
    const SolidInput& solid = load(selection.weld, labels_of(selection));
    warnings.insert(warnings.end(), solid.image_warnings.begin(), solid.image_warnings.end());
    const LabelSelection voxels = LabelSelection::of(selection.label, selection.threshold);
    const Certificate certificate = verifier_->certificate_of(file, voxels, context_);
    if (solid.weld && solid.weld->lost > 0) {
      // If --weld is not given, the tolerance is the one that the file of the axis records.
      const std::string asked = given_.weld ? std::string() : "as '" + axis.string() + "' records, ";
      if (!given_.weld || solid.weld->before != solid.weld->after) {
        warnings.emplace_back(WarningCode::other_vertices, asked + weld_text(*solid.weld));
      }
    }
    for (const Warning& warning : warnings) {
      // Several axes of one image have the same warnings about the image.
      if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
    }
    const MedialCounts counts = count(file.complex);
    const std::optional<double>& theta = file.metadata.theta;
    add_certificate(table_, theta ? " at theta " + rounded_text(*theta) : "", certificate, file.nested.has_value(),
                    size_of(solid, voxels, context_));
    add_axis_counts(table_, axis.string() + ": ", counts, file.has_labels);
    results_.push_back(
        answer_json("verify", {{"input", solid.json},
                               {"axis", {{"file", axis.string()}, {"counts", counts_json(counts, file.has_labels)}}},
                               {"certificate", certificate_json(certificate, file.nested.has_value())},
                               {"warnings", to_json(warnings)}}));
    if (!certificate.holds()) {
      std::vector<std::string> mismatches = other_source(path_, file.metadata);
      mismatches.insert(mismatches.end(), certificate.mismatches.begin(), certificate.mismatches.end());
      failures_.push_back(
          {axis, std::move(mismatches), missing_options(given_, kind_, file.metadata, certificate.topology_holds)});
    }
  }

  [[nodiscard]] TextTable table() const {
    TextTable out = table_;
    out.add(solid_->table);
    return out;
  }
  /// Returns an object if there is one axis, or an array if there are several.
  [[nodiscard]] Json json() const { return results_.size() == 1 ? results_.front() : results_; }
  [[nodiscard]] const std::vector<Warning>& warnings() const { return warnings_; }

  /// @throws NotCertified if an axis is not certified.
  void check() const {
    if (failures_.empty()) return;
    if (results_.size() == 1) throw NotCertified(failures_.front().mismatches, failures_.front().advice);
    std::vector<std::string> all;
    for (const Failure& failure : failures_) {
      for (const std::string& mismatch : failure.mismatches) all.push_back(failure.axis.string() + ": " + mismatch);
    }
    throw NotCertified(all, failures_.front().advice);
  }

 private:
  struct Failure {
    fs::path axis;
    std::vector<std::string> mismatches;
    std::string advice;
  };

  /// Returns the mesh or image. Reads the file again only if an axis needs another weld tolerance or label.
  const SolidInput& load(const std::optional<double>& weld, const std::vector<std::int64_t>& labels) {
    if (!solid_ || weld != weld_ || labels != labels_) {
      std::error_code error;
      if (solid_ && fs::is_fifo(path_, error)) {
        throw FileError("'" + path_.string() +
                        "' is a pipe and can be read only once, but these axes need it with different options; write "
                        "it to a file");
      }
      verifier_.reset();
      solid_ = load_solid(path_, weld, labels);
      verifier_.emplace(*solid_);
    }
    weld_ = weld;
    labels_ = labels;
    return *solid_;
  }

  fs::path path_;
  InputKind kind_;
  SolidSelection given_;
  bool smooth_;
  const Context& context_;
  std::optional<SolidInput> solid_;
  std::optional<SolidVerifier> verifier_;  ///< verifier for solid_
  std::optional<double> weld_;
  std::vector<std::int64_t> labels_;
  TextTable table_;
  Json results_ = Json::array();
  std::vector<Warning> warnings_;
  std::vector<Failure> failures_;
};

void run_path_check(const Arguments& a) {
  PathCheck check{.path = a.input, .meshes = {a.axes.begin(), a.axes.end()}, .clearance = {}, .report = a.report};
  refuse_given({{!a.labels.empty(), "--label"},
                {a.threshold.has_value(), "--threshold"},
                {a.smooth, "--smooth"},
                {a.weld.has_value(), "--weld"}},
               a.input, "a path", "solids");
  if (a.clearance) check.clearance = parse_non_negative("--clearance", *a.clearance);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  check_path(check, progress, make_context(parse_threads(a.threads), progress, interrupt));
}

void run(const Arguments& a) {
  const fs::path path = a.input;
  if (is_path_file(path)) return run_path_check(a);
  if (a.axes.empty()) throw UsageError("AXIS is required: give the medial axes to check after the solid");
  refuse_given({{a.clearance.has_value(), "--clearance"}}, path, "a solid", "paths");
  const std::vector<fs::path> axes(a.axes.begin(), a.axes.end());
  for (const fs::path& axis : axes)
    check_extension("AXIS", axis, file_extensions(FileContent::complex, FileAccess::read));
  std::vector<fs::path> inputs = axes;
  inputs.push_back(path);
  check_outputs(a.report.files(), inputs);
  const InputKind kind = input_kind(path);
  const SolidSelection given = solid_of_options(a, kind);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(parse_threads(a.threads), progress, interrupt);
  Verifier verifier(path, kind, given, a.smooth, context);
  for (const fs::path& axis : axes) verifier.verify(axis);
  progress.clear();
  report(a.report, verifier.json(), verifier.table());
  if (!a.report.quiet) warn(verifier.warnings());
  verifier.check();
}

}  // namespace

void add_verify_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand(
      "verify", "Check medial axes against their solid, or paths against their meshes, from the files alone");
  command.add_option("INPUT", a->input, "Mesh or image of the solid; or a path: .json or .csv").required();
  command.add_option("AXIS", a->axes,
                     "Medial axes: " + join_words(file_extensions(FileContent::complex, FileAccess::read), "or") +
                         "; for a path: the body, then the obstacles (default: those that the path names)");
  add_label_option(command, a->labels, "Image: select the voxels of value L (default: as recorded in AXIS)");
  add_text_option(command, "--threshold", a->threshold, "T",
                  "Image: select the voxels of value T or more (default: as recorded in AXIS)");
  command.add_flag("--smooth", a->smooth, "Image: AXIS belongs to the smooth surface (default: as recorded in AXIS)");
  add_weld_option(command, a->weld, weld_of_axis_help);
  add_text_option(command, "--clearance", a->clearance, "C",
                  "Path: the clearance to check, in mesh units (default: as recorded in the path, else 0)");
  add_threads_option(command, a->threads);
  add_report_options(command, a->report, "Write the certificates as JSON; - is standard output");
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
