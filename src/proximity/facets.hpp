// Blum: flat parts of a surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// The triangles of a surface that lie in one plane and hang together, and where that part ends.
class Facets {
 public:
  /// @param rounding  how far apart points in one plane may be.
  Facets(const MeshView& mesh, double rounding);

  /// How a triangle lies to a facet, seen along the facet's normal.
  struct Lie {
    bool is_over = false;  ///< all of it is over the facet
    double furthest = 0;   ///< of the corners from the facet's plane
    bool is_crossed = false;
    /// Where a side of the facet crosses it: distances of the corners from the plane through that side, along the
    /// normal; some above 0, some below.
    std::array<double, 3> sides{};
  };

  /// How many sides and triangles the facet of a triangle has.
  [[nodiscard]] std::size_t size(std::uint32_t triangle) const {
    const Facet& facet = facets_[facet_of_[triangle]];
    return facet.border.size() + facet.triangles.size();
  }
  /// @param triangle  one of the facet's. Cost: O(size of the facet), 10 ns for each.
  [[nodiscard]] Lie lie(const std::array<Vec3d, 3>& points, std::uint32_t triangle) const;

 private:
  using Point = std::array<double, 2>;
  struct Facet {
    Vec3d origin, u, v, normal;
    std::vector<std::array<Point, 2>> border;
    std::vector<std::array<Point, 3>> triangles;

    [[nodiscard]] Point seen(const Vec3d& p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
  };

  [[nodiscard]] bool holds(const Facet& facet, const Point& point) const;

  double rounding_;
  std::vector<std::uint32_t> facet_of_;  ///< of each triangle
  std::vector<Facet> facets_;
};

}  // namespace blum::detail
