#include "proximity/scene_pairs.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/triangle_contact.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t blocks_per_range = 16;

/// Returns a bound on the coordinates that occur in computations with an object and its transform.
double largest_coordinate(const SceneObject& object, const RigidTransform& place) {
  // A transformed point is at most sqrt(3) times as far from the origin as the largest coordinate, plus the
  // translation.
  return 3 * object.bvh().bounds().largest_coordinate() + 2 * length(place.translation);
}

auto key(const PrimitivePair& pair) {
  return std::tuple(pair.first_object, pair.first, pair.second_object, pair.second);
}

bool is_closer(const PrimitivePair& a, const PrimitivePair& b) {
  if (a.between.distance != b.between.distance) return a.between.distance < b.between.distance;
  return key(a) < key(b);
}

constexpr std::size_t pairs_among(std::size_t count) {
  return count < 2 ? 0 : count * (count - 1) / 2;
}

/// Returns, for each vertex that represents its position, the number of primitives with a vertex there.
std::vector<std::uint32_t> primitives_at_vertices(const ObjectPair& objects) {
  const SceneObject& object = objects.a();
  std::vector<std::uint32_t> count(object.mesh().vertices.size(), 0);
  for (std::uint32_t p = 0; p < object.primitives(); ++p) {
    const std::array<std::uint32_t, 3> places = objects.places(p);
    ++count[places[0]];
    if (places[1] != places[0]) ++count[places[1]];
    if (places[2] != places[0] && places[2] != places[1]) ++count[places[2]];
  }
  return count;
}

}  // namespace

void Closest::offer(const PrimitivePair& other) {
  if (other.between.distance > limit || (pair && !is_closer(other, *pair))) return;
  pair = other;
  limit = other.between.distance;
}

double position_slack(const SceneObject& a, const SceneObject& b, const RigidTransform& place_of_b) {
  constexpr double rounding = 1e-14;
  const double error = a.place().rotation_error() + place_of_b.rotation_error();
  return (rounding + 8 * error) * (largest_coordinate(a, a.place()) + largest_coordinate(b, place_of_b));
}

double box_gap(const Box3& a, const Box3& b) {
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double gap = std::max({a.lower[axis] - b.upper[axis], b.lower[axis] - a.upper[axis], 0.0});
    squared += gap * gap;
  }
  constexpr double rounding = 1e-14;
  return std::sqrt(squared) - rounding * (a.largest_coordinate() + b.largest_coordinate());
}

PrimitivePair exchanged(const PrimitivePair& pair) {
  const TriangleDistance& d = pair.between;
  return {pair.second_object,
          pair.first_object,
          pair.second,
          pair.first,
          {d.distance, d.second_point, d.first_point, d.second_feature, d.first_feature}};
}

void add(const ProximityReport& report, ProximityReport& to) {
  to.cells += report.cells;
  to.left_over += report.left_over;
  to.candidates += report.candidates;
  to.exact_tests += report.exact_tests;
}

ObjectPair::ObjectPair(ObjectId first, const SceneObject& a, ObjectId second, const SceneObject& b)
    : first_(first), second_(second), a_(&a), b_(&b) {
  // Without transforms, the positions in the scene are those in the hierarchies.
  const bool is_placed = !(a.place() == RigidTransform{} && b.place() == RigidTransform{});
  if (is_placed) slack_ = position_slack(a, b, b.place());
  if (is_self()) clusters_ = a.clusters();
  if (!(a.place() == b.place())) place_ = a.place().inverse() * b.place();
}

std::array<std::uint32_t, 3> ObjectPair::places(std::uint32_t primitive) const {
  const auto [a, b, c] = a_->vertices(primitive);
  return {clusters_[a], clusters_[b], clusters_[c]};
}

bool ObjectPair::are_neighbours(std::uint32_t i, std::uint32_t j) const {
  const std::array<std::uint32_t, 3> other = places(j);
  for (const std::uint32_t v : places(i)) {
    for (const std::uint32_t w : other) {
      if (v == w) return true;
    }
  }
  return false;
}

bool ObjectPair::are_folded(std::uint32_t i, std::uint32_t j) const {
  if (i >= a_->triangles() || j >= a_->triangles()) return false;
  const auto triangle = [&](std::uint32_t primitive) {
    return ContactTriangle{a_->corners(primitive), places(primitive)};
  };
  const ContactTriangle first = triangle(i);
  const ContactTriangle second = triangle(j);
  if (has_no_area(first.points) || has_no_area(second.points)) return false;
  return contact(first, second) != Contact::none;
}

PrimitivePair ObjectPair::compare(std::uint32_t i, std::uint32_t j) const {
  if (is_self() && j < i) std::swap(i, j);
  return {first_, second_, i, j, triangle_distance(a_->corners(i), b_->corners(j))};
}

void CandidateLimit::check() const {
  throw_if_cancelled(*context_);
  if (!is_stopped_) return;
  throw InvalidMesh("more than " + std::to_string(most_candidates) +
                    " pairs of primitives coincide or are adjacent: remove duplicates");
}

namespace {

/// An object (the partner) with which another object is compared.
struct Partner {
  const ObjectPair* pair;
  bool is_second;  ///< true if the partner is the second object of the pair
};

/// Searches, for each primitive of a block, the closest primitive of other objects or of the same object.
class BlockSearch {
 public:
  BlockSearch(const OrientedBvh& bvh, std::size_t block, double max_distance, CandidateLimit& candidates)
      : bvh_(bvh), block_(block), primitives_(bvh.block(block)), candidates_(&candidates) {
    best_.fill({std::nullopt, max_distance});
  }

  void look_at(const Partner& partner, ProximityReport& report) {
    const ObjectPair& pair = *partner.pair;
    const SceneObject& other = partner.is_second ? pair.b() : pair.a();
    const ObjectId other_id = partner.is_second ? pair.second() : pair.first();
    const RigidTransform place = partner.is_second ? pair.place() : pair.place().inverse();
    const auto visit = [&](std::uint32_t here, std::uint32_t there, double at_least) {
      if (candidates_->stops(++report.candidates)) return OrientedBvh::Wanted(-1);
      Closest& best = best_of(here);
      const bool is_left_out = pair.is_self() && (here == there || pair.are_neighbours(here, there));
      const bool may_count = at_least <= best.limit + pair.slack() && !best.rules_out(other_id, there);
      if (!is_left_out && may_count) {
        ++report.exact_tests;
        const PrimitivePair found = partner.is_second ? pair.compare(here, there) : pair.compare(there, here);
        const bool is_turned = pair.is_self() ? there < here : !partner.is_second;
        best.offer(is_turned ? exchanged(found) : found);
      }
      return OrientedBvh::Wanted(limit() + pair.slack(), last_of(other_id));
    };
    bvh_.for_each_near_pair(block_, other.bvh(), place, limit() + pair.slack(), visit);
  }

  /// @param out  receives the closest pair of each primitive of the block, at the index of the primitive.
  void add_to(std::vector<std::optional<PrimitivePair>>& out) const {
    for (std::size_t k = 0; k < primitives_.size(); ++k) out[primitives_[k]] = best_[k].pair;
  }

 private:
  static constexpr std::size_t most = 8;

  [[nodiscard]] Closest& best_of(std::uint32_t primitive) {
    const auto at = std::find(primitives_.begin(), primitives_.end(), primitive);
    return best_[static_cast<std::size_t>(at - primitives_.begin())];
  }
  [[nodiscard]] double limit() const {
    double furthest = 0;
    for (std::size_t k = 0; k < primitives_.size(); ++k) furthest = std::max(furthest, best_[k].limit);
    return furthest;
  }

  /// Returns the largest index of a primitive of object `other` that may still be closest to a primitive of this block.
  /// If all primitives of the block have a partner at distance zero, only partners that precede it are better.
  [[nodiscard]] std::uint32_t last_of(ObjectId other) const {
    std::uint32_t last = 0;
    for (std::size_t k = 0; k < primitives_.size(); ++k) {
      const Closest& best = best_[k];
      if (best.limit > 0 || !best.pair || best.pair->second_object > other) return 0xffffffffU;
      if (best.pair->second_object == other) last = std::max(last, best.pair->second);
    }
    return last;
  }

  const OrientedBvh& bvh_;
  std::size_t block_;
  std::span<const std::uint32_t> primitives_;
  CandidateLimit* candidates_;
  std::array<Closest, most> best_;
};

}  // namespace

ClosestRows closest_rows(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                         FunctionRef<bool(ObjectId, std::uint32_t)> is_wanted, const Context& context,
                         ProximityReport& report) {
  std::vector<std::vector<Partner>> partners(objects);
  std::vector<const SceneObject*> scene(objects, nullptr);
  for (const ObjectPair& pair : pairs) {
    if (pair.is_self()) check_neighbours(pair);
    scene[pair.first().value] = &pair.a();
    scene[pair.second().value] = &pair.b();
    partners[pair.first().value].push_back({&pair, true});
    if (!pair.is_self()) partners[pair.second().value].push_back({&pair, false});
  }
  ClosestRows out(objects);
  CandidateLimit candidates(context);
  for (std::uint32_t k = 0; k < objects; ++k) {
    if (partners[k].empty()) continue;
    const OrientedBvh& bvh = scene[k]->bvh();
    out[k].resize(bvh.size());
    const std::size_t blocks = bvh.block_count();
    std::vector<ProximityReport> reports((blocks + blocks_per_range - 1) / blocks_per_range);
    parallel_for(context, blocks, blocks_per_range, "closest primitives", [&](const WorkRange& range) {
      for (std::size_t block = range.begin; block < range.end; ++block) {
        const std::span<const std::uint32_t> primitives = bvh.block(block);
        const auto wanted = [&](std::uint32_t p) { return is_wanted(ObjectId(k), p); };
        if (!std::any_of(primitives.begin(), primitives.end(), wanted)) continue;
        BlockSearch search(bvh, block, max_distance, candidates);
        for (const Partner& partner : partners[k]) search.look_at(partner, reports[range.begin / blocks_per_range]);
        search.add_to(out[k]);
      }
    });
    candidates.check();
    for (const ProximityReport& one : reports) add(one, report);
  }
  return out;
}

void closest_of_each(std::span<const ObjectPair> pairs, std::size_t objects, double max_distance,
                     const Context& context, ProximityPairs& out) {
  const auto all = [](ObjectId, std::uint32_t) { return true; };
  for (const auto& object : closest_rows(pairs, objects, max_distance, all, context, out.report)) {
    for (const auto& one : object) {
      if (one) out.pairs.push_back(*one);
    }
  }
}

namespace {

/// Returns the indices of pairs, sorted by first object, first primitive, second object and second primitive.
std::vector<KeyedIndex> sorted_order(const std::vector<const PrimitivePair*>& pairs) {
  std::vector<std::array<std::uint32_t, 4>> keys;
  keys.reserve(pairs.size());
  std::array<bool, 4> varies{};
  for (const PrimitivePair* pair : pairs) {
    keys.push_back({pair->first_object.value, pair->first, pair->second_object.value, pair->second});
    for (std::size_t k = 0; k < 4; ++k) varies[k] = varies[k] || keys.back()[k] != keys.front()[k];
  }
  std::vector<KeyedIndex> order(pairs.size());
  std::vector<KeyedIndex> scratch;
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k].index = k;
  // One stable sort for each column, the last column first. Columns in which all values are equal are skipped, because
  // most scenes have few objects.
  for (std::size_t column = 4; column-- > 0;) {
    if (!varies[column]) continue;
    for (KeyedIndex& one : order) one.key = keys[one.index][column];
    radix_sort(order, scratch);
  }
  return order;
}

}  // namespace

void add_sorted(std::vector<std::vector<PrimitivePair>> parts, const Context& context,
                std::vector<PrimitivePair>& pairs) {
  constexpr std::size_t grain = 4096;
  parts.push_back(std::move(pairs));
  std::vector<const PrimitivePair*> all;
  for (const std::vector<PrimitivePair>& part : parts) {
    for (const PrimitivePair& pair : part) all.push_back(&pair);
  }
  const std::vector<KeyedIndex> order = sorted_order(all);
  pairs = std::vector<PrimitivePair>(all.size());
  parallel_for(context, pairs.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) pairs[k] = *all[order[k].index];
  });
}

void check_count(std::size_t pairs) {
  if (pairs <= most_close_pairs) return;
  throw OutOfMemory("more than " + std::to_string(most_close_pairs) +
                    " pairs lie within the distance: use a smaller distance, or remove duplicates");
}

namespace {

/// Results of one part of the work.
struct FoundPairs {
  std::vector<PrimitivePair> pairs;
  ProximityReport report;
  bool is_stopped = false;  ///< true if the caller asked to stop, or if there are too many pairs
};

class NearSearch {
 public:
  /// @param most   the search stops when `count` exceeds this number.
  /// @param count  number of pairs of all searches so far.
  NearSearch(const ObjectPair& objects, double distance, Neighbours neighbours, std::size_t most,
             std::atomic<std::size_t>& count, CandidateLimit& candidates)
      : objects_(objects),
        distance_(distance),
        neighbours_(neighbours),
        most_(most),
        count_(count),
        candidates_(candidates) {}

  void look_at(std::size_t block, FoundPairs& found) const {
    if (found.is_stopped) return;
    const double limit = distance_ + objects_.slack();
    const auto visit = [&](std::uint32_t i, std::uint32_t j, double) {
      test(i, j, found);
      return found.is_stopped ? -1.0 : limit;
    };
    const OrientedBvh& bvh = objects_.a().bvh();
    if (objects_.is_self()) {
      bvh.for_each_near_self_pair(block, limit, visit);
    } else {
      bvh.for_each_near_pair(block, objects_.b().bvh(), objects_.place(), limit, visit);
    }
  }

 private:
  void test(std::uint32_t i, std::uint32_t j, FoundPairs& found) const {
    found.is_stopped = candidates_.stops(++found.report.candidates) || count_ > most_;
    if (found.is_stopped) return;
    if (objects_.is_self() && objects_.are_neighbours(i, j)) {
      if (neighbours_ == Neighbours::folded) test_fold(i, j, found);
      return;
    }
    ++found.report.exact_tests;
    if (distance_ == 0 && !triangles_meet(objects_.a().corners(i), objects_.b().corners(j))) return;
    const PrimitivePair pair = objects_.compare(i, j);
    if (pair.between.distance <= distance_) add_to(pair, found);
  }
  void test_fold(std::uint32_t i, std::uint32_t j, FoundPairs& found) const {
    ++found.report.exact_tests;
    if (!objects_.are_folded(i, j)) return;
    add_to(objects_.compare(i, j), found);
  }
  void add_to(const PrimitivePair& pair, FoundPairs& found) const {
    found.pairs.push_back(pair);
    ++count_;
  }

  const ObjectPair& objects_;
  double distance_;
  Neighbours neighbours_;
  std::size_t most_;
  std::atomic<std::size_t>& count_;
  CandidateLimit& candidates_;
};

bool has_flat_primitives(const SceneObject& object) {
  if (object.triangles() != object.primitives()) return true;
  for (std::uint32_t t = 0; t < object.triangles(); ++t) {
    if (has_no_area(object.corners(t))) return true;
  }
  return false;
}

/// Returns the collisions of an object with itself. All primitives must be triangles with an area. Neighbours are also
/// tested.
SelfIntersections self_intersections(const ObjectPair& objects, std::size_t limit, const Context& context) {
  const SceneObject& object = objects.a();
  const std::vector<Vec3d> positions = object.positions();
  MeshView mesh = object.mesh();
  mesh.vertices = positions;
  return find_self_intersections(mesh, object.bvh().order(), objects.clusters(), limit, context);
}

/// Adds the collisions of an object with itself. All primitives must be triangles with an area.
void add_self_intersections(const ObjectPair& objects, const Context& context, ProximityPairs& out) {
  const SelfIntersections found = self_intersections(objects, most_close_pairs, context);
  if (!found.complete) check_count(most_close_pairs + 1);
  for (const TrianglePair& pair : found.pairs)
    out.pairs.push_back(objects.compare(pair.first.value, pair.second.value));
  out.report.candidates += found.pairs.size();
  out.report.exact_tests += found.pairs.size();
}

/// Searches all blocks of the first object. Returns the results of each range of blocks.
std::vector<FoundPairs> search_blocks(const ObjectPair& objects, const NearSearch& search, const Context& context) {
  const std::size_t blocks = objects.a().bvh().block_count();
  std::vector<FoundPairs> parts((blocks + blocks_per_range - 1) / blocks_per_range);
  parallel_for(context, blocks, blocks_per_range, "close pairs", [&](const WorkRange& range) {
    for (std::size_t b = range.begin; b < range.end; ++b) search.look_at(b, parts[range.begin / blocks_per_range]);
  });
  return parts;
}

}  // namespace

bool meets_itself(const ObjectPair& objects, const Context& context) {
  if (!has_flat_primitives(objects.a())) return !self_intersections(objects, 0, context).complete;
  check_neighbours(objects);
  std::atomic<std::size_t> count = 0;
  CandidateLimit candidates(context);
  const NearSearch search(objects, 0, Neighbours::folded, 0, count, candidates);
  static_cast<void>(search_blocks(objects, search, context));
  if (count == 0) candidates.check();
  return count > 0;
}

void near_pairs(std::span<const ObjectPair> pairs, double distance, Neighbours neighbours, const Context& context,
                ProximityPairs& out) {
  std::atomic<std::size_t> count = out.pairs.size();
  CandidateLimit candidates(context);
  std::vector<std::vector<PrimitivePair>> all;
  for (const ObjectPair& objects : pairs) {
    if (neighbours == Neighbours::folded && objects.is_self() && !has_flat_primitives(objects.a())) {
      check_equal_triangles(objects);
      add_self_intersections(objects, context, out);
      continue;
    }
    if (objects.is_self()) check_neighbours(objects);
    const NearSearch search(objects, distance, neighbours, most_close_pairs, count, candidates);
    std::vector<FoundPairs> parts = search_blocks(objects, search, context);
    candidates.check();  // parts that stopped are incomplete
    check_count(count);
    for (FoundPairs& part : parts) {
      all.push_back(std::move(part.pairs));
      add(part.report, out.report);
    }
  }
  add_sorted(std::move(all), context, out.pairs);
}

void check_neighbours(const ObjectPair& objects) {
  const std::vector<std::uint32_t> count = primitives_at_vertices(objects);
  const auto most = std::max_element(count.begin(), count.end());
  if (most == count.end() || pairs_among(*most) <= most_candidates) return;
  throw InvalidMesh(name_of(objects.first(), objects.a()) + ": " + std::to_string(*most) + " primitives share vertex " +
                    std::to_string(most - count.begin()) + ", which makes more than " +
                    std::to_string(most_candidates) + " pairs: remove duplicates");
}

void check_equal_triangles(const ObjectPair& objects) {
  const std::vector<std::uint32_t> count = primitives_at_vertices(objects);
  // If many triangles are equal, there are many primitives at all three of their corners.
  std::vector<std::array<std::uint32_t, 3>> crowded;
  for (std::uint32_t t = 0; t < objects.a().triangles(); ++t) {
    std::array<std::uint32_t, 3> places = objects.places(t);
    const bool is_crowded = std::all_of(places.begin(), places.end(),
                                        [&](std::uint32_t v) { return pairs_among(count[v]) > most_close_pairs; });
    if (!is_crowded) continue;
    std::sort(places.begin(), places.end());
    crowded.push_back(places);
  }
  std::sort(crowded.begin(), crowded.end());
  std::size_t pairs = 0;
  for (auto from = crowded.begin(); from != crowded.end();) {
    const auto to = std::upper_bound(from, crowded.end(), *from);
    pairs += pairs_among(static_cast<std::size_t>(to - from));
    from = to;
  }
  check_count(pairs);
}

}  // namespace blum::detail
