// Blum: typed indices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace blum {

/// Index of 32 bits, as a type of its own for each kind of object.
/// none() stands for "no object". In large arrays, std::optional would double the memory. Files store none() as -1.
template <class Tag>
struct Id {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t index) : value(index) {}
  [[nodiscard]] static constexpr Id none() { return Id(); }
  [[nodiscard]] constexpr bool has_value() const { return value != std::numeric_limits<std::uint32_t>::max(); }
  /// Returns the number that files hold: the index, or -1 for none().
  [[nodiscard]] constexpr std::int32_t to_file() const { return static_cast<std::int32_t>(value); }
  [[nodiscard]] friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using VertexId = Id<struct VertexTag>;
using EdgeId = Id<struct EdgeTag>;
using TriangleId = Id<struct TriangleTag>;
/// Site of a mesh (see geometry/sites.hpp for the numbering), or linear index of a voxel of an image.
using SiteId = Id<struct SiteTag>;

/// Largest number of objects of one kind. Ids must fit a signed 32-bit integer, because files hold them as such.
inline constexpr std::size_t max_id_count = 0x7fffffff;

}  // namespace blum
