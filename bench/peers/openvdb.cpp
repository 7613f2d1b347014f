// OpenVDB's conversion of meshes to sparse bands.
#include "peers/peers.hpp"

#ifdef BLUM_BENCH_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

namespace blum::bench {
namespace {

/// Adapts a mesh to OpenVDB's interface, in index space.
struct Adapter {
  const MeshView& mesh;
  const GridSpec& grid;
  [[nodiscard]] std::size_t polygonCount() const { return mesh.triangles.size(); }
  [[nodiscard]] std::size_t pointCount() const { return mesh.vertices.size(); }
  [[nodiscard]] std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t polygon, std::size_t corner, openvdb::Vec3d& position) const {
    const Vec3d p = (mesh.vertices[mesh.triangles[polygon][corner]] - grid.origin) / grid.spacing.x;
    position = openvdb::Vec3d(p.x, p.y, p.z);
  }
};

}  // namespace

std::optional<PeerBand> openvdb_band(const MeshView& mesh, const GridSpec& grid, double width, bool is_signed,
                                     const Context& context) {
  openvdb::initialize();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(thread_count(context)));
  const int flags = is_signed ? openvdb::tools::DISABLE_RENORMALIZATION : openvdb::tools::UNSIGNED_DISTANCE_FIELD;
  PeerBand band;
  openvdb::FloatGrid::Ptr distances;
  band.times = time_once([&] {
    const auto transform = openvdb::math::Transform::createLinearTransform(grid.spacing.x);
    openvdb::Int32Grid polygons;
    distances = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        Adapter{mesh, grid}, *transform, static_cast<float>(width), static_cast<float>(width), flags, &polygons);
  });
  band.active_nodes = static_cast<double>(distances->activeVoxelCount());
  const auto step = static_cast<std::size_t>(band.active_nodes / 100) + 1;
  std::size_t count = 0;
  for (auto voxel = distances->cbeginValueOn(); voxel; ++voxel, ++count) {
    if (count % step != step / 2) continue;
    const openvdb::Coord at = voxel.getCoord();
    band.samples.push_back({{at.x(), at.y(), at.z()}, static_cast<double>(*voxel)});
  }
  return band;
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::optional<PeerBand> openvdb_band(const MeshView&, const GridSpec&, double, bool, const Context&) {
  return std::nullopt;
}

}  // namespace blum::bench

#endif
