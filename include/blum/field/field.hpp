// Blum: distance fields with the closest site at every node. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
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
  };
};

/// Distance and closest site at every node of a grid.
struct Field {
  GridSpec grid;
  /// Distance in mesh units, negative inside when signed; +-band beyond the band. One per node, x fastest.
  Buffer<float> distance;
  /// Closest site; none() beyond the band. One per node, x fastest; empty where no sites were asked for.
  Buffer<SiteId> site;
  SiteIds site_ids = SiteIds::features;
  std::optional<double> band = {};  ///< half-width, mesh units
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;         ///< one sentence: why this rule
  Device device;                   ///< where it was computed: never `automatic`
  std::string device_reason = {};  ///< one sentence: why on the CPU, where `automatic` was asked for; else empty
  std::vector<PhaseTime> phases;
};

/// Exact distance and closest site at every node of a grid.
///
/// @param mesh  any soup of triangles, segments and points (see MeshView); it must pass validate(mesh).
/// @param grid  at most 2^40 nodes; must pass validate(grid).
/// @return      with D the diagonal of the box around mesh and grid: distances within 1e-6 D of exact; sites whose own
///              exact distance is within 1e-6 D of the smallest; at nodes further than 1e-6 D from the surface, signs
///              those of the winding number (of `normals`, those of the orientation: inverted for meshes that are
///              inside out, and not defined where closed shells neither all face the solid nor all face away from it,
///              or cross). The same bytes for any number of threads.
///              Devices agree within these bounds.
/// @throws InvalidMesh, InvalidGrid, InvalidOption, OutOfMemory, DeviceError, Cancelled.
/// Cost: about O(nodes + sites log sites); 8 bytes per node, without sites 4. (A CUDA device takes 8 on the way where
/// signs are found by sites: `normals` of shells that cross or face different ways.)
/// Method: docs/theory/fields.md (Sud 2006, ch. 2).
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options = {},
                                   const Context& context = {});

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

  /// Moves the last computed field out of the solver; the next frame gets new buffers.
  [[nodiscard]] Field take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
