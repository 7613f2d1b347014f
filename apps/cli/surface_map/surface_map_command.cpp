#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/phase_timer.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/surface_map_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/surface_map/surface_distance_map.hpp"
#include "blum/surface_map/surface_map_statistics.hpp"
#include "blum/surface_map/thickness.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum surface-map part.stl housing.stl -o clearance.glb --units mm      clearance between parts, as a texture
  blum surface-map scan.ply design.stl -o deviation.png --sign auto      deviation, negative inside the design
  blum surface-map part.stl -o thickness.vtp --thickness ray             thickness of a solid, straight inwards
  blum surface-map cloth.obj -o close.npz --self --max-distance 2        distances to triangles that share no vertex)";

struct Arguments {
  std::string target;
  std::vector<std::string> others, outputs;
  bool self = false;
  std::optional<std::string> thickness, separation, max_distance, texel, sign, range, weld, threads;
  std::string units;
  ReportOptions report;
};

/// Options after all checks.
struct Request {
  SurfaceMapOptions map;
  std::optional<ThicknessOptions> thickness;
  SurfaceMapWriteOptions write;
  std::vector<fs::path> outputs;
};

std::pair<double, double> parse_range(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    throw UsageError("--range is '" + text + "', but must be two numbers, for example 0,2.5");
  const double low = parse_number("--range", text.substr(0, comma));
  const double high = parse_number("--range", text.substr(comma + 1));
  if (!(low < high)) throw UsageError("--range is '" + text + "': the first number must be less than the second");
  return {low, high};
}

void check_kind(const Arguments& a) {
  if (a.self && a.thickness) throw UsageError("--self and --thickness select different kinds of maps; give one");
  if ((a.self || a.thickness) && !a.others.empty()) {
    throw UsageError(std::string(a.self ? "--self" : "--thickness") + " takes one mesh, but '" + a.others[0] +
                     "' is also given");
  }
  if (!a.self && !a.thickness && a.others.empty()) {
    throw UsageError("OTHER is missing; give another mesh, or --self or --thickness for a map of one mesh");
  }
  if ((a.self || a.thickness) && a.sign) throw UsageError("--sign is for distances to other meshes");
  if (a.separation && a.thickness != "ball") throw UsageError("--separation needs --thickness ball");
}

Request read(const Arguments& a) {
  check_kind(a);
  Request out;
  if (a.texel) out.map.texel = parse_positive("--texel", *a.texel);
  if (a.max_distance) out.map.max_distance = parse_non_negative("--max-distance", *a.max_distance);
  if (a.sign) out.map.sign = parse_enum<SignMode>("--sign", *a.sign);
  if (a.thickness) {
    out.thickness.emplace();
    out.thickness->kind = parse_enum<ThicknessKind>("--thickness", *a.thickness);
    if (a.separation) out.thickness->separation = number_in("--separation", *a.separation, Range::between(0, 180));
  }
  if (a.range) out.write.range = parse_range(*a.range);
  out.write.units = a.units;
  for (const std::string& output : a.outputs) {
    check_extension("--output", output, file_extensions(FileContent::surface_map, FileAccess::write));
    out.outputs.emplace_back(output);
  }
  return out;
}

/// All other meshes, joined into one mesh.
struct Joined {
  TriangleMesh mesh;
  std::vector<std::size_t> ends;  ///< for each of these meshes: end of its range of vertices

  [[nodiscard]] std::size_t object_of(std::size_t vertex) const {
    return static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), vertex) - ends.begin());
  }
};

SurfaceMap map_of(const Request& asked, const MeshView& target, const Joined& others, const Context& context) {
  if (asked.thickness) return thickness_map(target, asked.map, *asked.thickness, context);
  if (others.ends.empty()) return self_distance_map(target, asked.map, context);
  return surface_distance_map(target, others.mesh, asked.map, context);
}

/// Returns the position of a texel, and what was found there, as JSON.
Json place_json(const SurfaceMap& map, const MeshView& target, std::size_t texel) {
  const Vec3d point = surface_point(target, *map.atlas, texel);
  const Vec3f way = map.vector[texel];
  return {{"distance", map.distance[texel]},
          {"point", to_json(point)},
          {"closest", to_json(point + Vec3d{way.x, way.y, way.z})},
          {"triangle", map.atlas->triangle[texel].to_file()},
          {"site", map.site[texel].to_file()}};
}

std::optional<std::size_t> furthest_texel(const SurfaceMap& map) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < map.distance.size(); ++k) {
    if (std::isfinite(map.distance[k]) && (!best || map.distance[k] > map.distance[*best])) best = k;
  }
  return best;
}

/// Returns a text like "0.25 at (1, 2, 3)".
std::string quantity_text(SurfaceQuantity quantity) {
  switch (quantity) {
    case SurfaceQuantity::distance:
      return "distance";
    case SurfaceQuantity::self_distance:
      return "distance to the mesh itself";
    case SurfaceQuantity::ray_thickness:
      return "thickness along rays";
    case SurfaceQuantity::ball_thickness:
      return "thickness by balls";
  }
  return {};
}

std::string place_text(const Json& place) {
  const Json& p = place["point"];
  return rounded_text(place["distance"].number()) + " at " + vector_text({p[0].number(), p[1].number(), p[2].number()});
}

/// Facts about a map, for the JSON and the table.
struct Facts {
  std::size_t texels = 0;
  std::size_t without = 0;  ///< number of texels without a value
  double largest_error = 0;
  Json smallest = nullptr, largest = nullptr;

  Facts(const SurfaceMap& map, const MeshView& target, const Joined& others) {
    for (std::size_t k = 0; k < map.distance.size(); ++k) {
      if (!map.atlas->triangle[k].has_value()) continue;
      ++texels;
      without += map.site[k].has_value() ? 0U : 1U;
    }
    for (const float error : map.error) largest_error = std::max<double>(largest_error, error);
    if (const auto at = map.closest_texel()) smallest = place_json(map, target, *at);
    if (const auto at = furthest_texel(map)) largest = place_json(map, target, *at);
    if (others.ends.size() < 2) return;
    const SiteTable sites(others.mesh);
    for (Json* place : {&smallest, &largest}) {
      if (place->is_null()) continue;
      const SiteId site(static_cast<std::uint32_t>((*place)["site"].number()));
      (*place)["object"] = others.object_of(static_cast<std::size_t>(sites.vertices(site)[0]));
    }
  }
};

void run(const Arguments& a) {
  const Request asked = read(a);
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> inputs{a.target};
  inputs.insert(inputs.end(), a.others.begin(), a.others.end());
  std::vector<fs::path> outputs = a.report.files();
  outputs.insert(outputs.end(), asked.outputs.begin(), asked.outputs.end());
  check_outputs(outputs, inputs);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  MeshFile target;
  Joined others;
  {
    const Unattended reading;
    target = read_mesh_of_any_name(inputs[0], {weld});
    for (const std::string& other : a.others) {
      append(others.mesh, read_mesh_of_any_name(other, {weld}).mesh);
      others.ends.push_back(others.mesh.vertices.size());
    }
  }
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const SurfaceMap map = map_of(asked, target.mesh, others, context);
  phases.push_back({"map", watch.lap()});
  for (const fs::path& output : asked.outputs) {
    write_surface_map(output, target.mesh, map,
                      {{"tool", "blum surface-map"}, {"source", inputs[0].filename().string()}}, asked.write, context);
  }
  phases.push_back({"write", watch.lap()});
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  const Facts facts(map, target.mesh, others);
  const SurfaceMapStatistics by_area = surface_map_statistics(target.mesh, map);
  const std::string quantity(to_string(map.quantity));
  Json json =
      answer_json("surface-map", {{"target", a.target},
                                  {"others", a.others},
                                  {"triangles", target.mesh.triangles.size()},
                                  {"quantity", quantity},
                                  {"units", a.units},
                                  {"width", map.atlas->width},
                                  {"height", map.atlas->height},
                                  {"texels", facts.texels},
                                  {"without_value", facts.without},
                                  {"largest_error", map.error.empty() ? Json(nullptr) : Json(facts.largest_error)},
                                  {"smallest", facts.smallest},
                                  {"largest", facts.largest},
                                  {"by_area", by_area.measured_area > 0 ? to_json(by_area) : Json(nullptr)}});
  if (map.sign_rule != SignRule::none) {
    json["sign_rule"] = to_string(map.sign_rule);
    json["sign_reason"] = map.sign_reason;
  }
  Json written = Json::array();
  for (const fs::path& output : asked.outputs) written.push_back(output.string());
  add_run_facts(json, spent, context, map.warnings, written);
  TextTable table;
  table.add("map", quantity_text(map.quantity) + "; " + count_text(facts.texels) + " texels used in a texture of " +
                       std::to_string(map.atlas->width) + " x " + std::to_string(map.atlas->height));
  const std::string unit = a.units.empty() ? "" : " " + a.units;
  if (!map.error.empty()) {
    const double size = bounds(target.mesh).diagonal();
    table.add("error", "at most " + share_text(facts.largest_error, size, unit) + " between texels");
  }
  if (facts.without > 0) table.add("no value", plural(facts.without, "texel", "texels"));
  if (!facts.smallest.is_null()) table.add("smallest", place_text(facts.smallest));
  if (!facts.largest.is_null()) table.add("largest", place_text(facts.largest));
  if (by_area.measured_area > 0) {
    table.add("mean", rounded_text(by_area.mean) + ", rms " + rounded_text(by_area.rms) + " (weighted by area)");
    table.detail("percentiles", percentiles_text(SurfaceMapStatistics::percents, by_area.percentiles));
  }
  if (map.sign_rule != SignRule::none) table.add("sign", sign_text(map.sign_rule, map.sign_reason));
  table.add("input", a.target + ": " + plural(target.mesh.triangles.size(), "triangle", "triangles"));
  for (const fs::path& output : asked.outputs) table.add("wrote", output.string());
  spent.add_to(table);
  if (!a.report.quiet) warn(map.warnings);
  report(a.report, json, table);
}

}  // namespace

void add_surface_map_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand(
      "surface-map", "Texture of distances over a surface: to other meshes, to itself, or the thickness of a solid");
  const std::string help = extensions_help({FileContent::mesh}, FileAccess::read);
  command.add_option("TARGET", a->target, "Mesh whose surface gets the values: " + help).required();
  command.add_option("OTHER", a->others,
                     "Meshes to which distances are measured, for example the design of a scanned TARGET");
  command
      .add_option("-o,--output", a->outputs,
                  ".npz: all data; .glb: coloured mesh; .png: texture, triangle by triangle, and a colour bar; "
                  ".ply, .vtp: values of vertices and triangles. May be repeated")
      .required()
      .type_name("FILE");
  command.add_flag("--self", a->self, "Distances to other triangles of TARGET without a common vertex");
  add_text_option(command, "--thickness", a->thickness, "KIND",
                  "Thickness of TARGET at each point: ray (straight inwards to the far side) or ball (diameter of the "
                  "largest ball inside that touches the point)");
  add_text_option(command, "--separation", a->separation, "DEGREES",
                  "With --thickness ball: ignore triangles whose normal differs from the point's by less than DEGREES, "
                  "0 to 180 (default 30)");
  add_text_option(command, "--texel", a->texel, "H",
                  "Side of a texel on the surface, in mesh units (default: a side that gives about a million texels)");
  add_text_option(command, "--max-distance", a->max_distance, "D",
                  "Largest distance that is searched, in mesh units (default: no limit)");
  add_text_option(command, "--sign", a->sign, "SIGN",
                  "Sign rule: auto, normals, winding or none (default none); negative inside OTHER");
  add_text_option(command, "--range", a->range, "LOW,HIGH",
                  "Distances at the two ends of the colour scale (default: smallest and largest value of the map; for "
                  "distances, 0 is included)");
  command.add_option("--units", a->units, "Unit of the mesh, for example mm, for the colour bar and metadata")
      .type_name("TEXT");
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
