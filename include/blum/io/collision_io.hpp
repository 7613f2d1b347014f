// Blum: files of collisions, and of queries about collisions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "blum/proximity/motion.hpp"

namespace blum {

/// Pairs of moving features to be tested for collisions, with the correct answers if the file contains them.
struct ImpactQueries {
  std::vector<FourMovingPoints> points;
  /// for each query: true if the features meet; unset if the file does not contain the answer
  std::vector<std::optional<bool>> truth;
};

/// Reads a file of queries. The format is that of the data sets of Wang et al. 2021 (A large-scale benchmark and an
/// inclusion-based algorithm for continuous collision detection). The file is text without a header row. Each query has
/// eight rows: its four points at time 0, then the same points at time 1. The four points are a vertex and the three
/// corners of a face, or the ends of one edge and the ends of another edge. Columns are separated by commas. Each of x,
/// y and z has two columns: an integer numerator and an integer denominator. If the answer is known, the last column is
/// 0 or 1, and is the same in all eight rows. Each coordinate must be exactly representable as a double.
/// @throws FileError.
/// @throws FormatError with the number of the line.
[[nodiscard]] ImpactQueries read_impact_queries(const std::filesystem::path& path);
/// Reads queries from memory. In messages, `name` is used as the name of the file.
[[nodiscard]] ImpactQueries read_impact_queries(std::span<const std::byte> data, std::string_view name = "questions");

/// Mesh whose vertices move along straight lines, from time 0 to time 1.
struct MeshMotion {
  MeshView start;
  std::span<const Vec3d> end;  ///< vertices at time 1; if empty, the mesh does not move

  // NOLINTNEXTLINE(google-explicit-constructor): a mesh is a motion without movement
  MeshMotion(const MeshView& mesh, std::span<const Vec3d> vertices = {}) : start(mesh), end(vertices) {}
  // NOLINTNEXTLINE(google-explicit-constructor): as above
  MeshMotion(const TriangleMesh& mesh, std::span<const Vec3d> vertices = {}) : start(mesh), end(vertices) {}
};

/// Writes the collisions of a mesh. The extension selects the format.
///
///   `.npz`   Arrays for n collisions of a vertex and a face, and m collisions of two edges. `vertex_face` [n, 4] holds
///            the vertex, then the corners of the face. `vertex_face_time` [n] holds the times. `face` [n] holds the
///            indices of the faces. `edge_edge` [m, 4] holds the two ends of the first edge, then the two ends of the
///            second edge. `edge_edge_time` [m] holds the times. Indices are int32, and are those of vertices and
///            triangles of the mesh.
///   `.csv`   A row for each collision. Columns: `kind` (vertex_face or edge_edge), the four vertices `a`, `b`, `c`,
///            `d`, the `time`, and the index of the `face`. For edge_edge, the column `face` is empty.
///   `.json`  An object with the metadata and lists with the names of the .npz arrays. The metadata `self`, `tolerance`
///            and `min_separation` are written as true, false or numbers, not as texts.
///   `.vtp`   VTK poly data: the two features of each pair, at their positions at the time of the collision. A face is
///            a triangle, and an edge is a line. The vertex that meets a face is an isolated vertex. Point data are
///            `pair`, `time` and `vertex`. Cell data are `pair`, `time` and, for triangles, `face`. Pairs are numbered
///            from 0: first the pairs of vertex_face, then the pairs of edge_edge. read_complex() reads these files,
///            too.
///
/// A file appears under its name only when it is complete.
/// @param mesh  the mesh in which the collisions were found; its `end` is used for .vtp only.
/// @throws InvalidOption for another extension.
/// @throws InvalidOption if the mesh does not have a face of the collisions. For .vtp, InvalidOption is also thrown if
/// the mesh does not have a vertex of the collisions, or if `end` has the wrong length.
/// @throws FileError, Cancelled.
void write_collisions(const std::filesystem::path& path, const ContinuousCollisions& collisions, const MeshMotion& mesh,
                      const FileMetadata& metadata = {}, const Context& context = {});

/// Writes the collisions between objects of a scene. The formats are those of write_collisions() for one mesh, with the
/// following additions.
///
///   `.npz`   `vertex_face_object` [n, 2] holds the index of the vertex's object, then the index of the face's object.
///            `edge_edge_object` [m, 2] holds the indices of the two edges' objects. Indices of vertices and faces
///            refer to the meshes of these objects.
///   `.csv`   Columns: `kind, first_object, second_object, a, b, c, d, time, face`.
///   `.json`  Lists with the names of the .npz arrays.
///   `.vtp`   Point data `object`.
///
/// Collisions are in rising order of the pair (first object, second object). For each pair of objects, the collisions
/// of vertices of the first object come first, then those of vertices of the second object.
/// @param objects  the mesh of each object of the scene; for .vtp, the mesh must be at the object's position in the
///                 scene.
/// @throws InvalidOption, also for collisions of objects that are not in `objects`.
void write_collisions(const std::filesystem::path& path, const SceneCollisions& collisions,
                      std::span<const MeshMotion> objects, const FileMetadata& metadata = {},
                      const Context& context = {});

}  // namespace blum
