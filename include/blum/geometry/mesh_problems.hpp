// Blum: the words for what keeps a mesh from bounding a solid, and what to do. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "blum/core/context.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// What keeps a mesh from bounding a solid, with how often and what may help, in one sentence; empty where it is
/// closed, oriented, manifold and faces outwards. Whether it crosses itself is not told: problem_of_crossings() does.
[[nodiscard]] std::string problem_as_solid(const Topology& facts);

/// Whether a mesh meets itself where it should not, in one sentence with two vertices or triangles; empty where it does
/// not: two vertices of triangles in one place, triangles that cross or touch. @throws Cancelled.
[[nodiscard]] std::string problem_of_places(const MeshView& mesh);
[[nodiscard]] std::string problem_of_crossings(const MeshView& mesh, const Context& context = {});
/// The same of what find_self_intersections() found.
[[nodiscard]] std::string problem_of_crossings(const SelfIntersections& found);

/// Whole sentences, and the ends of some: all that Blum says of meshes that bound no solid stands here and in
/// mesh_problems.cpp.
namespace mesh_problem {

inline constexpr std::string_view no_triangles = "the mesh has no triangles, so it bounds no solid";
inline constexpr std::string_view no_interior = "the mesh has no triangles, so it has no interior";
inline constexpr std::string_view is_an_image = "the solid is one of voxels; a closed mesh is needed here";
inline constexpr std::string_view no_solid = "the mesh bounds no solid";
inline constexpr std::string_view one_sided =
    "the mesh bounds no solid: it has one side only, so that it cannot be oriented";
inline constexpr std::string_view not_nested =
    "the mesh bounds no solid: its shells do not lie in each other, they coincide or cross";
inline constexpr std::string_view no_volume =
    "the mesh bounds no solid: a shell of it encloses no volume, so that it faces nowhere";
inline constexpr std::string_view more_than_triangles =
    "the mesh has segments or points beside its triangles, which bound no solid: leave them out";
inline constexpr std::string_view touches_when_resolved =
    "the mesh crosses itself, and what it bounds touches itself where the crossings are resolved: move these parts "
    "apart, or into each other";
/// Of "the mesh bounds no polyhedron: ...".
inline constexpr std::string_view shells_cross = "its shells do not lie in each other, they cross or coincide";

/// Why a mesh bounds no polyhedron as far as its edges tell, with all that is in the way: of "the mesh bounds no
/// polyhedron: ..."; empty where it does.
[[nodiscard]] std::string obstacles(const Topology& facts);
/// The same of pairs of triangles that cross or touch. @param is_complete  whether there are no more of them.
[[nodiscard]] std::string crossing(std::size_t pairs, bool is_complete);
[[nodiscard]] std::string touching(std::size_t pairs, bool is_complete);
/// Where the numbers of the mesh's own triangles are wanted. @param how  Solid::reason().
[[nodiscard]] std::string crosses_and_is_resolved(const std::string& how);
/// A triangle that names a vertex twice, and one without area that no flip of an edge takes out.
[[nodiscard]] std::string doubled_corner(std::size_t triangle);
[[nodiscard]] std::string without_area(std::size_t triangle);
/// The edges that keep a mesh from being closed and oriented, with how many of each kind: of "the mesh has ...".
[[nodiscard]] std::string of_edges(const Orientation& facts);

/// Of one object among several. @param name  such as "object 3".
[[nodiscard]] std::string no_triangles_in(const std::string& name);
[[nodiscard]] std::string faces_inwards(const std::string& name);
/// @param open  edges that have no two triangles in opposite directions.
/// @param is_closed_by_welding  whether merging equal vertices leaves none.
[[nodiscard]] std::string not_closed(const std::string& name, std::size_t open, bool is_closed_by_welding);
/// @param obstacle  ResolvedMesh::obstacle.
[[nodiscard]] std::string not_resolved(const std::string& name, const std::string& obstacle);

}  // namespace mesh_problem
}  // namespace blum
