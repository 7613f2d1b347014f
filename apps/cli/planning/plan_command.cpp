#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/io/mesh_io.hpp"
#include "blum/io/path_io.hpp"
#include "blum/planning/plan.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "planning/no_path.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum plan robot.ply walls.ply --start=-2,0,0,1,0,0,0 --goal 2,0,0,1,0,0,0 -o path.json
  blum plan robot.ply walls.ply --start=-2,0,0,1,0,0,0 --goal 2,0,0,0,0,0,1 --clearance 0.05 --time 60
  blum verify path.json                                      check the written path

With --body FILE, a further body moves: repeat --start and --goal for it. The order is found.
A pose x,y,z,qw,qx,qy,qz maps a mesh to the scene: a translation and a unit quaternion.
All motions of the path are proven, so it passes no wall between two samples.
Exit status: 0 a path was found and proven, 3 none was found in time. None found does not mean
that none exists.)";

struct Arguments {
  std::string robot;
  std::vector<std::string> obstacles, bodies, starts, goals;
  std::optional<std::string> output, bounds, threads;
  OptionTexts<PlanOptions> options;
  ReportOptions report;
};

RigidTransform parse_pose(const std::string& option, const std::string& text) {
  PoseNumbers numbers{};
  std::size_t count = 0;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    if (count == numbers.size()) ++count;
    if (count > numbers.size()) break;
    numbers[count++] = parse_number(option, rest.substr(0, comma));
    if (comma == rest.size()) break;
    rest.remove_prefix(comma + 1);
  }
  if (count != numbers.size())
    throw UsageError(option + " is '" + text + "', but needs seven numbers x,y,z,qw,qx,qy,qz");
  return pose_of(numbers);
}

std::vector<RigidTransform> parse_poses(const std::string& option, const std::vector<std::string>& texts,
                                        std::size_t bodies) {
  if (texts.size() != bodies) {
    throw UsageError(option + " is given " + std::to_string(texts.size()) +
                     " times, but must be given once for each of " + plural(bodies, "body", "bodies"));
  }
  std::vector<RigidTransform> out;
  for (const std::string& text : texts) out.push_back(parse_pose(option, text));
  return out;
}

/// Meshes of bodies or obstacles, with their files.
struct Meshes {
  std::vector<std::string> files;
  std::vector<TriangleMesh> meshes;

  explicit Meshes(std::vector<std::string> files_) : files(std::move(files_)) {
    for (const std::string& file : files) meshes.push_back(read_mesh(file));
  }
  [[nodiscard]] std::vector<MeshView> views() const { return {meshes.begin(), meshes.end()}; }
  [[nodiscard]] std::vector<PathMesh> described(const fs::path& folder) const {
    std::vector<PathMesh> out;
    for (const std::string& file : files) out.push_back(describe_path_mesh(file, folder));
    return out;
  }
};

PathFile path_file(const PlannedPath& found, const Meshes& bodies, const Meshes& obstacles, const fs::path& output) {
  PathFile out;
  out.bodies = bodies.described(output.parent_path());
  out.obstacles = obstacles.described(output.parent_path());
  out.centres = found.path.centres;
  for (const std::vector<RigidTransform>& waypoint : found.path.poses) {
    std::vector<PoseNumbers>& poses = out.poses.emplace_back();
    for (const RigidTransform& pose : waypoint) poses.push_back(numbers_of(pose));
  }
  out.clearance = found.proof.at_least;
  out.intervals = found.proof.intervals;
  return out;
}

std::string pair_text(const MotionPair& pair, const Meshes& bodies, const Meshes& obstacles) {
  const std::string& other =
      pair.obstacle ? obstacles.files[*pair.obstacle] : bodies.files[pair.other_body.value_or(0)];
  return "'" + bodies.files[pair.body] + "' and '" + other + "'";
}

void run(const Arguments& a) {
  const PlanOptions options = a.options.read();
  std::vector<std::string> body_files{a.robot};
  body_files.insert(body_files.end(), a.bodies.begin(), a.bodies.end());
  if (a.output) check_extension("--output", *a.output, file_extensions(FileContent::path, FileAccess::write));
  PlanProblem problem;
  problem.start = parse_poses("--start", a.starts, body_files.size());
  problem.goal = parse_poses("--goal", a.goals, body_files.size());
  if (a.bounds) problem.bounds = parse_bounds("--bounds", *a.bounds);
  std::vector<fs::path> inputs(body_files.begin(), body_files.end());
  inputs.insert(inputs.end(), a.obstacles.begin(), a.obstacles.end());
  std::vector<fs::path> outputs = a.report.files();
  if (a.output) outputs.emplace_back(*a.output);
  check_outputs(outputs, inputs);
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  const Context context = make_context(parse_threads(a.threads), progress, interrupt);
  const Meshes bodies(body_files), obstacles(a.obstacles);
  problem.bodies = bodies.views();
  problem.obstacles = obstacles.views();
  const PlannedPath found = plan_path(problem, options, context);
  if (found.is_found && a.output) write_path(*a.output, path_file(found, bodies, obstacles, *a.output), context);
  progress.clear();
  TextTable table;
  Json facts = {{"bodies", body_files},    {"obstacles", a.obstacles},
                {"found", found.is_found}, {"planner", std::string(to_string(options.planner))},
                {"seed", options.seed},    {"seconds", found.seconds},
                {"states", found.states}};
  if (found.is_found) {
    const CertifiedPath& proof = found.proof;
    table.add("path", "proven: " + plural(found.path.edges(), "motion", "motions") + ", clearance at least " +
                          rounded_text(proof.at_least) + " (at most " + rounded_text(proof.at_most) + ")");
    if (proof.closest) {
      table.add("narrowest", pair_text(*proof.closest, bodies, obstacles) + " at " +
                                 vector_text(proof.closest->on_body) + ", motion " + std::to_string(proof.edge));
    }
    if (body_files.size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t body : found.order) names.push_back(body_files[body]);
      table.add("order", join_words(names, "then"));
    }
    facts["order"] = Json(std::vector<std::size_t>(found.order));
    facts["motions"] = found.path.edges();
    facts["proof"] = to_json(proof);
    facts["proof"]["intervals"] = proof.intervals.size();
  }
  table.add("search", rounded_text(found.seconds) + " s, " + plural(found.states, "state", "states"));
  if (found.is_found && a.output) table.add("wrote", *a.output);
  report(a.report, answer_json("plan", facts), table);
  if (!found.is_found) {
    throw NoPath("no path was found in " + rounded_text(options.time) +
                 " s; this does not prove that none exists; give more --time, another --seed or --planner, or less "
                 "--clearance");
  }
}

}  // namespace

void add_plan_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("plan", "Find a path of a rigid body among obstacles, proven free of contact");
  command.add_option("ROBOT", a->robot, "Mesh of the body that moves").required();
  command.add_option("OBSTACLES", a->obstacles, "Meshes that rest");
  command.add_option("--body", a->bodies, "Mesh of a further body that moves; repeat --start and --goal for it")
      .type_name("FILE")
      .one_value_each();
  command.add_option("--start", a->starts, "Pose of the body at the start")
      .required()
      .type_name("POSE")
      .one_value_each();
  command.add_option("--goal", a->goals, "Pose of the body at the end").required().type_name("POSE").one_value_each();
  add_text_option(command, "-o,--output", a->output, "FILE",
                  "Path with its proof: " + extension_list(FileContent::path, FileAccess::write));
  add_text_option(command, "--bounds", a->bounds, "X0,Y0,Z0,X1,Y1,Z1",
                  "Box for the centre of the body (default: around all meshes and poses)");
  a->options.add_to(command);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
