#include "field/cpu/record_build.hpp"

#include <array>
#include <utility>

#include "field/cpu/record_geometry.hpp"
#include "field/cpu/vertex_fans.hpp"
#include "field/kernels/site_shapes.hpp"
#include "field/kernels/vertex_cone.hpp"

namespace blum::cpu {
namespace {

using kernels::ChosenPlanes;
using kernels::VertexCone;

std::span<const std::uint32_t> neighbours_of(const RecordInput& input, std::uint32_t vertex) {
  const std::uint32_t first = input.adjacency.first_neighbour[vertex];
  return std::span(input.adjacency.neighbours).subspan(first, input.adjacency.first_neighbour[vertex + 1] - first);
}

/// Returns true if a vertex has enough edges to bound a cone, and few enough for the code that processes sixteen
/// vertices at a time.
bool fits_fan(std::size_t edge_count) {
  return edge_count >= 3 && edge_count <= VertexFans::most;
}

/// Writes a vertex and its edges into a lane. Edges without length are left out.
void add_fan(const RecordInput& input, std::uint32_t vertex, std::size_t lane, VertexFans& fans) {
  const Vec3d& p = input.positions[vertex];
  std::size_t count = 0;
  for (const std::uint32_t neighbour : neighbours_of(input, vertex)) {
    const Vec3d to = input.positions[neighbour] - p;
    if (!(squared_length(to) > negligible_length * negligible_length)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) fans.along[count][axis][lane] = static_cast<float>(to[axis]);
    ++count;
  }
  for (std::size_t k = count; k < VertexFans::most; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) fans.along[k][axis][lane] = fans.along[0][axis][lane];
  }
  fans.count[lane] = static_cast<std::uint32_t>(count);
}

/// Writes the record of a vertex whose bounding planes have been chosen.
template <class Direction>
void finish_vertex(const RecordInput& input, std::uint32_t vertex, const ChosenPlanes& planes, Direction direction,
                   std::span<const Vec3f> rays, Record& record, ClusterBuild& cluster) {
  const Vec3d& p = input.positions[vertex];
  store(record, VertexColumns::position, p);
  for (std::size_t k = 0; k < planes.count; ++k) {
    store(record, VertexColumns::direction + 3 * static_cast<int>(k), direction(planes.index[k]));
  }
  record.id = vertex;
  cluster.box.extend(p);
  cluster.directions.add(rays);
}

void build_alone(const RecordInput& input, std::uint32_t vertex, Record& record, ClusterBuild& cluster) {
  const Vec3d& p = input.positions[vertex];
  VertexCone cone;
  for (const std::uint32_t neighbour : neighbours_of(input, vertex)) {
    const Vec3d to = input.positions[neighbour] - p;
    const double distance = length(to);
    if (distance > negligible_length) cone.add(unit(to, distance));
  }
  if (!cone.find_facets()) return;
  finish_vertex(
      input, vertex, cone.planes(), [&](std::size_t k) { return cone.direction(k); }, cone.rays(), record, cluster);
}

void build_from_fan(const RecordInput& input, std::uint32_t vertex, std::size_t lane, std::uint32_t edge_count,
                    const VertexFanCones& cones, Record& record, ClusterBuild& cluster) {
  const bool is_certain = ((cones.is_uncertain >> lane) & 1U) == 0;
  const std::uint32_t rays = cones.ray_count[lane];
  if (rays == 0 && is_certain) return;
  const auto direction = [&](std::size_t k) {
    const SixteenVectors& all = cones.direction[k];
    return Vec3f{all[0][lane], all[1][lane], all[2][lane]};
  };
  ChosenPlanes planes;
  planes.choose(is_certain ? cones.facets[lane] : (1U << edge_count) - 1, direction);
  const bool are_rays_known = is_certain && rays <= VertexFanCones::most_rays;
  finish_vertex(input, vertex, planes, direction,
                std::span<const Vec3f>(cones.rays[lane].data(), are_rays_known ? rays : 0), record, cluster);
}

using kernels::EdgeShape;

/// Finds the unit direction that leads from an edge into one of its triangles, perpendicular to the edge. Returns false
/// if the triangle is missing or too flat.
bool in_face_direction(const RecordInput& input, const FaceFacts& facts, std::uint32_t triangle, const Segment& edge,
                       const Vec3d& tangent, Vec3d& direction) {
  if (triangle == no_index) return false;
  const Vec3d& normal = facts.normals[triangle];
  if (normal == Vec3d{}) return false;
  const Triangle& t = input.mesh.triangles[triangle];
  direction = kernels::in_face_direction(normal, tangent, kernels::runs_along(t, edge));
  return true;
}

/// Sets the two directions that bound an edge's domain. If the domain is not bounded by two directions, they are set to
/// zero; the reach is then unlimited.
void set_edge_reach(const EdgeShape& edge, std::size_t lane, ClusterBuild& cluster) {
  Vec3d border[2];
  const bool is_clear = kernels::edge_borders(edge, border);
  cluster.set_direction(lane, 0, is_clear ? border[0] : Vec3d{});
  cluster.set_direction(lane, 1, is_clear ? border[1] : Vec3d{});
  if (is_clear) {
    cluster.directions.add(std::array{to_float(border[0]), to_float(border[1])});
  } else {
    cluster.directions.add({});
  }
}

void build_edge(const RecordInput& input, const FaceFacts& facts, std::uint32_t index, std::size_t lane, Record& record,
                ClusterBuild& cluster) {
  const Segment& ends = input.sites.edges()[index];
  EdgeShape edge;
  edge.start = input.positions[ends[0]];
  edge.end = input.positions[ends[1]];
  edge.length = length(edge.end - edge.start);
  if (!(edge.length > negligible_length)) return;
  edge.tangent = unit(edge.end - edge.start, edge.length);

  const auto& faces = input.adjacency.edge_faces[index];
  edge.has_first = in_face_direction(input, facts, faces[0], ends, edge.tangent, edge.first);
  edge.has_second = in_face_direction(input, facts, faces[1], ends, edge.tangent, edge.second);
  if (edge.has_second && !edge.has_first) {
    std::swap(edge.first, edge.second);
    std::swap(edge.has_first, edge.has_second);
  }
  kernels::write_edge(edge, edge.has_second ? facts.normals[faces[0]] : Vec3d{}, record);
  record.id = static_cast<std::uint32_t>(input.mesh.vertices.size()) + index;
  cluster.box.extend(edge.start);
  cluster.box.extend(edge.end);
  set_edge_reach(edge, lane, cluster);
  cluster.set_corner(lane, 0, edge.start);
  cluster.set_corner(lane, 1, edge.end);
  cluster.set_corner(lane, 2, edge.end);
}

using kernels::FaceShape;

std::uint32_t face_site(const RecordInput& input, std::uint32_t triangle) {
  return static_cast<std::uint32_t>(input.mesh.vertices.size() + input.sites.edge_count()) + triangle;
}

void build_face(const RecordInput& input, std::uint32_t triangle, std::size_t lane, FaceFacts& facts, Record& record,
                ClusterBuild& cluster) {
  const auto corners = input.corners(triangle);
  const FaceShape shape = kernels::shape_of_face(corners[0], corners[1], corners[2]);
  facts.normals[triangle] = shape.has_normal ? shape.normal : Vec3d{};
  facts.is_sliver[triangle] = !shape.is_negligible && shape.is_sliver ? 1 : 0;
  if (!shape.has_record()) return;
  kernels::write_face(shape, record);
  record.id = face_site(input, triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    cluster.box.extend(corners[k]);
    cluster.set_corner(lane, k, corners[k]);
  }
  cluster.set_direction(lane, 0, shape.normal);
  cluster.set_direction(lane, 1, -shape.normal);
  cluster.directions.add(std::array{to_float(shape.normal)});
}

void build_sliver(const RecordInput& input, std::uint32_t triangle, Record& record, ClusterBuild& cluster) {
  const auto corners = input.corners(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    store(record, SliverColumns::corners + 3 * static_cast<int>(k), corners[k]);
    cluster.box.extend(corners[k]);
  }
  record.id = face_site(input, triangle);
  cluster.directions.add({});
}

}  // namespace

void prefetch_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead) {
  for (const std::uint32_t vertex : sites) {
    const std::span<const std::uint32_t> neighbours = neighbours_of(input, vertex);
    if (ahead == Ahead::far) {
      prefetch(neighbours.data());
    } else {
      prefetch(&input.positions[vertex]);
      for (const std::uint32_t neighbour : neighbours) prefetch(&input.positions[neighbour]);
    }
  }
}

void build_vertices(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                    ClusterBuild& cluster) {
  VertexFans fans;
  for (std::size_t lane = 0; lane < sites.size(); ++lane) {
    if (fits_fan(neighbours_of(input, sites[lane]).size())) add_fan(input, sites[lane], lane, fans);
  }
  VertexFanCones cones;
  find_fan_cones(fans, cones);
  for (std::size_t lane = 0; lane < sites.size(); ++lane) {
    if (fans.count[lane] >= 3) {
      build_from_fan(input, sites[lane], lane, fans.count[lane], cones, records[lane], cluster);
    } else {
      build_alone(input, sites[lane], records[lane], cluster);
    }
  }
}

void prefetch_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                    Ahead ahead) {
  for (const std::uint32_t e : sites) {
    if (ahead == Ahead::far) {
      prefetch(&input.sites.edges()[e]);
      prefetch(&input.adjacency.edge_faces[e]);
      continue;
    }
    for (const std::uint32_t v : input.sites.edges()[e]) prefetch(&input.positions[v]);
    for (const std::uint32_t t : input.adjacency.edge_faces[e]) {
      if (t == no_index) continue;
      prefetch(&facts.normals[t]);
      prefetch(&input.mesh.triangles[t]);
    }
  }
}

void build_edges(const RecordInput& input, const FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster) {
  for (std::size_t lane = 0; lane < sites.size(); ++lane) {
    build_edge(input, facts, sites[lane], lane, records[lane], cluster);
  }
}

void prefetch_faces(const RecordInput& input, std::span<const std::uint32_t> sites, Ahead ahead) {
  for (const std::uint32_t t : sites) {
    if (ahead == Ahead::far) {
      prefetch(&input.mesh.triangles[t]);
    } else {
      for (const std::uint32_t v : input.mesh.triangles[t]) prefetch(&input.positions[v]);
    }
  }
}

void build_faces(const RecordInput& input, FaceFacts& facts, std::span<const std::uint32_t> sites,
                 std::span<Record> records, ClusterBuild& cluster) {
  for (std::size_t lane = 0; lane < sites.size(); ++lane) {
    build_face(input, sites[lane], lane, facts, records[lane], cluster);
  }
}

void build_slivers(const RecordInput& input, std::span<const std::uint32_t> sites, std::span<Record> records,
                   ClusterBuild& cluster) {
  for (std::size_t lane = 0; lane < sites.size(); ++lane) build_sliver(input, sites[lane], records[lane], cluster);
}

}  // namespace blum::cpu
