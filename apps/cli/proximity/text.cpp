#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "common/options.hpp"
#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

/// Keeps at most the first `left` entries, and subtracts the number kept from `left`.
template <class T>
void cut(std::vector<T>& entries, std::size_t& left) {
  if (entries.size() > left) entries.resize(left);
  left -= entries.size();
}

}  // namespace

std::string objects_text(const std::vector<std::string>& names, ObjectId first, ObjectId second) {
  return names[first.value] + ", " + (first == second ? "itself" : names[second.value]);
}

void check_objects(const ProximityArguments& a) {
  if (a.scene.size() == 1 && !a.self) {
    throw UsageError("one object can only meet itself; add --self, or the files of more objects");
  }
}

std::size_t read_limit(const ProximityArguments& a) {
  constexpr std::int64_t most = std::int64_t{1} << 40;
  return a.limit ? static_cast<std::size_t>(parse_integer("--limit", *a.limit, 0, most)) : most;
}

std::string limit_text(std::size_t pairs, std::size_t limit) {
  return pairs > limit ? "; only the first " + count_text(limit) + " pairs were written (--limit)" : "";
}

ContinuousCollisions first_of(ContinuousCollisions found, std::size_t limit) {
  cut(found.vertex_face, limit);
  cut(found.edge_edge, limit);
  return found;
}

SceneCollisions first_of(SceneCollisions found, std::size_t limit) {
  for (ObjectCollisions& pair : found.objects) {
    cut(pair.vertex_face, limit);
    cut(pair.face_vertex, limit);
  }
  for (ObjectCollisions& pair : found.objects) cut(pair.edge_edge, limit);
  return found;
}

}  // namespace blum::cli
