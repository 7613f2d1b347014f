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

/// Requested rule for the sign of a field.
enum class SignMode : std::uint8_t {
  automatic,  ///< Unsigned if the mesh has no triangles. `normals` if it is closed, consistently oriented and faces
              ///< outwards, and no triangles but neighbours touch or cross. For `normals` it must also have no free
              ///< segments or points, and no triangle too flat for a normal. Else `winding`. This depends on the mesh
              ///< alone, not on the grid.
  normals,    ///< Side given by the orientation of a closed, consistently oriented mesh. Exact: crossings are counted
              ///< along the grid's rows. Angle-weighted pseudonormals (Baerentzen, Aanaes 2005) decide only if shells
              ///< cross or face different ways.
  winding,    ///< Generalized winding number (Jacobson 2013): above 1/2 is inside. For any soup.
  none        ///< Unsigned.
};

/// Rule that decided the signs of a field.
enum class SignRule : std::uint8_t {
  none,
  normals,
  winding,
  label,
  balls  ///< inside if a ball contains the node (ball_union_field)
};

/// Numbering of the site values of a field.
enum class SiteIds : std::uint8_t {
  features,   ///< vertices, edges, faces, numbered as in SiteTable
  triangles,  ///< smallest triangle that contains the closest site
  voxels      ///< linear indices of voxels (fields of images)
};

/// Sites that may be second at a node, given its closest one.
enum class SecondRule : std::uint8_t {
  no_common_vertex,  ///< Sites that share no vertex (by index) with the closest site. Both count with their border: a
                     ///< face with its edges and corners, an edge with its ends.
  other_object       ///< Sites of no object that the closest site belongs to.
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
  /// Rule for the sign; the distance is negative inside.
  SignMode sign = SignMode::automatic;
  /// Half-width of a narrow band, > 0 and finite, in mesh units. Beyond it nodes get +-band and no site. Unset: the
  /// full grid.
  std::optional<double> band = {};
  /// Numbering of the site values: features or triangles.
  SiteIds site_ids = SiteIds::features;
  /// True: the field gets its closest sites. False: it takes half the memory, and distances are the same bytes.
  bool sites = true;
  /// 1: the closest site of every node. 2: also the second site, selected by `second`. On the CPU only.
  int order = 1;
  /// Sites that may be second; used if `order` is 2.
  SecondRule second = SecondRule::no_common_vertex;
};

template <>
struct Description<FieldOptions> {
  static constexpr std::string_view name = "FieldOptions";
  static constexpr std::string_view doc = "Options of a field";
  static constexpr std::array of_meshes{SiteIds::features, SiteIds::triangles};
  static constexpr std::tuple members{
      Member{"sign", &FieldOptions::sign, "",
             "rule for the sign, negative inside; 'auto' uses orientation if the mesh is closed and simple, else "
             "winding numbers"},
      Member{"band", &FieldOptions::band, "mesh units",
             "half-width of a narrow band; beyond it nodes get +-band and no site", Range::positive()},
      Member{"site_ids", &FieldOptions::site_ids, "",
             "numbering of sites: features (vertices, edges and faces) or triangles", Range{}, of_meshes},
      Member{"sites", &FieldOptions::sites, "", "the closest site of every node, which takes half of the memory"},
      Member{"order", &FieldOptions::order, "",
             "number of closest sites per node, with their distances: 1, or 2 on the CPU", Range::between(1, 2)},
      Member{"second", &FieldOptions::second, "",
             "for order 2, possible second sites: without a common vertex with the closest one, or of another object "
             "(connected part of the mesh)"},
  };
};

/// Distance and closest site at every node of a grid; for order 2 also the second site.
struct Field {
  GridSpec grid;
  /// Distance in mesh units, negative inside when signed; +-band beyond the band. One per node, x fastest.
  Buffer<float> distance;
  /// Closest site; none() beyond the band. One per node, x fastest; empty if no sites were requested.
  Buffer<SiteId> site;
  /// Distance to the second site, mesh units, >= 0 inside and outside. If no site may be second, it is +infinity. With
  /// a band it is the half-width if no site within the band may be second. One per node; empty for fields of order 1.
  Buffer<float> distance2;
  /// Second site; none() if none exists, or it lies beyond the band. One per node. Empty for fields of order 1, and if
  /// no sites were requested.
  Buffer<SiteId> site2;
  std::optional<SecondRule> second = {};  ///< sites that may be second; unset for order 1
  SiteIds site_ids = SiteIds::features;
  std::optional<double> band = {};  ///< half-width, mesh units
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;         ///< reason for this rule, one sentence
  Device device;                   ///< device that computed it; never `automatic`
  std::string device_reason = {};  ///< if `automatic` was requested: reason for the CPU, one sentence; else empty
  std::vector<PhaseTime> phases;

  [[nodiscard]] int order() const { return distance2.empty() ? 1 : 2; }
};

/// Computes the exact distance and closest site at every node of a grid; for order 2 also the second site.
///
/// @param mesh  any soup of triangles, segments and points (see MeshView); must pass validate(mesh).
/// @param grid  at most 2^40 nodes; must pass validate(grid).
/// @return      the field. Let D be the diagonal of the box around mesh and grid. Distances are within 1e-6 D of exact.
///              The exact distance of each reported site is within 1e-6 D of the smallest one. At nodes further than
///              1e-6 D from the surface, signs are those of the winding number. The signs of `normals` are those of the
///              orientation instead. They are inverted for meshes that are inside out. They are undefined if closed
///              shells cross, or neither all face the solid nor all face away from it. The bytes are the same for any
///              number of threads. Devices agree within these bounds. For order 2, `distance` and `site` are those of
///              order 1, byte for byte. `distance2` and `site2` have the same guarantees, among the sites that may be
///              second beside the reported `site`. Among sites at the same computed distance, the one with the smallest
///              id is reported. Objects are the connected parts of the mesh: vertices joined by triangles or segments.
/// @throws InvalidMesh, InvalidGrid, InvalidOption, OutOfMemory, DeviceError, Cancelled.
/// Cost: about O(nodes + sites log sites); 8 bytes per node, without sites 4. A CUDA device temporarily takes 8 if
/// signs are found by sites (`normals` of shells that cross or face different ways). Order 2 takes twice that memory
/// and, without signs, three to four times the time.
/// Method: docs/theory/fields.md (Sud 2006, ch. 2 and 4).
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options = {},
                                   const Context& context = {});
/// Computes the same field with objects of the caller, for SecondRule::other_object.
///
/// @param objects  one number per vertex of the mesh: the object of the vertex. An edge or face belongs to the objects
///                 of all of its vertices. Empty: the connected parts of the mesh.
/// @throws InvalidOption, also for another count of numbers, or if the options do not use objects.
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, std::span<const std::uint32_t> objects,
                                   const FieldOptions& options, const Context& context = {});

/// Computes fields of a deforming mesh on one grid, frame after frame, and keeps its buffers between frames. Vertices
/// may move and the topology may change at every frame. The edge list is reused while the connectivity stays the same.
/// The plan of signs keeps hints that speed up the next frame. Nothing else outlives a frame, and results do not depend
/// on it.
class FieldSolver {
 public:
  /// @throws InvalidGrid, InvalidOption, OutOfMemory, DeviceError.
  explicit FieldSolver(const GridSpec& grid, const FieldOptions& options = {}, const Context& context = {});
  FieldSolver(FieldSolver&&) noexcept;
  FieldSolver& operator=(FieldSolver&&) noexcept;
  ~FieldSolver();

  /// Computes the field of this frame's mesh; valid until the next call. It equals that of distance_field(), byte for
  /// byte.
  /// @throws as distance_field; the solver stays usable.
  const Field& compute(const MeshView& mesh);
  /// Computes the field with a context for this frame alone, which can cancel it. The context's device is ignored.
  const Field& compute(const MeshView& mesh, const Context& context);

  /// Sets the object of each vertex of the following frames, instead of the connected parts of their meshes. An empty
  /// list restores these. The list is copied.
  /// @throws InvalidOption if the options do not use objects.
  void set_objects(std::span<const std::uint32_t> objects);

  /// Moves the last computed field out of the solver. The next frame gets new buffers.
  [[nodiscard]] Field take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
