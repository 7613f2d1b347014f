// Blum: the edges of a mesh, with their triangles and neighbours, on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "blum/geometry/triangle_mesh.hpp"
#include "field/kernels/host_device.hpp"

namespace blum::kernels {

inline constexpr std::uint32_t no_index = 0xffffffff;

/// Mesh in the memory of a device.
struct DeviceMesh {
  const Vec3d* vertices = nullptr;
  const Triangle* triangles = nullptr;
  const Segment* segments = nullptr;
  const std::uint32_t* points = nullptr;
  std::uint32_t vertex_count = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t segment_count = 0;
  std::uint32_t point_count = 0;

  /// Returns the number of borders: three sides per triangle, and one border per segment.
  [[nodiscard]] std::size_t border_count() const { return std::size_t{3} * triangle_count + segment_count; }
  [[nodiscard]] std::size_t corner_count() const {
    return std::size_t{3} * triangle_count + std::size_t{2} * segment_count + point_count;
  }
  /// Returns the k-th entry of the list of all corners. A vertex occurs once for each triangle corner, segment end or
  /// point that uses it.
  [[nodiscard]] BLUM_HD std::uint32_t corner(std::size_t k) const {
    const std::size_t of_triangles = std::size_t{3} * triangle_count;
    if (k < of_triangles) return triangles[k / 3][k % 3];
    k -= of_triangles;
    const std::size_t of_segments = std::size_t{2} * segment_count;
    return k < of_segments ? segments[k / 2][k % 2] : points[k - of_segments];
  }
};

/// Connectivity of a mesh. Connectivity depends only on the mesh's indices, so it stays valid while the mesh deforms.
/// Edges have the same numbers as in SiteTable.
struct ConnectivityView {
  const Segment* edges = nullptr;  ///< smaller vertex first, sorted
  /// Two triangles of each edge, further ones are left out. no_index fills missing entries.
  const std::array<std::uint32_t, 2>* edge_faces = nullptr;
  const std::uint32_t* named_vertices = nullptr;  ///< ascending
  const std::uint32_t* first_neighbour = nullptr;
  const std::uint32_t* neighbours = nullptr;  ///< neighbours of vertex v: [first_neighbour[v], first_neighbour[v + 1]).
  /// For each edge: traversals by triangles from its smaller to its larger vertex, minus those in the other direction.
  const std::int32_t* balance = nullptr;
  std::uint32_t edge_count = 0;
  std::uint32_t named_count = 0;
};

/// Marks the vertices in use.
struct MarkNamed {
  DeviceMesh mesh;
  std::uint32_t* is_named;
  BLUM_HD void operator()(std::size_t k) const { is_named[mesh.corner(k)] = 1; }
};

struct ListNamed {
  const std::uint32_t* is_named;
  const std::uint32_t* place;
  std::uint32_t* named;
  BLUM_HD void operator()(std::size_t v) const {
    if (is_named[v] != 0) named[place[v]] = static_cast<std::uint32_t>(v);
  }
};

/// Computes a key for each side of each triangle, and for each segment. The key consists of both ends, the smaller end
/// first. Sides whose ends are equal are sorted to the end.
struct BorderKeys {
  DeviceMesh mesh;
  int vertex_bits;
  std::uint64_t* key;
  std::uint32_t* border;

  BLUM_HD void operator()(std::size_t k) const {
    const std::size_t of_triangles = std::size_t{3} * mesh.triangle_count;
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    if (k < of_triangles) {
      a = mesh.triangles[k / 3][k % 3];
      b = mesh.triangles[k / 3][(k % 3 + 1) % 3];
    } else {
      a = mesh.segments[k - of_triangles][0];
      b = mesh.segments[k - of_triangles][1];
    }
    const std::uint64_t low = smaller(a, b);
    const std::uint64_t high = larger(a, b);
    key[k] = a == b ? std::uint64_t{1} << (2 * vertex_bits) : (low << vertex_bits) | high;
    border[k] = static_cast<std::uint32_t>(k);
  }
};

struct FirstOfKey {
  const std::uint64_t* key;
  int vertex_bits;
  std::uint32_t* is_first;
  BLUM_HD void operator()(std::size_t k) const {
    const bool is_edge = (key[k] >> (2 * vertex_bits)) == 0;
    is_first[k] = is_edge && (k == 0 || key[k - 1] != key[k]) ? 1 : 0;
  }
};

struct WriteEdges {
  const std::uint64_t* key;
  const std::uint32_t* border;
  const std::uint32_t* is_first;
  const std::uint32_t* place;
  std::size_t count;
  int vertex_bits;
  DeviceMesh mesh;
  Segment* edges;
  std::array<std::uint32_t, 2>* edge_faces;
  std::int32_t* balance;

  BLUM_HD void operator()(std::size_t k) const {
    if (is_first[k] == 0) return;
    const std::uint64_t mask = (std::uint64_t{1} << vertex_bits) - 1;
    const Segment edge{static_cast<std::uint32_t>(key[k] >> vertex_bits), static_cast<std::uint32_t>(key[k] & mask)};
    std::uint32_t faces[2] = {no_index, no_index};
    std::uint32_t found = 0;
    std::int32_t sum = 0;
    for (std::size_t at = k; at < count && key[at] == key[k]; ++at) {
      const std::uint32_t t = border[at] / 3;
      if (t >= mesh.triangle_count) continue;
      if (found < 2) faces[found++] = t;
      sum += mesh.triangles[t][border[at] % 3] == edge[0] ? 1 : -1;
    }
    edges[place[k]] = edge;
    edge_faces[place[k]] = {faces[0], faces[1]};
    balance[place[k]] = sum;
  }
};

/// Lists the pair (end, other end) for both ends of each edge. The pairs are sorted later.
struct NeighbourPairs {
  const Segment* edges;
  std::uint32_t* key;
  std::uint32_t* neighbour;
  BLUM_HD void operator()(std::size_t k) const {
    key[k] = edges[k / 2][k % 2];
    neighbour[k] = edges[k / 2][1 - k % 2];
  }
};

/// Finds the index of the first pair of each vertex.
struct FirstNeighbour {
  const std::uint32_t* key;
  std::uint32_t count;
  std::uint32_t* first;
  BLUM_HD void operator()(std::size_t v) const {
    std::uint32_t low = 0;
    std::uint32_t high = count;
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      if (key[middle] < v) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    first[v] = low;
  }
};

template <class Device>
struct Connectivity {
  template <class T>
  using Array = typename Device::template Array<T>;

  Array<Segment> edges;
  Array<std::array<std::uint32_t, 2>> edge_faces;
  Array<std::uint32_t> named_vertices;
  Array<std::uint32_t> first_neighbour;
  Array<std::uint32_t> neighbours;
  Array<std::int32_t> balance;
  std::uint32_t edge_count = 0;
  std::uint32_t named_count = 0;
  /// Scratch memory. It is kept so that the next mesh allocates nothing.
  struct Scratch {
    Array<std::uint32_t> flags, sums, border;
    Array<std::uint64_t> key;
  };
  Scratch scratch;

  [[nodiscard]] ConnectivityView view() const {
    return {edges.data(),
            edge_faces.data(),
            named_vertices.data(),
            first_neighbour.data(),
            neighbours.data(),
            balance.data(),
            edge_count,
            named_count};
  }
};

/// Returns the sum of all flags, from the flags and their exclusive sums. Waits for the device.
template <class Device>
std::uint32_t total_of(Device& device, const typename Device::template Array<std::uint32_t>& flags,
                       const typename Device::template Array<std::uint32_t>& sums) {
  if (flags.size() == 0) return 0;
  std::uint32_t last[2] = {};
  device.download(flags.data() + flags.size() - 1, 1, &last[0]);
  device.download(sums.data() + sums.size() - 1, 1, &last[1]);
  return last[0] + last[1];
}

/// Builds the connectivity of a mesh. Cost: two sorts, of all borders and of both ends of all edges.
template <class Device>
void build_connectivity(Device& device, const DeviceMesh& mesh, Connectivity<Device>& out) {
  auto& [flags, sums, border, key] = out.scratch;
  flags.resize(mesh.vertex_count);
  device.fill(flags, 0U);
  device.for_each(mesh.corner_count(), MarkNamed{mesh, flags.data()});
  device.exclusive_sum(flags, sums);
  out.named_count = total_of(device, flags, sums);
  out.named_vertices.resize(out.named_count);
  device.for_each(mesh.vertex_count, ListNamed{flags.data(), sums.data(), out.named_vertices.data()});

  const int vertex_bits = static_cast<int>(std::bit_width(mesh.vertex_count));
  const std::size_t borders = mesh.border_count();
  key.resize(borders);
  border.resize(borders);
  device.for_each(borders, BorderKeys{mesh, vertex_bits, key.data(), border.data()});
  device.sort_pairs(key, border, 2 * vertex_bits + 1);
  flags.resize(borders);
  device.for_each(borders, FirstOfKey{key.data(), vertex_bits, flags.data()});
  device.exclusive_sum(flags, sums);
  out.edge_count = total_of(device, flags, sums);
  out.edges.resize(out.edge_count);
  out.edge_faces.resize(out.edge_count);
  out.balance.resize(out.edge_count);
  device.for_each(borders, WriteEdges{key.data(), border.data(), flags.data(), sums.data(), borders, vertex_bits, mesh,
                                      out.edges.data(), out.edge_faces.data(), out.balance.data()});

  const std::size_t ends = std::size_t{2} * out.edge_count;
  flags.resize(ends);
  out.neighbours.resize(ends);
  device.for_each(ends, NeighbourPairs{out.edges.data(), flags.data(), out.neighbours.data()});
  device.sort_pairs(flags, out.neighbours, vertex_bits);
  out.first_neighbour.resize(std::size_t{mesh.vertex_count} + 1);
  device.for_each(std::size_t{mesh.vertex_count} + 1,
                  FirstNeighbour{flags.data(), static_cast<std::uint32_t>(ends), out.first_neighbour.data()});
}

}  // namespace blum::kernels
