#include "field/cpu/record_build.hpp"
#include "field/cpu/vertex_fans.hpp"
#include "field/kernels/vertex_cone.hpp"

namespace blum::cpu {
namespace {

using kernels::ChosenPlanes;
using kernels::VertexCone;

std::span<const std::uint32_t> neighbours_of(const RecordInput& input, std::uint32_t vertex) {
  const std::uint32_t first = input.adjacency.first_neighbour[vertex];
  return std::span(input.adjacency.neighbours).subspan(first, input.adjacency.first_neighbour[vertex + 1] - first);
}

/// Few enough edges for the sixteen-at-a-time path, and enough of them to bound a cone.
bool fits_fan(std::size_t edge_count) {
  return edge_count >= 3 && edge_count <= VertexFans::most;
}

/// Puts a vertex into a lane; edges without extent are left out.
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

/// Writes a vertex whose planes are chosen.
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

}  // namespace blum::cpu
