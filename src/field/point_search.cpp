#include "field/point_search.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "blum/core/inline_list.hpp"

namespace blum {
namespace {

/// Number of queries per batch. Larger batches need more memory (50 bytes per query) without reducing the time per
/// query.
constexpr std::size_t queries_per_batch = std::size_t{1} << 23;

}  // namespace

bool PointSearch::is_worth_building(std::size_t queries, std::size_t faces) {
  return queries >= 4096 && queries >= faces;
}

bool PointSearch::is_worth_using(std::size_t queries, const SiteTable& sites) {
  return queries >= fewest && queries >= sites.face_count() / 2;
}

bool PointSearch::is_certain(const cpu::FoundSite& found, NearestSite& nearest) const {
  if (!nearest.site.has_value()) return false;
  if (!found.other.has_value()) return true;
  NearestSite other;
  if (!projection_.project(found.other, found.at, engine_.margin(), other)) return false;
  const auto key = [](const NearestSite& site) { return std::pair(site.distance, site.site); };
  if (key(other) < key(nearest)) nearest = other;
  return true;
}

std::optional<NearestSite> PointSearch::search(const Vec3d& query, const cpu::FoundSite& found, double max_distance,
                                               const Bvh& bvh) const {
  const double at_most = engine_.at_most(query, found);
  if (at_most < max_distance) {
    const std::optional<NearestSite> near = bvh.nearest(query, at_most);
    if (near) return near;
  }
  return bvh.nearest(query, max_distance);
}

void PointSearch::nearest(std::span<const Vec3d> queries, double max_distance, const Bvh& bvh, const Context& context,
                          FunctionRef<void(std::span<const Answer>)> receive) const {
  for (std::size_t first = 0; first < queries.size(); first += queries_per_batch) {
    const auto batch = queries.subspan(first, std::min(queries_per_batch, queries.size() - first));
    engine_.for_each_group(batch, context, [&](const cpu::FoundGroup& group) {
      constexpr std::size_t most = cpu::PointEngine::most_per_group;
      std::array<SiteId, most> sites;
      std::array<NearestSite, most> nearest;
      for (std::size_t k = 0; k < group.size(); ++k) {
        sites[k] = engine_.is_in_frame(group.at[k]) ? group.known_site(group.site[k]) : SiteId::none();
      }
      projection_.project(std::span(sites).first(group.size()), group.at, engine_.margin(), nearest);
      InlineList<Answer, most> answers;
      for (std::size_t k = 0; k < group.size(); ++k) {
        Answer& answer = answers.emplace_back();
        answer = {first + group.order[k].index, group.at[k], nearest[k]};
        const bool is_single = nearest[k].site.has_value() && group.other[k] == cpu::dead_record;
        if (!is_single && !is_certain(group[k], answer.nearest)) {
          answer.nearest = search(answer.at, group[k], max_distance, bvh).value_or(NearestSite{});
        } else if (answer.nearest.distance > max_distance) {
          answer.nearest.site = SiteId::none();
        }
      }
      receive(answers.span());
    });
  }
}

}  // namespace blum
