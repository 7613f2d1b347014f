#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/io/field_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/input_facts.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"
#include "field/field_statistics.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum field bunny.obj -o bunny.nrrd --resolution 256
  blum field bunny.obj -o bunny.npz --band 3v --json summary.json
  blum field part.stl -o part.vti --weld 1e-6 --sign winding
  blum field parts.ply -o gap.npz --order 2 --second other-object
  blum field part.ply -o cut.nrrd --bounds -1,-1,0,1,1,0      2D field of one layer
  blum field scan.nii.gz -o organ.nrrd --label 1,3            writes organ-label1.nrrd and organ-label3.nrrd
  blum field scan.nrrd -o bone.npz --threshold 300)";

/// Command line as texts. parse() parses and checks the values.
struct Arguments {
  std::string input;
  std::string output;
  std::optional<std::string> resolution, spacing, bounds, padding, threshold, weld, threads, device;
  OptionTexts<FieldOptions> options;
  std::vector<std::string> labels;
  ReportOptions report;
};

struct Request {
  fs::path input;
  fs::path output;
  int resolution = 256;
  std::optional<double> spacing;
  std::optional<Box3> bounds;
  double padding = 0.1;
  OptionTexts<FieldOptions> option_texts;
  FieldOptions options;  ///< lengths that are given in grid steps are set when the grid is known
  Selections selections;
  std::optional<double> weld;
  int threads = 0;
  Device device;
  ReportOptions report;
};

Request parse(const Arguments& a) {
  Request r;
  r.input = a.input;
  r.output = a.output;
  check_extension("--output", r.output, file_extensions(FileContent::field, FileAccess::write));
  if (r.input.empty()) throw UsageError("INPUT needs a file name");
  exclude(a.resolution.has_value(), "--resolution", a.spacing.has_value(), "--spacing", "each sets the spacing");
  exclude(a.bounds.has_value(), "--bounds", a.padding.has_value(), "--padding",
          "--bounds sets the box without padding");
  if (a.resolution) r.resolution = static_cast<int>(parse_integer("--resolution", *a.resolution, 2, 65536));
  if (a.spacing) r.spacing = parse_positive("--spacing", *a.spacing);
  if (a.bounds) r.bounds = parse_bounds("--bounds", *a.bounds);
  if (a.padding) r.padding = parse_non_negative("--padding", *a.padding);
  exclude(a.options.has("site_ids"), "--site-ids", a.options.has("sites"), "--no-sites",
          "a field without sites has no ids");
  r.option_texts = a.options;
  r.options = a.options.read(1);
  if (a.options.has("second") && r.options.order != 2) throw UsageError("--second needs --order 2");
  r.selections = parse_selections(a.labels, a.threshold);
  r.weld = parse_weld(a.weld);
  r.threads = parse_threads(a.threads);
  if (a.device) r.device = parse_device(*a.device);
  r.report = a.report;
  return r;
}

void check_applicable(const Arguments& a, const Request& r, InputKind kind) {
  if (kind == InputKind::mesh) {
    refuse_given({{!a.labels.empty(), "--label"}, {a.threshold.has_value(), "--threshold"}}, r.input, "a mesh",
                 "images");
    return;
  }
  refuse_given({{a.resolution.has_value(), "--resolution"},
                {a.spacing.has_value(), "--spacing"},
                {a.bounds.has_value(), "--bounds"},
                {a.padding.has_value(), "--padding"},
                {a.options.has("site_ids"), "--site-ids"},
                {a.options.has("order"), "--order"},
                {a.options.has("second"), "--second"},
                {a.weld.has_value(), "--weld"},
                {r.options.sign == SignMode::normals, "--sign normals"},
                {r.options.sign == SignMode::winding, "--sign winding"}},
               r.input, "an image", "meshes");
}

/// Written file.
struct Output {
  fs::path path;
  std::string content;  ///< content of a file beside the field file; empty for the field file
};

/// Facts about a run, for its summary.
struct Run {
  Json input;
  TextTable input_table;
  Json fields = Json::array();
  std::vector<PhaseTime> phases;
  double field_seconds = 0;
  std::vector<Output> outputs;
  std::vector<fs::path> removed;         ///< sites files of the replaced fields, if the new fields have none
  std::vector<fs::path> removed_second;  ///< second-order files of the replaced fields, if the new fields have order 1
  std::vector<Warning> warnings;
  TextTable table;
  bool names_device = false;  ///< --device is not `cpu`; with `auto`, the CPU may still be used
  void time(const char* phase, double seconds) { phases.push_back({phase, seconds}); }
};

Json kind_json(const KindCount& count) {
  return {{"nodes", count.nodes}, {"sites", count.sites}};
}

Json sites_json(const Field& field, const FieldStatistics& s) {
  if (field.site.empty()) return nullptr;
  const SiteIds ids = field.site_ids;
  Json json = {{"count", to_string(ids)}, {"distinct", s.all.sites}, {"nodes_without", s.siteless_nodes}};
  if (ids == SiteIds::features) {
    json["vertices"] = kind_json(s.kinds[0]);
    json["edges"] = kind_json(s.kinds[1]);
    json["faces"] = kind_json(s.kinds[2]);
  }
  return json;
}

std::string sites_text(const Field& field, const FieldStatistics& s) {
  if (field.site.empty()) return "none (--no-sites)";
  const SiteIds ids = field.site_ids;
  if (ids == SiteIds::voxels) return count_text(s.all.sites) + " closest voxels";
  if (ids == SiteIds::triangles) return count_text(s.all.sites) + " closest triangles";
  const auto part = [&](std::size_t kind, const char* name) {
    const double share =
        s.all.nodes == 0 ? 0 : 100.0 * static_cast<double>(s.kinds[kind].nodes) / static_cast<double>(s.all.nodes);
    return count_text(s.kinds[kind].sites) + " " + name + " (" + rounded_text(std::round(share * 10) / 10) + " %)";
  };
  return part(0, "vertices") + ", " + part(1, "edges") + ", " + part(2, "faces") +
         "; shares of the nodes that are closest to them";
}

Json second_json(const Field& field, const FieldStatistics& s) {
  if (!s.second) return nullptr;
  return {{"rule", field.second ? Json(to_string(*field.second)) : Json(nullptr)},
          {"minimum", s.second->minimum ? Json(*s.second->minimum) : Json(nullptr)},
          {"maximum", s.second->maximum ? Json(*s.second->maximum) : Json(nullptr)},
          {"nodes_without", s.second->nodes_without}};
}

std::string second_text(const Field& field, const SecondStatistics& s) {
  std::string text = "no node has a second site";
  if (s.minimum && s.maximum) text = "distance " + rounded_text(*s.minimum) + " to " + rounded_text(*s.maximum);
  if (field.second) text += ", " + std::string(to_string(*field.second));
  if (s.nodes_without > 0) text += "; " + count_text(s.nodes_without) + " nodes have no second site";
  return text;
}

/// Returns the content of a file beside a .nrrd field file. Returns an empty text for the field file.
std::string content_of(const fs::path& file, SiteIds ids) {
  const std::string name = file.filename().string();
  const std::string_view site = ids == SiteIds::voxels      ? "voxel"
                                : ids == SiteIds::triangles ? "triangle"
                                                            : "vertex, edge or face";
  if (name.ends_with(".site.nrrd")) return "index of the closest " + std::string(site) + " for each node";
  if (name.ends_with(".site2.nrrd")) return "index of the second site for each node";
  if (name.ends_with(".distance2.nrrd")) return "distance of each node to its second site";
  return {};
}

/// @param files  the field file first. @param label  may be null.
void add_field(Run& run, const Field& field, const FieldStatistics& s, const std::vector<fs::path>& files,
               const std::int64_t* label) {
  Json json;
  if (label) json["label"] = *label;
  Json names = Json::array();
  for (const fs::path& file : files) {
    names.push_back(file.string());
    run.outputs.push_back({file, file == files.front() ? "" : content_of(file, field.site_ids)});
  }
  json["files"] = names;
  json["sign"] = {{"rule", to_string(field.sign_rule)}, {"reason", field.sign_reason}};
  json["device"] = to_string(field.device);
  json["device_reason"] = field.device_reason.empty() ? Json(nullptr) : Json(field.device_reason);
  json["band"] = field.band ? Json(*field.band) : Json(nullptr);
  json["distance"] = {{"minimum", s.minimum}, {"maximum", s.maximum}, {"inside_nodes", s.inside_nodes}};
  json["sites"] = sites_json(field, s);
  json["second"] = second_json(field, s);
  run.fields.push_back(json);

  if (label) run.table.add("label", std::to_string(*label));
  run.table.add("sign", sign_text(field.sign_rule, field.sign_reason));
  if (run.names_device) run.table.add("device", to_string(field.device));
  if (!field.device_reason.empty()) run.table.add("no device", field.device_reason);
  run.table.add("distance", node_range_text(s.minimum, s.maximum, field.sign_rule != SignRule::none) +
                                (field.band ? ", in a band of +-" + rounded_text(*field.band) : ""));
  run.table.detail("sites", sites_text(field, s));
  if (s.second) run.table.add("second", second_text(field, *s.second));
}

/// Returns the largest spacing among the axes with more than one layer.
double coarsest_step(const GridSpec& grid) {
  double step = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] > 1) step = std::max(step, grid.spacing[axis]);
  }
  return step > 0 ? step : grid.spacing.x;
}

Json names_json(const std::vector<fs::path>& files) {
  Json names = Json::array();
  for (const fs::path& file : files) names.push_back(file.string());
  return names;
}

/// Notes the files of the field at `output` that write_field() is about to remove.
void note_removed(const fs::path& output, const Request& r, Run& run) {
  if (!r.options.sites) {
    if (auto file = sites_of_replaced_field(output)) run.removed.push_back(std::move(*file));
  }
  if (r.options.order != 1) return;
  for (fs::path& file : second_of_replaced_field(output)) run.removed_second.push_back(std::move(file));
}

void finish(const Request& request, Run& run, const GridSpec& grid, const Context& context) {
  const PhaseSummary spent = summarize(run.phases);
  const double nodes = static_cast<double>(grid.node_count()) * static_cast<double>(run.fields.size());
  const double rate = nodes / std::max(run.field_seconds, 1e-9);
  Json outputs = Json::array();
  for (const Output& file : run.outputs) outputs.push_back(file.path.string());
  const Json removed = names_json(run.removed);
  const Json json = answer_json("field", {{"input", run.input},
                                          {"grid", to_json(grid)},
                                          {"sign_asked", to_string(request.options.sign)},
                                          {"fields", run.fields},
                                          {"seconds", spent.seconds},
                                          {"field_seconds", run.field_seconds},
                                          {"total_seconds", spent.total},
                                          {"nodes_per_second", rate},
                                          {"peak_memory_bytes", peak_memory()},
                                          {"threads", thread_count(context)},
                                          {"thread_backend", thread_backend()},
                                          {"warnings", to_json(run.warnings)},
                                          {"outputs", outputs},
                                          {"removed", run.removed.empty()       ? Json(nullptr)
                                                      : run.removed.size() == 1 ? Json(run.removed[0].string())
                                                                                : removed},
                                          {"removed_second", names_json(run.removed_second)}});
  run.table.add(run.input_table);
  spent.add_to(run.table);
  run.table.detail("speed", rounded_text(std::round(rate / 1e4) / 1e2) + " million nodes/s on " +
                                plural(static_cast<std::uint64_t>(thread_count(context)), "thread", "threads"));
  for (const auto& [file, content] : run.outputs) {
    run.table.add("wrote", file.string() + (content.empty() ? "" : " (" + content + ")"));
  }
  for (const fs::path& file : run.removed) {
    run.table.add("removed", file.string() + ": sites of the replaced field");
  }
  for (const fs::path& file : run.removed_second) {
    run.table.add("removed", file.string() + ": second order of the replaced field");
  }
  report(request.report, json, run.table);
  if (!request.report.quiet) warn(run.warnings);
}

GridSpec make_grid(const Request& r, const Box3& box) {
  if (r.spacing) check_spacing(*r.spacing, r.bounds.value_or(box));
  if (r.bounds) return r.spacing ? grid_in_with_spacing(*r.bounds, *r.spacing) : grid_in(*r.bounds, r.resolution);
  return r.spacing ? grid_around_with_spacing(box, *r.spacing, r.padding) : grid_around(box, r.resolution, r.padding);
}

void check_field_memory(const GridSpec& grid, std::size_t fields, double bytes_per_node = 8) {
  check_memory(bytes_per_node * static_cast<double>(grid.node_count()) * static_cast<double>(fields),
               "a grid of " + size_text(grid) + " nodes", "use a coarser grid or smaller bounds");
}

void add_grid_text(Run& run, const GridSpec& grid) {
  run.table.add("grid",
                size_text(grid) + " nodes, spacing " +
                    (grid.spacing.x == grid.spacing.y && grid.spacing.y == grid.spacing.z ? rounded_text(grid.spacing.x)
                                                                                          : vector_text(grid.spacing)) +
                    ", origin " + vector_text(grid.origin));
}

void run_mesh(const Request& r, Progress& progress, const Interrupt& interrupt) {
  Context context = make_context(r.threads, progress, interrupt);
  context.device = r.device;
  check_outputs(
      [&] {
        std::vector<fs::path> files = files_of_field(r.output, true, r.options.order);
        for (const fs::path& file : r.report.files()) files.push_back(file);
        return files;
      }(),
      {r.input});
  Run run;
  run.names_device = r.device != Device::cpu();
  Stopwatch watch;
  MeshFile file;
  {
    const Unattended reading;
    file = read_mesh_of_any_name(r.input, {r.weld});
  }
  run.time("read", watch.lap());
  const MeshView mesh = file.mesh;
  validate(mesh);
  const SiteTable sites(mesh, context);
  const Orientation facts = orientation(mesh, sites);
  run.input = mesh_json(r.input, file, sites, facts);
  run.input_table = mesh_table(r.input, file, sites, facts);
  run.time("input facts", watch.lap());

  const GridSpec grid = make_grid(r, bounds(mesh));
  // For order 2, the sites of both orders are in memory during the computation.
  check_field_memory(grid, 1, r.options.order == 2 ? 16 : r.options.sites ? 8 : 4);
  add_grid_text(run, grid);
  static_cast<void>(watch.lap());
  const Field field = distance_field(mesh, grid, r.option_texts.read(grid.spacing.x), context);
  run.field_seconds = watch.lap();
  run.phases.insert(run.phases.end(), field.phases.begin(), field.phases.end());
  progress.clear();

  const SiteTable* features = r.options.site_ids == SiteIds::features ? &sites : nullptr;
  const FieldStatistics statistics = field_statistics(field, features, context);
  run.time("statistics", watch.lap());
  note_removed(r.output, r, run);
  write_field(r.output, field, {&mesh, &sites, r.input.filename().string(), BLUM_VERSION}, context);
  run.time("write", watch.lap());
  progress.clear();
  add_field(run, field, statistics, files_of_field(r.output, r.options.sites, r.options.order), nullptr);
  run.warnings = field.warnings;
  if (is_welded_away(file)) run.warnings.emplace_back(WarningCode::other_vertices, welded_away_text(file));
  finish(r, run, grid, context);
}

void run_image(const Request& r, Progress& progress, const Interrupt& interrupt) {
  Context context = make_context(r.threads, progress, interrupt);
  context.device = r.device;
  std::vector<fs::path> names;
  if (r.selections.labels.size() < 2) names.push_back(r.output);
  if (r.selections.labels.size() >= 2) {
    for (const std::int64_t label : r.selections.labels) names.push_back(with_label(r.output, label));
  }
  std::vector<fs::path> all = r.report.files();
  for (const fs::path& name : names) {
    for (const fs::path& file : files_of_field(name)) all.push_back(file);
  }
  check_outputs(all, {r.input});

  Run run;
  run.names_device = r.device != Device::cpu();
  Stopwatch watch;
  ImageFile file;
  {
    const Unattended reading;
    file = read_image_of_any_name(r.input);
  }
  run.time("read", watch.lap());
  const VoxelImage& image = file.image;
  if (has_only_nan(image)) {
    throw FileError("'" + r.input.string() + "': every voxel is NaN (not a number), so none can be selected");
  }
  if (!r.selections.labels.empty()) round_labels(file, r.selections.labels, context);
  run.warnings = file.warnings;
  run.input = image_json(r.input, image, file.format);
  run.input_table = image_table(r.input, image, file.format);
  run.time("input facts", watch.lap());
  const std::vector<LabelSelection> selections = r.selections.all();
  check_field_memory(image.grid, selections.size(), r.options.sites ? 8 : 4);
  add_grid_text(run, image.grid);
  DistanceTransformOptions options;
  options.is_signed = r.options.sign != SignMode::none;
  options.sites = r.options.sites;
  options.band = r.option_texts.read(coarsest_step(image.grid)).band;
  static_cast<void>(watch.lap());
  std::vector<Field> fields = distance_transforms(image, selections, options, context);
  run.field_seconds = watch.lap();
  progress.clear();
  for (const Field& field : fields) run.phases.insert(run.phases.end(), field.phases.begin(), field.phases.end());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    static_cast<void>(watch.lap());
    const FieldStatistics statistics = field_statistics(fields[i], nullptr, context);
    run.time("statistics", watch.lap());
    note_removed(names[i], r, run);
    write_field(names[i], fields[i], {nullptr, nullptr, r.input.filename().string(), BLUM_VERSION, image.space},
                context);
    run.time("write", watch.lap());
    add_field(run, fields[i], statistics, files_of_field(names[i], r.options.sites),
              r.selections.labels.empty() ? nullptr : &r.selections.labels[i]);
    fields[i] = {};
  }
  progress.clear();
  finish(r, run, image.grid, context);
}

void run(const Arguments& arguments) {
  const Request request = parse(arguments);
  const InputKind kind = input_kind(request.input);
  // A .nrrd field can also be read as an image of its distances. Then only --threshold can select voxels.
  const bool is_image = file_extension(request.input) == ".nrrd";
  if (kind == InputKind::field && !(is_image && arguments.threshold)) {
    throw FileError("'" + request.input.string() + "' is a field; a mesh or a voxel image is needed here" +
                    (is_image ? "; --threshold reads it as an image" : ""));
  }
  check_applicable(arguments, request, kind);
  Progress progress(!request.report.quiet);
  const Interrupt interrupt;
  kind == InputKind::mesh ? run_mesh(request, progress, interrupt) : run_image(request, progress, interrupt);
}

}  // namespace

void add_field_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand("field", "Exact distance and closest site at every node of a grid");
  command.add_option("INPUT", a->input, extensions_help({FileContent::mesh, FileContent::image}, FileAccess::read))
      .required();
  command
      .add_option("-o,--output", a->output,
                  "Field file: .npz, .vti or .nrrd (then also OUT.site.nrrd; for order 2 also OUT.distance2.nrrd and "
                  "OUT.site2.nrrd)")
      .required()
      .type_name("FILE");
  const auto text = [&](const char* name, std::optional<std::string>& value, const char* type, const char* help) {
    add_text_option(command, name, value, type, help);
  };
  text("--resolution", a->resolution, "N",
       "Mesh: number of nodes along the longest side of the grid, 2 to 65536 (default 256)");
  text("--spacing", a->spacing, "H", "Mesh: distance between neighbouring nodes, in mesh units; replaces --resolution");
  text("--bounds", a->bounds, "BOX",
       "Mesh: box of the grid x0,y0,z0,x1,y1,z1, enlarged to whole steps; a side of length 0 gives a 2D field");
  text("--padding", a->padding, "F", "Mesh: margin around the shape, as a fraction of its longest side (default 0.1)");
  a->options.add_to(command, "", {}, true);
  add_label_option(
      command, a->labels,
      "Image: select the voxels of value L; several values (1,3 or --label 1 --label 3) give one field each");
  text("--threshold", a->threshold, "T",
       "Image: select the voxels of value T or more (default: all voxels that are not 0)");
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_device_option(command, a->device);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
