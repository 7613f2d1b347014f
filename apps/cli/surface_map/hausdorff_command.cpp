#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/point_io.hpp"
#include "blum/surface_map/hausdorff_distance.hpp"
#include "blum/surface_map/surface_deviation.hpp"
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
  blum hausdorff scan.ply design.stl                          interval of the distance, means, percentiles
  blum hausdorff part.obj simplified.obj --tolerance 1e-4 --json -
  blum hausdorff part.obj simplified.obj --one-sided -o where.vtp    only from part to simplified; writes witnesses
  blum hausdorff scan.xyz design.stl --one-sided              from the points of a scan to the design)";

struct Arguments {
  std::string a, b;
  std::optional<std::string> output, weld, threads;
  bool one_sided = false;
  bool only_distance = false;
  OptionTexts<HausdorffOptions> options;
  OptionTexts<DeviationOptions> deviation;
  ReportOptions report;
};

/// Results for one direction (from one surface to the other).
struct Side {
  DirectedHausdorff distance;
  std::optional<SurfaceDeviation> deviation;

  [[nodiscard]] Json json() const {
    Json out = to_json(distance);
    if (deviation) {
      out["deviation"] = to_json(*deviation);
      out["deviation"]["percents"] = to_json(SurfaceDeviation::percents);
    }
    return out;
  }
};

/// Returns the warnings about the signs of both directions, each once.
std::vector<Warning> warnings_of(const std::vector<Side>& sides) {
  std::vector<Warning> out;
  for (const Side& side : sides) {
    if (!side.deviation) continue;
    for (const Warning& warning : side.deviation->warnings) {
      if (std::find(out.begin(), out.end(), warning) == out.end()) out.push_back(warning);
    }
  }
  return out;
}

std::string interval_text(double lower, double upper) {
  if (rounded_text(lower) == rounded_text(upper)) {
    return rounded_text(upper) + " (interval " + rounded_text(upper - lower) + " wide)";
  }
  return "between " + rounded_text(lower) + " and " + rounded_text(upper);
}

void add_side(TextTable& table, const std::string& label, const Side& side) {
  table.add(label, "largest distance " + interval_text(side.distance.lower, side.distance.upper));
  if (!side.deviation) return;
  if (side.deviation->sign_rule != SignRule::none) {
    table.detail("", "signs " + sign_text(side.deviation->sign_rule, side.deviation->sign_reason));
  }
  const SurfaceDeviation& by_area = *side.deviation;
  const double most = side.distance.upper;
  // A value smaller than its error is only an estimate. The largest distance is then a better bound.
  const auto with_error = [&](double value, double error) {
    if (error < std::abs(value)) return rounded_text(value) + " (error at most " + rounded_text(error) + ")";
    const double lower = by_area.sign_rule != SignRule::none ? std::max(value - error, -most) : 0;
    return "about " + rounded_text(value) + " (between " + rounded_text(lower) + " and " +
           rounded_text(std::min(value + error, most)) + ")";
  };
  table.add("", "mean " + with_error(by_area.mean, by_area.mean_error) + ", rms " +
                    with_error(by_area.rms, by_area.rms_error));
  const bool is_resolved = by_area.percentile_error < std::max(std::abs(by_area.smallest), std::abs(by_area.largest));
  table.detail("", "by area " +
                       (is_resolved ? percentiles_text(SurfaceDeviation::percents, by_area.percentiles)
                                    : "no percentiles, because they are smaller than their error") +
                       " (error at most " + rounded_text(by_area.percentile_error) +
                       (is_resolved ? ")" : "); more --pieces reduce it"));
}

/// Returns the witnesses of the distances: one segment for each direction.
Complex witnesses(const std::vector<Side>& sides) {
  Complex out;
  for (const Side& side : sides) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    out.positions.insert(out.positions.end(), side.distance.points.begin(), side.distance.points.end());
    out.edges.push_back({first, first + 1});
  }
  out.vertex_columns = Columns(out.positions.size());
  out.edge_columns = Columns(out.edges.size());
  out.triangle_columns = Columns(0);
  const auto lower = out.edge_columns.add<double>("lower");
  const auto upper = out.edge_columns.add<double>("upper");
  for (std::size_t k = 0; k < sides.size(); ++k) {
    lower[k] = sides[k].distance.lower;
    upper[k] = sides[k].distance.upper;
  }
  return out;
}

bool has_area(const MeshView& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    if (length(cross(b - a, c - a)) > 0) return true;
  }
  return false;
}

TriangleMesh read_surface(const fs::path& path, std::optional<double> weld) {
  const std::vector<std::string> clouds = cloud_extensions();
  if (std::find(clouds.begin(), clouds.end(), file_extension(path)) == clouds.end()) {
    return read_mesh_of_any_name(path, {weld}).mesh;
  }
  TriangleMesh out;
  out.vertices = read_points(path);
  out.points.resize(out.vertices.size());
  std::iota(out.points.begin(), out.points.end(), 0U);
  return out;
}

/// Returns the number of triangles of a mesh, or the number of points of a cloud, as text.
std::string size_text(const MeshView& mesh) {
  if (mesh.triangles.empty() && !mesh.points.empty()) return plural(mesh.points.size(), "point", "points");
  return plural(mesh.triangles.size(), "triangle", "triangles");
}

void run(const Arguments& a) {
  const std::array<fs::path, 2> paths{a.a, a.b};
  if (a.only_distance && !a.deviation.given().empty()) {
    throw UsageError(a.deviation.given().front() +
                     " applies only to means by area, and --only-distance does not compute them");
  }
  const HausdorffOptions options = a.options.read();
  const DeviationOptions deviation = a.deviation.read();
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  if (a.output) {
    check_extension("--output", *a.output, file_extensions(FileContent::complex, FileAccess::write));
    outputs.emplace_back(*a.output);
  }
  check_outputs(outputs, {paths[0], paths[1]});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  std::array<TriangleMesh, 2> meshes;
  {
    const Unattended reading;
    for (std::size_t k = 0; k < 2; ++k) meshes[k] = read_surface(paths[k], weld);
  }
  const TriangleMesh& first = meshes[0];
  const TriangleMesh& second = meshes[1];
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  std::vector<Side> sides(a.one_sided ? 1 : 2);
  HausdorffDistance both;
  if (a.one_sided) {
    both.forward = sides[0].distance = directed_hausdorff_distance(first, second, options, context);
    both.lower = both.forward.lower;
    both.upper = both.forward.upper;
    both.points = both.forward.points;
  } else {
    both = hausdorff_distance(first, second, options, context);
    sides[0].distance = both.forward;
    sides[1].distance = both.backward;
  }
  phases.push_back({"distance", watch.lap()});
  for (std::size_t k = 0; k < sides.size() && !a.only_distance; ++k) {
    const TriangleMesh& from = k == 0 ? first : second;
    if (has_area(from)) sides[k].deviation = surface_deviation(from, k == 0 ? second : first, deviation, context);
  }
  phases.push_back({"deviation", watch.lap()});
  if (a.output) {
    write_complex(*a.output, witnesses(sides), {{"content", "witnesses"}, {"tool", "blum hausdorff"}});
    phases.push_back({"write", watch.lap()});
  }
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  Box3 box = bounds(first);
  box.extend(bounds(second));
  Json json = answer_json("hausdorff", {{"a", paths[0].string()},
                                        {"b", paths[1].string()},
                                        {"triangles", {first.triangles.size(), second.triangles.size()}},
                                        {"diagonal", box.diagonal()},
                                        {"one_sided", a.one_sided},
                                        {"lower", both.lower},
                                        {"upper", both.upper},
                                        {"points", to_json(both.points)},
                                        {"forward", sides[0].json()}});
  if (!a.one_sided) json["backward"] = sides[1].json();
  const std::vector<Warning> warnings = warnings_of(sides);
  add_run_facts(json, spent, context, warnings, a.output ? Json::array({*a.output}) : Json::array());
  TextTable table;
  const std::vector<std::string> names = distinct_names({paths[0].string(), paths[1].string()});
  const std::string there = names[0] + " to " + names[1];
  table.add("distance", interval_text(both.lower, both.upper) + (a.one_sided ? ", from " + there : ""));
  double size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size = std::max({size, std::abs(box.lower[axis]), std::abs(box.upper[axis])});
  }
  const auto point_of = [&](std::size_t which) { return point_text(both.points[which], size) + " of " + names[which]; };
  const std::size_t from = a.one_sided || both.forward.lower >= both.backward.lower ? 0 : 1;
  table.add("reached at", point_of(from) + ", closest point " + point_of(1 - from));
  add_side(table, there, sides[0]);
  if (!a.one_sided) add_side(table, names[1] + " to " + names[0], sides[1]);
  for (std::size_t k = 0; k < sides.size() && !a.only_distance; ++k) {
    if (!sides[k].deviation) table.add("", names[k] + " has no area, so means by area are not defined");
  }
  table.add("input", names[0] + ": " + size_text(first) + "; " + names[1] + ": " + size_text(second));
  if (a.output) table.add("wrote", *a.output);
  spent.add_to(table);
  report(a.report, json, table);
  if (!a.report.quiet) warn(warnings);
}

}  // namespace

void add_hausdorff_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand(
      "hausdorff", "Guaranteed interval of the Hausdorff distance of two meshes, and means weighted by area");
  const std::string help = extensions_help({FileContent::mesh}, FileAccess::read) + ", or points (" +
                           join_words(cloud_extensions(), "or") +
                           "). From points, no means and percentiles are computed, so --sign is ignored";
  command.add_option("A", a->a, help).required();
  command.add_option("B", a->b, help).required();
  add_text_option(command, "-o,--output", a->output, "FILE",
                  "Write the witnesses: for each direction a segment from a point that is furthest away to its closest "
                  "point (.vtp, .ply, ...)");
  command.add_flag("--one-sided", a->one_sided, "Only the directed distance from A to B");
  command.add_flag("--only-distance", a->only_distance,
                   "Compute only the distance, without the means and percentiles, which are weighted by area");
  a->options.add_to(command);
  a->deviation.add_to(command, "By area: ");
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
