#include "blum/geometry/weld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "geometry/topology/weld_tolerance.hpp"

namespace blum {
namespace {

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

/// A hash table of vertices with open addressing, at most half full. A slot holds a vertex and some bits of its hash,
/// which spare most looks at vertices that differ.
class VertexTable {
 public:
  explicit VertexTable(std::span<const Vec3d> vertices) : vertices_(vertices), slots_(1024) {}

  /// The first vertex that was ever entered at the place of this one: itself, when it is new there.
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
  throw InvalidMesh(std::string(what) + " " + std::to_string(which) + " names vertex " + std::to_string(index) +
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

  /// Adds the edges of collapsed triangles that nothing else has. Only edges that begin at a vertex where one was lost
  /// are looked at, which are few.
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
    throw InvalidMesh("the mesh has " + std::to_string(vertices.size()) + " vertices; at most " +
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
    // The representative is the smallest of its cluster, so its own new index is known by now.
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
