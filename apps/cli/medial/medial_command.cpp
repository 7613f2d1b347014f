#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/axis/extend_axis.hpp"
#include "blum/axis/label_patch_sheets.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/certified/certified_axis.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/smooth_surface.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/draft.hpp"
#include "blum/io/extended_io.hpp"
#include "blum/io/graph_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/axis_patches.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/input_facts.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"
#include "medial/axis_graph_file.hpp"
#include "medial/axis_solid.hpp"
#include "medial/extended_file.hpp"
#include "medial/medial_report.hpp"
#include "medial/medial_run.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum medial part.stl -o part.vtp                        all columns, for ParaView
  blum medial part.stl -o part.vtp --theta 20,60,120      writes part-theta20.vtp, part-theta60.vtp, ...
  blum medial knot.ply -o knot.obj --theta 170            curves, for Blender
  blum medial part.stl -o part.vtp --graph part.json      also sheets with thickness, seams, curves, junctions
  blum medial part.stl -o part.vtp --theta 110 --extend shell.ply   also its sheets extended to the surface
  blum medial scan.nii.gz -o vessels.npz --label 1,3      writes vessels-label1.npz and vessels-label3.npz
  blum medial scan.nii.gz -o vessels.npz --smooth         axis of the smooth surface of the voxels

Exit status 3: an axis is not certified. Only --allow-uncertified writes such an axis.)";

struct Arguments {
  std::string input;
  std::string output;
  std::optional<std::string> theta, prune, decimate, threshold, weld, threads, graph, patch_angle, patch_fit, extend,
      extend_length;
  OptionTexts<MedialAxisOptions> options;
  std::vector<std::string> labels;
  bool allow_uncertified = false;
  bool nested = false;
  bool smooth = false;
  ReportOptions report;
};

struct Request {
  fs::path input;
  fs::path output;
  std::optional<fs::path> graph;
  std::optional<double> patch_fit;             ///< mesh units; if unset, bends alone decide on patches
  std::optional<VoronoiPatchOptions> patches;  ///< set if the file gets sheets of pairs of patches
  std::optional<fs::path> extend;
  ExtendOptions extending;
  MedialAxisOptions options;
  std::vector<double> thetas{60};  ///< requested angles; in ascending order if whole sheets are pruned
  bool prunes_sheets = false;
  std::optional<double> decimate;  ///< tolerance in mesh units; if unset, a quarter of a voxel
  Selections selections;
  std::optional<double> weld;
  bool allow_uncertified = false;
  bool nested = false;
  bool smooth = false;          ///< for images: use the smooth surface of the selected voxels
  bool has_resolution = false;  ///< true also if a spacing is given; the voxels may then differ from those of the image
  int threads = 0;
  ReportOptions report;
};

std::vector<double> parse_thetas(const std::string& text) {
  std::vector<double> thetas;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const double theta = parse_angle("--theta", std::string_view(text).substr(begin, end - begin));
    if (std::find(thetas.begin(), thetas.end(), theta) != thetas.end()) {
      throw UsageError("--theta contains " + rounded_text(theta) + " twice");
    }
    thetas.push_back(theta);
    begin = end + 1;
  }
  return thetas;
}

Request parse(const Arguments& a) {
  Request r;
  r.input = a.input;
  r.output = a.output;
  check_extension("--output", r.output, file_extensions(FileContent::complex, FileAccess::both));
  if (r.input.empty()) throw UsageError("INPUT needs a file name");
  r.graph = parse_graph(a.graph);
  if (a.patch_fit && !r.graph && !a.patch_angle) {
    throw UsageError("--patch-fit is for graphs and sheets of patches; add --graph or --patch-angle");
  }
  if (a.patch_fit) r.patch_fit = parse_positive("--patch-fit", *a.patch_fit);
  if (a.patch_angle) r.patches = {parse_angle("--patch-angle", *a.patch_angle), r.patch_fit};
  r.extend = parse_extend(a.extend);
  r.extending = parse_extend_length(a.extend_length, r.extend.has_value());
  exclude(a.options.has("resolution"), "--resolution", a.options.has("spacing"), "--spacing",
          "each sets the voxel size");
  r.options = a.options.read();
  if (a.theta) r.thetas = parse_thetas(*a.theta);
  if (a.prune && *a.prune != "sheets") throw UsageError("--prune '" + *a.prune + "': must be sheets");
  r.prunes_sheets = a.prune.has_value();
  r.nested = a.nested;
  r.smooth = a.smooth;
  r.has_resolution = a.options.has("resolution") || a.options.has("spacing");
  if (r.nested && !may_hold_further(r.output)) {
    throw UsageError(
        "--nested needs an output with the extension .npz; other formats store the axis of only one angle");
  }
  if (r.nested && r.thetas.size() > 1) {
    throw UsageError(
        "--nested stores the axes of all angles from --theta upwards in one file; give --theta only one angle");
  }
  if (a.decimate) r.decimate = parse_non_negative("--decimate", *a.decimate);
  if (r.nested && r.decimate.value_or(0) > 0) {
    throw UsageError("--nested keeps all vertices, because its axes share them; remove --decimate");
  }
  if (r.nested) r.decimate = 0;
  exclude(r.nested, "--nested", r.prunes_sheets, "--prune",
          "--nested stores the order in which single cells are removed, but --prune removes whole sheets");
  if (r.prunes_sheets) std::sort(r.thetas.begin(), r.thetas.end());
  // Sheets are pruned as a whole. So the axis must first contain whole sheets (angles from 0 degrees).
  r.options.least_theta = r.prunes_sheets ? 0 : *std::min_element(r.thetas.begin(), r.thetas.end());
  if (!r.prunes_sheets && !r.nested) r.options.greatest_theta = *std::max_element(r.thetas.begin(), r.thetas.end());
  r.selections = parse_selections(a.labels, a.threshold);
  r.weld = parse_weld(a.weld);
  r.allow_uncertified = a.allow_uncertified;
  r.threads = parse_threads(a.threads);
  r.report = a.report;
  return r;
}

void check_applicable(const Arguments& a, const fs::path& input, InputKind kind) {
  if (kind == InputKind::mesh) {
    refuse_given({{!a.labels.empty(), "--label"}, {a.threshold.has_value(), "--threshold"}, {a.smooth, "--smooth"}},
                 input, "a mesh", "images");
    return;
  }
  refuse_given({{a.weld.has_value(), "--weld"}}, input, "an image", "meshes");
  if (a.smooth) return;
  refuse_given({{a.extend.has_value(), "--extend"}, {a.patch_angle.has_value(), "--patch-angle"}}, input, "an image",
               "meshes and images with --smooth");
  refuse_given({{a.options.has("resolution"), "--resolution"},
                {a.options.has("spacing"), "--spacing"},
                {a.options.has("max_resolution"), "--max-resolution"},
                {a.options.has("grid_shift"), "--grid-shift"}},
               input, "an image", "meshes and images with --smooth");
}

/// Returns the file name for one of several angles: OUT-theta20.vtp for OUT.vtp.
fs::path with_theta(const fs::path& path, double theta) {
  fs::path name = path.parent_path() / path.stem();
  name += "-theta" + rounded_text(theta);
  name += path.extension();
  return name;
}

/// Returns the requested side of the voxels for a mesh.
double asked_spacing(const SolidInput& input, const MedialAxisOptions& options) {
  const Vec3d size = bounds(input.mesh.mesh).size();
  return options.spacing.value_or(std::max({size.x, size.y, size.z}) / options.resolution);
}

/// Describes the bodies whose voxels are finer than requested, and the reason. Returns an empty text if there are none.
std::string refined_text(const MedialAxisReport& report, double asked) {
  std::size_t finer = 0;
  double finest = asked;
  for (const BodyReport& body : report.bodies) {
    if (body.spacing < asked * (1 - 1e-9)) ++finer;
    finest = std::min(finest, body.spacing);
  }
  if (finer == 0) return {};
  const std::string of_bodies =
      report.bodies.size() == 1 ? ""
                                : " for " + count_text(finer) + " of " + count_text(report.bodies.size()) + " bodies";
  return "voxels from side " + rounded_text(asked) + " to " + rounded_text(finest) + of_bodies +
         (report.rule == SolidRule::polyhedron ? ": with larger voxels, the topology of the model is not proven"
                                               : ": no larger voxel has its centre inside");
}

/// Returns the sides of voxels as text, for example " 0.5". If bodies differ, it is " 0.25 to 0.5". For an image with
/// unequal sides it is "s (0.5, 1, 2.5)".
std::string sides_text(const MedialAxisReport& report) {
  const Vec3d& sides = report.grid.spacing;
  if (report.rule == SolidRule::voxels && (sides.x != sides.y || sides.y != sides.z)) return "s " + vector_text(sides);
  const auto [least, most] =
      std::minmax_element(report.bodies.begin(), report.bodies.end(),
                          [](const BodyReport& a, const BodyReport& b) { return a.spacing < b.spacing; });
  return " " + rounded_text(least->spacing) +
         (least->spacing < most->spacing ? " to " + rounded_text(most->spacing) : "");
}

void add_report(MedialRun& run, const MedialAxisReport& report, std::optional<double> asked, Json& json) {
  std::size_t voxels = 0;
  std::size_t extra = 0;
  for (const BodyReport& body : report.bodies) {
    voxels += body.voxels;
    extra += body.extra_cells;
  }
  json["asked_spacing"] = asked ? Json(*asked) : Json(nullptr);
  json.update(to_json(report));
  json.erase("seconds");   // reported once for all solids
  json.erase("warnings");  // reported once for all solids, too
  run.table.detail("solid", betti_text(report.betti) + " (" + report.reason + ")");
  run.table.detail("voxels", count_text(voxels) + " of side" + sides_text(report) +
                                 (extra > 0 ? "; " + count_text(extra) + " further cells for thinner parts" : ""));
  if (const std::string text = asked ? refined_text(report, *asked) : ""; !text.empty()) run.table.add("refined", text);
  run.warnings.insert(run.warnings.end(), report.warnings.begin(), report.warnings.end());
}

/// If --graph is given, writes the graph of an axis and returns its JSON; else returns null.
Json add_graph(MedialRun& run, const Request& r, const SolidInput& input, const Complex& complex,
               const MedialMetadata& metadata, const fs::path& name, const Context& context) {
  if (!r.graph) return nullptr;
  Stopwatch watch;
  AxisGraphOptions options;
  options.homotopy_angle = metadata.theta;
  options.patch_fit = r.patch_fit;
  options.of_patches = r.patches.has_value();
  if (r.patches) options.patch_angle = r.patches->patch_angle;
  const AxisGraph graph = input.kind == InputKind::mesh ? axis_graph(complex, input.mesh.mesh, options, context)
                                                        : axis_graph(complex, options, context);
  run.graphs.emplace_back(beside_axis(*r.graph, r.output, name));
  write_graph(run.graphs.back().path(), graph, metadata);
  run.phases.push_back({"graph", watch.lap()});
  run.table.add("graph", graph_text(graph));
  return graph_json(graph, run.graphs.back().name());
}

/// If --extend is given, writes the extended surface of an axis and returns its JSON; else returns null.
Json add_extended(MedialRun& run, const Request& r, const SolidInput& input, const Complex& complex,
                  const MedialMetadata& metadata, const fs::path& name, const Context& context) {
  if (!r.extend) return nullptr;
  Stopwatch watch;
  const ExtendedAxis made = extend_axis(complex, input.mesh.mesh, r.extending, context);
  run.extended.emplace_back(beside_axis(*r.extend, r.output, name));
  write_extended(run.extended.back().path(), made.surface, metadata, context);
  run.phases.push_back({"extend", watch.lap()});
  run.table.add("extended", extended_text(made.report));
  for (const Warning& warning : made.warnings) {
    const std::string angle = rounded_text(metadata.theta.value_or(0));
    run.warnings.emplace_back(warning.code, "at theta " + angle + " " + warning.text);
  }
  return extended_json(made.report, run.extended.back().name());
}

/// Returns the metadata of the construction, with the input and the version added.
MedialMetadata for_file(MedialMetadata metadata, const Request& r, const SolidInput& input,
                        const LabelSelection& selection) {
  metadata.source = r.input.filename().string();
  metadata.version = BLUM_VERSION;
  record(selection, r.weld, r.smooth ? InputKind::image : input.kind, metadata);
  if (r.smooth) metadata.smooth = SmoothSurfaceOptions{}.iterations;
  return metadata;
}

/// Solid whose axes are requested.
struct AskedSolid {
  const SolidInput& input;
  const SolidVerifier& verifier;
  const LabelSelection& selection;
  std::optional<std::int64_t> label;
  const fs::path& output;
  Json smooth;  ///< report on the solid's smooth surface; null if it is not used
};

/// Axes in draft files. Each grid position has separate drafts, because the best position may not be the last one.
class AxisDrafts {
 public:
  AxisDrafts(const Request& r, const AskedSolid& solid, const Context& context)
      : r_(r), solid_(solid), context_(context) {
    if (!r.patches) return;
    polyhedron_ = of_file(r.input, [&] {
      Solid solid_of_mesh = Solid::of(solid.input.mesh.mesh, context);
      check_manifold(solid_of_mesh);
      return solid_of_mesh;
    });
  }

  /// Writes an axis to a file, reads the file, and certifies the axis that it contains.
  Certificate certify(const AxisCandidate& axis) {
    Stopwatch watch;
    const MedialMetadata metadata = for_file(axis.metadata, r_, solid_.input, solid_.selection);
    const fs::path& path = draft_of(axis.grid_shift, *metadata.theta).path();
    const Complex& complex = with_patches(axis);
    if (polyhedron_) axis.phases.push_back({"patches", watch.lap()});
    if (r_.nested) {
      write_medial(path, complex, axis.whole->nested(context_), axis.whole->least_theta(), metadata, context_);
    } else {
      write_medial(path, complex, metadata, context_);
    }
    axis.phases.push_back({"write", watch.lap()});
    Certificate certificate = solid_.verifier.certificate_of(path, metadata, solid_.selection, context_);
    axis.phases.push_back({"certificate", watch.lap()});
    return certificate;
  }

  /// Returns the draft with the axis that was certified last for this grid position and angle.
  Draft& draft_of(double grid_shift, double theta) {
    const fs::path name = r_.thetas.size() == 1 ? solid_.output : with_theta(solid_.output, theta);
    return drafts_.try_emplace({grid_shift, theta}, name).first->second;
  }

  /// Returns the axis in this draft. @param made the same axis without patches.
  const Complex& axis_of(double grid_shift, double theta, const Complex& made) const {
    const auto at = with_patches_.find({grid_shift, theta});
    return at == with_patches_.end() ? made : at->second;
  }

 private:
  /// Returns the axis as it is written: with the columns of patches if they are requested.
  const Complex& with_patches(const AxisCandidate& axis) {
    if (!polyhedron_) return axis.axis.axis;
    Complex& out = with_patches_[{axis.grid_shift, *axis.metadata.theta}];
    out = axis.axis.axis;
    add_axis_patch_columns(out, *polyhedron_, *r_.patches, context_);
    label_patch_sheets(out, context_);
    return out;
  }

  const Request& r_;
  const AskedSolid& solid_;
  const Context& context_;
  std::optional<Solid> polyhedron_;  ///< set if patches are requested
  std::map<std::pair<double, double>, Draft> drafts_;
  std::map<std::pair<double, double>, Complex> with_patches_;  ///< for each draft, its axis; empty without patches
};

/// Adds the axis for one angle to the results.
/// @param complex  the axis as its file contains it.
/// @param size  the result of size_of() for the solid.
void add_axis(MedialRun& run, const Request& r, const AskedSolid& solid, const CertifiedAxis& made,
              const Complex& complex, bool model_passes, double size, Draft&& draft, Json& axes,
              const Context& context) {
  const SolidInput& input = solid.input;
  const Certificate& certificate = made.certificate;
  const MedialMetadata metadata = for_file(made.metadata, r, input, solid.selection);
  const double theta = *metadata.theta;
  run.drafts.push_back(std::move(draft));
  const fs::path& name = run.drafts.back().name();
  run.warnings.insert(run.warnings.end(), made.warnings.begin(), made.warnings.end());
  run.is_kept.push_back((certificate.holds() && model_passes) || r.allow_uncertified);
  const MedialCounts counts = count(made.axis.axis);
  add_certificate(run.table, " at theta " + rounded_text(theta), certificate, r.nested, size);
  add_axis_counts(run.table, "", counts, true);
  add_decimated(run.table, made, size);
  axes.push_back({{"theta", theta},
                  {"file", name.string()},
                  {"counts", counts_json(counts, true)},
                  {"deviation", made.axis.deviation},
                  {"vertices_before", made.axis.vertices_before},
                  {"graph", add_graph(run, r, input, complex, metadata, name, context)},
                  {"extended", add_extended(run, r, input, made.axis.axis, metadata, name, context)},
                  {"certificate", certificate_json(certificate, r.nested)}});
}

MedialAxis make_axis(const SolidInput& input, const MedialAxisOptions& options, const Context& context) {
  if (input.kind == InputKind::image) return medial_axis(input.image, options, context);
  if (options.spacing) check_spacing(*options.spacing, bounds(input.mesh.mesh));
  return medial_axis(input.mesh.mesh, options, context);
}

/// Replaces an image by its smooth surface, as the input.
SolidInput smooth_input(MedialRun& run, const SolidInput& image, const LabelSelection& selection,
                        const Context& context) {
  Stopwatch watch;
  SmoothSurface surface = smooth_surface(image.image, selection, {}, context);
  run.phases.push_back({"surface", watch.lap()});
  run.table.add("smooth", count_text(surface.mesh.triangles.size()) + " triangles; moved by at most " +
                              rounded_text(surface.largest_move) + " voxels from the surface of the boxes");
  SolidInput out;
  out.json = {{"iterations", SmoothSurfaceOptions{}.iterations},
              {"triangles", surface.mesh.triangles.size()},
              {"largest_move", surface.largest_move},
              {"held_vertices", surface.held_vertices}};
  out.mesh.mesh = std::move(surface.mesh);
  return out;
}

/// Adds the axes of a solid for all requested angles to the results.
void add_axes(MedialRun& run, const Request& r, const AskedSolid& solid, const MedialAxisOptions& options,
              const Context& context) {
  const bool is_mesh = solid.input.kind == InputKind::mesh;
  AxisDrafts drafts(r, solid, context);
  const auto make = [&](double shift) {
    MedialAxisOptions moved = options;
    moved.grid_shift = shift;
    return std::make_shared<const MedialAxis>(make_axis(solid.input, moved, context));
  };
  const auto certify = [&](const AxisCandidate& axis) { return drafts.certify(axis); };
  const CertifiedAxes made =
      certified_axes({options.grid_shift, is_mesh, make}, certify,
                     {r.thetas, r.decimate, r.prunes_sheets, OptionStyle::command_line}, context);
  run.phases.insert(run.phases.end(), made.phases.begin(), made.phases.end());
  Json json = {{"smooth", solid.smooth}, {"grid_shift", made.grid_shift}};
  if (solid.label) {
    json["label"] = *solid.label;
    run.table.add("label", std::to_string(*solid.label));
  }
  run.warnings.insert(run.warnings.end(), made.warnings.begin(), made.warnings.end());
  add_report(run, made.report, is_mesh ? std::optional(asked_spacing(solid.input, options)) : std::nullopt, json);
  run.mismatches.insert(run.mismatches.end(), made.mismatches.begin(), made.mismatches.end());
  Json axes = Json::array();
  const double size = size_of(solid.input, solid.selection, context);
  for (const CertifiedAxis& axis : made.axes) {
    const double theta = *axis.metadata.theta;
    add_axis(run, r, solid, axis, drafts.axis_of(made.grid_shift, theta, axis.axis.axis), made.report.topology_matches,
             size, std::move(drafts.draft_of(made.grid_shift, theta)), axes, context);
  }
  json["axes"] = axes;
  run.solids.push_back(json);
}

void add_solid(MedialRun& run, const Request& r, const SolidInput& given, const LabelSelection& selection,
               const std::optional<std::int64_t>& label, const fs::path& output, const Context& context) {
  MedialAxisOptions options = r.options;
  options.selection = selection;
  const SolidInput surface = r.smooth ? smooth_input(run, given, selection, context) : SolidInput{};
  if (r.smooth && !r.has_resolution) {
    // The spacing is that of the image, within limits: the surface may be smaller than a voxel, or flat.
    const Vec3d& sides = given.image.grid.spacing;
    const Vec3d size = bounds(surface.mesh.mesh).size();
    const double longest = std::max({size.x, size.y, size.z});
    options.spacing = std::clamp(std::min({sides.x, sides.y, sides.z}), longest / options.max_resolution, longest / 8);
  }
  const SolidInput& input = r.smooth ? surface : given;
  const SolidVerifier verifier(input);
  add_axes(run, r, {input, verifier, selection, label, output, surface.json}, options, context);
}

std::vector<fs::path> outputs_of(const Request& r) {
  std::vector<fs::path> bases{r.output};
  if (r.selections.labels.size() > 1) {
    bases.clear();
    for (const std::int64_t label : r.selections.labels) bases.push_back(with_label(r.output, label));
  }
  return bases;
}

void check_all_outputs(const Request& r, const std::vector<fs::path>& bases) {
  std::vector<fs::path> files = r.report.files();
  for (const fs::path& base : bases) {
    if (r.thetas.size() == 1) files.push_back(base);
    if (r.thetas.size() > 1) {
      for (const double theta : r.thetas) files.push_back(with_theta(base, theta));
    }
  }
  const std::size_t axes = files.size();
  for (const std::optional<fs::path>& further : {r.graph, r.extend}) {
    for (std::size_t f = r.report.files().size(); further && f < axes; ++f) {
      files.push_back(beside_axis(*further, r.output, files[f]));
    }
  }
  check_outputs(files, {r.input});
}

void finish(const Request& r, MedialRun& run, const SolidInput& input, bool is_certified, const Context& context) {
  const PhaseSummary spent = summarize(run.phases);
  Json outputs = Json::array();
  for (std::size_t d = 0; d < run.drafts.size(); ++d) {
    if (!run.is_kept[d]) continue;
    for (const std::vector<Draft>* const kind : {&run.drafts, &run.graphs, &run.extended}) {
      if (kind->empty()) continue;
      outputs.push_back((*kind)[d].name().string());
      run.table.add("wrote", (*kind)[d].name().string());
    }
  }
  const Json json = answer_json("medial", {{"input", input.json},
                                           {"certified", is_certified},
                                           {"mismatches", run.mismatches},
                                           {"lambda", r.options.lambda},
                                           {"prune", r.prunes_sheets ? Json("sheets") : Json(nullptr)},
                                           {"solids", run.solids},
                                           {"seconds", spent.seconds},
                                           {"total_seconds", spent.total},
                                           {"peak_memory_bytes", peak_memory()},
                                           {"threads", thread_count(context)},
                                           {"thread_backend", thread_backend()},
                                           {"warnings", to_json(run.warnings)},
                                           {"outputs", outputs}});
  run.table.add(input.table);
  spent.add_to(run.table);
  report(r.report, json, run.table);
  if (!r.report.quiet) warn(run.warnings);
}

/// If an axis is not certified, describes the files that were written.
std::string written_text(const Request& r, const MedialRun& run) {
  if (r.allow_uncertified) return {};
  const auto kept = std::count(run.is_kept.begin(), run.is_kept.end(), true);
  if (kept == 0) return "; nothing was written";
  return "; of " + count_text(run.drafts.size()) + " axes, only the " + count_text(static_cast<std::size_t>(kept)) +
         " certified ones were written";
}

void run(const Arguments& arguments) {
  const Request r = parse(arguments);
  check_applicable(arguments, r.input, input_kind(r.input));
  const std::vector<fs::path> bases = outputs_of(r);
  check_all_outputs(r, bases);
  Progress progress(!r.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(r.threads, progress, interrupt);
  MedialRun run;
  Stopwatch watch;
  const SolidInput input = load_solid(r.input, r.weld, r.selections.labels);
  run.warnings = warnings_of(input);
  run.phases.push_back({"read", watch.lap()});
  const std::vector<LabelSelection> selections = r.selections.all();
  for (std::size_t s = 0; s < selections.size(); ++s) {
    const bool is_label = !r.selections.labels.empty();
    add_solid(run, r, input, selections[s], is_label ? std::optional(r.selections.labels[s]) : std::nullopt,
              bases[std::min(s, bases.size() - 1)], context);
  }
  progress.clear();
  const bool is_certified = run.mismatches.empty();
  for (std::size_t d = 0; d < run.drafts.size(); ++d) {
    if (!run.is_kept[d]) continue;
    run.drafts[d].keep();
    if (r.graph) run.graphs[d].keep();
    if (r.extend) run.extended[d].keep();
  }
  finish(r, run, input, is_certified, context);
  if (!is_certified) throw NotCertified(run.mismatches, written_text(r, run));
}

}  // namespace

void add_medial_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand("medial", "Certified medial axis with the topology of the solid");
  command.add_option("INPUT", a->input, extensions_help({FileContent::mesh, FileContent::image}, FileAccess::read))
      .required();
  command.add_option("-o,--output", a->output, "Medial axis: " + extension_list(FileContent::complex, FileAccess::both))
      .required()
      .type_name("FILE");
  const auto text = [&](const char* name, std::optional<std::string>& value, const char* type, const char* help) {
    add_text_option(command, name, value, type, help);
  };
  text("--theta", a->theta, "DEG",
       "Keep cells with separation angles above DEG degrees (default 60), and cells that connect them; several angles "
       "(20,60) give one file each. With --decimate 0, the axis of a larger angle is part of the axis of a smaller "
       "angle");
  text("--decimate", a->decimate, "TOL",
       "Reduce the number of triangles; the axis moves by at most TOL mesh units (default: a quarter of a voxel; 0 "
       "keeps all)");
  text("--prune", a->prune, "sheets",
       "Remove only whole sheets, namely those whose largest separation angle is at most --theta");
  a->options.add_to(command, "", {"least_theta", "greatest_theta"});
  add_label_option(command, a->labels,
                   "Image: select the voxels of value L; several values (1,3 or repeated) give one axis each");
  text("--threshold", a->threshold, "T",
       "Image: select the voxels of value T or more (default: all voxels that are not 0)");
  command.add_flag("--smooth", a->smooth,
                   "Image: use the solid inside the smooth surface of the voxels, instead of the boxes of the voxels");
  add_graph_option(command, a->graph, "Also write the sheets, seams, curves and junctions of the axis as a graph");
  text(
      "--patch-angle", a->patch_angle, "DEG",
      "Mesh: add columns with the patches of the surface on both sides of each triangle (patch_a, patch_b), and with "
      "the sheets of these pairs (patch_sheet). The graph is that of the patches. Edges inside a patch bend by at most "
      "DEG degrees, 0 to 180 (30 suits most meshes)");
  add_text_option(command, "--patch-fit", a->patch_fit, "TOL",
                  "Mesh: patches are planes, spheres, cylinders and cones whose vertices lie within TOL mesh units "
                  "(default: smooth parts of the surface)");
  add_extend_options(command, a->extend, a->extend_length);
  command.add_flag("--nested", a->nested,
                   "Also store the axes of all angles from --theta upwards (.npz), for `blum view`");
  command.add_flag("--allow-uncertified", a->allow_uncertified, "Write the axis even if it is not certified");
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
