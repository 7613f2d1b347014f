#include "blum/proximity/continuous_collisions.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "proximity/directions.hpp"
#include "proximity/impact_filter.hpp"
#include "proximity/moving_features.hpp"

namespace blum {
namespace {

using detail::FeatureKinds;

constexpr std::size_t blocks_per_range = 32;
constexpr std::size_t most_collisions = std::size_t{1} << 26;  ///< 1.6 GB of them

void check(const MeshView& mesh, std::span<const Vec3d> end) {
  validate(mesh);
  if (end.size() != mesh.vertices.size()) {
    throw InvalidMesh("the mesh has " + std::to_string(mesh.vertices.size()) + " vertices at the start, and " +
                      std::to_string(end.size()) + " at the end; they must be as many");
  }
  MeshView last = mesh;
  last.vertices = end;
  try {
    validate(last);
  } catch (const InvalidMesh& error) {
    throw InvalidMesh(std::string("at the end: ") + error.what());
  }
}

/// What one part of the work finds.
template <class Collision>
struct Found {
  std::vector<Collision> collisions;
  std::size_t box_pairs = 0;
  std::size_t exact_tests = 0;
  bool is_stopped = false;  ///< as the caller asked for it, or as there are too many
};

class Search {
 public:
  Search(const MovingFeatures& features, const ImpactOptions& options, const Context& context)
      : features_(features), options_(options), context_(context) {}

  /// @param vertices, faces  hierarchies over their boxes.
  void vertices_and_faces(const MovingBoxBvh& vertices, const MovingBoxBvh& faces, ContinuousCollisions& out) const {
    const auto find = [&](std::size_t block, Found<VertexFaceCollision>& found) {
      vertices.for_each_pair(block, faces, [&](std::uint32_t v, std::uint32_t f) { test_vertex_face(v, f, found); });
    };
    out.vertex_face = gathered<VertexFaceCollision>(vertices.block_count(), "vertices and faces", find, out);
    std::sort(out.vertex_face.begin(), out.vertex_face.end(),
              [](const VertexFaceCollision& a, const VertexFaceCollision& b) {
                return std::pair(a.vertex, a.face.value) < std::pair(b.vertex, b.face.value);
              });
  }
  void edges_and_edges(const MovingBoxBvh& edges, ContinuousCollisions& out) const {
    const auto find = [&](std::size_t block, Found<EdgeEdgeCollision>& found) {
      edges.for_each_self_pair(
          block, [&](std::uint32_t a, std::uint32_t b) { test_edge_edge(std::min(a, b), std::max(a, b), found); });
    };
    out.edge_edge = gathered<EdgeEdgeCollision>(edges.block_count(), "edges and edges", find, out);
    std::sort(out.edge_edge.begin(), out.edge_edge.end(), [](const EdgeEdgeCollision& a, const EdgeEdgeCollision& b) {
      return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
  }

 private:
  /// What find(block, found) finds in all blocks, in no stated order.
  template <class Collision, class Find>
  std::vector<Collision> gathered(std::size_t blocks, const char* phase, const Find& find,
                                  ContinuousCollisions& out) const {
    std::vector<Found<Collision>> parts((blocks + blocks_per_range - 1) / blocks_per_range);
    parallel_for(context_, blocks, blocks_per_range, phase, [&](const WorkRange& range) {
      for (std::size_t b = range.begin; b < range.end; ++b) find(b, parts[range.begin / blocks_per_range]);
    });
    throw_if_cancelled(context_);  // parts that stopped for it have not found all
    if (collisions_ > most_collisions) {
      throw OutOfMemory("more than " + std::to_string(most_collisions) +
                        " pairs collide: parts that lie on each other, mostly; take duplicates away");
    }
    std::vector<Collision> all;
    for (const Found<Collision>& part : parts) {
      all.insert(all.end(), part.collisions.begin(), part.collisions.end());
      out.box_pairs += part.box_pairs;
      out.exact_tests += part.exact_tests;
    }
    return all;
  }

  /// Counts a pair. @return whether it is to be left out, as nothing counts any more.
  template <class Collision>
  bool stops(Found<Collision>& found) const {
    constexpr std::size_t pairs_between_looks = 256;
    if (++found.box_pairs % pairs_between_looks == 0) {
      found.is_stopped = context_.cancel.stop_requested() || collisions_ > most_collisions;
    }
    return found.is_stopped;
  }

  void test_vertex_face(std::uint32_t vertex, std::uint32_t face, Found<VertexFaceCollision>& found) const {
    const std::uint32_t v = features_.vertices()[vertex];
    const auto& [a, b, c] = features_.faces()[face];
    if (features_.place(a) == v || features_.place(b) == v || features_.place(c) == v) return;
    if (stops(found)) return;
    const FourMovingPoints points = features_.points({v, a, b, c});
    if (detail::are_apart(points, 1, options_.min_separation)) return;
    ++found.exact_tests;
    if (const auto time = detail::impact(points, FeatureKinds::vertex_face, options_)) {
      found.collisions.push_back({v, TriangleId(face), *time});
      ++collisions_;
    }
  }

  void test_edge_edge(std::uint32_t first, std::uint32_t second, Found<EdgeEdgeCollision>& found) const {
    const auto& [a, b] = features_.edges()[first];
    const auto& [c, d] = features_.edges()[second];
    if (a == c || a == d || b == c || b == d) return;
    if (stops(found)) return;
    const FourMovingPoints points = features_.points({a, b, c, d});
    if (detail::are_apart(points, 2, options_.min_separation)) return;
    ++found.exact_tests;
    if (const auto time = detail::impact(points, FeatureKinds::edge_edge, options_)) {
      found.collisions.push_back({{a, b}, {c, d}, *time});
      ++collisions_;
    }
  }

  const MovingFeatures& features_;
  const ImpactOptions& options_;
  const Context& context_;
  mutable std::atomic<std::size_t> collisions_ = 0;
};

/// A box with its sides further out, by no less than half the distance that counts as meeting.
void grow(Box3& box, double min_separation) {
  if (!(min_separation > 0)) return;
  const double by = 0.5 * min_separation;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::nextafter(box.lower[axis] - by, -infinite);
    box.upper[axis] = std::nextafter(box.upper[axis] + by, infinite);
  }
}

/// A hierarchy over the boxes of features, each by the vertices of it.
template <class Features, class Vertices>
MovingBoxBvh hierarchy(const MovingFeatures& moving, const Features& features, const Vertices& vertices_of,
                       double min_separation, const Context& context) {
  std::vector<MovingBox> boxes(features.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    boxes[k] = moving.box(vertices_of(features[k]));
    grow(boxes[k].start, min_separation);
    grow(boxes[k].end, min_separation);
  }
  return MovingBoxBvh(boxes, context);
}

}  // namespace

std::optional<double> ContinuousCollisions::earliest() const {
  std::optional<double> first;
  const auto look_at = [&](double time) {
    if (!first || time < *first) first = time;
  };
  for (const VertexFaceCollision& one : vertex_face) look_at(one.time);
  for (const EdgeEdgeCollision& one : edge_edge) look_at(one.time);
  return first;
}

ContinuousCollisions continuous_collisions(const MeshView& mesh, std::span<const Vec3d> end,
                                           const ImpactOptions& options, const Context& context) {
  check(mesh, end);
  check(options);
  ContinuousCollisions out;
  PhaseTimer timer(out.phases);
  const MovingFeatures features(mesh, end, context);
  timer.lap("features");
  const auto itself = [](const auto& feature) { return std::span<const std::uint32_t>(feature); };
  const auto alone = [](const std::uint32_t& vertex) { return std::span<const std::uint32_t>(&vertex, 1); };
  const MovingBoxBvh vertices = hierarchy(features, features.vertices(), alone, options.min_separation, context);
  const MovingBoxBvh edges = hierarchy(features, features.edges(), itself, options.min_separation, context);
  const MovingBoxBvh faces = hierarchy(features, features.faces(), itself, options.min_separation, context);
  timer.lap("boxes");
  const Search search(features, options, context);
  search.vertices_and_faces(vertices, faces, out);
  timer.lap("vertices and faces");
  search.edges_and_edges(edges, out);
  timer.lap("edges and edges");
  return out;
}

}  // namespace blum
