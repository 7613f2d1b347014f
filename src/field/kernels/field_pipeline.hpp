// Blum: fields on a device, from vertices to distances. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "blum/grid/grid_spec.hpp"
#include "field/field_request.hpp"
#include "field/kernels/build_records.hpp"
#include "field/kernels/compute_tiles.hpp"
#include "field/kernels/nearest.hpp"
#include "field/kernels/tile_grid.hpp"

namespace blum::kernels {

/// Finds a surface point close to each tile's centre, with one warp per tile.
struct FindTilePoints {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 3;  ///< registers are limited so that at least this many fit
  static constexpr std::uint32_t warps = threads / warp_size;
  struct Shared {
    SearchStack stack[warps];
  };

  Forest forest;
  const NormalFrame* frame;
  TileGrid tiles;
  const SurfacePoint* coarse;  ///< points of the coarser tiles, used as start; null at the coarsest level
  TileGrid coarse_tiles;
  std::uint32_t count;  ///< number of tiles
  SurfacePoint* out;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared& shared, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const auto tile = static_cast<std::uint32_t>(index) * warps + warp.index();
      if (tile >= count) return;
      const Vec3f center = centered(*frame, tiles.box(tile)).center;
      SurfacePoint best;
      if (coarse != nullptr) {
        GridIndex place = tiles.place(tile);
        for (auto& x : place.at) x = x * tiles.side / coarse_tiles.side;
        best = coarse[coarse_tiles.index(place)];
        best.squared_distance = squared_length(center - best.point);
      }
      if (frame->fault == NormalFrame::Fault::none) {
        NearestSearch<typename Block::Warp>(warp, forest, shared.stack[warp.index()]).run(center, best);
      }
      warp.each([&](std::uint32_t lane) {
        if (lane == 0) out[tile] = best;
      });
    });
  }
};

/// Computes the bounding box of one vertex in use, in the grid's axes.
struct VertexBounds {
  const Vec3d* vertices;
  const std::uint32_t* named;
  Mat3 direction;
  BLUM_HD Bounds operator()(std::size_t k) const {
    Bounds box;
    box.extend_if_finite(direction.transposed_times(vertices[named[k]]));
    return box;
  }
};

struct JoinBounds {
  BLUM_HD Bounds operator()(const Bounds& a, const Bounds& b) const {
    Bounds box;
    box.lower = min(a.lower, b.lower);
    box.upper = max(a.upper, b.upper);
    return box;
  }
};

/// Computes the normalised frame on the device, so that no step waits for the host.
struct MakeFrame {
  const Bounds* bounds;
  GridSpec grid;
  NormalFrame* frame;
  BLUM_HD void operator()(std::size_t) const { *frame = make_normal_frame(*bounds, grid); }
};

/// Computes unsigned fields of a mesh in a device's memory. Device is CudaDevice, or EmulatedDevice in the tests.
///
/// Call set_connectivity() once for each connectivity and prepare() once for each frame. Then call compute() for slabs
/// of the grid, in any order.
template <class Device>
class FieldPipeline {
 public:
  explicit FieldPipeline(Device& device) : device_(device) {}

  /// Builds the connectivity. Waits for the device, because the number of edges determines later sizes.
  void set_connectivity(const DeviceMesh& mesh) { build_connectivity(device_, mesh, connectivity_); }
  [[nodiscard]] ConnectivityView connectivity() const { return connectivity_.view(); }
  /// Returns the forest of the last prepare(), in the device's memory; frame() returns the normalised frame.
  [[nodiscard]] const Forest& forest() const { return forest_; }
  [[nodiscard]] const NormalFrame* frame() const { return frame_.data(); }

  /// Builds records and trees for the vertices of this frame.
  void prepare(const DeviceMesh& mesh, const GridSpec& grid) {
    bounds_.resize(1);
    frame_.resize(1);
    device_.reduce(connectivity_.named_count,
                   VertexBounds{mesh.vertices, connectivity_.named_vertices.data(), grid.direction}, Bounds{},
                   JoinBounds{}, bounds_.data());
    device_.for_each(1, MakeFrame{bounds_.data(), grid, frame_.data()});
    order_sites(device_, mesh, connectivity_.view(), frame_.data(), order_);
    forest_ = build_records(device_, mesh, connectivity_.view(), order_, records_);
  }

  /// Checks the frame. Waits for the device.
  /// @throws InvalidGrid if mesh and grid are too large or small for 32-bit distances.
  void check_frame() {
    NormalFrame frame;
    device_.download(frame_.data(), 1, &frame);
    throw_if_faulty(frame);
  }

  /// Writes the slices [first_slice, last_slice) of the grid of the last prepare(). If the frame is faulty, writes NaN
  /// distances and no sites.
  /// @param request  its memory is on the device and holds these slices only.
  void compute(std::int64_t first_slice, std::int64_t last_slice, const FieldRequest& request) {
    const std::array<std::int64_t, 3>& size = request.grid.size;
    const TileGrid coarse{size, first_slice, last_slice, 4 * ComputeTiles::side};
    const TileGrid tiles{size, first_slice, last_slice, ComputeTiles::side};
    find_points({forest_, frame_.data(), coarse, nullptr, coarse, 0, nullptr}, coarse_points_);
    find_points({forest_, frame_.data(), tiles, coarse_points_.data(), coarse, 0, nullptr}, points_);
    device_.run_blocks(tiles.count(), ComputeTiles{forest_, frame_.data(), tiles, points_.data(), request});
  }

 private:
  using Points = typename Device::template Array<SurfacePoint>;

  void find_points(FindTilePoints body, Points& out) {
    const std::size_t count = body.tiles.count();
    out.resize(count);
    body.count = static_cast<std::uint32_t>(count);
    body.out = out.data();
    device_.run_blocks((count + FindTilePoints::warps - 1) / FindTilePoints::warps, body);
  }

  Device& device_;
  Connectivity<Device> connectivity_;
  typename Device::template Array<Bounds> bounds_;
  typename Device::template Array<NormalFrame> frame_;
  SiteOrder<Device> order_;
  SiteRecords<Device> records_;
  Forest forest_;
  Points coarse_points_;
  Points points_;
};

}  // namespace blum::kernels
