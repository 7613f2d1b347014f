#include <array>

#include "field/cpu/record_build.hpp"
#include "field/cpu/record_geometry.hpp"
#include "field/kernels/site_shapes.hpp"

namespace blum::cpu {
namespace {

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
