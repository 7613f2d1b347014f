// Blum: messages about meshes that bound no solid, with remedies. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "blum/core/context.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Returns the reason why a mesh bounds no solid, in one sentence with counts and possible remedies. The text is empty
/// if the mesh is closed, oriented, manifold and faces outwards. This function does not search for self-crossings;
/// problem_of_crossings() finds them.
[[nodiscard]] std::string problem_as_solid(const Topology& facts);

/// Return a sentence if a mesh touches or crosses itself; else an empty text. The sentence contains the indices of two
/// vertices or triangles. The first function looks for two vertices of triangles at the same position. The second one
/// looks for triangles that cross, or touch beyond shared corners and edges.
/// @throws Cancelled.
[[nodiscard]] std::string problem_of_places(const MeshView& mesh);
[[nodiscard]] std::string problem_of_crossings(const MeshView& mesh, const Context& context = {});
/// Returns the sentence of problem_of_crossings(mesh) for a given result of find_self_intersections().
[[nodiscard]] std::string problem_of_crossings(const SelfIntersections& found);

/// Messages and ends of messages. All messages of Blum about meshes that bound no solid are in this namespace and in
/// mesh_problems.cpp.
namespace mesh_problem {

inline constexpr std::string_view no_triangles = "the mesh has no triangles, so it bounds no solid";
inline constexpr std::string_view no_interior = "the mesh has no triangles, so it has no interior";
inline constexpr std::string_view is_an_image = "the solid is made of voxels; a closed mesh is needed here";
inline constexpr std::string_view no_solid = "the mesh bounds no solid";
inline constexpr std::string_view one_sided =
    "the mesh bounds no solid: it has only one side, so it cannot be oriented";
inline constexpr std::string_view not_nested =
    "the mesh bounds no solid: its shells are not nested: they coincide or cross";
inline constexpr std::string_view no_volume =
    "the mesh bounds no solid: one of its shells encloses no volume, so it has no inside";
inline constexpr std::string_view more_than_triangles =
    "the mesh has segments or points besides its triangles, which bound no solid: remove them";
inline constexpr std::string_view touches_when_resolved =
    "the mesh crosses itself, and its solid touches itself once the crossings are resolved: move these parts apart, or "
    "into each other";
/// End of a message "the mesh bounds no polyhedron: ...".
inline constexpr std::string_view shells_cross = "its shells are not nested: they cross or coincide";

/// Returns all defects of edges and vertices because of which a mesh bounds no polyhedron. The text is the end of a
/// message "the mesh bounds no polyhedron: ...". The text is empty if edges and vertices have no defects.
[[nodiscard]] std::string obstacles(const Topology& facts);
/// Return the end of a message "the mesh bounds no polyhedron: ..." for pairs of triangles that cross or touch.
/// @param is_complete  false if more than `pairs` pairs exist.
[[nodiscard]] std::string crossing(std::size_t pairs, bool is_complete);
[[nodiscard]] std::string touching(std::size_t pairs, bool is_complete);
/// Returns the message of functions that need the triangles of the mesh itself, if the mesh crosses or touches itself.
/// @param how  text of Solid::reason().
[[nodiscard]] std::string crosses_and_is_resolved(const std::string& how);
/// Return the messages for a triangle with the same vertex at two corners, and for a triangle without area that no edge
/// flip removes.
[[nodiscard]] std::string doubled_corner(std::size_t triangle);
[[nodiscard]] std::string without_area(std::size_t triangle);
/// Returns the numbers of edges, by kind, that keep a mesh from being closed and oriented. The text is the end of a
/// message "the mesh has ...".
[[nodiscard]] std::string of_edges(const Orientation& facts);

/// Return messages about one of several objects. @param name  for example "object 3".
[[nodiscard]] std::string no_triangles_in(const std::string& name);
[[nodiscard]] std::string faces_inwards(const std::string& name);
/// @param open                  number of edges that are not traversed by exactly two triangles, in opposite
///                              directions.
/// @param is_closed_by_welding  true if merging vertices at equal positions closes the mesh.
[[nodiscard]] std::string not_closed(const std::string& name, std::size_t open, bool is_closed_by_welding);
/// @param obstacle  ResolvedMesh::obstacle.
[[nodiscard]] std::string not_resolved(const std::string& name, const std::string& obstacle);

}  // namespace mesh_problem
}  // namespace blum
