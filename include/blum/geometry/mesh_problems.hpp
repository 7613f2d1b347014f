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

/// Returns the reason why a mesh bounds no solid, in one sentence with counts and possible remedies. It is empty if the
/// mesh is closed, oriented, manifold and faces outwards. It does not check for self-crossings; problem_of_crossings()
/// does.
[[nodiscard]] std::string problem_as_solid(const Topology& facts);

/// Return a sentence if a mesh meets itself where it should not, naming two vertices or triangles; else an empty one.
/// The first function looks for two vertices of triangles in one place, the second for triangles that cross or touch.
/// @throws Cancelled.
[[nodiscard]] std::string problem_of_places(const MeshView& mesh);
[[nodiscard]] std::string problem_of_crossings(const MeshView& mesh, const Context& context = {});
/// Returns the same sentence for a result of find_self_intersections().
[[nodiscard]] std::string problem_of_crossings(const SelfIntersections& found);

/// Sentences and ends of sentences. All messages of Blum about meshes that bound no solid are here and in
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
/// Ends "the mesh bounds no polyhedron: ...".
inline constexpr std::string_view shells_cross = "its shells are not nested: they cross or coincide";

/// Returns all reasons found at edges and vertices why a mesh bounds no polyhedron. They end "the mesh bounds no
/// polyhedron: ...". Empty without such a reason.
[[nodiscard]] std::string obstacles(const Topology& facts);
/// Return such a reason for pairs of triangles that cross or touch. @param is_complete  false if more pairs exist.
[[nodiscard]] std::string crossing(std::size_t pairs, bool is_complete);
[[nodiscard]] std::string touching(std::size_t pairs, bool is_complete);
/// Returns the message of calls that need the numbers of the mesh's own triangles. @param how  Solid::reason().
[[nodiscard]] std::string crosses_and_is_resolved(const std::string& how);
/// Return messages for a triangle that names a vertex twice, and for one without area that no edge flip removes.
[[nodiscard]] std::string doubled_corner(std::size_t triangle);
[[nodiscard]] std::string without_area(std::size_t triangle);
/// Returns how many edges of each kind keep a mesh from being closed and oriented. It ends "the mesh has ...".
[[nodiscard]] std::string of_edges(const Orientation& facts);

/// Return messages about one object among several. @param name  for example "object 3".
[[nodiscard]] std::string no_triangles_in(const std::string& name);
[[nodiscard]] std::string faces_inwards(const std::string& name);
/// @param open                  number of edges that have no two triangles in opposite directions.
/// @param is_closed_by_welding  true if merging equal vertices leaves no such edge.
[[nodiscard]] std::string not_closed(const std::string& name, std::size_t open, bool is_closed_by_welding);
/// @param obstacle  ResolvedMesh::obstacle.
[[nodiscard]] std::string not_resolved(const std::string& name, const std::string& obstacle);

}  // namespace mesh_problem
}  // namespace blum
