#include "proximity/impact_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/plural.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "blum/proximity/impact.hpp"
#include "proximity/impact_filter.hpp"

namespace blum {

void check_motion(const MeshView& mesh, std::span<const Vec3d> end) {
  validate(mesh);
  if (end.size() != mesh.vertices.size()) {
    throw InvalidMesh("the mesh has " + std::to_string(mesh.vertices.size()) + " vertices at the start, but " +
                      std::to_string(end.size()) + " at the end; both must have the same number");
  }
  MeshView last = mesh;
  last.vertices = end;
  try {
    validate(last);
  } catch (const InvalidMesh& error) {
    throw InvalidMesh(std::string("at the end: ") + error.what());
  }
}

namespace {

/// Returns, for each vertex that the mesh uses, the smallest used vertex with the same positions at the start and the
/// end. Returns an empty list if no two used vertices have the same position at the start.
std::vector<std::uint32_t> places(const MeshView& mesh, std::span<const Vec3d> end) {
  const std::vector<std::uint32_t> first = weld_clusters(mesh.vertices);
  // True for a vertex that is the first of several vertices at its start position.
  std::vector<bool> is_shared(first.size(), false);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) is_shared[first[v]] = true;
  }
  std::vector<std::uint32_t> together;
  for_each_named_vertex(mesh, [&](std::uint32_t v) {
    if (is_shared[first[v]]) together.push_back(v);
  });
  if (together.empty()) return {};
  detail::sort_unique(together);
  const std::vector<std::uint32_t> last = weld_clusters(end);
  const auto key = [&](std::uint32_t v) { return std::pair(first[v], last[v]); };
  std::sort(together.begin(), together.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<std::uint32_t> out(first.size());
  for (std::uint32_t v = 0; v < out.size(); ++v) out[v] = v;
  for (std::size_t k = 1; k < together.size(); ++k) {
    if (key(together[k]) == key(together[k - 1])) out[together[k]] = out[together[k - 1]];
  }
  return out;
}

/// Moves the sides of a box outwards by at least half of `min_separation`.
void grow(Box3& box, double min_separation) {
  if (!(min_separation > 0)) return;
  const double by = 0.5 * min_separation;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::nextafter(box.lower[axis] - by, -infinite);
    box.upper[axis] = std::nextafter(box.upper[axis] + by, infinite);
  }
}

}  // namespace

void grow(MovingBox& box, double min_separation) {
  grow(box.start, min_separation);
  grow(box.end, min_separation);
}

MovingFeatures::MovingFeatures(const MeshView& mesh, std::span<const Vec3d> end, const Context& context)
    : mesh_(mesh), end_(end), place_(places(mesh, end)) {
  throw_if_cancelled(context);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { vertices_.push_back(place(v)); });
  detail::sort_unique(vertices_);
  const auto add_edge = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t from = place(a);
    const std::uint32_t to = place(b);
    if (from != to) edges_.push_back({std::min(from, to), std::max(from, to)});
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) add_edge(t[k], t[(k + 1) % 3]);
  }
  for (const Segment& s : mesh.segments) add_edge(s[0], s[1]);
  detail::sort_unique(edges_);
}

namespace {

constexpr std::size_t direction_count = 10;

/// Heights of a point along ten directions: the six diagonals of a cube's faces, then the cube's four space diagonals.
using Heights = std::array<double, direction_count>;

Heights heights_of(const Vec3d& p) {
  return {p.x + p.y, p.x - p.y,       p.x + p.z,       p.x - p.z,       p.y + p.z,
          p.y - p.z, p.x + p.y + p.z, p.x + p.y - p.z, p.x - p.y + p.z, p.x - p.y - p.z};
}

/// Returns a bound on the rounding error of the difference of two heights. Each height is a sum of at most three
/// numbers.
double rounding_of(const std::array<Vec3d, 4>& points) {
  double most = 0;
  for (const Vec3d& p : points) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return 0x1p-48 * most;
}

/// For each direction: the gap between the first points and the other points, if the first points are above or below
/// the others. A negative gap means that the points are not separated.
struct Gaps {
  Heights above;
  Heights below;
};

Gaps gaps_of(const std::array<Vec3d, 4>& points, std::size_t first_count) {
  Heights least_first = heights_of(points[0]);
  Heights most_first = least_first;
  Heights least_rest = heights_of(points[3]);
  Heights most_rest = least_rest;
  const auto widen = [](const Vec3d& p, Heights& least, Heights& most) {
    const Heights heights = heights_of(p);
    for (std::size_t k = 0; k < direction_count; ++k) {
      least[k] = std::min(least[k], heights[k]);
      most[k] = std::max(most[k], heights[k]);
    }
  };
  for (std::size_t v = 1; v < first_count; ++v) widen(points[v], least_first, most_first);
  for (std::size_t v = first_count; v < 3; ++v) widen(points[v], least_rest, most_rest);
  Gaps gaps;
  for (std::size_t k = 0; k < direction_count; ++k) {
    gaps.above[k] = least_first[k] - most_rest[k];
    gaps.below[k] = least_rest[k] - most_first[k];
  }
  return gaps;
}

}  // namespace

bool are_apart(const FourMovingPoints& points, std::size_t first_count, double distance) {
  const Gaps start = gaps_of(points.start, first_count);
  const Gaps end = gaps_of(points.end, first_count);
  constexpr std::size_t of_faces = 6;  // directions of length sqrt(2); the others are sqrt(3) long
  double widest = -1;
  for (std::size_t k = 0; k < direction_count; ++k) {
    const double gap = std::max(std::min(start.above[k], end.above[k]), std::min(start.below[k], end.below[k]));
    widest = std::max(widest, gap - distance * (k < of_faces ? 1.4143 : 1.7321));
  }
  return widest > rounding_of(points.start) + rounding_of(points.end) + 0x1p-50 * distance;
}

namespace {

using detail::FeatureKinds;

constexpr std::size_t blocks_per_range = 32;
constexpr std::size_t most_collisions = std::size_t{1} << 26;  ///< largest number of collisions: they take 1.6 GB

/// Returns a hierarchy over the boxes of features. Each box contains the vertices of a feature.
template <class Features, class Vertices>
MovingBoxBvh hierarchy(const MovingFeatures& moving, const Features& features, const Vertices& vertices_of,
                       double min_separation, const Context& context) {
  std::vector<MovingBox> boxes(features.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    boxes[k] = moving.box(vertices_of(features[k]), min_separation);
  }
  return MovingBoxBvh(boxes, context);
}

std::span<const std::uint32_t> itself(std::span<const std::uint32_t> feature) {
  return feature;
}
std::span<const std::uint32_t> alone(const std::uint32_t& vertex) {
  return {&vertex, 1};
}

}  // namespace

MovingBox MovingFeatures::box(std::span<const std::uint32_t> vertices, double min_separation) const {
  MovingBox box;
  for (const std::uint32_t v : vertices) {
    box.start.extend(start(v));
    box.end.extend(end(v));
  }
  grow(box, min_separation);
  return box;
}

bool MovingFeatures::is_corner(std::uint32_t vertex, const Triangle& face) const {
  return std::any_of(face.begin(), face.end(), [&](std::uint32_t corner) { return place(corner) == vertex; });
}

bool share_end(const Segment& a, const Segment& b) {
  return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

FourMovingPoints moving_points(const MovingFeatures& a, std::span<const std::uint32_t> first, const MovingFeatures& b,
                               std::span<const std::uint32_t> second) {
  FourMovingPoints out;
  std::size_t k = 0;
  for (const std::uint32_t v : first) {
    out.start[k] = a.start(v);
    out.end[k++] = a.end(v);
  }
  for (const std::uint32_t v : second) {
    out.start[k] = b.start(v);
    out.end[k++] = b.end(v);
  }
  return out;
}

MovingObject::MovingObject(const MeshView& mesh, std::span<const Vec3d> end, double min_separation,
                           const Context& context)
    : features_(mesh, end, context),
      min_separation_(min_separation),
      vertices_(hierarchy(features_, features_.vertices(), alone, min_separation, context)),
      edges_(hierarchy(features_, features_.edges(), itself, min_separation, context)),
      faces_(hierarchy(features_, features_.faces(), itself, min_separation, context)) {}

/// Results of one part of the work.
template <class Collision>
struct ImpactSearch::Found {
  std::vector<Collision> collisions;
  std::size_t box_pairs = 0;
  std::size_t exact_tests = 0;
  bool is_stopped = false;  ///< true if the caller asked to stop, or if there are too many collisions
};

std::vector<VertexFaceCollision> ImpactSearch::vertices_and_faces(const MovingObject& of_vertices,
                                                                  const MovingObject& of_faces) {
  const auto find = [&](std::size_t block, Found<VertexFaceCollision>& found) {
    of_vertices.vertices().for_each_pair(block, of_faces.faces(), [&](std::uint32_t v, std::uint32_t f) {
      test_vertex_face(of_vertices.features(), of_faces.features(), v, f, found);
    });
  };
  auto out = gathered<VertexFaceCollision>(of_vertices.vertices().block_count(), "vertices and faces", find);
  std::sort(out.begin(), out.end(), [](const VertexFaceCollision& a, const VertexFaceCollision& b) {
    return std::pair(a.vertex, a.face.value) < std::pair(b.vertex, b.face.value);
  });
  return out;
}

std::vector<EdgeEdgeCollision> ImpactSearch::edges_and_edges(const MovingObject& a, const MovingObject& b) {
  const bool is_self = &a == &b;
  const auto find = [&](std::size_t block, Found<EdgeEdgeCollision>& found) {
    const auto test = [&](std::uint32_t first, std::uint32_t second) {
      if (is_self && second < first) std::swap(first, second);
      test_edge_edge(a.features(), b.features(), first, second, found);
    };
    if (is_self) {
      a.edges().for_each_self_pair(block, test);
    } else {
      a.edges().for_each_pair(block, b.edges(), test);
    }
  };
  auto out = gathered<EdgeEdgeCollision>(a.edges().block_count(), "edges and edges", find);
  std::sort(out.begin(), out.end(), [](const EdgeEdgeCollision& x, const EdgeEdgeCollision& y) {
    return std::pair(x.first, x.second) < std::pair(y.first, y.second);
  });
  return out;
}

/// Returns the results of find(block, found) for all blocks, in unspecified order.
template <class Collision, class Find>
std::vector<Collision> ImpactSearch::gathered(std::size_t blocks, const char* phase, const Find& find) {
  std::vector<Found<Collision>> parts((blocks + blocks_per_range - 1) / blocks_per_range);
  parallel_for(context_, blocks, blocks_per_range, phase, [&](const WorkRange& range) {
    for (std::size_t b = range.begin; b < range.end; ++b) find(b, parts[range.begin / blocks_per_range]);
  });
  throw_if_cancelled(context_);  // parts that stopped are incomplete
  if (collisions_ > most_collisions) {
    throw OutOfMemory("more than " + std::to_string(most_collisions) +
                      " pairs collide, usually because parts lie on each other: remove duplicates");
  }
  std::vector<Collision> all;
  for (const Found<Collision>& part : parts) {
    all.insert(all.end(), part.collisions.begin(), part.collisions.end());
    box_pairs_ += part.box_pairs;
    exact_tests_ += part.exact_tests;
  }
  return all;
}

/// Counts a pair of boxes.
/// @return  true if the pair must be skipped, because the search has stopped.
template <class Collision>
bool ImpactSearch::stops(Found<Collision>& found) const {
  constexpr std::size_t pairs_between_looks = 256;
  if (++found.box_pairs % pairs_between_looks == 0) {
    found.is_stopped = context_.cancel.stop_requested() || collisions_ > most_collisions;
  }
  return found.is_stopped;
}

void ImpactSearch::test_vertex_face(const MovingFeatures& of_vertices, const MovingFeatures& of_faces,
                                    std::uint32_t vertex, std::uint32_t face, Found<VertexFaceCollision>& found) {
  const std::uint32_t v = of_vertices.vertices()[vertex];
  const Triangle& corners = of_faces.faces()[face];
  if (&of_vertices == &of_faces && of_faces.is_corner(v, corners)) return;
  if (stops(found)) return;
  const FourMovingPoints four = moving_points(of_vertices, alone(v), of_faces, corners);
  if (are_apart(four, 1, options_.min_separation)) return;
  ++found.exact_tests;
  if (const auto time = detail::impact(four, FeatureKinds::vertex_face, options_)) {
    found.collisions.push_back({v, TriangleId(face), *time});
    ++collisions_;
  }
}

void ImpactSearch::test_edge_edge(const MovingFeatures& a, const MovingFeatures& b, std::uint32_t first,
                                  std::uint32_t second, Found<EdgeEdgeCollision>& found) {
  const Segment& one = a.edges()[first];
  const Segment& other = b.edges()[second];
  if (&a == &b && share_end(one, other)) return;
  if (stops(found)) return;
  const FourMovingPoints four = moving_points(a, one, b, other);
  if (are_apart(four, 2, options_.min_separation)) return;
  ++found.exact_tests;
  if (const auto time = detail::impact(four, FeatureKinds::edge_edge, options_)) {
    found.collisions.push_back({one, other, *time});
    ++collisions_;
  }
}

std::optional<double> ContinuousCollisions::earliest() const {
  std::optional<double> first;
  const auto look_at = [&](double time) {
    if (!first || time < *first) first = time;
  };
  for (const VertexFaceCollision& one : vertex_face) look_at(one.time);
  for (const EdgeEdgeCollision& one : edge_edge) look_at(one.time);
  return first;
}

std::vector<Warning> start_warnings(std::size_t pairs) {
  if (pairs == 0) return {};
  return {{WarningCode::meet_at_start, plural(pairs, "pair meets", "pairs meet") +
                                           " already at the start of the motion, so " +
                                           (pairs == 1 ? "its time is 0" : "their times are 0")}};
}

std::vector<Warning> start_warnings(const ContinuousCollisions& found) {
  const auto at_start = [](const auto& pairs) {
    return static_cast<std::size_t>(
        std::count_if(pairs.begin(), pairs.end(), [](const auto& one) { return one.time == 0; }));
  };
  return start_warnings(at_start(found.vertex_face) + at_start(found.edge_edge));
}

ContinuousCollisions continuous_collisions(const MeshView& mesh, std::span<const Vec3d> end,
                                           const ImpactOptions& options, const Context& context) {
  check_motion(mesh, end);
  check(options);
  ContinuousCollisions out;
  PhaseTimer timer(out.phases);
  const MovingObject object(mesh, end, options.min_separation, context);
  timer.lap("boxes");
  ImpactSearch search(options, context);
  out.vertex_face = search.vertices_and_faces(object, object);
  timer.lap("vertices and faces");
  out.edge_edge = search.edges_and_edges(object, object);
  timer.lap("edges and edges");
  out.box_pairs = search.box_pairs();
  out.exact_tests = search.exact_tests();
  return out;
}

}  // namespace blum
