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
#include "blum/core/warning.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

/// Requested rule for the sign of a field.
enum class SignMode : std::uint8_t {
  automatic,  ///< `none` is chosen if the mesh has no triangles. `normals` is chosen if the mesh is closed,
              ///< consistently oriented and faces outwards, and no triangles cross or touch beyond shared corners and
              ///< edges. The mesh must also have no free segments or points, and every triangle must have a normal
              ///< (none is too flat). Otherwise `winding` is chosen. The choice depends on the mesh, not on the grid.
              ///< If the mesh is closed, triangles and shells that face the wrong way are first reversed, for the signs
              ///< only, with a warning. So the inside of a closed mesh does not depend on the way its triangles face.
  normals,    ///< The orientation of the mesh decides which side is inside. The mesh must be closed and consistently
              ///< oriented. Signs are exact, because crossings with the mesh are counted along the rows of the grid. If
              ///< shells cross or face different ways, angle-weighted pseudonormals (Baerentzen, Aanaes 2005) decide
              ///< instead.
  winding,    ///< A node is inside if its generalized winding number (Jacobson 2013) is above 1/2. Winding numbers
              ///< exist for any soup of triangles.
  none        ///< Distances are unsigned.
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
  triangles,  ///< smallest index of a triangle that contains the closest site
  voxels      ///< linear indices of voxels (fields of images)
};

/// Rule that decides which sites may be the second site of a node. The rule depends on the closest site of the node.
enum class SecondRule : std::uint8_t {
  no_common_vertex,  ///< Sites that share no vertex (by index) with the closest site. Here, the vertices of a face are
                     ///< its corners, and the vertices of an edge are its ends.
  other_object       ///< Sites that have no object in common with the closest site (see distance_field()).
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
  /// Half-width of the band around the surface, > 0 and finite, in mesh units. Nodes with a larger distance get +-band
  /// and no site. Unset: no limit.
  std::optional<double> band = {};
  /// Numbering of the site values: features or triangles.
  SiteIds site_ids = SiteIds::features;
  /// True: the field contains the closest site of every node. False: the field contains no sites and takes half the
  /// memory. The distances do not depend on this option.
  bool sites = true;
  /// 1: the field contains the closest site of every node. 2: it also contains the second site of every node, by the
  /// rule `second`. Only the CPU computes order 2.
  int order = 1;
  /// Rule for second sites; used if `order` is 2.
  SecondRule second = SecondRule::no_common_vertex;
};

template <>
struct Description<FieldOptions> {
  static constexpr std::string_view name = "FieldOptions";
  static constexpr std::string_view doc = "Options of a field";
  static constexpr std::array of_meshes{SiteIds::features, SiteIds::triangles};
  static constexpr std::tuple members{
      Member{"sign", &FieldOptions::sign, "",
             "rule for the sign, which is negative inside; 'auto': by orientation if the mesh is closed and does not "
             "cross itself, otherwise by winding numbers"},
      Member{"band", &FieldOptions::band, "mesh units",
             "half-width of a band around the surface; nodes beyond it get the distance +-band and no site",
             Range::positive()},
      Member{"site_ids", &FieldOptions::site_ids, "",
             "numbering of sites: features (vertices, edges and faces) or triangles", Range{}, of_meshes},
      Member{"sites", &FieldOptions::sites, "", "true: store the closest sites, which doubles the memory"},
      Member{"order", &FieldOptions::order, "",
             "number of closest sites per node, with their distances: 1, or (on the CPU only) 2", Range::between(1, 2)},
      Member{"second", &FieldOptions::second, "",
             "for order 2, sites that may be second: without a common vertex with the closest site, or of another "
             "object (connected part of the mesh)"},
  };
};

/// Distance and closest site at every node of a grid; for order 2 also the second site.
struct Field {
  GridSpec grid;
  /// Distance of each node in mesh units, x fastest. If the field is signed, the distance is negative inside. Beyond
  /// the band, it is +-band.
  Buffer<float> distance;
  /// Closest site of each node, x fastest; none() beyond the band. The list is empty if no sites were requested.
  Buffer<SiteId> site;
  /// Distance of each node to its second site, in mesh units, >= 0 inside and outside. If no site may be second, the
  /// distance is +infinity. If the field has a band and no site within the band may be second, the distance is the
  /// half-width of the band. The list is empty for fields of order 1.
  Buffer<float> distance2;
  /// Second site of each node; none() if no second site exists, or if it lies beyond the band. The list is empty for
  /// fields of order 1, and if no sites were requested.
  Buffer<SiteId> site2;
  std::optional<SecondRule> second = {};  ///< rule for second sites; unset for order 1
  SiteIds site_ids = SiteIds::features;
  std::optional<double> band = {};  ///< half-width of the band, mesh units; unset without a band
  SignRule sign_rule = SignRule::none;
  std::string sign_reason;  ///< reason for sign_rule, one sentence
  /// Warnings about the signs. WarningCode::facing: parts of the mesh face the wrong way. WarningCode::nothing_inside:
  /// no node is inside the mesh. The list has at most one of these warnings, and is empty for fields of images and of
  /// balls. Fields read from NRRD files instead have warnings about coordinate frames that disagree, as in ImageFile.
  std::vector<Warning> warnings = {};
  Device device;                   ///< device that computed the field; never `automatic`
  std::string device_reason = {};  ///< reason in one sentence if `automatic` was requested and the CPU was chosen;
                                   ///< otherwise empty
  std::vector<PhaseTime> phases;

  [[nodiscard]] int order() const { return distance2.empty() ? 1 : 2; }
};

/// Computes the exact distance and closest site at every node of a grid; for order 2 also the second site.
///
/// @param mesh  any soup of triangles, segments and points (see MeshView); must pass validate(mesh).
/// @param grid  at most 2^40 nodes; must pass validate(grid).
/// @return      the field. Let D be the diagonal of the box around mesh and grid. Each distance is within 1e-6 D of the
///              exact distance. The exact distance between a node and its reported site is within 1e-6 D of the node's
///              smallest distance to any site. Signs are guaranteed at nodes further than 1e-6 D from the surface. With
///              `winding`, the winding number decides the signs. With `normals`, the orientation decides the signs,
///              which are inverted if the mesh is inside out. With `normals`, signs are undefined if closed shells
///              cross, or if some shells face the solid and others face away from it. The bytes are the same for any
///              number of threads. CPU and CUDA devices agree within these bounds. For order 2, `distance` and `site`
///              are those of order 1, byte for byte. `distance2` and `site2` have the same guarantees, among the sites
///              that may be second if `site` is the closest site. If several sites have the same computed distance, the
///              one with the smallest id is reported. The objects are the connected parts of the mesh; triangles and
///              segments connect their vertices.
/// @throws InvalidMesh, InvalidGrid, InvalidOption, OutOfMemory, DeviceError, Cancelled.
/// Cost: about O(nodes + sites log sites). The field takes 8 bytes per node, or 4 without sites. A CUDA device
/// temporarily takes 8 bytes per node, also without sites, if the closest sites decide signs. This is the case with
/// `normals` if shells cross or face different ways. Order 2 takes twice the memory of order 1. An unsigned field of
/// order 2 takes three to four times as long as one of order 1. Method: docs/theory/fields.md (Sud 2006, ch. 2 and 4).
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options = {},
                                   const Context& context = {});
/// Computes the same field with objects that the caller defines, for SecondRule::other_object.
///
/// @param objects  one number per vertex of the mesh: the number of the object that the vertex belongs to. An edge or
///                 face belongs to the objects of all of its vertices. If the list is empty, the objects are the
///                 connected parts of the mesh.
/// @throws InvalidOption, also if the numbers of objects and vertices differ, or if the options do not use objects.
[[nodiscard]] Field distance_field(const MeshView& mesh, const GridSpec& grid, std::span<const std::uint32_t> objects,
                                   const FieldOptions& options, const Context& context = {});

/// Computes fields of a deforming mesh on one grid, frame after frame, and keeps its buffers between frames. Vertices
/// may move and the topology may change at every frame. The list of edges is reused while the connectivity stays the
/// same. Hints for the signs are kept to speed up the next frame. Results do not depend on earlier frames.
class FieldSolver {
 public:
  /// @throws InvalidGrid, InvalidOption, OutOfMemory, DeviceError.
  explicit FieldSolver(const GridSpec& grid, const FieldOptions& options = {}, const Context& context = {});
  FieldSolver(FieldSolver&&) noexcept;
  FieldSolver& operator=(FieldSolver&&) noexcept;
  ~FieldSolver();

  /// Computes the field of this frame's mesh. The field equals that of distance_field(), byte for byte. The reference
  /// is valid until the next call of compute() or take().
  /// @throws as distance_field(). After an error, the solver can still be used.
  const Field& compute(const MeshView& mesh);
  /// Computes the field with a context for this frame alone, which can cancel it. The context's device is ignored.
  const Field& compute(const MeshView& mesh, const Context& context);

  /// Sets the object of each vertex for the following frames. Before the first call, and after a call with an empty
  /// list, the objects are the connected parts of each mesh. The list is copied.
  /// @throws InvalidOption if the options do not select order 2 and SecondRule::other_object.
  void set_objects(std::span<const std::uint32_t> objects);

  /// Moves the last computed field out of the solver. The next frame gets new buffers.
  [[nodiscard]] Field take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blum
