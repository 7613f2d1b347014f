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

/// What the values of a surface map are.
enum class SurfaceQuantity : std::uint8_t {
  distance,       ///< to the closest point of another mesh
  self_distance,  ///< to the closest point of the mesh's own triangles that share no vertex with the texel's triangle
  ray_thickness,  ///< from the surface, straight inwards, to where the solid ends
  ball_thickness  ///< diameter of the largest ball inside of the solid that touches the surface there
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
  /// How the sign of distances to another mesh is found: negative where the surface is inside of it.
  SignMode sign = SignMode::none;
  /// Nothing further than this is looked for; >= 0, mesh units. Unset: no limit.
  std::optional<double> max_distance = {};
};

template <>
struct Description<SurfaceMapOptions> {
  static constexpr std::string_view name = "SurfaceMapOptions";
  static constexpr std::string_view doc = "What a surface map is asked for";
  static constexpr std::tuple members{
      Member{"texel", &SurfaceMapOptions::texel, "mesh units",
             "side of a texel on the surface; else such that there are about a million", Range::positive()},
      Member{"sign", &SurfaceMapOptions::sign, "",
             "how the sign of distances to other meshes is found: negative inside of them"},
      Member{"max_distance", &SurfaceMapOptions::max_distance, "mesh units", "nothing further than this is looked for",
             Range::at_least(0)},
  };
};

/// A distance vector field over the surface of a mesh, as a texture: for each texel what is closest to its point of the
/// surface. Lists of texels have rows from the top, x fastest, and atlas->size() entries.
struct SurfaceMap {
  std::shared_ptr<const SurfaceAtlas> atlas;  ///< shared by the maps of a SurfaceMapper; never null
  SurfaceQuantity quantity = SurfaceQuantity::distance;
  /// Mesh units, up to 3e38 as all that is float here. Infinite where there is nothing (within max_distance); not a
  /// number of texels of no triangle.
  Buffer<float> distance;
  /// From the point of the surface to the closest point, mesh units (of ray_thickness to the far side, of
  /// ball_thickness to where the ball touches again); zeros where there is none.
  Buffer<Vec3f> vector;
  /// What the closest point lies on, numbered as the SiteTable of the other mesh says, or of the mesh itself; none()
  /// where there is none.
  Buffer<SiteId> site;
  /// For each triangle of the mesh: how much the distance at any of its points may differ from the value that is read
  /// there from the texture, by the nearest texel or bilinearly: distances do not change by more than one moves. Mesh
  /// units. Of distances and self-distances; empty of thickness, which may jump. Where signs may jump (see
  /// ClosestPointQuery::sign_may_jump()), it holds that, too, and is large. Where nothing lies within max_distance of
  /// some texels, it counts for places that do not look at these.
  std::vector<float> error;

  /// Exact, at each vertex of the mesh; not a number at those of no triangle. Of all quantities but `distance`, as for
  /// a point of the smallest triangle at the vertex.
  std::vector<double> vertex_distance;
  struct FaceSummary {
    float smallest = 0;  ///< of the texels of the triangle; mesh units, as `distance`
    float largest = 0;
    float mean = 0;  ///< of those that are finite
  };
  std::vector<FaceSummary> faces;  ///< for each triangle of the mesh

  SignRule sign_rule = SignRule::none;
  std::string sign_reason;        ///< one sentence: why this rule
  std::vector<PhaseTime> phases;  ///< where time went
  /// That no texel has a value (WarningCode::nothing_found); of thickness, thickness_warnings() before it. None of maps
  /// from files.
  std::vector<Warning> warnings;

  /// A texel with the smallest distance; nullopt where no texel has one.
  [[nodiscard]] std::optional<std::size_t> closest_texel() const;
  /// All texels whose distance is at most this, in rising order.
  [[nodiscard]] std::vector<std::uint32_t> texels_within(double limit) const;
};

/// The distance from every point of a surface to another mesh, as a texture (Sud 2006, chapter 3).
///
/// @param target  a mesh with triangles; its segments and points get no texels.
/// @param other   any soup of triangles, segments and points. Several objects go in as one mesh.
/// @return        exact at the point of each texel, rounded to float32; in between within `error`. The same for any
///                number of threads.
/// @throws InvalidMesh, InvalidOption, OutOfMemory, Cancelled. Cost: about 0.1 to 0.2 us per texel on two cores; 28
/// bytes per texel. Method: docs/theory/surface-maps.md.
[[nodiscard]] SurfaceMap surface_distance_map(const MeshView& target, const MeshView& other,
                                              const SurfaceMapOptions& options = {}, const Context& context = {});

/// The distance from every point of a surface to the triangles, segments and points of the same mesh that share no
/// vertex with the triangle that the point lies on. `sign` is not looked at.
[[nodiscard]] SurfaceMap self_distance_map(const MeshView& target, const SurfaceMapOptions& options = {},
                                           const Context& context = {});

/// Maps of surfaces that move: the atlas stays, and so does what is known of how the meshes are connected.
class SurfaceMapper {
 public:
  /// @throws as surface_distance_map().
  SurfaceMapper(const MeshView& target, const MeshView& other, const SurfaceMapOptions& options = {},
                const Context& context = {});
  /// The same on an atlas that is there, such as one of given texture coordinates. `texel` is not looked at.
  SurfaceMapper(const MeshView& target, SurfaceAtlas atlas, const MeshView& other,
                const SurfaceMapOptions& options = {}, const Context& context = {});
  SurfaceMapper(SurfaceMapper&&) noexcept;
  SurfaceMapper& operator=(SurfaceMapper&&) noexcept;
  ~SurfaceMapper();

  /// New places of the vertices of the target, or of the other mesh. @throws InvalidMesh for another count, or one that
  /// is not finite.
  void move_target(std::span<const Vec3d> vertices);
  void move_other(std::span<const Vec3d> vertices, const Context& context = {});
  /// Another mesh instead of the other one.
  void replace_other(const MeshView& other, const Context& context = {});

  /// The map of the meshes as they are now.
  [[nodiscard]] SurfaceMap map(const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
