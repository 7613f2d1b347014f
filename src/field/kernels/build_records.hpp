// Blum: builds the records of sites, with one thread per site. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "field/kernels/box_forest.hpp"
#include "field/kernels/connectivity.hpp"
#include "field/kernels/morton.hpp"
#include "field/kernels/normal_frame.hpp"
#include "field/kernels/site_shapes.hpp"
#include "field/kernels/vertex_cone.hpp"

namespace blum::kernels {

/// Computes the normalised positions of the vertices in use, and their Morton codes.
struct PlaceVertices {
  const NormalFrame* frame;
  const Vec3d* vertices;
  const std::uint32_t* named;
  Vec3d* positions;
  std::uint32_t* key;
  std::uint32_t* vertex;

  BLUM_HD void operator()(std::size_t k) const {
    const std::uint32_t v = named[k];
    const Vec3d p = frame->to_normal(vertices[v]);
    positions[v] = p;
    key[k] = morton_code(p);
    vertex[k] = v;
  }
};

/// Stores each vertex's index along the curve, and the vertex positions in that order.
struct RankVertices {
  const std::uint32_t* vertex;
  const Vec3d* positions;
  std::uint32_t* rank;
  Vec3f* surface_points;

  BLUM_HD void operator()(std::size_t k) const {
    rank[vertex[k]] = static_cast<std::uint32_t>(k);
    surface_points[k] = to_float(positions[vertex[k]]);
  }
};

/// Computes keys that sort edges by their first vertex on the curve. FaceKeys does this for faces.
struct EdgeKeys {
  const Segment* edges;
  const std::uint32_t* rank;
  std::uint32_t* key;
  std::uint32_t* edge;

  BLUM_HD void operator()(std::size_t e) const {
    key[e] = smaller(rank[edges[e][0]], rank[edges[e][1]]);
    edge[e] = static_cast<std::uint32_t>(e);
  }
};

struct FaceKeys {
  const Triangle* triangles;
  const std::uint32_t* rank;
  std::uint32_t* key;
  std::uint32_t* face;

  BLUM_HD void operator()(std::size_t t) const {
    key[t] = smaller(smaller(rank[triangles[t][0]], rank[triangles[t][1]]), rank[triangles[t][2]]);
    face[t] = static_cast<std::uint32_t>(t);
  }
};

/// Orders of the sites in which sites that lie close together follow each other. Ties are sorted by site id.
template <class Device>
struct SiteOrder {
  template <class T>
  using Array = typename Device::template Array<T>;

  Array<std::uint32_t> vertices, edges, faces;
  Array<std::uint32_t> rank;    ///< index of each vertex in use in `vertices`
  Array<Vec3d> positions;       ///< normalised positions of the vertices in use
  Array<Vec3f> surface_points;  ///< positions of `vertices`, in the same order
  Array<std::uint32_t> key;     ///< scratch
};

/// Computes the orders. Cost: a radix sort for each kind of site.
template <class Device>
void order_sites(Device& device, const DeviceMesh& mesh, const ConnectivityView& connectivity, const NormalFrame* frame,
                 SiteOrder<Device>& out) {
  const std::size_t named = connectivity.named_count;
  out.positions.resize(mesh.vertex_count);
  out.rank.resize(mesh.vertex_count);
  out.vertices.resize(named);
  out.surface_points.resize(named);
  out.key.resize(named);
  device.for_each(named, PlaceVertices{frame, mesh.vertices, connectivity.named_vertices, out.positions.data(),
                                       out.key.data(), out.vertices.data()});
  device.sort_pairs(out.key, out.vertices, morton_bits);
  device.for_each(named,
                  RankVertices{out.vertices.data(), out.positions.data(), out.rank.data(), out.surface_points.data()});

  const int rank_bits = std::max(1, static_cast<int>(std::bit_width(connectivity.named_count)));
  out.edges.resize(connectivity.edge_count);
  out.key.resize(connectivity.edge_count);
  device.for_each(connectivity.edge_count,
                  EdgeKeys{connectivity.edges, out.rank.data(), out.key.data(), out.edges.data()});
  device.sort_pairs(out.key, out.edges, rank_bits);
  out.faces.resize(mesh.triangle_count);
  out.key.resize(mesh.triangle_count);
  device.for_each(mesh.triangle_count, FaceKeys{mesh.triangles, out.rank.data(), out.key.data(), out.faces.data()});
  device.sort_pairs(out.key, out.faces, rank_bits);
}

/// Finds an upper bound on the distance from a site at which it can be closest. Let p be the corners of the site, and w
/// the directions of its domain. Then a surface point y is closer beyond the distance rho:
///   rho = max over p of |y - p|^2 / (2 min over p, w of w . (y - p)).
/// The reason: for a point p + r w of the domain, |y - (p + r w)|^2 < r^2 is linear in r. Here p varies over a convex
/// set, and w over a cone. The search takes the smallest rho over a few dozen vertices near `rank` on the Morton curve.
struct ReachSearch {
  const Vec3f* points;
  std::uint32_t count;

  /// Returns the bound rho for one site.
  /// @param directions  one or two unit vectors: the domain's only direction, or the two that bound it.
  BLUM_HD float reach(const Vec3f* corners, int corner_count, const Vec3f* directions, int direction_count,
                      std::uint32_t rank) const {
    float best = far_away;
    for (std::uint32_t offset = 0; offset < count; offset += 1 + offset / 6) {
      if (rank + offset < count) {
        best = smaller(best, bound(corners, corner_count, directions, direction_count, points[rank + offset]));
      }
      if (offset <= rank) {
        best = smaller(best, bound(corners, corner_count, directions, direction_count, points[rank - offset]));
      }
    }
    return best + 10 * plane_slack;
  }

 private:
  BLUM_HD static float bound(const Vec3f* corners, int corner_count, const Vec3f* directions, int direction_count,
                             const Vec3f& y) {
    constexpr float rounding = 6e-7F;
    constexpr float safety = 1.002F;
    float squared = 0;
    float along = far_away;
    for (int c = 0; c < corner_count; ++c) {
      const Vec3f gap = y - corners[c];
      squared = larger(squared, squared_length(gap));
      for (int k = 0; k < direction_count; ++k) along = smaller(along, dot(directions[k], gap));
    }
    const float margin = along - rounding;
    return margin > 0 ? squared * (0.5F * safety) / margin : far_away;
  }
};

/// Input of the kernels that build records.
struct RecordSource {
  DeviceMesh mesh;
  ConnectivityView connectivity;
  const Vec3d* positions;
  const std::uint32_t* rank;
  ReachSearch reach;
  /// The kernel of faces writes these normals, and the kernel of edges reads them. They are zero for triangles too flat
  /// for a reliable normal.
  Vec3d* face_normals;

  [[nodiscard]] BLUM_HD std::uint32_t first_face() const { return mesh.vertex_count + connectivity.edge_count; }
};

/// Builds the records of faces. A site that cannot be closest to any node keeps its position, as a dead record in an
/// empty box.
struct BuildFaces {
  RecordSource source;
  const std::uint32_t* order;
  Record* records;
  ReachBox* boxes;

  BLUM_HD void operator()(std::size_t slot) const {
    const std::uint32_t t = order[slot];
    const Triangle& triangle = source.mesh.triangles[t];
    const Vec3d corners[3] = {source.positions[triangle[0]], source.positions[triangle[1]],
                              source.positions[triangle[2]]};
    const FaceShape shape = shape_of_face(corners[0], corners[1], corners[2]);
    source.face_normals[t] = shape.has_normal ? shape.normal : Vec3d{};
    Record record;
    ReachBox box;
    record.id = dead_record;
    if (!shape.is_negligible) {
      record.id = source.first_face() + t;
      const float reach =
          shape.is_sliver ? write_sliver(corners, record) : write_with_reaches(shape, corners, triangle, record);
      box.set(min(min(corners[0], corners[1]), corners[2]), max(max(corners[0], corners[1]), corners[2]), reach);
    }
    records[slot] = record;
    boxes[slot] = box;
  }

 private:
  BLUM_HD static float write_sliver(const Vec3d corners[3], Record& record) {
    for (int k = 0; k < 3; ++k) store(record, SliverColumns::corners + 3 * k, corners[k]);
    store(record, FaceColumns::is_sliver, 1.0);
    return far_away;
  }
  BLUM_HD float write_with_reaches(const FaceShape& shape, const Vec3d corners[3], const Triangle& triangle,
                                   Record& record) const {
    write_face(shape, record);
    const Vec3f rounded[3] = {to_float(corners[0]), to_float(corners[1]), to_float(corners[2])};
    const Vec3f above = to_float(shape.normal);
    const Vec3f below = -above;
    const std::uint32_t rank = source.rank[triangle[0]];
    const float reach_above = source.reach.reach(rounded, 3, &above, 1, rank);
    const float reach_below = source.reach.reach(rounded, 3, &below, 1, rank);
    record.column[FaceColumns::reach_above] = reach_above;
    record.column[FaceColumns::reach_below] = reach_below;
    return larger(reach_above, reach_below);
  }
};

struct BuildEdges {
  RecordSource source;
  const std::uint32_t* order;
  Record* records;
  ReachBox* boxes;

  BLUM_HD void operator()(std::size_t slot) const {
    const std::uint32_t e = order[slot];
    const Segment ends = source.connectivity.edges[e];
    EdgeShape edge;
    edge.start = source.positions[ends[0]];
    edge.end = source.positions[ends[1]];
    edge.length = norm(edge.end - edge.start);
    Record record;
    ReachBox box;
    record.id = dead_record;
    if (edge.length > negligible_length) {
      edge.tangent = unit(edge.end - edge.start, edge.length);
      const auto& faces = source.connectivity.edge_faces[e];
      edge.has_first = find_direction(faces[0], ends, edge.tangent, edge.first);
      edge.has_second = find_direction(faces[1], ends, edge.tangent, edge.second);
      if (edge.has_second && !edge.has_first) {
        edge.first = edge.second;
        edge.has_first = true;
        edge.has_second = false;
      }
      write_edge(edge, edge.has_second ? source.face_normals[faces[0]] : Vec3d{}, record);
      record.id = source.mesh.vertex_count + e;
      const float reach = find_reach(edge, source.rank[ends[0]]);
      record.column[EdgeColumns::reach] = reach;
      box.set(min(edge.start, edge.end), max(edge.start, edge.end), reach);
    }
    records[slot] = record;
    boxes[slot] = box;
  }

 private:
  BLUM_HD bool find_direction(std::uint32_t face, const Segment& ends, const Vec3d& tangent, Vec3d& direction) const {
    if (face == no_index) return false;
    const Vec3d normal = source.face_normals[face];
    if (normal == Vec3d{}) return false;
    const Triangle& t = source.mesh.triangles[face];
    direction = in_face_direction(normal, tangent, runs_along(t, ends));
    return true;
  }
  BLUM_HD float find_reach(const EdgeShape& edge, std::uint32_t rank) const {
    Vec3d borders[2];
    if (!edge_borders(edge, borders)) return far_away;
    const Vec3f corners[2] = {to_float(edge.start), to_float(edge.end)};
    const Vec3f directions[2] = {to_float(borders[0]), to_float(borders[1])};
    return source.reach.reach(corners, 2, directions, 2, rank);
  }
};

struct BuildVertices {
  RecordSource source;
  const std::uint32_t* order;
  Record* records;
  ReachBox* boxes;

  BLUM_HD void operator()(std::size_t slot) const {
    const std::uint32_t v = order[slot];
    const Vec3d p = source.positions[v];
    VertexCone cone;
    for (std::uint32_t k = source.connectivity.first_neighbour[v]; k < source.connectivity.first_neighbour[v + 1];
         ++k) {
      const Vec3d to = source.positions[source.connectivity.neighbours[k]] - p;
      const double distance = norm(to);
      if (distance > negligible_length) cone.add(unit(to, distance));
    }
    Record record;
    ReachBox box;
    record.id = dead_record;
    if (cone.find_facets()) {
      record.id = v;
      store(record, VertexColumns::position, p);
      const ChosenPlanes& planes = cone.planes();
      for (std::size_t k = 0; k < planes.count; ++k) {
        store(record, VertexColumns::direction + 3 * static_cast<int>(k), cone.direction(planes.index[k]));
      }
      box.set(p, p, far_away);
    }
    records[slot] = record;
    boxes[slot] = box;
  }
};

template <class Device>
struct SiteRecords {
  std::array<RecordSet<Device>, kind_count> kinds;
  typename Device::template Array<Vec3d> face_normals;
};

/// Builds the records of all sites and the trees above them. Cost: O(sites).
template <class Device>
Forest build_records(Device& device, const DeviceMesh& mesh, const ConnectivityView& connectivity,
                     const SiteOrder<Device>& order, SiteRecords<Device>& out) {
  out.face_normals.resize(mesh.triangle_count);
  const RecordSource source{mesh,
                            connectivity,
                            order.positions.data(),
                            order.rank.data(),
                            {order.surface_points.data(), connectivity.named_count},
                            out.face_normals.data()};
  Forest forest;
  const auto build = [&]<class Body>(Kind kind, const auto& sites, Body) {
    RecordSet<Device>& set = out.kinds[kind];
    set.records.resize(sites.size());
    set.site_boxes.resize(sites.size());
    device.for_each(sites.size(), Body{source, sites.data(), set.records.data(), set.site_boxes.data()});
    forest.trees[kind] = build_tree(device, set);
  };
  // Faces are built first, because edges read the normals that faces write.
  build(face_kind, order.faces, BuildFaces{});
  build(edge_kind, order.edges, BuildEdges{});
  build(vertex_kind, order.vertices, BuildVertices{});
  return forest;
}

}  // namespace blum::kernels
