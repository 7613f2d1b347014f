#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {
namespace {

/// The search first makes this number of descents, each from the closest pair of boxes down to primitives.
constexpr std::size_t dives = 8;
/// Then one thread continues for this number of steps, which is enough for most searches. Only longer searches use all
/// threads, because starting them takes tens of microseconds. A thread does this number of steps between two looks at
/// the context.
constexpr std::size_t steps_alone = 4096;
constexpr std::size_t parts_of_two = 64;
constexpr std::size_t blocks_per_part = 16;
constexpr std::size_t parts_of_first_round = 4;

/// One part of a search: searches for a pair of primitives that is closer than the best pair so far.
class PartSearch {
 public:
  PartSearch(const ObjectPair& objects, CandidateLimit& candidates, const Closest& start)
      : objects_(&objects), candidates_(&candidates), best_(start) {}

  /// Returns the greatest distance at which primitives may still change the result, plus the error of positions in the
  /// hierarchies.
  [[nodiscard]] double limit() const { return best_.limit + objects_->slack(); }
  [[nodiscard]] const Closest& best() const { return best_; }
  [[nodiscard]] const ProximityReport& report() const { return report_; }

  /// Compares two primitives.
  /// @return  limit() after the comparison; negative if the search must stop.
  double look_at(std::uint32_t i, std::uint32_t j) {
    if (candidates_->stops(++report_.candidates)) return -1;
    if (objects_->is_self() && objects_->are_neighbours(i, j)) return limit();
    if (objects_->is_self() && j < i) std::swap(i, j);
    const bool is_after =
        best_.limit == 0 && best_.pair && std::pair(i, j) > std::pair(best_.pair->first, best_.pair->second);
    if (!is_after) {
      ++report_.exact_tests;
      best_.offer(objects_->compare(i, j));
    }
    return limit();
  }

  /// Compares primitives of two different objects. If a pair at distance 0 is known, only earlier primitives of the
  /// first object may still change the result.
  OrientedBvh::Wanted see(std::uint32_t i, std::uint32_t j) {
    const double within = look_at(i, j);
    const bool is_zero = best_.limit == 0 && best_.pair;
    return {within, 0xffffffffU, is_zero ? best_.pair->first : 0xffffffffU};
  }

 private:
  const ObjectPair* objects_;
  CandidateLimit* candidates_;
  Closest best_;
  ProximityReport report_;
};

/// The search for the closest pair of two objects, or of an object and itself.
class ClosestPairSearch {
 public:
  ClosestPairSearch(const ObjectPair& objects, double max_distance, const Context& context)
      : objects_(objects), context_(context), candidates_(context), best_{std::nullopt, max_distance} {}

  std::optional<PrimitivePair> run(ProximityReport& report) {
    if (objects_.is_self()) {
      search_self();
    } else {
      search_two();
    }
    candidates_.check();
    add(report_, report);
    return best_.pair;
  }

 private:
  [[nodiscard]] PartSearch part() { return {objects_, candidates_, best_}; }

  void take(const PartSearch& found) {
    if (found.best().pair) best_.offer(*found.best().pair);
    add(found.report(), report_);
  }

  void search_two() {
    const OrientedBvh& a = objects_.a().bvh();
    const OrientedBvh& b = objects_.b().bvh();
    PartSearch search = part();
    const auto see = [&](std::uint32_t i, std::uint32_t j, double) { return search.see(i, j); };
    auto left = a.dive_to_near_pairs(b, objects_.place(), search.limit(), dives, see);
    left = a.visit_some_near_pairs(left, b, objects_.place(), search.limit(), steps_alone, see);
    take(search);
    const std::size_t size = std::max<std::size_t>(left.size() / parts_of_two, 1);
    search_in_rounds((left.size() + size - 1) / size, [&](std::size_t k, PartSearch& of_part) {
      const auto visit = [&](std::uint32_t i, std::uint32_t j, double) { return of_part.see(i, j); };
      const auto from = left.begin() + static_cast<std::ptrdiff_t>(k * size);
      const auto count = static_cast<std::ptrdiff_t>(std::min(size, left.size() - k * size));
      std::vector<OrientedBvh::NodePair> nodes(from, from + count);
      while (!nodes.empty() && !candidates_.look()) {
        nodes = a.visit_some_near_pairs(nodes, b, objects_.place(), of_part.limit(), steps_alone, visit);
      }
    });
  }

  void search_self() {
    const OrientedBvh& bvh = objects_.a().bvh();
    const std::size_t parts = (bvh.block_count() + blocks_per_part - 1) / blocks_per_part;
    search_in_rounds(parts, [&](std::size_t k, PartSearch& search) {
      const auto visit = [&](std::uint32_t i, std::uint32_t j, double) { return search.look_at(i, j); };
      const std::size_t end = std::min((k + 1) * blocks_per_part, bvh.block_count());
      for (std::size_t block = k * blocks_per_part; block < end && !candidates_.is_stopped(); ++block) {
        bvh.for_each_near_self_pair(block, search.limit(), visit);
      }
    });
  }

  /// Searches all parts in rounds. Each round has twice as many parts as the round before. All parts of a round start
  /// from the results of earlier rounds, so that results and counts do not depend on the number of threads.
  /// @param search_part  callable: (k, search) -> void, searches part k with the given PartSearch.
  template <class SearchPart>
  void search_in_rounds(std::size_t parts, const SearchPart& search_part) {
    std::size_t size = parts_of_first_round;
    for (std::size_t begin = 0; begin < parts; begin += size, size *= 2) {
      std::vector<PartSearch> found(std::min(size, parts - begin), part());
      parallel_for(context_, found.size(), 1, "", [&](const WorkRange& range) {
        for (std::size_t k = range.begin; k < range.end; ++k) search_part(begin + k, found[k]);
      });
      for (const PartSearch& one : found) take(one);
    }
  }

  const ObjectPair& objects_;
  const Context& context_;
  CandidateLimit candidates_;
  Closest best_;
  ProximityReport report_;
};

}  // namespace

std::optional<PrimitivePair> closest_pair(const ObjectPair& objects, double max_distance, const Context& context,
                                          ProximityReport& report) {
  static_cast<void>(thread_count(context));
  throw_if_cancelled(context);
  if (objects.is_self()) check_neighbours(objects);
  return ClosestPairSearch(objects, max_distance, context).run(report);
}

}  // namespace blum::detail
