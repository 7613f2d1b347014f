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
  self_distance,  ///< Distance to the closest point of the mesh itself. Parts that share a vertex with the texel's
                  ///< triangle are ignored.
  ray_thickness,  ///< Distance from the surface, straight inwards, to the far side of the solid.
  ball_thickness  ///< Diameter of the largest ball inside of the solid that touches the surface there.
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
  /// Side of a texel on the surface, > 0, mesh units. Unset: about a million texels.
  std::optional<double> texel = {};
  /// Rule for the sign of distances to another mesh: negative where the surface is inside of it.
  SignMode sign = SignMode::none;
  /// Largest distance that is searched; >= 0, mesh units. Unset: no limit.
  std::optional<double> max_distance = {};
};

template <>
struct Description<SurfaceMapOptions> {
  static constexpr std::string_view name = "SurfaceMapOptions";
  static constexpr std::string_view doc = "Options of a surface map";
  static constexpr std::tuple members{
      Member{"texel", &SurfaceMapOptions::texel, "mesh units",
             "side of a texel on the surface; by default for about a million texels", Range::positive()},
      Member{"sign", &SurfaceMapOptions::sign, "",
             "rule for the sign of distances to other meshes: negative inside them"},
      Member{"max_distance", &SurfaceMapOptions::max_distance, "mesh units", "largest distance that is searched",
             Range::at_least(0)},
  };
};

/// Distance vector field over the surface of a mesh, as a texture. Each texel holds the closest point for its point of
/// the surface. Lists of texels have rows from the top, x fastest, and atlas->size() entries.
struct SurfaceMap {
  std::shared_ptr<const SurfaceAtlas> atlas;  ///< shared by the maps of a SurfaceMapper; never null
  SurfaceQuantity quantity = SurfaceQuantity::distance;
  /// Distance of each texel, mesh units, at most 3e38, as for all float members. Infinite if nothing lies within
  /// max_distance; NaN for texels of no triangle.
  Buffer<float> distance;
  /// Vector from the point of the surface to the closest point, mesh units. For ray_thickness it ends at the far side,
  /// for ball_thickness where the ball touches again. Zero if there is none.
  Buffer<Vec3f> vector;
  /// Site that contains the closest point, numbered as in the SiteTable of the other mesh, or of the mesh itself;
  /// none() if there is none.
  Buffer<SiteId> site;
  /// Error bound for each triangle of the mesh, in mesh units. At any point of the triangle, the distance differs from
  /// the texture's value by at most this. It holds for lookups by the nearest texel and bilinearly, because a distance
  /// changes by at most the distance moved. It exists for distances and self-distances; it is empty for thickness,
  /// which may jump. If signs may jump (see ClosestPointQuery::sign_may_jump()), the bound includes that and is large.
  /// If nothing lies within max_distance of some texels, it holds for lookups that do not read these.
  std::vector<float> error;

  /// Exact distance at each vertex of the mesh; NaN for vertices of no triangle. For all quantities but `distance`, it
  /// is that of a point of the smallest triangle at the vertex.
  std::vector<double> vertex_distance;
  struct FaceSummary {
    float smallest = 0;  ///< smallest value of the triangle's texels, mesh units as `distance`; NaN without texels
    float largest = 0;
    float mean = 0;  ///< mean of the finite values; NaN without any
  };
  std::vector<FaceSummary> faces;  ///< for each triangle of the mesh

  SignRule sign_rule = SignRule::none;
  std::string sign_reason;        ///< Reason for this rule, one sentence.
  std::vector<PhaseTime> phases;  ///< Time of each phase.
  /// A warning that no texel has a value (WarningCode::nothing_found). For thickness, thickness_warnings() come before
  /// it. Empty for maps from files.
  std::vector<Warning> warnings;

  /// Returns a texel with the smallest distance; nullopt if no texel has one.
  [[nodiscard]] std::optional<std::size_t> closest_texel() const;
  /// Returns all texels whose distance is at most this, in rising order.
  [[nodiscard]] std::vector<std::uint32_t> texels_within(double limit) const;
};

/// Computes the distance from every point of a surface to another mesh, as a texture (Sud 2006, chapter 3).
///
/// @param target  a mesh with triangles; its segments and points get no texels.
/// @param other   any soup of triangles, segments and points. Pass several objects as one mesh.
/// @return        exact at the point of each texel, rounded to float32; between them within `error`. The same for any
///                number of threads.
/// @throws InvalidMesh, InvalidOption, OutOfMemory, Cancelled.
/// Cost: about 0.1 to 0.2 us per texel on two cores; 28 bytes per texel. Method: docs/theory/surface-maps.md.
[[nodiscard]] SurfaceMap surface_distance_map(const MeshView& target, const MeshView& other,
                                              const SurfaceMapOptions& options = {}, const Context& context = {});

/// Computes the distance from every point of a surface to the same mesh. For each point, the triangles, segments and
/// points that share a vertex with its triangle are ignored. `sign` is ignored.
[[nodiscard]] SurfaceMap self_distance_map(const MeshView& target, const SurfaceMapOptions& options = {},
                                           const Context& context = {});

/// Computes maps of surfaces that move. It keeps the atlas, and what depends only on the connectivity of the meshes.
class SurfaceMapper {
 public:
  /// @throws as surface_distance_map().
  SurfaceMapper(const MeshView& target, const MeshView& other, const SurfaceMapOptions& options = {},
                const Context& context = {});
  /// Makes a mapper with an existing atlas, for example one of given texture coordinates. `texel` is ignored.
  SurfaceMapper(const MeshView& target, SurfaceAtlas atlas, const MeshView& other,
                const SurfaceMapOptions& options = {}, const Context& context = {});
  SurfaceMapper(SurfaceMapper&&) noexcept;
  SurfaceMapper& operator=(SurfaceMapper&&) noexcept;
  ~SurfaceMapper();

  /// Sets new positions of the vertices of the target, or of the other mesh.
  /// @throws InvalidMesh for another count, or a position that is not finite.
  void move_target(std::span<const Vec3d> vertices);
  void move_other(std::span<const Vec3d> vertices, const Context& context = {});
  /// Replaces the other mesh.
  void replace_other(const MeshView& other, const Context& context = {});

  /// Returns the map of the meshes as they are now.
  [[nodiscard]] SurfaceMap map(const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
