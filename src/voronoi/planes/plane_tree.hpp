// Blum: search for the planes closest to a point inside them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/planes/half_spaces.hpp"

namespace blum::voronoi {

/// Tree over the planes of HalfSpaces, by their normals. Bounds hold for all points; they exclude most planes if
/// neighbours in the tree also touch the solid close to each other.
class PlaneTree {
 public:
  using Index = HalfSpaces::Index;

  /// @param middle  for each plane: a point near its polygon.
  PlaneTree(const HalfSpaces& spaces, const std::vector<Vec3d>& middle);

  /// Planes that a point does not clear.
  struct Found {
    bool is_outside = false;    ///< the point is outside a half-space
    std::vector<Index> planes;  ///< the plane that it lies furthest outside; otherwise all planes that it may touch
  };
  /// Finds the planes that a point may touch within its error. Cost: about 1 us if these are few.
  /// @param out  its memory is used again.
  void find(const PlacedCorner& point, Found& out) const;

 private:
  struct Node {
    Vec3d low, high;          ///< bounds on the normals
    Vec3d place;              ///< close to the polygons
    Vec3d inwards;            ///< mean of the normals
    double least_cosine = 0;  ///< smallest product of a normal and `inwards`
    double above_place = 0;   ///< smallest depth of `place`
    double above_centre = 0;  ///< smallest depth of the tree's centre
    std::uint32_t begin = 0, end = 0;
    std::uint32_t second = 0;  ///< second child; the first one is the next node; 0 for a leaf
  };
  struct Row {
    Vec3d normal;
    double offset = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end, const HalfSpaces& spaces, const std::vector<Vec3d>& middle);
  void bound(Node& node, const std::vector<Vec3d>& middle) const;
  [[nodiscard]] double least_depth(const Node& node, const PlacedCorner& point) const;

  Vec3d centre_;
  double scale_ = 0;  ///< bound on the magnitudes of all places and offsets
  std::vector<Index> order_;
  std::vector<Row> rows_;  ///< in this order
  std::vector<Node> nodes_;
};

}  // namespace blum::voronoi
