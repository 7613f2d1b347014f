// Blum: the solid that a mesh or an image stands for. SPDX-License-Identifier: Apache-2.0
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

/// A closed shell of the surface of a polyhedron.
struct SolidShell {
  std::uint32_t body = 0;                    ///< that it bounds from outside, or that it is a void of
  std::uint32_t depth = 0;                   ///< number of other shells that it lies in: at odd depth it is a void
  std::optional<std::uint32_t> parent = {};  ///< the innermost shell that it lies in
  std::int64_t genus = 0;                    ///< number of handles
  double volume = 0;                         ///< that it encloses, > 0, cubic mesh units
  bool is_reversed = false;                  ///< whether it faced the solid in the input
};

template <>
struct Description<SolidShell> {
  static constexpr std::string_view name = "SolidShell";
  static constexpr std::string_view doc = "A closed shell of the surface of a polyhedron";
  static constexpr std::tuple members{
      Member{"body", &SolidShell::body, "", "that it bounds from outside, or that it is a void of"},
      Member{"depth", &SolidShell::depth, "", "number of other shells that it lies in: at odd depth it is a void"},
      Member{"parent", &SolidShell::parent, "", "the innermost shell that it lies in"},
      Member{"genus", &SolidShell::genus, "", "number of handles"},
      Member{"volume", &SolidShell::volume, "cubic mesh units", "that it encloses, > 0"},
      Member{"is_reversed", &SolidShell::is_reversed, "", "whether it faced the solid in the input"}};
};

/// A connected part of a solid, or the whole of it, and the triangles of the input around it.
struct SolidBody {
  /// Of a vertex that the input does not have: where triangles crossed.
  static constexpr std::uint32_t no_vertex = ResolvedMesh::no_vertex;

  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of;    ///< of each vertex of `mesh`, in the input; or no_vertex
  std::vector<std::uint32_t> triangle_of;  ///< of each triangle of `mesh`, that of the input which it is a part of
  BettiNumbers betti{};                    ///< SolidRule::polyhedron: of the body
  std::vector<std::uint32_t> shells;       ///< SolidRule::polyhedron: the outer one, then its voids, rising

  /// The site of the input that a site of `mesh` stands for. Where crossings were resolved, new vertices and edges
  /// stand for a face that they lie on, up to the rounding of their coordinates.
  [[nodiscard]] SiteId input_site(SiteId own, const SiteTable& own_sites, const SiteTable& input_sites) const;
};

/// The surface of a solid as one mesh.
struct SolidSurface {
  /// Of a polyhedron it faces away from it. Triangles are those of the input in their order, with the second and third
  /// corner of some exchanged; where crossings were resolved, those that were made.
  TriangleMesh mesh;
  /// Where crossings were resolved: of each vertex, in the input, or SolidBody::no_vertex. Else empty: numbers stay.
  std::vector<std::uint32_t> vertex_of;
  /// Where crossings were resolved: of each triangle, that of the input which it is a part of. Else empty.
  std::vector<std::uint32_t> triangle_of;
};

/// The solid that a mesh or an image stands for: which rule tells its inside, its bodies and their topology. It is
/// found once and passed on, and asked of nothing else: copies share what was found, and all of it may be asked from
/// many threads at once.
///
/// What of a grid's nodes lies inside, where no polyhedron is bounded (SolidRule::winding), depends on that grid and is
/// not part of the solid: voxels_inside() tells it by the signs of fields.
class Solid {
 public:
  /// Closed, manifold meshes that do not cross themselves are polyhedra (SolidRule::polyhedron), shell by shell: each
  /// outer shell and the voids in it are one body, and bodies may touch. Triangles that face another way than most of
  /// their shell are reversed, and so are shells that face the solid. Closed meshes that cross, overlap or touch
  /// themselves become such ones where resolve_crossings() can: the solid is where their winding number is 1 or more.
  /// For other meshes it is where that is above 1/2 (SolidRule::winding). The mesh may go away.
  /// @throws InvalidMesh unless it passes validate(mesh), and where there are no triangles; Cancelled.
  /// Cost: that of topology() and find_self_intersections(), and a copy of the mesh; where it crosses itself, that of
  /// resolve_crossings() and of both again.
  [[nodiscard]] static Solid of(const MeshView& mesh, const Context& context = {});

  /// The union of the selected, closed voxels of an image; those that touch in a corner are one body.
  /// @throws InvalidImage (also when no voxel is selected), InvalidOption, Cancelled.
  [[nodiscard]] static Solid of(const VoxelImageView& image, const LabelSelection& selection = {},
                                const Context& context = {});

  [[nodiscard]] SolidRule rule() const;
  /// One sentence: why this rule.
  [[nodiscard]] const std::string& reason() const;

  /// What keeps a mesh from bounding bodies that do not touch, in one sentence with what to do; empty where nothing
  /// does. Not empty where rule() is SolidRule::winding, and where bodies touch each other in more than vertices or
  /// edges that have their places in common.
  [[nodiscard]] const std::string& problem() const;

  /// Components, tunnels and voids of the whole solid; nullopt for SolidRule::winding, where only voxels have numbers.
  [[nodiscard]] std::optional<BettiNumbers> betti() const;
  /// Polyhedra: each faces outwards. SolidRule::winding: one, of all triangles. Images: none.
  [[nodiscard]] std::span<const SolidBody> bodies() const&;
  std::span<const SolidBody> bodies() const&& = delete;  // they go away with the solid
  /// Meshes: the surface of all bodies, or of what there is where none is bounded. Images: empty.
  [[nodiscard]] const SolidSurface& surface() const&;
  const SolidSurface& surface() const&& = delete;
  /// Meshes: the facts of the input as it was given, before anything was reversed or resolved. Images: zeros.
  [[nodiscard]] const Topology& topology() const&;
  const Topology& topology() const&& = delete;
  /// Polyhedra: in the order of their smallest triangles. Else none.
  [[nodiscard]] std::span<const SolidShell> shells() const&;
  std::span<const SolidShell> shells() const&& = delete;
  /// How many shells faced the solid and were reversed.
  [[nodiscard]] std::size_t reversed_shells() const;
  /// How many triangles faced another way than most of their shell and were reversed.
  [[nodiscard]] std::size_t reversed_triangles() const;
  /// What stood in the way of the mesh being a polyhedron, where that was resolved; nullopt where nothing did, and
  /// where reason() says why it was not.
  [[nodiscard]] const std::optional<CrossingCounts>& resolved() const;
  /// SolidRule::winding: whether the triangles face inwards as a whole, so that hardly anything is inside: reversing
  /// them all is what helps. Judged by the volume between them and the middle of their box.
  [[nodiscard]] bool faces_inwards() const;

  /// Meshes: the box around the input, mesh units. Images: that of all voxels of the image, selected or not.
  [[nodiscard]] const Box3& box() const;
  /// Meshes: the sites of the input. Images: empty.
  [[nodiscard]] const SiteTable& sites() const;
  /// Images: the selected voxels, on grid(). Meshes: empty.
  [[nodiscard]] const VoxelSet& voxels() const;
  /// Images: the grid of the voxels' centres.
  [[nodiscard]] const GridSpec& grid() const;

  /// Whether a point lies in the solid. Exact, for coordinates of magnitude 1e-80 to 1e100 or 0, where the mesh is
  /// closed and consistently oriented: crossings of a ray are counted; points of the surface of a polyhedron lie in it.
  /// Elsewhere as WindingNumber::is_inside(). For images exact up to the rounding of the grid's coordinates; voxels are
  /// closed.
  /// @param p  finite.  Cost: about a microsecond; the first call also builds what it searches in.
  [[nodiscard]] bool inside(const Vec3d& p) const;

  /// A cell complex with the homotopy type of a polyhedron: look at its report() for whether that is proven.
  /// @throws InvalidOption, also for an image, whose voxels are such a complex; InvalidMesh for SolidRule::winding, and
  /// where coordinates lie further apart than 45 orders of magnitude; InvalidGrid, OutOfMemory, Cancelled.
  /// Cost: linear in triangles, and in the cubes that the surface meets; 3 bytes for each cube of the box.
  [[nodiscard]] CellularModel model(const CellularModelOptions& options = {}, const Context& context = {}) const;

 private:
  struct Data;
  explicit Solid(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

/// @throws InvalidMesh where a solid is no polyhedron whose surface is a manifold apart from itself: vertices or edges
/// of it have their places in common, or Solid::problem() is not empty. Cost: near-linear in the surface.
void check_manifold(const Solid& solid);

}  // namespace blum
