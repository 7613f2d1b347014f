#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/complex/sample_axis.hpp"
#include "blum/field/ball_union.hpp"
#include "blum/field/zero_surface.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"
#include "medial/axis_solid.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum reconstruct part.vtp -o part.ply                      union of the balls of an axis, as a mesh
  blum reconstruct part.vtp -o part.nrrd --resolution 256    the same as a signed field
  blum reconstruct part.vtp -o part.ply --input part.stl     also report its distance from the solid)";

struct Arguments {
  std::string axis;
  std::string output;
  std::optional<std::string> input, resolution, spacing, threshold, weld, threads;
  std::vector<std::string> labels;
  ReportOptions report;
};

struct Request {
  fs::path axis;
  fs::path output;
  std::optional<fs::path> input;
  bool is_field = false;
  int resolution = 256;
  std::optional<double> spacing;
  SolidSelection given;
  int threads = 0;
};

/// Throws if the file is a field. Its user probably wants the surface of the field; the message says how to get it.
void check_is_no_field(const fs::path& path) {
  if (!FieldFormat::by_name(path)) return;
  std::error_code ignored;
  if (ComplexFormat::by_name(path) && (!fs::exists(path, ignored) || holds_complex(path))) return;
  throw UsageError("AXIS '" + path.string() +
                   "' is not a medial axis; for the surface of a field, use `blum surface FIELD --level L -o MESH`");
}

Request parse(const Arguments& a) {
  Request r;
  r.axis = a.axis;
  r.output = a.output;
  check_is_no_field(r.axis);
  check_extension("AXIS", r.axis, extensions_with_radii());
  std::vector<std::string> known = file_extensions(FileContent::field, FileAccess::write);
  for (const std::string& end : file_extensions(FileContent::mesh, FileAccess::write)) known.push_back(end);
  check_extension("--output", r.output, known);
  r.is_field = FieldFormat::by_name(r.output).has_value();
  exclude(a.resolution.has_value(), "--resolution", a.spacing.has_value(), "--spacing", "each sets the spacing");
  if (a.input) r.input = *a.input;
  if (a.resolution) r.resolution = static_cast<int>(parse_integer("--resolution", *a.resolution, 2, 65536));
  if (a.spacing) r.spacing = parse_positive("--spacing", *a.spacing);
  r.given = parse_solid(a.labels, a.threshold, a.weld);
  if (!r.input) {
    refuse_given({{!a.labels.empty(), "--label"},
                  {a.threshold.has_value(), "--threshold"},
                  {r.given.weld.has_value(), "--weld"}},
                 r.axis, "an axis", "the image or mesh of --input");
  }
  r.threads = parse_threads(a.threads);
  return r;
}

/// Returns balls around points of the axis that are at most a step apart, and around all vertices.
/// @param step  if infinite, only vertices get balls.
std::vector<Ball> balls_of(const MedialFile& file, double step) {
  std::vector<Ball> balls;
  for (const AxisSample& sample : sample_axis(MedialView(file.complex), step)) {
    balls.push_back({sample.position, sample.radius});
  }
  return balls;
}

MedialFile read_balls(const fs::path& path) {
  const Unattended reading;
  MedialFile file = read_axis(path);
  if (!file.has_radii) {
    throw FileError("'" + path.string() + "' contains no radii; use a " + join_words(extensions_with_radii(), "or") +
                    " file");
  }
  if (file.complex.positions.empty())
    throw FileError("'" + path.string() + "' contains no vertices and therefore no balls");
  return file;
}

void run(const Arguments& a) {
  const Request r = parse(a);
  const std::vector<fs::path> outputs = {r.output};
  std::vector<fs::path> inputs{r.axis};
  if (r.input) inputs.push_back(*r.input);
  {
    std::vector<fs::path> all = r.is_field ? files_of_field(r.output) : outputs;
    for (const fs::path& file : a.report.files()) all.push_back(file);
    check_outputs(all, inputs);
  }
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(r.threads, progress, interrupt);
  Stopwatch watch;
  const MedialFile file = read_balls(r.axis);
  std::vector<Ball> balls = balls_of(file, std::numeric_limits<double>::infinity());
  const Box3 box = bounds(balls);
  if (r.spacing) check_spacing(*r.spacing, box);
  const GridSpec grid = r.spacing ? grid_around_with_spacing(box, *r.spacing) : grid_around(box, r.resolution);
  check_memory(4.0 * static_cast<double>(grid.node_count()), "a grid of " + size_text(grid) + " nodes",
               "use a coarser grid");
  // In a decimated axis, vertices are far apart. So balls between them are interpolated, at the spacing of the grid.
  if (file.metadata.deviation) balls = balls_of(file, std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
  const Field field = ball_union_field(balls, grid, context);
  const double field_seconds = watch.lap();

  TextTable table;
  add_axis_counts(table, r.axis.string() + ": ", count(file.complex), file.has_labels);
  table.add("grid", size_text(grid) + " nodes, spacing " + rounded_text(grid.spacing.x));
  Json json = answer_json("reconstruct",
                          {{"axis", {{"file", r.axis.string()}, {"balls", balls.size()}}}, {"grid", to_json(grid)}});
  std::vector<Warning> warnings;
  // Reading the input may fail, so it is read before anything is written.
  if (r.input) {
    const InputKind kind = kind_of_input(*r.input);
    const auto [selection, found] = solid_of_axis(r.given, kind, file.metadata, r.axis);
    warnings = found;
    const SolidInput input = load_solid(*r.input, selection.weld, labels_of(selection));
    warnings.insert(warnings.end(), input.image_warnings.begin(), input.image_warnings.end());
    const LabelSelection voxels = LabelSelection::of(selection.label, selection.threshold);
    const Certificate certificate = SolidVerifier(input).certificate_of(file, voxels, context);
    json["input"] = input.json;
    json["distance"] = {{"solid_to_balls", certificate.balls.solid_to_balls},
                        {"mean_solid_to_balls", certificate.balls.mean_solid_to_balls},
                        {"balls_beyond_solid", certificate.balls.balls_beyond_solid},
                        {"balls_to_surface", certificate.balls.balls_to_surface}};
    table.add("distance", balls_text(certificate.balls, size_of(input, voxels, context)));
  }
  if (r.is_field) {
    const std::optional<fs::path> removed = sites_of_replaced_field(r.output);
    write_field(r.output, field, {nullptr, nullptr, r.axis.filename().string(), BLUM_VERSION}, context);
    if (removed) table.add("removed", removed->string() + ": sites of the replaced field");
    json["removed"] = removed ? Json(removed->string()) : Json(nullptr);
  } else {
    const TriangleMesh surface = zero_surface(field, 0, context);
    if (surface.triangles.empty())
      throw FileError("the balls are so small that no node of the grid lies in one; use a finer grid");
    write_mesh(r.output, surface);
    json["surface"] = {{"vertices", surface.vertices.size()}, {"triangles", surface.triangles.size()}};
    table.add("surface", count_text(surface.vertices.size()) + " vertices, " + count_text(surface.triangles.size()) +
                             " triangles");
  }
  progress.clear();
  json["field_seconds"] = field_seconds;
  json["total_seconds"] = field_seconds + watch.lap();
  json["peak_memory_bytes"] = peak_memory();
  json["outputs"] = Json::array();
  for (const fs::path& output : outputs) {
    json["outputs"].push_back(output.string());
    table.add("wrote", output.string());
  }
  json["warnings"] = to_json(warnings);
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
}

}  // namespace

void add_reconstruct_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("reconstruct", "Union of the balls of a medial axis, as a field or a mesh");
  command.add_option("AXIS", a->axis, "Medial axis: " + join_words(extensions_with_radii(), "or")).required();
  command
      .add_option("-o,--output", a->output, extensions_help({FileContent::field, FileContent::mesh}, FileAccess::write))
      .required()
      .type_name("FILE");
  const auto text = [&](const char* name, std::optional<std::string>& value, const char* type, const char* help) {
    add_text_option(command, name, value, type, help);
  };
  text("--input", a->input, "FILE",
       "Mesh or image of the solid: also report the distances between the solid and the balls");
  text("--resolution", a->resolution, "N",
       "Number of nodes along the longest side of the grid, 2 to 65536 (default 256)");
  text("--spacing", a->spacing, "H", "Distance between neighbouring nodes, in mesh units; replaces --resolution");
  add_label_option(command, a->labels, "Image: select the voxels of value L (default: as recorded in AXIS)");
  text("--threshold", a->threshold, "T", "Image: select the voxels of value T or more (default: as recorded in AXIS)");
  add_weld_option(command, a->weld, weld_of_axis_help);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
