// Blum: distance vector fields on surfaces. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/surface_map/surface_atlas.hpp"

namespace blum {

/// Meaning of the values of a surface map.
enum class SurfaceQuantity : std::uint8_t {
  distance,       ///< Distance to the closest point of another mesh.
  self_distance,  ///< Distance to the closest point of the mesh itself. Primitives that share a vertex with the texel's
                  ///< triangle are ignored.
  ray_thickness,  ///< Distance from the surface, straight inwards, to the far side of the solid.
  ball_thickness  ///< Diameter of the largest ball inside the solid that touches the surface at the texel's point.
};

template <>
struct Description<SurfaceQuantity> {
  static constexpr std::string_view name = "SurfaceQuantity";
  static constexpr std::array values{NamedValue{SurfaceQuantity::distance, "distance"},
                                     NamedValue{SurfaceQuantity::self_distance, "self-distance"},
                                     NamedValue{SurfaceQuantity::ray_thickness, "ray-thickness"},
                                     NamedValue{SurfaceQuantity::ball_thickness, "ball-thickness"}};
};

struct SurfaceMapOptions {
  /// Side of a texel on the surface, > 0, mesh units. The default gives a texture of about a million texels.
  std::optional<double> texel = {};
  /// Rule for the sign of distances to another mesh. Signed distances are negative where the surface is inside the
  /// other mesh.
  SignMode sign = SignMode::none;
  /// Largest distance at which closest points are searched, >= 0, mesh units. Unset: no limit.
  std::optional<double> max_distance = {};
};

template <>
struct Description<SurfaceMapOptions> {
  static constexpr std::string_view name = "SurfaceMapOptions";
  static constexpr std::string_view doc = "Options of a surface map";
  static constexpr std::tuple members{
      Member{"texel", &SurfaceMapOptions::texel, "mesh units",
             "side of a texel on the surface; the default gives about a million texels", Range::positive()},
      Member{"sign", &SurfaceMapOptions::sign, "",
             "rule for the sign of distances to another mesh; distances are negative inside the other mesh"},
      Member{"max_distance", &SurfaceMapOptions::max_distance, "mesh units",
             "largest distance at which closest points are searched", Range::at_least(0)},
  };
};

/// Distance vector field over the surface of a mesh, as a texture. Each texel represents a point of the surface (see
/// surface_point()), and stores the vector from this point to the closest point. Lists with an entry for each texel
/// have atlas->size() entries, in rows from the top, x fastest.
struct SurfaceMap {
  std::shared_ptr<const SurfaceAtlas> atlas;  ///< shared by the maps of a SurfaceMapper; never null
  SurfaceQuantity quantity = SurfaceQuantity::distance;
  /// Distance at each texel's point, mesh units. Finite values of this and all other float members are at most 3e38.
  /// The distance is infinite if nothing lies within max_distance, and NaN for texels of no triangle.
  Buffer<float> distance;
  /// Vector from each texel's point to the closest point, mesh units. For ray_thickness, the vector ends at the far
  /// side; for ball_thickness, at the other point that the ball touches. The vector is zero if no end point was found.
  Buffer<Vec3f> vector;
  /// Site that contains the closest point; none() if no closest point was found. Sites are numbered as in the SiteTable
  /// of the other mesh, or of the mesh itself.
  Buffer<SiteId> site;
  /// For each triangle of the mesh: a bound on the errors of lookups, mesh units. At any point of the triangle, the
  /// exact distance differs from the result of a lookup by at most this bound. The bound holds for lookups of the
  /// nearest texel and for bilinear lookups. The bound exists because distances at two points differ by at most the
  /// distance between the points. The list is empty for thickness, because thickness may jump between two points. If
  /// signs may jump (see ClosestPointQuery::sign_may_jump()), the bound includes the jumps and is large. The bound does
  /// not hold for lookups that read a texel for which nothing lies within max_distance.
  std::vector<float> error;

  /// Exact distance or thickness at each vertex of the mesh; NaN for vertices of no triangle. For quantities other than
  /// `distance`, the vertex is treated as a point of the triangle with the smallest index among the triangles at the
  /// vertex.
  std::vector<double> vertex_distance;
  struct FaceSummary {
    float smallest = 0;  ///< smallest value of the triangle's texels, mesh units; NaN if it has no texels
    float largest = 0;
    float mean = 0;  ///< mean of the finite values; NaN if there are none
  };
  std::vector<FaceSummary> faces;  ///< for each triangle of the mesh

  SignRule sign_rule = SignRule::none;
  std::string sign_reason;        ///< Reason for the sign rule, one sentence.
  std::vector<PhaseTime> phases;  ///< Time of each phase.
  /// For distances, the warnings about signs (ClosestPointQuery::warnings()). For thickness, thickness_warnings(). The
  /// last warning is WarningCode::nothing_found if no texel has a value. Empty for maps that were read from files.
  std::vector<Warning> warnings;

  /// Returns the index of a texel with the smallest distance; nullopt if no texel has a distance.
  [[nodiscard]] std::optional<std::size_t> closest_texel() const;
  /// Returns the indices of all texels whose distance is at most `limit`, ascending.
  [[nodiscard]] std::vector<std::uint32_t> texels_within(double limit) const;
  /// Returns the smallest and the largest finite distance of the texels that belong to triangles; nullopt if none is
  /// finite.
  [[nodiscard]] std::optional<std::pair<double, double>> finite_range() const;
};

/// Computes the distance from every point of a surface to another mesh, as a texture (Sud 2006, chapter 3).
///
/// @param target  a mesh with triangles; its segments and points get no texels.
/// @param other   any soup of triangles, segments and points. To measure the distance to several objects, pass them as
///                one mesh.
/// @return        a map that is exact at the point of each texel, rounded to float32. Between texels, lookups have an
///                error of at most SurfaceMap::error. The map is the same for any number of threads.
/// @throws InvalidMesh, InvalidOption, OutOfMemory, Cancelled.
/// Cost: about 0.1 to 0.2 us per texel on two cores; 28 bytes per texel. Method: docs/theory/surface-maps.md.
[[nodiscard]] SurfaceMap surface_distance_map(const MeshView& target, const MeshView& other,
                                              const SurfaceMapOptions& options = {}, const Context& context = {});

/// Computes the distance from every point of a surface to the same mesh. For each point of the surface, primitives that
/// share a vertex with the point's triangle are ignored. SurfaceMapOptions::sign is ignored.
[[nodiscard]] SurfaceMap self_distance_map(const MeshView& target, const SurfaceMapOptions& options = {},
                                           const Context& context = {});

/// Computes maps of surfaces that move. A mapper reuses the atlas, and all data that depend only on the connectivity of
/// the meshes.
class SurfaceMapper {
 public:
  /// @throws as surface_distance_map().
  SurfaceMapper(const MeshView& target, const MeshView& other, const SurfaceMapOptions& options = {},
                const Context& context = {});
  /// Makes a mapper with an existing atlas, for example from given texture coordinates. SurfaceMapOptions::texel is
  /// ignored.
  SurfaceMapper(const MeshView& target, SurfaceAtlas atlas, const MeshView& other,
                const SurfaceMapOptions& options = {}, const Context& context = {});
  SurfaceMapper(SurfaceMapper&&) noexcept;
  SurfaceMapper& operator=(SurfaceMapper&&) noexcept;
  ~SurfaceMapper();

  /// Sets new positions of the vertices of the target, or of the other mesh.
  /// @throws InvalidMesh for another number of vertices, or for a position that is not finite.
  void move_target(std::span<const Vec3d> vertices);
  void move_other(std::span<const Vec3d> vertices, const Context& context = {});
  /// Replaces the mesh to which distances are measured.
  void replace_other(const MeshView& other, const Context& context = {});

  /// Returns the map of the meshes as they are now.
  [[nodiscard]] SurfaceMap map(const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
