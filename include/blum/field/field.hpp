// Blum: distance fields with the closest site at every node. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
#include "blum/core/device.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

/// How the sign of a field is asked for.
enum class SignMode : std::uint8_t {
  automatic,  ///< `normals` where the mesh is closed, consistently oriented, faces outwards, and no two of its
              ///< triangles touch or cross but neighbours; else `winding`. A function of the mesh alone, whatever the
              ///< grid
  normals,    ///< the side that the orientation of a closed, consistently oriented mesh tells. Exact: crossings are
            ///< counted along the grid's rows. Angle-weighted pseudonormals (Baerentzen, Aanaes 2005) decide only where
            ///< shells cross or face different ways
  winding,  ///< generalized winding number (Jacobson 2013) above 1/2 is inside; any soup
  none      ///< unsigned
};

/// How the sign of a field was found.
enum class SignRule : std::uint8_t {
  none,
  normals,
  winding,
  label,
  balls  ///< inside where a ball is (ball_union_field)
};

/// What the site values of a field count.
enum class SiteIds : std::uint8_t {
  features,   ///< vertices, edges, faces, numbered as SiteTable says
  triangles,  ///< the smallest triangle that the closest site lies on
  voxels      ///< linear indices of voxels (fields of images)
};

/// Which sites may be second at a node, given its closest one.
enum class SecondRule : std::uint8_t {
  no_common_vertex,  ///< those that share no vertex (by index) with the closest site, each with its border: a face with
                     ///< its edges and corners, an edge with its ends
  other_object       ///< those that belong to no object that the closest site belongs to
};

template <>
struct Description<SecondRule> {
  static constexpr std::string_view name = "SecondRule";
  static constexpr std::array values{NamedValue{SecondRule::no_common_vertex, "no-common-vertex"},
                                     NamedValue{SecondRule::other_object, "other-object"}};
};
template <>
struct Description<SignMode> {
  static constexpr std::string_view name = "SignMode";
  static constexpr std::array values{NamedValue{SignMode::automatic, "auto"}, NamedValue{SignMode::normals, "normals"},
                                     NamedValue{SignMode::winding, "winding"}, NamedValue{SignMode::none, "none"}};
};
template <>
struct Description<SignRule> {
  static constexpr std::string_view name = "SignRule";
  static constexpr std::array values{NamedValue{SignRule::none, "none"}, NamedValue{SignRule::normals, "normals"},
                                     NamedValue{SignRule::winding, "winding"}, NamedValue{SignRule::label, "label"},
                                     NamedValue{SignRule::balls, "balls"}};
};
template <>
struct Description<SiteIds> {
  static constexpr std::string_view name = "SiteIds";
  static constexpr std::array values{NamedValue{SiteIds::features, "features"},
                                     NamedValue{SiteIds::triangles, "triangles"},
                                     NamedValue{SiteIds::voxels, "voxels"}};
};

struct FieldOptions {
  /// How the sign is found; the distance is negative inside.
  SignMode sign = SignMode::automatic;
  /// Half-width of a narrow band, > 0, in mesh units. Beyond it nodes get +-band and no site. Unset: the full grid.
  std::optional<double> band = {};
  /// What the site values count: features or triangles.
  SiteIds site_ids = SiteIds::features;
  /// Whether the field gets its closest sites. Without them it takes half the memory; distances are the same bytes.
  bool sites = true;
  /// 1: the closest site of every node. 2: the second as well, which `second` chooses. On the CPU only.
  int order = 1;
  /// Which sites may be second; looked at where `order` is 2.
  SecondRule second = SecondRule::no_common_vertex;
};

template <>
struct Description<FieldOptions> {
  static constexpr std::string_view name = "FieldOptions";
  static constexpr std::string_view doc = "What a field is asked for";
  static constexpr std::array of_meshes{SiteIds::features, SiteIds::triangles};
  static constexpr std::tuple members{
      Member{"sign", &FieldOptions::sign, "",
             "how the sign is found; inside is negative. 'auto' goes by orientation where the mesh is closed and "
             "simple, else by winding numbers"},
      Member{"band", &FieldOptions::band, "mesh units",
             "half-width of a narrow band; beyond it nodes get +-band and no site", Range::positive()},
      Member{"site_ids", &FieldOptions::site_ids, "", "what sites count: vertices, edges and faces, or triangles",
             Range{}, of_meshes},
      Member{"sites", &FieldOptions::sites, "", "the closest site of every node, which takes half of the memory"},
      Member{"order", &FieldOptions::order, "",
             "how many closest sites each node gets, with their distances: 1 or 2 (on the CPU)", Range::between(1, 2)},
      Member{"second", &FieldOptions::second, "",
             "of order 2, which sites may be second: those without a common vertex with the closest one, or those of "
             "another object (a connected part of the mesh)"},
  };
};

/// Distance and closest site at every node of a grid; of order 2 also the second site.
struct Field {
  GridSpec grid;
  /// Distance in mesh units, negative inside when signed; +-band beyond the band. One per node, x fastest.
  Buffer<float> distance;
  /// Closest site; none() beyond the band. One per node, x fastest; empty where no sites were asked for.
  Buffer<SiteId> site;
  /// Distance to the second site, mesh units, >= 0 inside and outside. Where no site may be second: +infinity. With a
  /// band: the band's half-width where no site within the band may be second. One per node; empty for fields of order
  /// 1.
  Buffer<float> distance2;
  /// The second site; none() where there is none, or it is beyond the band. One per node; empty for fields of order 1,
  /// and where no sites were asked for.
  Buffer<SiteId> site2;
  std::optional<SecondRule> second = {};  ///< which sites may be second; none of order 1
  SiteIds site_ids = SiteIds::features;
  std::optional<double> band = {};  ///< half-width, mesh units
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;         ///< one sentence: why this rule
  Device device;                   ///< where it was computed: never `automatic`
  std::string device_reason = {};  ///< one sentence: why on the CPU, where `automatic` was asked for; else empty
  std::vector<PhaseTime> phases;

  [[nodiscard]] int order() const { return distance2.empty() ? 1 : 2; }
};

/// Exact distance and closest site at every node of a grid; of order 2 also the second site.
///
/// @param mesh  any soup of triangles, segments and points (see MeshView); it must pass validate(mesh).
/// @param grid  at most 2^40 nodes; must pass validate(grid).
/// @return      with D the diagonal of the box around mesh and grid: distances within 1e-6 D of exact; sites whose own
///              exact distance is within 1e-6 D of the smallest; at nodes further than 1e-6 D from the surface, signs
///              those of the winding number (of `normals`, those of the orientation: inverted for meshes that are
///              inside out, and not defined where closed shells neither all face the solid nor all face away from it,
///              or cross). The same bytes for any number of threads.
///              Devices agree within these bounds. Of order 2: `distance` and `site` are those of order 1, byte for
///              byte; with the sites that may be second beside the reported `site`, `distance2` and `site2` keep the
///              promises of `distance` and `site`. Of sites at the same computed distance the one with the smallest id
///              is taken. Objects are the connected parts of the mesh: vertices that triangles or segments join.
/// @throws InvalidMesh, InvalidGrid, InvalidOption, OutOfMemory, DeviceError, Cancelled.
/// Cost: about O(nodes + sites log sites); 8 bytes per node, without sites 4. (A CUDA device takes 8 on the way where
/// signs are found by sites: `normals` of shells that cross or face different ways.) Order 2 takes twice that memory
/// and, without signs, three to four times the time.
/// Method: docs/theory/fields.md (Sud 2006, ch. 2 and 4).
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options = {},
                                   const Context& context = {});
/// The same with objects of the caller's, for SecondRule::other_object.
///
/// @param objects  one number per vertex of the mesh: which object it belongs to. An edge or face belongs to the
///                 objects of all of its vertices. Empty: the connected parts of the mesh.
/// @throws InvalidOption also where there is not one number per vertex, or the options ask for nothing of objects.
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, std::span<const std::uint32_t> objects,
                                   const FieldOptions& options, const Context& context = {});

/// Computes fields of a deforming mesh on one grid, frame after frame, and keeps its buffers between frames.
/// Vertices may move and the topology may change at every frame; nothing is precomputed that outlives a frame except
/// the edge list, which is reused while the connectivity stays the same.
class FieldSolver {
 public:
  /// @throws InvalidGrid, InvalidOption, OutOfMemory, DeviceError.
  explicit FieldSolver(const GridSpec& grid, const FieldOptions& options = {}, const Context& context = {});
  FieldSolver(FieldSolver&&) noexcept;
  FieldSolver& operator=(FieldSolver&&) noexcept;
  ~FieldSolver();

  /// The field of this frame's mesh; valid until the next call. Equal, byte for byte, to distance_field's.
  /// @throws as distance_field; the solver stays usable.
  const Field& compute(const MeshView& mesh);
  /// The same with a context for this frame alone, which it can be cancelled by. Its device is not looked at.
  const Field& compute(const MeshView& mesh, const Context& context);

  /// Which object each vertex of the following frames belongs to, instead of the connected parts of their meshes; an
  /// empty list goes back to these. Copied. @throws InvalidOption where the options ask for nothing of objects.
  void set_objects(std::span<const std::uint32_t> objects);

  /// Moves the last computed field out of the solver; the next frame gets new buffers.
  [[nodiscard]] Field take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
