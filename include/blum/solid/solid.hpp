// Blum: the solid that a mesh or an image represents. SPDX-License-Identifier: Apache-2.0
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

#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/resolve_crossings.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/solid/cellular_model.hpp"
#include "blum/solid/solid_rule.hpp"

namespace blum {

/// Closed shell of the surface of a polyhedron.
struct SolidShell {
  std::uint32_t body = 0;   ///< Body that this shell bounds, as its outer shell or as the boundary of a void.
  std::uint32_t depth = 0;  ///< Number of other shells that contain this one. If odd, this shell bounds a void.
  std::optional<std::uint32_t> parent = {};  ///< Innermost other shell that contains this shell; unset if none does.
  std::int64_t genus = 0;                    ///< Number of handles.
  double volume = 0;                         ///< Enclosed volume, > 0, cubic mesh units.
  bool is_reversed = false;                  ///< True if the shell faced into the solid in the input.
};

template <>
struct Description<SolidShell> {
  static constexpr std::string_view name = "SolidShell";
  static constexpr std::string_view doc = "Closed shell of the surface of a polyhedron";
  static constexpr std::tuple members{
      Member{"body", &SolidShell::body, "", "body whose outer shell this is, or in which it bounds a void"},
      Member{"depth", &SolidShell::depth, "", "number of other shells that contain it; if odd, it bounds a void"},
      Member{"parent", &SolidShell::parent, "", "innermost other shell that contains this one"},
      Member{"genus", &SolidShell::genus, "", "number of handles"},
      Member{"volume", &SolidShell::volume, "cubic mesh units", "enclosed volume, > 0"},
      Member{"is_reversed", &SolidShell::is_reversed, "", "true if it faced the solid in the input"}};
};

/// Body of a mesh: a connected part of a polyhedron, or all of a solid with SolidRule::winding. A SolidBody stores the
/// triangles of the input that bound the body.
struct SolidBody {
  /// Value of `vertex_of` for a vertex that the input does not have, because triangles crossed there.
  static constexpr std::uint32_t no_vertex = ResolvedMesh::no_vertex;

  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< For each vertex of `mesh`: its index in the input, or no_vertex.
  std::vector<std::uint32_t> triangle_of;  ///< For each triangle of `mesh`: the input's triangle that contains it.
  BettiNumbers betti{};                    ///< SolidRule::polyhedron: Betti numbers of the body.
  std::vector<std::uint32_t> shells;  ///< SolidRule::polyhedron: the outer shell, then the shells of voids, ascending.

  /// Returns the site of the input that a site of `mesh` represents. If crossings were resolved, the result for a new
  /// vertex or edge is a face of the input. Up to rounding of coordinates, this face contains the vertex or edge.
  [[nodiscard]] SiteId input_site(SiteId own, const SiteTable& own_sites, const SiteTable& input_sites) const;
};

/// Surface of a solid as one mesh.
struct SolidSurface {
  /// The surface of a polyhedron faces away from the solid. The triangles are those of the input in their order, with
  /// the second and third corner of some triangles exchanged. If crossings were resolved, the triangles are those of
  /// ResolvedMesh.
  TriangleMesh mesh;
  /// If crossings were resolved: for each vertex, its index in the input, or SolidBody::no_vertex. Otherwise empty,
  /// because indices are those of the input.
  std::vector<std::uint32_t> vertex_of;
  /// If crossings were resolved: for each triangle, the triangle of the input that contains it. Otherwise empty.
  std::vector<std::uint32_t> triangle_of;
};

/// Solid that a mesh or an image represents. This class stores the rule that decides which points are inside, the
/// bodies of the solid, and their topology. Compute a Solid once and pass it to all functions that need one. Copies
/// share their data, and many threads may read it at the same time.
///
/// For SolidRule::winding, this class does not store voxels, because voxels depend on a grid. Call voxels_inside() for
/// the voxels of a grid that are inside.
class Solid {
 public:
  /// Returns the solid of a mesh.
  ///
  /// A closed, manifold mesh that does not cross itself bounds a polyhedron (SolidRule::polyhedron). Each outer shell,
  /// with the shells of the voids in it, bounds one body. Bodies may touch each other. Triangles that face against the
  /// majority of their shell are reversed. Shells that face into the solid are reversed, too. If a closed mesh crosses,
  /// overlaps or touches itself, resolve_crossings() is called. If it resolves the crossings, the solid is the
  /// polyhedron of the points with a winding number of 1 or more. For all other meshes, the solid consists of the
  /// points with a winding number above 1/2 (SolidRule::winding). The mesh may be destroyed after the call.
  /// @throws InvalidMesh if validate(mesh) fails or no triangle exists; Cancelled.
  /// Cost: that of topology() and find_self_intersections(), and a copy of the mesh. If the mesh crosses itself, also
  /// that of resolve_crossings(), and of topology() and find_self_intersections() for its result.
  [[nodiscard]] static Solid of(const MeshView& mesh, const Context& context = {});

  /// Returns the union of the selected, closed voxels of an image. Voxels that touch in a corner belong to one body.
  /// @throws InvalidImage, also if no voxel is selected; InvalidOption; Cancelled.
  [[nodiscard]] static Solid of(const VoxelImageView& image, const LabelSelection& selection = {},
                                const Context& context = {});

  [[nodiscard]] SolidRule rule() const;
  /// Returns the reason for rule() in one sentence.
  [[nodiscard]] const std::string& reason() const;

  /// Returns an empty string if the solid is a polyhedron whose bodies do not touch. Otherwise returns one sentence
  /// with the reason and advice. Contacts in vertices or edges at the same positions are ignored here; check_manifold()
  /// reports them. For SolidRule::winding and SolidRule::voxels, the string is never empty.
  [[nodiscard]] const std::string& problem() const;

  /// Returns the numbers of components, tunnels and voids of the whole solid. Returns nullopt for SolidRule::winding,
  /// because the numbers of such a solid depend on a grid of voxels.
  [[nodiscard]] std::optional<BettiNumbers> betti() const;
  /// Returns the bodies. Bodies of a polyhedron face outwards. SolidRule::winding: one body with all triangles. Images:
  /// none.
  [[nodiscard]] std::span<const SolidBody> bodies() const&;
  std::span<const SolidBody> bodies() const&& = delete;  // bodies are part of the solid
  /// Returns the surface of all bodies of a polyhedron. SolidRule::winding: the whole mesh. Images: empty.
  [[nodiscard]] const SolidSurface& surface() const&;
  const SolidSurface& surface() const&& = delete;
  /// Returns the topology of the input mesh, before any reversal or resolution. Images: zeros.
  [[nodiscard]] const Topology& topology() const&;
  const Topology& topology() const&& = delete;
  /// Returns the shells of a polyhedron in the order of their smallest triangles. Other rules: none.
  [[nodiscard]] std::span<const SolidShell> shells() const&;
  std::span<const SolidShell> shells() const&& = delete;
  /// Returns the number of shells that faced into the solid and were reversed.
  [[nodiscard]] std::size_t reversed_shells() const;
  /// Returns the number of triangles that faced against the majority of their shell and were reversed.
  [[nodiscard]] std::size_t reversed_triangles() const;
  /// Returns counts of the defects that were resolved to make the mesh a polyhedron. Returns nullopt if the mesh has no
  /// defects, or if defects were not resolved. If defects were not resolved, reason() gives the cause.
  [[nodiscard]] const std::optional<CrossingCounts>& resolved() const;
  /// SolidRule::winding: returns true if the triangles face inwards as a whole, so that almost no point is inside. The
  /// remedy is to reverse all triangles. The sign of the volume between the triangles and the middle of their box
  /// decides.
  [[nodiscard]] bool faces_inwards() const;

  /// Returns the box around the input mesh, mesh units. Images: the box of all voxels, selected or not.
  [[nodiscard]] const Box3& box() const;
  /// Returns the sites of the input mesh. Images: empty.
  [[nodiscard]] const SiteTable& sites() const;
  /// Returns the selected voxels of an image, on grid(). Meshes: empty.
  [[nodiscard]] const VoxelSet& voxels() const;
  /// Returns the grid of an image's voxel centres.
  [[nodiscard]] const GridSpec& grid() const;

  /// Returns true if a point lies in the solid.
  ///
  /// For closed and consistently oriented meshes, crossings of a ray are counted. The result is then exact if all
  /// coordinates are 0 or have magnitudes of 1e-80 to 1e100. Points on the surface of a polyhedron count as inside. For
  /// other meshes, the result is that of WindingNumber::is_inside(). For images, the result is exact up to the rounding
  /// of the grid's coordinates, and voxels include their borders.
  /// @param p  finite.
  /// Cost: about a microsecond. The first call also builds a search structure.
  [[nodiscard]] bool inside(const Vec3d& p) const;

  /// Returns a cell complex with the homotopy type of a polyhedron. CellularModel::report() states if this homotopy
  /// type is proven.
  /// @throws InvalidOption, also for an image, because its voxels already are such a complex. InvalidMesh for
  /// SolidRule::winding, or if a non-zero coordinate is more than 45 orders of magnitude smaller than the largest
  /// coordinate. InvalidGrid, OutOfMemory, Cancelled.
  /// Cost: linear in the number of triangles, and of cubes that the surface meets; 3 bytes of memory per cube of the
  /// grid.
  [[nodiscard]] CellularModel model(const CellularModelOptions& options = {}, const Context& context = {}) const;

 private:
  struct Data;
  explicit Solid(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

/// Checks that a solid is a polyhedron whose surface is a manifold without contacts.
/// @throws InvalidMesh if two vertices or two edges of the surface have the same positions, or if Solid::problem() is
/// not empty.
/// Cost: near-linear in the surface.
void check_manifold(const Solid& solid);

}  // namespace blum
