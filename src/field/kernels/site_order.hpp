// Blum: the order in which sites are stored on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "field/kernels/connectivity.hpp"
#include "field/kernels/morton.hpp"
#include "field/kernels/normal_frame.hpp"

namespace blum::kernels {

/// Normalised positions of the named vertices, and their places on the curve.
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

/// Where each vertex ended up, and the surface's vertices along the curve.
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

/// Edges and faces go behind their first vertex on the curve.
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

/// Spatially coherent orders of the sites. Ties keep the sites' own order.
template <class Device>
struct SiteOrder {
  template <class T>
  using Array = typename Device::template Array<T>;

  Array<std::uint32_t> vertices, edges, faces;
  Array<std::uint32_t> rank;    ///< place of each named vertex in `vertices`
  Array<Vec3d> positions;       ///< normalised; of named vertices
  Array<Vec3f> surface_points;  ///< of `vertices`, in their order
  Array<std::uint32_t> key;     ///< scratch
};

/// Cost: a radix sort of the sites of each kind.
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

}  // namespace blum::kernels
