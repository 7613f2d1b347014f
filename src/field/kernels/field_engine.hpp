// Blum: fields of meshes, computed slab by slab on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "blum/core/error.hpp"
#include "blum/field/device_memory.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/field_request.hpp"
#include "field/kernels/compute_tiles.hpp"
#include "field/kernels/connectivity.hpp"
#include "field/kernels/crossings.hpp"
#include "field/kernels/field_pipeline.hpp"

namespace blum::kernels {

using MemoryArray = DeviceArrayView;
using MemoryMesh = DeviceMeshView;

/// Copies float or double vertices as double.
struct CopyVertices {
  MemoryArray from;
  Vec3d* to;

  BLUM_HD void operator()(std::size_t k) const {
    if (from.type == ElementType::float32) {
      const auto* const row = static_cast<const float*>(from.data) + 3 * k;
      to[k] = {row[0], row[1], row[2]};
    } else {
      const auto* const row = static_cast<const double*>(from.data) + 3 * k;
      to[k] = {row[0], row[1], row[2]};
    }
  }
};

/// Copies indices as 32-bit numbers. An index outside of the vertices becomes 0 and sets `faults`.
struct CopyIndices {
  MemoryArray from;
  std::size_t limit;
  std::uint32_t* to;
  std::uint32_t* faults;

  BLUM_HD void operator()(std::size_t k) const {
    const std::int64_t index = value(k);
    const bool is_good = index >= 0 && static_cast<std::uint64_t>(index) < limit;
    to[k] = is_good ? static_cast<std::uint32_t>(index) : 0;
    if (!is_good) *faults = 1;
  }

 private:
  [[nodiscard]] BLUM_HD std::int64_t value(std::size_t k) const {
    switch (from.type) {
      case ElementType::int32:
        return static_cast<const std::int32_t*>(from.data)[k];
      case ElementType::uint32:
        return static_cast<const std::uint32_t*>(from.data)[k];
      default:
        return static_cast<const std::int64_t*>(from.data)[k];
    }
  }
};

/// Finds the smallest index of a triangle at each vertex, with one thread per corner.
struct FindVertexTriangles {
  const Triangle* triangles;
  std::uint32_t* vertex_triangle;

  BLUM_HD void operator()(std::size_t k) const {
    const auto t = static_cast<std::uint32_t>(k / 3);
    std::uint32_t& least = vertex_triangle[triangles[t][k % 3]];
#if defined(__CUDA_ARCH__)
    atomicMin(&least, t);
#else
    least = smaller(least, t);
#endif
  }
};

/// Replaces a site by the triangle with the smallest index that contains it.
struct ShowTriangle {
  const std::uint32_t* vertex_triangle;
  const std::array<std::uint32_t, 2>* edge_faces;
  std::uint32_t vertex_count;
  std::uint32_t edge_count;
  std::uint32_t* site;

  BLUM_HD void operator()(std::size_t k) const {
    const std::uint32_t id = site[k];
    if (id == no_index) return;
    if (id < vertex_count) {
      site[k] = vertex_triangle[id];
    } else if (id - vertex_count < edge_count) {
      site[k] = edge_faces[id - vertex_count][0];
    } else {
      site[k] = id - vertex_count - edge_count;
    }
  }
};

/// Divides a grid into slabs that consist of whole tiles of both sizes. So the tile of a node does not depend on the
/// slabs.
class Slabs {
 public:
  /// @param nodes  largest number of nodes of a slab. A slab may exceed this number if the grid's slices are too large.
  Slabs(const GridSpec& grid, std::size_t nodes)
      : per_slice_(static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])),
        size_(grid.size[2]) {
    constexpr std::int64_t unit = 4 * ComputeTiles::side;
    const auto fitting = static_cast<std::int64_t>(nodes / std::max<std::size_t>(per_slice_, 1));
    slices_ = std::max(unit, fitting / unit * unit);
  }

  [[nodiscard]] std::int64_t count() const { return (size_ + slices_ - 1) / slices_; }
  [[nodiscard]] std::int64_t first_slice(std::int64_t slab) const { return slab * slices_; }
  [[nodiscard]] std::int64_t last_slice(std::int64_t slab) const { return std::min((slab + 1) * slices_, size_); }
  [[nodiscard]] std::size_t first_node(std::int64_t slab) const {
    return static_cast<std::size_t>(first_slice(slab)) * per_slice_;
  }
  [[nodiscard]] std::size_t nodes(std::int64_t slab) const {
    return static_cast<std::size_t>(last_slice(slab) - first_slice(slab)) * per_slice_;
  }

 private:
  std::size_t per_slice_;
  std::int64_t size_;
  std::int64_t slices_ = 0;
};

/// Computes fields. Keeps a mesh's connectivity and working memory from frame to frame. Fields are copied to the host's
/// memory slab by slab, or stay on the device.
template <class Device>
class FieldEngine {
 public:
  /// Number of nodes of a slab. Two slabs are on the device at a time. Each needs 8 bytes per node.
  static constexpr std::size_t default_slab_nodes = std::size_t{1} << 23;
  /// Number of nodes of a slab if the field stays on the device. While a slab is computed, it needs 5 additional bytes
  /// per node.
  static constexpr std::size_t device_slab_nodes = std::size_t{1} << 28;

  explicit FieldEngine(Device& device, std::size_t slab_nodes = default_slab_nodes)
      : device_(device), slab_nodes_(slab_nodes), pipeline_(device), signs_(device) {}

  void set_connectivity(const MeshView& mesh) {
    device_.upload(mesh.triangles, triangles_);
    device_.upload(mesh.segments, segments_);
    device_.upload(mesh.points, points_);
    vertices_.resize(mesh.vertices.size());
    build();
  }
  /// Sets the connectivity. Copies the indices, which are in the device's memory. Waits for the device.
  /// @throws InvalidMesh if an index is out of range.
  void set_connectivity(const MemoryMesh& mesh) {
    constexpr std::size_t kinds = 3;
    faults_.resize(kinds);
    device_.fill(faults_, 0U);
    copy_indices(mesh.triangles, mesh.vertices.rows, triangles_, faults_.data());
    copy_indices(mesh.segments, mesh.vertices.rows, segments_, faults_.data() + 1);
    copy_indices(mesh.points, mesh.vertices.rows, points_, faults_.data() + 2);
    vertices_.resize(mesh.vertices.rows);
    std::uint32_t faults[kinds] = {};
    device_.download(faults_.data(), kinds, &faults[0]);
    for (std::size_t k = 0; k < kinds; ++k) {
      constexpr const char* names[kinds] = {"triangles", "segments", "points"};
      if (faults[k] == 0) continue;
      throw InvalidMesh(std::string(names[k]) +
                        " have an index that is negative, or not below the number of vertices, " +
                        std::to_string(mesh.vertices.rows));
    }
    build();
  }

  /// Computes the field of a mesh. The mesh must have the current connectivity.
  /// @param request     request with host memory. The sites are written as feature ids.
  /// @param is_stopped  callable: returns true to stop early.
  /// @param report      callable: receives the fraction done.
  /// @return  true if the distances have signs, which winding numbers decide. False if there are too many boundary
  ///          edges to sum up at every node.
  /// @throws InvalidGrid, Cancelled, and the device's errors.
  template <class IsStopped, class Report>
  bool compute(const MeshView& mesh, const FieldRequest& request, const IsStopped& is_stopped, const Report& report) {
    check_size(request.grid);
    device_.upload(mesh.vertices, vertices_);
    pipeline_.prepare(mesh_, request.grid);
    pipeline_.check_frame();
    const bool is_signed = prepare_signs(request) && has_few_boundary_edges(request);
    const Slabs slabs(request.grid, slab_nodes_);
    const auto fetch = [&](std::int64_t slab) {
      const Slab& from = slabs_[static_cast<std::size_t>(slab % 2)];
      device_.fetch(from.distance.data(), slabs.nodes(slab), request.distance + slabs.first_node(slab));
      if (request.site != nullptr) {
        device_.fetch(from.site.data(), slabs.nodes(slab), request.site + slabs.first_node(slab));
      }
      report(static_cast<double>(slab + 1) / static_cast<double>(slabs.count()));
    };
    for (std::int64_t slab = 0; slab < slabs.count(); ++slab) {
      if (is_stopped()) throw Cancelled();
      Slab& to = slabs_[static_cast<std::size_t>(slab % 2)];
      to.distance.resize(slabs.nodes(slab));
      if (request.site != nullptr) to.site.resize(slabs.nodes(slab));
      FieldRequest part = request;
      part.distance = to.distance.data();
      part.site = request.site != nullptr ? to.site.data() : nullptr;
      compute_slab(slabs, slab, part, is_signed);
      device_.mark(static_cast<int>(slab % 2));
      // While this slab is computed, the previous slab is copied to the host.
      if (slab > 0) {
        device_.await(static_cast<int>((slab - 1) % 2));
        fetch(slab - 1);
      }
    }
    device_.wait();
    fetch(slabs.count() - 1);
    return is_signed;
  }

  /// Computes the field from vertices in the device's memory, into memory of the device. Queues the work without
  /// waiting for it. For faulty input, every node gets NaN and no site. Input is faulty if mesh and grid are too large
  /// or too small for 32-bit distances, or if a vertex is not finite.
  /// @throws InvalidGrid; InvalidMesh if the number of vertices is not that of the connectivity.
  void compute(const MemoryArray& vertices, const FieldRequest& request) {
    check_size(request.grid);
    if (vertices.rows != mesh_.vertex_count) {
      throw InvalidMesh("there are " + std::to_string(vertices.rows) +
                        " vertices, but triangles, segments and points were given for " +
                        std::to_string(mesh_.vertex_count) + " vertices");
    }
    copy_vertices(vertices);
    pipeline_.prepare(mesh_, request.grid);
    const bool is_signed = prepare_signs(request);
    const Slabs slabs(request.grid, device_slab_nodes);
    for (std::int64_t slab = 0; slab < slabs.count(); ++slab) {
      FieldRequest part = request;
      part.distance += slabs.first_node(slab);
      if (request.site != nullptr) part.site += slabs.first_node(slab);
      compute_slab(slabs, slab, part, is_signed);
    }
    if (request.site != nullptr && request.site_ids == SiteIds::triangles)
      show_triangles(request.grid.node_count(), request.site);
  }

 private:
  struct Slab {
    typename Device::template Array<float> distance;
    typename Device::template Array<std::uint32_t> site;
  };

  /// Replaces each site in the device's memory by the triangle with the smallest index that contains the site. Queues
  /// the work.
  void show_triangles(std::size_t count, std::uint32_t* site) {
    if (!has_vertex_triangles_) {
      vertex_triangle_.resize(mesh_.vertex_count);
      device_.fill(vertex_triangle_, no_index);
      device_.for_each(std::size_t{3} * mesh_.triangle_count,
                       FindVertexTriangles{mesh_.triangles, vertex_triangle_.data()});
      has_vertex_triangles_ = true;
    }
    const ConnectivityView connectivity = pipeline_.connectivity();
    device_.for_each(count, ShowTriangle{vertex_triangle_.data(), connectivity.edge_faces, mesh_.vertex_count,
                                         connectivity.edge_count, site});
  }

  static void check_size(const GridSpec& grid) {
    // A whole number of tiles, below 2^31.
    constexpr std::int64_t most_nodes = std::numeric_limits<std::int32_t>::max() - 63;
    for (const std::int64_t size : grid.size) {
      if (size > most_nodes) throw InvalidGrid("a device takes at most 2^31 - 64 nodes along an axis");
    }
  }

  /// Builds the connectivity of the current index arrays.
  void build() {
    mesh_ = {vertices_.data(),
             triangles_.data(),
             segments_.data(),
             points_.data(),
             static_cast<std::uint32_t>(vertices_.size()),
             static_cast<std::uint32_t>(triangles_.size()),
             static_cast<std::uint32_t>(segments_.size()),
             static_cast<std::uint32_t>(points_.size())};
    has_vertex_triangles_ = false;
    pipeline_.set_connectivity(mesh_);
    signs_.set_connectivity(pipeline_.connectivity());
  }

  template <class Row>
  void copy_indices(const MemoryArray& from, std::size_t limit, typename Device::template Array<Row>& to,
                    std::uint32_t* fault) {
    to.resize(from.rows);
    const std::size_t count = from.rows * (sizeof(Row) / sizeof(std::uint32_t));
    device_.for_each(count, CopyIndices{from, limit, reinterpret_cast<std::uint32_t*>(to.data()), fault});
  }
  void copy_vertices(const MemoryArray& from) { device_.for_each(from.rows, CopyVertices{from, vertices_.data()}); }

  /// Returns true if this class finds the requested signs. Prepares them in this case.
  bool prepare_signs(const FieldRequest& request) {
    if (!sign::is_by_winding(request.sign)) return false;
    signs_.prepare(mesh_, request.grid);
    return true;
  }
  /// Returns true if there are few enough boundary edges to sum up at every node. Waits for the device.
  bool has_few_boundary_edges(const FieldRequest& request) {
    constexpr std::uint32_t most_edges = 1U << 14U;
    constexpr double most_nodes_times_edges = 0x1p36;
    if (signs_.boundary_count() == 0) return true;
    const std::uint32_t edges = signs_.download_boundary_count();
    return edges <= most_edges &&
           static_cast<double>(edges) * static_cast<double>(request.grid.node_count()) <= most_nodes_times_edges;
  }
  /// Computes a slab.
  /// @param request  its memory is on the device and holds this slab only.
  void compute_slab(const Slabs& slabs, std::int64_t slab, const FieldRequest& request, bool is_signed) {
    const std::int64_t first = slabs.first_slice(slab);
    const std::int64_t last = slabs.last_slice(slab);
    pipeline_.compute(first, last, request);
    if (is_signed) signs_.apply(first, last, request, pipeline_.frame());
  }

  Device& device_;
  std::size_t slab_nodes_;
  FieldPipeline<Device> pipeline_;
  CrossingSigns<Device> signs_;
  DeviceMesh mesh_;
  bool has_vertex_triangles_ = false;
  typename Device::template Array<std::uint32_t> vertex_triangle_;
  typename Device::template Array<std::uint32_t> faults_;
  typename Device::template Array<Vec3d> vertices_;
  typename Device::template Array<Triangle> triangles_;
  typename Device::template Array<Segment> segments_;
  typename Device::template Array<std::uint32_t> points_;
  std::array<Slab, 2> slabs_;
};

}  // namespace blum::kernels
