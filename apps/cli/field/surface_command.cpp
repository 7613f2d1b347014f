#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/field/smooth_surface.hpp"
#include "blum/field/zero_surface.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum surface part.nrrd -o part.ply                 boundary of the shape
  blum surface part.nrrd -o shell.stl --level 0.5    surface 0.5 outside of it; -0.5: inside
  blum surface scan.nii.gz -o part.ply --smooth      smooth surface of the voxels of an image)";

struct Arguments {
  std::string input;
  std::string output;
  std::optional<std::string> level, threshold, threads;
  bool smooth = false;
  std::vector<std::string> labels;
  OptionTexts<SmoothSurfaceOptions> options;
  ReportOptions report;
};

/// Returns the reason why the level may be unsuitable for this field. Returns an empty text if there is none.
std::string doubt(const Field& field, double level) {
  if (field.band && std::abs(level) >= *field.band) {
    return "the band of the field contains distances up to " + rounded_text(*field.band) +
           " only, and the level lies outside it";
  }
  if (field.sign_rule == SignRule::none && level <= 0) {
    return "the distances of the field are unsigned, so only levels above 0 have a surface; give a positive --level";
  }
  return {};
}

/// Makes the smooth surface of an image.
void run_smooth(const Arguments& a) {
  const fs::path input = a.input;
  const fs::path output = a.output;
  refuse_given({{a.level.has_value(), "--level"}}, input, "an image (--smooth)", "fields");
  const SmoothSurfaceOptions options = a.options.read();
  const Selections selections = parse_selections(a.labels, a.threshold);
  if (selections.labels.size() > 1) throw UsageError("--label: a smooth surface belongs to one label; give only one");
  const int threads = parse_threads(a.threads);
  if (input_kind(input) != InputKind::image) {
    throw FileError("'" + input.string() + "' is not a voxel image; --smooth needs one");
  }
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, {input});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  const SolidInput image = load_solid(input, {}, selections.labels);
  const std::vector<Warning> warnings = warnings_of(image);
  const double read_seconds = watch.lap();
  const SmoothSurface surface = smooth_surface(image.image, selections.all().front(), options, context);
  const double surface_seconds = watch.lap();
  write_mesh(output, surface.mesh);
  progress.clear();
  const double write_seconds = watch.lap();
  const Json json = answer_json(
      "surface",
      {{"image", image.json},
       {"iterations", options.iterations},
       {"largest_move", surface.largest_move},
       {"held_vertices", surface.held_vertices},
       {"surface", {{"vertices", surface.mesh.vertices.size()}, {"triangles", surface.mesh.triangles.size()}}},
       {"seconds", {{"read", read_seconds}, {"surface", surface_seconds}, {"write", write_seconds}}},
       {"total_seconds", read_seconds + surface_seconds + write_seconds},
       {"peak_memory_bytes", peak_memory()},
       {"threads", thread_count(context)},
       {"warnings", to_json(warnings)},
       {"outputs", {output.string()}}});
  TextTable table;
  table.add("surface", count_text(surface.mesh.vertices.size()) + " vertices, " +
                           count_text(surface.mesh.triangles.size()) + " triangles; moved by at most " +
                           rounded_text(surface.largest_move) + " voxels from the surface of the boxes");
  table.add(image.table);
  table.add("wrote", output.string());
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
}

void run_level(const Arguments& a) {
  const fs::path input = a.input;
  const fs::path output = a.output;
  refuse_given({{!a.labels.empty(), "--label"},
                {a.threshold.has_value(), "--threshold"},
                {a.options.has("iterations"), "--iterations"}},
               input, "a field", "images with --smooth");
  const double level = a.level ? parse_number("--level", *a.level) : 0;
  const int threads = parse_threads(a.threads);
  check_may_be_field(input);
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, files_of_field(input));
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  const Field field = read_field(input);
  const double read_seconds = watch.lap();
  const TriangleMesh surface = zero_surface(field, level, context);
  const double surface_seconds = watch.lap();
  const std::string reason = doubt(field, level);
  if (surface.triangles.empty()) {
    throw FileError("'" + input.string() + "' has no surface at the level " + rounded_text(level) +
                    (reason.empty() ? ": all its distances are above the level, or all are below" : ": " + reason));
  }
  write_mesh(output, surface);
  progress.clear();

  std::vector<Warning> warnings = field.warnings;
  for (Warning& warning : level_warnings(field, level, context)) warnings.push_back(std::move(warning));
  if (!reason.empty()) warnings.emplace_back(WarningCode::nothing_found, reason);
  const double write_seconds = watch.lap();
  const Json json = answer_json(
      "surface", {{"field", input.string()},
                  {"grid", to_json(field.grid)},
                  {"level", level},
                  {"surface", {{"vertices", surface.vertices.size()}, {"triangles", surface.triangles.size()}}},
                  {"seconds", {{"read", read_seconds}, {"surface", surface_seconds}, {"write", write_seconds}}},
                  {"total_seconds", read_seconds + surface_seconds + write_seconds},
                  {"peak_memory_bytes", peak_memory()},
                  {"threads", thread_count(context)},
                  {"warnings", to_json(warnings)},
                  {"outputs", {output.string()}}});
  const double surface_size = surface.vertices.empty() ? 0 : bounds(surface).diagonal();
  TextTable table;
  table.add("surface", count_text(surface.vertices.size()) + " vertices, " + count_text(surface.triangles.size()) +
                           " triangles at the level " + rounded_text(level));
  table.add("error", "up to half a cell's diagonal, " + share_text(0.5 * length(field.grid.spacing), surface_size) +
                         ", in edges and corners of the surface; much less where it is smooth");
  table.add("field", input.string() + ": " + size_text(field.grid) + " nodes");
  table.add("wrote", output.string());
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
}

void run(const Arguments& a) {
  check_extension("--output", a.output, file_extensions(FileContent::mesh, FileAccess::write));
  if (a.smooth) {
    run_smooth(a);
  } else {
    run_level(a);
  }
}

}  // namespace

void add_surface_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand(
      "surface", "Write a level surface of a field, or the smooth surface of an image, as a mesh");
  command.add_option("INPUT", a->input, extensions_help({FileContent::field, FileContent::image}, FileAccess::read))
      .required();
  command.add_option("-o,--output", a->output, extensions_help({FileContent::mesh}, FileAccess::write))
      .required()
      .type_name("FILE");
  add_text_option(
      command, "--level", a->level, "L",
      "Signed distance of the surface from the shape, in mesh units; negative values lie inside (default 0)");
  command.add_flag("--smooth", a->smooth, "Image: write the smooth surface between the selected voxels and all others");
  add_label_option(command, a->labels, "Image: select the voxels of value L");
  add_text_option(command, "--threshold", a->threshold, "T",
                  "Image: select the voxels of value T or more (default: all voxels that are not 0)");
  a->options.add_to(command, "Image: ");
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
