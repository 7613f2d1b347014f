#include <algorithm>
#include <array>
#include <cmath>

#include "blum/core/error.hpp"
#include "medial_axis/certificate/solid.hpp"
#include "medial_axis/certificate/triangle_search.hpp"
#include "medial_axis/certificate/voxel_betti.hpp"
#include "medial_axis/certificate/voxel_surface.hpp"

namespace blum::verifier {
namespace {

/// Voxels of an image: one body, whose surface are the faces.
class VoxelSolid : public Solid {
 public:
  VoxelSolid(const VoxelSet& voxels, const GridSpec& grid, const Context& context) : faces_(voxels, grid, context) {}

  [[nodiscard]] double diagonal() const override { return faces_.box().diagonal(); }

  [[nodiscard]] Place locate(const Vec3d& p) const override {
    const double own = faces_.distance(p);
    return {0, own, faces_.contains(p) ? 0 : own};
  }

  [[nodiscard]] double distance(const Vec3d& p, std::uint32_t /*body*/) const override { return faces_.distance(p); }

  [[nodiscard]] Samples samples(double step, const Context& context) const override {
    std::size_t count = 0;
    for (std::size_t b = 0; b < faces_.brick_count(); ++b) {
      if (b % 4096 == 0) throw_if_cancelled(context);
      faces_.for_each_face(b, [&](const VoxelSurface::Face&) { ++count; });
    }
    const double face = face_diagonal();
    if (step < face / 2 && 4 * count <= most_samples) return {samples_of_faces(2, context), face / 4};
    if (count <= most_samples) return {samples_of_faces(1, context), face / 2};
    return {samples_of_bricks(context), 4 * length(faces_.grid().spacing)};
  }

 protected:
  [[nodiscard]] const VoxelSurface& faces() const { return faces_; }

 private:
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

  /// parts x parts points of each face.
  [[nodiscard]] std::vector<Sample> samples_of_faces(int parts, const Context& context) const {
    std::vector<Sample> list;
    for (std::size_t b = 0; b < faces_.brick_count(); ++b) {
      if (b % 4096 == 0) throw_if_cancelled(context);
      faces_.for_each_face(b, [&](const VoxelSurface::Face& face) {
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

  /// Along each axis one face of each brick that has any.
  [[nodiscard]] std::vector<Sample> samples_of_bricks(const Context& context) const {
    std::vector<Sample> list;
    for (std::size_t b = 0; b < faces_.brick_count(); ++b) {
      if (b % 4096 == 0) throw_if_cancelled(context);
      std::array<Sample, 3> first;
      faces_.for_each_face(b, [&](const VoxelSurface::Face& face) {
        const Box3 rectangle = faces_.rectangle(face);
        Sample& sample = first[face.axis];
        if (!(sample.area > 0)) sample.point = world(rectangle.center());
        sample.area += area_of(rectangle, face.axis);
      });
      std::copy_if(first.begin(), first.end(), std::back_inserter(list), [](const Sample& s) { return s.area > 0; });
    }
    return list;
  }

  VoxelSurface faces_;
};

/// Voxels that stand for the inside of a mesh: distances are to the mesh, and a voxel more or less is no matter.
class WindingSolid : public VoxelSolid {
 public:
  WindingSolid(const VoxelSet& voxels, const GridSpec& grid, const MeshView& surface, const Context& context)
      : VoxelSolid(voxels, grid, context), search_(surface, {}, context) {}

  [[nodiscard]] double diagonal() const override { return search_.bounds().diagonal(); }

  [[nodiscard]] Place locate(const Vec3d& p) const override {
    const double beyond = faces().contains(p) ? 0 : faces().distance(p) - length(faces().grid().spacing);
    return {0, distance(p, 0), std::max(beyond, 0.0)};
  }

  [[nodiscard]] double distance(const Vec3d& p, std::uint32_t /*body*/) const override {
    return search_.nearest(p).distance;
  }

 private:
  TriangleSearch search_;
};

}  // namespace

KnownSolid solid_of_voxels(const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                           const Context& context) {
  const BettiNumbers betti = voxel_betti_numbers(voxels, context);
  if (surface == nullptr) return {std::make_unique<VoxelSolid>(voxels, grid, context), betti};
  validate(*surface);
  if (surface->triangles.empty()) throw InvalidMesh("the mesh has no triangles: distances to it are not known");
  return {std::make_unique<WindingSolid>(voxels, grid, *surface, context), betti};
}

}  // namespace blum::verifier
