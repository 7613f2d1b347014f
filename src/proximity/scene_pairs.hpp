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

/// The closest pair of one primitive so far.
struct Closest {
  std::optional<PrimitivePair> pair;
  double limit = 0;  ///< pairs further away do not count

  void offer(const PrimitivePair& other);
  /// Returns true if a partner comes after the closest one, however close it is.
  [[nodiscard]] bool rules_out(ObjectId object, std::uint32_t primitive) const {
    return limit == 0 && pair && std::pair(object, primitive) > std::pair(pair->second_object, pair->second);
  }
};

/// Returns the distance of two boxes, or a little less because of rounding.
[[nodiscard]] double box_gap(const Box3& a, const Box3& b);

[[nodiscard]] PrimitivePair exchanged(const PrimitivePair& pair);

/// Adds counts, but not times.
/// @param to  receives the sums.
void add(const ProximityReport& report, ProximityReport& to);

/// Two objects, the smaller one first, or an object and itself.
struct TwoObjects {
  ObjectId first;
  const SceneObject* a;
  ObjectId second;
  const SceneObject* b;
};

/// Two objects, and all that comparing their primitives needs.
class ObjectPair {
 public:
  explicit ObjectPair(const TwoObjects& two) : ObjectPair(two.first, *two.a, two.second, *two.b) {}
  ObjectPair(ObjectId first, const SceneObject& a, ObjectId second, const SceneObject& b);

  [[nodiscard]] ObjectId first() const { return first_; }
  [[nodiscard]] ObjectId second() const { return second_; }
  [[nodiscard]] const SceneObject& a() const { return *a_; }
  [[nodiscard]] const SceneObject& b() const { return *b_; }
  [[nodiscard]] bool is_self() const { return first_ == second_; }
  /// Returns the place of the second object as seen from the first.
  [[nodiscard]] const RigidTransform& place() const { return place_; }
  /// Returns the amount that searches in the first object's frame must add to distances in the scene, because positions
  /// are rounded.
  [[nodiscard]] double slack() const { return slack_; }

  /// For an object and itself: returns for each vertex the smallest one in the same place.
  [[nodiscard]] std::span<const std::uint32_t> clusters() const { return clusters_; }
  /// For an object and itself: returns for each vertex of a primitive the smallest vertex in its place.
  [[nodiscard]] std::array<std::uint32_t, 3> places(std::uint32_t primitive) const;
  /// Returns true if two primitives of one object have a vertex in common.
  [[nodiscard]] bool are_neighbours(std::uint32_t i, std::uint32_t j) const;
  /// Returns true if two neighbouring primitives of one object have more points in common than their shared vertices
  /// and edges.
  [[nodiscard]] bool are_folded(std::uint32_t i, std::uint32_t j) const;
  /// Returns the closest points of a primitive of the first object and one of the second. Within one object, the
  /// smaller primitive is first.
  [[nodiscard]] PrimitivePair compare(std::uint32_t i, std::uint32_t j) const;

 private:
  ObjectId first_, second_;
  const SceneObject* a_;
  const SceneObject* b_;
  RigidTransform place_;
  double slack_ = 0;
  std::vector<std::uint32_t> clusters_;  ///< for an object and itself: the smallest vertex in the place of each
};

/// Treatment of primitives of one object that share a vertex.
enum class Neighbours : std::uint8_t {
  left_out,
  folded  ///< listed if they have more in common than they share
};

/// Returns the closest pair within a distance.
/// @throws InvalidOption if the context has no threads.
/// @throws Cancelled
/// @throws InvalidMesh if more pairs than most_candidates lie on each other.
[[nodiscard]] std::optional<PrimitivePair> closest_pair(const ObjectPair& objects, double max_distance,
                                                        const Context& context, ProximityReport& report);

/// The closest pair of each primitive, by object and primitive.
using ClosestRows = std::vector<std::vector<std::optional<PrimitivePair>>>;

/// Returns the closest pair of each primitive.
/// @param objects  number of objects in the scene.
/// @param is_wanted  selects primitives; others get none.
[[nodiscard]] ClosestRows closest_rows(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                                       FunctionRef<bool(ObjectId, std::uint32_t)> is_wanted, const Context& context,
                                       ProximityReport& report);

/// Appends the closest pairs of all primitives, in one list.
void closest_of_each(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                     const Context& context, ProximityPairs& out);

/// Adds the pairs of parts of a search to others, and sorts all by objects and primitives.
/// @throws Cancelled.
void add_sorted(std::vector<std::vector<PrimitivePair>> parts, const Context& context,
                std::vector<PrimitivePair>& pairs);

/// Largest number of candidates that one query examines. They take a minute or more, for example in a heap of equal
/// triangles.
inline constexpr std::size_t most_candidates = std::size_t{1} << 29;

/// Counts the candidates of all parts of a loop.
class CandidateLimit {
 public:
  explicit CandidateLimit(const Context& context) : context_(&context) {}

  /// Must be called for every candidate of a part.
  /// @param count  number of candidates of that part so far.
  /// @return true if the search must stop: the caller asked for it, or candidates are too many.
  [[nodiscard]] bool stops(std::size_t count) {
    constexpr std::size_t between_looks = 1024;
    if (count % between_looks == 0) total_ += between_looks;
    return is_stopped_ || (count % between_looks == 0 && look());
  }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }
  /// @throws Cancelled; InvalidMesh if candidates were too many.
  void check() const;

 private:
  bool look() {
    if (context_->cancel.stop_requested() || total_ > most_candidates) is_stopped_ = true;
    return is_stopped_;
  }

  const Context* context_;
  std::atomic<std::size_t> total_ = 0;
  std::atomic<bool> is_stopped_ = false;
};

/// Largest number of pairs in a result: they take 5 GB.
inline constexpr std::size_t most_close_pairs = std::size_t{1} << 26;

/// @throws OutOfMemory if there are more than most_close_pairs.
void check_count(std::size_t pairs);

/// Adds all pairs within a distance.
void near_pairs(std::span<const ObjectPair> pairs, double distance, Neighbours neighbours, const Context& context,
                ProximityPairs& out);

/// Rejects at once an object on which a query would fail after a minute.
/// @param objects  an object with itself.
/// @throws InvalidMesh if so many primitives share a vertex that they form more than most_candidates pairs.
void check_neighbours(const ObjectPair& objects);

/// @throws OutOfMemory if more than most_close_pairs pairs of equal triangles collide.
void check_equal_triangles(const ObjectPair& objects);

}  // namespace blum::detail
