// Blum: close pairs of primitives of pairs of objects. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/proximity/scene.hpp"
#include "proximity/scene_object.hpp"

namespace blum::detail {

/// The closest pair found so far, of one primitive or of two objects.
struct Closest {
  std::optional<PrimitivePair> pair;
  double limit = 0;  ///< pairs further away are ignored

  void offer(const PrimitivePair& other);
  /// Returns true if a partner cannot replace the closest partner, whatever its distance. This is the case if the
  /// closest partner is at distance 0, and has a smaller (object, primitive).
  [[nodiscard]] bool rules_out(ObjectId object, std::uint32_t primitive) const {
    return limit == 0 && pair && std::pair(object, primitive) > std::pair(pair->second_object, pair->second);
  }
};

/// Returns the distance of two boxes, reduced by a bound on rounding errors.
[[nodiscard]] double box_gap(const Box3& a, const Box3& b);

/// Gaps of boxes are computed in the hierarchies' coordinates, but distances from rounded positions in the scene.
/// Returns a bound on the difference that rounding in the transforms of both objects causes.
/// @param place_of_b is used instead of the transform of the second object.
[[nodiscard]] double position_slack(const SceneObject& a, const SceneObject& b, const RigidTransform& place_of_b);

[[nodiscard]] PrimitivePair exchanged(const PrimitivePair& pair);

/// Adds counts, but not times.
/// @param to  the report to which the counts are added.
void add(const ProximityReport& report, ProximityReport& to);

/// Two objects, the one with the smaller number first, or an object and itself.
struct TwoObjects {
  ObjectId first;
  const SceneObject* a;
  ObjectId second;
  const SceneObject* b;
};

/// Two objects, and the data that a comparison of their primitives needs.
class ObjectPair {
 public:
  explicit ObjectPair(const TwoObjects& two) : ObjectPair(two.first, *two.a, two.second, *two.b) {}
  ObjectPair(ObjectId first, const SceneObject& a, ObjectId second, const SceneObject& b);

  [[nodiscard]] ObjectId first() const { return first_; }
  [[nodiscard]] ObjectId second() const { return second_; }
  [[nodiscard]] const SceneObject& a() const { return *a_; }
  [[nodiscard]] const SceneObject& b() const { return *b_; }
  [[nodiscard]] bool is_self() const { return first_ == second_; }
  /// Returns the transform from the coordinates of the second object to the coordinates of the first object.
  [[nodiscard]] const RigidTransform& place() const { return place_; }
  /// Returns the amount that must be added to distances in the scene for searches in the first object's coordinates,
  /// because positions are rounded.
  [[nodiscard]] double slack() const { return slack_; }

  /// For an object and itself: returns for each vertex the smallest vertex with the same position.
  [[nodiscard]] std::span<const std::uint32_t> clusters() const { return clusters_; }
  /// For an object and itself: returns for each vertex of a primitive the smallest vertex with the same position.
  [[nodiscard]] std::array<std::uint32_t, 3> places(std::uint32_t primitive) const;
  /// Returns true if two primitives of one object have vertices with the same position.
  [[nodiscard]] bool are_neighbours(std::uint32_t i, std::uint32_t j) const;
  /// Returns true if two neighbouring primitives of one object have more points in common than their shared vertices
  /// and edges.
  [[nodiscard]] bool are_folded(std::uint32_t i, std::uint32_t j) const;
  /// Returns the closest points of primitive i of the first object and primitive j of the second. Within one object,
  /// the smaller primitive is first in the result.
  [[nodiscard]] PrimitivePair compare(std::uint32_t i, std::uint32_t j) const;

 private:
  ObjectId first_, second_;
  const SceneObject* a_;
  const SceneObject* b_;
  RigidTransform place_;
  double slack_ = 0;
  /// For an object and itself: for each vertex, the smallest vertex with the same position.
  std::vector<std::uint32_t> clusters_;
};

/// Treatment of primitives of one object that share a vertex.
enum class Neighbours : std::uint8_t {
  left_out,
  folded  ///< returned if they have more points in common than their shared vertices and edges
};

/// Returns the closest pair of primitives within a distance.
/// @throws InvalidOption if the context has no threads.
/// @throws Cancelled
/// @throws InvalidMesh if more than most_candidates pairs lie on each other.
[[nodiscard]] std::optional<PrimitivePair> closest_pair(const ObjectPair& objects, double max_distance,
                                                        const Context& context, ProximityReport& report);

/// The closest pair of each primitive: row o, item p is that of primitive p of object o. Rows of objects that are not
/// compared are empty.
using ClosestRows = std::vector<std::vector<std::optional<PrimitivePair>>>;

/// Returns the closest pair of each primitive.
/// @param objects  number of objects in the scene.
/// @param is_wanted  callable: returns true for primitives whose pairs are needed. Others may have no pair.
[[nodiscard]] ClosestRows closest_rows(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                                       FunctionRef<bool(ObjectId, std::uint32_t)> is_wanted, const Context& context,
                                       ProximityReport& report);

/// Appends the closest pairs of all primitives to `out`, sorted by object and primitive.
void closest_of_each(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                     const Context& context, ProximityPairs& out);

/// Adds the pairs of all parts of a search to `pairs`, and sorts `pairs` by objects and primitives.
/// @throws Cancelled.
void add_sorted(std::vector<std::vector<PrimitivePair>> parts, const Context& context,
                std::vector<PrimitivePair>& pairs);

/// Largest number of candidate pairs that one query examines. This number takes a minute or more; it is reached, for
/// example, in a heap of equal triangles.
inline constexpr std::size_t most_candidates = std::size_t{1} << 29;

/// Counts the candidates of all parts of a parallel loop.
class CandidateLimit {
 public:
  explicit CandidateLimit(const Context& context) : context_(&context) {}

  /// Must be called for every candidate of a part.
  /// @param count  number of candidates of that part so far.
  /// @return true if the search must stop, because the caller asked for it or because there are too many candidates.
  [[nodiscard]] bool stops(std::size_t count) {
    constexpr std::size_t between_looks = 1024;
    if (count % between_looks == 0) total_ += between_looks;
    return is_stopped_ || (count % between_looks == 0 && look());
  }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }
  /// Returns true if the search must stop, as stops(), for parts of a search without candidates.
  [[nodiscard]] bool look() {
    if (context_->cancel.stop_requested() || total_ > most_candidates) is_stopped_ = true;
    return is_stopped_;
  }
  /// @throws Cancelled; InvalidMesh if there were too many candidates.
  void check() const;

 private:
  const Context* context_;
  std::atomic<std::size_t> total_ = 0;
  std::atomic<bool> is_stopped_ = false;
};

/// Largest number of pairs in a result. This number of pairs takes 5 GB.
inline constexpr std::size_t most_close_pairs = std::size_t{1} << 26;

/// @throws OutOfMemory if `pairs` is above most_close_pairs.
void check_count(std::size_t pairs);

/// Adds all pairs of primitives that are at most a distance apart.
void near_pairs(std::span<const ObjectPair> pairs, double distance, Neighbours neighbours, const Context& context,
                ProximityPairs& out);

/// Returns true if near_pairs() with Neighbours::folded would find a pair at distance 0. Stops at the first pair.
/// @param objects  a pair of an object and itself.
[[nodiscard]] bool meets_itself(const ObjectPair& objects, const Context& context);

/// Rejects at once an object for which a query would fail after a minute.
/// @param objects  a pair of an object and itself.
/// @throws InvalidMesh if so many primitives share a vertex that they form more than most_candidates pairs.
void check_neighbours(const ObjectPair& objects);

/// @throws OutOfMemory if more than most_close_pairs pairs of equal triangles collide.
void check_equal_triangles(const ObjectPair& objects);

}  // namespace blum::detail
