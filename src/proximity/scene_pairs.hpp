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
  double limit = 0;  ///< nothing further away than this counts

  void offer(const PrimitivePair& other);
  /// Whether a partner comes after the closest one, however close it is.
  [[nodiscard]] bool rules_out(ObjectId object, std::uint32_t primitive) const {
    return limit == 0 && pair && std::pair(object, primitive) > std::pair(pair->second_object, pair->second);
  }
};

/// How far two boxes are apart, or a little less for rounding.
[[nodiscard]] double box_gap(const Box3& a, const Box3& b);

[[nodiscard]] PrimitivePair exchanged(const PrimitivePair& pair);

/// Counts and not times. @param to is added to.
void add(const ProximityReport& report, ProximityReport& to);

/// Two objects, the smaller one first, or an object and itself.
struct TwoObjects {
  ObjectId first;
  const SceneObject* a;
  ObjectId second;
  const SceneObject* b;
};

/// Two objects, and what comparing their primitives needs.
class ObjectPair {
 public:
  explicit ObjectPair(const TwoObjects& two) : ObjectPair(two.first, *two.a, two.second, *two.b) {}
  ObjectPair(ObjectId first, const SceneObject& a, ObjectId second, const SceneObject& b);

  [[nodiscard]] ObjectId first() const { return first_; }
  [[nodiscard]] ObjectId second() const { return second_; }
  [[nodiscard]] const SceneObject& a() const { return *a_; }
  [[nodiscard]] const SceneObject& b() const { return *b_; }
  [[nodiscard]] bool is_self() const { return first_ == second_; }
  /// Where the second one is, seen from the first.
  [[nodiscard]] const RigidTransform& place() const { return place_; }
  /// How close they must be in the scene to be that close seen from the first, for rounding of positions.
  [[nodiscard]] double slack() const { return slack_; }

  /// Of an object and itself: for each vertex the smallest one in the same place.
  [[nodiscard]] std::span<const std::uint32_t> clusters() const { return clusters_; }
  /// Of an object and itself: the places of a primitive's vertices, for each the smallest vertex there.
  [[nodiscard]] std::array<std::uint32_t, 3> places(std::uint32_t primitive) const;
  /// Whether two primitives of one object have a vertex in common.
  [[nodiscard]] bool are_neighbours(std::uint32_t i, std::uint32_t j) const;
  /// Whether two primitives of one object that are neighbours have more in common than what they share.
  [[nodiscard]] bool are_folded(std::uint32_t i, std::uint32_t j) const;
  /// The closest points of a primitive of the first object and one of the second, the smaller one first in an object.
  [[nodiscard]] PrimitivePair compare(std::uint32_t i, std::uint32_t j) const;

 private:
  ObjectId first_, second_;
  const SceneObject* a_;
  const SceneObject* b_;
  RigidTransform place_;
  double slack_ = 0;
  std::vector<std::uint32_t> clusters_;  ///< of an object and itself: the vertex in the place of each
};

/// What is to be done with primitives of one object that share a vertex.
enum class Neighbours : std::uint8_t {
  left_out,
  folded  ///< told where they have more in common than what they share
};

/// The closest pair within a distance. @throws InvalidOption for a context without threads, Cancelled; InvalidMesh
/// where more pairs than most_candidates lie on each other.
[[nodiscard]] std::optional<PrimitivePair> closest_pair(const ObjectPair& objects, double max_distance,
                                                        const Context& context, ProximityReport& report);

/// The closest ones of primitives, by object and primitive.
using ClosestRows = std::vector<std::vector<std::optional<PrimitivePair>>>;

/// The closest one of each primitive. @param objects  how many there are in the scene.
/// @param is_wanted  which primitives are asked about; others get none.
[[nodiscard]] ClosestRows closest_rows(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                                       FunctionRef<bool(ObjectId, std::uint32_t)> is_wanted, const Context& context,
                                       ProximityReport& report);

/// The same of all, in one row.
void closest_of_each(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                     const Context& context, ProximityPairs& out);

/// Adds the pairs of parts of a search to others, and puts all into the order of objects and primitives.
/// @throws Cancelled.
void add_sorted(std::vector<std::vector<PrimitivePair>> parts, const Context& context,
                std::vector<PrimitivePair>& pairs);

/// More candidates are not looked at by one query: a minute of them or more, as of a heap of equal triangles.
inline constexpr std::size_t most_candidates = std::size_t{1} << 29;

/// Candidates of all parts of a loop.
class CandidateLimit {
 public:
  explicit CandidateLimit(const Context& context) : context_(&context) {}

  /// To be asked for every candidate of a part. @param count  of that part so far.
  /// @return whether to stop looking: as the caller asks for it, or as there are too many.
  [[nodiscard]] bool stops(std::size_t count) {
    constexpr std::size_t between_looks = 1024;
    if (count % between_looks == 0) total_ += between_looks;
    return is_stopped_ || (count % between_looks == 0 && look());
  }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }
  /// @throws Cancelled; InvalidMesh where there were too many.
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

/// More pairs are not told: they are 5 GB.
inline constexpr std::size_t most_close_pairs = std::size_t{1} << 26;

/// @throws OutOfMemory where there are more.
void check_count(std::size_t pairs);

/// All pairs within a distance.
void near_pairs(std::span<const ObjectPair> pairs, double distance, Neighbours neighbours, const Context& context,
                ProximityPairs& out);

/// Says at once what a query would find after a minute.
/// @param objects  an object with itself.
/// @throws InvalidMesh where so many primitives share a vertex that they are more than most_candidates pairs.
void check_neighbours(const ObjectPair& objects);

/// @throws OutOfMemory where more than most_close_pairs pairs of equal triangles collide.
void check_equal_triangles(const ObjectPair& objects);

}  // namespace blum::detail
