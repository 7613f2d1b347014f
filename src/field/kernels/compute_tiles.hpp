// Blum: the kernel that computes tiles of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "field/field_request.hpp"
#include "field/kernels/box_forest.hpp"
#include "field/kernels/domain_tests.hpp"
#include "field/kernels/nearest.hpp"
#include "field/kernels/record_geometry.hpp"
#include "field/kernels/tile_grid.hpp"

namespace blum::kernels {

/// Closest site of a node found so far.
struct Winner {
  float squared = std::numeric_limits<float>::max();
  std::uint32_t id = dead_record;

  /// Offers a site. Among equally close sites the smaller id wins, so the order of offers does not matter.
  BLUM_HD void offer(float candidate, std::uint32_t candidate_id) {
    if (candidate < squared || (candidate == squared && candidate_id < id)) {
      squared = candidate;
      id = candidate_id;
    }
  }
};

BLUM_HD inline void offer_vertex(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3f to = node - vec_at(record, VertexColumns::position);
  bool is_inside = true;
  for (int k = 0; k < 4; ++k) {
    is_inside = is_inside && dot(to, vec_at(record, VertexColumns::direction + 3 * k)) < plane_slack;
  }
  if (is_inside) winner.offer(squared_length(to), record.id);
}

BLUM_HD inline void offer_edge(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3f to = node - vec_at(record, EdgeColumns::midpoint);
  const Vec3f t = vec_at(record, EdgeColumns::tangent);
  const Vec3f b = vec_at(record, EdgeColumns::binormal);
  const float across_b = dot(to, b);
  const float across_n = dot(to, cross(t, b));
  // Beyond an end, the distance from the edge is that from the end. The term with `excess` keeps the distance exact
  // also within the slack beyond the ends.
  const float excess = magnitude(dot(to, t)) - value_at(record, EdgeColumns::half_length);
  const float second =
      value_at(record, EdgeColumns::second_b) * across_b + value_at(record, EdgeColumns::second_n) * across_n;
  if (!(excess < plane_slack && across_b < value_at(record, EdgeColumns::first_limit) && second < plane_slack)) return;
  const float beyond = larger(excess, 0.0F);
  winner.offer(across_b * across_b + (across_n * across_n + beyond * beyond), record.id);
}

BLUM_HD inline void offer_sliver(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3d query = to_double(node);
  winner.offer(static_cast<float>(squared_length(query - closest_on_sliver(record, query))), record.id);
}

BLUM_HD inline void offer_face(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3f to = node - vec_at(record, FaceColumns::anchor);
  const float minus_u = dot(to, vec_at(record, FaceColumns::minus_u));
  const float minus_v = dot(to, vec_at(record, FaceColumns::minus_v));
  if (!(minus_u < 0 && minus_v < 0 && minus_u + minus_v > -1)) return;
  const float height = dot(to, vec_at(record, FaceColumns::normal));
  winner.offer(height * height, record.id);
}

/// Offers a site to a node. The site wins if the node lies in its domain and the site is closer than the closest site
/// so far.
BLUM_HD inline void offer_site(std::uint32_t kind, const Record& record, const Vec3f& node, Winner& winner) {
  if (kind == vertex_kind) {
    offer_vertex(record, node, winner);
  } else if (kind == edge_kind) {
    offer_edge(record, node, winner);
  } else if (value_at(record, FaceColumns::is_sliver) != 0) {
    offer_sliver(record, node, winner);
  } else {
    offer_face(record, node, winner);
  }
}

/// Record in shared memory. Records are stored 80 bytes apart, so that the lanes of a warp read from different memory
/// banks.
struct alignas(16) PackedRecord {
  float column[15];
  std::uint32_t id;
  float padding[4];

  BLUM_HD void set(const Record& record) {
    for (std::size_t k = 0; k < 15; ++k) column[k] = record.column[k];
    id = record.id;
  }
  [[nodiscard]] BLUM_HD Record get() const {
    Record record;
    for (std::size_t k = 0; k < 15; ++k) record.column[k] = column[k];
    record.id = id;
    return record;
  }
};

/// Computes a field, with one thread block per tile of 8^3 nodes. The block's warps search the trees for sites that may
/// be closest to a node of the tile, and collect their records. The warps share one stack of entries. Then each warp
/// processes one leaf of 4^3 nodes. The warp drops records that cannot be closest in the leaf, and evaluates the other
/// records at two nodes per lane.
///
/// If the list of records is full, its records are evaluated before the search continues. So no list can overflow. The
/// result does not depend on the order in which sites are found.
struct ComputeTiles {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 3;  ///< registers are limited so that at least this many fit
  static constexpr std::uint32_t warps = threads / warp_size;
  static constexpr std::int32_t side = 8;
  static constexpr std::int32_t leaf_side = 4;
  static constexpr std::uint32_t list_capacity = 512;
  static constexpr std::uint32_t stack_capacity = 1024;
  /// Upper bound on the entries that the stack gains while one entry and all of its descendants are processed one by
  /// one.
  static constexpr std::uint32_t stack_reserve = (warp_size - 1) * (Tree::most_levels + 1);
  /// With fewer records, it is cheaper to evaluate all of them than to find a surface point that excludes some.
  static constexpr std::uint32_t fewest_worth_dominating = 24;
  static_assert(warps * warp_size <= list_capacity && stack_reserve + warps * warp_size <= stack_capacity);

  struct Shared {
    std::uint32_t stack[stack_capacity];
    std::uint32_t top;
    std::uint32_t taken[warps];
    std::uint32_t taken_count;
    std::uint32_t list_count;
    std::uint32_t kind_count_of[kind_count];
    std::uint16_t place[kind_count][list_capacity];  ///< per kind: indices of its records in `list`
    SurfacePoint leaf_point[warps];
    CenteredBox box;  ///< of the tile, widened
    TileTest test;
    Domination domination;
    CenteredBox leaf_boxes[warps];
    Domination leaf_domination[warps];
    union {
      PackedRecord list[list_capacity];
      SearchStack search[warps];
    };
  };

  Forest forest;
  const NormalFrame* frame;
  TileGrid tiles;
  const SurfacePoint* tile_points;
  FieldRequest request;  ///< its memory is that of the slab's nodes

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared& shared, std::size_t index) const {
    Run<Block>(*this, block, shared, static_cast<std::uint32_t>(index)).run();
  }

 private:
  /// Two nodes of a leaf that one lane computes, and their closest sites found so far.
  struct LaneNodes {
    Vec3f node[2];
    Winner winner[2];
  };

  /// State and work of one thread block.
  template <class Block>
  class Run {
    using Warp = typename Block::Warp;

   public:
    BLUM_HD Run(const ComputeTiles& job, const Block& block, Shared& shared, std::uint32_t tile)
        : job_(job),
          block_(block),
          shared_(shared),
          tile_(tile),
          nodes_(job.tiles.box(tile)),
          box_(centered(*job.frame, nodes_).widened()),
          nearest_(job.tile_points[tile]) {}

    BLUM_HD void run() {
      if (job_.frame->fault != NormalFrame::Fault::none) {
        fill(NAN);
        return;
      }
      if (is_beyond_band()) {
        fill(static_cast<float>(job_.request.band));
        return;
      }
      start();
      for (bool is_done = false; !is_done;) {
        is_done = !take();
        block_.each_warp([&](const Warp& warp) {
          if (warp.index() >= shared_.taken_count) return;
          const Entry entry{shared_.taken[warp.index()]};
          if (entry.level() == 0) {
            collect(warp, entry);
          } else {
            descend(warp, entry);
          }
        });
        if (is_done || block_.read(shared_.list_count) > list_capacity - warps * warp_size) evaluate();
      }
      write();
    }

   private:
    [[nodiscard]] BLUM_HD double scale() const { return job_.frame->scale; }

    [[nodiscard]] BLUM_HD bool is_beyond_band() const {
      if (!(job_.request.band > 0)) return false;
      const float distance = root(squared_length(box_.center - nearest_.point));
      return distance - norm(box_.half) * 1.0001F - box_slack > static_cast<float>(job_.request.band * scale());
    }

    /// Returns surface points near this tile and its neighbours. Sites that are further away than these points
    /// everywhere in the tile can be dropped.
    [[nodiscard]] BLUM_HD Dominators tile_dominators() const {
      Dominators out;
      out.point[0] = nearest_.point;
      for (int axis = 0; axis < 3; ++axis) {
        GridIndex next = job_.tiles.place(tile_);
        next.at[axis] = smaller(next.at[axis] ^ 1, job_.tiles.tiles[axis] - 1);
        out.point[axis + 1] = job_.tile_points[job_.tiles.index(next)].point;
      }
      return out;
    }

    [[nodiscard]] BLUM_HD NodeBox leaf_box(std::uint32_t leaf) const {
      NodeBox out{};
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::int32_t offset = ((leaf >> axis) & 1U) != 0 ? leaf_side : 0;
        out.first[axis] = nodes_.first[axis] + offset;
        out.count[axis] = smaller(leaf_side, nodes_.count[axis] - offset);
      }
      return out;
    }

    BLUM_HD void start() {
      block_.once([&] {
        shared_.top = 0;
        for (std::uint32_t kind = 0; kind < kind_count; ++kind) {
          const std::uint32_t levels = job_.forest.trees[kind].levels;
          if (levels > 0) shared_.stack[shared_.top++] = Entry::make(kind, levels, 0).code;
          shared_.kind_count_of[kind] = 0;
        }
        shared_.list_count = 0;
        shared_.box = box_;
        shared_.test = TileTest(box_, nearest_.point);
        shared_.domination = Domination(box_, tile_dominators());
      });
      block_.each_warp([&](const Warp& warp) {
        const NodeBox leaf = leaf_box(warp.index());
        const Vec3f center = leaf.is_empty() ? box_.center : centered(*job_.frame, leaf).center;
        warp.each([&](std::uint32_t lane) {
          LaneNodes& mine = lanes_.at(warp, lane);
          for (std::uint32_t k = 0; k < 2; ++k) {
            const GridIndex place = place_in(leaf, lane, k);
            mine.node[k] = {coordinate(0, place), coordinate(1, place), coordinate(2, place)};
            mine.winner[k] = Winner{};
          }
          if (lane == 0) {
            shared_.leaf_point[warp.index()] = {nearest_.point, squared_length(center - nearest_.point), nearest_.id};
          }
        });
      });
    }

    /// Takes entries from the stack: one for each warp if the stack has room for all entries that they may add,
    /// otherwise fewer. Returns false if the stack is empty.
    BLUM_HD bool take() {
      const std::uint32_t top = block_.read(shared_.top);
      const std::uint32_t room = stack_capacity - stack_reserve;
      const std::uint32_t fitting = top < room ? (room - top) / (warp_size - 1) : 0;
      const std::uint32_t count = smaller(top, larger(1U, smaller(warps, fitting)));
      block_.once([&] {
        for (std::uint32_t w = 0; w < count; ++w) shared_.taken[w] = shared_.stack[top - 1 - w];
        shared_.taken_count = count;
        shared_.top = top - count;
      });
      return count > 0;
    }

    /// Pushes those children of a box onto the stack that may contain a closest site of the tile's nodes.
    BLUM_HD void descend(const Warp& warp, const Entry& entry) {
      const Tree& tree = job_.forest.trees[entry.kind()];
      const std::uint32_t level = entry.level() - 1;
      const std::uint32_t first = entry.index() * warp_size;
      const std::uint32_t kept = warp.ballot([&](std::uint32_t lane) {
        return first + lane < tree.box_count[level] && shared_.test.keeps(tree.boxes[level][first + lane]);
      });
      if (kept == 0) return;
      const std::uint32_t place = warp.claim(shared_.top, count_bits(kept));
      warp.each([&](std::uint32_t lane) {
        if (((kept >> lane) & 1U) == 0) return;
        shared_.stack[place + bits_below(kept, lane)] = Entry::make(entry.kind(), level, first + lane).code;
      });
    }

    /// Lists the records of a cluster that may be closest somewhere in the tile.
    BLUM_HD void collect(const Warp& warp, const Entry& entry) {
      const std::uint32_t kind = entry.kind();
      const Tree& tree = job_.forest.trees[kind];
      typename Warp::template Lanes<Record> record;
      const std::uint32_t kept = warp.ballot([&](std::uint32_t lane) {
        const std::uint32_t at = entry.index() * warp_size + lane;
        if (at >= tree.record_count) return false;
        record[lane] = tree.records[at];
        return record[lane].id != dead_record && site_matters(kind, record[lane], shared_.box, shared_.domination);
      });
      if (kept == 0) return;
      const std::uint32_t slot = warp.claim(shared_.list_count, count_bits(kept));
      const std::uint32_t place = warp.claim(shared_.kind_count_of[kind], count_bits(kept));
      warp.each([&](std::uint32_t lane) {
        if (((kept >> lane) & 1U) == 0) return;
        const std::uint32_t rank = bits_below(kept, lane);
        shared_.list[slot + rank].set(record[lane]);
        shared_.place[kind][place + rank] = static_cast<std::uint16_t>(slot + rank);
      });
    }

    /// Evaluates the listed records and empties the list.
    BLUM_HD void evaluate() {
      if (block_.read(shared_.list_count) >= fewest_worth_dominating) {
        block_.each_warp([&](const Warp& warp) { find_leaf_point(warp); });
      }
      block_.each_warp([&](const Warp& warp) { evaluate_leaf(warp); });
      block_.once([&] {
        shared_.list_count = 0;
        for (std::uint32_t kind = 0; kind < kind_count; ++kind) shared_.kind_count_of[kind] = 0;
      });
    }

    /// Searches the listed records for a surface point closer to the leaf's centre than the one so far.
    BLUM_HD void find_leaf_point(const Warp& warp) {
      const NodeBox leaf = leaf_box(warp.index());
      if (leaf.is_empty()) return;
      const Vec3f center = centered(*job_.frame, leaf).center;
      typename Warp::template Lanes<SurfacePoint> best;
      warp.each([&](std::uint32_t lane) {
        best[lane] = SurfacePoint{};
        for (std::uint32_t kind = 0; kind < kind_count; ++kind) {
          for (std::uint32_t k = lane; k < shared_.kind_count_of[kind]; k += warp_size) {
            const Record record = shared_.list[shared_.place[kind][k]].get();
            Vec3f point;
            if (!closest_on_record(kind, record, center, point)) continue;
            const float squared = squared_length(center - point);
            if (squared < best[lane].squared_distance) best[lane] = {point, squared, record.id};
          }
        }
      });
      const std::uint64_t smallest = warp.smallest([&](std::uint32_t lane) {
        return (static_cast<std::uint64_t>(bits_of(best[lane].squared_distance)) << 32) | lane;
      });
      const auto winner = static_cast<std::uint32_t>(smallest);
      warp.each([&](std::uint32_t lane) {
        SurfacePoint& known = shared_.leaf_point[warp.index()];
        if (lane == winner && best[lane].squared_distance < known.squared_distance) known = best[lane];
      });
    }

    BLUM_HD void set_leaf_domination(const Warp& warp, const NodeBox& leaf) {
      warp.each([&](std::uint32_t lane) {
        if (lane != 0) return;
        Dominators dominators;
        dominators.point[0] = shared_.leaf_point[warp.index()].point;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          dominators.point[axis + 1] = shared_.leaf_point[warp.index() ^ (1U << axis)].point;
        }
        const CenteredBox box = centered(*job_.frame, leaf).widened();
        shared_.leaf_boxes[warp.index()] = box;
        shared_.leaf_domination[warp.index()] = Domination(box, dominators);
      });
    }

    BLUM_HD void evaluate_leaf(const Warp& warp) {
      const NodeBox leaf = leaf_box(warp.index());
      if (leaf.is_empty()) return;
      set_leaf_domination(warp, leaf);
      const CenteredBox& box = shared_.leaf_boxes[warp.index()];
      const Domination& domination = shared_.leaf_domination[warp.index()];
      for (std::uint32_t kind = 0; kind < kind_count; ++kind) {
        const std::uint32_t count = shared_.kind_count_of[kind];
        for (std::uint32_t first = 0; first < count; first += warp_size) {
          std::uint32_t kept = warp.ballot([&](std::uint32_t lane) {
            return first + lane < count &&
                   site_matters(kind, shared_.list[shared_.place[kind][first + lane]].get(), box, domination);
          });
          for (; kept != 0; kept &= kept - 1) {
            const Record record = shared_.list[shared_.place[kind][first + lowest_bit(kept)]].get();
            warp.each([&](std::uint32_t lane) {
              LaneNodes& mine = lanes_.at(warp, lane);
              for (int k = 0; k < 2; ++k) offer_site(kind, record, mine.node[k], mine.winner[k]);
            });
          }
        }
      }
    }

    /// Settles nodes that lie in no site's domain because of rounding: each gets the closest of all sites, borders
    /// included.
    BLUM_HD void settle(const Warp& warp, const NodeBox& leaf) {
      for (std::uint32_t k = 0; k < 2; ++k) {
        std::uint32_t open = warp.ballot([&](std::uint32_t lane) {
          return is_in(leaf, place_in(leaf, lane, k)) && lanes_.at(warp, lane).winner[k].id == dead_record;
        });
        for (; open != 0; open &= open - 1) {
          const std::uint32_t owner = lowest_bit(open);
          typename Warp::template Lanes<Vec3f> node;
          warp.each([&](std::uint32_t lane) { node[lane] = lanes_.at(warp, lane).node[k]; });
          const Vec3f query = warp.broadcast(node, owner);
          const SurfacePoint best = search(warp, job_.forest, query, nearest_, shared_.search[warp.index()]);
          warp.each([&](std::uint32_t lane) {
            if (lane == owner) lanes_.at(warp, lane).winner[k] = {best.squared_distance, best.id};
          });
        }
      }
    }

    /// Not inlined: the code is rarely used, and must not increase the registers of other code.
    BLUM_HD BLUM_NOINLINE static SurfacePoint search(const Warp& warp, const Forest& forest, const Vec3f& query,
                                                     SurfacePoint best, SearchStack& stack) {
      best.squared_distance = squared_length(query - best.point);
      NearestSearch<Warp>(warp, forest, stack).run(query, best);
      return best;
    }

    /// Returns the k-th node of a lane. Nodes are distributed over the lanes; the two nodes of one lane differ by two
    /// in z.
    [[nodiscard]] BLUM_HD static GridIndex place_in(const NodeBox& leaf, std::uint32_t lane, std::uint32_t k) {
      return {{leaf.first[0] + static_cast<std::int32_t>(lane % 4),
               leaf.first[1] + static_cast<std::int32_t>(lane / 4 % 4),
               leaf.first[2] + static_cast<std::int32_t>(lane / 16 + 2 * k)}};
    }
    [[nodiscard]] BLUM_HD static bool is_in(const NodeBox& box, const GridIndex& place) {
      bool is_in = true;
      for (int axis = 0; axis < 3; ++axis) is_in = is_in && place.at[axis] < box.first[axis] + box.count[axis];
      return is_in;
    }
    [[nodiscard]] BLUM_HD float coordinate(int axis, const GridIndex& place) const {
      return static_cast<float>(job_.frame->at(axis, static_cast<double>(place.at[axis])));
    }
    /// Returns the index of a node in the request's memory.
    [[nodiscard]] BLUM_HD std::size_t offset(const GridIndex& place) const {
      const auto slice = static_cast<std::size_t>(place.at[2] - job_.tiles.first_slice);
      const auto row = slice * static_cast<std::size_t>(job_.tiles.size[1]) + static_cast<std::size_t>(place.at[1]);
      return row * static_cast<std::size_t>(job_.tiles.size[0]) + static_cast<std::size_t>(place.at[0]);
    }

    BLUM_HD void write() {
      const auto to_world = static_cast<float>(1 / scale());
      const float band = job_.request.band > 0 ? static_cast<float>(job_.request.band) : far_away * far_away;
      block_.each_warp([&](const Warp& warp) {
        const NodeBox leaf = leaf_box(warp.index());
        if (leaf.is_empty()) return;
        settle(warp, leaf);
        warp.each([&](std::uint32_t lane) {
          const LaneNodes& mine = lanes_.at(warp, lane);
          for (std::uint32_t k = 0; k < 2; ++k) {
            const GridIndex place = place_in(leaf, lane, k);
            if (!is_in(leaf, place)) continue;
            const std::size_t at = offset(place);
            const float distance = root(mine.winner[k].squared) * to_world;
            const bool is_beyond = distance > band;
            job_.request.distance[at] = is_beyond ? band : distance;
            if (job_.request.site != nullptr) job_.request.site[at] = is_beyond ? dead_record : mine.winner[k].id;
          }
        });
      });
    }

    /// Gives all nodes of the tile this distance and no site.
    BLUM_HD void fill(float distance) {
      block_.each_warp([&](const Warp& warp) {
        warp.each([&](std::uint32_t lane) {
          for (std::uint32_t k = 0; k < 2; ++k) {
            const GridIndex place = place_in(leaf_box(warp.index()), lane, k);
            if (!is_in(nodes_, place)) continue;
            const std::size_t at = offset(place);
            job_.request.distance[at] = distance;
            if (job_.request.site != nullptr) job_.request.site[at] = dead_record;
          }
        });
      });
    }

    const ComputeTiles& job_;
    const Block& block_;
    Shared& shared_;
    std::uint32_t tile_;
    NodeBox nodes_;
    CenteredBox box_;  ///< widened by box_slack
    SurfacePoint nearest_;
    typename Block::template PerThread<LaneNodes> lanes_;
  };
};

}  // namespace blum::kernels
