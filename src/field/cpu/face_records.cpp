#include <algorithm>
#include <cmath>

#include "field/cpu/record_build.hpp"
#include "field/cpu/record_geometry.hpp"

namespace blum::cpu {
namespace {

constexpr double negligible_altitude = 1e-7;
/// Above this, rounding of a face's barycentrics would reach beyond its corners (docs/theory/fields.md).
constexpr double largest_condition = 64;
/// A normal is trusted only if rounding in double cannot have turned it by more than about 1e-9.
constexpr double smallest_relative_altitude = 1e-7;

/// A face's shape as its record needs it: corners with the anchor first, and how well-conditioned they are.
struct FaceShape {
  Vec3d anchor, to_u, to_v, normal;
  double doubled_area = 0;
  bool is_negligible = true;
  bool is_sliver = false;
  bool has_normal = false;
};

FaceShape shape_of_face(const std::array<Vec3d, 3>& corner) {
  const std::array<double, 3> squared_side{squared_length(corner[2] - corner[1]), squared_length(corner[0] - corner[2]),
                                           squared_length(corner[1] - corner[0])};
  const auto opposite =
      static_cast<std::size_t>(std::max_element(squared_side.begin(), squared_side.end()) - squared_side.begin());
  FaceShape shape;
  shape.anchor = corner[opposite];
  shape.to_u = corner[(opposite + 1) % 3] - shape.anchor;
  shape.to_v = corner[(opposite + 2) % 3] - shape.anchor;
  const Vec3d area_normal = cross(shape.to_u, shape.to_v);
  const double squared_longest = squared_side[opposite];
  const double squared_area = squared_length(area_normal);
  if (!(squared_area > 0)) return shape;
  shape.doubled_area = std::sqrt(squared_area);
  shape.normal = unit(area_normal, shape.doubled_area);
  shape.has_normal = shape.doubled_area > smallest_relative_altitude * squared_longest;
  shape.is_negligible = !(squared_area > negligible_altitude * negligible_altitude * squared_longest);
  // |grad u| |to_u| + |grad v| |to_v|, with |grad u| = |to_v| / doubled area and the other way round.
  const double squared_sides = squared_side[(opposite + 1) % 3] * squared_side[(opposite + 2) % 3];
  shape.is_sliver = 4 * squared_sides > largest_condition * largest_condition * squared_area;
  return shape;
}

std::uint32_t face_site(const RecordInput& input, std::uint32_t triangle) {
  return static_cast<std::uint32_t>(input.mesh.vertices.size() + input.sites.edge_count()) + triangle;
}

void build_face(const RecordInput& input, std::uint32_t triangle, std::size_t lane, FaceFacts& facts, Record& record,
                ClusterBuild& cluster) {
  const auto corners = input.corners(triangle);
  const FaceShape shape = shape_of_face(corners);
  facts.normals[triangle] = shape.has_normal ? shape.normal : Vec3d{};
  facts.is_sliver[triangle] = !shape.is_negligible && shape.is_sliver ? 1 : 0;
  if (shape.is_negligible || shape.is_sliver) return;
  store(record, FaceColumns::anchor, shape.anchor);
  store(record, FaceColumns::normal, shape.normal);
  store(record, FaceColumns::minus_u, unit(cross(shape.normal, shape.to_v), shape.doubled_area));
  store(record, FaceColumns::minus_v, unit(cross(shape.to_u, shape.normal), shape.doubled_area));
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
