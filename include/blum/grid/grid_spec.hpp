// Blum: positions of the nodes of a grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Regular grid of nodes. Node (i, j, k) lies at origin + direction * (i * spacing.x, j * spacing.y, k * spacing.z).
/// Values are stored with i (x) fastest, as in a C-ordered array that is indexed [z, y, x]. If a grid has one layer
/// along an axis, fields on it are two-dimensional.
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
  static constexpr std::string_view doc = "Positions of the nodes of a grid";
  static constexpr std::tuple members{
      Member{"origin", &GridSpec::origin, "mesh units", "position of node (0, 0, 0)"},
      Member{"spacing", &GridSpec::spacing, "mesh units", "distance between neighbouring nodes"},
      Member{"size", &GridSpec::size, "", "number of nodes along x, y, z"},
      Fact{"nodes", &GridSpec::node_count, "", "number of nodes"},
      Member{"direction", &GridSpec::direction, "", "orthonormal matrix; column a is the direction of index axis a"},
  };
};

/// @throws InvalidGrid if a size is below 1, there are more than 2^40 nodes, or a spacing is not positive and finite.
/// InvalidGrid is also thrown if the origin is not finite, or the direction is not orthonormal within 1e-6.
void validate(const GridSpec& grid);

/// Returns the box around the grid's nodes, axis-aligned in world space.
[[nodiscard]] Box3 bounds(const GridSpec& grid);

/// Returns the default grid around a shape. Let L be the longest side of the shape's bounds. Each side of the bounds is
/// padded by padding * L at both ends. The longest padded side gets `resolution` nodes. The spacing along all axes is
/// (1 + 2 padding) L / (resolution - 1). Each other axis gets the smallest number of nodes that covers its padded side.
/// These nodes are centred on the side.
/// @param resolution  2 to 65536.
/// @param padding     0 to 1e6, as a fraction of L.
/// @throws InvalidGrid if the bounds are empty, not finite or a single point, or the grid has over 2^40 nodes.
/// @throws InvalidOption if a parameter is out of range.
[[nodiscard]] GridSpec grid_around(const Box3& shape_bounds, int resolution = 256, double padding = 0.1);

/// Does the same as grid_around(), with a given spacing instead of a resolution. @param spacing > 0, in mesh units.
[[nodiscard]] GridSpec grid_around_with_spacing(const Box3& shape_bounds, double spacing, double padding = 0.1);

/// Returns a grid over a box, without padding. The longest side has `resolution` nodes and is covered exactly. The
/// other sides get nodes as in grid_around(). A side of length zero gets one layer. @throws InvalidGrid, InvalidOption.
[[nodiscard]] GridSpec grid_in(const Box3& box, int resolution = 256);
/// Does the same as grid_in(), with a given spacing instead of a resolution. If a side is not a whole number of steps
/// long, the grid is centred on the side, with the next larger number of steps. The grid then extends beyond the box by
/// less than half a step at each end.
[[nodiscard]] GridSpec grid_in_with_spacing(const Box3& box, double spacing);

}  // namespace blum
