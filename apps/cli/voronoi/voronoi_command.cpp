#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/voronoi_io.hpp"
#include "blum/solid/clean_mesh.hpp"
#include "blum/solid/solid.hpp"
#include "blum/solid/solid_warnings.hpp"
#include "blum/voronoi/failing_cells.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"
#include "medial/medial_report.hpp"
#include "shape/cleaning.hpp"
#include "voronoi/voronoi_axis.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum voronoi part.stl -o part.vtp                walls and surface with their sites, for ParaView
  blum voronoi part.stl -o walls.ply --walls       walls between regions, without the surface
  blum voronoi part.stl -o axis.vtp --medial       medial axis: walls with two footprints
  blum voronoi part.stl -o axis.vtp --medial --theta 60 --decimate 0.01    angles above 60 degrees; fewer triangles
  blum voronoi part.stl -o part.npz --resolution 32    smaller triangles: cubes of at most 1/32 of the box
  blum voronoi part.stl -o part.vtp --tolerance 0.1    at most 0.1 mesh units from the exact walls
  blum voronoi scan.stl -o scan.vtp --clean 0.001 --cleaned clean.ply    remove needles first, and write that mesh
  blum voronoi part.stl --walls --graph part.json --patch-angle 30    graph of smooth patches instead of triangles
  blum voronoi part.stl --walls --graph part.json --patch-fit 0.001    graph of planes, cylinders, cones and spheres
  blum voronoi part.stl --json -                   report only: sites, cubes, certificate

Exit status 3: the complex is not certified. Only --allow-uncertified writes it.)";

struct Arguments {
  std::string input;
  std::optional<std::string> output, clean, cleaned, weld, threads;
  OptionTexts<VoronoiOptions> options;
  bool walls = false;
  bool medial = false;
  VoronoiAxisTexts axis;
  bool allow_uncertified = false;
  ReportOptions report;
};

bool is_wall(std::int32_t site_a) {
  return site_a != -1;
}

SolidInput read_mesh_input(const fs::path& path, std::optional<double> weld) {
  if (kind_of_input(path) != InputKind::mesh) {
    throw FileError("'" + path.string() + "' is not a mesh; `blum voronoi` needs a closed mesh");
  }
  return load_solid(path, weld);
}

/// Returns the name of the part's complex, for messages.
std::string subject_of(VoronoiPart part) {
  if (part == VoronoiPart::medial_axis) return "the medial axis";
  return part == VoronoiPart::walls ? "Voronoi walls" : "Voronoi walls and the solid's surface together";
}

/// Returns advice on options that may increase the number of certified cubes.
std::string advice(const VoronoiReport& report, const VoronoiOptions& options, bool is_cleaned) {
  std::vector<std::string> all;
  if (options.depth < VoronoiOptions{}.depth) all.emplace_back("a larger --depth may help");
  if (report.stopped_at_max_cubes) {
    all.push_back("splitting stopped at --max-cubes " + count_text(static_cast<std::size_t>(options.max_cubes)) +
                  (options.tolerance || options.resolution > VoronoiOptions{}.resolution
                       ? ", which is too few for this --resolution or --tolerance"
                       : ""));
  }
  if (!is_cleaned && options.depth == VoronoiOptions{}.depth) {
    all.emplace_back("if coordinates are rounded, as in .stl files, --clean with a small tolerance may help");
  }
  std::string out;
  for (const std::string& one : all) out += "; " + one;
  return out;
}

/// Returns the reasons why a complex is not certified. Returns none if it is certified.
std::vector<std::string> mismatches_of(const VoronoiReport& report, const VoronoiOptions& options, bool is_cleaned) {
  std::vector<std::string> all;
  if (report.certified) return all;
  if (!report.failing.empty()) {
    const FailingVoronoiCell& first = report.failing.front();
    std::string text = report.failing.size() == 1
                           ? "a cube does not pass the local test,"
                           : count_text(report.failing.size()) + " cubes do not pass the local test, the first one";
    text += " from " + vector_text(first.low) + " to " + vector_text(first.high) + " (" +
            std::string(to_string(first.obstacle)) + ")";
    all.push_back(text + advice(report, options, is_cleaned));
  }
  if (report.undecided_lines > 0) {
    all.push_back("on " + plural(report.undecided_lines, "part of a grid line", "parts of grid lines") +
                  " the closest site is unknown");
  }
  if (report.contradictions > 0) {
    all.push_back("at " + plural(report.contradictions, "node", "nodes") +
                  " of the grid the closest site is contradictory, for every grid position that was tried");
  }
  if (report.found != report.expected) {
    all.push_back("the complex has " + betti_text(report.found) + ", but " + subject_of(options.part) +
                  (options.part == VoronoiPart::medial_axis ? " has " : " have ") + betti_text(report.expected));
  }
  return all;
}

/// Counts of a complex, for JSON and for text.
struct Counts {
  std::size_t vertices = 0;
  std::size_t walls = 0;    ///< number of triangles
  std::size_t surface = 0;  ///< number of triangles

  explicit Counts(const Complex& complex) : vertices(complex.positions.size()) {
    const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
    walls = static_cast<std::size_t>(std::count_if(site_a.begin(), site_a.end(), is_wall));
    surface = site_a.size() - walls;
  }
  [[nodiscard]] Json json() const {
    return {{"vertices", vertices},
            {"triangles", walls + surface},
            {"wall_triangles", walls},
            {"surface_triangles", surface}};
  }
  [[nodiscard]] std::string text() const {
    return plural(vertices, "vertex", "vertices") + ", " + plural(walls + surface, "triangle", "triangles") + ": " +
           count_text(walls) + " on walls, " + count_text(surface) + " on the surface";
  }
};

std::string sites_text(const VoronoiReport& report) {
  std::string text = plural(report.faces, "flat face", "flat faces") + ", " +
                     plural(report.reflex_edges, "reflex edge", "reflex edges") + ", " +
                     plural(report.reflex_vertices, "reflex vertex", "reflex vertices");
  if (report.thin_vertices > 0) text += " (" + count_text(report.thin_vertices) + " of them thin)";
  return text;
}

/// Describes the voids of a complex that contains the surface.
std::string regions_text(const VoronoiReport& report, VoronoiPart part) {
  const bool is_each = part == VoronoiPart::all && report.certified && report.thin_vertices == 0;
  return is_each ? " (each is the region of one site)" : "";
}

std::string certificate_text(VoronoiPart part, bool is_exact) {
  if (is_exact) return "each wall, seam and junction is that of the exact diagram";
  if (part == VoronoiPart::medial_axis) return "same topology (homology) as the exact medial axis and as the solid";
  return "same topology (homology) as the exact diagram";
}

std::string proof_text(const VoronoiReport& report) {
  return count_text(report.proven_junctions) + " of " + plural(report.junctions, "junction", "junctions") + ", " +
         count_text(report.proven_seams) + " of " + plural(report.seams, "seam", "seams") +
         (report.open.empty() ? "" : "; the list \"open\" in the JSON summary contains the others");
}

void add_facts(const VoronoiReport& report, VoronoiPart part, const Counts& counts, double size, TextTable& table) {
  table.add("certified", report.certified ? "yes: " + certificate_text(part, report.exact || report.proven) : "NO");
  table.add("topology", subject_of(part) + ": " + betti_text(report.found) + regions_text(report, part) +
                            (report.found == report.expected ? "" : "; expected " + betti_text(report.expected)));
  table.add("sites", sites_text(report));
  if (report.flatness > 0) {
    table.detail("flatness", "corners of triangles lie at most " + share_text(report.flatness, size) +
                                 " from the planes of their faces");
  }
  if (report.joined > 0) {
    table.detail("joined",
                 "junctions and seams within " + share_text(report.joined, size) + " of each other are merged");
  }
  if (report.traced) {
    table.add("traced", "walls are at most " + share_text(report.label_error, size) +
                            " farther from their own sites than from the surface");
    table.add("proven", proof_text(report));
  } else if (!report.trace_problem.empty()) {
    table.add("traced", "no, cubes instead: " + report.trace_problem);
  }
  if (!report.exact && !report.traced) {
    table.detail("cubes", count_text(report.cubes) + ", with " + plural(report.squares, "square", "squares") + "; " +
                              plural(report.splits, "split", "splits") + ", the smallest cube split " +
                              std::to_string(report.depth) + " times; " + rounded_text(report.governors) +
                              " labels in a cube on average");
    table.detail("lines", plural(report.lines, "part of a grid line", "parts of grid lines") + ", " +
                              count_text(report.exact_lines) + " of them decided by exact signs");
  }
  table.add("complex", counts.text());
  if (report.certified) {
    table.add("error", report.traced ? "chords of curved walls are within " + share_text(report.chord, size)
                                     : "Hausdorff distance from the exact diagram at most " +
                                           share_text(report.hausdorff_bound, size));
  }
}

struct Request {
  VoronoiOptions options;
  VoronoiAxisOptions axis;
  std::optional<double> clean;  ///< tolerance in mesh units
  std::optional<double> weld;
  int threads = 0;
};

/// Returns the path of the mesh to which the ids of triangles, edges and vertices refer.
fs::path source_of(const Arguments& a) {
  return a.cleaned ? *a.cleaned : a.input;
}

FileMetadata metadata_of(const Arguments& a, const Request& r, const VoronoiReport& report) {
  FileMetadata out =
      voronoi_metadata(r.options.part, report.certified ? std::optional(report.hausdorff_bound) : std::nullopt,
                       report.failing.size(), BLUM_VERSION);
  out.emplace_back("source", source_of(a).filename().string());
  if (r.weld) out.emplace_back("weld", exact_text(*r.weld));
  if (r.clean) out.emplace_back("clean", exact_text(*r.clean));
  return out;
}

Request parse(const Arguments& a) {
  Request r{a.options.read(), parse_axis_options(a.axis), {}, parse_weld(a.weld), parse_threads(a.threads)};
  if (a.clean) r.clean = parse_positive("--clean", *a.clean);
  if (a.walls && a.medial) throw UsageError("--walls and --medial select different parts of the diagram; give one");
  if (a.walls) r.options.part = VoronoiPart::walls;
  if (a.medial) r.options.part = VoronoiPart::medial_axis;
  const std::string of_axis = a.axis.given();
  if (!of_axis.empty() && !a.medial) throw UsageError(of_axis + " is for medial axes; add --medial");
  if (!of_axis.empty() && !a.output) throw UsageError(of_axis + " changes the file; add --output");
  std::vector<fs::path> outputs = a.report.files();
  if (r.axis.graph) {
    if (a.medial && !a.output) throw UsageError("--graph with --medial needs --output");
    outputs.push_back(*r.axis.graph);
  }
  if (a.cleaned) {
    check_extension("--cleaned", *a.cleaned, file_extensions(FileContent::mesh, FileAccess::both));
    outputs.emplace_back(*a.cleaned);
  } else if (a.clean && a.medial && a.output) {
    throw UsageError(
        "--clean with --medial needs --cleaned FILE, because the axis is verified against the cleaned mesh");
  }
  if (a.output) {
    // Axes are read again after they are written.
    const FileAccess access = a.medial ? FileAccess::both : FileAccess::write;
    check_extension("--output", *a.output, file_extensions(FileContent::complex, access));
    outputs.emplace_back(*a.output);
  } else if (a.allow_uncertified) {
    throw UsageError("--allow-uncertified needs --output");
  }
  check_outputs(outputs, {a.input});
  return r;
}

/// The patches of the sites, if --patch-angle or --patch-fit is given.
using Patches = std::optional<std::vector<VoronoiPatch>>;

/// If --patch-angle or --patch-fit is given, finds the patches, and adds their columns to the complex.
Patches add_patches(const Request& r, const MeshView& mesh, std::span<const VoronoiSite> sites, Complex& complex,
                    const Context& context) {
  if (!r.axis.patches) return std::nullopt;
  std::vector<VoronoiPatch> patches = voronoi_patches(mesh, sites, *r.axis.patches, context);
  add_patch_columns(complex, patches);
  return patches;
}

/// If --graph is given, computes and writes the graph of the diagram's parts. VoronoiComplex.graph() in Python returns
/// the same graph.
std::optional<VoronoiGraph> make_graph(const Arguments& a, const Request& r, std::span<const VoronoiSite> sites,
                                       const Patches& patches, const VoronoiComplex& made, const Context& context) {
  if (a.medial || !r.axis.graph) return std::nullopt;
  VoronoiGraph graph = patches ? voronoi_graph(made.complex, *patches, context) : voronoi_graph(made.complex, context);
  write_voronoi_graph(*r.axis.graph, graph, sites, metadata_of(a, r, made.report));
  return graph;
}

/// Counts shapes, for example " (2 planes, 1 cylinder)". Returns an empty text if shapes were not fitted.
std::string shapes_text(const std::vector<VoronoiPatch>& patches) {
  std::string out;
  for (const auto& named : Description<SurfaceKind>::values) {
    const auto count =
        static_cast<std::size_t>(std::count_if(patches.begin(), patches.end(), [&](const VoronoiPatch& one) {
          return one.shape && one.shape->kind == named.value;
        }));
    if (count == 0) continue;
    const std::string name(named.name);
    out += (out.empty() ? " (" : ", ") + plural(count, name, name + "s");
  }
  return out.empty() ? out : out + ")";
}

std::string patches_text(const std::vector<VoronoiPatch>& patches) {
  const auto count_of = [&](SiteKind kind) {
    return static_cast<std::size_t>(
        std::count_if(patches.begin(), patches.end(), [&](const VoronoiPatch& one) { return one.kind == kind; }));
  };
  return count_text(count_of(SiteKind::face)) + " of faces" + shapes_text(patches) + ", " +
         count_text(count_of(SiteKind::edge)) + " of reflex edges, " + count_text(count_of(SiteKind::vertex)) +
         " of reflex vertices";
}

std::string graph_text(const VoronoiGraph& graph) {
  std::string text = graph.regions.empty() ? "" : plural(graph.regions.size(), "region", "regions") + ", ";
  return text + plural(graph.walls.size(), "wall", "walls") + ", " + plural(graph.seams.size(), "seam", "seams") +
         ", " + plural(graph.junctions.size(), "junction", "junctions");
}

/// The solid whose diagram is computed.
struct Prepared {
  Solid solid;
  std::optional<CleanReport> cleaning;
};

/// Returns the solid of the input mesh. If --clean is given, the mesh is cleaned first. The solid's surface replaces
/// the input mesh, and is written if --cleaned is given.
Prepared prepare(const Arguments& a, const Request& r, SolidInput& input, std::vector<Warning>& warnings,
                 const Context& context) {
  const auto make = [&]() -> Prepared {
    const TriangleMesh& mesh = input.mesh.mesh;
    if (!r.clean) return {Solid::of(mesh, context), std::nullopt};
    CleanedMesh cleaned = clean_mesh(mesh, *r.clean, context);
    warnings = std::move(cleaned.warnings);
    return {std::move(cleaned.solid), cleaned.report};
  };
  Prepared out = of_file(a.input, make);
  if (!out.cleaning) warnings = reversal_warnings(out.solid.reversed_triangles(), out.solid.reversed_shells());
  if (out.solid.resolved()) {
    if (a.medial && a.output && !a.cleaned) {
      throw InvalidMesh("'" + a.input +
                        "': the mesh crosses itself; add --cleaned FILE to write the mesh without crossings, against "
                        "which the axis is verified");
    }
    for (Warning& warning : crossing_warnings(out.solid)) {
      if (!a.cleaned) warning.text += "; --cleaned FILE writes this surface";
      warnings.push_back(std::move(warning));
    }
  }
  input.mesh.mesh = out.solid.surface().mesh;
  if (a.cleaned) write_mesh(*a.cleaned, input.mesh.mesh);
  return out;
}

/// A diagram, and the axis that was made from it.
struct Diagram {
  VoronoiComplex made;
  Counts counts;
  std::vector<VoronoiSite> sites;
  Patches patches;
  std::vector<std::string> mismatches;  ///< reasons why the diagram is not certified
  std::optional<VoronoiAxis> axis;      ///< if it was asked for, and may be written
  std::vector<PhaseTime> phases;
};

Diagram make_diagram(const Arguments& a, const Request& r, const VoronoiOptions& options, const Solid& solid,
                     const SolidInput& input, const Context& context) {
  Stopwatch watch;
  VoronoiComplex made = of_file(a.input, [&] { return voronoi_complex(solid, options, context); });
  static_cast<void>(watch.lap());
  std::vector<PhaseTime> phases = made.report.phases;
  const Counts counts(made.complex);
  std::vector<VoronoiSite> sites = voronoi_sites(input.mesh.mesh, made.report, context);
  Patches patches = add_patches(r, input.mesh.mesh, sites, made.complex, context);
  if (patches) phases.push_back({"patches", watch.lap()});
  std::vector<std::string> mismatches = mismatches_of(made.report, options, r.clean.has_value());
  std::optional<VoronoiAxis> axis;
  if (a.output && a.medial && (mismatches.empty() || a.allow_uncertified)) {
    axis = make_voronoi_axis(made.complex, input, r.axis, source_of(a), a.cleaned ? std::nullopt : r.weld, *a.output,
                             context);
    phases.insert(phases.end(), axis->phases.begin(), axis->phases.end());
  }
  return {std::move(made),       counts,          std::move(sites), std::move(patches),
          std::move(mismatches), std::move(axis), std::move(phases)};
}

/// Makes the diagram. If the certificate refuses a traced axis, the diagram is made from cubes, unless their axis is
/// refused, too.
Diagram certified_diagram(const Arguments& a, const Request& r, const Solid& solid, const SolidInput& input,
                          const Context& context) {
  Diagram first = make_diagram(a, r, r.options, solid, input, context);
  const bool is_refused = first.axis && !first.axis->mismatches.empty() && first.made.report.traced;
  if (!is_refused || r.options.method != VoronoiMethod::automatic) return first;
  VoronoiOptions options = r.options;
  options.method = VoronoiMethod::cubes;
  Diagram second = make_diagram(a, r, options, solid, input, context);
  const bool is_better = second.mismatches.empty() && second.axis && second.axis->mismatches.empty();
  if (is_better) {
    second.made.report.trace_problem = "the traced axis is not certified: " + first.axis->mismatches.front();
  }
  Diagram& best = is_better ? second : first;
  const Diagram& other = is_better ? first : second;
  best.phases.insert(best.phases.begin(), other.phases.begin(), other.phases.end());
  return std::move(best);
}

/// Returns the names of the files that were written.
std::vector<std::string> outputs_of(const Arguments& a, bool is_written, bool is_graph_written) {
  std::vector<std::string> out;
  if (a.cleaned) out.push_back(*a.cleaned);
  if (is_written) out.push_back(*a.output);
  if (is_graph_written) out.push_back(*a.axis.graph);
  return out;
}

void run(const Arguments& a) {
  const Request r = parse(a);
  const fs::path path = a.input;
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(r.threads, progress, interrupt);
  Stopwatch watch;
  SolidInput input = read_mesh_input(path, r.weld);
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  std::vector<Warning> changes;
  const Prepared prepared = prepare(a, r, input, changes, context);
  const std::optional<CleanReport>& cleaning = prepared.cleaning;
  phases.push_back({cleaning ? "clean" : "solid", watch.lap()});
  std::vector<Warning> warnings = warnings_of(input);
  warnings.insert(warnings.end(), changes.begin(), changes.end());
  if (a.cleaned) add_rounding_warning(*a.cleaned, input.mesh.mesh, warnings);
  Diagram diagram = certified_diagram(a, r, prepared.solid, input, context);
  VoronoiComplex& made = diagram.made;
  const VoronoiReport& found = made.report;
  const Counts& counts = diagram.counts;
  const std::vector<VoronoiSite>& sites = diagram.sites;
  const Patches& patches = diagram.patches;
  phases.insert(phases.end(), diagram.phases.begin(), diagram.phases.end());
  static_cast<void>(watch.lap());
  std::vector<std::string> mismatches = diagram.mismatches;
  const bool may_write = mismatches.empty() || a.allow_uncertified;
  bool is_written = a.output && may_write;
  std::optional<VoronoiAxis>& axis = diagram.axis;
  std::optional<VoronoiGraph> graph;
  if (may_write) graph = make_graph(a, r, sites, patches, made, context);
  if (graph) phases.push_back({"graph", watch.lap()});
  if (axis) {
    mismatches.insert(mismatches.end(), axis->mismatches.begin(), axis->mismatches.end());
    is_written = mismatches.empty() || a.allow_uncertified;
    if (is_written) {
      for (Draft& draft : axis->drafts) draft.keep();
    }
    warnings.insert(warnings.end(), axis->warnings.begin(), axis->warnings.end());
  } else if (is_written) {
    ComplexWriteOptions how;
    how.allow_loss = true;  // the table of formats documents what is lost
    if (!mismatches.empty()) add_failing_cells(made.complex, found.failing);
    write_complex(*a.output, made.complex, metadata_of(a, r, found), how, context);
    phases.push_back({"write", watch.lap()});
  }
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  Json facts = {{"input", input.json}, {"options", to_json(r.options)}};
  facts["reversed_triangles"] = cleaning ? cleaning->reversed_triangles : prepared.solid.reversed_triangles();
  facts["reversed_shells"] = cleaning ? cleaning->reversed_shells : prepared.solid.reversed_shells();
  facts["cleaning"] = cleaning ? cleaning_json(*cleaning, *r.clean) : Json(nullptr);
  facts.update(to_json(found));
  facts.erase("seconds");  // add_run_facts() adds them below
  facts["certified"] = mismatches.empty();
  facts["mismatches"] = mismatches;
  facts["complex"] = counts.json();
  facts["sites"] = to_json(sites);
  facts["patches"] = patches ? Json(to_json(*patches)) : Json(nullptr);
  facts["regions"] = nullptr;
  if (r.options.part == VoronoiPart::all) {
    facts["regions"] = to_json(graph ? graph->regions : voronoi_regions(made.complex));
  }
  facts["graph"] =
      graph
          ? Json{{"walls", graph->walls.size()}, {"seams", graph->seams.size()}, {"junctions", graph->junctions.size()}}
          : Json(nullptr);
  facts["axis"] = axis ? axis->json : Json(nullptr);
  Json json = answer_json("voronoi", facts);
  const bool is_graph_written = graph || (axis && is_written && r.axis.graph);
  const std::vector<std::string> outputs = outputs_of(a, is_written, is_graph_written);
  add_run_facts(json, spent, context, warnings, outputs);
  TextTable table;
  const double size = bounds(input.mesh.mesh).diagonal();
  if (cleaning) add_cleaning(*cleaning, *r.clean, size, table);
  add_facts(found, r.options.part, counts, size, table);
  if (patches) table.add("patches", patches_text(*patches));
  if (axis) table.add(axis->table);
  if (graph) table.add("graph", graph_text(*graph));
  for (const std::string& output : outputs) table.add("wrote", output);
  table.add(input.table);
  spent.add_to(table);
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
  if (mismatches.empty()) return;
  const bool is_any_missing = a.output && !is_written;
  const std::string missing = a.cleaned ? "; only the cleaned mesh was written" : "; nothing was written";
  throw NotCertified(mismatches, is_any_missing ? missing : "");
}

}  // namespace

void add_voronoi_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand(
      "voronoi", "Certified Voronoi diagram of faces, reflex edges and reflex vertices inside a closed mesh");
  command.add_option("INPUT", a->input, extensions_help({FileContent::mesh}, FileAccess::read)).required();
  add_text_option(command, "-o,--output", a->output, "FILE",
                  "File of walls and surface: .vtp, .ply or .npz with columns, .obj without");
  command.add_flag("--walls", a->walls, "Only the walls between regions, without the surface");
  command.add_flag("--medial", a->medial,
                   "Only the medial axis: walls with two footprints, except those between a face and its own edge");
  a->axis.add_to(command);
  a->options.add_to(command, {}, {"part"});
  add_text_option(command, "--clean", a->clean, "TOL",
                  "First remove needles and unnecessary vertices as `blum clean` does, within TOL "
                  "mesh units");
  add_text_option(command, "--cleaned", a->cleaned, "FILE",
                  "Write the mesh to which the ids of sites refer: cleaned by --clean, and without crossings");
  command.add_flag("--allow-uncertified", a->allow_uncertified, "Write the complex even if it is not certified");
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
