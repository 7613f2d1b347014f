// Blum: queries to a solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/random.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "certificate/homology/complement.hpp"

namespace blum::verifier {

class StatedSites;

/// Number that stands for the absence of a wall.
inline constexpr std::uint32_t no_wall = 0xffffffffU;

/// A value that is computed when it is first needed, and then kept. If several threads need it at once, one computes it
/// and the others wait. If the computation throws, the next request tries again.
template <class T>
class Lazy {
 public:
  /// @param make  computes the value, the same for every caller. The callable must not request the same value.
  template <class Make>
  const T& get(const Make& make) const {
    const std::scoped_lock lock(mutex_);
    if (!value_) value_.emplace(make());
    return *value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
};

/// The location of a point.
struct Location {
  std::uint32_t body = 0;  ///< the body around the point; the closest one if it is outside all
  double distance = 0;     ///< distance from the surface of that body
  double outside_by = 0;   ///< distance from the solid; 0 inside
  double depth = 0;        ///< distance from the boundary of that body; negative outside
};

/// A point of the surface, and the area that it represents.
struct Sample {
  Vec3d point;
  double area = 0;
};

struct Samples {
  std::vector<Sample> list;
  double step = 0;  ///< each point of the surface is at most this far from a sample
};

/// A solid and its surface. All functions are thread-safe.
class SolidOracle {
 public:
  SolidOracle() = default;
  SolidOracle(const SolidOracle&) = delete;
  SolidOracle& operator=(const SolidOracle&) = delete;
  virtual ~SolidOracle() = default;

  [[nodiscard]] virtual double diagonal() const = 0;  ///< diagonal of the solid's box
  [[nodiscard]] virtual Box3 box(std::uint32_t body) const = 0;
  /// Returns the diagonal of the box of a body, which may be rotated.
  [[nodiscard]] virtual double diagonal(std::uint32_t body) const { return box(body).diagonal(); }
  [[nodiscard]] virtual Location locate(const Vec3d& p) const = 0;
  /// Returns the exact distance of a point from the surface of a body.
  [[nodiscard]] virtual double distance(const Vec3d& p, std::uint32_t body) const = 0;
  /// Returns the exact distance if it is at least `enough`. If the distance is smaller, returns a value below `enough`,
  /// which may be larger than the distance. This costs less.
  [[nodiscard]] virtual double distance_above(const Vec3d& p, double /*enough*/, std::uint32_t body) const {
    return distance(p, body);
  }
  /// Returns the depth of a point in a body; negative outside. The depths of two points differ by at most their
  /// distance.
  [[nodiscard]] virtual double depth(const Vec3d& p, std::uint32_t body) const = 0;
  /// Returns the depth of a point near the point `other`, whose depth is known. Returns a negative value if the
  /// boundary is closer than `near`. If the absolute value of `other_depth` is above `near`, that depth is used, which
  /// costs less.
  [[nodiscard]] virtual double depth_beside(const Vec3d& p, std::uint32_t body, const Vec3d& /*other*/,
                                            double /*other_depth*/, double /*near*/) const {
    return depth(p, body);
  }
  /// Returns true if the segment between two points is known to lie in a body, boundary included. Also returns false if
  /// this solid cannot decide.
  [[nodiscard]] virtual bool holds(const Vec3d& /*a*/, const Vec3d& /*b*/, std::uint32_t /*body*/) const {
    return false;
  }
  /// Returns true if the segment between two points is known not to meet the boundary of a body. Also returns false if
  /// rounding leaves this open, or this solid cannot decide.
  [[nodiscard]] virtual bool is_clear(const Vec3d& /*a*/, const Vec3d& /*b*/, std::uint32_t /*body*/) const {
    return false;
  }
  /// Returns true if a triangle, sides included, is known not to meet the boundary of a body.
  [[nodiscard]] virtual bool is_clear(const std::array<Vec3d, 3>& /*triangle*/, std::uint32_t /*body*/) const {
    return false;
  }
  /// Returns true if a part of a segment outside a body crosses a gap. In this case, no path along the surface, within
  /// `reach` of the part, joins the ends of the part. Returns nullopt if that is undecided.
  [[nodiscard]] virtual std::optional<bool> crosses_gap(const Vec3d& /*a*/, const Vec3d& /*b*/, std::uint32_t /*body*/,
                                                        double /*reach*/) const {
    return false;
  }
  /// Returns the closest point of the surface of a body.
  [[nodiscard]] virtual Vec3d closest_point(const Vec3d& p, std::uint32_t body) const = 0;
  /// Returns the closest point, possibly faster, if a point of the surface is known to be within the distance `within`.
  [[nodiscard]] virtual Vec3d closest_point_within(const Vec3d& p, double /*within*/, std::uint32_t body) const {
    return closest_point(p, body);
  }
  /// Returns a random point just inside the surface of a body, with uniform density. Returns nullopt if there is none,
  /// or if the surface has no triangles.
  [[nodiscard]] virtual std::optional<Vec3d> beside_surface(std::uint32_t /*body*/, Random& /*random*/) const {
    return std::nullopt;
  }
  /// Returns the number of vertices of the surface of a body; 0 if the surface has no triangles.
  [[nodiscard]] virtual std::size_t corners(std::uint32_t /*body*/) const { return 0; }
  /// Returns the middle of a chord from a vertex of the surface of a body. The chord has about the mean direction of
  /// the triangles around the vertex. At the end of a rod or the border of a plate, that is about the end of their
  /// middle. Returns nullopt if there is none, or if that is undecided.
  /// @param corner  below corners().
  [[nodiscard]] virtual std::optional<Vec3d> behind_corner(std::uint32_t /*body*/, std::size_t /*corner*/) const {
    return std::nullopt;
  }
  /// Returns true if the surface is that of the bodies, and has triangles.
  [[nodiscard]] virtual bool has_triangles() const { return false; }
  /// Returns the diagonal of a voxel if the solid consists of voxels, otherwise 0.
  [[nodiscard]] virtual double grain() const { return 0; }
  /// Returns how far outside the voxels a point is still treated as inside: 0, unless only voxels define the inside of
  /// a mesh.
  [[nodiscard]] virtual double slack() const { return 0; }
  /// Returns the smallest and the largest number of the walls (SurfaceWalls) of a body that contain a point of its
  /// surface. The two numbers differ at an edge between walls. Returns no_wall twice if the surface is not that of the
  /// bodies, or has no triangles.
  [[nodiscard]] virtual std::array<std::uint32_t, 2> walls_at(const Vec3d& /*point*/, std::uint32_t /*body*/) const {
    return {no_wall, no_wall};
  }
  /// Returns true if two walls belong to one smooth part of the surface.
  [[nodiscard]] virtual bool are_smooth(std::uint32_t wall, std::uint32_t other) const { return wall == other; }
  /// Returns the sites by their numbers in files of Voronoi diagrams. Returns nullptr if the surface is not that of the
  /// bodies, or if it has other triangles than the input.
  [[nodiscard]] virtual const StatedSites* stated_sites() const { return nullptr; }
  /// Returns the distance of a point from a site; HUGE_VAL if the site does not exist.
  [[nodiscard]] virtual double distance_from_site(const Vec3d& p, SiteId site) const = 0;
  /// Returns the paths and points for linking and winding numbers; nullptr if they are unknown. They are computed once.
  /// @throws Cancelled.
  [[nodiscard]] const Complement* complement(const Context& context) const;
  /// Returns samples of the surface, close enough together for `step` unless they would be too many. The samples of the
  /// last step are kept.
  /// @throws Cancelled.
  [[nodiscard]] std::shared_ptr<const Samples> samples(double step, const Context& context) const;

 private:
  [[nodiscard]] virtual std::unique_ptr<Complement> make_complement(const Context& /*context*/) const {
    return nullptr;
  }
  [[nodiscard]] virtual Samples make_samples(double step, const Context& context) const = 0;

  Lazy<std::unique_ptr<Complement>> complement_;
  mutable std::mutex samples_mutex_;
  mutable std::shared_ptr<const Samples> samples_;  ///< samples of the last step
  mutable double step_of_samples_ = 0;
};

/// Largest number of samples of a mesh, unless it has more triangles. For each sample all balls are searched, and the
/// result is only reported. Five times as many samples would cost more than all checks that can fail.
inline constexpr std::size_t most_samples = 50'000;

class DrawnBalls;

/// A solid, and the Betti numbers of its bodies.
struct KnownSolid {
  std::unique_ptr<SolidOracle> solid;
  std::vector<BettiNumbers> bodies;

  KnownSolid(std::unique_ptr<SolidOracle> own, std::vector<BettiNumbers> betti);
  KnownSolid(KnownSolid&&) noexcept;
  KnownSolid& operator=(KnownSolid&&) noexcept;
  ~KnownSolid();

  /// Returns the balls drawn from random points. They are computed once.
  [[nodiscard]] const DrawnBalls& drawn_balls() const;

 private:
  struct Later;
  std::unique_ptr<Later> later_;
};

/// Returns the solid that closed shells bound. The meshes must outlive it.
/// @param named  the input mesh, to whose sites distance_from_site() refers.
/// @throws InvalidMesh, Cancelled.
[[nodiscard]] KnownSolid solid_of_mesh(const MeshView& mesh, const MeshView& named, const Context& context);

/// Returns the solid of closed voxels. The voxels and the mesh must outlive it.
/// @param surface  the mesh to which distances are measured; nullptr: they are measured to the voxels' faces.
/// @throws InvalidMesh if the surface has no triangles, InvalidGrid if the grid does not cover it, Cancelled.
[[nodiscard]] KnownSolid solid_of_voxels(const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                                         const Context& context);

}  // namespace blum::verifier
