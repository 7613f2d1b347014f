#include "proximity/meets.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/triangle_distance.hpp"

namespace blum::detail {
namespace {

using NodePair = OrientedBvh::NodePair;

/// Number of steps between two looks at the context. A search that needs fewer steps uses one thread, because starting
/// threads takes tens of microseconds.
constexpr std::size_t steps_per_part = 4096;
constexpr std::size_t places_per_range = 16;

/// Two different objects that may meet, with any transform of the second object.
class Couple {
 public:
  Couple(const SceneObject& a, const SceneObject& b, const RigidTransform& place_of_b)
      : a_(&a), b_(&b), place_of_b_(place_of_b), slack_(position_slack(a, b, place_of_b)) {
    if (!(a.place() == place_of_b)) relative_ = a.place().inverse() * place_of_b;
  }

  /// Returns true if primitive i of the first object and primitive j of the second have a common point.
  [[nodiscard]] bool meet(std::uint32_t i, std::uint32_t j) const {
    return triangles_meet(a_->corners(i), b_->corners(j, place_of_b_));
  }

  [[nodiscard]] NodePair whole() const { return a_->bvh().whole(b_->bvh()); }

  /// Searches below pairs of nodes for a limited number of steps.
  /// @param visit  callable: (i, j) -> bool, returns true to end the search.
  /// @return  the remaining pairs of nodes.
  template <class Visit>
  std::vector<NodePair> search(std::span<const NodePair> nodes, const Visit& visit) const {
    const auto see = [&](std::uint32_t i, std::uint32_t j, double) { return visit(i, j) ? -1 : slack_; };
    return a_->bvh().visit_some_near_pairs(nodes, b_->bvh(), relative_, slack_, steps_per_part, see);
  }

 private:
  const SceneObject* a_;
  const SceneObject* b_;
  RigidTransform place_of_b_;
  double slack_;
  RigidTransform relative_;  ///< from the coordinates of the second object to those of the first
};

/// A search for the first pair of primitives that meet. Its parts may run on several threads.
class MeetSearch {
 public:
  MeetSearch(const Couple& couple, CandidateLimit& candidates) : couple_(couple), candidates_(candidates) {}

  [[nodiscard]] bool is_found() const { return is_found_; }
  /// Returns the pair that was found, after a search by one thread.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> pair() const { return pair_; }

  /// Searches below pairs of nodes for a limited number of steps. Returns the remaining pairs.
  std::vector<NodePair> run(std::span<const NodePair> nodes) {
    std::size_t count = 0;
    return couple_.search(nodes, [&](std::uint32_t i, std::uint32_t j) {
      if (candidates_.stops(++count) || is_found_) return true;
      if (!couple_.meet(i, j)) return false;
      pair_ = {i, j};
      is_found_ = true;
      return true;
    });
  }

 private:
  const Couple& couple_;
  CandidateLimit& candidates_;
  std::atomic<bool> is_found_ = false;
  std::pair<std::uint32_t, std::uint32_t> pair_;
};

/// Searches for a pair that meets, on the calling thread only.
/// @return  the pair; nullopt also if the search was stopped.
std::optional<std::pair<std::uint32_t, std::uint32_t>> first_meeting_pair(const Couple& couple,
                                                                          CandidateLimit& candidates) {
  MeetSearch search(couple, candidates);
  const NodePair whole = couple.whole();
  std::vector<NodePair> left = search.run({&whole, 1});
  while (!left.empty() && !candidates.look()) left = search.run(left);
  return search.is_found() ? std::optional(search.pair()) : std::nullopt;
}

/// Returns true if the objects meet. A search of many steps runs in rounds. In each round, threads search below pairs
/// of nodes for some steps. The pairs of nodes that remain are examined in the next round.
bool meet_in_rounds(const Couple& couple, CandidateLimit& candidates, const Context& context) {
  MeetSearch search(couple, candidates);
  const NodePair whole = couple.whole();
  std::vector<NodePair> left = search.run({&whole, 1});
  while (!left.empty() && !search.is_found()) {
    std::vector<std::vector<NodePair>> parts(left.size());
    parallel_for(context, left.size(), 1, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        if (!search.is_found() && !candidates.look()) parts[k] = search.run({&left[k], 1});
      }
    });
    left.clear();
    for (const std::vector<NodePair>& part : parts) left.insert(left.end(), part.begin(), part.end());
  }
  if (!search.is_found()) candidates.check();
  return search.is_found();
}

}  // namespace

bool meet(const TwoObjects& objects, const Context& context) {
  static_cast<void>(thread_count(context));
  throw_if_cancelled(context);
  if (objects.first == objects.second) return meets_itself(ObjectPair(objects), context);
  CandidateLimit candidates(context);
  return meet_in_rounds(Couple(*objects.a, *objects.b, objects.b->place()), candidates, context);
}

namespace {

/// Returns true if a transform passes check().
bool is_rigid(const RigidTransform& place) {
  try {
    check(place);
  } catch (const InvalidOption&) {
    return false;
  }
  return true;
}

/// Checks one of several transforms. @throws InvalidOption with its index.
void check_nth(std::size_t k, const RigidTransform& place) {
  try {
    check(place);
  } catch (const InvalidOption& error) {
    throw InvalidOption("transforms[" + std::to_string(k) + "]: " + error.what());
  }
}

/// Checks all transforms with the threads of the context. For many transforms that are far apart, checks take a quarter
/// of the time.
void check_all(std::span<const RigidTransform> places, const Context& context) {
  constexpr std::size_t checks_per_range = 512;
  std::vector<std::size_t> wrong((places.size() + checks_per_range - 1) / checks_per_range, places.size());
  parallel_for(context, places.size(), checks_per_range, "", [&](const WorkRange& range) {
    std::size_t k = range.begin;
    while (k < range.end && is_rigid(places[k])) ++k;
    if (k < range.end) wrong[range.begin / checks_per_range] = k;
  });
  for (const std::size_t k : wrong) {
    if (k < places.size()) check_nth(k, places[k]);
  }
}

}  // namespace

std::vector<std::uint8_t> meet_at(const SceneObject& first, const SceneObject& second,
                                  std::span<const RigidTransform> places, const Context& context) {
  check_all(places, context);
  std::vector<std::uint8_t> out(places.size());
  CandidateLimit candidates(context);
  parallel_for(context, places.size(), places_per_range, "places", [&](const WorkRange& range) {
    // Successive transforms often differ only slightly, as along a path. So the pair that met last may meet again.
    std::optional<std::pair<std::uint32_t, std::uint32_t>> last;
    for (std::size_t k = range.begin; k < range.end && !candidates.look(); ++k) {
      const Couple couple(first, second, places[k]);
      const bool meets_again = last && couple.meet(last->first, last->second);
      if (!meets_again) {
        if (const auto found = first_meeting_pair(couple, candidates))
          last = found;
        else
          continue;
      }
      out[k] = 1;
    }
  });
  candidates.check();
  return out;
}

}  // namespace blum::detail
