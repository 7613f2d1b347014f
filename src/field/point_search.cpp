#include "field/point_search.hpp"

#include <algorithm>
#include <utility>

#include "blum/core/inline_list.hpp"

namespace blum {
namespace {

/// More at once take more memory (50 bytes each), and no less time each.
constexpr std::size_t queries_per_batch = std::size_t{1} << 23;

}  // namespace

bool PointSearch::is_worth_building(std::size_t queries, const SiteTable& sites) {
  return queries >= 4096 && queries >= sites.face_count();
}

bool PointSearch::is_worth_using(std::size_t queries, const SiteTable& sites) {
  return queries >= fewest && queries >= sites.face_count() / 2;
}

std::optional<NearestSite> PointSearch::projection(const Vec3d& query, const cpu::FoundSite& found) const {
  if (!found.site.has_value()) return std::nullopt;
  const std::optional<NearestSite> first = projection_.project(found.site, query, engine_.margin());
  if (!first || !found.other.has_value()) return first;
  const std::optional<NearestSite> second = projection_.project(found.other, query, engine_.margin());
  if (!second) return std::nullopt;
  const auto key = [](const NearestSite& site) { return std::pair(site.distance, site.site); };
  return key(*first) < key(*second) ? first : second;
}

std::optional<NearestSite> PointSearch::finished(const Vec3d& query, const cpu::FoundSite& found, double max_distance,
                                                 const Bvh& bvh) const {
  if (const std::optional<NearestSite> projected = projection(query, found)) {
    return projected->distance <= max_distance ? projected : std::nullopt;
  }
  if (found.at_most < max_distance) {
    const std::optional<NearestSite> near = bvh.nearest(query, found.at_most);
    if (near) return near;
  }
  return bvh.nearest(query, max_distance);
}

void PointSearch::nearest(std::span<const Vec3d> queries, double max_distance, const Bvh& bvh, const Context& context,
                          FunctionRef<void(std::span<const Answer>)> tell) const {
  for (std::size_t first = 0; first < queries.size(); first += queries_per_batch) {
    const auto batch = queries.subspan(first, std::min(queries_per_batch, queries.size() - first));
    engine_.for_each_group(batch, context, [&](std::span<const cpu::FoundSite> group) {
      InlineList<Answer, cpu::PointEngine::most_per_group> answers;
      for (const cpu::FoundSite& one : group) {
        answers.push_back({first + one.query, finished(batch[one.query], one, max_distance, bvh)});
      }
      tell({&answers[0], answers.size()});
    });
  }
}

}  // namespace blum
