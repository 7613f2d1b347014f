// Blum: winding numbers of a closed mesh at the nodes of a slab, by scan conversion.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/field_request.hpp"
#include "field/kernels/boundary_signs.hpp"
#include "field/kernels/connectivity.hpp"
#include "field/kernels/row_crossings.hpp"

// Counts exactly the same crossings as SignScan (field/sign/scan.hpp). Crossings are not sorted, but added to the nodes
// behind them. The counts are integers, so the order of additions does not matter.
namespace blum::kernels {

template <class T>
BLUM_HD void add_atomically(T& sum, T value) {
#if defined(__CUDA_ARCH__)
  atomicAdd(&sum, value);
#else
  sum += value;
#endif
}

/// Adds one to a counter and returns its previous value.
BLUM_HD inline std::uint32_t take_number(std::uint32_t& counter) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(&counter, 1U);
#else
  return counter++;
#endif
}

/// Converts each vertex to node units once, so that all its triangles use the same numbers.
struct PlaceInNodes {
  NodeUnits units;
  const Vec3d* vertices;
  Vec3d* places;
  BLUM_HD void operator()(std::size_t v) const { places[v] = units.position(vertices[v]); }
};

/// Counts crossings of triangles with rows (lines of nodes along x).
struct CrossingCount {
  const Triangle* triangles;
  const Vec3d* places;  ///< positions of the vertices, in node units
  bool is_mirrored;
  std::int32_t size[3];
  std::int32_t first_slice;
  std::int32_t last_slice;
  /// Per node of the slab: change of the winding number along the row; to be summed along the row.
  std::int32_t* change;

  [[nodiscard]] BLUM_HD PlacedTriangle placed(std::uint32_t t) const {
    return {places[triangles[t][0]], places[triangles[t][1]], places[triangles[t][2]]};
  }
  /// Returns the slices of the slab that cut a triangle.
  [[nodiscard]] BLUM_HD Cuts<std::int32_t> slices(const PlacedTriangle& t) const {
    Cuts<std::int32_t> cuts = t.slices(size[2]);
    cuts.begin = larger(cuts.begin, first_slice);
    cuts.end = smaller(cuts.end, last_slice);
    return cuts;
  }
  BLUM_HD void cross_row(const SliceCut& cut, std::int32_t slice, std::int32_t row) const {
    const double next = cut.node_behind(static_cast<double>(row));
    if (!(next < static_cast<double>(size[0]))) return;
    const auto line = static_cast<std::size_t>(slice - first_slice) * static_cast<std::size_t>(size[1]) +
                      static_cast<std::size_t>(row);
    const auto node = static_cast<std::size_t>(larger(next, 0.0));
    add_atomically(change[line * static_cast<std::size_t>(size[0]) + node], cut.goes_in ? 1 : -1);
  }
};

/// Counts the crossings of one triangle per thread. Triangles with many crossings are left to CrossLargeTriangles.
struct CrossTriangles {
  static constexpr std::int64_t most_rows = 256;

  CrossingCount count;
  std::uint32_t* large;
  std::uint32_t* large_count;

  BLUM_HD void operator()(std::size_t index) const {
    const PlacedTriangle triangle = count.placed(static_cast<std::uint32_t>(index));
    const auto slices = count.slices(triangle);
    if (slices.begin >= slices.end) return;
    const auto all_rows = triangle.rows(count.size[1]);
    if (std::int64_t{slices.end - slices.begin} * (all_rows.end - all_rows.begin) > most_rows) {
      large[take_number(*large_count)] = static_cast<std::uint32_t>(index);
      return;
    }
    for (std::int32_t slice = slices.begin; slice < slices.end; ++slice) {
      const SliceCut cut(triangle, static_cast<double>(slice), count.is_mirrored);
      const auto rows = cut.rows(count.size[1]);
      for (std::int32_t row = rows.begin; row < rows.end; ++row) count.cross_row(cut, slice, row);
    }
  }
};

/// Counts the crossings of large triangles. Triangles are divided among blocks, slices of a triangle among warps, and
/// rows of a slice among lanes.
struct CrossLargeTriangles {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 2;
  static constexpr std::uint32_t blocks = 1024;
  struct Shared {};

  CrossingCount count;
  const std::uint32_t* large;
  const std::uint32_t* large_count;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared&, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const auto own = static_cast<std::int32_t>(warp.index());
      constexpr auto step = static_cast<std::int32_t>(threads / warp_size);
      for (auto k = static_cast<std::uint32_t>(index); k < *large_count; k += blocks) {
        const PlacedTriangle triangle = count.placed(large[k]);
        const auto slices = count.slices(triangle);
        for (std::int32_t slice = slices.begin + own; slice < slices.end; slice += step) {
          const SliceCut cut(triangle, static_cast<double>(slice), count.is_mirrored);
          const auto rows = cut.rows(count.size[1]);
          warp.each([&](std::uint32_t lane) {
            for (std::int32_t row = rows.begin + static_cast<std::int32_t>(lane); row < rows.end;
                 row += static_cast<std::int32_t>(warp_size)) {
              count.cross_row(cut, slice, row);
            }
          });
        }
      }
    });
  }
};

/// Sums the changes along a row. Calls visit(node, sum) for each node.
template <class Warp, class Visit>
BLUM_HD void add_up_row(const Warp& warp, const std::int32_t* change, std::int32_t width, const Visit& visit) {
  std::int32_t before = 0;
  for (std::int32_t first = 0; first < width; first += static_cast<std::int32_t>(warp_size)) {
    typename Warp::template Lanes<std::int32_t> sum;
    warp.each([&](std::uint32_t lane) {
      const std::int32_t x = first + static_cast<std::int32_t>(lane);
      sum[lane] = x < width ? change[x] : 0;
    });
    warp.add_up(sum);
    warp.each([&](std::uint32_t lane) {
      const std::int32_t x = first + static_cast<std::int32_t>(lane);
      if (x < width) visit(x, before + sum[lane]);
    });
    before += warp.broadcast(sum, warp_size - 1);
  }
}

/// Common part of the kernels that process one row per warp.
struct RowsOfWarps {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 4;
  static constexpr std::uint32_t warps = threads / warp_size;
  struct Shared {};
};

/// Replaces the changes by their sums along each row.
struct SumCrossings : RowsOfWarps {
  std::int32_t* change;
  std::size_t rows;
  std::int32_t width;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared&, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const std::size_t row = index * warps + warp.index();
      if (row >= rows) return;
      std::int32_t* const line = change + row * static_cast<std::size_t>(width);
      add_up_row(warp, line, width, [&](std::int32_t x, std::int32_t sum) { line[x] = sum; });
    });
  }
};

/// Negates the distances of nodes whose winding number is above `level`. Winding numbers must be whole.
struct ApplyWinding : RowsOfWarps {
  const std::int32_t* change;
  std::size_t rows;
  std::int32_t width;
  std::int32_t level;
  float* distance;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared&, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const std::size_t row = index * warps + warp.index();
      if (row >= rows) return;
      const std::size_t line = row * static_cast<std::size_t>(width);
      add_up_row(warp, change + line, width, [&](std::int32_t x, std::int32_t winding) {
        float& value = distance[line + static_cast<std::size_t>(x)];
        if (winding > level && value > 0) value = -value;
      });
    });
  }
};

/// Finds the signs of slabs by winding numbers. Winding numbers are sums of counted crossings and, for meshes with a
/// boundary, of the terms of the boundary's edges.
template <class Device>
class CrossingSigns {
 public:
  explicit CrossingSigns(Device& device) : device_(device), boundary_(device) {}

  /// Finds the boundary, once per connectivity. Waits for the device.
  void set_connectivity(const ConnectivityView& connectivity) { boundary_.set_connectivity(connectivity); }
  /// Returns the number of boundary edges by vertex index. If it is 0, winding numbers are whole.
  [[nodiscard]] std::uint32_t boundary_count() const { return boundary_.count(); }
  /// Returns the number of boundary edges that are left in the last frame, after edges at the same position cancelled.
  /// The mesh must have boundary edges by vertex index. Waits for the device.
  [[nodiscard]] std::uint32_t download_boundary_count() { return boundary_.download_kept_count(); }

  /// Sets the mesh and the grid, once per frame.
  void prepare(const DeviceMesh& mesh, const GridSpec& grid) {
    mesh_ = mesh;
    units_ = NodeUnits(grid);
    places_.resize(mesh.vertex_count);
    large_.resize(mesh.triangle_count);
    large_count_.resize(1);
    device_.for_each(mesh.vertex_count, PlaceInNodes{units_, mesh.vertices, places_.data()});
    if (boundary_.count() > 0) boundary_.place(mesh.vertices);
  }

  /// Negates the distances of a slab's nodes inside; they must be unsigned. Nodes are inside if their winding number is
  /// above the request's level, or above level + 1/2 if the mesh has a boundary.
  /// @param request  must be for the grid of the last prepare(). Its memory is on the device and holds these slices
  /// only.
  /// @param frame    normalised frame of the distances, in the device's memory.
  void apply(std::int64_t first_slice, std::int64_t last_slice, const FieldRequest& request, const NormalFrame* frame) {
    const GridSpec& grid = request.grid;
    const auto width = static_cast<std::int32_t>(grid.size[0]);
    const auto rows = static_cast<std::size_t>(last_slice - first_slice) * static_cast<std::size_t>(grid.size[1]);
    const std::size_t row_blocks = (rows + RowsOfWarps::warps - 1) / RowsOfWarps::warps;
    count_changes(grid, first_slice, last_slice, rows);
    if (boundary_.count() == 0) {
      device_.run_blocks(row_blocks, ApplyWinding{{}, change_.data(), rows, width, request.level, request.distance});
      return;
    }
    device_.run_blocks(row_blocks, SumCrossings{{}, change_.data(), rows, width});
    const TileGrid tiles{grid.size, first_slice, last_slice, SignTiles::side};
    device_.run_blocks(tiles.count(), SignTiles{{boundary_.kept(), boundary_.kept_count(), places_.data(), grid.spacing,
                                                 units_.is_mirrored},
                                                frame,
                                                tiles,
                                                grid.spacing,
                                                change_.data(),
                                                request.level,
                                                request.distance});
  }

 private:
  void count_changes(const GridSpec& grid, std::int64_t first_slice, std::int64_t last_slice, std::size_t rows) {
    change_.resize(rows * static_cast<std::size_t>(grid.size[0]));
    device_.fill(change_, std::int32_t{0});
    device_.fill(large_count_, 0U);
    const CrossingCount count{mesh_.triangles,
                              places_.data(),
                              units_.is_mirrored,
                              {static_cast<std::int32_t>(grid.size[0]), static_cast<std::int32_t>(grid.size[1]),
                               static_cast<std::int32_t>(grid.size[2])},
                              static_cast<std::int32_t>(first_slice),
                              static_cast<std::int32_t>(last_slice),
                              change_.data()};
    device_.for_each(mesh_.triangle_count, CrossTriangles{count, large_.data(), large_count_.data()});
    device_.run_blocks(CrossLargeTriangles::blocks, CrossLargeTriangles{count, large_.data(), large_count_.data()});
  }

  Device& device_;
  DeviceMesh mesh_;
  NodeUnits units_;
  Boundary<Device> boundary_;
  typename Device::template Array<Vec3d> places_;
  typename Device::template Array<std::uint32_t> large_;
  typename Device::template Array<std::uint32_t> large_count_;
  typename Device::template Array<std::int32_t> change_;
};

}  // namespace blum::kernels
