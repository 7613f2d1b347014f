#include <array>
#include <utility>

#include "field/cpu/record_build.hpp"
#include "field/cpu/record_geometry.hpp"
#include "field/kernels/site_shapes.hpp"

namespace blum::cpu {
namespace {

using kernels::EdgeShape;

/// Unit direction that leaves an edge into one of its triangles; false if the triangle is too flat to have one.
bool in_face_direction(const RecordInput& input, const FaceFacts& facts, std::uint32_t triangle, const Segment& edge,
                       const Vec3d& tangent, Vec3d& direction) {
  if (triangle == no_index) return false;
  const Vec3d& normal = facts.normals[triangle];
  if (normal == Vec3d{}) return false;
  const Triangle& t = input.mesh.triangles[triangle];
  direction = kernels::in_face_direction(normal, tangent, kernels::runs_along(t, edge));
  return true;
}

/// The directions between which an edge's domain lies. A zero direction stands for a domain without such bounds, whose
/// reach is unlimited.
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

}  // namespace

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

}  // namespace blum::cpu
