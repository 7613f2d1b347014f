#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

SceneFound ask_collide(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  if (asked.max_distance.value_or(0) > 0) return {.pairs = scene.closer_than(*asked.max_distance, context)};
  return {.pairs = scene.collisions(context), .kind = "collision"};
}

SceneFound ask_meets(const ProximityScene& scene, const SceneQuestion&, const Context& context) {
  SceneFound out{.kind = "meets"};
  PhaseTimer timer(out.pairs.report.phases);
  out.meets = scene.meets(context);
  timer.lap("primitives");
  return out;
}

SceneFound ask_penetration(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  Penetrations found = scene.penetrations(asked.penetration, context);
  SceneFound out{.parts = std::move(found.parts), .kind = "penetration"};
  for (const Penetration& part : out.parts) out.pairs.pairs.push_back(deepest_pair(part));
  out.pairs.report.object_pairs = found.object_pairs;
  out.pairs.report.phases = std::move(found.phases);
  return out;
}

constexpr std::string_view pairs_output =
    "Pairs: .npz (object, primitive, distance, closest, feature, metadata), .csv, .json, .vtp (lines between closest "
    "points)";
constexpr std::string_view within = "Only pairs at most D apart, in mesh units (default: all)";

constexpr std::array queries{
    SceneQuery{.name = "separation",
               .doc = "Closest pair of primitives for each pair of objects",
               .output = pairs_output,
               .method = "separation",
               .examples = R"(  blum proximity separation arm.ply table.ply
  blum proximity separation *.stl -o pairs.csv)",
               .max_distance = within,
               .takes_culling = true,
               .has_rows = true},
    SceneQuery{.name = "signed",
               .doc = "Distance for each pair of solids, or minus the depth if they overlap",
               .output = pairs_output,
               .method = "signed_separations",
               .examples = "  blum proximity signed a.ply b.ply c.ply",
               .takes_culling = true,
               .takes_depth = true,
               .takes_frames = false,
               .has_rows = true},
    SceneQuery{.name = "closest",
               .doc = "Closest other primitive of each triangle, segment and point",
               .output = pairs_output,
               .method = "closest_primitives",
               .examples = "  blum proximity closest cloth.ply --self --max-distance 0.01 -o pairs.vtp",
               .max_distance = within,
               .takes_culling = true},
    SceneQuery{.name = "collide",
               .doc = "All pairs of primitives that meet, or are close",
               .output = pairs_output,
               .method = "collisions",
               .examples = R"(  blum proximity collide a.ply b.ply
  blum proximity collide a.ply b.ply --max-distance 0.01 -o pairs.npz)",
               .max_distance = "All pairs at most D apart, in mesh units (default 0: pairs with a common point)",
               .takes_culling = true,
               .ask = ask_collide},
    SceneQuery{.name = "meets",
               .doc = "Yes or no: do any two objects meet? Stops at the first pair of primitives that meet",
               .method = "meets",
               .examples = R"(  blum proximity meets arm.ply table.ply
  blum proximity meets a.ply b.ply --json -)",
               .takes_frames = false,
               .has_pairs = false,
               .ask = ask_meets},
    SceneQuery{.name = "penetration",
               .doc = "Common parts of solids: depth, direction, area, volume",
               .output = "Deepest point of each part and its closest surface point; the depth is a negative "
                         "distance. Formats: .npz (also depth_bound, direction, area, volume), .csv, .json, "
                         ".vtp",
               .method = "penetrations",
               .examples = "  blum proximity penetration a.ply b.ply --json -",
               .takes_depth = true,
               .ask = ask_penetration},
    SceneQuery{.name = "continuous",
               .doc = "Collisions of moving meshes between two frames",
               .output = "Collisions: .npz, .csv, .json, .vtp (vertices, edges and faces at the time of impact). "
                         "Arrays of .npz: vertex_face, vertex_face_time, face, edge_edge, edge_edge_time, metadata; "
                         "with --to also vertex_face_object, edge_edge_object. Columns of .vtp: pair, time, vertex, "
                         "face; with --to also object",
               .method = "continuous",
               .examples = R"(  blum proximity continuous cloth1.ply cloth2.ply --self -o pairs.npz
  blum proximity continuous ball1.ply plate.ply --to ball2.ply plate.ply
  blum proximity continuous cloth*.ply --frames --self -o pairs.json)",
               .moves = true}};

}  // namespace

SceneFound ask(const SceneQuery& query, const ProximityScene& scene, const SceneQuestion& asked,
               const Context& context) {
  if (query.ask != nullptr) return query.ask(scene, asked, context);
  PairQueryOptions options{.penetration = asked.penetration};
  if (asked.max_distance) options.max_distance = *asked.max_distance;
  return {.pairs = ask_pairs(scene, query.method, options, context)};
}

std::span<const SceneQuery> scene_queries() {
  return queries;
}

}  // namespace blum::cli
