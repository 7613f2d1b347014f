#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "axis_info.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/io/field_io.hpp"
#include "commands.hpp"
#include "common_options.hpp"
#include "field_statistics.hpp"
#include "files.hpp"
#include "input_facts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum info bunny.obj
  blum info part.stl --weld 1e-6 --json part.json
  blum info scan.nii.gz --json - | jq .labels
  blum info bunny.nrrd                             a field that Blum wrote
  blum info bunny.vtp                              a medial axis)";

constexpr std::size_t contact_limit = 100000;   // looked for
constexpr std::size_t pair_limit = 20;          // shown in JSON
constexpr std::size_t label_limit = 20;         // shown
constexpr std::size_t distinct_limit = 100000;  // counted; more values are no labels

struct Arguments {
  std::string input;
  std::optional<std::string> weld;
  ReportOptions report;
};

const char* yes_no(bool value) {
  return value ? "yes" : "no";
}

// ---- Meshes ----

Json shell_json(const Shell& shell) {
  return {{"triangles", shell.triangles},
          {"genus", shell.genus},
          {"euler_characteristic", shell.euler_characteristic},
          {"signed_volume", shell.signed_volume},
          {"area", shell.area},
          {"depth", shell.depth},
          {"parent", shell.parent},
          {"faces_outwards", shell.faces_outwards},
          {"bounds", to_json(shell.bounds)}};
}

Json topology_json(const Topology& t) {
  Json json = {{"named_vertices", t.named_vertices},
               {"edges", t.edges},
               {"pieces", t.pieces},
               {"components", t.surface_components},
               {"closed_components", t.closed_components},
               {"boundary_edges", t.boundary_edges},
               {"boundary_loops", t.boundary_loops},
               {"nonmanifold_edges", t.nonmanifold_edges},
               {"nonmanifold_vertices", t.nonmanifold_vertices},
               {"inconsistent_edges", t.inconsistent_edges},
               {"degenerate_triangles", t.degenerate_triangles},
               {"duplicate_triangles", t.duplicate_triangles},
               {"closed", t.closed},
               {"oriented", t.oriented},
               {"manifold", t.manifold},
               {"faces_outwards", t.closed && t.oriented ? Json(t.faces_outwards) : Json(nullptr)},
               {"area", t.area},
               {"signed_volume", t.closed && t.oriented ? Json(t.signed_volume) : Json(nullptr)},
               {"euler_characteristic", t.euler_characteristic}};
  Json shells = Json::array();
  std::int64_t genus = 0;
  for (const Shell& shell : t.shells) {
    shells.push_back(shell_json(shell));
    genus += shell.genus;
  }
  const bool whole = t.closed && t.oriented;
  json["genus"] = whole ? Json(genus) : Json(nullptr);
  json["shells"] = shells;
  return json;
}

/// The Betti numbers of the solid; null where the surface bounds none, as far as is known.
Json betti_json(const Topology& t, const SelfIntersections& contacts) {
  return t.betti && contacts.crossing == 0 ? Json(*t.betti) : Json(nullptr);
}

std::string solid_text(const Topology& t, const SelfIntersections& contacts) {
  const bool crosses = t.closed && t.oriented && contacts.crossing > 0;
  if (crosses) return "no: triangles cross each other, so parts may overlap";
  if (t.betti) {
    const auto& [components, tunnels, voids] = *t.betti;
    return "yes: " + plural(static_cast<std::uint64_t>(components), "part", "parts") + ", " +
           plural(static_cast<std::uint64_t>(tunnels), "tunnel", "tunnels") + ", " +
           plural(static_cast<std::uint64_t>(voids), "void", "voids") + " (Betti numbers " +
           std::to_string(components) + ", " + std::to_string(tunnels) + ", " + std::to_string(voids) + ")";
  }
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
  return crossing + touching + (contacts.complete ? "" : ", and more: the search ended there");
}

std::string topology_text(const fs::path& path, const MeshFile& file, const Topology& t,
                          const SelfIntersections& contacts) {
  TextTable table;
  table.add("file", path.string() + ": " + file_text(file));
  table.add("vertices", count_text(t.vertices) +
                            (t.named_vertices < t.vertices
                                 ? ", of them " + count_text(t.vertices - t.named_vertices) + " used by nothing"
                                 : ""));
  table.add("edges", count_text(t.edges));
  table.add("triangles", count_text(t.triangles));
  if (t.segments > 0) table.add("segments", count_text(t.segments));
  if (t.points > 0) table.add("points", count_text(t.points));
  if (!t.bounds.is_empty()) {
    table.add("bounds", vector_text(t.bounds.lower) + " to " + vector_text(t.bounds.upper));
    table.add("size", vector_text(t.bounds.size()));
  }
  table.add("pieces", count_text(t.pieces));
  if (t.triangles > 0) {
    table.add("components",
              count_text(t.surface_components) + ", of them " + count_text(t.closed_components) + " closed");
    table.add("boundary edges", count_text(t.boundary_edges) + " in " + plural(t.boundary_loops, "loop", "loops"));
    table.add("non-manifold", plural(t.nonmanifold_edges, "edge", "edges") + ", " +
                                  plural(t.nonmanifold_vertices, "vertex", "vertices"));
    table.add("degenerate", plural(t.degenerate_triangles, "triangle", "triangles"));
    table.add("repeated", plural(t.duplicate_triangles, "triangle", "triangles"));
    table.add("crossings", contacts_text(contacts));
    table.add("closed", yes_no(t.closed));
    table.add("oriented",
              t.oriented ? "yes"
                         : "no: " + plural(t.inconsistent_edges, "edge", "edges") + " between triangles that disagree");
    table.add("area", rounded_text(t.area));
    if (t.closed && t.oriented) table.add("volume", rounded_text(t.signed_volume));
    table.add("Euler number", std::to_string(t.euler_characteristic));
    if (!t.shells.empty()) table.add("genus", genus_text(t));
  }
  table.add("solid", solid_text(t, contacts));
  return table.text();
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
  progress.clear();
  Json json = file_json(a.input, file);
  json.update(topology_json(facts));
  json["betti"] = betti_json(facts, contacts);
  json["self_intersections"] = contacts_json(contacts);
  if (is_welded_away(file) && !a.report.quiet) warn({welded_away_text(file)});
  report(a.report, json, topology_text(a.input, file, facts, contacts));
}

// ---- Images ----

struct ImageFacts {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;
  std::uint64_t not_numbers = 0;
  bool labelled = true;                                        ///< whole numbers, few distinct ones
  std::vector<std::pair<std::int64_t, std::uint64_t>> labels;  ///< with voxel counts, most frequent first
};

constexpr double exact_integer_limit = 9007199254740992.0;  // 2^53

/// Whether a value can be named by --label.
template <class T>
bool is_label(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::trunc(value) == value && std::abs(static_cast<double>(value)) <= exact_integer_limit;
  } else if constexpr (std::is_same_v<T, std::uint64_t>) {
    return value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  } else {
    return true;
  }
}

template <class T>
ImageFacts image_facts(const std::vector<T>& values) {
  ImageFacts facts;
  std::unordered_map<std::int64_t, std::uint64_t> counts;
  for (std::size_t i = 0; i < values.size();) {
    const T value = values[i];
    std::size_t end = i + 1;
    while (end < values.size() && values[end] == value) ++end;  // runs are long in labelled images
    const std::uint64_t run = end - i;
    i = end;
    const double number = static_cast<double>(value);
    if (std::isnan(number)) {
      facts.not_numbers += run;
      continue;
    }
    facts.minimum = std::min(facts.minimum, number);
    facts.maximum = std::max(facts.maximum, number);
    if (value != T{}) facts.nonzero += run;
    if (facts.labelled && is_label(value)) {
      counts[static_cast<std::int64_t>(value)] += run;
      facts.labelled = counts.size() <= distinct_limit;
    } else {
      facts.labelled = false;
    }
  }
  if (facts.labelled) facts.labels.assign(counts.begin(), counts.end());
  std::sort(facts.labels.begin(), facts.labels.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  return facts;
}

std::string labels_text(const ImageFacts& facts) {
  if (!facts.labelled) return "more than can be labels; use --threshold";
  std::string text = plural(facts.labels.size(), "value", "values") + ":";
  for (std::size_t i = 0; i < std::min(label_limit, facts.labels.size()); ++i) {
    text += std::string(i == 0 ? " " : ", ") + std::to_string(facts.labels[i].first) + " (" +
            count_text(facts.labels[i].second) + ")";
  }
  return text + (facts.labels.size() > label_limit ? ", ..." : "");
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
  const VoxelImage image = read_image_of_any_name(a.input);
  validate(image);
  const ImageFacts facts = std::visit([](const auto& values) { return image_facts(values); }, image.values);
  Json json = image_json(a.input, image);
  const bool has_values = facts.minimum <= facts.maximum;
  json["range"] = has_values ? Json::array({facts.minimum, facts.maximum}) : Json(nullptr);
  json["nonzero"] = facts.nonzero;
  json["not_numbers"] = facts.not_numbers;
  json["distinct"] = facts.labelled ? Json(facts.labels.size()) : Json(nullptr);
  Json labels = Json::array();
  for (std::size_t i = 0; i < std::min(label_limit, facts.labels.size()); ++i) {
    labels.push_back({{"label", facts.labels[i].first}, {"voxels", facts.labels[i].second}});
  }
  json["labels"] = labels;

  TextTable table;
  table.add("file", a.input + ": " + std::string(image_format_name(a.input)) + " image of " + type_name(image.values));
  add_grid(table, image.grid);
  if (!image.space.empty()) table.add("world axes", image.space);
  table.add("range", has_values ? rounded_text(facts.minimum) + " to " + rounded_text(facts.maximum) : "no numbers");
  table.add("not zero", plural(facts.nonzero, "voxel", "voxels"));
  if (facts.not_numbers > 0) table.add("not a number", plural(facts.not_numbers, "voxel", "voxels"));
  table.add("labels", labels_text(facts));
  report(a.report, json, table.text());
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
  table.add("distance", rounded_text(s.minimum) + " to " + rounded_text(s.maximum));
  if (field.band) table.add("band", "+-" + rounded_text(*field.band));
  table.add("sign",
            std::string(to_string(field.sign_rule)) + (field.sign_reason.empty() ? "" : ": " + field.sign_reason));
  table.add("inside", plural(s.inside_nodes, "node", "nodes"));
  table.add("sites", has_sites ? count_text(s.all.sites) + " distinct (" + std::string(to_string(field.site_ids)) +
                                     "), " + plural(s.siteless_nodes, "node", "nodes") + " without"
                               : "none in the file");
  report(a.report, json, table.text());
}

void run(const Arguments& a) {
  if (a.input.empty()) throw UsageError("INPUT needs a file name");
  const std::optional<double> weld = parse_weld(a.weld);
  check_outputs(a.report.files(), {a.input});
  if (holds_complex(a.input)) {
    if (weld) throw UsageError("--weld is for meshes, and '" + a.input + "' is a medial axis");
    return report_axis(a.input, a.report);
  }
  const InputKind kind = input_kind(a.input);
  if (weld && kind != InputKind::mesh) throw UsageError("--weld is for meshes, and '" + a.input + "' is none");
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
  CLI::App* command = line.app.add_subcommand("info", "What a mesh, an image, a field or a medial axis holds");
  command->add_option("INPUT", a->input, "Mesh, image, field or medial axis")->required();
  add_weld_option(*command, a->weld);
  add_report_options(*command, a->report, "Write the facts as JSON; - is standard output");
  command->footer(examples);
  command->callback([a] { run(*a); });
}

}  // namespace blum::cli
