#include <cmath>
#include <utility>

#include "field/cpu/record_build.hpp"
#include "field/cpu/record_geometry.hpp"

namespace blum::cpu {
namespace {

Vec3d any_perpendicular(const Vec3d& t) {
  const Vec3d axis = std::abs(t.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d b = cross(t, axis);
  return b / length(b);
}

/// Unit direction that leaves an edge into one of its triangles; false if the triangle is too flat to have one.
bool in_face_direction(const RecordInput& input, const FaceFacts& facts, std::uint32_t triangle, const Segment& edge,
                       const Vec3d& tangent, Vec3d& direction) {
  if (triangle == no_index) return false;
  const Vec3d& normal = facts.normals[triangle];
  if (normal == Vec3d{}) return false;
  const Triangle& t = input.mesh.triangles[triangle];
  const bool is_forward = (t[0] == edge[0] && t[1] == edge[1]) || (t[1] == edge[0] && t[2] == edge[1]) ||
                          (t[2] == edge[0] && t[0] == edge[1]);
  direction = is_forward ? cross(normal, tangent) : cross(tangent, normal);
  return true;
}

/// The directions between which an edge's domain lies: perpendicular to each of its faces, away from the other.
/// A zero direction stands for a domain without such bounds, whose reach is unlimited.
void set_edge_reach(bool has_both, const Vec3d& first, const Vec3d& second, const Vec3d& tangent, std::size_t lane,
                    ClusterBuild& cluster) {
  const Vec3d first_normal = has_both ? cross(tangent, first) : Vec3d{};
  const Vec3d second_normal = has_both ? cross(tangent, second) : Vec3d{};
  // Of the two perpendiculars of a face, the domain's border is the one that does not lead into the other face. Where
  // the faces are nearly in one plane both may pass in rounding: then the domain may be a half-plane or more.
  const double side = dot(first_normal, second);
  const bool is_clear = has_both && std::abs(side) > 1e-5;
  if (!is_clear) {
    cluster.set_direction(lane, 0, {});
    cluster.set_direction(lane, 1, {});
    cluster.directions.add({});
    return;
  }
  const std::array<Vec3d, 2> border{side < 0 ? first_normal : -first_normal,
                                    dot(second_normal, first) < 0 ? second_normal : -second_normal};
  cluster.set_direction(lane, 0, border[0]);
  cluster.set_direction(lane, 1, border[1]);
  cluster.directions.add(std::array{to_float(border[0]), to_float(border[1])});
}

void build_edge(const RecordInput& input, const FaceFacts& facts, std::uint32_t index, std::size_t lane, Record& record,
                ClusterBuild& cluster) {
  const Segment& edge = input.sites.edges()[index];
  const Vec3d& start = input.positions[edge[0]];
  const Vec3d& end = input.positions[edge[1]];
  const double length_of_edge = length(end - start);
  if (!(length_of_edge > negligible_length)) return;
  const Vec3d tangent = unit(end - start, length_of_edge);

  Vec3d first;
  Vec3d second;
  const auto& faces = input.adjacency.edge_faces[index];
  bool has_first = in_face_direction(input, facts, faces[0], edge, tangent, first);
  bool has_second = in_face_direction(input, facts, faces[1], edge, tangent, second);
  if (has_second && !has_first) {
    std::swap(first, second);
    std::swap(has_first, has_second);
  }
  if (!has_first) first = any_perpendicular(tangent);
  const Vec3d n = cross(tangent, first);

  store(record, EdgeColumns::midpoint, (start + end) * 0.5);
  store(record, EdgeColumns::tangent, tangent);
  store(record, EdgeColumns::half_length, 0.5 * length_of_edge);
  store(record, EdgeColumns::binormal, first);
  store(record, EdgeColumns::first_limit, has_first ? plane_slack : 1e30);
  if (has_second) {
    store(record, EdgeColumns::second_b, dot(second, first));
    store(record, EdgeColumns::second_n, dot(second, n));
    // Between faces that nearly fold together float32 cannot tell the pseudonormal: left to exact queries.
    const bool is_folded = 1 - dot(second, first) < 1e-5;
    store(record, EdgeColumns::side, is_folded ? 0.0 : dot(facts.normals[faces[0]], n) > 0 ? 1.0 : -1.0);
  }
  record.id = static_cast<std::uint32_t>(input.mesh.vertices.size()) + index;
  cluster.box.extend(start);
  cluster.box.extend(end);
  set_edge_reach(has_first && has_second, first, second, tangent, lane, cluster);
  cluster.set_corner(lane, 0, start);
  cluster.set_corner(lane, 1, end);
  cluster.set_corner(lane, 2, end);
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
