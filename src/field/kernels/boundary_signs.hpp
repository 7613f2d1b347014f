// Blum: signs of a slab of nodes around a surface with a boundary. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "field/kernels/connectivity.hpp"
#include "field/kernels/row_crossings.hpp"
#include "field/kernels/tile_grid.hpp"

namespace blum::kernels {

/// Boundary edge: an edge that triangles do not traverse equally often in both directions.
struct BoundaryEdge {
  std::uint32_t from;
  std::uint32_t to;
  double count;  ///< number of traversals by triangles from `from` to `to`, minus the number of traversals from `to` to
                 ///< `from`
};

struct FlagBoundary {
  const std::int32_t* balance;
  std::uint32_t* is_boundary;
  BLUM_HD void operator()(std::size_t e) const { is_boundary[e] = balance[e] != 0 ? 1 : 0; }
};

struct ListBoundary {
  const Segment* edges;
  const std::int32_t* balance;
  const std::uint32_t* place;
  BoundaryEdge* out;
  BLUM_HD void operator()(std::size_t e) const {
    if (balance[e] != 0) out[place[e]] = {edges[e][0], edges[e][1], static_cast<double>(balance[e])};
  }
};

/// Positions of the two ends of an edge, in an order that does not depend on its direction.
struct EdgePositions {
  Vec3d low, high;
  bool is_reversed;  ///< true if `from` is the higher end

  BLUM_HD EdgePositions(const Vec3d* vertices, const BoundaryEdge& edge)
      : low(vertices[edge.from]), high(vertices[edge.to]), is_reversed(is_before(high, low)) {
    if (!is_reversed) return;
    const Vec3d other = low;
    low = high;
    high = other;
  }
  [[nodiscard]] BLUM_HD bool operator==(const EdgePositions& other) const {
    return low == other.low && high == other.high;
  }
  [[nodiscard]] BLUM_HD std::uint64_t hash() const {
    std::uint64_t value = 0;
    for (const Vec3d& p : {low, high}) {
      for (const double x : {p.x, p.y, p.z}) value = mixed(value ^ bits(x));
    }
    return value;
  }

 private:
  [[nodiscard]] BLUM_HD static bool is_before(const Vec3d& a, const Vec3d& b) {
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
  }
  [[nodiscard]] BLUM_HD static std::uint64_t bits(double x) {
    x += 0.0;  // turns -0 into 0
#if defined(__CUDA_ARCH__)
    return static_cast<std::uint64_t>(__double_as_longlong(x));
#else
    return std::bit_cast<std::uint64_t>(x);
#endif
  }
  /// Finaliser of SplitMix64 (Steele, Lea, Flood 2014).
  [[nodiscard]] BLUM_HD static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
  }
};

struct HashEdges {
  const BoundaryEdge* edges;
  const Vec3d* vertices;
  std::uint64_t* key;
  std::uint32_t* edge;
  BLUM_HD void operator()(std::size_t k) const {
    key[k] = EdgePositions(vertices, edges[k]).hash();
    edge[k] = static_cast<std::uint32_t>(k);
  }
};

/// Adds the counts of all edges with the same end positions to the first of them, in the order of their keys. Edges in
/// the opposite direction count negatively.
struct SumCoincident {
  const BoundaryEdge* edges;
  const Vec3d* vertices;
  const std::uint64_t* key;
  const std::uint32_t* edge;
  std::uint32_t count;
  BoundaryEdge* sum;
  std::uint32_t* is_kept;

  BLUM_HD void operator()(std::size_t k) const {
    is_kept[k] = 0;
    BoundaryEdge own = edges[edge[k]];
    const EdgePositions at(vertices, own);
    if (at.low == at.high) return;
    for (std::size_t before = k; before > 0 && key[before - 1] == key[k];) {
      if (EdgePositions(vertices, edges[edge[--before]]) == at) return;  // that edge has the sum
    }
    for (std::size_t next = k + 1; next < count && key[next] == key[k]; ++next) {
      const BoundaryEdge& other = edges[edge[next]];
      const EdgePositions there(vertices, other);
      if (there == at) own.count += there.is_reversed == at.is_reversed ? other.count : -other.count;
    }
    sum[k] = own;
    is_kept[k] = own.count != 0 ? 1 : 0;
  }
};

struct KeepEdges {
  const BoundaryEdge* sum;
  const std::uint32_t* is_kept;
  const std::uint32_t* place;
  std::uint32_t count;
  BoundaryEdge* out;
  std::uint32_t* kept;
  BLUM_HD void operator()(std::size_t k) const {
    if (is_kept[k] != 0) out[place[k]] = sum[k];
    if (k + 1 == count) *kept = place[k] + is_kept[k];
  }
};

/// Boundary of a mesh. Boundary edges by vertex index are found once per connectivity. In each frame, edges at the same
/// position whose counts cancel are removed. Such edges lie between triangles that do not share their vertices.
template <class Device>
class Boundary {
 public:
  explicit Boundary(Device& device) : device_(device) {}

  /// Finds the boundary edges by vertex index. Waits for the device.
  void set_connectivity(const ConnectivityView& connectivity) {
    flags_.resize(connectivity.edge_count);
    device_.for_each(connectivity.edge_count, FlagBoundary{connectivity.balance, flags_.data()});
    device_.exclusive_sum(flags_, sums_);
    count_ = total_of(device_, flags_, sums_);
    edges_.resize(count_);
    kept_.resize(count_);
    device_.for_each(connectivity.edge_count,
                     ListBoundary{connectivity.edges, connectivity.balance, sums_.data(), edges_.data()});
  }
  /// Returns the number of boundary edges by vertex index. If it is 0, winding numbers are whole.
  [[nodiscard]] std::uint32_t count() const { return count_; }

  /// Removes the edges that cancel at these positions, once per frame. Cost: a sort.
  void place(const Vec3d* vertices) {
    key_.resize(count_);
    edge_.resize(count_);
    sum_.resize(count_);
    flags_.resize(count_);
    kept_count_.resize(1);
    device_.for_each(count_, HashEdges{edges_.data(), vertices, key_.data(), edge_.data()});
    device_.sort_pairs(key_, edge_, 64);
    device_.for_each(
        count_, SumCoincident{edges_.data(), vertices, key_.data(), edge_.data(), count_, sum_.data(), flags_.data()});
    device_.exclusive_sum(flags_, sums_);
    device_.for_each(count_,
                     KeepEdges{sum_.data(), flags_.data(), sums_.data(), count_, kept_.data(), kept_count_.data()});
  }
  /// Returns the edges that the last place() kept, in the device's memory.
  [[nodiscard]] const BoundaryEdge* kept() const { return kept_.data(); }
  [[nodiscard]] const std::uint32_t* kept_count() const { return kept_count_.data(); }
  /// Returns the number of kept edges. Waits for the device.
  [[nodiscard]] std::uint32_t download_kept_count() {
    std::uint32_t count = 0;
    device_.download(kept_count_.data(), 1, &count);
    return count;
  }

 private:
  template <class T>
  using Array = typename Device::template Array<T>;

  Device& device_;
  std::uint32_t count_ = 0;
  Array<std::uint32_t> flags_, sums_, edge_, kept_count_;
  Array<std::uint64_t> key_;
  Array<BoundaryEdge> edges_, sum_, kept_;
};

inline constexpr double pi = 3.141592653589793;

/// Projected direction u to a vertex, as the quotient (y, z) / weight, so that it may be infinite.
struct ProjectedDirection {
  double weight = 1;
  double y = 0;
  double z = 0;

  /// @param v  vector from the query to the vertex.
  BLUM_HD explicit ProjectedDirection(const Vec3d& v) {
    const double across = hypot(v.y, v.z);  // hypot, because the squares may underflow
    const double distance = norm(v);
    if (v.x > 0) {
      weight = distance + v.x;
      y = v.y;
      z = v.z;
      return;
    }
    const double scale = distance - v.x;
    if (across > 0) {
      weight = across;
      y = v.y / across * scale;
      z = v.z / across * scale;
    } else if (scale > 0) {
      // The vertex lies on the ray itself. The vertex is treated as if the ray were shifted towards larger y and, by
      // less, larger z, as for crossings.
      weight = 0;
      y = -scale;
    }
  }
};

/// Terms of the boundary edges in the winding number of a node, and bounds on their gradients. The winding number is
/// the sum of the crossings of the node's ray to -x and these terms. A term jumps at its strip: the edge swept along
/// +x.
class BoundaryTerms {
 public:
  BoundaryTerms() = default;
  /// @param edges, count  in the device's memory.
  /// @param places        positions of the vertices, in node units.
  BoundaryTerms(const BoundaryEdge* edges, const std::uint32_t* count, const Vec3d* places, const Vec3d& spacing,
                bool is_mirrored)
      : edges_(edges), count_(count), places_(places), spacing_(spacing), is_mirrored_(is_mirrored) {}

  [[nodiscard]] BLUM_HD std::uint32_t count() const { return *count_; }

  /// Returns an edge's term at a node.
  /// @param node  in node units: integers.
  [[nodiscard]] BLUM_HD double term(std::uint32_t index, const Vec3d& node) const {
    const BoundaryEdge edge = edges_[index];
    const double winding = edge.count * angle(places_[edge.from], places_[edge.to], node) * (0.5 / pi);
    return is_mirrored_ ? -winding : winding;
  }

  /// Returns a bound on the gradient of an edge's term at all points within a distance of a node, apart from jumps at
  /// strips. The bound is infinite if the edge may be within this distance. The winding number's gradient is the
  /// Biot-Savart field of the boundary.
  /// @param reach  the distance, mesh units.
  [[nodiscard]] BLUM_HD double gradient_bound(std::uint32_t index, const Vec3d& node, double reach) const {
    const BoundaryEdge edge = edges_[index];
    const Vec3d a = scaled(places_[edge.from] - node);
    const Vec3d along = scaled(places_[edge.to] - node) - a;
    const double squared = squared_length(along);
    const double t = squared > 0 ? clamped(-dot(a, along) / squared, 0.0, 1.0) : 0.0;
    // The factors cover rounding of places and of this sum, which is far below 0.01 % of the distance and of the edge.
    const double gap = 0.9999 * norm(a + along * t) - 1e-9 * root(squared) - reach;
    if (!(gap > 0)) return HUGE_VAL;
    return magnitude(edge.count) * root(squared) / (4 * pi * gap * gap);
  }

 private:
  [[nodiscard]] BLUM_HD Vec3d scaled(const Vec3d& v) const {
    return {v.x * spacing_.x, v.y * spacing_.y, v.z * spacing_.z};
  }

  /// Returns the angle by which the edge turns to the left around the ray of a node. The ray is viewed from +x, with y
  /// to the right and z up.
  ///
  /// Edges that share a vertex use the same rounded direction to it. So the sum of their angles is correct up to whole
  /// turns, even if the ray passes very close to the vertex. The whole turn is chosen by the comparison that decides
  /// which rows cross a triangle with this edge. The sign of a rounded angle would not be reliable.
  [[nodiscard]] BLUM_HD double angle(const Vec3d& from, const Vec3d& to, const Vec3d& node) const {
    const Vec3d a = from - node;
    const Vec3d b = to - node;
    const ProjectedDirection u(scaled(a));
    const ProjectedDirection v(scaled(b));
    const double real = u.weight * v.weight + u.y * v.y + u.z * v.z;
    const double turned = u.y * v.z - u.z * v.y;
    const double angle = atan2(turned, real);
    const bool is_a_above = a.z > 0;
    const bool is_b_above = b.z > 0;
    if (is_a_above == is_b_above) {
      if (turned != 0) return angle;
      return (b.y > a.y) != is_a_above ? magnitude(angle) : -magnitude(angle);
    }
    const SlicePoint cut = is_b_above ? edge_point(from, to, node.z) : edge_point(to, from, node.z);
    if (!(cut.x < node.x)) return angle;  // the node is not behind the edge, so there is no jump
    const bool is_left = (cut.y <= node.y) != is_b_above;
    // The angle may underflow, so its sign is taken from `turned`.
    const bool is_contradicted = turned != 0 ? is_left != (turned > 0) : real < 0 && is_left != (angle > 0);
    if (!is_contradicted) return angle;
    return angle + (is_left ? 2 * pi : -2 * pi);
  }

  const BoundaryEdge* edges_ = nullptr;
  const std::uint32_t* count_ = nullptr;
  const Vec3d* places_ = nullptr;
  Vec3d spacing_;
  bool is_mirrored_ = false;
};

/// Negates the distances of nodes whose winding number is above level + 1/2. One thread block processes a tile of 8^3
/// nodes.
///
/// In a tile without triangles, winding numbers differ by at most the bound on their gradient times the distance. In
/// most of these tiles, one node is evaluated. In other tiles, one node per row is evaluated. Along the row the winding
/// number changes by the counted crossings, and otherwise by at most this bound. If that does not decide a node, the
/// node is evaluated separately.
///
/// Cost: (number of tiles, plus rows of tiles with triangles) times the number of boundary edges. If the boundary is
/// everywhere, as in soups: nodes times boundary edges.
struct SignTiles {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 2;
  static constexpr std::uint32_t warps = threads / warp_size;
  static constexpr std::int32_t side = 8;
  /// Bound on the rounding error of a winding number, far above the real error.
  static constexpr double slack = 1e-9;

  struct Sum {
    double winding = 0;
    double gradient = 0;
  };
  struct Shared {
    Sum partial[warps];
    bool is_settled;
    bool is_inside;
  };

  BoundaryTerms terms;
  const NormalFrame* frame;
  TileGrid tiles;
  Vec3d spacing;
  const std::int32_t* crossings;  ///< per node of the slab: signed crossings of its ray to -x
  std::int32_t level;
  float* distance;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared& shared, std::size_t index) const {
    using Warp = typename Block::Warp;
    if (frame->fault != NormalFrame::Fault::none) return;  // a faulty frame has no distances
    const NodeBox nodes = tiles.box(static_cast<std::uint32_t>(index));
    const GridIndex middle{{nodes.first[0] + nodes.count[0] / 2, nodes.first[1] + nodes.count[1] / 2,
                            nodes.first[2] + nodes.count[2] / 2}};
    const double reach = norm(
        Vec3d{spacing.x * (nodes.count[0] / 2), spacing.y * (nodes.count[1] / 2), spacing.z * (nodes.count[2] / 2)});
    // The slack covers the errors of distances: 1e-6 of the diagonal, which is at most 1 in normalised units.
    const bool may_be_crossed = !(static_cast<double>(distance[offset(middle)]) > reach + 4e-6 / frame->scale);
    block.each_warp([&](const Warp& warp) {
      Sum sum;
      if (!may_be_crossed) sum = sum_over_edges(warp, middle, reach, warp.index() * warp_size, threads);
      warp.each([&](std::uint32_t lane) {
        if (lane == 0) shared.partial[warp.index()] = sum;
      });
    });
    block.once([&] {
      Sum sum;
      for (const Sum& part : shared.partial) sum = {sum.winding + part.winding, sum.gradient + part.gradient};
      const double above = winding_above(middle, sum.winding);
      shared.is_settled = !may_be_crossed && magnitude(above) > sum.gradient * reach + slack;
      shared.is_inside = above > 0;
    });
    const bool is_settled = block.read(shared.is_settled);
    const bool is_inside = block.read(shared.is_inside);
    if (is_settled && !is_inside) return;
    block.each_warp([&](const Warp& warp) {
      const auto rows = static_cast<std::uint32_t>(nodes.count[1] * nodes.count[2]);
      for (std::uint32_t row = warp.index(); row < rows; row += warps) {
        const GridIndex first{{nodes.first[0], nodes.first[1] + static_cast<std::int32_t>(row) % nodes.count[1],
                               nodes.first[2] + static_cast<std::int32_t>(row) / nodes.count[1]}};
        if (is_settled) {
          negate(warp, first, nodes.count[0]);
        } else {
          settle_row(warp, first, nodes.count[0]);
        }
      }
    });
  }

 private:
  [[nodiscard]] BLUM_HD std::size_t offset(const GridIndex& p) const {
    const auto line = static_cast<std::size_t>(p.at[2] - tiles.first_slice) * static_cast<std::size_t>(tiles.size[1]) +
                      static_cast<std::size_t>(p.at[1]);
    return line * static_cast<std::size_t>(tiles.size[0]) + static_cast<std::size_t>(p.at[0]);
  }
  [[nodiscard]] BLUM_HD static GridIndex moved(GridIndex p, std::int32_t along_x) {
    p.at[0] += along_x;
    return p;
  }
  [[nodiscard]] BLUM_HD double winding_above(const GridIndex& p, double of_boundary) const {
    return static_cast<double>(crossings[offset(p)] - level) - 0.5 + of_boundary;
  }

  /// Sums the terms of the edges with indices first, first + step, and so on. The edges are divided among the lanes.
  template <class Warp>
  [[nodiscard]] BLUM_HD Sum sum_over_edges(const Warp& warp, const GridIndex& place, double reach, std::uint32_t first,
                                           std::uint32_t step) const {
    const Vec3d node{static_cast<double>(place.at[0]), static_cast<double>(place.at[1]),
                     static_cast<double>(place.at[2])};
    typename Warp::template Lanes<double> winding;
    typename Warp::template Lanes<double> gradient;
    warp.each([&](std::uint32_t lane) {
      winding[lane] = 0;
      gradient[lane] = 0;
      for (std::uint32_t e = first + lane; e < terms.count(); e += step) {
        winding[lane] += terms.term(e, node);
        if (reach > 0) gradient[lane] += terms.gradient_bound(e, node, reach);
      }
    });
    warp.add_up(winding);
    warp.add_up(gradient);
    return {warp.broadcast(winding, warp_size - 1), warp.broadcast(gradient, warp_size - 1)};
  }

  template <class Warp>
  BLUM_HD void negate(const Warp& warp, const GridIndex& first, std::int32_t count) const {
    warp.each([&](std::uint32_t lane) {
      if (static_cast<std::int32_t>(lane) < count) negate(moved(first, static_cast<std::int32_t>(lane)));
    });
  }
  BLUM_HD void negate(const GridIndex& place) const {
    float& value = distance[offset(place)];
    if (value > 0) value = -value;
  }

  template <class Warp>
  BLUM_HD void settle_row(const Warp& warp, const GridIndex& first, std::int32_t count) const {
    const GridIndex middle = moved(first, count / 2);
    const double reach = spacing.x * (count / 2);
    const Sum sum = sum_over_edges(warp, middle, reach, 0, warp_size);
    std::uint32_t open = warp.ballot([&](std::uint32_t lane) {
      const auto x = static_cast<std::int32_t>(lane);
      if (x >= count) return false;
      const double above = winding_above(moved(first, x), sum.winding);
      // In a row of one node, reach is 0 and the gradient may be infinite, so the product is not used.
      if (magnitude(above) <= (reach > 0 ? sum.gradient * reach : 0.0) + slack) return true;
      if (above > 0) negate(moved(first, x));
      return false;
    });
    for (; open != 0; open &= open - 1) {
      const GridIndex place = moved(first, static_cast<std::int32_t>(lowest_bit(open)));
      const Sum own = sum_over_edges(warp, place, 0, 0, warp_size);
      warp.each([&](std::uint32_t lane) {
        if (lane == 0 && winding_above(place, own.winding) > 0) negate(place);
      });
    }
  }
};

}  // namespace blum::kernels
