// Blum: the boundary of a mesh's triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "field/kernels/connectivity.hpp"

namespace blum::kernels {

/// An edge that triangles do not run along as often one way as the other.
struct BoundaryEdge {
  std::uint32_t from;
  std::uint32_t to;
  double count;  ///< surplus of triangles that run from `from` to `to`; may be negative
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

/// The two ends of an edge by position, in an order that its direction does not change.
struct EdgePositions {
  Vec3d low, high;
  bool is_reversed;  ///< `from` is the higher end

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
    x += 0.0;  // -0 is 0
#if defined(__CUDA_ARCH__)
    return static_cast<std::uint64_t>(__double_as_longlong(x));
#else
    return std::bit_cast<std::uint64_t>(x);
#endif
  }
  /// The finaliser of SplitMix64 (Steele, Lea, Flood 2014).
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

/// Gives the first edge of those at the same place, in the order of their keys, the sum of their counts.
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
      if (EdgePositions(vertices, edges[edge[--before]]) == at) return;  // that one has the sum
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

/// The boundary of a mesh: by its indices once per connectivity, and each frame without the edges that lie upon each
/// other and cancel, as those of triangles that do not share their vertices do.
template <class Device>
class Boundary {
 public:
  explicit Boundary(Device& device) : device_(device) {}

  /// Waits for the device.
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
  /// Edges by index: with none, winding numbers are whole.
  [[nodiscard]] std::uint32_t count() const { return count_; }

  /// Once per frame. Cost: a sort.
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
  /// Of the last place(), in the device's memory.
  [[nodiscard]] const BoundaryEdge* kept() const { return kept_.data(); }
  [[nodiscard]] const std::uint32_t* kept_count() const { return kept_count_.data(); }
  /// Waits for the device.
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

}  // namespace blum::kernels
