#include "blum/geometry/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/space_order.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/bvh/primitive_block.hpp"

namespace blum {
namespace {

constexpr std::size_t leaf_grain = 512;
constexpr std::size_t query_grain = 512;
/// Candidates whose approximate distance exceeds the smallest distance by at most this are evaluated exactly. The value
/// is relative to the lengths involved.
constexpr double candidate_slack = 2e-12;
/// Error of distances that is due to rounding the coordinates of closest points, relative to the largest coordinate.
constexpr double coordinate_slack = 4e-15;

/// A primitive in the form that PrimitiveBlock stores.
struct Primitive {
  std::array<std::uint32_t, 3> vertices{};
  std::array<SiteId, 3> edges{SiteId::none(), SiteId::none(), SiteId::none()};
  SiteId face = SiteId::none();
  /// For each corner of the mesh triangle (first, second, third): its index in `vertices`, two bits each.
  std::uint8_t corners = 0b10'01'00;
};

class PrimitiveReader {
 public:
  PrimitiveReader(const MeshView& mesh, const SiteTable& sites) : mesh_(mesh), sites_(sites) {}

  [[nodiscard]] std::size_t count() const {
    return mesh_.triangles.size() + mesh_.segments.size() + mesh_.points.size();
  }

  [[nodiscard]] std::array<std::uint32_t, 3> vertices(std::size_t index) const {
    const std::size_t triangles = mesh_.triangles.size();
    if (index < triangles) return mesh_.triangles[index];
    index -= triangles;
    if (index < mesh_.segments.size()) {
      const Segment& s = mesh_.segments[index];
      return {std::min(s[0], s[1]), std::max(s[0], s[1]), std::max(s[0], s[1])};
    }
    const std::uint32_t v = mesh_.points[index - mesh_.segments.size()];
    return {v, v, v};
  }

  [[nodiscard]] Primitive read(std::size_t index) const {
    Primitive out;
    out.vertices = vertices(index);
    if (index < mesh_.triangles.size()) {
      read_triangle(static_cast<std::uint32_t>(index), out);
    } else if (out.vertices[0] != out.vertices[1]) {
      const Segment edge{out.vertices[0], out.vertices[1]};
      const auto found = std::lower_bound(sites_.edges().begin(), sites_.edges().end(), edge);
      out.edges[0] = edge_site(static_cast<std::uint32_t>(found - sites_.edges().begin()));
    }
    return out;
  }

 private:
  [[nodiscard]] SiteId edge_site(std::uint32_t edge) const { return sites_.id({SiteKind::edge, edge}); }

  void read_triangle(std::uint32_t triangle, Primitive& out) const {
    const std::array<EdgeId, 3>& edges = sites_.triangle_edges()[triangle];
    std::array<std::size_t, 3> corner{0, 1, 2};
    const std::array<std::uint32_t, 3> v = out.vertices;
    std::sort(corner.begin(), corner.end(), [&](std::size_t a, std::size_t b) { return v[a] < v[b]; });
    const auto between = [&](std::size_t a, std::size_t b) {
      const EdgeId edge = edges[(a + 1) % 3 == b ? a : b];
      return edge.has_value() ? edge_site(edge.value) : SiteId::none();
    };
    out.vertices = {v[corner[0]], v[corner[1]], v[corner[2]]};
    out.corners = 0;
    for (unsigned k = 0; k < 3; ++k) out.corners |= static_cast<std::uint8_t>(k << (2 * corner[k]));
    out.edges = {between(corner[0], corner[1]), between(corner[1], corner[2]), between(corner[0], corner[2])};
    const bool has_area = out.vertices[0] != out.vertices[1] && out.vertices[1] != out.vertices[2];
    if (has_area) out.face = sites_.id({SiteKind::face, triangle});
  }

  const MeshView& mesh_;
  const SiteTable& sites_;
};

}  // namespace

/// Returns the box around a ray from its origin to t = end, slightly enlarged for rounding.
Box3 box_around(const Ray& ray, double end) {
  constexpr double rounding = 1e-14;
  const Vec3d way = ray.direction * (end * (1 + 1e-9));
  Box3 box;
  box.extend(ray.origin);
  box.extend(ray.origin + way);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double slack = rounding * (std::abs(ray.origin[axis]) + std::abs(way[axis]));
    box.lower[axis] -= slack;
    box.upper[axis] += slack;
  }
  return box;
}

struct Bvh::Data {
  Box3 bounds;
  double scale = 1;  ///< factor from mesh coordinates to the coordinates of blocks
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::vector<std::uint32_t> order;  ///< primitives in leaf order
  std::vector<std::uint8_t> turns;   ///< Primitive::corners, parallel to `order`
  std::vector<PrimitiveBlock> leaves;
  BoxTree tree;

  /// Query in the coordinates of blocks, and the error bound of approximate distances.
  struct Query {
    Vec3d point;
    double slack = 0;
  };

  /// Returns nullopt if the query's coordinates are out of range or the tree is empty.
  [[nodiscard]] std::optional<Query> prepare(const Vec3d& query) const {
    const Vec3d q = query * scale;
    const double coordinate = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    if (tree.is_empty() || !(coordinate <= 1e150)) return std::nullopt;
    const Vec3d outside = max(max(bounds.lower * scale - q, q - bounds.upper * scale), Vec3d{});
    return Query{q, candidate_slack * (1 + length(outside)) + coordinate_slack * coordinate};
  }

  [[nodiscard]] std::size_t lanes_of(std::size_t leaf) const { return std::min(lanes, order.size() - leaf * lanes); }

  /// Unused lanes of the last leaf repeat its last primitive; these copies are not reported.
  [[nodiscard]] bool is_triangle(std::size_t leaf, std::size_t lane) const {
    return lane < lanes_of(leaf) && order[leaf * lanes + lane] < triangles;
  }

  /// Calls limit = offer(leaf, lane, limit) for the primitives that may lie within `limit`. Lengths are in the units of
  /// blocks.
  template <class Offer>
  void for_each_candidate(const Query& query, double limit, const Offer& offer) const {
    visit_near(tree, query.point, limit, [&](std::size_t leaf) {
      double distances[lanes];
      approximate_distances(leaves[leaf], query.point, distances);
      unsigned within = 0;  // computed without branches, which would often be mispredicted
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        within |= static_cast<unsigned>(distances[lane] <= limit) << lane;
      }
      if (within == 0) return limit;
      // The candidate with the smallest approximate distance is offered first: it usually excludes the others.
      std::size_t first = 0;
      for (std::size_t lane = 1; lane < lanes; ++lane) first = distances[lane] < distances[first] ? lane : first;
      for (limit = offer(leaf, first, limit), within &= ~(1U << first); within != 0; within &= within - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(within));
        if (distances[lane] <= limit) limit = offer(leaf, lane, limit);
      }
      return limit;
    });
  }

  /// Returns the closest point of one primitive.
  [[nodiscard]] NearestPrimitive closest(std::size_t leaf, std::size_t lane, const Vec3d& q) const {
    SiteCandidate best;
    offer_closest(leaves[leaf], lane, q, best);
    return {best.point / scale, best.distance / scale, best.site, order[leaf * lanes + lane]};
  }

  /// Converts a crossing from the corner order of its block to that of the mesh triangle.
  [[nodiscard]] RayCrossing as_given(const detail::TriangleCrossing& found, std::size_t leaf, std::size_t lane,
                                     double t) const {
    const std::size_t rank = leaf * lanes + lane;
    RayCrossing out{t, TriangleId(order[rank]), {}, found.side, found.on_border};
    const std::array<unsigned, 3> at{turns[rank] & 3U, turns[rank] >> 2 & 3U, turns[rank] >> 4 & 3U};
    for (std::size_t k = 0; k < 3; ++k) out.weights[k] = found.weights[at[k]];
    const bool is_reversed = (at[0] + 1) % 3 != at[1];
    if (is_reversed) out.side = -out.side;
    return out;
  }

  template <class Go, class Visit>
  void cross(const Ray& ray, double limit, const Go& go, const Visit& visit) const;
  template <class Visit>
  void for_each_leaf(const BvhPart& part, const Box3& box, const Visit& visit) const;
  template <class Visit>
  bool visit_near_in(std::size_t leaf, const ProbeTriangle& probe, const Visit& visit) const;

  void fill_tree(const Context& context) {
    std::vector<Box3> boxes(leaves.size());
    parallel_for(context, leaves.size(), leaf_grain, "", [&](const WorkRange& range) {
      for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
        for (std::size_t lane = 0; lane < lanes_of(leaf); ++lane) {
          for (std::size_t k = 0; k < 3; ++k) boxes[leaf].extend(leaves[leaf].position(k, lane));
        }
      }
    });
    tree = make_box_tree(boxes, context);
  }

  /// Returns the box around the primitives when the vertices are at the positions `moved`.
  [[nodiscard]] Box3 bounds_of(std::span<const Vec3d> moved, const Context& context) const;
};

Bvh::Bvh(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  auto data = std::make_unique<Data>();
  data->bounds = blum::bounds(mesh);
  data->scale = unit_scale(data->bounds);
  data->vertices = mesh.vertices.size();
  data->triangles = mesh.triangles.size();
  const double scale = data->scale;
  const PrimitiveReader reader(mesh, sites);
  const auto box_of = [&](std::size_t index) {
    Box3 box;
    for (const std::uint32_t v : reader.vertices(index)) box.extend(mesh.vertices[v] * scale);
    return box;
  };
  const std::size_t count = reader.count();
  data->order = space_order(count, [&](std::size_t index) { return box_of(index).center(); }, context);

  data->leaves.resize((count + lanes - 1) / lanes);
  data->turns.resize(count);
  parallel_for(context, data->leaves.size(), leaf_grain, "", [&](const WorkRange& range) {
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        // Unused lanes of the last leaf repeat its last primitive.
        const std::size_t rank = std::min(leaf * lanes + lane, count - 1);
        const Primitive p = reader.read(data->order[rank]);
        if (leaf * lanes + lane == rank) data->turns[rank] = p.corners;
        const auto corner = [&](std::size_t k) { return mesh.vertices[p.vertices[k]] * scale; };
        data->leaves[leaf].set(lane, {corner(0), corner(1), corner(2)}, p.vertices, p.edges, p.face);
      }
    }
  });
  data->fill_tree(context);
  data_ = std::move(data);
}

Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;

Box3 Bvh::Data::bounds_of(std::span<const Vec3d> moved, const Context& context) const {
  constexpr std::uint32_t nobody = 0xffffffff;
  std::vector<Box3> boxes((leaves.size() + leaf_grain - 1) / leaf_grain);
  std::vector<std::uint32_t> unusable(boxes.size(), nobody);
  parallel_for(context, leaves.size(), leaf_grain, "", [&](const WorkRange& range) {
    const std::size_t part = range.begin / leaf_grain;
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
      for (std::size_t lane = 0; lane < lanes_of(leaf); ++lane) {
        for (const auto& corners : leaves[leaf].vertex) {
          const Vec3d& p = moved[corners[lane]];
          const bool is_usable = std::abs(p.x) <= 1e150 && std::abs(p.y) <= 1e150 && std::abs(p.z) <= 1e150;
          if (!is_usable && unusable[part] == nobody) unusable[part] = corners[lane];
          boxes[part].extend(p);
        }
      }
    }
  });
  Box3 box;
  for (std::size_t part = 0; part < boxes.size(); ++part) {
    if (unusable[part] != nobody) {
      throw InvalidMesh("vertex " + std::to_string(unusable[part]) + " is not finite, or beyond 1e150");
    }
    box.extend(boxes[part]);
  }
  return box;
}

void Bvh::refit(std::span<const Vec3d> vertices, const Context& context) {
  Data& data = *data_;
  if (vertices.size() != data.vertices) {
    throw InvalidMesh("a hierarchy of a mesh with " + std::to_string(data.vertices) +
                      " vertices cannot be refitted to " + std::to_string(vertices.size()) +
                      " vertices; build a new hierarchy");
  }
  data.bounds = data.bounds_of(vertices, context);
  data.scale = unit_scale(data.bounds);
  parallel_for(context, data.leaves.size(), leaf_grain, "", [&](const WorkRange& range) {
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
      PrimitiveBlock& block = data.leaves[leaf];
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const auto corner = [&](std::size_t k) { return vertices[block.vertex[k][lane]] * data.scale; };
        block.place(lane, {corner(0), corner(1), corner(2)});
      }
    }
  });
  data.fill_tree(context);
}

std::span<const std::uint32_t> Bvh::order() const {
  return data_->order;
}

const Box3& Bvh::bounds() const {
  return data_->bounds;
}
std::size_t Bvh::size() const {
  return data_->order.size();
}

std::optional<NearestSite> Bvh::nearest(const Vec3d& query, double max_distance) const {
  const Data& data = *data_;
  const std::optional<Data::Query> q = data.prepare(query);
  if (!q) return std::nullopt;
  const double furthest = max_distance * data.scale;
  SiteCandidate best;
  data.for_each_candidate(*q, furthest + q->slack, [&](std::size_t leaf, std::size_t lane, double limit) {
    offer_closest(data.leaves[leaf], lane, q->point, best);
    return std::min(limit, best.distance + q->slack);
  });
  if (!best.site.has_value() || best.distance > furthest) return std::nullopt;
  return NearestSite{best.point / data.scale, best.distance / data.scale, best.site};
}

std::vector<std::optional<NearestSite>> Bvh::nearest(std::span<const Vec3d> queries, double max_distance,
                                                     const Context& context) const {
  std::vector<std::optional<NearestSite>> out(queries.size());
  parallel_for(context, queries.size(), query_grain, "closest points", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) out[i] = nearest(queries[i], max_distance);
  });
  return out;
}

namespace {

bool is_nearer(const NearestPrimitive& a, const NearestPrimitive& b) {
  return a.distance < b.distance || (a.distance == b.distance && a.primitive < b.primitive);
}

bool is_earlier(const RayCrossing& a, const RayCrossing& b) {
  return a.t < b.t || (a.t == b.t && a.triangle < b.triangle);
}

}  // namespace

std::optional<NearestPrimitive> Bvh::nearest_wanted(const Vec3d& query, FunctionRef<bool(std::uint32_t)> is_wanted,
                                                    double max_distance) const {
  const Data& data = *data_;
  std::optional<NearestPrimitive> best;
  const std::optional<Data::Query> q = data.prepare(query);
  if (!q) return best;
  const double furthest = max_distance * data.scale + q->slack;
  data.for_each_candidate(*q, furthest, [&](std::size_t leaf, std::size_t lane, double limit) {
    // The predicate is called first, because it costs less than the exact distance.
    if (lane >= data.lanes_of(leaf) || !is_wanted(data.order[leaf * lanes + lane])) return limit;
    const NearestPrimitive found = data.closest(leaf, lane, q->point);
    if (found.distance > max_distance || (best && !is_nearer(found, *best))) return limit;
    best = found;
    return std::min(limit, found.distance * data.scale + q->slack);
  });
  return best;
}

std::vector<NearestPrimitive> Bvh::nearest_primitives(const Vec3d& query, std::size_t k, double max_distance) const {
  const Data& data = *data_;
  std::vector<NearestPrimitive> best;  // a heap with the furthest primitive on top
  const std::optional<Data::Query> q = data.prepare(query);
  if (!q || k == 0) return best;
  data.for_each_candidate(
      *q, max_distance * data.scale + q->slack, [&](std::size_t leaf, std::size_t lane, double limit) {
        if (lane >= data.lanes_of(leaf)) return limit;
        const NearestPrimitive found = data.closest(leaf, lane, q->point);
        if (found.distance > max_distance) return limit;
        if (best.size() == k && !is_nearer(found, best.front())) return limit;
        if (best.size() == k) {
          std::pop_heap(best.begin(), best.end(), is_nearer);
          best.pop_back();
        }
        best.push_back(found);
        std::push_heap(best.begin(), best.end(), is_nearer);
        return best.size() < k ? limit : std::min(limit, best.front().distance * data.scale + q->slack);
      });
  std::sort_heap(best.begin(), best.end(), is_nearer);
  return best;
}

void Bvh::for_each_within(const Vec3d& query, double distance, FunctionRef<bool(const NearestPrimitive&)> visit) const {
  const Data& data = *data_;
  const std::optional<Data::Query> q = data.prepare(query);
  if (!q || !(distance >= 0)) return;
  data.for_each_candidate(*q, distance * data.scale + q->slack, [&](std::size_t leaf, std::size_t lane, double limit) {
    if (lane >= data.lanes_of(leaf)) return limit;
    const NearestPrimitive found = data.closest(leaf, lane, q->point);
    constexpr double stop = -1;
    return found.distance > distance || visit(found) ? limit : stop;
  });
}

std::vector<NearestPrimitive> Bvh::within(const Vec3d& query, double distance) const {
  std::vector<NearestPrimitive> out;
  for_each_within(query, distance, [&](const NearestPrimitive& found) {
    out.push_back(found);
    return true;
  });
  std::sort(out.begin(), out.end(), is_nearer);
  return out;
}

/// Calls visit(leaf) for the leaves of a part of the tree whose boxes touch a box, until a call returns false.
template <class Visit>
void Bvh::Data::for_each_leaf(const BvhPart& part, const Box3& box, const Visit& visit) const {
  for (const BvhPart::Leaves& leaves : part.leaves_) {
    for (unsigned bits = leaves.bits & touching(tree.levels[0][leaves.block], box); bits != 0; bits &= bits - 1) {
      if (!visit(leaves.block * lanes + static_cast<std::size_t>(std::countr_zero(bits)))) return;
    }
  }
}

/// Calls limit = visit(crossing) for the triangles that a ray crosses at t <= limit.
/// @param go  calls its last argument for the leaves that the ray may cross, as visit_along() does.
template <class Go, class Visit>
void Bvh::Data::cross(const Ray& ray, double limit, const Go& go, const Visit& visit) const {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3d{}) return;
  const auto [scaled_ray, factor] = detail::scaled_direction({ray.origin * scale, ray.direction});
  const Ray& scaled = scaled_ray;
  if (!prepare(ray.origin)) return;
  // Converts t to block units. Lengths there are `scale` times those of the caller, and directions 1 / factor times.
  const double t_factor = factor * scale;
  double furthest = limit;
  go(scaled, furthest * t_factor, [&](std::size_t leaf) {
    const PrimitiveBlock& block = leaves[leaf];
    // The end is slightly beyond the limit, so that crossings at the limit itself are found if rounding allows.
    const double end = std::min(furthest * t_factor * (1 + 1e-9), 1e300);
    for (unsigned bits = may_cross(block, scaled, end); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      if (!is_triangle(leaf, lane)) continue;
      const std::optional<detail::TriangleCrossing> found =
          detail::crossing(scaled, {block.position(0, lane), block.position(1, lane), block.position(2, lane)});
      if (!found || !(found->t / t_factor <= furthest)) continue;
      furthest = visit(as_given(*found, leaf, lane, found->t / t_factor));
    }
    return furthest * t_factor;
  });
}

void Bvh::for_each_crossing(const Ray& ray, double limit, FunctionRef<double(const RayCrossing&)> visit) const {
  const auto go = [&](const auto& scaled, double end, const auto& look_at) {
    visit_along(data_->tree, scaled, end, look_at);
  };
  data_->cross(ray, limit, go, visit);
}

std::optional<RayCrossing> Bvh::first_crossing(const Ray& ray, const BvhPart& part) const {
  std::optional<RayCrossing> first;
  const auto go = [&](const Ray& scaled, double end, const auto& look_at) {
    data_->for_each_leaf(part, box_around(scaled, end), [&](std::size_t leaf) {
      look_at(leaf);
      return true;
    });
  };
  data_->cross(ray, 1, go, [&](const RayCrossing& found) {
    if (!first || is_earlier(found, *first)) first = found;
    return first->t;
  });
  return first;
}

std::optional<BvhPart> Bvh::part_in(const Box3& box) const {
  constexpr std::size_t most_leaves = 64;
  BvhPart part;
  std::size_t count = 0;
  const Box3 scaled{box.lower * data_->scale, box.upper * data_->scale};
  for_each_touching(data_->tree, scaled, 0, [&](std::size_t leaf) {
    if (may_reach(data_->leaves[leaf], scaled) == 0) return true;
    const auto block = static_cast<std::uint32_t>(leaf / lanes);
    if (part.leaves_.empty() || part.leaves_.back().block != block) part.leaves_.push_back({block, 0});
    part.leaves_.back().bits |= 1U << (leaf % lanes);
    return ++count <= most_leaves;
  });
  if (count > most_leaves) return std::nullopt;
  return part;
}

std::vector<RayCrossing> Bvh::crossings(const Ray& ray, double limit) const {
  std::vector<RayCrossing> out;
  for_each_crossing(ray, limit, [&](const RayCrossing& found) {
    out.push_back(found);
    return limit;
  });
  std::sort(out.begin(), out.end(), is_earlier);
  return out;
}

std::optional<RayCrossing> Bvh::first_crossing(const Ray& ray, double limit) const {
  std::optional<RayCrossing> first;
  for_each_crossing(ray, limit, [&](const RayCrossing& found) {
    if (!first || is_earlier(found, *first)) first = found;
    return first->t;
  });
  return first;
}

std::vector<std::optional<RayCrossing>> Bvh::first_crossings(std::span<const Ray> rays, double limit,
                                                             const Context& context) const {
  std::vector<std::optional<RayCrossing>> out(rays.size());
  parallel_for(context, rays.size(), query_grain, "rays", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) out[i] = first_crossing(rays[i], limit);
  });
  return out;
}

/// Calls visit(triangle) for the triangles of a leaf that may meet `probe`, until a call returns false.
/// @return  false if a call of `visit` returned false.
template <class Visit>
bool Bvh::Data::visit_near_in(std::size_t leaf, const ProbeTriangle& probe, const Visit& visit) const {
  for (unsigned bits = may_meet(leaves[leaf], probe); bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    if (is_triangle(leaf, lane) && !visit(TriangleId(order[leaf * lanes + lane]))) return false;
  }
  return true;
}

void Bvh::for_each_near(const std::array<Vec3d, 3>& triangle, FunctionRef<bool(TriangleId)> visit) const {
  const Data& data = *data_;
  const ProbeTriangle probe({triangle[0] * data.scale, triangle[1] * data.scale, triangle[2] * data.scale});
  for_each_touching(data.tree, probe.box, 0, [&](std::size_t leaf) { return data.visit_near_in(leaf, probe, visit); });
}

void Bvh::for_each_near(const std::array<Vec3d, 3>& triangle, const BvhPart& part,
                        FunctionRef<bool(TriangleId)> visit) const {
  const Data& data = *data_;
  const ProbeTriangle probe({triangle[0] * data.scale, triangle[1] * data.scale, triangle[2] * data.scale});
  data.for_each_leaf(part, probe.box, [&](std::size_t leaf) { return data.visit_near_in(leaf, probe, visit); });
}

bool Bvh::may_touch(const Box3& box) const {
  const Data& data = *data_;
  if (box.is_empty()) return false;
  return blum::may_touch(data.tree, {box.lower * data.scale, box.upper * data.scale});
}

}  // namespace blum
