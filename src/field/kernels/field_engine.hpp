// Blum: fields in the host's memory, computed slab by slab on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/kernels/crossings.hpp"
#include "field/kernels/field_pipeline.hpp"

namespace blum::kernels {

/// What a field is asked for.
struct EngineRequest {
  GridSpec grid;
  double band = 0;                         ///< half-width, mesh units; 0: the full grid
  std::optional<std::int32_t> level = {};  ///< nodes with a winding number above it get negative distances
};

/// Keeps a mesh's connectivity and its memory from frame to frame.
template <class Device>
class FieldEngine {
 public:
  /// Nodes of a slab: two of them are on the device at a time, 8 bytes per node each.
  static constexpr std::size_t default_slab_nodes = std::size_t{1} << 23;

  explicit FieldEngine(Device& device, std::size_t slab_nodes = default_slab_nodes)
      : device_(device), slab_nodes_(slab_nodes), pipeline_(device), signs_(device) {}

  void set_connectivity(const MeshView& mesh) {
    device_.upload(mesh.triangles, triangles_);
    device_.upload(mesh.segments, segments_);
    device_.upload(mesh.points, points_);
    pipeline_.set_connectivity(on_device(mesh));
  }

  /// Computes the field of a mesh with the current connectivity.
  /// @return            with a level: whether every node has the winding number level or level + 1.
  /// @param is_stopped  callable: whether to give up.
  /// @param report      callable: fraction done.
  /// @throws InvalidGrid, Cancelled, and what the device throws.
  template <class IsStopped, class Report>
  bool compute(const MeshView& mesh, const EngineRequest& request, float* distance, std::uint32_t* site,
               const IsStopped& is_stopped, const Report& report) {
    const GridSpec& grid = request.grid;
    constexpr std::int64_t most_nodes = std::numeric_limits<std::int32_t>::max() - 63;  // whole tiles, in 32 bits
    for (const std::int64_t size : grid.size) {
      if (size > most_nodes) throw InvalidGrid("a device takes at most 2^31 - 64 nodes along an axis");
    }
    device_.upload(mesh.vertices, vertices_);
    pipeline_.prepare(on_device(mesh), grid);
    pipeline_.check_frame();
    if (request.level) signs_.prepare(on_device(mesh), grid);
    const auto per_slice = static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]);
    const std::int64_t slices = slab_slices(per_slice);
    const std::int64_t slabs = (grid.size[2] + slices - 1) / slices;
    const auto fetch = [&](std::int64_t slab) {
      const Slab& from = slabs_[static_cast<std::size_t>(slab % 2)];
      const std::size_t first = static_cast<std::size_t>(slab * slices) * per_slice;
      device_.fetch(from.distance.data(), from.nodes, distance + first);
      device_.fetch(from.site.data(), from.nodes, site + first);
      report(static_cast<double>(slab + 1) / static_cast<double>(slabs));
    };
    for (std::int64_t slab = 0; slab < slabs; ++slab) {
      if (is_stopped()) throw Cancelled();
      Slab& to = slabs_[static_cast<std::size_t>(slab % 2)];
      const std::int64_t first = slab * slices;
      const std::int64_t last = std::min(first + slices, grid.size[2]);
      to.nodes = static_cast<std::size_t>(last - first) * per_slice;
      to.distance.resize(to.nodes);
      to.site.resize(to.nodes);
      pipeline_.compute(first, last, {request.band, to.distance.data(), to.site.data()});
      if (request.level) signs_.apply(first, last, *request.level, to.distance.data());
      device_.mark(static_cast<int>(slab % 2));
      // The slab before this one travels while this one is computed.
      if (slab > 0) {
        device_.await(static_cast<int>((slab - 1) % 2));
        fetch(slab - 1);
      }
    }
    device_.wait();
    fetch(slabs - 1);
    return request.level && signs_.is_simple();
  }

 private:
  struct Slab {
    typename Device::template Array<float> distance;
    typename Device::template Array<std::uint32_t> site;
    std::size_t nodes = 0;
  };

  /// Whole tiles of both sizes, so that slabs do not change which tile a node is in.
  [[nodiscard]] std::int64_t slab_slices(std::size_t per_slice) const {
    constexpr std::int64_t unit = 4 * ComputeTiles::side;
    const auto fitting = static_cast<std::int64_t>(slab_nodes_ / std::max<std::size_t>(per_slice, 1));
    return std::max(unit, fitting / unit * unit);
  }

  [[nodiscard]] DeviceMesh on_device(const MeshView& mesh) const {
    return {vertices_.data(),
            triangles_.data(),
            segments_.data(),
            points_.data(),
            static_cast<std::uint32_t>(mesh.vertices.size()),
            static_cast<std::uint32_t>(mesh.triangles.size()),
            static_cast<std::uint32_t>(mesh.segments.size()),
            static_cast<std::uint32_t>(mesh.points.size())};
  }

  Device& device_;
  std::size_t slab_nodes_;
  FieldPipeline<Device> pipeline_;
  CrossingSigns<Device> signs_;
  typename Device::template Array<Vec3d> vertices_;
  typename Device::template Array<Triangle> triangles_;
  typename Device::template Array<Segment> segments_;
  typename Device::template Array<std::uint32_t> points_;
  std::array<Slab, 2> slabs_;
};

}  // namespace blum::kernels
