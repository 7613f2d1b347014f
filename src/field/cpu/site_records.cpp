#include "field/cpu/site_records.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "blum/core/parallel.hpp"
#include "field/cpu/direction_cone.hpp"
#include "field/cpu/reach.hpp"
#include "field/cpu/record_geometry.hpp"
#include "field/cpu/vertex_cone.hpp"

namespace blum::cpu {
namespace {

constexpr std::size_t clusters_per_range = 64;
/// Shorter or flatter than this, in a frame whose diagonal is about one, float32 cannot tell a site from its border.
constexpr double negligible_length = 1e-12;
constexpr double negligible_altitude = 1e-7;
/// Above this, rounding of a face's barycentrics would reach beyond its corners (docs/theory/fields.md).
constexpr double largest_condition = 64;
/// A normal is trusted only if rounding in double cannot have turned it by more than about 1e-9.
constexpr double smallest_relative_altitude = 1e-7;

void store(Record& record, int column, const Vec3d& v) {
  const auto at = static_cast<std::size_t>(column);
  record.column[at] = static_cast<float>(v.x);
  record.column[at + 1] = static_cast<float>(v.y);
  record.column[at + 2] = static_cast<float>(v.z);
}

void store(Record& record, int column, double x) {
  record.column[static_cast<std::size_t>(column)] = static_cast<float>(x);
}

/// What the builders of all kinds share.
struct Input {
  const MeshView& mesh;
  const SiteTable& sites;
  const Adjacency& adjacency;
  std::span<const Vec3d> positions;
  /// Unit normals; zero for triangles too flat to trust one.
  std::span<const Vec3d> face_normals;

  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t triangle) const {
    const Triangle& t = mesh.triangles[triangle];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
};

/// A cluster while it is built.
struct ClusterBuild {
  Box3 box;
  ReachInput reach;
  DirectionCone directions;

  void set_corner(std::size_t lane, std::size_t which, const Vec3d& p) { set(reach.corner[which], lane, p); }
  void set_direction(std::size_t lane, std::size_t which, const Vec3d& w) { set(reach.direction[which], lane, w); }

 private:
  static void set(SixteenVectors& v, std::size_t lane, const Vec3d& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) v[axis][lane] = static_cast<float>(value[axis]);
  }
};

/// Builds the record of one site and adds it to its cluster; returns false where the site can own no node.
bool build_vertex(const Input& input, std::uint32_t vertex, std::size_t /*lane*/, Record& record,
                  ClusterBuild& cluster) {
  const Vec3d& p = input.positions[vertex];
  VertexCone cone;
  for (std::uint32_t k = input.adjacency.first_incident[vertex]; k < input.adjacency.first_incident[vertex + 1]; ++k) {
    const Segment& edge = input.sites.edges()[input.adjacency.incident_edges[k]];
    const Vec3d direction = input.positions[edge[0] == vertex ? edge[1] : edge[0]] - p;
    const double length_of_edge = length(direction);
    if (length_of_edge > negligible_length) cone.add(direction / length_of_edge);
  }
  if (!cone.find_facets()) return false;
  store(record, VertexColumns::position, p);
  for (std::size_t k = 0; k < cone.chosen_count(); ++k) {
    store(record, VertexColumns::direction + 3 * static_cast<int>(k), cone.chosen(k));
  }
  record.id = vertex;
  cluster.box.extend(p);
  cluster.directions.add(cone.rays());
  return true;
}

Vec3d any_perpendicular(const Vec3d& t) {
  const Vec3d axis = std::abs(t.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d b = cross(t, axis);
  return b / length(b);
}

/// Unit direction that leaves an edge into one of its triangles; false if the triangle is too flat to have one.
bool in_face_direction(const Input& input, std::uint32_t triangle, const Segment& edge, const Vec3d& tangent,
                       Vec3d& direction) {
  if (triangle == no_index) return false;
  const Vec3d& normal = input.face_normals[triangle];
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

bool build_edge(const Input& input, std::uint32_t index, std::size_t lane, Record& record, ClusterBuild& cluster) {
  const Segment& edge = input.sites.edges()[index];
  const Vec3d& start = input.positions[edge[0]];
  const Vec3d& end = input.positions[edge[1]];
  const double length_of_edge = length(end - start);
  if (!(length_of_edge > negligible_length)) return false;
  const Vec3d tangent = (end - start) / length_of_edge;

  Vec3d first;
  Vec3d second;
  const auto& faces = input.adjacency.edge_faces[index];
  bool has_first = in_face_direction(input, faces[0], edge, tangent, first);
  bool has_second = in_face_direction(input, faces[1], edge, tangent, second);
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
    store(record, EdgeColumns::side, is_folded ? 0.0 : dot(input.face_normals[faces[0]], n) > 0 ? 1.0 : -1.0);
  }
  record.id = static_cast<std::uint32_t>(input.mesh.vertices.size()) + index;
  cluster.box.extend(start);
  cluster.box.extend(end);
  set_edge_reach(has_first && has_second, first, second, tangent, lane, cluster);
  cluster.set_corner(lane, 0, start);
  cluster.set_corner(lane, 1, end);
  cluster.set_corner(lane, 2, end);
  return true;
}

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
  shape.normal = area_normal / shape.doubled_area;
  shape.has_normal = shape.doubled_area > smallest_relative_altitude * squared_longest;
  shape.is_negligible = !(squared_area > negligible_altitude * negligible_altitude * squared_longest);
  // |grad u| |to_u| + |grad v| |to_v|, with |grad u| = |to_v| / doubled area and the other way round.
  const double squared_sides = squared_side[(opposite + 1) % 3] * squared_side[(opposite + 2) % 3];
  shape.is_sliver = 4 * squared_sides > largest_condition * largest_condition * squared_area;
  return shape;
}

/// What is computed once per triangle, before its edges ask for it.
struct FaceFacts {
  std::vector<Vec3d> normals;
  std::vector<std::uint8_t> is_sliver;

  FaceFacts(const Input& input, const Context& context)
      : normals(input.mesh.triangles.size()), is_sliver(input.mesh.triangles.size()) {
    parallel_for(context, normals.size(), clusters_per_range * cluster_size, "", [&](const WorkRange& range) {
      for (std::size_t t = range.begin; t < range.end; ++t) {
        const FaceShape shape = shape_of_face(input.corners(static_cast<std::uint32_t>(t)));
        if (shape.has_normal) normals[t] = shape.normal;
        is_sliver[t] = !shape.is_negligible && shape.is_sliver ? 1 : 0;
      }
    });
  }
};

bool build_face(const Input& input, std::uint32_t triangle, std::size_t lane, Record& record, ClusterBuild& cluster) {
  const auto corners = input.corners(triangle);
  const FaceShape shape = shape_of_face(corners);
  if (shape.is_negligible || shape.is_sliver) return false;
  store(record, FaceColumns::anchor, shape.anchor);
  store(record, FaceColumns::normal, shape.normal);
  store(record, FaceColumns::minus_u, cross(shape.normal, shape.to_v) / shape.doubled_area);
  store(record, FaceColumns::minus_v, cross(shape.to_u, shape.normal) / shape.doubled_area);
  record.id = static_cast<std::uint32_t>(input.mesh.vertices.size() + input.sites.edge_count()) + triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    cluster.box.extend(corners[k]);
    cluster.set_corner(lane, k, corners[k]);
  }
  cluster.set_direction(lane, 0, shape.normal);
  cluster.set_direction(lane, 1, -shape.normal);
  cluster.directions.add(std::array{to_float(shape.normal)});
  return true;
}

bool build_sliver(const Input& input, std::uint32_t triangle, std::size_t /*lane*/, Record& record,
                  ClusterBuild& cluster) {
  const auto corners = input.corners(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    store(record, SliverColumns::corners + 3 * static_cast<int>(k), corners[k]);
    cluster.box.extend(corners[k]);
  }
  record.id = static_cast<std::uint32_t>(input.mesh.vertices.size() + input.sites.edge_count()) + triangle;
  return true;
}

void store_box(BoxArrays& boxes, std::size_t index, const Box3& box, float reach) {
  constexpr float rounding = 2e-7F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    boxes.lower[axis][index] = box.is_empty() ? far_away : static_cast<float>(box.lower[axis]) - rounding;
    boxes.upper[axis][index] = box.is_empty() ? far_away : static_cast<float>(box.upper[axis]) + rounding;
  }
  boxes.reach[index] = reach;
}

void store_cone(ConeArrays& cones, std::size_t index, const DirectionCone::Result& cone) {
  for (std::size_t axis = 0; axis < 3; ++axis) cones.axis[axis][index] = cone.axis[axis];
  cones.cosine[index] = cone.cosine;
  cones.sine[index] = cone.sine;
}

/// Writes the reaches of a cluster's records into them; returns the largest.
template <Kind kind>
float store_reaches(const ClusterBuild& cluster, const SurfacePoints& points, std::size_t rank,
                    std::span<Record> records) {
  if constexpr (kind != edge_kind && kind != face_kind) return far_away;
  SixteenFloats first;
  SixteenFloats second;
  find_reaches(cluster.reach, points, rank, kind == edge_kind, first, second);
  float largest = 0;
  for (std::size_t lane = 0; lane < records.size(); ++lane) {
    Record& record = records[lane];
    if (record.id == dead_record) continue;
    if constexpr (kind == edge_kind) {
      record.column[EdgeColumns::reach] = first[lane];
    } else {
      record.column[FaceColumns::reach_above] = first[lane];
      record.column[FaceColumns::reach_below] = second[lane];
    }
    largest = std::max({largest, first[lane], kind == edge_kind ? 0.0F : second[lane]});
  }
  return largest;
}

/// Builds all records of a kind.
/// @param rank_of  callable: site index -> a place on the Morton curve near it.
template <Kind kind, class Build, class RankOf>
void build_set(const Input& input, std::span<const std::uint32_t> order, const SurfacePoints& points,
               const Context& context, RecordSet& set, Build build, RankOf rank_of) {
  set.count = order.size();
  const std::size_t clusters = (order.size() + cluster_size - 1) / cluster_size;
  if (set.records.size() < clusters * cluster_size) set.records = Buffer<Record>(clusters * cluster_size);
  set.cluster_boxes.resize(clusters);
  set.cluster_cones.resize(clusters);
  parallel_for(context, clusters, clusters_per_range, "", [&](const WorkRange& range) {
    for (std::size_t index = range.begin; index < range.end; ++index) {
      ClusterBuild cluster{};
      const std::size_t first = index * cluster_size;
      for (std::size_t lane = 0; lane < cluster_size; ++lane) {
        Record record;
        const std::size_t at = first + lane;
        if (at >= order.size() || !build(input, order[at], lane, record, cluster)) record.id = dead_record;
        set.records[at] = record;
      }
      const std::size_t middle = std::min(first + cluster_size / 2, order.size() - 1);
      const float reach =
          store_reaches<kind>(cluster, points, rank_of(order[middle]), {set.records.data() + first, cluster_size});
      store_box(set.cluster_boxes, index, cluster.box, reach);
      if (kind == sliver_kind) cluster.directions.add({});
      store_cone(set.cluster_cones, index, cluster.directions.finish());
    }
  });
}

/// Vertex positions along the Morton curve.
SurfacePoints surface_points(std::span<const Vec3d> positions, const SiteOrder& order, const Context& context) {
  SurfacePoints points;
  for (auto& coordinate : points.coordinate) coordinate.resize(order.vertices.size());
  parallel_for(context, order.vertices.size(), clusters_per_range * cluster_size, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const Vec3d& p = positions[order.vertices[k]];
      for (std::size_t axis = 0; axis < 3; ++axis) points.coordinate[axis][k] = static_cast<float>(p[axis]);
    }
  });
  return points;
}

}  // namespace

void BoxArrays::resize(std::size_t new_count) {
  // Whole vectors of boxes are read at a time, so the tail is padded with boxes around nothing.
  const std::size_t padded = (new_count + cluster_size - 1) / cluster_size * cluster_size;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (auto* side : {&lower[axis], &upper[axis]}) {
      if (side->size() < padded) *side = Buffer<float>(padded);
      std::fill(side->begin() + static_cast<std::ptrdiff_t>(new_count),
                side->begin() + static_cast<std::ptrdiff_t>(padded), far_away);
    }
  }
  if (reach.size() < padded) reach = Buffer<float>(padded);
  std::fill(reach.begin() + static_cast<std::ptrdiff_t>(new_count), reach.begin() + static_cast<std::ptrdiff_t>(padded),
            0.0F);
  count = new_count;
}

void ConeArrays::resize(std::size_t count) {
  const std::size_t padded = (count + cluster_size - 1) / cluster_size * cluster_size;
  for (Buffer<float>* values : {&axis[0], &axis[1], &axis[2], &cosine, &sine}) {
    if (values->size() < padded) *values = Buffer<float>(padded, 0.0F);
  }
}

void build_site_records(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        std::span<const Vec3d> positions, const SiteOrder& order, const Context& context,
                        SiteRecords& out) {
  Input input{mesh, sites, adjacency, positions, {}};
  const FaceFacts facts(input, context);
  input.face_normals = facts.normals;
  std::vector<std::uint32_t> slivers;
  std::copy_if(order.faces.begin(), order.faces.end(), std::back_inserter(slivers),
               [&](std::uint32_t t) { return facts.is_sliver[t] != 0; });
  const SurfacePoints points = surface_points(positions, order, context);
  const auto build = [&]<Kind kind>(std::span<const std::uint32_t> sites_in_order, auto build_one, auto rank_of) {
    build_set<kind>(input, sites_in_order, points, context, out.kinds[kind], build_one, rank_of);
  };
  const auto no_rank = [](std::uint32_t) { return std::size_t{0}; };
  build.operator()<vertex_kind>(order.vertices, build_vertex, no_rank);
  build.operator()<edge_kind>(order.edges, build_edge,
                              [&](std::uint32_t e) -> std::size_t { return order.rank[sites.edges()[e][0]]; });
  build.operator()<face_kind>(order.faces, build_face,
                              [&](std::uint32_t t) -> std::size_t { return order.rank[mesh.triangles[t][0]]; });
  build.operator()<sliver_kind>(slivers, build_sliver, no_rank);
}

}  // namespace blum::cpu
