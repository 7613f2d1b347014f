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
  blum proximity arm.ply table.ply       how far they are apart, and where
  blum proximity *.stl -o pairs.csv      the same for all pairs of files
  blum proximity cloth.ply --self --query nbody --max-distance 0.01 -o pairs.vtp
                                         for each triangle the closest one, within 0.01, that shares no vertex with it
  blum proximity a.ply b.ply --query collide
                                         how many triangles meet
  blum proximity a.ply b.ply --query collide -o pairs.npz
                                         all pairs of triangles that meet
  blum proximity a.ply b.ply --query collide --max-distance 0.01 -o pairs.npz
                                         all pairs no further apart than 0.01
  blum proximity a.ply b.ply c.ply --query signed
                                         how far each two solids are apart, or minus the depth where they overlap
  blum proximity a.ply b.ply --query penetration --json -
                                         what they have in common, part by part: depth, direction, area, volume, curves
  blum proximity cloth1.ply cloth2.ply --query continuous --self -o pairs.npz
                                         all pairs of a vertex and a face, or of two edges, that meet between two frames
  blum proximity cloth1.ply cloth2.ply --query continuous --self -o pairs.csv --min-separation 1e-3
                                         all that come as close as that
  blum proximity ball1.ply plate.ply --to ball2.ply plate.ply --query continuous -o pairs.npz
                                         the same of objects: each file has one at the end; the plate rests
  blum proximity cloth*.ply --frames --self --query continuous -o pairs.json
                                         what meets between any frame and the next; blum view shows it)";

/// "separation: the closest pair of ...; signed: ...".
std::string queries_text() {
  std::string out;
  for (const SceneQuery& query : scene_queries()) {
    out += (out.empty() ? "" : "; ") + std::string(query.name) + ": " + std::string(query.doc);
  }
  return out;
}

void run(const ProximityArguments& a) {
  const SceneQuery& query = scene_query(a.query);
  if (!a.ends.empty() && a.ends.front().starts_with('-')) {
    throw UsageError("--to names no file: '" + a.ends.front() + "' follows it; name one for each SCENE");
  }
  if (a.skip_changed && !(a.frames && a.query == "continuous")) {
    throw UsageError("--skip-changed is for --frames with --query continuous alone");
  }
  if (a.frames && !query.takes_frames) {
    throw UsageError("--query " + a.query + " is for several objects, not for --frames");
  }
  if (!a.ends.empty() && a.query != "continuous") throw UsageError("--to is for --query continuous alone");
  if (a.frames) return run_frames(a, query);
  if (query.ask == nullptr) return run_continuous_query(a);
  run_scene_query(a, query);
}

}  // namespace

void add_proximity_command(const CommandLine& line) {
  auto a = std::make_shared<ProximityArguments>();
  const Command command = line.app.add_subcommand("proximity", "Distances and collisions of meshes, exactly");
  command
      .add_option("SCENE", a->scene,
                  "Objects, a file for each; with --query continuous two frames of one, or with --to objects: " +
                      extensions_help({FileContent::mesh}, FileAccess::read))
      .required();
  command.add_option("--query", a->query, queries_text()).type_name("QUERY");
  command
      .add_option("--to", a->ends,
                  "continuous: where the objects are at the end, a file for each SCENE, in the same order; one that "
                  "rests is named in both")
      .type_name("END");
  command.add_flag("--self", a->self, "Compare each object with itself, too: primitives that share no vertex");
  command.add_flag("--frames", a->frames,
                   "The files are frames of one object that moves; -o PAIRS.json tells the pairs of each, for `blum "
                   "view --frames --pairs`");
  command.add_flag("--skip-changed", a->skip_changed,
                   "continuous with --frames: leave out steps between frames of different triangles or vertices, and "
                   "tell which, instead of an error");
  add_text_option(command, "--max-distance", a->max_distance, "D",
                  queries_that(&SceneQuery::takes_max_distance) +
                      ": only pairs no further apart than D, mesh units (default: all; of collide those that meet)");
  add_text_option(
      command, "-o,--output", a->output, "FILE",
      "The pairs: .npz (object, primitive, distance, point, feature), .csv, .json, .vtp (lines between "
      "closest points); of continuous .npz (vertex_face, edge_edge, vertex_face_time, edge_edge_time; with --to "
      "vertex_face_object, edge_edge_object), .csv, .json, .vtp (the vertices, edges and faces where they meet). Of "
      "penetration the deepest point of each part and the closest one to it, with the depth as a negative distance; "
      "depth_bound, direction, area, volume. Without it the pairs are counted");
  add_text_option(command, "--limit", a->limit, "N",
                  "Write at most N pairs, of --frames of each frame; all are counted (default: all)");
  add_weld_option(command, a->weld);
  a->culling.add_to(command, queries_that(&SceneQuery::takes_culling) + ": ");
  a->penetration.add_to(command, queries_that(&SceneQuery::takes_depth) + ": ");
  a->impact.add_to(command, "continuous: ");
  add_threads_option(command, a->threads);
  add_report_options(command, a->report);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
