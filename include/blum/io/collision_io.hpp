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

/// Queries about continuous collisions of pairs of features, with the correct answers if the file has them.
struct ImpactQueries {
  std::vector<FourMovingPoints> points;
  std::vector<std::optional<bool>> truth;  ///< for each query: true if the features meet
};

/// Reads a file of queries. Its form is that of the data sets of Wang et al. 2021 (A large-scale benchmark and an
/// inclusion-based algorithm for continuous collision detection). The file is text without a header row. Each query has
/// eight rows: its four points at time 0, then at time 1. The points are a vertex and the three of a face, or the two
/// ends of one edge and those of the other. Columns are separated by commas: x, y and z, each as integer numerator and
/// denominator. If the answer is known, it follows as 0 or 1, the same in all eight rows. Each coordinate must be
/// exactly a double.
/// @throws FileError.
/// @throws FormatError that names the line.
[[nodiscard]] ImpactQueries read_impact_queries(const std::filesystem::path& path);
/// Reads queries from memory. In messages, `name` stands for the file.
[[nodiscard]] ImpactQueries read_impact_queries(std::span<const std::byte> data, std::string_view name = "questions");

/// Mesh whose vertices move along straight lines, from time 0 to time 1.
struct MeshMotion {
  MeshView start;
  std::span<const Vec3d> end;  ///< vertices at time 1; empty: the mesh rests

  // NOLINTNEXTLINE(google-explicit-constructor): a mesh is one that rests
  MeshMotion(const MeshView& mesh, std::span<const Vec3d> vertices = {}) : start(mesh), end(vertices) {}
  // NOLINTNEXTLINE(google-explicit-constructor): as above
  MeshMotion(const TriangleMesh& mesh, std::span<const Vec3d> vertices = {}) : start(mesh), end(vertices) {}
};

/// Writes the collisions of a mesh. The extension selects the format.
///
///   `.npz`   `vertex_face` [n, 4] holds the vertex, then the corners of the face. `vertex_face_time` [n] holds times.
///            `face` [n] holds the numbers of these faces. `edge_edge` [m, 4] holds the ends of one edge, then those of
///            the other. `edge_edge_time` [m] holds times. Indices are int32, those of the mesh.
///   `.csv`   A row for each collision. Columns: `kind` (vertex_face or edge_edge), the four vertices `a`, `b`, `c`,
///            `d`, the `time`, and the number of the `face`. The face is empty for edge_edge.
///   `.json`  An object with the metadata and the same lists. The metadata `self`, `tolerance` and `min_separation` are
///            true, false or numbers.
///   `.vtp`   VTK poly data: the features of each pair, placed at its time. A face is a triangle, edges are lines. The
///            vertex that meets a face is an isolated vertex. Point data are `pair`, `time` and `vertex`. Cell data are
///            `pair`, `time` and, for triangles, `face`. Pairs of vertex_face are numbered from 0, pairs of edge_edge
///            follow. read_complex() reads these files, too.
///
/// A file appears under its name only when it is complete.
/// @param mesh  the mesh of the collisions; its `end` is used for .vtp only.
/// @throws InvalidOption for another extension.
/// @throws InvalidOption for faces that the mesh lacks, and in .vtp for vertices that it lacks or an `end` of another
/// length.
/// @throws FileError, Cancelled.
void write_collisions(const std::filesystem::path& path, const ContinuousCollisions& collisions, const MeshMotion& mesh,
                      const FileMetadata& metadata = {}, const Context& context = {});

/// Writes the collisions between objects of a scene: as above, with the objects.
///
///   `.npz`   Also `vertex_face_object` [n, 2], the object of the vertex, then that of the face. Also
///            `edge_edge_object` [m, 2], the object of one edge, then that of the other. Indices are those of the
///            meshes of these objects.
///   `.csv`   Columns: `kind, first_object, second_object, a, b, c, d, time, face`.
///   `.json`  The same lists.
///   `.vtp`   Also `object`, as point data.
///
/// Pairs come by rising (first, second) object. For each, the vertices of the first object come first, then those of
/// the second one.
/// @param objects  the meshes of the scene, by object; for .vtp placed as in the scene.
/// @throws InvalidOption, also for collisions of objects that are not given.
void write_collisions(const std::filesystem::path& path, const SceneCollisions& collisions,
                      std::span<const MeshMotion> objects, const FileMetadata& metadata = {},
                      const Context& context = {});

}  // namespace blum
