#include <memory>
#include <string>

#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

constexpr const char* examples = R"(Examples:
  blum proximity separation arm.ply table.ply            distance and closest points
  blum proximity collide a.ply b.ply -o pairs.npz        all pairs of triangles that meet
  blum proximity meets a.ply b.ply                       yes or no, stops at the first pair
  blum proximity penetration a.ply b.ply --json -        each connected part of the overlap of two solids
  blum proximity continuous start.ply end.ply --self     collisions between two frames

`blum proximity QUERY --help` lists the options of a query.)";

void run(const ProximityArguments& a, const SceneQuery& query) {
  if (!a.ends.empty() && a.ends.front().starts_with('-')) {
    throw UsageError("--to needs a file for each SCENE, but '" + a.ends.front() + "' follows it");
  }
  if (a.skip_changed && !a.frames) throw UsageError("--skip-changed needs --frames");
  if (a.frames) return run_frames(a, query);
  if (query.moves) return run_continuous_query(a);
  run_scene_query(a, query);
}

void add_output_options(const Command& command, const SceneQuery& query, ProximityArguments& a) {
  add_text_option(command, "-o,--output", a.output, "FILE", std::string(query.output) + ". Default: print counts only");
  add_text_option(command, "--limit", a.limit, "N",
                  std::string("Write at most N pairs") + (query.takes_frames ? " (per frame)" : "") +
                      ", the first by index, not by distance or time (penetration: the deepest first); counts include "
                      "all pairs (default: all)");
}

void add_query(const Command& parent, const SceneQuery& query) {
  auto a = std::make_shared<ProximityArguments>();
  a->query = query.name;
  const Command command = parent.add_subcommand(a->query, std::string(query.doc));
  const std::string files = extensions_help({FileContent::mesh}, FileAccess::read);
  command
      .add_option(
          "SCENE", a->scene,
          (query.moves
               ? "Two files: one mesh at the start and at the end of its motion. With --to, one file for each object: "
               : "One file for each object: ") +
              files)
      .required();
  if (query.moves) {
    command
        .add_option("--to", a->ends,
                    "Objects at the end of the motion: one file for each SCENE, in the same order. For an object at "
                    "rest, repeat its file")
        .type_name("END");
  }
  command.add_flag(
      "--self", a->self,
      query.has_pairs
          ? "Also compare each object with itself, except primitives with a common vertex. Without "
            "--max-distance, collide also returns pairs with a common vertex that cross or are folded onto each other"
          : "Also compare each object with itself, by the same rules as collide");
  if (query.takes_frames) {
    command.add_flag(
        "--frames", a->frames,
        "The files are frames of one moving object; -o PAIRS.json stores the pairs of each frame for `blum "
        "view --frames --pairs`");
  }
  if (query.moves) {
    command.add_flag(
        "--first", a->first,
        "Find only the first contact (of several at the same time, the one with the smallest indices). Much faster if "
        "many pairs meet; counts and -o then contain only this pair");
    command.add_flag("--skip-changed", a->skip_changed,
                     "With --frames: skip and list steps between frames that differ in triangles or numbers of "
                     "vertices (default: report an error)");
  }
  if (!query.max_distance.empty()) {
    add_text_option(command, "--max-distance", a->max_distance, "D", std::string(query.max_distance));
  }
  if (query.has_pairs) add_output_options(command, query, *a);
  add_weld_option(command, a->weld);
  if (query.takes_culling) a->culling.add_to(command);
  if (query.takes_depth) a->penetration.add_to(command);
  if (query.moves) a->impact.add_to(command);
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer("Examples:\n" + std::string(query.examples) + "\n\nIn C++ and Python: ProximityScene." +
                 std::string(query.method) + "()");
  command.callback([a, &query] { run(*a, query); });
}

}  // namespace

void add_proximity_command(const CommandLine& line) {
  const Command command = line.app.add_subcommand(
      "proximity", "Exact distances, collisions and overlaps of meshes: one subcommand per query");
  command.require_subcommand();
  for (const SceneQuery& query : scene_queries()) add_query(command, query);
  add_translation_query(command);
  command.footer(examples);
}

}  // namespace blum::cli
