#include "blum/geometry/weld.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"

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
  // Unlike a sum of squares, hypot neither overflows nor underflows.
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// Cells of an irregular grid, each at most tolerance / sqrt(3) wide. All vertices of one cell belong together, because
/// they are within the tolerance.
///
/// Along each axis, the grid's slabs start at coordinates of vertices. So slabs stay accurate far from the origin,
/// where quotients of coordinate and width could not distinguish neighbours. Coordinates two slabs apart differ by more
/// than one width, and coordinates three slabs apart by more than two widths. Vertices within the tolerance are thus at
/// most two slabs apart along each axis.
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
    std::size_t begin, end;  ///< range of the cell's vertices in order_
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

  /// For each vertex, sets entry `axis` of its key to the index of its slab along that axis.
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

  /// Joins every cell with the later cells that are (dx, dy, -2 .. 2) slabs away, if they touch. Cells are sorted, and
  /// so are the first neighbours to be tested. So one sweep finds all neighbours.
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

  /// Returns true if some vertex of a is within the tolerance of some vertex of b. If both groups are large, they are
  /// halved repeatedly, so that not all pairs are compared. Reorders each group.
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
  std::vector<std::uint32_t> order_;  ///< distinct vertices; after make_cells() they are sorted by cell
  std::vector<Cell> cells_;
};

/// Joins clusters that contain vertices at a distance of at most `tolerance`.
/// @param cluster  on input, for each vertex, the smallest vertex at exactly its position. On output, the smallest
/// vertex of its cluster.
void join_close_vertices(std::span<const Vec3d> vertices, double tolerance, std::span<std::uint32_t> cluster) {
  CloseVertices(vertices, tolerance, cluster).run();
  // One pass is enough: the root of a set is its smallest member, and parents are smaller than their children.
  for (std::uint32_t& representative : cluster) representative = cluster[representative];
}

constexpr std::uint32_t none = 0xffffffffU;

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value + 0.0);  // + 0.0 turns -0.0 into 0.0
}

std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ h >> 32) * 0x9e3779b97f4a7c15U;
  return h ^ h >> 29;
}

std::uint64_t hash(const Vec3d& v) {
  return mixed(mixed(mixed(bits(v.x)) + bits(v.y)) + bits(v.z)) * 0xbf58476d1ce4e5b9U;
}

bool same_place(const Vec3d& a, const Vec3d& b) {
  return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

/// Hash table of vertices with open addressing, at most half full. A slot contains a vertex and some bits of its hash.
/// The bits make most comparisons of different vertices unnecessary.
class VertexTable {
 public:
  explicit VertexTable(std::span<const Vec3d> vertices) : vertices_(vertices), slots_(1024) {}

  /// Returns the first vertex that was entered at this vertex's position. If the position is new, returns the vertex
  /// itself.
  std::uint32_t enter(std::uint32_t vertex) {
    if (2 * used_ >= slots_.size()) grow();
    const std::uint64_t h = hash(vertices_[vertex]);
    const auto tag = static_cast<std::uint32_t>(h);
    for (std::size_t i = home(h);; i = (i + 1) & (slots_.size() - 1)) {
      Slot& slot = slots_[i];
      if (slot.vertex == none) {
        slot = {vertex, tag};
        ++used_;
        return vertex;
      }
      if (slot.tag == tag && same_place(vertices_[slot.vertex], vertices_[vertex])) return slot.vertex;
    }
  }

 private:
  struct Slot {
    std::uint32_t vertex = none;
    std::uint32_t tag = 0;
  };

  [[nodiscard]] std::size_t home(std::uint64_t h) const {
    return static_cast<std::size_t>(h >> (64 - std::countr_zero(slots_.size())));
  }

  void grow() {
    std::vector<Slot> old(4 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.vertex == none) continue;
      std::size_t i = home(hash(vertices_[slot.vertex]));
      while (slots_[i].vertex != none) i = (i + 1) & (slots_.size() - 1);
      slots_[i] = slot;
    }
  }

  std::span<const Vec3d> vertices_;
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

void check_index(std::uint32_t index, std::size_t count, const char* what, std::size_t which) {
  if (index < count) return;
  throw InvalidMesh(std::string(what) + " " + std::to_string(which) + " uses vertex " + std::to_string(index) +
                    ", but the mesh has " + std::to_string(count) + " vertices");
}

Segment ordered(std::uint32_t a, std::uint32_t b) {
  return a < b ? Segment{a, b} : Segment{b, a};
}

/// Builds the welded mesh from the new index of every vertex.
class Welder {
 public:
  Welder(const MeshView& mesh, std::vector<std::uint32_t> new_index, TriangleMesh&& result)
      : mesh_(mesh), new_index_(std::move(new_index)), result_(std::move(result)) {}

  TriangleMesh run() {
    add_triangles();
    add_segments();
    if (!lost_edges_.empty()) keep_lost_edges();
    add_points();
    return std::move(result_);
  }

 private:
  std::uint32_t moved(std::uint32_t index, const char* what, std::size_t which) const {
    check_index(index, new_index_.size(), what, which);
    return new_index_[index];
  }

  void add_triangles() {
    result_.triangles.reserve(mesh_.triangles.size());
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      Triangle t = mesh_.triangles[i];
      for (std::uint32_t& index : t) index = moved(index, "triangle", i);
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
        result_.triangles.push_back(t);
      } else if (t[0] == t[1] && t[1] == t[2]) {
        lost_points_.push_back(t[0]);
      } else {
        lost_edges_.push_back(ordered(t[0], t[0] == t[1] ? t[2] : t[1]));
      }
    }
  }

  void add_segments() {
    result_.segments.reserve(mesh_.segments.size());
    for (std::size_t i = 0; i < mesh_.segments.size(); ++i) {
      const Segment s = {moved(mesh_.segments[i][0], "segment", i), moved(mesh_.segments[i][1], "segment", i)};
      if (s[0] != s[1]) {
        result_.segments.push_back(s);
      } else {
        lost_points_.push_back(s[0]);
      }
    }
  }

  /// Adds those edges of collapsed triangles that nothing else in the mesh has. Only edges that start at the first
  /// vertex of such an edge are compared; they are few.
  void keep_lost_edges() {
    std::vector<bool> begins(result_.vertices.size(), false);
    for (const Segment& edge : lost_edges_) begins[edge[0]] = true;
    std::vector<Segment> present;
    const auto look_at = [&](std::uint32_t a, std::uint32_t b) {
      const Segment edge = ordered(a, b);
      if (begins[edge[0]]) present.push_back(edge);
    };
    for (const Triangle& t : result_.triangles) {
      look_at(t[0], t[1]);
      look_at(t[1], t[2]);
      look_at(t[2], t[0]);
    }
    for (const Segment& s : result_.segments) look_at(s[0], s[1]);
    std::sort(present.begin(), present.end());
    std::sort(lost_edges_.begin(), lost_edges_.end());
    lost_edges_.erase(std::unique(lost_edges_.begin(), lost_edges_.end()), lost_edges_.end());
    std::set_difference(lost_edges_.begin(), lost_edges_.end(), present.begin(), present.end(),
                        std::back_inserter(result_.segments));
  }

  void add_points() {
    if (mesh_.points.empty() && lost_points_.empty()) return;
    std::vector<bool> named(result_.vertices.size(), false);
    result_.points.reserve(mesh_.points.size());
    const auto add = [&](std::uint32_t vertex) {
      if (!named[vertex]) result_.points.push_back(vertex);
      named[vertex] = true;
    };
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) add(moved(mesh_.points[i], "point", i));
    for (const Triangle& t : result_.triangles) {
      for (const std::uint32_t vertex : t) named[vertex] = true;
    }
    for (const Segment& s : result_.segments) named[s[0]] = named[s[1]] = true;
    for (const std::uint32_t vertex : lost_points_) add(vertex);
  }

  const MeshView& mesh_;
  std::vector<std::uint32_t> new_index_;
  TriangleMesh result_;
  std::vector<Segment> lost_edges_;
  std::vector<std::uint32_t> lost_points_;
};

}  // namespace

std::vector<std::uint32_t> weld_clusters(std::span<const Vec3d> vertices, double tolerance) {
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
    throw InvalidOption("the weld tolerance is " + std::to_string(tolerance) + ", but must be finite and not negative");
  }
  if (vertices.size() > max_id_count) {
    throw InvalidMesh("the mesh has " + std::to_string(vertices.size()) + " vertices, but at most " +
                      std::to_string(max_id_count) + " are possible");
  }
  std::vector<std::uint32_t> cluster(vertices.size());
  VertexTable table(vertices);
  for (std::uint32_t i = 0; i < cluster.size(); ++i) cluster[i] = table.enter(i);
  constexpr double smallest_tolerance = 1e-300;
  if (tolerance >= smallest_tolerance) join_close_vertices(vertices, tolerance, cluster);
  return cluster;
}

TriangleMesh weld(const MeshView& mesh, double tolerance) {
  const std::vector<std::uint32_t> cluster = weld_clusters(mesh.vertices, tolerance);
  TriangleMesh result;
  std::vector<std::uint32_t> new_index(cluster.size());
  for (std::uint32_t i = 0; i < cluster.size(); ++i) {
    // The representative is the smallest vertex of its cluster, so its new index has already been set.
    if (cluster[i] == i) {
      new_index[i] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(mesh.vertices[i]);
    } else {
      new_index[i] = new_index[cluster[i]];
    }
  }
  return Welder(mesh, std::move(new_index), std::move(result)).run();
}

}  // namespace blum
