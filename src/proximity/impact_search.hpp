// Blum: search for collisions of moving objects. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/moving_box_bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "blum/proximity/impact.hpp"

namespace blum {

/// Checks a mesh, and its vertices at the end of a motion. @throws InvalidMesh
void check_motion(const MeshView& mesh, std::span<const Vec3d> end);

/// Moves the sides of a box outwards by at least half of `min_separation`.
void grow(MovingBox& box, double min_separation);

/// The features of a mesh between two frames. Vertices with equal positions in both frames count as one vertex,
/// represented by the smallest of their indices. Vertices that the mesh does not use are ignored.
class MovingFeatures {
 public:
  /// @param mesh  the mesh at the start. It must outlive this object.
  /// @param end   positions of the vertices at the end. They must outlive this object.
  MovingFeatures(const MeshView& mesh, std::span<const Vec3d> end, const Context& context);

  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// Returns each edge once, as two representing vertices, the vertex with the smaller index first.
  [[nodiscard]] const std::vector<Segment>& edges() const { return edges_; }
  [[nodiscard]] std::span<const Triangle> faces() const { return mesh_.triangles; }

  /// Returns the vertex that represents a vertex.
  [[nodiscard]] std::uint32_t place(std::uint32_t vertex) const { return place_.empty() ? vertex : place_[vertex]; }

  [[nodiscard]] const Vec3d& start(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  [[nodiscard]] const Vec3d& end(std::uint32_t vertex) const { return end_[vertex]; }

  /// Returns a box around vertices, with its sides moved outwards by at least half of `min_separation`.
  [[nodiscard]] MovingBox box(std::span<const std::uint32_t> vertices, double min_separation) const;

  /// Returns true if a vertex is a corner of a face.
  [[nodiscard]] bool is_corner(std::uint32_t vertex, const Triangle& face) const;

 private:
  MeshView mesh_;
  std::span<const Vec3d> end_;
  /// For each vertex: the vertex that represents it; empty if each represents itself.
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> vertices_;
  std::vector<Segment> edges_;
};

/// Returns true if two edges have an end in common.
[[nodiscard]] bool share_end(const Segment& a, const Segment& b);

/// Returns the points of two features, of one object or of two objects.
[[nodiscard]] FourMovingPoints moving_points(const MovingFeatures& a, std::span<const std::uint32_t> first,
                                             const MovingFeatures& b, std::span<const std::uint32_t> second);

/// Returns true if one of ten directions certainly separates the first points from the others at all times, by more
/// than a distance. The three axes are not among the directions, because boxes are compared along them.
/// @param first_count  1 for a vertex and a face, 2 for two edges.
/// @param distance  mesh units, >= 0.
[[nodiscard]] bool are_apart(const FourMovingPoints& points, std::size_t first_count, double distance);

/// A mesh between two frames, with hierarchies over the boxes of its features.
class MovingObject {
 public:
  /// @param mesh            the mesh at the start. It must outlive this object.
  /// @param end             positions of the vertices at the end. They must outlive this object.
  /// @param min_separation  features at this distance or less are treated as meeting.
  MovingObject(const MeshView& mesh, std::span<const Vec3d> end, double min_separation, const Context& context);

  [[nodiscard]] const MovingFeatures& features() const { return features_; }
  /// Returns the box of a feature that the hierarchies contain.
  [[nodiscard]] MovingBox box(std::span<const std::uint32_t> vertices) const {
    return features_.box(vertices, min_separation_);
  }
  [[nodiscard]] const MovingBoxBvh& vertices() const { return vertices_; }
  [[nodiscard]] const MovingBoxBvh& edges() const { return edges_; }
  [[nodiscard]] const MovingBoxBvh& faces() const { return faces_; }

 private:
  MovingFeatures features_;
  double min_separation_;
  MovingBoxBvh vertices_;
  MovingBoxBvh edges_;
  MovingBoxBvh faces_;
};

/// Finds collisions of features, and counts the work.
class ImpactSearch {
 public:
  ImpactSearch(const ImpactOptions& options, const Context& context) : options_(options), context_(context) {}

  /// Returns the colliding pairs of a vertex of one object and a face of another object or of the same object, in
  /// ascending order.
  /// @throws OutOfMemory, Cancelled.
  [[nodiscard]] std::vector<VertexFaceCollision> vertices_and_faces(const MovingObject& of_vertices,
                                                                    const MovingObject& of_faces);
  /// Returns the colliding pairs of edges, in rising order. For two objects, each pair begins with the edge of the
  /// first object. For one object, each pair begins with the smaller edge.
  [[nodiscard]] std::vector<EdgeEdgeCollision> edges_and_edges(const MovingObject& a, const MovingObject& b);

  [[nodiscard]] std::size_t box_pairs() const { return box_pairs_; }
  [[nodiscard]] std::size_t exact_tests() const { return exact_tests_; }

 private:
  template <class Collision>
  struct Found;
  template <class Collision, class Find>
  std::vector<Collision> gathered(std::size_t blocks, const char* phase, const Find& find);
  template <class Collision>
  bool stops(Found<Collision>& found) const;
  void test_vertex_face(const MovingFeatures& of_vertices, const MovingFeatures& of_faces, std::uint32_t vertex,
                        std::uint32_t face, Found<VertexFaceCollision>& found);
  void test_edge_edge(const MovingFeatures& a, const MovingFeatures& b, std::uint32_t first, std::uint32_t second,
                      Found<EdgeEdgeCollision>& found);

  ImpactOptions options_;
  const Context& context_;
  std::atomic<std::size_t> collisions_ = 0;
  std::size_t box_pairs_ = 0;
  std::size_t exact_tests_ = 0;
};

}  // namespace blum
