// Blum: smooth patches of the sites of a Voronoi diagram. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/surface_shape.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/voronoi_sites.hpp"

namespace blum {

struct VoronoiPatchOptions {
  /// Degrees. Faces form one patch if they are connected through edges that bend by at most this angle.
  double patch_angle = 30;
  /// Mesh units. If set, a patch of faces is a connected part of a plane, sphere, cylinder or cone. The vertices of a
  /// patch are at most this far from its shape. Edges inside a patch bend by at most `patch_angle`.
  std::optional<double> patch_fit = {};
};

template <>
struct Description<VoronoiPatchOptions> {
  static constexpr std::string_view name = "VoronoiPatchOptions";
  static constexpr std::string_view doc = "Options of the patches of a Voronoi diagram's sites";
  static constexpr std::tuple members{
      Member{"patch_angle", &VoronoiPatchOptions::patch_angle, "degrees",
             "largest bend at an edge between two faces of one patch", Range::between(0, 180)},
      Member{"patch_fit", &VoronoiPatchOptions::patch_fit, "mesh units",
             "largest distance of vertices from the plane, sphere, cylinder or cone of their patch; default: no shapes "
             "are fitted",
             Range::positive()},
  };
};

/// Sites of one smooth part of a polyhedron's border, which together are treated as one site. Patches have three kinds:
///
///   face    Faces that are connected through edges with small bends, and the reflex edges and vertices inside this
///           part of the border. For example, all sites of a cylinder's side.
///   edge    Connected reflex edges between the same two patches of faces, and the reflex vertices along them. For
///           example, the circle at the foot of a cylinder that stands on a plate.
///   vertex  A reflex vertex between patches. The vertex lies on no chain of reflex edges of the kind `edge`.
struct VoronoiPatch {
  SiteKind kind = SiteKind::face;
  std::vector<std::int32_t> sites;         ///< Numbers of its sites as in voronoi_sites(), ascending.
  std::optional<SurfaceShape> shape = {};  ///< The fitted shape of a patch of faces, if `patch_fit` is set.
};

template <>
struct Description<VoronoiPatch> {
  static constexpr std::string_view name = "VoronoiPatch";
  static constexpr std::string_view doc = "Sites of one smooth part of a polyhedron's border";
  static constexpr std::tuple members{
      Member{"kind", &VoronoiPatch::kind, "", "face: faces; edge: reflex edges between patches; vertex: one vertex"},
      Member{"sites", &VoronoiPatch::sites, "", "sites of the patch, including reflex edges and vertices inside it"},
      Member{"shape", &VoronoiPatch::shape, "",
             "plane, sphere, cylinder or cone that fits the faces, if patch_fit is set"},
  };
};

/// Returns the patches of the sites of a polyhedron. Patch k has the number k in `patch_a` and `patch_b` of
/// add_patch_columns(), and in graphs of patches. Patches of faces come first, in the order of their first triangles,
/// as in AxisGraph::patches. Patches of edges come next, and patches of vertices last, each in the order of their
/// smallest sites. The normal of a face is the mean normal of its triangles. A face without triangles belongs to no
/// patch, because it was joined to another face (VoronoiReport::joined_faces).
/// With `patch_fit`, each patch of faces is a part of the shape that fits it. Flat faces that fit no sphere, cylinder
/// or cone are planes. If several shapes fit, the shape with the largest part is chosen; for parts of similar size, the
/// smallest deviation decides (docs/theory/voronoi.md, "Fitted patches"). Patches do not depend on the number of
/// threads.
/// @param sites  result of voronoi_sites() for this mesh.
/// @throws InvalidOption if the angle or the tolerance is out of range, or if the sites are not those of the mesh;
/// InvalidMesh; Cancelled. Cost: O(n log n) for n triangles, about 1 us per triangle; about 20 us with `patch_fit`.
[[nodiscard]] std::vector<VoronoiPatch> voronoi_patches(const MeshView& mesh, std::span<const VoronoiSite> sites,
                                                        const VoronoiPatchOptions& options = {},
                                                        const Context& context = {});

/// Adds the columns `patch_a` and `patch_b` (int32) to the triangles of a complex. The columns contain the patches of
/// site_a and site_b, the smaller number first. On the surface, `patch_a` is -1. If both sites belong to the same
/// patch, the two numbers are equal. Existing columns of these names are replaced.
/// @param complex  with the columns `site_a` and `site_b`.
/// @throws InvalidOption if a column is missing, or if no patch has a site of the complex.
void add_patch_columns(Complex& complex, std::span<const VoronoiPatch> patches);

}  // namespace blum
