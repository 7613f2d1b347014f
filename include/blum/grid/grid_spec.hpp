// Blum: where the nodes of a grid lie. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// A regular grid of nodes. Node (i, j, k) lies at origin + direction * (i * spacing.x, j * spacing.y, k * spacing.z).
/// Values are stored with i (x) fastest; the same memory is a C-ordered array indexed [z, y, x].
/// A grid with one layer along an axis is a 2D field.
struct GridSpec {
  Vec3d origin{};                             ///< position of node (0, 0, 0), in mesh units
  Vec3d spacing{1, 1, 1};                     ///< distance between neighbouring nodes, > 0, in mesh units
  std::array<std::int64_t, 3> size{0, 0, 0};  ///< number of nodes along x, y, z, each >= 1
  Mat3 direction{};                           ///< orthonormal; column a is the direction of index axis a

  [[nodiscard]] std::size_t node_count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
  [[nodiscard]] std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
  }
  [[nodiscard]] Vec3d position(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return origin + direction * Vec3d{static_cast<double>(i) * spacing.x, static_cast<double>(j) * spacing.y,
                                      static_cast<double>(k) * spacing.z};
  }
  [[nodiscard]] friend bool operator==(const GridSpec&, const GridSpec&) = default;
};

template <>
struct Description<GridSpec> {
  static constexpr std::string_view name = "GridSpec";
  static constexpr std::string_view doc = "Where the nodes of a grid lie";
  static constexpr std::tuple members{
      Member{"origin", &GridSpec::origin, "mesh units", "position of node (0, 0, 0)"},
      Member{"spacing", &GridSpec::spacing, "mesh units", "distance between neighbouring nodes"},
      Member{"size", &GridSpec::size, "", "number of nodes along x, y, z"},
      Fact{"nodes", &GridSpec::node_count, "", "their number"},
      Member{"direction", &GridSpec::direction, "", "orthonormal; column a is the direction of index axis a"},
  };
};

/// @throws InvalidGrid unless sizes are >= 1, there are at most 2^40 nodes, spacing is positive and finite, the origin
/// finite and the direction orthonormal (within 1e-6).
void validate(const GridSpec& grid);

/// The box around the grid's nodes, axis-aligned in world space.
[[nodiscard]] Box3 bounds(const GridSpec& grid);

/// The default grid around a shape: each side of its bounds padded by padding * L, L the longest side; `resolution`
/// nodes along the longest padded side, spacing h = (1 + 2 padding) L / (resolution - 1) on all axes; the other axes
/// get the smallest number of nodes that covers their padded side, centred.
/// @param resolution  2 to 65536.   @param padding  >= 0, as a fraction of L.
/// @throws InvalidGrid when the bounds are empty or a single point; InvalidOption when a parameter is out of range.
[[nodiscard]] GridSpec grid_around(const Box3& shape_bounds, int resolution = 256, double padding = 0.1);

/// The same with the spacing (> 0, in mesh units) given instead of the number of nodes.
[[nodiscard]] GridSpec grid_around_with_spacing(const Box3& shape_bounds, double spacing, double padding = 0.1);

/// A grid over exactly this box, without padding: `resolution` nodes along its longest side, the others centred as
/// above. A side of length zero gives one layer. @throws InvalidGrid, InvalidOption.
[[nodiscard]] GridSpec grid_in(const Box3& box, int resolution = 256);
/// The same with the spacing given. A side that is no whole number of steps grows to the next one, centred: the grid
/// reaches beyond the box by less than half a step at each end.
[[nodiscard]] GridSpec grid_in_with_spacing(const Box3& box, double spacing);

}  // namespace blum
