// Blum: clusters of triangles with the moments for winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight triangles. Unused entries of the last block are single points.
struct alignas(64) TriangleBlock {
  double corner[3][3][lanes];  ///< [corner][axis][lane]
};

/// Eight clusters of triangles, each as a multipole at its centre. Empty lanes contain nothing and are further away
/// than any query, so they are always added as a whole. With s = x - centre and n the unit normal at x:
struct alignas(64) MultipoleBlock {
  double center[3][lanes];
  double dipole[3][lanes];  ///< integral of n
  /// Integral of n s, symmetric, traceless: xx, yy, xy, xz, yz; off-diagonals twice; times -3.
  double quadrupole[5][lanes];
  /// Integral of n s s, symmetric, traceless: xxx, yyy, xyy, xxy, xxz, yyz, xyz; see series().
  double octupole[7][lanes];
  double cubed[lanes];   ///< bound on the integral of |s|^3
  double radius[lanes];  ///< bound on |s|
};

/// Sums over the clusters that a traversal added as a whole: solid angles, and bounds on their errors, in steradians.
/// Lanes have separate sums.
struct alignas(64) FarSum {
  double solid_angle[lanes] = {};
  double error[lanes] = {};
};

/// Flags of eight clusters: 1 if the cluster must be opened, else 0.
struct alignas(64) OpenLanes {
  double open[lanes];
};

/// Adds the clusters whose error is at most `tolerance` (steradians). Marks the others in `others`: they must be
/// opened.
void add_clusters(const MultipoleBlock& block, const Vec3d& query, double tolerance, FarSum& sum, OpenLanes& others);

/// Adds the clusters whose distance exceeds beta times their radius, without error bounds. Marks the others in
/// `others`: they must be opened.
void add_clusters_beyond(const MultipoleBlock& block, const Vec3d& query, double beta, FarSum& sum, OpenLanes& others);

/// Sum of half solid angles that needs no atan2 for each term. Every lane contains a product of complex numbers whose
/// arguments are half the solid angles. The sum also counts how often the arguments' total left (-pi, pi].
struct alignas(64) SolidAngleSum {
  double re[lanes];
  double im[lanes];
  double turns[lanes];

  SolidAngleSum();
  /// Returns the current sum as a winding number.
  [[nodiscard]] double winding_number() const;
};

/// Adds eight triangles (van Oosterom and Strackee 1983).
void add_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum);

/// Adds eight triangles, and also measures how ill-conditioned their angles are. For each angle, adds a quotient to its
/// lane of `inverse`: the magnitude of its terms over that of their sum. The error of the angle is rounding times this
/// quotient.
void add_watched_triangles(const TriangleBlock& block, const Vec3d& query, SolidAngleSum& sum,
                           double (&inverse)[lanes]);

/// Complete tree with eight children per node. Leaf i contains triangles 8 i ... 8 i + 7 of a spatial order. Block i of
/// level 0 contains the clusters of leaves 8 i ... 8 i + 7. Higher levels continue likewise, up to one block.
struct WindingTree {
  double scale = 1;  ///< factor of mesh coordinates, a power of two; the scaled mesh is about 1 long
  std::vector<TriangleBlock> leaves;
  std::vector<std::vector<MultipoleBlock>> levels;
  BoxTree boxes;  ///< boxes of a tree of the same shape; level 0 contains the boxes of leaves

  [[nodiscard]] int top() const { return static_cast<int>(levels.size()) - 1; }
};

[[nodiscard]] WindingTree make_winding_tree(const MeshView& mesh, const Context& context);

}  // namespace blum
