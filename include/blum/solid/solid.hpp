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
  std::uint32_t body = 0;                    ///< Body that it bounds from outside, or of which it is a void.
  std::uint32_t depth = 0;                   ///< Number of other shells that contain it. At odd depth it is a void.
  std::optional<std::uint32_t> parent = {};  ///< Innermost shell that contains it.
  std::int64_t genus = 0;                    ///< Number of handles.
  double volume = 0;                         ///< Enclosed volume, > 0, cubic mesh units.
  bool is_reversed = false;                  ///< True if it faced the solid in the input.
};

template <>
struct Description<SolidShell> {
  static constexpr std::string_view name = "SolidShell";
  static constexpr std::string_view doc = "Closed shell of the surface of a polyhedron";
  static constexpr std::tuple members{
      Member{"body", &SolidShell::body, "", "body that it bounds from outside, or has as a void"},
      Member{"depth", &SolidShell::depth, "", "number of other shells around it; it is a void at odd depth"},
      Member{"parent", &SolidShell::parent, "", "innermost shell around it"},
      Member{"genus", &SolidShell::genus, "", "number of handles"},
      Member{"volume", &SolidShell::volume, "cubic mesh units", "enclosed volume, > 0"},
      Member{"is_reversed", &SolidShell::is_reversed, "", "true if it faced the solid in the input"}};
};

/// Connected part of a solid, or the whole of it, and the triangles of the input around it.
struct SolidBody {
  /// Marks a vertex that the input does not have, because triangles crossed there.
  static constexpr std::uint32_t no_vertex = ResolvedMesh::no_vertex;

  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< Vertex of the input for each vertex of `mesh`; or no_vertex.
  std::vector<std::uint32_t> triangle_of;  ///< Triangle of the input of which each triangle of `mesh` is a part.
  BettiNumbers betti{};                    ///< SolidRule::polyhedron: Betti numbers of the body.
  std::vector<std::uint32_t> shells;       ///< SolidRule::polyhedron: the outer shell, then its voids, ascending.

  /// Returns the site of the input that a site of `mesh` represents. If crossings were resolved, new vertices and edges
  /// represent a face that contains them, up to the rounding of their coordinates.
  [[nodiscard]] SiteId input_site(SiteId own, const SiteTable& own_sites, const SiteTable& input_sites) const;
};

/// Surface of a solid as one mesh.
struct SolidSurface {
  /// The surface of a polyhedron faces away from it. Its triangles are those of the input in their order, with the
  /// second and third corner of some exchanged. If crossings were resolved, they are the resulting triangles.
  TriangleMesh mesh;
  /// If crossings were resolved: vertex of the input for each vertex, or SolidBody::no_vertex. Otherwise empty, because
  /// numbers stay.
  std::vector<std::uint32_t> vertex_of;
  /// If crossings were resolved: triangle of the input of which each triangle is a part. Otherwise empty.
  std::vector<std::uint32_t> triangle_of;
};

/// Solid that a mesh or an image represents: the rule for its inside, its bodies and their topology. It is computed
/// once and passed on. Copies share the data, and many threads may read it at once.
///
/// For SolidRule::winding, the nodes of a grid that are inside depend on the grid. They are not part of the solid;
/// voxels_inside() computes them from the signs of fields.
class Solid {
 public:
  /// Returns the solid of a mesh.
  ///
  /// Closed, manifold meshes that do not cross themselves are polyhedra (SolidRule::polyhedron), shell by shell. Each
  /// outer shell and the voids in it are one body, and bodies may touch. Triangles that face another way than most of
  /// their shell are reversed, and so are shells that face the solid. Closed meshes that cross, overlap or touch
  /// themselves become such meshes if resolve_crossings() succeeds. The solid is then where their winding number is 1
  /// or more. The solid of other meshes is where that is above 1/2 (SolidRule::winding). The mesh is not needed
  /// afterwards.
  /// @throws InvalidMesh if validate(mesh) fails or no triangle exists; Cancelled.
  /// Cost: that of topology() and find_self_intersections(), and a copy of the mesh. If it crosses itself, also that of
  /// resolve_crossings() and of both again.
  [[nodiscard]] static Solid of(const MeshView& mesh, const Context& context = {});

  /// Returns the union of the selected, closed voxels of an image. Voxels that touch in a corner belong to one body.
  /// @throws InvalidImage, also if no voxel is selected; InvalidOption; Cancelled.
  [[nodiscard]] static Solid of(const VoxelImageView& image, const LabelSelection& selection = {},
                                const Context& context = {});

  [[nodiscard]] SolidRule rule() const;
  /// Returns one sentence: the reason for this rule.
  [[nodiscard]] const std::string& reason() const;

  /// Returns the reason why a mesh does not bound bodies that do not touch, in one sentence with advice. Empty if it
  /// does. Not empty if rule() is SolidRule::winding or SolidRule::voxels. Also not empty if bodies touch in more than
  /// vertices or edges with the same positions.
  [[nodiscard]] const std::string& problem() const;

  /// Returns components, tunnels and voids of the whole solid. Returns nullopt for SolidRule::winding, where only
  /// voxels have such numbers.
  [[nodiscard]] std::optional<BettiNumbers> betti() const;
  /// Returns the bodies. Those of polyhedra face outwards. SolidRule::winding: one, of all triangles. Images: none.
  [[nodiscard]] std::span<const SolidBody> bodies() const&;
  std::span<const SolidBody> bodies() const&& = delete;  // they are part of the solid
  /// Returns the surface of all bodies of a mesh, or the whole mesh if it bounds none. Images: empty.
  [[nodiscard]] const SolidSurface& surface() const&;
  const SolidSurface& surface() const&& = delete;
  /// Returns the topology of the input mesh, before any reversal or resolution. Images: zeros.
  [[nodiscard]] const Topology& topology() const&;
  const Topology& topology() const&& = delete;
  /// Returns the shells of a polyhedron in the order of their smallest triangles. Otherwise none.
  [[nodiscard]] std::span<const SolidShell> shells() const&;
  std::span<const SolidShell> shells() const&& = delete;
  /// Returns the number of shells that faced the solid and were reversed.
  [[nodiscard]] std::size_t reversed_shells() const;
  /// Returns the number of triangles that faced another way than most of their shell and were reversed.
  [[nodiscard]] std::size_t reversed_triangles() const;
  /// Returns counts of the defects that were resolved to make the mesh a polyhedron. Returns nullopt if no defect
  /// exists, or if defects were not resolved; then reason() gives the cause.
  [[nodiscard]] const std::optional<CrossingCounts>& resolved() const;
  /// SolidRule::winding: returns true if the triangles face inwards as a whole, so that hardly anything is inside.
  /// Reversing all triangles helps. The sign of the volume between them and the middle of their box decides.
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
  /// For closed and consistently oriented meshes the result is exact, for coordinates of magnitude 1e-80 to 1e100 or 0.
  /// It counts crossings of a ray. Points on the surface of a polyhedron lie in it. Other meshes use
  /// WindingNumber::is_inside(). For images it is exact up to the rounding of the grid's coordinates; voxels are
  /// closed.
  /// @param p  finite.
  /// Cost: about a microsecond. The first call also builds a search structure.
  [[nodiscard]] bool inside(const Vec3d& p) const;

  /// Returns a cell complex with the homotopy type of a polyhedron. Its report() states whether that is proven.
  /// @throws InvalidOption, also for an image, whose voxels are such a complex. InvalidMesh for SolidRule::winding, or
  /// if coordinates lie further apart than 45 orders of magnitude. InvalidGrid, OutOfMemory, Cancelled.
  /// Cost: linear in triangles, and in the cubes that the surface meets; 3 bytes per cube of the box.
  [[nodiscard]] CellularModel model(const CellularModelOptions& options = {}, const Context& context = {}) const;

 private:
  struct Data;
  explicit Solid(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

/// Checks that a solid is a polyhedron whose surface is a manifold without contacts.
/// @throws InvalidMesh if it is not: if vertices or edges of it have the same positions, or Solid::problem() is not
/// empty.
/// Cost: near-linear in the surface.
void check_manifold(const Solid& solid);

}  // namespace blum
