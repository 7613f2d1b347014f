#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/options.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

double most(const SceneQuestion& asked) {
  return asked.max_distance.value_or(std::numeric_limits<double>::infinity());
}

SceneFound ask_separation(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  return {.pairs = scene.separation(most(asked), context)};
}

SceneFound ask_signed(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  return {.pairs = scene.signed_separations(asked.penetration, context)};
}

SceneFound ask_nbody(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  return {.pairs = scene.closest_primitives(most(asked), context)};
}

SceneFound ask_collide(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  if (asked.max_distance.value_or(0) > 0) return {.pairs = scene.closer_than(*asked.max_distance, context)};
  return {.pairs = scene.collisions(context), .kind = "collision"};
}

SceneFound ask_penetration(const ProximityScene& scene, const SceneQuestion& asked, const Context& context) {
  Penetrations found = scene.penetrations(asked.penetration, context);
  SceneFound out{.parts = std::move(found.parts), .kind = "penetration"};
  for (const Penetration& part : out.parts) out.pairs.pairs.push_back(deepest_pair(part));
  out.pairs.report.object_pairs = found.object_pairs;
  out.pairs.report.phases = std::move(found.phases);
  return out;
}

constexpr std::array queries{
    SceneQuery{.name = "separation",
               .doc = "the closest pair of each two objects (default)",
               .takes_max_distance = true,
               .takes_culling = true,
               .has_rows = true,
               .ask = ask_separation},
    SceneQuery{.name = "signed",
               .doc = "the same of solids, or minus the depth where they overlap",
               .takes_culling = true,
               .takes_depth = true,
               .takes_frames = false,
               .has_rows = true,
               .ask = ask_signed},
    SceneQuery{.name = "nbody",
               .doc = "for each primitive (triangle, segment or point) the closest one",
               .takes_max_distance = true,
               .takes_culling = true,
               .ask = ask_nbody},
    SceneQuery{.name = "collide",
               .doc = "all pairs that meet",
               .takes_max_distance = true,
               .takes_culling = true,
               .ask = ask_collide},
    SceneQuery{.name = "penetration",
               .doc = "what solids have in common, and how deep they lie in each other",
               .takes_depth = true,
               .ask = ask_penetration},
    SceneQuery{.name = "continuous", .doc = "what of a mesh, or with --to of objects, meets between two frames"}};

}  // namespace

std::span<const SceneQuery> scene_queries() {
  return queries;
}

std::string queries_that(bool SceneQuery::* take) {
  std::vector<std::string> names;
  for (const SceneQuery& query : queries) {
    if (query.*take) names.emplace_back(query.name);
  }
  return join_words(names);
}

const SceneQuery& scene_query(const std::string& name) {
  const auto* const query =
      std::find_if(queries.begin(), queries.end(), [&](const auto& one) { return one.name == name; });
  if (query != queries.end()) return *query;
  std::vector<std::string> names;
  for (const SceneQuery& one : queries) names.emplace_back(one.name);
  throw UsageError("--query is '" + name + "', but must be " + join_words(names, "or"));
}

}  // namespace blum::cli
