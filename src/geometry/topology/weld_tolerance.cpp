#include "geometry/topology/weld_tolerance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace blum {
namespace {

/// Disjoint sets of vertices; the root of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::span<std::uint32_t> parent) : parent_(parent) {}

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::span<std::uint32_t> parent_;
};

double distance(const Vec3d& a, const Vec3d& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);  // neither overflows nor underflows, unlike the sum of squares
}

/// The cells of an irregular grid, each no wider than tolerance / sqrt(3): all vertices of a cell belong together.
///
/// The slabs of each axis begin at a coordinate that occurs, so they are as right far from the origin, where a
/// coordinate divided by the width would no longer tell neighbours apart. Two slabs on, a coordinate is more than one
/// width away, three slabs on more than two: vertices within tolerance are at most two slabs apart on each axis.
class CloseVertices {
 public:
  CloseVertices(std::span<const Vec3d> vertices, double tolerance, std::span<std::uint32_t> cluster)
      : vertices_(vertices), tolerance_(tolerance), sets_(cluster) {
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      if (cluster[i] == i && is_finite(vertices[i])) order_.push_back(i);
    }
  }

  void run() {
    make_cells();
    for (const Cell& cell : cells_) {
      for (std::size_t i = cell.begin + 1; i < cell.end; ++i) sets_.join(order_[cell.begin], order_[i]);
    }
    for (std::int64_t dx = 0; dx <= 2; ++dx) {
      for (std::int64_t dy = dx == 0 ? 0 : -2; dy <= 2; ++dy) join_neighbours(dx, dy);
    }
  }

 private:
  using Key = std::array<std::uint32_t, 3>;
  struct Cell {
    Key key;
    std::size_t begin, end;  ///< in order_
  };

  void make_cells() {
    constexpr double below_root_third = 0.57735;
    const double width = tolerance_ * below_root_third;
    std::vector<Key> keys(order_.size());
    std::vector<std::uint32_t> by_coordinate(order_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) number_slabs(axis, width, by_coordinate, keys);

    std::vector<std::uint32_t> by_key(order_.size());
    std::iota(by_key.begin(), by_key.end(), 0U);
    std::sort(by_key.begin(), by_key.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    std::vector<std::uint32_t> sorted(order_.size());
    for (std::size_t i = 0; i < by_key.size(); ++i) {
      sorted[i] = order_[by_key[i]];
      if (i == 0 || keys[by_key[i]] != keys[by_key[i - 1]]) cells_.push_back({keys[by_key[i]], i, i});
      cells_.back().end = i + 1;
    }
    order_.swap(sorted);
  }

  /// Entry `axis` of each key: the number of the slab of that axis.
  void number_slabs(std::size_t axis, double width, std::vector<std::uint32_t>& by_coordinate, std::vector<Key>& keys) {
    std::vector<double> coordinates(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) coordinates[i] = vertices_[order_[i]][axis];
    std::iota(by_coordinate.begin(), by_coordinate.end(), 0U);
    std::sort(by_coordinate.begin(), by_coordinate.end(),
              [&](std::uint32_t a, std::uint32_t b) { return coordinates[a] < coordinates[b]; });
    std::uint32_t slab = 0;
    double start = by_coordinate.empty() ? 0.0 : coordinates[by_coordinate.front()];
    for (const std::uint32_t i : by_coordinate) {
      if (coordinates[i] - start > width) {
        ++slab;
        start = coordinates[i];
      }
      keys[i][axis] = slab;
    }
  }

  /// Joins every cell with those (dx, dy, -2 .. 2) slabs away, later cells only. Cells are sorted, and so are the
  /// places where their neighbours begin: one sweep finds them all.
  void join_neighbours(std::int64_t dx, std::int64_t dy) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const std::array<std::int64_t, 3> lower = {cells_[i].key[0] + dx, cells_[i].key[1] + dy,
                                                 std::int64_t{cells_[i].key[2]} - 2};
      const auto before = [&](const Key& key) { return std::array<std::int64_t, 3>{key[0], key[1], key[2]} < lower; };
      while (first < cells_.size() && before(cells_[first].key)) ++first;
      for (std::size_t j = std::max(first, i + 1); j < cells_.size(); ++j) {
        const Key& key = cells_[j].key;
        if (key[0] != lower[0] || key[1] != lower[1] || key[2] > lower[2] + 4) break;
        join_cells(cells_[i], cells_[j]);
      }
    }
  }

  void join_cells(const Cell& a, const Cell& b) {
    const std::uint32_t first = order_[a.begin];
    const std::uint32_t second = order_[b.begin];
    if (sets_.root(first) == sets_.root(second)) return;
    const std::span<std::uint32_t> order(order_);
    if (touch(order.subspan(a.begin, a.end - a.begin), order.subspan(b.begin, b.end - b.begin))) {
      sets_.join(first, second);
    }
  }

  Box3 box_of(std::span<const std::uint32_t> group) const {
    Box3 box;
    for (const std::uint32_t i : group) box.extend(vertices_[i]);
    return box;
  }

  /// Whether some vertex of a is within tolerance of some vertex of b. Halves crowded groups, so that two crowds do not
  /// have all their pairs compared; reorders within the groups.
  bool touch(std::span<std::uint32_t> a, std::span<std::uint32_t> b) {
    constexpr std::size_t few_pairs = 64;
    if (a.size() * b.size() <= few_pairs) {
      for (const std::uint32_t i : a) {
        for (const std::uint32_t j : b) {
          if (distance(vertices_[i], vertices_[j]) <= tolerance_) return true;
        }
      }
      return false;
    }
    const Box3 box_a = box_of(a);
    const Box3 box_b = box_of(b);
    const Vec3d gap = max(max(box_a.lower - box_b.upper, box_b.lower - box_a.upper), Vec3d{});
    if (std::hypot(gap.x, gap.y, gap.z) > tolerance_) return false;
    if (distance(vertices_[a.front()], vertices_[b.front()]) <= tolerance_) return true;
    const bool cut_a = a.size() >= b.size();
    const std::span<std::uint32_t> group = cut_a ? a : b;
    const Vec3d size = cut_a ? box_a.size() : box_b.size();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = group.size() / 2;
    std::nth_element(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(half), group.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return vertices_[i][axis] < vertices_[j][axis]; });
    const std::span<std::uint32_t> other = cut_a ? b : a;
    return touch(group.first(half), other) || touch(group.subspan(half), other);
  }

  std::span<const Vec3d> vertices_;
  double tolerance_;
  DisjointSets sets_;
  std::vector<std::uint32_t> order_;  ///< distinct vertices; sorted by cell after make_cells()
  std::vector<Cell> cells_;
};

}  // namespace

void join_close_vertices(std::span<const Vec3d> vertices, double tolerance, std::span<std::uint32_t> cluster) {
  CloseVertices(vertices, tolerance, cluster).run();
  // Roots are the smallest of their sets, and parents are smaller than their children.
  for (std::uint32_t& representative : cluster) representative = cluster[representative];
}

}  // namespace blum
