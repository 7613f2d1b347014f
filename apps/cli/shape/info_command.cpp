#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/cuda_devices.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/grid/image_values.hpp"
#include "blum/io/field_io.hpp"
#include "blum/solid/solid.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/input_facts.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "field/field_statistics.hpp"
#include "medial/axis_graph_file.hpp"
#include "medial/axis_info.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum info bunny.obj
  blum info part.stl --weld 1e-6 --json part.json
  blum info scan.nii.gz --json - | jq .labels
  blum info part.stl --model --resolution 32       its topology, with a proof for each cell
  blum info bunny.nrrd                             a distance field
  blum info bunny.vtp                              a medial axis
  blum info bunny.vtp --graph bunny.graphml        also write its sheets, seams, curves, junctions)";

constexpr std::size_t contact_limit = 100000;  // largest number of contacts that the search returns
constexpr std::size_t pair_limit = 20;         // largest number of pairs in the JSON
constexpr std::size_t failure_limit = 10;      // largest number of failures in the text, for a model
// Largest number of labels with details; each needs a pass over the image.
constexpr std::size_t label_limit = 20;

struct Arguments {
  std::string input;
  bool devices = false;
  bool model = false;
  OptionTexts<CellularModelOptions> model_options;
  std::optional<std::string> weld, graph;
  ReportOptions report;
};

const char* yes_no(bool value) {
  return value ? "yes" : "no";
}

// ---- Meshes ----

// topology() and find_self_intersections() describe the mesh as it is. Solid::of() calls both, but first repairs the
// mesh and copies its bodies. It does not report boundaries or crossings. For a million triangles it would add 1.75 s
// to the 1.35 s of processor time of `blum info`. So it runs only if the Betti numbers are still unknown and a repair
// may help.

/// If a mesh without boundary does not bound a solid, returns the solid of the repaired mesh, if there is one.
std::optional<Solid> repaired_solid(const MeshView& mesh, const Topology& t, const SelfIntersections& contacts,
                                    const Context& context) {
  const bool is_solid = t.betti && contacts.pairs.empty();
  if (is_solid || t.triangles == 0 || t.boundary_edges > 0) return std::nullopt;
  return Solid::of(mesh, context);
}

Json repaired_json(const std::optional<Solid>& solid) {
  if (!solid) return nullptr;
  return {{"rule", to_string(solid->rule())},
          {"reason", solid->reason()},
          {"betti", solid->betti() ? to_json(*solid->betti()) : Json(nullptr)},
          {"resolved", solid->resolved() ? to_json(*solid->resolved()) : Json(nullptr)}};
}

/// If the mesh does not bound a solid, its orientation, volume and genus are null.
Json topology_json(const Topology& t, const SelfIntersections& contacts) {
  Json json = to_json(t);
  const bool whole = t.closed && t.oriented;
  std::int64_t genus = 0;
  for (const Shell& shell : t.shells) genus += shell.genus;
  json["genus"] = whole ? Json(genus) : Json(nullptr);
  if (!whole) json["faces_outwards"] = json["signed_volume"] = nullptr;
  if (contacts.crossing > 0) json["betti"] = nullptr;
  return json;
}

std::string parts_text(const BettiNumbers& betti) {
  const auto& [components, tunnels, voids] = betti;
  return plural(static_cast<std::uint64_t>(components), "component", "components") + ", " +
         plural(static_cast<std::uint64_t>(tunnels), "tunnel", "tunnels") + ", " +
         plural(static_cast<std::uint64_t>(voids), "void", "voids") + " (Betti numbers " + std::to_string(components) +
         ", " + std::to_string(tunnels) + ", " + std::to_string(voids) + ")";
}

std::string solid_text(const Topology& t, const SelfIntersections& contacts) {
  const bool crosses = t.closed && t.oriented && contacts.crossing > 0;
  if (crosses) return "no: triangles cross each other, so parts may overlap";
  if (t.betti) return "yes: " + parts_text(*t.betti);
  if (t.triangles == 0) return "no: it has no triangles";
  if (t.boundary_edges > 0) return "no: the surface has a boundary";
  if (t.nonmanifold_edges > 0) return "no: edges have more than two triangles";
  if (!t.closed) return "no: the surface is not closed";
  if (!t.oriented) return "no: triangles are not consistently oriented";
  if (!t.manifold) return "no: the surface is not a manifold";
  return "no: shells face the wrong way";
}

std::string genus_text(const Topology& t) {
  constexpr std::size_t limit = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(limit, t.shells.size()); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(t.shells[i].genus);
  }
  if (t.shells.size() > limit) text += ", ... (" + count_text(t.shells.size()) + " shells)";
  return text;
}

Json contacts_json(const SelfIntersections& contacts) {
  Json pairs = Json::array();
  for (std::size_t i = 0; i < std::min(pair_limit, contacts.pairs.size()); ++i) {
    const TrianglePair& pair = contacts.pairs[i];
    pairs.push_back({{"triangles", {pair.first.value, pair.second.value}}, {"crosses", pair.crosses}});
  }
  return {{"crossing", contacts.crossing},
          {"touching", contacts.touching},
          {"complete", contacts.complete},
          {"pairs", pairs}};
}

std::string contacts_text(const SelfIntersections& contacts) {
  if (contacts.pairs.empty()) return "none";
  const std::string crossing = plural(contacts.crossing, "pair of triangles crosses", "pairs of triangles cross");
  const std::string touching =
      contacts.touching == 0 ? "" : ", " + plural(contacts.touching, "touches or overlaps", "touch or overlap");
  return crossing + touching + (contacts.complete ? "" : ", and more: the search reached its limit");
}

std::string cells_text(const Topology& t) {
  std::string text = plural(t.vertices, "vertex", "vertices") + ", " + plural(t.edges, "edge", "edges") + ", " +
                     plural(t.triangles, "triangle", "triangles");
  if (t.segments > 0) text += ", " + plural(t.segments, "segment", "segments");
  if (t.points > 0) text += ", " + plural(t.points, "point", "points");
  return text + "; " + plural(t.pieces, "component", "components");
}

/// Lists the defects of a mesh: all properties that a clean closed surface does not have.
std::string defects_text(const Topology& t, const SelfIntersections& contacts) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* one, const char* many) {
    if (count > 0) text += (text.empty() ? "" : ", ") + plural(count, one, many);
  };
  add(t.boundary_edges, "boundary edge", "boundary edges");
  add(t.nonmanifold_edges, "non-manifold edge", "non-manifold edges");
  add(t.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices");
  add(t.inconsistent_edges, "edge between triangles of opposite orientation",
      "edges between triangles of opposite orientation");
  add(t.degenerate_triangles, "degenerate triangle", "degenerate triangles");
  add(t.duplicate_triangles, "repeated triangle", "repeated triangles");
  add(t.vertices - t.named_vertices, "unused vertex", "unused vertices");
  if (!contacts.pairs.empty()) text += (text.empty() ? "" : ", ") + contacts_text(contacts);
  return text.empty() ? "none: closed, manifold, consistently oriented, without self-intersections" : text;
}

void add_topology_details(const Topology& t, const SelfIntersections& contacts, TextTable& table) {
  if (t.triangles == 0) return;
  table.detail("components", count_text(t.components) + ", of them " + count_text(t.closed_components) + " closed");
  table.detail("boundary edges", count_text(t.boundary_edges) + " in " + plural(t.boundary_loops, "loop", "loops"));
  table.detail("crossings", contacts_text(contacts));
  table.detail("closed", yes_no(t.closed));
  table.detail("oriented", yes_no(t.oriented));
  table.detail("Euler number", std::to_string(t.euler_characteristic));
  if (!t.shells.empty()) table.detail("genus", genus_text(t));
}

TextTable topology_table(const fs::path& path, const MeshFile& file, const Topology& t,
                         const SelfIntersections& contacts, const std::optional<Solid>& repaired) {
  TextTable table;
  table.add("file", path.string() + ": " + file_text(file));
  table.add("mesh", cells_text(t));
  table.add("solid", solid_text(t, contacts));
  if (repaired && repaired->betti()) {
    table.add("repaired", parts_text(*repaired->betti()));
    table.detail("", repaired->reason());
  } else if (repaired) {
    table.add("repaired", "no: " + repaired->reason());
  }
  if (t.triangles > 0) table.add("defects", defects_text(t, contacts));
  if (!t.bounds.is_empty()) {
    table.add("size", vector_text(t.bounds.size()) + ", from " + vector_text(t.bounds.lower) + " to " +
                          vector_text(t.bounds.upper));
  }
  if (t.triangles > 0) {
    table.add("area", rounded_text(t.area));
    if (t.closed && t.oriented) table.add("volume", rounded_text(t.signed_volume));
  }
  add_topology_details(t, contacts, table);
  return table;
}

/// Builds the cellular model of the solid that a mesh bounds. Adds its rows to the table, and returns its JSON.
Json add_model(const Arguments& a, const MeshView& mesh, const Context& context, TextTable& table) {
  const Solid solid = Solid::of(mesh, context);
  const CellularModel model = solid.model(a.model_options.read(), context);
  const CellularModelReport& facts = model.report();
  const BettiNumbers betti = model.betti(context);
  const bool is_proven = facts.passes && betti == solid.betti();
  Json json = to_json(facts);
  json["betti"] = to_json(betti);
  json["proven"] = is_proven;
  const auto& [vertices, edges, polygons, polyhedra] = facts.cells;
  table.add("model", std::to_string(facts.grid.size[0] - 1) + " x " + std::to_string(facts.grid.size[1] - 1) + " x " +
                         std::to_string(facts.grid.size[2] - 1) + " cubes, " + count_text(facts.cut_cubes) +
                         " cut by the surface, " + count_text(facts.failing_cubes) + " of them split into " +
                         plural(facts.boxes, "box", "boxes"));
  table.add("", count_text(static_cast<std::uint64_t>(vertices)) + " vertices, " +
                    count_text(static_cast<std::uint64_t>(edges)) + " edges, " +
                    count_text(static_cast<std::uint64_t>(polygons)) + " polygons, " +
                    count_text(static_cast<std::uint64_t>(polyhedra)) + " polyhedra: " + betti_text(betti));
  table.add("homotopy type",
            is_proven ? "that of the solid: proven, every component in a cell is contractible" : "not proven");
  for (const ModelFailure& failure : std::span(facts.failures).first(std::min(failure_limit, facts.failures.size()))) {
    table.add("", std::string(to_string(failure.obstacle)) + " between " + vector_text(failure.low) + " and " +
                      vector_text(failure.high) +
                      (failure.obstacle == ModelObstacle::slanted_needle
                           ? ": " + count_text(static_cast<std::uint64_t>(failure.cuts)) + " splits would resolve it"
                           : ": another --shift may avoid it"));
  }
  if (facts.failures.size() > failure_limit) {
    table.add("", "and at " + count_text(facts.failures.size() - failure_limit) + " more places");
  }
  return json;
}

void run_mesh(const Arguments& a, const std::optional<double>& weld) {
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(0, progress, interrupt);
  MeshFile file;
  {
    const Unattended reading;
    file = read_mesh_of_any_name(a.input, {weld});
  }
  const Topology facts = topology(file.mesh, context);
  const SelfIntersections contacts = find_self_intersections(file.mesh, contact_limit, context);
  Json json = file_json(a.input, file);
  json.update(topology_json(facts, contacts));
  json["self_intersections"] = contacts_json(contacts);
  const std::optional<Solid> repaired = repaired_solid(file.mesh, facts, contacts, context);
  json["repaired"] = repaired_json(repaired);
  TextTable table = topology_table(a.input, file, facts, contacts, repaired);
  if (a.model) json["model"] = add_model(a, file.mesh, context, table);
  progress.clear();
  if (is_welded_away(file) && !a.report.quiet) warn({{WarningCode::other_vertices, welded_away_text(file)}});
  report(a.report, answer_json("info", json), table);
}

// ---- Images ----

std::string labels_text(const ImageValues& values) {
  if (!values.distinct)
    return "none: values are not whole numbers, are beyond 2^53 (integers: 2^63 - 1), or are more than 100,000; use "
           "--threshold";
  return plural(*values.distinct, "value", "values");
}

/// Adds a row for each label, and one row for all labels that are left out.
void add_labels(TextTable& table, const ImageValues& values) {
  table.add("labels", labels_text(values));
  for (const LabelFacts& facts : values.labels) {
    std::string text = plural(facts.voxels, "voxel", "voxels") + ", volume " + rounded_text(facts.volume);
    if (facts.betti) text += ": " + betti_text(*facts.betti);
    table.add("label " + std::to_string(facts.label), text);
  }
  const std::uint64_t more = values.distinct.value_or(0) - values.labels.size();
  if (values.distinct && more > 0) table.add("", "and " + count_text(more) + " more, of fewer voxels");
}

void add_grid(TextTable& table, const GridSpec& grid) {
  table.add("size", size_text(grid) + " (" + count_text(grid.node_count()) + ")");
  table.add("spacing", vector_text(grid.spacing));
  table.add("origin", vector_text(grid.origin));
  if (grid.direction != Mat3{}) {
    const auto& c = grid.direction.columns;
    table.add("direction", vector_text(c[0]) + ", " + vector_text(c[1]) + ", " + vector_text(c[2]));
  }
}

void run_image(const Arguments& a) {
  ImageFile file = read_image_of_any_name(a.input);
  const VoxelImage& image = file.image;
  validate(image);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(0, progress, interrupt);
  round_labels(file, {}, context);
  const ImageValues values = image_values(image, label_limit, context);
  progress.clear();
  Json json = image_json(a.input, image, file.format);
  json.update(to_json(values));
  json["warnings"] = to_json(file.warnings);

  TextTable table;
  table.add("file", a.input + ": " + format_name(file.format) + " image of " + type_name(image.values));
  add_grid(table, image.grid);
  if (!image.space.empty()) table.add("world axes", image.space);
  table.add("range",
            values.range ? rounded_text((*values.range)[0]) + " to " + rounded_text((*values.range)[1]) : "no numbers");
  table.add("not zero", plural(values.nonzero, "voxel", "voxels"));
  if (values.not_numbers > 0) table.add("not a number", plural(values.not_numbers, "voxel", "voxels"));
  add_labels(table, values);
  report(a.report, answer_json("info", json), table);
  if (!a.report.quiet) warn(file.warnings);
}

// ---- Fields ----

void run_field(const Arguments& a) {
  const Field field = read_field(a.input);
  const FieldStatistics s = field_statistics(field, nullptr, {});
  const bool has_sites = !field.site.empty();
  Json json = {{"path", a.input}, {"kind", "field"}};
  json["grid"] = to_json(field.grid);
  json["bounds"] = to_json(bounds(field.grid));
  json["sign"] = {{"rule", to_string(field.sign_rule)}, {"reason", field.sign_reason}};
  json["band"] = field.band ? Json(*field.band) : Json(nullptr);
  json["distance"] = {{"minimum", s.minimum}, {"maximum", s.maximum}, {"inside_nodes", s.inside_nodes}};
  json["sites"] =
      has_sites
          ? Json{{"count", to_string(field.site_ids)}, {"distinct", s.all.sites}, {"nodes_without", s.siteless_nodes}}
          : Json(nullptr);
  TextTable table;
  table.add("file", a.input + ": distance field");
  add_grid(table, field.grid);
  table.add("distance", node_range_text(s.minimum, s.maximum, field.sign_rule != SignRule::none));
  if (field.band) table.add("band", "+-" + rounded_text(*field.band));
  table.add("sign", sign_text(field.sign_rule, field.sign_reason));
  table.add("inside", plural(s.inside_nodes, "node", "nodes"));
  table.add("sites", has_sites ? count_text(s.all.sites) + " distinct (" + std::string(to_string(field.site_ids)) +
                                     "), " + plural(s.siteless_nodes, "node", "nodes") + " without"
                               : "none in the file");
  json["warnings"] = to_json(field.warnings);
  report(a.report, answer_json("info", json), table);
  if (!a.report.quiet) warn(field.warnings);
}

// ---- Devices ----

void run_devices(const Arguments& a) {
  const CudaDevices found = cuda_devices();
  TextTable table;
  if (found.devices.empty()) table.add("cuda", "none: " + found.reason);
  for (const DeviceInfo& device : found.devices) {
    table.add(device.device, device.name + ", " + bytes_text(static_cast<double>(device.memory)));
  }
  report(a.report, answer_json("info", to_json(found)), table);
}

void run(const Arguments& a) {
  exclude(a.devices, "--devices", !a.input.empty(), "INPUT", "--devices reads no file");
  exclude(a.devices, "--devices", a.graph.has_value(), "--graph", "--graph needs a medial axis");
  if (a.devices) return run_devices(a);
  if (a.input.empty()) throw UsageError("INPUT needs a file name");
  if (!a.model && !a.model_options.given().empty()) {
    throw UsageError(a.model_options.given().front() + " needs --model");
  }
  const std::optional<double> weld = parse_weld(a.weld);
  const std::optional<fs::path> graph = parse_graph(a.graph);
  std::vector<fs::path> outputs = a.report.files();
  if (graph) outputs.push_back(*graph);
  check_outputs(outputs, {a.input});
  if (holds_complex(a.input)) {
    if (a.model) throw UsageError("--model is for meshes, but '" + a.input + "' is a medial axis");
    if (weld) throw UsageError("--weld is for meshes, but '" + a.input + "' is a medial axis");
    return report_axis(a.input, graph, a.report);
  }
  if (graph) throw UsageError("--graph is for medial axes, but '" + a.input + "' is not one");
  const InputKind kind = input_kind(a.input);
  for (const auto& [is_given, name] : {std::pair{weld.has_value(), "--weld"}, {a.model, "--model"}}) {
    if (is_given && kind != InputKind::mesh) {
      throw UsageError(std::string(name) + " is for meshes, but '" + a.input + "' is not one");
    }
  }
  switch (kind) {
    case InputKind::mesh:
      return run_mesh(a, weld);
    case InputKind::image:
      return run_image(a);
    case InputKind::field:
      return run_field(a);
  }
}

}  // namespace

void add_info_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("info", "Report the properties of a mesh, an image, a field or a medial axis");
  command.add_option("INPUT", a->input, "Mesh, image, field or medial axis");
  command.add_flag("--devices", a->devices, "List the CUDA devices, or the reason why none is usable; takes no INPUT");
  command.add_flag("--model", a->model,
                   "Mesh: make a cellular model of its solid, and report if its homotopy type is proven");
  a->model_options.add_to(command, "With --model: ");
  add_weld_option(command, a->weld);
  add_graph_option(command, a->graph, "Medial axis: write its sheets, seams, curves and junctions as a graph");
  add_report_options(command, a->report, "Write the properties as JSON; - is standard output");
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
