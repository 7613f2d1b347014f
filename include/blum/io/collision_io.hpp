// Blum: files of collisions, and of questions about them. SPDX-License-Identifier: Apache-2.0
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

/// Questions about continuous collisions of pairs of features, and the right answers where the file has them.
struct ImpactQueries {
  std::vector<FourMovingPoints> points;
  std::vector<std::optional<bool>> truth;  ///< of each: whether they meet
};

/// Reads a file of questions in the form of the data sets of Wang et al. 2021 (A large-scale benchmark and an
/// inclusion- based algorithm for continuous collision detection): text, without a head, eight rows for each question,
/// which are the four points at time 0, then at time 1: vertex, then the face's three; or the ends of one edge, then
/// those of the other. Columns, parted by commas: x, y and z, each as integer numerator and denominator, and where it
/// is known the answer, 0 or 1, the same in all eight. Each coordinate must be exactly a double.
/// @throws FileError; FormatError naming the line.
[[nodiscard]] ImpactQueries read_impact_queries(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] ImpactQueries read_impact_queries(std::span<const std::byte> data, std::string_view name = "questions");

/// A mesh whose vertices move along straight lines, from time 0 to time 1.
struct MeshMotion {
  MeshView start;
  std::span<const Vec3d> end;  ///< the vertices at time 1; none: it rests

  // NOLINTNEXTLINE(google-explicit-constructor): a mesh is one that rests
  MeshMotion(const MeshView& mesh, std::span<const Vec3d> vertices = {}) : start(mesh), end(vertices) {}
  // NOLINTNEXTLINE(google-explicit-constructor): as above
  MeshMotion(const TriangleMesh& mesh, std::span<const Vec3d> vertices = {}) : start(mesh), end(vertices) {}
};

/// Writes the collisions of a mesh; the format goes by the extension.
///
///   .npz   `vertex_face` [n, 4]: the vertex, then the corners of the face; `vertex_face_time` [n]; `face` [n]: the
///          numbers of these faces; `edge_edge` [m, 4]: the ends of one edge, then those of the other;
///          `edge_edge_time` [m]. Indices are int32, those of the mesh.
///   .csv   a row for each collision: kind (vertex_face or edge_edge), the four vertices a, b, c, d, the time, the
///          number of the face (of edge_edge nothing).
///   .json  an object with the metadata (self, tolerance, min_separation as true, false and numbers) and the same
///          lists.
///   .vtp   VTK poly data: the features of each pair where they are at its time: a face as a triangle, edges as lines,
///          the vertex that a face meets as one that nothing else names. Point data: pair (vertex_face from 0 on, then
///          edge_edge), time, vertex; cell data: pair, time, of triangles also face. read_complex() reads them, too.
///
/// A file appears under its name only when it is complete.
/// @param mesh  whose collisions they are; its end is for .vtp alone.
/// @throws InvalidOption for another extension, and for faces or (.vtp) vertices that are not there; FileError;
/// Cancelled.
void write_collisions(const std::filesystem::path& path, const ContinuousCollisions& collisions, const MeshMotion& mesh,
                      const FileMetadata& metadata = {}, const Context& context = {});

/// Writes what of the objects of a scene collides: as above, with the objects.
///
///   .npz   also `vertex_face_object` [n, 2]: the object of the vertex, then that of the face; `edge_edge_object`
///          [m, 2]: the object of one edge, then that of the other. Indices are those of the meshes of these objects.
///   .csv   kind, first_object, second_object, a, b, c, d, time, face.
///   .json  the same lists.
///   .vtp   also object, as point data.
///
/// Pairs come by rising (first, second) object; of these first the vertices of the first object, then those of the
/// second one.
/// @param objects  the meshes of the scene, by object, for .vtp placed as they are in it.
/// @throws InvalidOption also for collisions of objects that are not there.
void write_collisions(const std::filesystem::path& path, const SceneCollisions& collisions,
                      std::span<const MeshMotion> objects, const FileMetadata& metadata = {},
                      const Context& context = {});

}  // namespace blum
