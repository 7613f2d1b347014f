// Blum: the closest point of the surface to a point, found by a warp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "field/kernels/box_forest.hpp"
#include "field/kernels/record_geometry.hpp"

namespace blum::kernels {

/// Point of the surface, and a site whose closure contains it.
struct SurfacePoint {
  Vec3f point{};
  float squared_distance = std::numeric_limits<float>::max();  ///< from the query
  std::uint32_t id = dead_record;
};

/// Entries that a warp still has to search. The nearest one is on top.
struct SearchStack {
  /// At each level, one box is searched and at most warp_size - 1 others remain.
  static constexpr std::uint32_t capacity = kind_count + (Tree::most_levels + 1) * (warp_size - 1);
  std::uint32_t code[capacity];
  float squared[capacity];
};

BLUM_HD inline float squared_distance_to_box(const Vec3f& q, const ReachBox& box) {
  const Vec3f gap{q.x - clamped(q.x, box.lower.x, box.upper.x), q.y - clamped(q.y, box.lower.y, box.upper.y),
                  q.z - clamped(q.z, box.lower.z, box.upper.z)};
  return squared_length(gap);
}

/// Finds the closest point of a record's site, border included. Returns false if the record is dead. Returns false for
/// a face if the query does not project into it.
BLUM_HD inline bool closest_on_record(std::uint32_t kind, const Record& record, const Vec3f& query, Vec3f& point) {
  if (record.id == dead_record) return false;
  if (kind == vertex_kind) {
    point = vec_at(record, VertexColumns::position);
  } else if (kind == edge_kind) {
    point = closest_on_edge(record, query);
  } else if (value_at(record, FaceColumns::is_sliver) != 0) {
    point = to_float(closest_on_sliver(record, to_double(query)));
  } else {
    return closest_on_face(record, query, point);
  }
  return true;
}

/// Search by one warp that visits the nearest entries first. All values are equal in all lanes, except those in Lanes.
template <class Warp>
class NearestSearch {
 public:
  template <class T>
  using Lanes = typename Warp::template Lanes<T>;

  BLUM_HD NearestSearch(const Warp& warp, const Forest& forest, SearchStack& stack)
      : warp_(warp), forest_(forest), stack_(stack) {}

  /// Replaces `best` if a closer point exists. Among equally close sites the one with the smallest id wins.
  BLUM_HD void run(const Vec3f& query, SurfacePoint& best) {
    std::uint32_t top = 0;
    warp_.each([&](std::uint32_t lane) {
      if (lane >= kind_count) return;
      // Vertices are on top of the stack, because each gives a point. A face gives none if the query does not project
      // into it.
      const std::uint32_t kind = kind_count - 1 - lane;
      const std::uint32_t levels = forest_.trees[kind].levels;
      stack_.code[lane] = Entry::make(kind, levels, 0).code;
      stack_.squared[lane] = levels > 0 ? 0.0F : std::numeric_limits<float>::infinity();
    });
    top = kind_count;
    while (top > 0) {
      --top;
      const Entry entry{stack_.code[top]};
      const float squared = stack_.squared[top];
      warp_.each([](std::uint32_t) {});  // all lanes have read before any lane writes
      if (squared > best.squared_distance) continue;
      if (entry.level() == 0) {
        visit_cluster(entry, query, best);
      } else {
        open(entry, query, best, top);
      }
    }
  }

 private:
  BLUM_HD void visit_cluster(const Entry& entry, const Vec3f& query, SurfacePoint& best) {
    const Tree& tree = forest_.trees[entry.kind()];
    Lanes<SurfacePoint> found;
    warp_.each([&](std::uint32_t lane) {
      found[lane] = SurfacePoint{};
      const std::uint32_t at = entry.index() * warp_size + lane;
      if (at >= tree.record_count) return;
      const Record& record = tree.records[at];
      Vec3f point;
      if (!closest_on_record(entry.kind(), record, query, point)) return;
      found[lane] = {point, squared_length(query - point), record.id};
    });
    const std::uint64_t nearest = warp_.smallest([&](std::uint32_t lane) { return key_of(found[lane]); });
    if (nearest >= key_of(best)) return;
    const std::uint32_t winner =
        lowest_bit(warp_.ballot([&](std::uint32_t lane) { return key_of(found[lane]) == nearest; }));
    best = warp_.broadcast(found, winner);
  }

  BLUM_HD void open(const Entry& entry, const Vec3f& query, const SurfacePoint& best, std::uint32_t& top) {
    const Tree& tree = forest_.trees[entry.kind()];
    const std::uint32_t level = entry.level() - 1;
    const std::uint32_t first = entry.index() * warp_size;
    Lanes<float> squared;
    warp_.each([&](std::uint32_t lane) {
      squared[lane] = first + lane < tree.box_count[level]
                          ? squared_distance_to_box(query, tree.boxes[level][first + lane])
                          : std::numeric_limits<float>::infinity();
    });
    const std::uint32_t is_open =
        warp_.ballot([&](std::uint32_t lane) { return squared[lane] <= best.squared_distance; });
    if (is_open == 0) return;
    const auto nearest = static_cast<std::uint32_t>(warp_.smallest(
        [&](std::uint32_t lane) { return (static_cast<std::uint64_t>(bits_of(squared[lane])) << 32) | lane; }));
    const std::uint32_t others = is_open & ~(1U << nearest);
    const std::uint32_t end = top + count_bits(others);
    warp_.each([&](std::uint32_t lane) {
      if (((is_open >> lane) & 1U) == 0) return;
      const std::uint32_t at = lane == nearest ? end : top + bits_below(others, lane);
      stack_.code[at] = Entry::make(entry.kind(), level, first + lane).code;
      stack_.squared[at] = squared[lane];
    });
    top = end + 1;
  }

  BLUM_HD static std::uint64_t key_of(const SurfacePoint& p) {
    return (static_cast<std::uint64_t>(bits_of(p.squared_distance)) << 32) | p.id;
  }

  const Warp& warp_;
  const Forest& forest_;
  SearchStack& stack_;
};

}  // namespace blum::kernels
