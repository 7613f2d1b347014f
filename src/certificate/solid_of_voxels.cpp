#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/geometry/sites.hpp"
#include "certificate/sampling.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/triangle_search.hpp"
#include "certificate/voxel_betti.hpp"
#include "certificate/voxel_faces.hpp"

namespace blum::verifier {
namespace {

/// A solid of voxels, such as those of an image. Their outer faces are the surface.
class VoxelOracle : public SolidOracle {
 public:
  VoxelOracle(const VoxelSet& voxels, const GridSpec& grid, VoxelBodies bodies, const Context& context)
      : faces_(voxels, grid, context), bodies_(std::move(bodies)) {}

  [[nodiscard]] double diagonal() const override { return faces_.box().diagonal(); }

  [[nodiscard]] Box3 box(std::uint32_t body) const override {
    const VoxelBodies::Extent& extent = bodies_.extent(body);
    Box3 box;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vec3d at;
      for (std::size_t a = 0; a < 3; ++a) {
        const double end = (corner >> a & 1U) != 0 ? static_cast<double>(extent.upper[a]) + 0.5
                                                   : static_cast<double>(extent.lower[a]) - 0.5;
        at[a] = end * faces_.grid().spacing[a];
      }
      box.extend(world(at));
    }
    return box;
  }

  [[nodiscard]] double diagonal(std::uint32_t body) const override {
    const VoxelBodies::Extent& extent = bodies_.extent(body);
    Vec3d size;
    for (std::size_t a = 0; a < 3; ++a) {
      size[a] = static_cast<double>(extent.upper[a] - extent.lower[a] + 1) * faces_.grid().spacing[a];
    }
    return length(size);
  }

  [[nodiscard]] double grain() const override { return length(faces_.grid().spacing); }

  [[nodiscard]] Location locate(const Vec3d& p) const override {
    const VoxelFaces::Nearest nearest = faces_.nearest(p);
    if (const auto voxel = faces_.voxel_at(p)) return {body_of(*voxel), nearest.distance, 0, nearest.distance};
    return {body_beside(nearest.face), nearest.distance, nearest.distance, -nearest.distance};
  }

  [[nodiscard]] double distance(const Vec3d& p, std::uint32_t /*body*/) const override { return faces_.distance(p); }

  [[nodiscard]] double depth(const Vec3d& p, std::uint32_t body) const override {
    const auto voxel = faces_.voxel_at(p);
    return voxel && body_of(*voxel) == body ? faces_.distance(p) : -faces_.distance(p);
  }

  /// Bodies share no corners, so a segment inside the voxels lies in one body.
  [[nodiscard]] bool holds(const Vec3d& a, const Vec3d& b, std::uint32_t body) const override {
    const auto voxel = faces_.held(a, b);
    return voxel && body_of(*voxel) == body;
  }

  [[nodiscard]] Vec3d closest_point(const Vec3d& p, std::uint32_t /*body*/) const override {
    const GridSpec& grid = faces_.grid();
    const Box3 face = faces_.rectangle(faces_.nearest(p).face);
    return world(max(face.lower, min(face.upper, grid.direction.transposed_times(p - grid.origin))));
  }

  [[nodiscard]] double distance_from_site(const Vec3d& p, SiteId site) const override {
    const GridSpec& grid = faces_.grid();
    if (!site.has_value() || site.value >= grid.node_count()) return HUGE_VAL;
    const auto row = site.value / static_cast<std::uint32_t>(grid.size[0]);
    const std::array<std::int64_t, 3> voxel{site.value % grid.size[0], row % grid.size[1], row / grid.size[1]};
    const Vec3d q = grid.direction.transposed_times(p - grid.origin);
    Box3 box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.lower[a] = (static_cast<double>(voxel[a]) - 0.5) * grid.spacing[a];
      box.upper[a] = (static_cast<double>(voxel[a]) + 0.5) * grid.spacing[a];
    }
    return std::sqrt(squared_distance(q, box));
  }

  [[nodiscard]] Samples make_samples(double step, const Context& context) const override {
    std::size_t count = 0;
    for (std::size_t b = 0; b < faces_.brick_count(); ++b) {
      if (b % 4096 == 0) throw_if_cancelled(context);
      faces_.for_each_face(b, [&](const VoxelFaces::Face&) { ++count; });
    }
    constexpr std::size_t most = 250'000;
    const double face = face_diagonal();
    if (step < face / 2 && 4 * count <= most) return {samples_of_faces(2, context), face / 4};
    if (count <= most) return {samples_of_faces(1, context), face / 2};
    return {samples_of_bricks(context), 4 * length(faces_.grid().spacing)};
  }

 protected:
  [[nodiscard]] const VoxelFaces& faces() const { return faces_; }

 private:
  [[nodiscard]] std::uint32_t body_of(const std::array<std::int64_t, 3>& voxel) const {
    return bodies_.of(voxel[0], voxel[1], voxel[2]);
  }

  /// Returns the body that a face belongs to.
  [[nodiscard]] std::uint32_t body_beside(const VoxelFaces::Face& face) const {
    std::array<std::int64_t, 3> voxel = face.voxel;
    if (!faces_.voxels().contains(voxel[0], voxel[1], voxel[2])) --voxel[face.axis];
    return body_of(voxel);
  }

  [[nodiscard]] double face_diagonal() const {
    std::array<double, 3> sides{faces_.grid().spacing.x, faces_.grid().spacing.y, faces_.grid().spacing.z};
    std::sort(sides.begin(), sides.end());
    return std::hypot(sides[1], sides[2]);
  }

  [[nodiscard]] Vec3d world(const Vec3d& local) const { return faces_.grid().origin + faces_.grid().direction * local; }

  [[nodiscard]] double area_of(const Box3& rectangle, std::size_t axis) const {
    const Vec3d size = rectangle.size();
    return size[(axis + 1) % 3] * size[(axis + 2) % 3];
  }

  /// Returns parts * parts samples of each face.
  [[nodiscard]] std::vector<Sample> samples_of_faces(int parts, const Context& context) const {
    std::vector<Sample> list;
    for (std::size_t b = 0; b < faces_.brick_count(); ++b) {
      if (b % 4096 == 0) throw_if_cancelled(context);
      faces_.for_each_face(b, [&](const VoxelFaces::Face& face) {
        const Box3 rectangle = faces_.rectangle(face);
        const std::size_t u = (face.axis + 1) % 3;
        const std::size_t v = (face.axis + 2) % 3;
        for (int part = 0; part < parts * parts; ++part) {
          Vec3d p = rectangle.lower;
          p[u] += rectangle.size()[u] * (part % parts + 0.5) / parts;
          p[v] += rectangle.size()[v] * (part / parts + 0.5) / parts;
          list.push_back({world(p), area_of(rectangle, face.axis) / (parts * parts)});
        }
      });
    }
    return list;
  }

  /// Returns one sample for each brick and axis. It is the centre of one face across the axis, with the area of all
  /// such faces in the brick.
  [[nodiscard]] std::vector<Sample> samples_of_bricks(const Context& context) const {
    std::vector<Sample> list;
    for (std::size_t b = 0; b < faces_.brick_count(); ++b) {
      if (b % 4096 == 0) throw_if_cancelled(context);
      std::array<Sample, 3> first;
      faces_.for_each_face(b, [&](const VoxelFaces::Face& face) {
        const Box3 rectangle = faces_.rectangle(face);
        Sample& sample = first[face.axis];
        if (!(sample.area > 0)) sample.point = world(rectangle.center());
        sample.area += area_of(rectangle, face.axis);
      });
      std::copy_if(first.begin(), first.end(), std::back_inserter(list), [](const Sample& s) { return s.area > 0; });
    }
    return list;
  }

  VoxelFaces faces_;
  VoxelBodies bodies_;
};

/// Voxels that represent the inside of a mesh. Distances are to the mesh. A point up to a voxel's diagonal outside the
/// voxels is treated as inside.
class WindingOracle : public VoxelOracle {
 public:
  WindingOracle(const VoxelSet& voxels, const GridSpec& grid, VoxelBodies bodies, const MeshView& surface,
                const Context& context)
      : VoxelOracle(voxels, grid, std::move(bodies), context),
        mesh_(surface),
        search_(surface, {}, context),
        sites_(surface, context) {}

  [[nodiscard]] double diagonal() const override { return search_.bounds().diagonal(); }

  [[nodiscard]] Location locate(const Vec3d& p) const override {
    Location location = VoxelOracle::locate(p);
    location.distance = distance(p, location.body);
    location.outside_by = std::max(location.outside_by - slack(), 0.0);
    return location;
  }

  [[nodiscard]] double distance(const Vec3d& p, std::uint32_t /*body*/) const override {
    return search_.nearest(p).distance;
  }

  [[nodiscard]] double distance_above(const Vec3d& p, double enough, std::uint32_t /*body*/) const override {
    return search_.distance_above(p, enough, no_group);
  }

  [[nodiscard]] Vec3d closest_point(const Vec3d& p, std::uint32_t /*body*/) const override {
    return search_.closest_point_within(p, HUGE_VAL, no_group);
  }

  [[nodiscard]] double slack() const override { return length(faces().grid().spacing); }

  [[nodiscard]] double distance_from_site(const Vec3d& p, SiteId site) const override {
    return verifier::distance_from_site(mesh_, sites_, p, site);
  }

  [[nodiscard]] Samples make_samples(double step, const Context& context) const override {
    return samples_of_triangles(mesh_, {}, step, context);
  }

 private:
  MeshView mesh_;
  TriangleSearch search_;
  SiteTable sites_;
};

/// @throws InvalidGrid unless the voxels of a grid contain all triangles.
void check_covers(const GridSpec& grid, const MeshView& surface) {
  for (const Triangle& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3d q = grid.direction.transposed_times(surface.vertices[v] - grid.origin);
      for (std::size_t a = 0; a < 3; ++a) {
        const double at = q[a] / grid.spacing[a];
        if (at >= -0.5 && at <= static_cast<double>(grid.size[a]) - 0.5) continue;
        throw InvalidGrid("the grid of the voxels does not cover the mesh: vertex " + std::to_string(v) +
                          " lies outside it");
      }
    }
  }
}

}  // namespace

KnownSolid solid_of_voxels(const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                           const Context& context) {
  if (surface != nullptr) {
    if (surface->triangles.empty()) throw InvalidMesh("the mesh has no triangles, so distances to it are undefined");
    check_covers(grid, *surface);
  }
  VoxelBodies bodies(voxels, context);
  std::vector<BettiNumbers> betti = voxel_betti_numbers(voxels, bodies, context);
  std::unique_ptr<SolidOracle> oracle;
  if (surface == nullptr) {
    oracle = std::make_unique<VoxelOracle>(voxels, grid, std::move(bodies), context);
  } else {
    oracle = std::make_unique<WindingOracle>(voxels, grid, std::move(bodies), *surface, context);
  }
  return {std::move(oracle), std::move(betti)};
}

}  // namespace blum::verifier
