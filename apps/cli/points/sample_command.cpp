#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/phase_timer.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/point_io.hpp"
#include "blum/points/sample_surface.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "points/point_columns.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum sample part.stl -n 100000 -o points.ply                       points on the surface, with normals
  blum sample part.stl -n 5000 -o even.npz --blue-noise              evenly spaced points
  blum sample part.stl -n 200000 -o near.npz --near --in-box 0.1     points near the surface, with signed distances)";

struct Arguments {
  std::string mesh, output;
  std::string count;
  bool near = false;
  std::optional<std::string> weld, threads;
  OptionTexts<SampleOptions> options;
  OptionTexts<NearSampleOptions> near_options;
  ReportOptions report;
};

/// @param parts_normals  true for columns nx, ny, nz, which other programs expect in .ply files; false for one column
/// `normal`.
Complex points_of_surface(const SurfaceSamples& samples, bool parts_normals) {
  Complex out;
  const std::size_t count = samples.points.size();
  out.positions = samples.points;
  out.vertex_columns = Columns(count);
  if (parts_normals) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto part = out.vertex_columns.add<double>(std::string("n") + "xyz"[axis]);
      for (std::size_t k = 0; k < count; ++k) part[k] = samples.normals[k][axis];
    }
  } else {
    const auto normal = out.vertex_columns.add<double>("normal", 3);
    for (std::size_t k = 0; k < 3 * count; ++k) normal[k] = samples.normals[k / 3][k % 3];
  }
  const auto triangle = out.vertex_columns.add<std::int32_t>("triangle");
  for (std::size_t k = 0; k < count; ++k) triangle[k] = samples.triangles[k].to_file();
  return out;
}

/// Throws if an option is given that is only for the other kind of points. `--seed` is for both kinds.
void refuse_others(const Arguments& a) {
  if (a.near && a.options.has("blue_noise"))
    throw UsageError("--blue-noise is for points on the surface; remove it, or --near");
  for (const char* member : {"sigma", "in_box", "sign"}) {
    if (!a.near && a.near_options.has(member)) {
      throw UsageError(option_name(member) + " is for points near the surface; add --near");
    }
  }
}

/// Options after all checks.
struct Request {
  std::size_t count = 0;
  SampleOptions options;
  NearSampleOptions near;
};

Request read(const Arguments& a) {
  Request out{static_cast<std::size_t>(parse_integer("-n", a.count, 0, std::numeric_limits<std::int32_t>::max())),
              a.options.read(), a.near_options.read()};
  out.near.seed = out.options.seed;
  return out;
}

/// Returns the gradient at each sample. A query is only built if samples lie on the surface, within rounding.
std::vector<std::optional<Vec3d>> gradients_at(const NearSamples& near, const MeshView& mesh, SignMode sign,
                                               const Context& context) {
  std::vector<std::optional<Vec3d>> out(near.points.size());
  bool is_any_on_surface = false;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = gradient(near.points[k], near.closest[k]);
    is_any_on_surface |= !out[k] && near.closest[k].site.has_value();
  }
  if (!is_any_on_surface) return out;
  return ClosestPointQuery(mesh, {.sign = sign}, context).gradients(near.points, near.closest, context);
}

/// Sampled points. The facts about signs are only for points near the surface.
struct Samples {
  Complex points;
  std::size_t inside = 0;
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;
  std::vector<Warning> warnings;
};

Samples samples_of(const Arguments& a, const Request& asked, const MeshView& mesh, const Context& context) {
  Samples out;
  if (!a.near) {
    const bool is_ply = file_extension(a.output) == ".ply";
    out.points = points_of_surface(sample_surface(mesh, asked.count, asked.options, context), is_ply);
    return out;
  }
  NearSamples near = sample_near(mesh, asked.count, asked.near, context);
  out.points = points_with_distances(near.points, near.closest, gradients_at(near, mesh, asked.near.sign, context));
  for (const ClosestPoint& found : near.closest) out.inside += found.distance < 0 ? 1 : 0;
  out.sign_rule = near.sign_rule;
  out.sign_reason = std::move(near.sign_reason);
  out.warnings = std::move(near.warnings);
  return out;
}

void run(const Arguments& a) {
  const fs::path input = a.mesh;
  const fs::path output = a.output;
  check_extension("--output", output, file_extensions(FileContent::points, FileAccess::write));
  refuse_others(a);
  const Request asked = read(a);
  const std::optional<double> weld = parse_weld(a.weld);
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  outputs.push_back(output);
  check_outputs(outputs, {input});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(threads, progress, interrupt);
  Stopwatch watch;
  MeshFile file;
  {
    const Unattended reading;
    file = read_mesh_of_any_name(input, {weld});
  }
  std::vector<PhaseTime> phases{{"read", watch.lap()}};
  const Samples samples = samples_of(a, asked, file.mesh, context);
  const Complex& points = samples.points;
  phases.push_back({"sample", watch.lap()});
  FileMetadata metadata{{"tool", "blum sample"}, {"source", input.filename().string()}};
  if (a.near) metadata.emplace_back("sign_rule", to_string(samples.sign_rule));
  write_points(output, points, metadata, context);
  phases.push_back({"write", watch.lap()});
  progress.clear();
  const PhaseSummary spent = summarize(phases);
  Json json = answer_json("sample", {{"mesh", input.string()},
                                     {"triangles", file.mesh.triangles.size()},
                                     {"points", points.positions.size()},
                                     {"near", a.near},
                                     {"seed", asked.options.seed}});
  if (a.near) {
    json["inside"] = samples.inside;
    json["sign_rule"] = to_string(samples.sign_rule);
    json["sign_reason"] = samples.sign_reason;
  }
  add_run_facts(json, spent, context, samples.warnings, Json::array({output.string()}));
  TextTable table;
  table.add("points",
            plural(points.positions.size(), "point", "points") +
                (a.near ? " near the surface, " + count_text(samples.inside) + " inside" : " on the surface"));
  if (a.near) table.add("sign", sign_text(samples.sign_rule, samples.sign_reason));
  table.add("mesh", input.string() + ": " + plural(file.mesh.triangles.size(), "triangle", "triangles"));
  table.add("wrote", output.string());
  spent.add_to(table);
  report(a.report, json, table);
  if (!a.report.quiet) warn(samples.warnings);
}

}  // namespace

void add_sample_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("sample", "Random points on a surface, or near it with signed distances");
  command.add_option("MESH", a->mesh, extensions_help({FileContent::mesh}, FileAccess::read)).required();
  command.add_option("-n,--count", a->count, "Number of points, 0 to 2147483647").required().type_name("N");
  command
      .add_option("-o,--output", a->output,
                  extension_list(FileContent::points, FileAccess::write) +
                      ": points with columns normal (nx, ny, nz in .ply) and triangle; with --near instead distance, "
                      "gradient, closest, site and triangle")
      .required()
      .type_name("FILE");
  command.add_flag("--near", a->near,
                   "Points near the surface, with exact signed distances; the points of --in-box come last");
  a->options.add_to(command);
  a->near_options.add_to(command, "With --near: ", {"seed"});
  add_weld_option(command, a->weld);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
