// Blum: what the verifier asks a solid. SPDX-License-Identifier: Apache-2.0
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

/// A value that is made when it is first asked for, and then kept. Many threads may ask at once: one makes it, the
/// others wait. Where making it throws, the next one that asks tries again.
template <class T>
class Lazy {
 public:
  /// @param make  gives the value, the same whoever asks. It must not ask for the same one.
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

/// Where a point lies.
struct Location {
  std::uint32_t body = 0;  ///< that it lies in, or outside of all of them, the closest one
  double distance = 0;     ///< from the surface of that body
  double outside_by = 0;   ///< distance from the solid; 0 inside
  double depth = 0;        ///< in that body, from its boundary; below 0 outside
};

/// A point of the surface, and how much of the surface it stands for.
struct Sample {
  Vec3d point;
  double area = 0;
};

struct Samples {
  std::vector<Sample> list;
  double step = 0;  ///< each point of the surface is at most this far from a sample
};

/// A solid and its surface. All of it may be asked from many threads at once.
class SolidOracle {
 public:
  SolidOracle() = default;
  SolidOracle(const SolidOracle&) = delete;
  SolidOracle& operator=(const SolidOracle&) = delete;
  virtual ~SolidOracle() = default;

  [[nodiscard]] virtual double diagonal() const = 0;  ///< of its box
  [[nodiscard]] virtual Box3 box(std::uint32_t body) const = 0;
  /// Of the box of a body, which may be turned.
  [[nodiscard]] virtual double diagonal(std::uint32_t body) const { return box(body).diagonal(); }
  [[nodiscard]] virtual Location locate(const Vec3d& p) const = 0;
  /// Exact distance of a point from the surface of a body.
  [[nodiscard]] virtual double distance(const Vec3d& p, std::uint32_t body) const = 0;
  /// The same; where it is below `enough` maybe more, but below it, too, which costs less.
  [[nodiscard]] virtual double distance_above(const Vec3d& p, double /*enough*/, std::uint32_t body) const {
    return distance(p, body);
  }
  /// How deep a point lies in a body; below 0 outside of it. No two points differ by more than they are apart.
  [[nodiscard]] virtual double depth(const Vec3d& p, std::uint32_t body) const = 0;
  /// The same, but below 0 wherever the boundary is closer than `near`; and where `other_depth` is above that, or below
  /// its negative, that of another point near by is used, which costs less.
  [[nodiscard]] virtual double depth_beside(const Vec3d& p, std::uint32_t body, const Vec3d& /*other*/,
                                            double /*other_depth*/, double /*near*/) const {
    return depth(p, body);
  }
  /// Whether the segment between two points is known to lie in a body, boundary included; false also where this solid
  /// cannot tell.
  [[nodiscard]] virtual bool holds(const Vec3d& /*a*/, const Vec3d& /*b*/, std::uint32_t /*body*/) const {
    return false;
  }
  /// Whether the segment between two points is known to meet no boundary of a body; false also where rounding leaves
  /// doubt, or this solid cannot tell.
  [[nodiscard]] virtual bool is_clear(const Vec3d& /*a*/, const Vec3d& /*b*/, std::uint32_t /*body*/) const {
    return false;
  }
  /// The same for a triangle, sides included.
  [[nodiscard]] virtual bool is_clear(const std::array<Vec3d, 3>& /*triangle*/, std::uint32_t /*body*/) const {
    return false;
  }
  /// Whether a part of a segment between two points that is outside of a body crosses a gap: no way along the surface,
  /// within `reach` of that part, leads from where it goes out to where it comes in; nullopt where that cannot be told.
  [[nodiscard]] virtual std::optional<bool> crosses_gap(const Vec3d& /*a*/, const Vec3d& /*b*/, std::uint32_t /*body*/,
                                                        double /*reach*/) const {
    return false;
  }
  /// The closest point of the surface of a body.
  [[nodiscard]] virtual Vec3d closest_point(const Vec3d& p, std::uint32_t body) const = 0;
  /// The same, and maybe faster, where some point of it is known to be within a distance.
  [[nodiscard]] virtual Vec3d closest_point_within(const Vec3d& p, double /*within*/, std::uint32_t body) const {
    return closest_point(p, body);
  }
  /// A random point of a body beside its surface, all parts of this alike; nullopt where there is none, or the surface
  /// has no triangles.
  [[nodiscard]] virtual std::optional<Vec3d> beside_surface(std::uint32_t /*body*/, Random& /*random*/) const {
    return std::nullopt;
  }
  /// Whether the surface is that of the bodies, and has triangles.
  [[nodiscard]] virtual bool has_triangles() const { return false; }
  /// The diagonal of a voxel, where the solid is made of voxels; else 0.
  [[nodiscard]] virtual double grain() const { return 0; }
  /// How far outside of the solid is not outside: 0, unless only voxels tell inside from outside.
  [[nodiscard]] virtual double slack() const { return 0; }
  /// Distance of a point from a site; HUGE_VAL where there is no such site.
  [[nodiscard]] virtual double distance_from_site(const Vec3d& p, SiteId site) const = 0;
  /// What linking and winding numbers are taken with; nullptr where that is not known. Made once. @throws Cancelled.
  [[nodiscard]] const Complement* complement(const Context& context) const;
  /// Points of the surface, close enough together for `step` unless they would be too many. Those of the last step are
  /// kept. @throws Cancelled.
  [[nodiscard]] std::shared_ptr<const Samples> samples(double step, const Context& context) const;

 private:
  [[nodiscard]] virtual std::unique_ptr<Complement> make_complement(const Context& /*context*/) const {
    return nullptr;
  }
  [[nodiscard]] virtual Samples make_samples(double step, const Context& context) const = 0;

  Lazy<std::unique_ptr<Complement>> complement_;
  mutable std::mutex samples_mutex_;
  mutable std::shared_ptr<const Samples> samples_;  ///< the last ones
  mutable double step_of_samples_ = 0;
};

/// No more samples of a mesh than this are taken, unless it has more triangles. Each is searched for among all balls,
/// which is told and not judged: five times as many cost more than all that is judged.
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

  /// Made once.
  [[nodiscard]] const DrawnBalls& drawn_balls() const;

 private:
  struct Later;
  std::unique_ptr<Later> later_;
};

/// What closed shells bound. @param named  the mesh whose sites distances are asked of: the input.
/// @throws InvalidMesh, Cancelled. The meshes must outlive the solid.
[[nodiscard]] KnownSolid solid_of_mesh(const MeshView& mesh, const MeshView& named, const Context& context);

/// Closed voxels. @param surface  distances are to its triangles; nullptr: to the voxels' faces.
/// @throws InvalidMesh where the surface has no triangles, InvalidGrid where the grid does not cover it, Cancelled. The
/// voxels and the mesh must outlive the solid.
[[nodiscard]] KnownSolid solid_of_voxels(const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                                         const Context& context);

}  // namespace blum::verifier
